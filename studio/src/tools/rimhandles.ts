// The handles of a boundary: places that stand for its operator's fields, whatever curve it is. Dragging one gives the fields anew.
import type { FieldSchema, OperatorSchema } from "../protocol/types";
import { type Arguments, valueOf } from "./calls";
import { roundedCurve, splineCurve } from "./curves";
import { type Place, add, cross, dot, size, unit } from "./vectors";

export type { Place };
export interface Handles {
    points: Place[];
    names: string[];
    /** The curve that they stand for, to be drawn. */
    curve: Place[];
    closed: boolean;
    move(k: number, to: Place): Arguments;
}

const round = (a: Place, b: Place, centre: Place, n = 64): Place[] =>
    Array.from({ length: n }, (_, k) => add(add(centre, a, Math.cos((2 * Math.PI * k) / n)), b, Math.sin((2 * Math.PI * k) / n)));

/** The field that holds the curve's points in space, if the operator has one. */
export function pointsField(schema: OperatorSchema | undefined): FieldSchema | undefined {
    return schema?.fields.find((f) => f.kind === "points" && f.width === 3 && f.required);
}

/** `reach`: about the size of the shell, for what has no length of its own. Null: there is nothing to take hold of yet. */
export function handlesOf(schema: OperatorSchema, args: Arguments, reach: number): Handles | null {
    const field = (name: string) => schema.fields.find((f) => f.name === name);
    const place = (name: string) => (field(name) ? ((valueOf(args, field(name)!) as Place | null | undefined) ?? null) : null);
    const figure = (name: string) => (field(name) ? ((valueOf(args, field(name)!) as number | null | undefined) ?? null) : null);
    const listed = pointsField(schema);
    if (listed) {
        const points = (args[listed.name] as Place[] | undefined) ?? [];
        const closed = valueOf(args, field("closed") ?? listed) !== false;
        const curve = schema.name.endsWith("spline") ? splineCurve(points, closed) : roundedCurve(points, closed, figure("fillet") ?? 0);
        return points.length ? { points, names: points.map((_, k) => `Point ${k + 1}`), curve, closed, move: (k, to) => ({ [listed.name]: points.map((p, j) => (j === k ? to : p)) }) } : null;
    }
    const centre = place("centre");
    const radius = figure("radius");
    if (centre && radius) {
        const normal = unit(place("normal") ?? [0, 0, 1]);
        const u = unit(cross(Math.abs(normal[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], normal));
        const a: Place = add([0, 0, 0], cross(u, normal), radius);
        return {
            points: [centre, add(centre, a)], names: ["Centre", "Radius"], curve: round(a, add([0, 0, 0], u, radius), centre), closed: true,
            move: (k, to) => (k === 0 ? { centre: to } : { radius: size(add(add(to, centre, -1), normal, -dot(add(to, centre, -1), normal))) }),
        };
    }
    const [a, b] = [place("a"), place("b")];
    if (centre && a && b)
        return {
            points: [centre, add(centre, a), add(centre, b)], names: ["Centre", "First axis", "Second axis"], curve: round(a, b, centre), closed: true,
            move(k, to) {
                if (k === 0) return { centre: to };
                const d = add(to, centre, -1);
                // the axes stay at a right angle: the second turns with the first, and changes its length alone
                return k === 1 ? { a: d, b: add([0, 0, 0], unit(cross(cross(a, b), d)), size(b)) } : { b: add([0, 0, 0], unit(b), Math.abs(dot(d, unit(b)))) };
            },
        };
    const [width, height] = [figure("width"), figure("height")];
    if (centre && width && height) {
        const turn = ((figure("turn") ?? 0) * Math.PI) / 180;
        const x: Place = [Math.cos(turn), Math.sin(turn), 0];
        const y: Place = [-Math.sin(turn), Math.cos(turn), 0];
        const corner = (i: number, j: number) => add(add(centre, x, (i * width) / 2), y, (j * height) / 2);
        return {
            points: [centre, corner(1, 1)], names: ["Centre", "Corner"], closed: true,
            curve: roundedCurve([corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1)], true, figure("fillet") ?? 0),
            move: (k, to) => (k === 0 ? { centre: to } : { width: 2 * Math.abs(dot(add(to, centre, -1), x)), height: 2 * Math.abs(dot(add(to, centre, -1), y)) }),
        };
    }
    const [point, direction] = [place("point"), place("direction")];
    if (point && direction) {
        const end = add(point, unit(direction), reach);
        return {
            points: [point, end], names: ["Point", "Direction"], curve: [add(point, unit(direction), -reach), end], closed: false,
            move: (k, to) => (k === 0 ? { point: to } : { direction: add(to, point, -1) }),
        };
    }
    return null;
}
