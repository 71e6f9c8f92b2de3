// Matt surfaces in the light of the scene, computed once per panel: what the renderer's own shaders make of diffuse light.

/** Linear colours times intensity, and unit directions towards the lamps. */
export interface Lights {
    lamps: { from: readonly number[]; colour: readonly number[] }[];
    sky: readonly number[];
    ground: readonly number[];
}

export const underside = 0.55;

const toLinear = Float32Array.from({ length: 256 }, (_, k) => (k <= 10 ? k / 255 / 12.92 : ((k / 255 + 0.055) / 1.055) ** 2.4));
const steps = 4095;
const toDisplay = Uint8Array.from({ length: steps + 1 }, (_, k) => {
    const v = k / steps;
    return Math.round(255 * (v <= 0.0031308 ? v * 12.92 : 1.055 * v ** (1 / 2.4) - 0.055));
});

/** Display colours of both sides of every panel, from its normal (3 numbers) and tint (4 bytes): 3 vertices per panel with 4 bytes each;
 *  the fourth byte of the top is the panel's mark. */
export function shadePanels(lights: Lights, normals: Float32Array, tints: Uint8Array, marks: Uint8Array, top: Uint8Array, below: Uint8Array): void {
    const light = [0, 0, 0];
    const side = (t: number, sign: number, share: number, out: Uint8Array) => {
        const [x, y, z] = [sign * normals[3 * t], sign * normals[3 * t + 1], sign * normals[3 * t + 2]];
        const up = 0.5 + 0.5 * z;
        for (let c = 0; c < 3; c++) light[c] = lights.ground[c] + (lights.sky[c] - lights.ground[c]) * up;
        for (const { from, colour } of lights.lamps) {
            const meets = x * from[0] + y * from[1] + z * from[2];
            if (meets > 0) for (let c = 0; c < 3; c++) light[c] += colour[c] * meets;
        }
        for (let c = 0; c < 3; c++) {
            const shown = toDisplay[Math.min(steps, Math.round((steps * share * toLinear[tints[4 * t + c]] * light[c]) / Math.PI))];
            out[12 * t + c] = out[12 * t + 4 + c] = out[12 * t + 8 + c] = shown;
        }
    };
    for (let t = 0; t < marks.length; t++) {
        side(t, 1, 1, top);
        side(t, -1, underside, below);
        top[12 * t + 3] = top[12 * t + 7] = top[12 * t + 11] = marks[t];
    }
}
