// Measuring: straight distance, and along the shell where both ends lie on it. A third click begins anew.
import { signal } from "@preact/signals";
import * as THREE from "three";
import { shortestWay } from "../panels/lines";
import { currentShell } from "../state/session";
import { length } from "../ui/format";
import type { SkinPoint } from "../scene/skin";
import type { StateId } from "../scene/stage";
import { type Tool, pointer } from "./tool";

interface End {
    on: SkinPoint;
    hinge: number;
    state: StateId;
}
const ends = signal<End[]>([]);

export interface Measured {
    straight: number;
    along: number;
    dx: number;
    dy: number;
    dz: number;
}

export function measured(): Measured | null {
    const shell = currentShell();
    const stage = pointer.value?.stage;
    if (!shell || !stage?.skins || ends.value.length < 2) return null;
    const [a, b] = ends.value;
    const skin = stage.skins[a.state];
    const p = skin.carry(a.on, new THREE.Vector3());
    const q = skin.carry(b.on, new THREE.Vector3());
    const way = shortestWay(shell.linkage, shell.sheet, a.hinge, b.hinge);
    let along = 0;
    for (let k = 1; k < way.length; k++)
        along += new THREE.Vector3().fromArray(skin.places, 3 * way[k]).distanceTo(new THREE.Vector3().fromArray(skin.places, 3 * way[k - 1]));
    return { straight: p.distanceTo(q), along, dx: q.x - p.x, dy: q.y - p.y, dz: q.z - p.z };
}

export const measureCount = () => ends.value.length;

export const measure: Tool = {
    id: "measure", title: "Measure", icon: "measure", shortcut: "M", cursor: "crosshair",
    down: (hit) => hit.on !== null,
    up(hit) {
        const skin = hit.stage.skins?.[hit.view.state];
        if (!hit.on || !skin) return;
        const end = { on: hit.on, hinge: skin.hingeAt(hit.on), state: hit.view.state };
        ends.value = ends.value.length === 1 && ends.value[0].state === end.state ? [...ends.value, end] : [end];
        hit.stage.invalidateOverlay();
    },
    cancel: () => (ends.value = []),
    key(event) {
        if (event.key !== "Escape") return false;
        ends.value = [];
        pointer.value?.stage.invalidateOverlay();
        return true;
    },
    overlay(context, stage) {
        const shell = currentShell();
        if (!stage.skins || !shell || ends.value.length === 0) return;
        const [a, b] = ends.value;
        const skin = stage.skins[a.state];
        for (const id of stage.shown) {
            const view = stage.views[id];
            if (view.state !== a.state) continue;
            const p = stage.project(view, skin.carry(a.on, new THREE.Vector3()));
            const hit = pointer.value;
            const q = b ? stage.project(view, skin.carry(b.on, new THREE.Vector3())) : hit && hit.view === view ? { x: hit.x, y: hit.y } : null;
            context.strokeStyle = context.fillStyle = stage.theme.ink;
            context.lineWidth = 1.5;
            for (const e of q ? [p, q] : [p]) {
                context.beginPath();
                context.arc(e.x, e.y, 3.5, 0, 2 * Math.PI);
                context.fill();
            }
            if (!q) continue;
            context.beginPath();
            context.moveTo(p.x, p.y);
            context.lineTo(q.x, q.y);
            context.stroke();
            const m = measured();
            if (m) {
                const text = length(m.straight, shell.unit as "m");
                context.font = '600 12px "Inter Variable", sans-serif';
                const w = context.measureText(text).width + 16;
                const [x, y] = [(p.x + q.x) / 2, (p.y + q.y) / 2];
                context.beginPath();
                context.roundRect(x - w / 2, y - 12, w, 24, 6);
                context.fill();
                context.fillStyle = stage.theme.dark ? "#14171b" : "#fff";
                context.textAlign = "center";
                context.textBaseline = "middle";
                context.fillText(text, x, y + 0.5);
            }
        }
    },
};
