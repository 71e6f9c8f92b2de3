// The panel as a template in barycentric coordinates, placed by the vertex shader from three corners per instance: a frame of
// the solver moves 9 numbers per panel, whatever the panel's level of detail.

/** Sizes over the median panel edge, as drawn. */
export const drawn = { thickness: 0.11, inset: 0.015, clip: 0.075, bevel: 0.022, jointRadius: 0.07, jointHeight: 0.12 };

export interface Template {
    /** Barycentric weights, 3 per vertex. */
    bary: Float32Array;
    /** x: height, 0 underside to 1 top; y: share of the bevel's drop; z: kind of face, 0 top, 1 bevel, 2 side, 3 underside. */
    level: Float32Array;
    /** Barycentric direction outwards and along the outline, 3 + 3 per vertex: sides and bevel take their normals from them. */
    outward: Float32Array;
    along: Float32Array;
    index: Uint16Array;
}

export type Detail = "full" | "prism" | "flat";

const perHeight = 2 / Math.sqrt(3); // an edge over the height of an equilateral triangle

function shrink(b: number[], s: number): number[] {
    return b.map((v) => v * (1 - 3 * s) + s);
}

/** The outline counter-clockwise; with clipped corners two points each. */
function outline(clip: number): number[][] {
    if (clip === 0) return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const c = clip;
    return [[1 - c, c, 0], [c, 1 - c, 0], [0, 1 - c, c], [0, c, 1 - c], [c, 0, 1 - c], [1 - c, 0, c]];
}

export function makeTemplate(detail: Detail): Template {
    const bary: number[] = [];
    const level: number[] = [];
    const outward: number[] = [];
    const along: number[] = [];
    const index: number[] = [];
    const vertex = (b: number[], height: number, drop: number, kind: number, out: number[], dir: number[]) => {
        bary.push(...b);
        level.push(height, drop, kind);
        outward.push(...out);
        along.push(...dir);
        return bary.length / 3 - 1;
    };
    const polygon = (points: number[][], height: number, kind: number, reversed: boolean) => {
        const first = points.map((p) => vertex(p, height, 0, kind, [0, 0, 0], [0, 0, 0]))[0];
        for (let k = 1; k + 1 < points.length; k++)
            if (reversed) index.push(first, first + k + 1, first + k);
            else index.push(first, first + k, first + k + 1);
    };
    const base = outline(detail === "full" ? drawn.clip : 0);
    const rim = base.map((b) => shrink(b, detail === "flat" ? 0 : drawn.inset * perHeight));
    const band = (low: number[][], lowLevel: number[], high: number[][], highLevel: number[], kind: number) => {
        for (let k = 0; k < low.length; k++) {
            const n = (k + 1) % low.length;
            const dir = low[n].map((v, i) => v - low[k][i]);
            const out = low[n].map((v, i) => (v + low[k][i]) / 2 - 1 / 3);
            const a = vertex(low[k], lowLevel[0], lowLevel[1], kind, out, dir);
            vertex(low[n], lowLevel[0], lowLevel[1], kind, out, dir);
            vertex(high[n], highLevel[0], highLevel[1], kind, out, dir);
            vertex(high[k], highLevel[0], highLevel[1], kind, out, dir);
            index.push(a, a + 1, a + 2, a, a + 2, a + 3);
        }
    };
    if (detail === "full") {
        const top = base.map((b) => shrink(b, (drawn.inset + drawn.bevel) * perHeight));
        polygon(top, 1, 0, false);
        band(rim, [1, 1], top, [1, 0], 1);
        band(rim, [0, 0], rim, [1, 1], 2);
        polygon(rim, 0, 3, true);
    } else if (detail === "prism") {
        polygon(rim, 1, 0, false);
        band(rim, [0, 0], rim, [1, 0], 2);
        polygon(rim, 0, 3, true);
    } else {
        polygon(rim, 1, 0, false);
        polygon(rim, 1, 3, true);
    }
    return {
        bary: Float32Array.from(bary),
        level: Float32Array.from(level),
        outward: Float32Array.from(outward),
        along: Float32Array.from(along),
        index: Uint16Array.from(index),
    };
}

/** Level of detail from pixels per panel edge, with a fifth of hysteresis around the present one. */
export function detailFor(pixels: number, present: Detail): Detail {
    const order: Detail[] = ["flat", "prism", "full"];
    const limits = [4, 8];
    let k = order.indexOf(present);
    while (k < 2 && pixels > limits[k] * 1.2) k++;
    while (k > 0 && pixels < limits[k - 1] / 1.2) k--;
    return order[k];
}
