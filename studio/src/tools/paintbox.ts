// Tools that set scale factors besides the brush: fill, gradient, smooth, eyedropper.
import { signal } from "@preact/signals";
import * as THREE from "three";
import { apply, currentShell, operatorNamed, preview } from "../state/session";
import { selectionWords } from "../state/selection";
import { number } from "../ui/format";
import { argumentsOf, callOf, numberOf, setArgument, sheetRadius } from "./calls";
import { type Hit, type Tool, toolId } from "./tool";

/** Where the selection confines an operator that knows regions. */
const region = () => (selectionWords.value ? { hinges: selectionWords.value } : {});

export const fillValue = () => numberOf("fill", "value", 1.5);
export const smoothAmount = () => numberOf("smooth", "amount", Number((0.1 * sheetRadius()).toPrecision(2)));

export function fillCall() {
    const schema = operatorNamed("fill");
    return schema ? callOf(schema, { ...region(), ...argumentsOf("fill"), value: fillValue() }) : null;
}

export function smoothCall() {
    const schema = operatorNamed("smooth");
    return schema ? callOf(schema, { ...region(), ...argumentsOf("smooth"), amount: smoothAmount() }) : null;
}

const applyAt = (call: () => ReturnType<typeof fillCall>): Pick<Tool, "down" | "up"> => ({
    down: (hit) => hit.on !== null,
    up: () => {
        const operator = call();
        if (operator) void apply(operator);
    },
});

export const fill: Tool = {
    id: "fill", title: "Fill", icon: "fill", shortcut: "U", cursor: "crosshair",
    ...applyAt(fillCall),
    tag: (hit) => (hit.on ? { strong: `Fill λ ${number(fillValue(), 2)}`, rest: selectionWords.value ? "the selection" : "everything" } : null),
};

export const smooth: Tool = {
    id: "smooth", title: "Smooth", icon: "smooth", shortcut: "S", cursor: "crosshair",
    ...applyAt(smoothCall),
    tag: (hit) => (hit.on ? { strong: "Smooth", rest: selectionWords.value ? "the selection" : "everything" } : null),
};

export const gradientKind = signal<"linear" | "radial">("linear");
let from: [number, number] | null = null;
let to: [number, number] | null = null;
let ends: { hit: Hit; start: THREE.Vector3 } | null = null;

const onSheet = (hit: Hit): [number, number] | null => {
    if (!hit.on || !hit.stage.skins) return null;
    const p = hit.stage.skins.sheet.carry(hit.on, new THREE.Vector3());
    return [Number(p.x.toPrecision(6)), Number(p.y.toPrecision(6))];
};

function gradientCall() {
    const radial = gradientKind.value === "radial";
    const schema = operatorNamed(radial ? "gradient_radial" : "gradient_linear");
    if (!schema || !from || !to) return null;
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (length < 1e-3 * sheetRadius()) return null;
    const given = argumentsOf(schema.name);
    return callOf(schema, radial ? { inner: 1.6, outer: 1.2, ...region(), ...given, centre: from, radius: Number(length.toPrecision(4)) }
        : { from_value: 1.2, to_value: 1.6, ...region(), ...given, from, to });
}

export const gradient: Tool = {
    id: "gradient", title: "Gradient", icon: "gradient", shortcut: "G", cursor: "crosshair",
    down(hit) {
        from = to = onSheet(hit);
        ends = from && hit.on ? { hit, start: hit.on.point } : null;
        return from !== null;
    },
    move(hit, dragging) {
        if (!dragging || !from) return;
        to = onSheet(hit) ?? to;
        if (ends) ends.hit = hit;
        const operator = gradientCall();
        if (operator) preview(operator);
        hit.stage.invalidateOverlay();
    },
    up(hit) {
        const operator = gradientCall();
        from = to = ends = null;
        hit.stage.invalidateOverlay();
        if (operator) void apply(operator);
    },
    cancel() {
        from = to = ends = null;
        preview(null);
    },
    overlay(context, stage) {
        if (!ends) return;
        const a = stage.project(ends.hit.view, ends.start);
        const b = ends.hit;
        for (const [width, colour] of [[4.5, "rgb(0 0 0 / 0.6)"], [2, "#fff"]] as const) {
            context.beginPath();
            context.moveTo(a.x, a.y);
            context.lineTo(b.x, b.y);
            context.lineWidth = width;
            context.strokeStyle = colour;
            context.stroke();
            for (const p of [a, b]) {
                context.beginPath();
                context.arc(p.x, p.y, 5, 0, 2 * Math.PI);
                context.stroke();
            }
        }
    },
};

export const pipette: Tool = {
    id: "pipette", title: "Eyedropper", icon: "pipette", shortcut: "I", cursor: "crosshair",
    down: (hit) => hit.panel >= 0,
    up(hit) {
        const shell = currentShell();
        if (!shell || hit.panel < 0) return;
        const value = Number(shell.prescribed[hit.panel].toFixed(3));
        setArgument("paint", "value", value);
        setArgument("fill", "value", value);
        toolId.value = "brush";
    },
    tag(hit) {
        const shell = currentShell();
        return shell && hit.panel >= 0 ? { strong: `λ ${number(shell.prescribed[hit.panel], 3)}`, rest: `asked, ${number(shell.realised[hit.panel], 3)} reached` } : null;
    },
};
