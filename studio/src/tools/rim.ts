// The boundary: an operator that holds the rim, with handles on the deployed views that stand for its fields. Dragging moves a
// handle in the plane that faces the view, or along an axis with X, Y or Z; it snaps to grid, hinges and the other handles
// unless Ctrl is held.
import { signal } from "@preact/signals";
import * as THREE from "three";
import { niceBelow } from "../panels/colour";
import type { OperatorSchema } from "../protocol/types";
import type { Stage, View } from "../scene/stage";
import { apply, currentShell, documentState, operatorNamed, operators, preview } from "../state/session";
import { type Arguments, argumentsOf, callOf, resetArguments, setArgument, sheetRadius } from "./calls";
import { type Handles, handlesOf, pointsField } from "./rimhandles";
import { type Hit, type Tool, pointer } from "./tool";

export const rimOp = signal("");
export const activePoint = signal(-1);
export const snapping = signal(true);
let axis: 0 | 1 | 2 | null = null;
let dragging: { plane: THREE.Plane; from: THREE.Vector3 } | null = null;
let snapped: THREE.Vector3 | null = null;

export const boundaryOperators = (): OperatorSchema[] => operators.value.filter((o) => o.group === "boundary");
/** The applied step that holds the rim now, of one operator or of any. */
function rimStep(op?: string) {
    const d = documentState.value;
    const names = boundaryOperators().map((o) => o.name);
    return d?.steps.slice(0, d.at).map((s) => s.operator).filter((o) => (op ? o.op === op : names.includes(o.op))).at(-1);
}

export const rimSchema = () => operatorNamed(rimOp.value) ?? operatorNamed(rimStep()?.op ?? "rim_circle") ?? boundaryOperators()[0];

/** What the operator's fields are: as the document has them, but for what the user set since. */
export function rimArguments(schema: OperatorSchema): Arguments {
    const { op: _, ...step } = rimStep(schema.name) ?? { op: "" };
    return { ...step, ...argumentsOf(schema.name) };
}

export function rimHandles(): Handles | null {
    const schema = rimSchema();
    return schema ? handlesOf(schema, rimArguments(schema), sheetRadius()) : null;
}

export const rimPoints = (): [number, number, number][] => rimHandles()?.points ?? [];

/** One step of what is set; from then on the fields are the document's again. */
export async function applyRim(): Promise<void> {
    const schema = rimSchema();
    const operator = rimCall();
    if (schema && operator && (await apply(operator))) resetArguments(schema.name);
}

function moveHandle(k: number, to: [number, number, number]): void {
    const schema = rimSchema();
    const changed = schema && rimHandles()?.move(k, to);
    if (!changed) return;
    for (const [name, value] of Object.entries(changed)) setArgument(schema.name, name, typeof value === "number" ? tidy(value) : name === "points" ? value : (value as number[]).map(tidy));
    previewRim();
}

export function setRimPoints(points: [number, number, number][]): void {
    const schema = rimSchema();
    const field = pointsField(schema);
    if (schema && field) setArgument(schema.name, field.name, points);
}

export function rimCall() {
    const schema = rimSchema();
    return schema ? callOf(schema, rimArguments(schema)) : null;
}

export function previewRim(): void {
    const operator = rimCall();
    if (operator) preview(operator);
}

/** Control points from the rim as it is: its curve's own, or as many hinges evenly round it as asked. */
export function pointsFromRim(count: number): [number, number, number][] {
    const shell = currentShell();
    if (!shell) return [];
    const curve = documentState.value?.rim.find((r) => r.curve && (r.curve.kind === "spline" || r.curve.kind === "polyline"))?.curve;
    if (curve && curve.points.length === count) return curve.points;
    const rim = rimLoop();
    const places = shell.deployed;
    return Array.from({ length: Math.min(count, rim.length) }, (_, k) => {
        const h = 3 * rim[Math.floor((k * rim.length) / count)];
        return [0, 1, 2].map((i) => tidy(places[h + i] + shell.origin[i])) as [number, number, number];
    });
}

/** Rim hinges by angle about the middle: enough for handles, whose order the user sees. */
function rimLoop(): number[] {
    const shell = currentShell()!;
    const rim: number[] = [];
    shell.onRim.forEach((on, h) => on && rim.push(h));
    let [x, y] = [0, 0];
    for (const h of rim) {
        x += shell.sheet[3 * h] / rim.length;
        y += shell.sheet[3 * h + 1] / rim.length;
    }
    const angle = (h: number) => Math.atan2(shell.sheet[3 * h + 1] - y, shell.sheet[3 * h] - x);
    return rim.sort((a, b) => angle(a) - angle(b));
}

function tidy(v: number): number {
    const shell = currentShell();
    const step = 10 ** Math.floor(Math.log10((shell?.spacing ?? 1) / 100));
    return Number((Math.round(v / step) * step).toPrecision(10));
}

const local = (p: readonly number[]) => {
    const o = currentShell()!.origin;
    return new THREE.Vector3(p[0] - o[0], p[1] - o[1], p[2] - o[2]);
};

function handleAt(stage: Stage, view: View, x: number, y: number): number {
    let best = -1;
    let least = 14;
    rimPoints().forEach((p, k) => {
        const s = stage.project(view, local(p));
        const d = Math.hypot(s.x - x, s.y - y);
        if (d < least) {
            least = d;
            best = k;
        }
    });
    return best;
}

/** Snaps to other handles and rim hinges within 12 pixels, then to the grid. */
function snap(hit: Hit, place: THREE.Vector3): THREE.Vector3 {
    snapped = null;
    const shell = currentShell();
    if (!snapping.value || hit.control || !shell || axis !== null) return place;
    const at = hit.stage.project(hit.view, place);
    let least = 12;
    const offer = (q: THREE.Vector3) => {
        const s = hit.stage.project(hit.view, q);
        const d = Math.hypot(s.x - at.x, s.y - at.y);
        if (d < least) {
            least = d;
            snapped = q;
        }
    };
    rimPoints().forEach((p, k) => k !== activePoint.value && offer(local(p)));
    const skin = hit.stage.skins!.space;
    shell.onRim.forEach((on, h) => on && offer(new THREE.Vector3().fromArray(skin.places, 3 * h)));
    if (snapped) return (snapped as THREE.Vector3).clone();
    const step = niceBelow(shell.spacing / 2);
    return new THREE.Vector3(...place.toArray().map((v, k) => Math.round((v + shell.origin[k]) / step) * step - shell.origin[k]));
}

export const rim: Tool = {
    id: "rim", title: "Boundary", icon: "rim", shortcut: "C", cursor: "default",
    down(hit) {
        if (hit.view.state !== "space") return false;
        const k = handleAt(hit.stage, hit.view, hit.x, hit.y);
        activePoint.value = k;
        if (k < 0) {
            // a double click on the curve puts a handle there
            if (hit.double && hit.on && pointsField(rimSchema()) && rimPoints().length) insertNear(hit);
            hit.stage.invalidateOverlay();
            return false;
        }
        const from = local(rimPoints()[k]);
        dragging = { plane: new THREE.Plane().setFromNormalAndCoplanarPoint(hit.view.orbit.camera.getWorldDirection(new THREE.Vector3()), from), from };
        axis = null;
        return true;
    },
    move(hit, pressed) {
        if (!pressed || !dragging || activePoint.value < 0) return;
        const to = hit.stage.ray(hit.view, hit.x, hit.y).intersectPlane(dragging.plane, new THREE.Vector3());
        if (!to) return;
        if (axis !== null) for (const k of [0, 1, 2] as const) if (k !== axis) to.setComponent(k, dragging.from.getComponent(k));
        const place = snap(hit, to);
        const o = currentShell()!.origin;
        moveHandle(activePoint.value, [tidy(place.x + o[0]), tidy(place.y + o[1]), tidy(place.z + o[2])]);
        hit.stage.invalidateOverlay();
    },
    up(hit) {
        if (!dragging) return;
        dragging = null;
        snapped = null;
        hit.stage.invalidateOverlay();
        void applyRim();
    },
    cancel() {
        dragging = null;
        snapped = null;
        preview(null);
    },
    key(event) {
        const k = ["x", "y", "z"].indexOf(event.key.toLowerCase());
        if (dragging && k >= 0) {
            axis = axis === k ? null : (k as 0 | 1 | 2);
            return true;
        }
        if ((event.key === "Delete" || event.key === "Backspace") && activePoint.value >= 0 && pointsField(rimSchema()) && rimPoints().length > 3) {
            setRimPoints(rimPoints().filter((_, i) => i !== activePoint.value));
            activePoint.value = -1;
            pointer.value?.stage.invalidateOverlay();
            return true;
        }
        return false;
    },
    overlay(context, stage) {
        const handles = rimHandles();
        if (!handles || !stage.skins || !currentShell()) return;
        for (const id of stage.shown) {
            const view = stage.views[id];
            if (view.state !== "space") continue;
            const at = handles.points.map((p) => stage.project(view, local(p)));
            const curve = handles.curve.map((p) => stage.project(view, local(p)));
            context.save();
            context.beginPath();
            context.rect(view.rect.x, view.rect.y, view.rect.width, view.rect.height);
            context.clip();
            context.setLineDash([4, 4]);
            context.strokeStyle = stage.theme.ink;
            context.lineWidth = 1;
            context.beginPath();
            curve.forEach((p, k) => (k ? context.lineTo(p.x, p.y) : context.moveTo(p.x, p.y)));
            if (handles.closed) context.closePath();
            context.stroke();
            context.setLineDash([]);
            at.forEach((p, k) => {
                context.beginPath();
                context.rect(p.x - 5, p.y - 5, 10, 10);
                context.fillStyle = k === activePoint.value ? stage.theme.accent : stage.theme.dark ? "#181b20" : "#fff";
                context.fill();
                context.lineWidth = 1.5;
                context.strokeStyle = k === activePoint.value ? stage.theme.accent : stage.theme.ink;
                context.stroke();
            });
            if (snapped) {
                const s = stage.project(view, snapped);
                context.beginPath();
                context.arc(s.x, s.y, 10, 0, 2 * Math.PI);
                context.strokeStyle = stage.theme.accent;
                context.stroke();
            }
            context.restore();
        }
    },
    tag: (hit) => (dragging ? { strong: axis === null ? "Free" : `Along ${"XYZ"[axis]}`, rest: snapped ? "on a hinge" : "X, Y, Z hold an axis" } : handleAt(hit.stage, hit.view, hit.x, hit.y) >= 0 ? { strong: rimHandles()!.names[handleAt(hit.stage, hit.view, hit.x, hit.y)], rest: "drag to move" } : null),
};

function insertNear(hit: Hit): void {
    const points = rimPoints();
    const p = hit.on!.point;
    let best = 0;
    let least = Infinity;
    points.forEach((a, k) => {
        const b = points[(k + 1) % points.length];
        const d = new THREE.Line3(local(a), local(b)).closestPointToPoint(p, true, new THREE.Vector3()).distanceTo(p);
        if (d < least) {
            least = d;
            best = k;
        }
    });
    const o = currentShell()!.origin;
    setRimPoints([...points.slice(0, best + 1), [tidy(p.x + o[0]), tidy(p.y + o[1]), tidy(p.z + o[2])], ...points.slice(best + 1)]);
    activePoint.value = best + 1;
}
