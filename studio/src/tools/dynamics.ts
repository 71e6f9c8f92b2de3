// Grabbing a hinge while the solver runs: it follows the pointer in the plane that faces the view.
import { signal } from "@preact/signals";
import * as THREE from "three";
import { currentShell, grab, release } from "../state/session";
import { type Hit, type Tool } from "./tool";

export const grabbed = signal<{ hinge: number; to: THREE.Vector3 } | null>(null);
let plane: THREE.Plane | null = null;

function placeOn(hit: Hit): THREE.Vector3 | null {
    return plane ? hit.stage.ray(hit.view, hit.x, hit.y).intersectPlane(plane, new THREE.Vector3()) : null;
}

function send(): void {
    const shell = currentShell();
    const g = grabbed.value;
    if (shell && g) grab(g.hinge, [g.to.x + shell.origin[0], g.to.y + shell.origin[1], g.to.z + shell.origin[2]]);
}

export const dynamics: Tool = {
    id: "dynamics", title: "Dynamics", icon: "move", shortcut: "D", cursor: "grab",
    down(hit) {
        const skin = hit.stage.skins?.space;
        if (!hit.on || !skin || hit.view.state !== "space") return false;
        const hinge = skin.hingeAt(hit.on);
        const at = new THREE.Vector3().fromArray(skin.places, 3 * hinge);
        plane = new THREE.Plane().setFromNormalAndCoplanarPoint(hit.view.orbit.camera.getWorldDirection(new THREE.Vector3()), at);
        grabbed.value = { hinge, to: at };
        send();
        return true;
    },
    move(hit, dragging) {
        if (!dragging || !grabbed.value) return;
        const to = placeOn(hit);
        if (!to) return;
        grabbed.value = { hinge: grabbed.value.hinge, to };
        send();
        hit.stage.invalidateOverlay();
    },
    up(hit) {
        grabbed.value = null;
        plane = null;
        release();
        hit.stage.invalidateOverlay();
    },
    cancel() {
        grabbed.value = null;
        plane = null;
        release();
    },
    overlay(context, stage) {
        const g = grabbed.value;
        if (!g || !stage.skins) return;
        for (const id of stage.shown) {
            const view = stage.views[id];
            if (view.state !== "space") continue;
            const p = stage.project(view, g.to);
            const h = stage.project(view, new THREE.Vector3().fromArray(stage.skins.space.places, 3 * g.hinge));
            context.strokeStyle = stage.theme.accent;
            context.lineWidth = 2;
            context.beginPath();
            context.moveTo(h.x, h.y);
            context.lineTo(p.x, p.y);
            context.stroke();
            context.beginPath();
            context.arc(p.x, p.y, 7, 0, 2 * Math.PI);
            context.stroke();
        }
    },
    tag: (hit) => (hit.view.state === "space" && hit.on ? { strong: "Pull", rest: "a hinge while it runs" } : null),
};
