// The fields that panels can be coloured by: where their values come from and on which scale they are shown.
import { type Scale, level, niceAbove, percentile, tide } from "./colour";
import { awayFromRim, distances, leastAtCorners } from "./measures";
import type { Shell } from "./shell";

export interface Field {
    id: string;
    title: string;
    unit: "" | "deg" | "length" | "1/length" | "N" | "%";
    digits: number;
    /** Words under the ends of the scale. */
    ends?: [string, string];
    available(source: Shell): boolean;
    values(source: Shell): Float32Array;
    /** Panels whose values count for the range that is told; all, unless given. */
    judged?(source: Shell): Uint8Array;
    scale(values: Float32Array, source: Shell): Scale;
}

const always = () => true;
const upTo = (values: Float32Array): Scale => ({ map: tide, lo: 0, hi: niceAbove(percentile(values, 0.99)) });

/** The edge force of largest magnitude in each panel, with its sign. */
export function leadingForce(forces: Float32Array): Float32Array {
    const out = new Float32Array(forces.length / 3);
    for (let t = 0; t < out.length; t++)
        for (let k = 0; k < 3; k++) if (Math.abs(forces[3 * t + k]) > Math.abs(out[t])) out[t] = forces[3 * t + k];
    return out;
}

export const fields: Field[] = [
    {
        id: "lambda", title: "Scale factor λ", unit: "", digits: 2, available: always,
        values: (s) => s.realised, judged: (s) => awayFromRim(s.linkage),
        scale: () => ({ map: tide, lo: 1, hi: 2 }),
    },
    {
        id: "mouth", title: "Mouth angle", unit: "deg", digits: 1, available: always,
        values: (s) => leastAtCorners(s.linkage, s.mouth).map((v) => (180 / Math.PI) * v),
        scale: () => ({ map: tide, lo: 0, hi: 120 }),
    },
    {
        id: "force", title: "Axial force", unit: "N", digits: 0, ends: ["Compression", "Tension"],
        available: (s) => s.forces !== null,
        values: (s) => leadingForce(s.forces!),
        scale: (values) => {
            const hi = niceAbove(percentile(values.map(Math.abs), 0.99));
            return { map: level, lo: -hi, hi };
        },
    },
    {
        id: "residual", title: "Edge residual", unit: "%", digits: 2, available: always,
        values: (s) => s.residual.map((v) => 100 * v),
        scale: upTo,
    },
    {
        id: "distance", title: "Distance to design", unit: "length", digits: 1,
        available: (s) => s.simulated !== null,
        values: (s) => distances(s.linkage, s.deployed, s.simulated!),
        scale: upTo,
    },
    {
        id: "curvature", title: "Mean curvature", unit: "1/length", digits: 2, ends: ["Inwards", "Outwards"], available: always,
        values: (s) => s.curvature,
        scale: (values) => {
            const hi = niceAbove(percentile(values.map(Math.abs), 0.99));
            return { map: level, lo: -hi, hi };
        },
    },
];

export function fieldById(id: string): Field {
    return fields.find((f) => f.id === id) ?? fields[0];
}
