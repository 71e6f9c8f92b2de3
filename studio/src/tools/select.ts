// Selecting: a click, a lasso, a kagome line, a curve between two hinges.
import { signal } from "@preact/signals";
import * as THREE from "three";
import { drawn } from "../panels/template";
import type { Stage } from "../scene/stage";
import { insidePolygon, kagomeLine, shortestWay } from "../panels/lines";
import { clearSelection, hoveredHinge, select as choose, selectHinges, selected, selectedHinges } from "../state/selection";
import { currentShell } from "../state/session";
import { type Hit, type Tool, pointer } from "./tool";

/** `click`: panels one by one, or by a loop round them. */
export type SelectKind = "click" | "line" | "curve";
export const selectKind = signal<SelectKind>("click");

let loop: { x: number; y: number }[] = [];
/** First hinge of a curve. */
const first = signal(-1);

const modeOf = (hit: Hit) => (hit.control ? "remove" : hit.shift ? "add" : "replace");

/** The neighbour of the nearest hinge whose line runs most nearly through the pointer. */
function lineAt(hit: Hit): number[] {
    const shell = currentShell();
    const skin = hit.stage.skins?.[hit.view.state];
    if (!shell || !skin || !hit.on) return [];
    const h = skin.hingeAt(hit.on);
    const place = (k: number) => new THREE.Vector3().fromArray(skin.places, 3 * k);
    const to = hit.on.point.clone().sub(place(h)).normalize();
    let best = -1;
    let most = -Infinity;
    for (const t of [shell.linkage.around[2 * h], shell.linkage.around[2 * h + 1]])
        for (let k = 0; t >= 0 && k < 3; k++) {
            const n = shell.linkage.triangles[3 * t + k];
            if (n === h) continue;
            const along = Math.abs(place(n).sub(place(h)).normalize().dot(to));
            if (along > most) {
                most = along;
                best = n;
            }
        }
    return best < 0 ? [] : kagomeLine(shell.linkage, h, best);
}

export const selectTool: Tool = {
    id: "select", title: "Select", icon: "select", shortcut: "V", cursor: "default",
    down(hit) {
        loop = [{ x: hit.x, y: hit.y }];
        return true;
    },
    move(hit, dragging) {
        if (!dragging || selectKind.value === "line" || selectKind.value === "curve") return;
        const last = loop.at(-1);
        if (last && Math.hypot(last.x - hit.x, last.y - hit.y) > 3) loop.push({ x: hit.x, y: hit.y });
        hit.stage.invalidateOverlay();
    },
    up(hit) {
        const shell = currentShell();
        const drawn = loop;
        loop = [];
        hit.stage.invalidateOverlay();
        if (!shell) return;
        if (selectKind.value === "line") {
            selectHinges(lineAt(hit));
        } else if (selectKind.value === "curve") {
            const h = hoveredHinge.value;
            if (h < 0) return;
            if (first.value < 0) {
                first.value = h;
                selectHinges([h]);
            } else {
                selectHinges(shortestWay(shell.linkage, shell.sheet, first.value, h));
                first.value = -1;
            }
        } else if (drawn.length > 4) {
            const skin = hit.stage.skins![hit.view.state];
            const inside: number[] = [];
            const centre = new THREE.Vector3();
            for (let t = 0; t < shell.linkage.panels; t++) {
                const p = hit.stage.project(hit.view, skin.centre(t, centre));
                if (insidePolygon(drawn, p.x, p.y)) inside.push(t);
            }
            choose(inside, modeOf(hit));
        } else if (hit.panel >= 0) choose([hit.panel], hit.shift && selected.value.has(hit.panel) ? "remove" : modeOf(hit));
        else if (!hit.shift && !hit.control) clearSelection();
    },
    cancel() {
        loop = [];
        first.value = -1;
    },
    key(event) {
        if (event.key !== "Escape") return false;
        if (first.value >= 0) first.value = -1;
        else clearSelection();
        return true;
    },
    overlay(context, stage) {
        context.lineJoin = "round";
        if (loop.length > 1) {
            context.beginPath();
            loop.forEach((p, k) => (k ? context.lineTo(p.x, p.y) : context.moveTo(p.x, p.y)));
            context.closePath();
            context.strokeStyle = stage.theme.accent;
            context.lineWidth = 1.5;
            context.setLineDash([5, 4]);
            context.stroke();
            context.setLineDash([]);
        }
        const hit = pointer.value;
        if (hit && selectKind.value === "line" && selectedHinges.value.length === 0) drawHinges(context, hit.stage, lineAt(hit), 0.5);
    },
};

/** The outline of a panel in every view, as it is drawn: its top. */
export function drawPanel(context: CanvasRenderingContext2D, stage: Stage, panel: number): void {
    if (!stage.skins || !stage.scenes || panel < 0 || panel >= stage.skins.flat.linkage.panels) return;
    const up = new THREE.Vector3();
    context.save();
    context.strokeStyle = stage.theme.accent;
    context.lineJoin = "round";
    context.lineWidth = 1.5;
    for (const id of stage.shown) {
        const { state, rect } = stage.views[id];
        const skin = stage.skins[state];
        skin.normal(panel, up).multiplyScalar((drawn.thickness / 2) * stage.scenes[state].panels.edge);
        context.beginPath();
        context.rect(rect.x, rect.y, rect.width, rect.height);
        context.save();
        context.clip();
        context.beginPath();
        for (let k = 0; k < 3; k++) {
            const p = stage.project(stage.views[id], new THREE.Vector3().fromArray(skin.places, 3 * skin.linkage.triangles[3 * panel + k]).add(up));
            if (k) context.lineTo(p.x, p.y);
            else context.moveTo(p.x, p.y);
        }
        context.closePath();
        context.stroke();
        context.restore();
    }
    context.restore();
}

/** A sequence of hinges in every view, as a line through them. */
export function drawHinges(context: CanvasRenderingContext2D, stage: Stage, hinges: readonly number[], alpha = 1): void {
    if (!stage.skins || hinges.length === 0) return;
    context.save();
    context.globalAlpha = alpha;
    context.strokeStyle = context.fillStyle = stage.theme.accent;
    context.lineWidth = 2;
    for (const id of stage.shown) {
        const view = stage.views[id];
        const places = stage.skins[view.state].places;
        const at = hinges.map((h) => stage.project(view, new THREE.Vector3().fromArray(places, 3 * h)));
        context.save();
        context.beginPath();
        context.rect(view.rect.x, view.rect.y, view.rect.width, view.rect.height);
        context.clip();
        context.beginPath();
        at.forEach((p, k) => (k ? context.lineTo(p.x, p.y) : context.moveTo(p.x, p.y)));
        context.stroke();
        if (hinges.length < 200)
            for (const p of at) {
                context.beginPath();
                context.arc(p.x, p.y, 3, 0, 2 * Math.PI);
                context.fill();
            }
        context.restore();
    }
    context.restore();
}
