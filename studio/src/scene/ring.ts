// A circle on the sheet as it lies on every state: what a brush of that radius takes. Its points are found on the sheet once
// and carried to the states by the panels.
import * as THREE from "three";
import type { Stage, View } from "./stage";
import type { SkinPoint } from "./skin";

const points = 56;

export interface Ring {
    centre: { face: number; bary: [number, number, number] };
    at: SkinPoint[];
}

export function ringAround(stage: Stage, hit: SkinPoint, radius: number): Ring | null {
    const skins = stage.skins;
    if (!skins) return null;
    const c = skins.sheet.carry(hit, new THREE.Vector3());
    const at: SkinPoint[] = [];
    for (let k = 0; k < points; k++) {
        const a = (2 * Math.PI * k) / points;
        const p = skins.sheet.nearest(new THREE.Vector3(c.x + radius * Math.cos(a), c.y + radius * Math.sin(a), 0));
        if (p) at.push(p);
    }
    return { centre: { face: hit.face, bary: hit.bary }, at };
}

/** The ring in a view: white within a dark halo, at a third of its weight where the surface faces away. */
export function drawRing(context: CanvasRenderingContext2D, stage: Stage, view: View, ring: Ring, style: { inner: number; dashed: boolean; minus: boolean; weight: number }): void {
    const skin = stage.skins?.[view.state];
    if (!skin) return;
    const place = new THREE.Vector3();
    const normal = new THREE.Vector3();
    const eye = view.orbit.camera.position;
    const carried = lowPass(ring.at.map((p) => skin.carry(p, new THREE.Vector3())), view.state === "flat" ? 1 : 3);
    const projected = ring.at.map((p, k) => {
        const s = stage.project(view, carried[k]);
        const away = view.state === "space" && skin.normal(p.face, normal).dot(eye.clone().sub(carried[k])) < 0;
        return { ...s, away };
    });
    const centre = stage.project(view, skin.carry(ring.centre, place));
    context.save();
    context.beginPath();
    context.rect(view.rect.x, view.rect.y, view.rect.width, view.rect.height);
    context.clip();
    const path = (scale: number, away: boolean | null) => {
        context.beginPath();
        const n = projected.length;
        const at = (k: number) => {
            const p = projected[k % n];
            return [centre.x + (p.x - centre.x) * scale, centre.y + (p.y - centre.y) * scale] as const;
        };
        for (let k = 0; k < n; k++) {
            if (away !== null && (projected[k].away || projected[(k + 1) % n].away) !== away) continue;
            context.moveTo(...at(k));
            context.lineTo(...at(k + 1));
        }
    };
    context.beginPath();
    projected.forEach((p, k) => (k ? context.lineTo(p.x, p.y) : context.moveTo(p.x, p.y)));
    context.fillStyle = "rgb(255 255 255 / 0.10)";
    context.fill();
    context.lineCap = "round";
    for (const away of [true, false]) {
        context.globalAlpha = style.weight * (away ? 0.35 : 1);
        if (style.dashed) context.setLineDash([6, 5]);
        path(1, away);
        context.lineWidth = 4.5;
        context.strokeStyle = "rgb(0 0 0 / 0.6)";
        context.stroke();
        context.lineWidth = 2.25;
        context.strokeStyle = "#fff";
        context.stroke();
        context.setLineDash([]);
        if (style.inner > 0) {
            path(style.inner, away);
            context.lineWidth = 2.5;
            context.strokeStyle = "rgb(0 0 0 / 0.35)";
            context.stroke();
            context.lineWidth = 1;
            context.strokeStyle = "#fff";
            context.stroke();
        }
    }
    if (style.minus) {
        context.globalAlpha = style.weight;
        context.beginPath();
        context.moveTo(centre.x - 6, centre.y);
        context.lineTo(centre.x + 6, centre.y);
        context.lineWidth = 4.5;
        context.strokeStyle = "rgb(0 0 0 / 0.6)";
        context.stroke();
        context.lineWidth = 2;
        context.strokeStyle = "#fff";
        context.stroke();
    }
    context.restore();
}

/** Panels turn against each other, which carries a circle over in steps as long as a panel: only its slow waves are kept,
 *  in the plane those of an ellipse. */
function lowPass(loop: THREE.Vector3[], waves: number): THREE.Vector3[] {
    const n = loop.length;
    const out = loop.map(() => new THREE.Vector3());
    for (let wave = 0; wave <= waves; wave++) {
        const cosine = new THREE.Vector3();
        const sine = new THREE.Vector3();
        loop.forEach((p, k) => {
            const a = (2 * Math.PI * wave * k) / n;
            cosine.addScaledVector(p, ((wave ? 2 : 1) / n) * Math.cos(a));
            sine.addScaledVector(p, (2 / n) * Math.sin(a));
        });
        out.forEach((p, k) => {
            const a = (2 * Math.PI * wave * k) / n;
            p.addScaledVector(cosine, Math.cos(a));
            if (wave) p.addScaledVector(sine, Math.sin(a));
        });
    }
    return out;
}
