// From brush movement to the new deployed state on screen, measured in the page while a hand paints: prints a table. Started by hand on
// a quiet machine: cd build/studio && AUXSHELL=$PWD/../release/bin/auxshell AUXSHELL_ROOT=$PWD/../.. node e2e/latency.mjs [PANELS...]
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { Hand, Studio, launch } from "./studio.mjs";

const movements = 150;
const parts = [
    ["pointer to handler", (s) => s.sent - s.moved],
    ["solved and arrived", (s) => s.arrived - s.sent],
    ["waits for its turn, submitted", (s) => s.submitted - s.arrived],
    ["without the renderer", (s) => s.submitted - s.moved],
    ["drawn by the renderer", (s) => s.drawn - s.submitted],
    ["hand to screen", (s) => s.drawn - s.moved],
];

const quantile = (values, q) => values.slice().sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(q * values.length))];

/** What a hand does for some seconds, 60 places a second: circles over the middle of the flat view. It does not wait for the page. */
async function paint(hand) {
    const { mouse } = hand.page;
    const box = [await hand.flat(0.5, 0.48), await hand.flat(0.66, 0.64)];
    const at = (k) => [box[0][0] + (box[1][0] - box[0][0]) * Math.cos(k / 14), box[0][1] + (box[1][1] - box[0][1]) * Math.sin(k / 9)];
    await mouse.move(...at(0));
    await mouse.down();
    const began = performance.now();
    const moves = [];
    for (let k = 1; k <= movements; k++) {
        await new Promise((resolve) => setTimeout(resolve, began + (k * 1000) / 60 - performance.now()));
        moves.push(mouse.move(...at(k)));
    }
    await Promise.all(moves);
    await hand.page.waitForFunction(() => auxshell.latency.pending() === 0, null, { timeout: 30000 }); // the last ones are shown before the stroke ends
    await mouse.up();
}

/** `drawn`: false leaves out all drawing, of the scenes and of the page: what is left is this project's own part of the way. */
async function measure(browser, panels, drawn) {
    const studio = new Studio();
    writeFileSync(join(studio.folder, "shell.json"), JSON.stringify({
        format: "auxshell-recipe", version: 1, operators: [
            { op: "start_circle", radius: 5, triangles: panels, scale: 1.2 }, { op: "gradient_radial", radius: 5, inner: 1.5, outer: 1.15 },
            { op: "rim_circle", radius: 5.5 }, { op: "inflation" }],
    }));
    await studio.start("shell.json");
    try {
        const hand = await Hand.open(browser, studio.address, { viewport: { width: 1440, height: 900 }, refines: true });
        await hand.key("b");
        await hand.page.waitForFunction(() => auxshell.stage.value.atRest, null, { timeout: 60000 });
        if (!drawn)
            await hand.page.evaluate(() => {
                const { renderer } = auxshell.stage.value;
                renderer.render = renderer.clear = renderer.setPixelRatio = () => undefined;
                auxshell.stage.value.overlays.clear();
                const sheet = new CSSStyleSheet();
                sheet.replaceSync("#app * { visibility: hidden } #app .views { visibility: visible; background: none }");
                document.adoptedStyleSheets = [sheet];
            });
        await hand.page.evaluate(() => (auxshell.latency.samples.length = 0));
        const began = performance.now();
        await paint(hand);
        const seconds = (performance.now() - began) / 1000;
        const found = await hand.page.evaluate(() => ({ samples: auxshell.latency.samples, panels: auxshell.shell().linkage.panels, renderer: auxshell.stage.value.rendererName }));
        await hand.rest();
        await hand.page.context().close();
        return { ...found, seconds };
    } finally {
        await studio.remove();
    }
}

const browser = await launch();
const sizes = process.argv.slice(2).map(Number);
for (const panels of sizes.length ? sizes : [2000, 10000])
    for (const drawn of [false, true]) {
        const found = await measure(browser, panels, drawn);
        const states = new Set(found.samples.map((s) => s.drawn)).size;
        console.log(`\n${found.panels} panels, ${drawn ? found.renderer : "nothing drawn"}: ${found.samples.length} movements shown in ${states} pictures, ${(states / found.seconds).toFixed(0)} a second`);
        console.log(`${"ms".padEnd(32)}${["median", "p95", "most"].map((w) => w.padStart(9)).join("")}`);
        for (const [name, of] of parts) {
            const values = found.samples.map(of);
            console.log(`${name.padEnd(32)}${[0.5, 0.95, 1].map((q) => quantile(values, q).toFixed(1).padStart(9)).join("")}`);
        }
    }
await browser.close();
