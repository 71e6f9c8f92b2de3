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

/** Display colour 0xBBGGRR of one side of a panel, from the panel's unit normals (3 numbers each) and tints (4 bytes each). */
export function shadePanel({ lamps, sky, ground }: Lights, normals: Float32Array, tints: Uint8Array, panel: number, front: boolean): number {
    const sign = front ? 1 : -1;
    const x = sign * normals[3 * panel], y = sign * normals[3 * panel + 1], z = sign * normals[3 * panel + 2];
    const up = 0.5 + 0.5 * z;
    const scale = (steps * (front ? 1 : underside)) / Math.PI;
    let shown = 0;
    for (let c = 2; c >= 0; c--) {
        let light = ground[c] + (sky[c] - ground[c]) * up;
        for (const { from, colour } of lamps) light += colour[c] * Math.max(0, x * from[0] + y * from[1] + z * from[2]);
        shown = (shown << 8) | toDisplay[Math.min(steps, Math.round(scale * toLinear[tints[4 * panel + c]] * light))];
    }
    return shown;
}
