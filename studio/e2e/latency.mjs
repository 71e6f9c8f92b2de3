// From brush movement to the new deployed state on screen, while a hand paints: prints a table. Started by hand on a quiet machine:
// cd build/studio && AUXSHELL=$PWD/../release/bin/auxshell AUXSHELL_ROOT=$PWD/../.. node e2e/latency.mjs [PANELS...]
//
// It begins at the pointer event's time stamp and ends when the browser says that the first picture which holds the movement was
// presented. Drawing in software is what a graphics card would take over: panels into pixels, WebGL, and putting the page together.
// Its time is that of one and the same run, as the browser's own trace has it.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { Browser } from "./alone.mjs";
import { Studio } from "./studio.mjs";

const movements = 150;
const parts = [
    ["pointer event to page", (s) => s.heard - s.moved],
    ["page to preview", (s) => s.sent - s.heard],
    ["to the server and back", (s) => s.arrived - s.sent - s.waited - s.solved],
    ["waits for the solver", (s) => s.waited],
    ["solved", (s) => s.solved],
    ["to who draws it", (s) => s.came - s.arrived],
    ["waits for the last picture", (s) => s.began - s.came],
    ["panels into pixels", (s) => s.submitted - s.began],
    ["to the screen", (s) => s.presented - s.submitted],
    ["hand to screen", (s) => s.presented - s.moved],
    ["of it drawing in software", (s) => s.software],
    ["hand to screen without", (s) => s.presented - s.moved - s.software],
];

const quantile = (values, q) => values.slice().sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(q * values.length))];

/** What a hand does for some seconds, 60 places a second: circles over the middle of the flat view. It does not wait for the page. It comes
 *  there first; then `begins` is called. */
async function paint(browser, begins) {
    const box = await browser.value(`(() => {
        const { canvas, views: { flat: { rect } } } = auxshell.stage.value;
        const { left, top } = canvas.getBoundingClientRect();
        return [[0.5, 0.48], [0.66, 0.64]].map(([u, v]) => [left + rect.x + u * rect.width, top + rect.y + v * rect.height]);
    })()`);
    const mouse = (type, k, buttons = 1) => browser.send("Input.dispatchMouseEvent", {
        type, x: box[0][0] + (box[1][0] - box[0][0]) * Math.cos(k / 14), y: box[0][1] + (box[1][1] - box[0][1]) * Math.sin(k / 9),
        button: buttons ? "left" : "none", buttons, clickCount: type === "mouseMoved" ? 0 : 1,
    });
    const move = async (from, to, buttons) => {
        const began = performance.now();
        const moves = [];
        for (let k = from; k <= to; k++) {
            await new Promise((resolve) => setTimeout(resolve, began + ((k - from + 1) * 1000) / 60 - performance.now()));
            moves.push(mouse("mouseMoved", k, buttons));
        }
        await Promise.all(moves);
    };
    await move(-60, 0, 0);
    await begins();
    await mouse("mousePressed", 0);
    await move(1, movements);
    await browser.until("auxshell.latency.pending() === 0"); // the last ones are shown before the stroke ends
    await new Promise((resolve) => setTimeout(resolve, 100));
    await mouse("mouseReleased", movements);
}

/** Length of a union of intervals within [from, to]. */
function covered(intervals, from, to) {
    let [sum, end] = [0, from];
    for (const [a, b] of intervals.map(([a, b]) => [Math.max(a, from), Math.min(b, to)]).filter(([a, b]) => b > a).sort((p, q) => p[0] - q[0])) {
        sum += Math.max(0, b - Math.max(a, end));
        end = Math.max(end, b);
    }
    return sum;
}

/** Adds to every sample when its picture was presented and how long software drew it. */
function complete(samples, events, origin) {
    const mark = events.find((e) => e.name === "origin" && e.cat.includes("user_timing"));
    const at = (e) => (e.ts - mark.ts) / 1000 + origin;
    const frames = new Map(); // animation frames of the page by their ids
    const open = new Map();
    for (const e of events.filter((e) => e.pid === mark.pid).sort((a, b) => a.ts - b.ts)) {
        if (e.name === "AnimationFrame" && e.ph === "b") {
            open.set(e.id2?.local, e.args.id);
            frames.set(e.args.id, { from: at(e), to: Infinity, presented: NaN });
        } else if (e.name === "AnimationFrame" && e.ph === "e") frames.get(open.get(e.id2?.local)).to = at(e);
        else if (e.name === "AnimationFrame::Presentation" && frames.has(e.args.id)) frames.get(e.args.id).presented = at(e);
    }
    const software = events.filter((e) => e.ph === "X" && (e.name === "Display::DrawAndSwap" || e.name === "GPUTask")).map((e) => [at(e), at(e) + e.dur / 1000]);
    // a worker's canvas hands its pictures to the browser by itself, as a surface of its own; the next drawing takes it in
    const surface = (e) => Number(/FrameSinkId\(\d+, (\d+)\)/.exec(e.args.SurfaceId)?.[1]);
    const times = (of) => events.filter(of).map((e) => [at(e), at(e) + (e.dur ?? 0) / 1000]).sort((a, b) => a[0] - b[0]);
    const pushed = times((e) => e.name === "OffscreenCanvas::PushFrame" && e.pid === mark.pid);
    const handed = times((e) => e.name === "Surface::CommitFrame" && surface(e) >= 2 ** 31);
    const drawings = times((e) => e.ph === "X" && e.name === "Display::DrawAndSwap");
    const next = (list, after) => list.find(([from]) => from >= after) ?? [NaN, NaN];
    const shown = (submitted) => next(drawings, next(handed, next(pushed, submitted)[0])[0])[1];
    software.push(...samples.map((s) => [s.began, s.submitted]));
    for (const s of samples) {
        // a frame that changed nothing says so at once; the picture is then in the next one that was presented
        const frame = [...frames.values()].filter((f) => f.to >= s.submitted && f.presented >= s.submitted).sort((a, b) => a.from - b.from)[0];
        s.presented = s.apart ? shown(s.submitted) : (frame?.presented ?? NaN);
        s.software = covered(software, s.began, s.presented);
    }
    return samples.filter((s) => Number.isFinite(s.presented));
}

async function measure(panels) {
    const studio = new Studio();
    writeFileSync(join(studio.folder, "shell.json"), JSON.stringify({
        format: "auxshell-recipe", version: 1, operators: [
            { op: "start_circle", radius: 5, triangles: panels, scale: 1.2 }, { op: "gradient_radial", radius: 5, inner: 1.5, outer: 1.15 },
            { op: "rim_circle", radius: 5.5 }, { op: "inflation" }],
    }));
    await studio.start("shell.json");
    const browser = new Browser(new URL("./chromium.sh", import.meta.url).pathname);
    try {
        await browser.open(studio.address, 1440, 900);
        await browser.until('typeof auxshell === "object" && auxshell.shell() !== null && auxshell.session.status.value?.solver === "idle"');
        await browser.key("b");
        await browser.until("auxshell.stage.value.atRest");
        await new Promise((resolve) => setTimeout(resolve, 1500)); // and a moment more, as a hand does
        let origin = 0;
        const begins = async () => (origin = await browser.value('(auxshell.latency.samples.length = 0, performance.mark("origin").startTime)'));
        const events = await browser.traced(["devtools.timeline", "viz", "gpu", "blink.user_timing", "blink"], () => paint(browser, begins));
        const found = await browser.value("({ samples: auxshell.latency.samples, panels: auxshell.shell().linkage.panels, renderer: auxshell.stage.value.rendererName })");
        return { ...found, samples: complete(found.samples, events, origin), all: found.samples.length };
    } finally {
        await browser.close();
        await studio.remove();
    }
}

const sizes = process.argv.slice(2).map(Number);
for (const panels of sizes.length ? sizes : [2000, 10000]) {
    const { samples, all, panels: count, renderer } = await measure(panels);
    const pictures = new Set(samples.map((s) => s.presented)).size;
    const apart = samples.filter((s) => s.apart).length;
    console.log(`\n${count} panels, ${renderer}: ${samples.length} of ${all} movements in ${pictures} pictures, ${(pictures / (movements / 60)).toFixed(0)} a second; ${apart} by the worker`);
    console.log(`${"ms".padEnd(32)}${["median", "p95", "most"].map((w) => w.padStart(9)).join("")}`);
    for (const [name, of] of parts) {
        const values = samples.map(of);
        console.log(`${name.padEnd(32)}${[0.5, 0.95, 1].map((q) => quantile(values, q).toFixed(1).padStart(9)).join("")}`);
    }
}
