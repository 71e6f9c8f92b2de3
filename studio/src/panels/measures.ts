// What follows from places alone is computed here and never sent.
import type { Linkage } from "./linkage";

/** The smallest of its hinges' values, per panel; NaN where no hinge has one. */
export function leastAtCorners(linkage: Linkage, perHinge: Float32Array): Float32Array {
    const out = new Float32Array(linkage.panels);
    for (let t = 0; t < linkage.panels; t++) {
        let least = NaN;
        for (let k = 0; k < 3; k++) {
            const v = perHinge[linkage.triangles[3 * t + k]];
            if (!(v >= least)) least = Number.isNaN(v) ? least : v;
        }
        out[t] = least;
    }
    return out;
}

/** Distance between two states at each panel: the largest over its hinges. */
export function distances(linkage: Linkage, from: Float32Array, to: Float32Array): Float32Array {
    const out = new Float32Array(linkage.panels);
    for (let t = 0; t < linkage.panels; t++)
        for (let k = 0; k < 3; k++) {
            const h = 3 * linkage.triangles[3 * t + k];
            const d = Math.hypot(from[h] - to[h], from[h + 1] - to[h + 1], from[h + 2] - to[h + 2]);
            if (d > out[t]) out[t] = d;
        }
    return out;
}

/** Unit normals of the panels, 3 numbers each; hinge normals are the mean of their panels'. */
export function panelNormals(triangles: Uint32Array, places: Float32Array, out: Float32Array): void {
    for (let t = 0; 3 * t < triangles.length; t++) {
        const a = 3 * triangles[3 * t];
        const b = 3 * triangles[3 * t + 1];
        const c = 3 * triangles[3 * t + 2];
        const ux = places[b] - places[a], uy = places[b + 1] - places[a + 1], uz = places[b + 2] - places[a + 2];
        const vx = places[c] - places[a], vy = places[c + 1] - places[a + 1], vz = places[c + 2] - places[a + 2];
        const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        const s = 1 / (Math.hypot(x, y, z) || 1);
        out[3 * t] = x * s;
        out[3 * t + 1] = y * s;
        out[3 * t + 2] = z * s;
    }
}

export function hingeNormals(linkage: Linkage, normals: Float32Array, out: Float32Array): void {
    for (let h = 0; h < linkage.hinges; h++) {
        const a = linkage.around[2 * h];
        const b = linkage.around[2 * h + 1] < 0 ? a : linkage.around[2 * h + 1];
        const x = normals[3 * a] + normals[3 * b];
        const y = normals[3 * a + 1] + normals[3 * b + 1];
        const z = normals[3 * a + 2] + normals[3 * b + 2];
        const s = 1 / (Math.hypot(x, y, z) || 1);
        out[3 * h] = x * s;
        out[3 * h + 1] = y * s;
        out[3 * h + 2] = z * s;
    }
}

/** `judged`: 1 for values that count. */
export function rangeOf(values: Float32Array, judged?: Uint8Array): [number, number] {
    let lo = Infinity;
    let hi = -Infinity;
    for (let k = 0; k < values.length; k++) {
        if (judged && !judged[k]) continue;
        if (values[k] < lo) lo = values[k];
        if (values[k] > hi) hi = values[k];
    }
    return lo <= hi ? [lo, hi] : [NaN, NaN];
}

const away = new WeakMap<Linkage, Uint8Array>();
/** 1 for panels whose neighbours are all there and touch no rim: only there says a scale factor what was painted, and the check
 *  judges it. All, where no panel is so far inside. */
export function awayFromRim(linkage: Linkage): Uint8Array {
    const known = away.get(linkage);
    if (known) return known;
    const atRim = (t: number) => [0, 1, 2].some((k) => linkage.neighbours[3 * t + k] < 0);
    const out = new Uint8Array(linkage.panels);
    for (let t = 0; t < linkage.panels; t++) out[t] = Number([0, 1, 2].every((k) => linkage.neighbours[3 * t + k] >= 0 && !atRim(linkage.neighbours[3 * t + k])));
    if (!out.includes(1)) out.fill(1);
    away.set(linkage, out);
    return out;
}
