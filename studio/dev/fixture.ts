// A stand-in for the server while the page is worked on: one design JSON, shown and never changed. `npm run dev`, then
// http://127.0.0.1:5173/?fixture=/dev/k.json with a design exported by `auxshell export P.auxshell -o studio/dev/k.json`.
import { encodeFrame, kinds, section, type Numbers } from "../src/protocol/frames";
import type { Connect } from "../src/protocol/link";
import { loopsOf } from "../src/panels/linkage";

interface Design {
    units: string;
    triangles: number[][];
    holes: number[][];
    openings: number[][];
    supports: number[];
    flat: number[][];
    deployed: number[][];
    simulated: number[][] | null;
    scale: number[];
    load: { kind: string; pressure: number | null } | null;
    edge_forces: number[][] | null;
    report: Record<string, unknown> & { panels: string[]; edge_mean: number };
}

export function fixtureTransport(url: string): Connect {
    return (events) => {
        let serial = 0;
        void fetch(url).then((r) => r.json() as Promise<Design>).then((d) => {
            const f = (rows: number[][]) => Float32Array.from(rows.flat());
            const holes = loopsOf(d.holes);
            const openings = loopsOf(d.openings);
            const n = d.flat.length;
            const supports = new Uint8Array(n);
            d.supports.forEach((h) => (supports[h] = 1));
            const count = new Uint8Array(n);
            d.triangles.flat().forEach((h) => count[h]++);
            const i = (a: Uint32Array) => new Int32Array(a);
            const sections = new Map<number, Numbers>([
                [section.triangles, Int32Array.from(d.triangles.flat())], [section.holeStart, i(holes.start)], [section.holeHinges, i(holes.items)],
                [section.openingStart, i(openings.start)], [section.openingHinges, i(openings.items)], [section.onRim, count.map((c) => (c === 1 ? 1 : 0))],
                [section.panels, new Int32Array(3 * d.triangles.length)], [section.names, new TextEncoder().encode(d.report.panels.join("\n") + "\n")],
                [section.sheet, f(d.flat)], [section.flat, f(d.flat)], [section.deployed, f(d.deployed)], [section.simulated, d.simulated ? f(d.simulated) : new Float32Array(0)],
                [section.prescribed, Float32Array.from(d.scale)], [section.realised, Float32Array.from(d.scale)], [section.opening, new Float32Array(d.holes.length).fill(1)],
                [section.material, new Float32Array(n)], [section.mouth, new Float32Array(n).fill(0.6)], [section.residual, new Float32Array(d.scale.length).fill(1e-9)],
                [section.curvature, new Float32Array(d.scale.length).fill(0.1)], [section.forces, d.edge_forces ? f(d.edge_forces) : new Float32Array(0)],
                [section.supports, supports], [section.reactions, d.load && "forces" in d.load ? f((d.load as unknown as { forces: number[][] }).forces).map((v, k) => (supports[Math.floor(k / 3)] ? -v : 0)) : new Float32Array(0)],
            ]);
            const say = (event: object) => events.text(JSON.stringify(event));
            events.open();
            say({ event: "hello", protocol: 1, version: "fixture", client: 1, folder: "designs", start: "d1", operators: fixtureOperators, exporters: [], examples: [], recovered: [], limits: { message: 1, upload: 1, triangles: 1 } });
            say({ event: "document", id: "d1", name: "Kidney dome", path: "kidney.auxshell", read_only: null, autosaved: 0, unit: d.units, at: 2, steps: [
                { operator: { op: "start_target", file: "kidney.obj" }, words: "Start from a surface: kidney.obj", type: "start", state: "applied" },
                { operator: { op: "paint", value: 1.6 }, words: "Paint: 1.6 within 0.80 m", type: "scale", state: "applied" },
                { operator: { op: "smooth", amount: 0.3 }, words: "Smooth: over 0.30 m", type: "scale", state: "ahead" },
            ], undo: "Paint", redo: "Smooth", selections: [], constraints: [{ name: "fair-1", kind: "fair", hinges: [], weight: 0.2, residual: 0.0004, multiplier: 0 }], rim: [{ name: "rim", kind: "slide", hinges: [0, 1], weight: null, residual: 0.014, multiplier: 0.2, curve: { kind: "spline", closed: true, points: [] } }], underlays: [], load: { kind: "inflation", direction: [0, 0, 1], pressure: 100, density: 0 } });
            say({ event: "linkage", document: "d1", topology: 1, triangles: d.triangles.length, hinges: n, holes: d.holes.length, openings: d.openings.length, origin: [0, 0, 0], flat_origin: [0, 0], spacing: 2 * d.report.edge_mean, unit: d.units });
            events.binary(encodeFrame({ kind: kinds.state, re: 0, topology: 1, revision: 1, serial: 0, flags: 3, sections }));
            const check = (key: string, title: string, answer: string, limit: string, severity = "pass") => ({ key, title, answer, limit, value: 1, severity, triangle: 3, hinge: -1 });
            say({ event: "report", revision: 1, verdict: { word: "Yes, with care", severity: "warning" }, findings: [], held: [], figures: [], checks: [
                check("scale", "Scale factor λ", "1.13 to 1.54", "Limit 1.90"), check("mouth", "Smallest mouth", "12.1°", "Limit 7.0°"), check("overlap", "Overlaps", "None", "Closest panels 31 mm"),
                check("curvature", "Bulges outward", "Everywhere", "Mean curvature above 0"), check("rim", "Rim on curve", "6 hinges off", "Largest gap 14 mm", "warning"), check("match", "Simulated to design", "1.6 mm rms", "Largest 5.3 mm"), check("force", "Force residual", "8e-11", "Limit 1e-10"),
            ] });
            say({ event: "status", solver: "idle", state: "settled", iterations: 20, milliseconds: 12, residual: 1e-4, hand: 0, words: "Settled, 12 ms" });
            say({ event: "variants", variants: [] });
        });
        return {
            send(text) {
                const message = JSON.parse(text) as { do: string; id?: number; serial?: number };
                if (message.serial) serial = message.serial;
                if (message.id) queueMicrotask(() => events.text(JSON.stringify({ re: message.id, ok: true, document: "d1", at: 2, files: [], serial })));
            },
            close() {},
        };
    };
}

const number = (name: string, title: string, unit: string, lo: number, hi: number, value: number | null) => ({ name, title, doc: title, unit, kind: "number", required: value === null, default: value, lo, hi, width: 0, choices: [] });
const fixtureOperators = [
    { name: "paint", title: "Paint", doc: "A stroke of the brush.", reference: "", group: "scale", starts: false, settles: true, fields: [
        { name: "mode", title: "Mode", doc: "", unit: "", kind: "choice", required: false, default: "set", lo: null, hi: null, width: 0, choices: ["set", "add", "subtract", "smooth"] },
        number("value", "Value", "", 0, 2, 1.6), number("strength", "Strength", "", 0, 1, 0.6), { name: "points", title: "Stroke", doc: "", unit: "length", kind: "points", required: true, default: null, lo: 1, hi: null, width: 2, choices: [] },
        number("radius", "Radius", "length", 0, 1e9, 0.8), { name: "falloff", title: "Falloff", doc: "", unit: "", kind: "choice", required: false, default: "sphere", lo: null, hi: null, width: 0, choices: ["sphere", "flat", "linear", "gauss"] },
        { name: "copies", title: "Copies", doc: "", unit: "", kind: "integer", required: false, default: 1, lo: 1, hi: 360, width: 0, choices: [] },
    ] },
    { name: "fill", title: "Fill", doc: "", reference: "", group: "scale", starts: false, settles: true, fields: [number("value", "Value", "", 1, 2, null)] },
    { name: "inflation", title: "Inflation", doc: "", reference: "", group: "dynamics", starts: false, settles: true, fields: [number("pressure", "Pressure", "Pa", 0, 1e9, 100)] },
    { name: "gravity", title: "Gravity", doc: "", reference: "", group: "dynamics", starts: false, settles: true, fields: [number("density", "Weight", "kg/m2", 0, 1e6, 5)] },
];
