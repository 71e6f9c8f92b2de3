// A small picture of a shell without the graphics card: panels sorted from back to front, shaded by the key light.
import { colourOf, tide } from "../panels/colour";
import type { Linkage } from "../panels/linkage";
import { OrbitCamera, presets } from "./camera";
import { keyFrom } from "./look";

export function thumbnail(linkage: Linkage, places: Float32Array, lambda: Float32Array, width: number, height: number): HTMLCanvasElement {
    const canvas = document.createElement("canvas");
    canvas.width = width;
    canvas.height = height;
    const context = canvas.getContext("2d")!;
    const orbit = new OrbitCamera();
    const pose = orbit.framed(places, presets.perspective, width, height, 0.88, 0.03);
    const rad = Math.PI / 180;
    const [a, e] = [pose.azimuth * rad, pose.elevation * rad];
    const back = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
    const right = [-Math.sin(a), Math.cos(a), 0];
    const up = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
    const focus = height / 2 / Math.tan(15 * rad);
    const n = places.length / 3;
    const screen = new Float32Array(3 * n);
    for (let h = 0; h < n; h++) {
        const d = [0, 1, 2].map((k) => places[3 * h + k] - pose.target[k]);
        const dot = (v: number[]) => d[0] * v[0] + d[1] * v[1] + d[2] * v[2];
        const depth = pose.distance - dot(back);
        screen[3 * h] = width / 2 + (focus * dot(right)) / depth;
        screen[3 * h + 1] = height / 2 - (focus * dot(up)) / depth;
        screen[3 * h + 2] = depth;
    }
    const { triangles, panels } = linkage;
    const depth = (t: number) => screen[3 * triangles[3 * t] + 2] + screen[3 * triangles[3 * t + 1] + 2] + screen[3 * triangles[3 * t + 2] + 2];
    const order = Array.from({ length: panels }, (_, t) => t).sort((s, t) => depth(t) - depth(s));
    const key = keyFrom.space.map((v) => v / Math.hypot(...keyFrom.space));
    const scale = { map: tide, lo: 1, hi: 2 };
    const p = (h: number, k: number) => places[3 * h + k];
    for (const t of order) {
        const [i, j, k] = [triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]];
        const u = [0, 1, 2].map((c) => p(j, c) - p(i, c));
        const v = [0, 1, 2].map((c) => p(k, c) - p(i, c));
        const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        const size = Math.hypot(...normal) || 1;
        const lit = (normal[0] * key[0] + normal[1] * key[1] + normal[2] * key[2]) / size;
        const seen = normal[0] * back[0] + normal[1] * back[1] + normal[2] * back[2] > 0;
        const shade = seen ? 0.72 + 0.34 * Math.max(0, lit) : 0.5;
        const [r, g, b] = colourOf(scale, lambda[t]).map((c) => Math.min(255, c * shade));
        context.fillStyle = `rgb(${r} ${g} ${b})`;
        context.beginPath();
        context.moveTo(screen[3 * i], screen[3 * i + 1]);
        context.lineTo(screen[3 * j], screen[3 * j + 1]);
        context.lineTo(screen[3 * k], screen[3 * k + 1]);
        context.fill();
    }
    return canvas;
}

export function pictureUrl(canvas: HTMLCanvasElement): Promise<string> {
    return new Promise((resolve) => canvas.toBlob((blob) => resolve(blob ? URL.createObjectURL(blob) : ""), "image/png"));
}
