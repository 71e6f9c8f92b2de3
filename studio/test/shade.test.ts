import { describe, expect, it } from "vitest";
import { shadePanel, underside } from "../src/panels/shade";

const shade = (normal: number[], tint: number[], lights: Parameters<typeof shadePanel>[0], front = true) => {
    const shown = shadePanel(lights, Float32Array.from(normal), Uint8Array.from([...tint, 255]), 0, front);
    return [shown & 255, (shown >> 8) & 255, shown >> 16];
};
const grey = [200, 200, 200];
const linear = (byte: number) => ((byte / 255 + 0.055) / 1.055) ** 2.4;
const lamp = { lamps: [{ from: [0, 0, 1], colour: [2, 2, 2] }], sky: [0, 0, 0], ground: [0, 0, 0] };

describe("panels shaded one by one", () => {
    it("follow the cosine, and the lamp lights one side", () => {
        expect(linear(shade([0.6, 0, 0.8], grey, lamp)[0])).toBeCloseTo((0.8 * 2 * linear(200)) / Math.PI, 2);
        expect(shade([0.6, 0, 0.8], grey, lamp, false)[0]).toBe(0);
    });
    it("take the sky from above and the ground from below, the underside darker", () => {
        const sky = { lamps: [], sky: [2, 2, 2], ground: [1, 1, 1] };
        expect(linear(shade([0, 0, 1], grey, sky)[0])).toBeCloseTo((2 * linear(200)) / Math.PI, 2);
        expect(linear(shade([0, 0, 1], grey, sky, false)[0])).toBeCloseTo((underside * linear(200)) / Math.PI, 2);
    });
    it("keep red, green and blue apart", () => {
        const [r, g, b] = shade([0, 0, 1], [200, 100, 0], lamp);
        expect(r).toBeGreaterThan(g);
        expect(g).toBeGreaterThan(b);
        expect(b).toBe(0);
    });
    it("stay within what a display shows", () => {
        expect(shade([0, 0, 1], [255, 255, 255], { ...lamp, sky: [40, 40, 40] })[0]).toBe(255);
    });
});
