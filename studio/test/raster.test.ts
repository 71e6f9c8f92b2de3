import { describe, expect, it } from "vitest";
import { type Window, clear, drawPanels, makePicture } from "../src/panels/raster";

const size = 64;
/** The square from -1 to 1, seen from above in parallel; larger z is nearer. */
const above: Window = { x: 0, y: 0, width: size, height: size, matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1] };
const inks = { line: 0x0000ff, lineAlpha: 0, accent: 0x00ff00, hatch: 0x010203 };
const triangle = (z: number, turn = false) => (turn ? [-0.8, -0.8, z, 0, 0.8, z, 0.8, -0.8, z] : [-0.8, -0.8, z, 0.8, -0.8, z, 0, 0.8, z]);

function draw(places: number[], options: { window?: Window; colours?: number[]; below?: number; marks?: number[]; lineAlpha?: number } = {}) {
    const picture = makePicture(size, size);
    clear(picture);
    const panels = places.length / 9;
    drawPanels(picture, options.window ?? above, Float32Array.from(places), Uint32Array.from({ length: 3 * panels }, (_, k) => k),
        (t, front) => (front ? (options.colours?.[t] ?? 0x808080) : (options.below ?? 0x404040)), Uint8Array.from(options.marks ?? new Array(panels).fill(0)),
        { ...inks, lineAlpha: options.lineAlpha ?? 0 });
    return { ...picture, at: (x: number, y: number) => picture.pixels[y * size + x] & 0xffffff, seen: (x: number, y: number) => picture.pixels[y * size + x] >>> 24 };
}

describe("panels drawn without a renderer", () => {
    it("cover their area, edges by shares of a pixel", () => {
        const { pixels } = draw(triangle(0));
        const covered = pixels.reduce((sum, p) => sum + (p >>> 24) / 255, 0);
        expect(covered).toBeCloseTo(0.5 * (0.8 * size) ** 2, -1);
        expect(pixels.some((p) => p >>> 24 > 0 && p >>> 24 < 255)).toBe(true);
        expect(new Set(pixels.filter((p) => p >>> 24 > 0).map((p) => p & 0xffffff))).toEqual(new Set([0x808080]));
    });
    it("hide what is farther, in any order", () => {
        const [near, far] = [0xaa0000, 0x00aa00];
        expect(draw([...triangle(0.5), ...triangle(0)], { colours: [near, far] }).at(32, 40)).toBe(near);
        expect(draw([...triangle(0), ...triangle(0.5)], { colours: [far, near] }).at(32, 40)).toBe(near);
    });
    it("meet where they cross", () => {
        const sloping = [-0.8, -0.8, -0.5, 0.8, -0.8, 0.5, 0, 0.8, 0];
        const both = draw([...triangle(0), ...sloping], { colours: [1, 2] });
        expect([both.at(24, 50), both.at(40, 50)]).toEqual([1, 2]);
    });
    it("show their other side turned over", () => {
        expect(draw(triangle(0, true), { below: 0x123456 }).at(32, 40)).toBe(0x123456);
    });
    it("lie over their ground and are taken off it again", () => {
        const ground = Uint32Array.from({ length: size * size }, (_, k) => 0xff000000 + k);
        const picture = makePicture(size, size, ground);
        const put = () => drawPanels(picture, above, Float32Array.from(triangle(0)), Uint32Array.of(0, 1, 2), () => 0x808080, Uint8Array.of(0), { ...inks, lineAlpha: 0 });
        put();
        const once = picture.pixels.slice();
        expect(once.every((p) => p >>> 24 === 255)).toBe(true);
        const [[left, top, right, bottom]] = picture.drawn;
        once.forEach((p, k) => {
            const [x, y] = [k % size, Math.floor(k / size)];
            if (x < left || x >= right || y < top || y >= bottom) expect(p).toBe(ground[k]);
        });
        expect(once[40 * size + 32]).toBe(0xff808080);
        clear(picture);
        expect(picture.pixels).toEqual(ground);
        put();
        expect(picture.pixels).toEqual(once);
    });
    it("stay within their window", () => {
        const { pixels } = draw(triangle(0), { window: { ...above, x: 32, width: 32 } });
        expect(pixels.some((p, k) => p !== 0 && k % size < 32)).toBe(false);
        expect(pixels.some((p) => p !== 0)).toBe(true);
        const beyond = draw(triangle(0).map((v) => 4 * v), { window: { ...above, x: 20, width: 20 } });
        expect(beyond.pixels.some((p, k) => p !== 0 && (k % size < 20 || k % size >= 40))).toBe(false);
    });
    it("are left out behind the eye", () => {
        const eye = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, 0, 0]; // w = -z
        expect(draw(triangle(-1), { window: { ...above, matrix: eye } }).at(32, 40)).toBe(0x808080);
        expect(draw(triangle(1), { window: { ...above, matrix: eye } }).pixels.every((p) => p === 0)).toBe(true);
    });
    it("have an outline, and marks", () => {
        const lined = draw(triangle(0), { lineAlpha: 1 });
        expect(lined.pixels.some((p) => (p & 255) > 0xc0 && ((p >> 8) & 255) < 0x40)).toBe(true);
        expect(lined.at(32, 40)).toBe(0x808080);
        const selected = draw(triangle(0), { marks: [128] });
        expect((selected.at(32, 40) >> 8) & 255).toBeGreaterThan(selected.at(32, 40) & 255);
        const hatched = draw(triangle(0), { marks: [192] });
        expect(new Set([0, 1, 2, 3, 4, 5, 6, 7].map((x) => hatched.at(28 + x, 40)))).toEqual(new Set([0x808080, inks.hatch]));
    });
});
