// Curves as the solver takes them, as points to be drawn: rounded corners and splines.
import { type Place, add, dot, size, unit } from "./vectors";

const ring = (points: Place[], k: number) => points[(k + points.length) % points.length];
const between = (p: Place, q: Place) => add(q, p, -1);

/** Straight sides, corners rounded by arcs of this radius, or of as much as half the shorter side has room for. */
export function roundedCurve(points: Place[], closed: boolean, radius: number, cuts = 12): Place[] {
    if (!(radius > 0) || points.length < 3) return points;
    return points.flatMap((b, k): Place[] => {
        if (!closed && (k === 0 || k === points.length - 1)) return [b];
        const [toA, toC] = [between(b, ring(points, k - 1)), between(b, ring(points, k + 1))];
        const [u, v] = [unit(toA), unit(toC)];
        const turn = Math.acos(Math.max(-1, Math.min(1, -dot(u, v))));
        if (turn < 1e-6 || turn > Math.PI - 1e-6) return [b];
        const cut = Math.min(radius * Math.tan(turn / 2), Math.min(size(toA), size(toC)) / 2);
        const r = cut / Math.tan(turn / 2);
        const centre = add(b, unit(add(u, v)), r / Math.cos(turn / 2));
        // from one tangent point to the other, about the centre
        const [from, to] = [between(centre, add(b, u, cut)), between(centre, add(b, v, cut))];
        return Array.from({ length: cuts + 1 }, (_, i) => {
            const [p, q] = [Math.sin(turn * (1 - i / cuts)), Math.sin((turn * i) / cuts)];
            return add(add(centre, from, p / Math.sin(turn)), to, q / Math.sin(turn));
        });
    });
}

/** Through the points, with knots a square root of the distance apart. */
export function splineCurve(points: Place[], closed: boolean, cuts = 12): Place[] {
    const n = points.length;
    if (n < 3) return points;
    const tangent = (a: Place, b: Place, c: Place, span: number): Place => {
        const [s, t] = [Math.sqrt(size(between(a, b))) || 1e-9, Math.sqrt(size(between(b, c))) || 1e-9];
        return [0, 1, 2].map((i) => span * ((b[i] - a[i]) / s - (c[i] - a[i]) / (s + t) + (c[i] - b[i]) / t)) as Place;
    };
    const pieces = closed ? n : n - 1;
    const curve: Place[] = [];
    for (let k = 0; k < pieces; k++) {
        const [b, c] = [points[k], ring(points, k + 1)];
        // an open end is gone on from by its mirror image
        const before = closed || k > 0 ? ring(points, k - 1) : add(add([0, 0, 0], b, 2), c, -1);
        const after = closed || k + 2 < n ? ring(points, k + 2) : add(add([0, 0, 0], c, 2), b, -1);
        const span = Math.sqrt(size(between(b, c)));
        const [m, w] = [tangent(before, b, c, span), tangent(b, c, after, span)];
        for (let i = 0; i < cuts; i++) {
            const t = i / cuts;
            const [h0, h1, h2, h3] = [(1 + 2 * t) * (1 - t) ** 2, t * (1 - t) ** 2, t * t * (3 - 2 * t), t * t * (t - 1)];
            curve.push([0, 1, 2].map((j) => h0 * b[j] + h1 * m[j] + h2 * c[j] + h3 * w[j]) as Place);
        }
    }
    return closed ? curve : [...curve, points[n - 1]];
}
