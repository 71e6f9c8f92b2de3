import { describe, expect, it } from "vitest";
import type { FieldSchema, OperatorSchema } from "../src/protocol/types";
import { type Place, handlesOf } from "../src/tools/rimhandles";

const field = (name: string, kind: FieldSchema["kind"], value: unknown = null): FieldSchema =>
    ({ name, kind, title: name, doc: "", unit: "", required: value === null, default: value, lo: null, hi: null, width: 3, choices: [] }) as FieldSchema;
const schema = (...fields: FieldSchema[]) => ({ name: "rim", fields }) as OperatorSchema;
const centre = field("centre", "vector", [0, 0, 0]);
const near = (p: readonly number[], q: readonly number[]) => p.forEach((v, k) => expect(v).toBeCloseTo(q[k], 9));

describe("handles of a boundary", () => {
    it("of a circle are its centre and a place on it; the radius is measured in its plane", () => {
        const circle = schema(field("radius", "number"), centre, field("normal", "vector", [0, 0, 1]));
        const handles = handlesOf(circle, { radius: 2, centre: [1, 0, 3] }, 5)!;
        expect(Math.hypot(...handles.points[1].map((v, k) => v - handles.points[0][k]))).toBeCloseTo(2, 12);
        for (const p of handles.curve) expect(Math.hypot(p[0] - 1, p[1])).toBeCloseTo(2, 12);
        expect(handles.move(0, [4, 5, 6])).toEqual({ centre: [4, 5, 6] });
        expect(handles.move(1, [4, 4, 9]).radius).toBeCloseTo(5, 12);
        expect(handlesOf(circle, {}, 5)).toBeNull();
    });
    it("of an ellipse keep its axes at a right angle", () => {
        const handles = handlesOf(schema(field("a", "vector"), field("b", "vector"), centre), { a: [3, 0, 0], b: [0, 2, 0] }, 5)!;
        const turned = handles.move(1, [0, 4, 0]) as { a: Place; b: Place };
        near(turned.a, [0, 4, 0]);
        near(turned.b, [-2, 0, 0]);
        near(handles.move(2, [7, 1.5, 0]).b as Place, [0, 1.5, 0]);
    });
    it("of a turned rectangle are its centre and a corner", () => {
        const handles = handlesOf(schema(field("width", "number"), field("height", "number"), field("turn", "number", 0), centre), { width: 4, height: 2, turn: 90 }, 5)!;
        near(handles.points[1], [-1, 2, 0]);
        const { width, height } = handles.move(1, [-3, 5, 0]) as { width: number; height: number };
        near([width, height], [10, 6]);
    });
    it("of a line are a place on it and where it goes; of points, these", () => {
        const line = handlesOf(schema(field("point", "vector"), field("direction", "vector")), { point: [1, 1, 0], direction: [0, 9, 0] }, 5)!;
        near(line.points[1], [1, 6, 0]);
        near(line.move(1, [3, 1, 0]).direction as Place, [2, 0, 0]);
        const spline = handlesOf(schema(field("points", "points")), { points: [[0, 0, 0], [1, 0, 0], [1, 1, 0]] }, 5)!;
        expect(spline.move(1, [2, 0, 0])).toEqual({ points: [[0, 0, 0], [2, 0, 0], [1, 1, 0]] });
    });
    it("are drawn with the curve that the solver takes: corners rounded, as far as there is room, and splines through their points", () => {
        const rectangle = schema(field("width", "number"), field("height", "number"), field("fillet", "number", 0), centre);
        const { curve } = handlesOf(rectangle, { width: 6, height: 4, fillet: 1 }, 5)!;
        for (const [x, y] of curve) {
            const [u, v] = [Math.max(0, Math.abs(x) - 2), Math.max(0, Math.abs(y) - 1)];
            expect(u && v ? Math.hypot(u, v) : Math.max(u, v)).toBeCloseTo(1, 9); // on the sides or on the arcs
        }
        const most = handlesOf(rectangle, { width: 6, height: 4, fillet: 9 }, 5)!.curve;
        expect(Math.max(...most.map((p) => Math.hypot(p[0] - 1, p[1])).filter((_, k) => most[k][0] > 1))).toBeCloseTo(2, 9);
        expect(handlesOf(rectangle, { width: 6, height: 4 }, 5)!.curve).toHaveLength(4);

        const points: Place[] = [[2, 0, 0], [0, 2, 0], [-2, 0, 0], [0, -2, 0]];
        const spline = handlesOf({ ...schema(field("points", "points")), name: "rim_spline" } as OperatorSchema, { points }, 5)!.curve;
        for (const p of points) expect(Math.min(...spline.map((q) => Math.hypot(q[0] - p[0], q[1] - p[1])))).toBeLessThan(1e-12);
        // round a square of points it keeps near the circle
        expect(Math.max(...spline.map((p) => Math.hypot(...p)))).toBeCloseTo(2, 9);
        expect(Math.min(...spline.map((p) => Math.hypot(...p)))).toBeGreaterThan(1.7);
    });
});
