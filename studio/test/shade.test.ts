import { describe, expect, it } from "vitest";
import { shadePanels, underside } from "../src/panels/shade";

const shade = (normal: number[], tint: number, light: Parameters<typeof shadePanels>[0]) => {
    const [top, below] = [new Uint8Array(12), new Uint8Array(12)];
    shadePanels(light, Float32Array.from(normal), Uint8Array.of(tint, tint, tint, 255), Uint8Array.of(128), top, below);
    return { top, below };
};
const linear = (byte: number) => ((byte / 255 + 0.055) / 1.055) ** 2.4;
const lamp = { lamps: [{ from: [0, 0, 1], colour: [2, 2, 2] }], sky: [0, 0, 0], ground: [0, 0, 0] };

describe("panels shaded one by one", () => {
    it("follow the cosine, and the lamp lights one side", () => {
        const { top, below } = shade([0.6, 0, 0.8], 200, lamp);
        expect(linear(top[0])).toBeCloseTo((0.8 * 2 * linear(200)) / Math.PI, 2);
        expect(below[0]).toBe(0);
    });
    it("take the sky from above and the ground from below, the underside darker", () => {
        const { top, below } = shade([0, 0, 1], 200, { lamps: [], sky: [2, 2, 2], ground: [1, 1, 1] });
        expect(linear(top[0])).toBeCloseTo((2 * linear(200)) / Math.PI, 2);
        expect(linear(below[0])).toBeCloseTo((underside * linear(200)) / Math.PI, 2);
    });
    it("have one colour at all corners, and their mark beside it", () => {
        const { top } = shade([0, 0, 1], 90, lamp);
        expect([...top.slice(4, 8)]).toEqual([...top.slice(0, 4)]);
        expect([...top.slice(8)]).toEqual([...top.slice(0, 4)]);
        expect(top[3]).toBe(128);
    });
    it("stay within what a display shows", () => {
        expect(shade([0, 0, 1], 255, { ...lamp, sky: [40, 40, 40] }).top[0]).toBe(255);
    });
});
