import { describe, expect, it } from "vitest";
import { colourOf, histogram, level, niceAbove, niceBelow, paint, percentile, tide, type ColourMap } from "../src/panels/colour";

function oklab([r, g, b]: number[]): [number, number, number] {
    const [lr, lg, lb] = [r, g, b].map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
    const l = Math.cbrt(0.4122214708 * lr + 0.5363325363 * lg + 0.0514459929 * lb);
    const m = Math.cbrt(0.2119034982 * lr + 0.6806995451 * lg + 0.1073969566 * lb);
    const s = Math.cbrt(0.0883024619 * lr + 0.2817188376 * lg + 0.6299787005 * lb);
    return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s, 1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s, 0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
}
/** Viénot, Brettel and Mollon 1999, on linear light. */
const deuteranope = [[0.292, 0.708, 0], [0.292, 0.708, 0], [-0.022, 0.022, 1]];
const protanope = [[0.11238, 0.88762, 0], [0.11238, 0.88762, 0], [0.00401, -0.00401, 1]];
function seenBy(matrix: number[][], colour: number[]): number[] {
    const linear = colour.map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
    return matrix.map((row) => {
        const v = Math.max(0, row[0] * linear[0] + row[1] * linear[1] + row[2] * linear[2]);
        return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
    });
}
const at = (map: ColourMap, i: number) => [...map.table.slice(3 * i, 3 * i + 3)];

describe("Tide", () => {
    it("gets lighter all the way, also to colour-blind eyes", () => {
        for (const see of [(c: number[]) => c, (c: number[]) => seenBy(deuteranope, c), (c: number[]) => seenBy(protanope, c)]) {
            let last = -1;
            for (let i = 0; i < 256; i += 8) {
                const l = oklab(see(at(tide, i)))[0];
                expect(l, `colour ${i}`).toBeGreaterThan(last);
                last = l;
            }
        }
    });
    it("moves in steps of one size", () => {
        const steps: number[] = [];
        for (let i = 32; i < 256; i += 32) steps.push(Math.hypot(...oklab(at(tide, i)).map((v, k) => v - oklab(at(tide, i - 32))[k])));
        expect(Math.max(...steps) / Math.min(...steps)).toBeLessThan(1.25);
    });
    it("has the ends that the legend shows", () => {
        expect(colourOf({ map: tide, lo: 1, hi: 2 }, 1)).toEqual([0x31, 0x35, 0x7d]);
        expect(colourOf({ map: tide, lo: 1, hi: 2 }, 2)).toEqual([0xfb, 0xe7, 0x86]);
        expect(colourOf({ map: tide, lo: 1, hi: 2 }, 3)).toEqual([0xfb, 0xe7, 0x86]);
        expect(colourOf({ map: tide, lo: 1, hi: 2 }, NaN)[0]).toBe(168);
    });
});

describe("Level", () => {
    it("is lightest at zero and tells push from pull by hue, also to colour-blind eyes", () => {
        for (const matrix of [deuteranope, protanope]) {
            const [push, pull] = [at(level, 32), at(level, 223)].map((c) => oklab(seenBy(matrix, c)));
            expect(push[2] - pull[2]).toBeLessThan(-0.1);
        }
        expect(oklab(at(level, 128))[0]).toBeGreaterThan(Math.max(oklab(at(level, 64))[0], oklab(at(level, 192))[0]));
    });
});

describe("scales", () => {
    it("paint what colourOf says", () => {
        const values = Float32Array.of(1, 1.37, 2, NaN, 0.2);
        const out = new Uint8Array(20);
        paint({ map: tide, lo: 1, hi: 2 }, values, out);
        values.forEach((v, t) => expect([...out.slice(4 * t, 4 * t + 3)]).toEqual(colourOf({ map: tide, lo: 1, hi: 2 }, v)));
    });
    it("end at 1, 2, 5 or 6 times a power of ten", () => {
        expect([0.9, 1, 1.1, 3, 5.5, 53, 640].map(niceAbove)).toEqual([1, 1, 2, 5, 6, 60, 1000]);
        expect(niceAbove(0)).toBe(1);
        expect([0.7, 1, 3, 9.9, 0.04].map((v) => Number(niceBelow(v).toPrecision(6)))).toEqual([0.5, 1, 2, 5, 0.02]);
    });
    it("count every value once", () => {
        const bins = histogram(Float32Array.of(0.9, 1, 1.5, 1.999, 2, 2.4, NaN), 1, 2, 4);
        expect([...bins]).toEqual([2, 0, 1, 3]);
        expect(percentile(Float32Array.from({ length: 100 }, (_, k) => k), 0.99)).toBe(99);
    });
});
