// Panels drawn without a graphics card: one flat triangle each, put into an array of pixels with a depth per pixel. What moves is
// drawn so where WebGL itself is software, which takes ten times as long for the same picture.
import { panelNormals } from "./measures";
import { type Lights, shadePanel } from "./shade";

/** Columns and rows: from, and up to. */
export type Box = [left: number, top: number, right: number, bottom: number];

/** RGBA bytes as numbers of 32 bits (little-endian), and depths, nearer is less; rows from the top down. */
export interface Picture {
    width: number;
    height: number;
    pixels: Uint32Array;
    depth: Float32Array;
    /** What panels are drawn over; where there is none, over nothing. */
    ground: Uint32Array | null;
    /** Where it differs from its ground, for every window that was drawn in. */
    drawn: Box[];
}

/** Part of a picture in pixels, and the matrix (4 x 4, column by column) from places to -1..1 across it. */
export interface Window {
    x: number;
    y: number;
    width: number;
    height: number;
    matrix: ArrayLike<number>;
}

/** What is drawn over a panel: outline and marks, as colours 0xBBGGRR. */
export interface Inks {
    line: number;
    lineAlpha: number;
    accent: number;
    hatch: number;
}

export const makePicture = (width: number, height: number, ground: Uint32Array | null = null): Picture => ({
    width, height, ground, pixels: ground?.slice() ?? new Uint32Array(width * height), depth: new Float32Array(width * height).fill(Infinity), drawn: [],
});

/** Takes panels off again. */
export function clear(picture: Picture): void {
    const { width, pixels, depth, ground } = picture;
    for (const [left, top, right, bottom] of picture.drawn)
        for (let y = top; y < bottom; y++) {
            const [from, to] = [y * width + left, y * width + right];
            if (ground) pixels.set(ground.subarray(from, to), from);
            else pixels.fill(0, from, to);
            depth.fill(Infinity, from, to);
        }
    picture.drawn = [];
}

/** Share s of b, the rest of a; 0xBBGGRR. */
function mix(a: number, b: number, s: number): number {
    const k = (256 * s + 0.5) | 0;
    const two = (((a & 0xff00ff) * (256 - k) + (b & 0xff00ff) * k) >>> 8) & 0xff00ff;
    return two | ((((a >>> 8) & 0xff) * (256 - k) + ((b >>> 8) & 0xff) * k) & 0xff00);
}

let room = new Float32Array(0);

/** Places (3 per hinge) in the picture: x and y in pixels, and depth; a depth that is none where a place is behind the eye. */
function project(places: Float32Array, { x, y, width, height, matrix }: Window): Float32Array {
    if (room.length < places.length) room = new Float32Array(places.length);
    const screen = room, m = Float64Array.from(matrix);
    for (let i = 0; i < places.length; i += 3) {
        const px = places[i], py = places[i + 1], pz = places[i + 2];
        const w = m[3] * px + m[7] * py + m[11] * pz + m[15];
        const s = w > 1e-9 ? 1 / w : NaN;
        screen[i] = x + 0.5 * width * (1 + (m[0] * px + m[4] * py + m[8] * pz + m[12]) * s);
        screen[i + 1] = y + 0.5 * height * (1 - (m[1] * px + m[5] * py + m[9] * pz + m[13]) * s);
        screen[i + 2] = (m[2] * px + m[6] * py + m[10] * pz + m[14]) * s;
    }
    return screen;
}

const inverse = (x: number, y: number) => 1 / Math.sqrt(x * x + y * y);

/** An outline's half width and the softness of its inner side, pixels. */
const [lineFrom, lineTo] = [0.4, 1.2];

/**
 * Draws panels (3 hinges each) within the window. `colour` gives what a side of a panel looks like, 0xBBGGRR; `marks` are 0 for none,
 * 128 selected, 192 hatched. Edges are smooth by the share of a pixel that they cover.
 */
export function drawPanels(picture: Picture, window: Window, places: Float32Array, triangles: Uint32Array,
    colour: (panel: number, front: boolean) => number, marks: Uint8Array, inks: Inks): void {
    const { pixels, depth, width } = picture;
    const { line: lineInk, lineAlpha, accent, hatch } = inks;
    const left = Math.max(0, window.x), top = Math.max(0, window.y);
    const right = Math.min(picture.width, window.x + window.width), bottom = Math.min(picture.height, window.y + window.height);
    const screen = project(places, window);
    let boxLeft = right, boxTop = bottom, boxRight = left, boxBottom = top;
    for (let t = 0; t < marks.length; t++) {
        const a = 3 * triangles[3 * t];
        let b = 3 * triangles[3 * t + 1], c = 3 * triangles[3 * t + 2];
        const ax = screen[a], ay = screen[a + 1], az = screen[a + 2];
        let area = (screen[b] - ax) * (screen[c + 1] - ay) - (screen[c] - ax) * (screen[b + 1] - ay);
        if (!(Math.abs(area) > 1e-6)) continue; // on edge, or behind the eye
        const front = area < 0; // counter-clockwise, and y points down
        if (front) {
            [b, c] = [c, b];
            area = -area;
        }
        const bx = screen[b], by = screen[b + 1], cx = screen[c], cy = screen[c + 1];
        const x0 = Math.max(left, Math.floor(Math.min(ax, bx, cx) - 0.5)), x1 = Math.min(right, Math.ceil(Math.max(ax, bx, cx) + 0.5));
        const y0 = Math.max(top, Math.floor(Math.min(ay, by, cy) - 0.5)), y1 = Math.min(bottom, Math.ceil(Math.max(ay, by, cy) + 0.5));
        if (x0 >= x1 || y0 >= y1) continue;
        if (x0 < boxLeft) boxLeft = x0;
        if (x1 > boxRight) boxRight = x1;
        if (y0 < boxTop) boxTop = y0;
        if (y1 > boxBottom) boxBottom = y1;
        // distances in pixels from the three edges, positive inside: d = u x + v y + w
        const la = inverse(bx - ax, by - ay), lb = inverse(cx - bx, cy - by), lc = inverse(ax - cx, ay - cy);
        const ua = (ay - by) * la, va = (bx - ax) * la, ub = (by - cy) * lb, vb = (cx - bx) * lb, uc = (cy - ay) * lc, vc = (ax - cx) * lc;
        const wa = -ua * ax - va * ay, wb = -ub * bx - vb * by, wc = -uc * cx - vc * cy;
        const bz = screen[b + 2] - az, cz = screen[c + 2] - az;
        const zx = (bz * (cy - ay) - cz * (by - ay)) / area, zy = (cz * (bx - ax) - bz * (cx - ax)) / area;
        const selected = marks[t] === 128, hatched = marks[t] === 192;
        const face = selected ? mix(colour(t, front), accent, 0.12) : colour(t, front);
        const line = selected ? accent : mix(face, lineInk, lineAlpha);
        const ia = -1 / ua, ib = -1 / ub, ic = -1 / uc;
        for (let y = y0; y < y1; y++) {
            const v = y + 0.5;
            const da = va * v + wa + 0.5 * ua, db = vb * v + wb + 0.5 * ub, dc = vc * v + wc + 0.5 * uc;
            const z = az + zx * (0.5 - ax) + zy * (v - ay);
            // where all three are above -1/2
            let low = x0, high = x1 - 1;
            const pa = (da + 0.5) * ia, pb = (db + 0.5) * ib, pc = (dc + 0.5) * ic;
            if (ua > 0) { if (pa > low) low = pa; } else if (ua < 0 && pa < high) high = pa;
            if (ub > 0) { if (pb > low) low = pb; } else if (ub < 0 && pb < high) high = pb;
            if (uc > 0) { if (pc > low) low = pc; } else if (uc < 0 && pc < high) high = pc;
            const from = Math.ceil(low), to = Math.floor(high);
            for (let x = from, i = y * width + from; x <= to; x++, i++) {
                const d1 = ua * x + da, d2 = ub * x + db, d3 = uc * x + dc;
                const d = d1 < d2 ? (d1 < d3 ? d1 : d3) : d2 < d3 ? d2 : d3;
                if (d <= -0.5) continue; // beside an edge along the row
                const near = z + zx * x;
                if (near >= depth[i]) continue;
                const ground = hatched && ((x + y) & 7) > 4 ? hatch : face;
                const ink = d >= lineTo ? ground : d <= lineFrom ? line : mix(ground, line, (lineTo - d) / (lineTo - lineFrom));
                if (d >= 0.5) {
                    pixels[i] = ink | 0xff000000;
                    depth[i] = near;
                } else { // covers a share of the pixel, over what is there
                    const under = pixels[i], before = under >>> 24;
                    const after = before + (255 - before) * (d + 0.5);
                    pixels[i] = mix(under & 0xffffff, ink, (255 * (d + 0.5)) / after) | ((after + 0.5) << 24);
                    if (d >= 0) depth[i] = near;
                }
            }
        }
    }
    picture.drawn.push([boxLeft, boxTop, boxRight, boxBottom]);
}

/** What a state is seen with. */
export interface Sight {
    window: Window;
    lights: Lights;
    inks: Inks;
}

/** Panels in their places with their colours (4 bytes each) and marks. `normals` is room for 3 numbers per panel. */
export function drawShell(picture: Picture, { window, lights, inks }: Sight, triangles: Uint32Array, places: Float32Array, tints: Uint8Array,
    marks: Uint8Array, normals: Float32Array): void {
    panelNormals(triangles, places, normals);
    drawPanels(picture, window, places, triangles, (t, front) => shadePanel(lights, normals, tints, t, front), marks, inks);
}
