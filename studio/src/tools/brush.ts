// The brush: strokes on either view, given to the operator in sheet coordinates. While the hand moves every stroke so far is a
// preview; lifting it makes one step.
import { signal } from "@preact/signals";
import * as THREE from "three";
import { apply, currentShell, operatorNamed, preview } from "../state/session";
import { boundsOf } from "../panels/linkage";
import { drawRing, ringAround } from "../scene/ring";
import type { Skin, SkinPoint } from "../scene/skin";
import { length, number } from "../ui/format";
import { argumentsOf, callOf, numberOf, setArgument, sheetRadius } from "./calls";
import { type Hit, type Tool, pointer } from "./tool";

export type BrushMode = "set" | "add" | "subtract" | "smooth";
/** The mode while a key is held; null: what the panel says. */
const held = signal<BrushMode | null>(null);

let stroke: [number, number][] = [];
let drawing = false;
/** F or Shift F: the pointer's way sets radius or strength. */
let sizing: { name: "radius" | "strength"; from: number; x: number } | null = null;
let restTimer: ReturnType<typeof setTimeout> | undefined;
export const resting = signal(false);

export const brushRadius = () => numberOf("paint", "radius", 0.15 * sheetRadius());
export const brushStrength = () => numberOf("paint", "strength", 1);
export const brushValue = () => numberOf("paint", "value", (argumentsOf("paint").mode ?? "set") === "set" ? 1.6 : 0.1);

export function brushMode(): BrushMode {
    return held.value ?? (argumentsOf("paint").mode as BrushMode | undefined) ?? "set";
}

/** Ctrl subtracts and Shift smooths, as in Blender. */
function heldBy(hit: Hit): BrushMode | null {
    return hit.control ? "subtract" : hit.shift ? "smooth" : null;
}

function call() {
    const schema = operatorNamed("paint");
    if (!schema) return null;
    const mode = brushMode();
    return callOf(schema, { points: stroke, radius: brushRadius(), mode, value: mode === "smooth" ? null : amount(mode) });
}

/** Held down for a moment, subtracting takes a tenth unless the panel says how much. */
function amount(mode: BrushMode): number {
    return held.value === "subtract" && (argumentsOf("paint").mode ?? "set") === "set" && mode === "subtract" ? 0.1 : brushValue();
}

function add(hit: Hit): boolean {
    if (!hit.on || !hit.stage.skins) return false;
    const p = hit.stage.skins.sheet.carry(hit.on, new THREE.Vector3());
    const last = stroke.at(-1);
    if (last && Math.hypot(last[0] - p.x, last[1] - p.y) < 0.02 * brushRadius()) return false;
    stroke.push([round(p.x), round(p.y)]);
    return true;
}

/** Five digits of the radius are far below what a hand can mean and keep recipes readable. */
function round(v: number): number {
    const step = 10 ** Math.floor(Math.log10(brushRadius()) - 4);
    return Number((Math.round(v / step) * step).toPrecision(12));
}

/** The pointer's place and those that symmetry makes of it, as the operator does: mirrored in a line through the centre, then turned. */
function copiesOf(sheet: Skin, on: SkinPoint): SkinPoint[] {
    const args = argumentsOf("paint");
    const fields = operatorNamed("paint")?.fields ?? [];
    const value = (name: string) => args[name] ?? fields.find((f) => f.name === name)?.default;
    const folds = Math.max(1, Number(value("copies") ?? 1));
    const mirror = value("mirror") === true;
    if (folds === 1 && !mirror) return [on];
    const given = value("centre") as number[] | null | undefined;
    const { min, max } = boundsOf(sheet.places);
    const [x0, y0] = Array.isArray(given) ? given : [(min[0] + max[0]) / 2, (min[1] + max[1]) / 2];
    const p = sheet.carry(on, new THREE.Vector3());
    const twice = (2 * Number(value("mirror_angle") ?? 0) * Math.PI) / 180;
    const places = [[p.x - x0, p.y - y0]];
    if (mirror) places.push([Math.cos(twice) * places[0][0] + Math.sin(twice) * places[0][1], Math.sin(twice) * places[0][0] - Math.cos(twice) * places[0][1]]);
    const found = [on];
    for (let k = 0; k < folds; k++)
        for (const [j, [x, y]] of places.entries()) {
            if (k === 0 && j === 0) continue;
            const [c, s] = [Math.cos((2 * Math.PI * k) / folds), Math.sin((2 * Math.PI * k) / folds)];
            const at = sheet.nearest(new THREE.Vector3(x0 + c * x - s * y, y0 + s * x + c * y, 0));
            if (at) found.push(at);
        }
    return found;
}

export const brush: Tool = {
    id: "brush", title: "Brush", icon: "brush", shortcut: "B", cursor: "none",
    reach: brushRadius,
    down(hit) {
        if (sizing) {
            sizing = null;
            return false;
        }
        held.value = heldBy(hit);
        stroke = [];
        if (!add(hit)) return false;
        drawing = true;
        const operator = call();
        if (operator) preview(operator);
        return true;
    },
    move(hit, dragging) {
        clearTimeout(restTimer);
        resting.value = false;
        if (sizing) {
            const d = hit.x - sizing.x;
            const range = sizing.name === "radius" ? sheetRadius() : 1;
            const v = Math.max(range * 0.01, sizing.from + (d / 300) * range);
            setArgument("paint", sizing.name, Number((sizing.name === "strength" ? Math.min(1, v) : v).toPrecision(3)));
        } else if (dragging && drawing && add(hit)) {
            const operator = call();
            if (operator) preview(operator);
            restTimer = setTimeout(() => (resting.value = true), 400);
        } else if (!dragging) held.value = heldBy(hit);
        hit.stage.invalidateOverlay();
    },
    up() {
        if (!drawing) return;
        drawing = false;
        resting.value = false;
        const operator = call();
        stroke = [];
        if (operator) void apply(operator);
    },
    cancel() {
        drawing = false;
        sizing = null;
        stroke = [];
        preview(null);
    },
    leave() {
        pointer.value?.stage.invalidateOverlay();
    },
    key(event) {
        const hit = pointer.value;
        if (event.key.toLowerCase() === "f" && hit && !event.ctrlKey && !event.metaKey) {
            const name = event.shiftKey ? "strength" : "radius";
            sizing = { name, from: name === "radius" ? brushRadius() : brushStrength(), x: hit.x };
            return true;
        }
        if (event.key === "[" || event.key === "]") {
            setArgument("paint", "radius", Number((brushRadius() * (event.key === "]" ? 1.1 : 1 / 1.1)).toPrecision(3)));
            hit?.stage.invalidateOverlay();
            return true;
        }
        if (event.key === "Escape" && sizing) {
            setArgument("paint", sizing.name, sizing.from);
            sizing = null;
            return true;
        }
        return false;
    },
    overlay(context, stage) {
        const hit = pointer.value;
        if (!hit?.on || !stage.skins) return;
        for (const [k, at] of copiesOf(stage.skins.sheet, hit.on).entries()) {
            const ring = ringAround(stage, at, brushRadius());
            if (!ring) continue;
            for (const id of stage.shown)
                drawRing(context, stage, stage.views[id], ring, { inner: 0.5 * brushStrength(), dashed: brushMode() === "smooth", minus: brushMode() === "subtract", weight: k ? 0.5 : 1 });
        }
    },
    tag(hit) {
        const shell = currentShell();
        if (!hit.on || !shell) return null;
        const mode = brushMode();
        const now = number(shell.prescribed[hit.panel] ?? shell.realised[hit.panel], 2);
        return {
            strong: mode === "smooth" ? "Smooth" : mode === "set" ? `λ ${number(brushValue(), 2)}` : `λ ${mode === "add" ? "+" : "−"}${number(amount(mode), 2)}`,
            rest: `now ${now}, ${length(brushRadius(), (shell.unit as "m") ?? "m")}`,
        };
    },
};
