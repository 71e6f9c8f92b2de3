// What a user does, against the real server; what is judged are figures first, then what the page says.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import rhino3dm from "rhino3dm/rhino3dm.module.js";
import { Hand, Studio } from "./studio.mjs";

const root = process.env.AUXSHELL_ROOT;
const surfaces = join(root, "examples/surfaces");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

const circle = { op: "start_circle", radius: 5, triangles: 200, scale: 1.2 };
const bowl = [circle, { op: "gradient_radial", radius: 5, inner: 1.5, outer: 1.15 }, { op: "rim_circle", radius: 5.5 }, { op: "inflation" }];

/** A studio on a recipe of these operators. */
async function studioOn(operators, files = {}) {
    const studio = new Studio();
    for (const [name, text] of Object.entries(files)) writeFileSync(join(studio.folder, name), text);
    writeFileSync(join(studio.folder, "shell.json"), JSON.stringify({ format: "auxshell-recipe", version: 1, operators }));
    return studio.start("shell.json");
}

async function withStudio(browser, operators, run, options, files) {
    const studio = await studioOn(operators, files);
    try {
        const hand = await Hand.open(browser, studio.address, options);
        await run(hand, studio);
        assert.deepEqual(hand.errors, [], "errors in the page");
        await hand.page.context().close();
    } finally {
        await studio.remove();
    }
}

function edges(design, places) {
    const lengths = [];
    for (const t of design.triangles)
        for (let k = 0; k < 3; k++) {
            const [a, b] = [places[t[k]], places[t[(k + 1) % 3]]];
            lengths.push(Math.hypot(...a.map((v, i) => v - b[i])));
        }
    return lengths;
}

async function exported(hand, name) {
    const download = hand.page.waitForEvent("download");
    await hand.page.getByRole("dialog").getByRole("button", { name: /^Export/ }).click();
    const file = await download;
    assert.match(file.suggestedFilename(), name);
    return readFileSync(await file.path(), "utf8");
}

/** No edge is steeper than a slope of hundredths of a millimetre in exact designs: congruence of all three states. */
function judge(design) {
    const flat = edges(design, design.flat);
    const deployed = edges(design, design.deployed);
    const mean = flat.reduce((s, v) => s + v, 0) / flat.length;
    const off = Math.max(...flat.map((v, k) => Math.abs(v - deployed[k]) / mean));
    assert.ok(off < 1e-9, `flat and deployed edges differ by ${off} of an edge`);
    assert.ok(design.simulated, "there is a simulated state");
    const simulated = edges(design, design.simulated);
    assert.ok(Math.max(...flat.map((v, k) => Math.abs(v - simulated[k]) / mean)) < 1e-8, "simulated edges keep their length");
    for (const lambda of design.scale) assert.ok(lambda > 0.98 && lambda < 2.001, `lambda ${lambda}`);
}

export const scenarios = {
    async "from an outline to files: paint, smooth, rim on a circle, gravity, finish, export"(browser) {
        const studio = await new Studio().start(".");
        try {
            const hand = await Hand.open(browser, studio.address);
            const { page } = hand;
            await hand.key("Control+Alt+N");
            await page.getByRole("button", { name: "Circle", exact: true }).click();
            const form = page.getByRole("dialog");
            await form.getByLabel("Radius", { exact: true }).last().fill("500 cm");
            await form.getByLabel("Triangles", { exact: true }).last().fill("200");
            await form.getByLabel("Scale factor", { exact: true }).last().fill("1.2");
            await page.keyboard.press("Tab");
            await form.getByRole("button", { name: "Start" }).click();
            await hand.stepsAre("start_circle");
            const start = await hand.figures();
            assert.ok(start.panels > 150 && start.panels < 260, `${start.panels} panels`);

            await hand.key("b");
            await page.getByLabel("Value λ", { exact: true }).last().fill("1.5");
            await page.keyboard.press("Enter");
            await page.getByLabel("Radius", { exact: true }).last().fill("4m");
            await page.keyboard.press("Enter");
            await hand.drag(await hand.flat(0.45, 0.5), await hand.flat(0.55, 0.5));
            await hand.stepsAre("start_circle", "paint");
            const painted = await hand.figures();
            assert.ok(Math.abs(painted.prescribed - 1.5) < 0.02, `painted ${painted.prescribed}`);
            const stroke = await page.evaluate(() => auxshell.session.documentState.value.steps[1].operator);
            assert.equal(stroke.radius, 4);
            assert.ok(stroke.points.length >= 3, "the stroke has its points");

            await hand.key("s");
            await page.getByRole("complementary").getByRole("button", { name: "Smooth", exact: true }).click();
            await hand.stepsAre("start_circle", "paint", "smooth");
            assert.ok((await hand.figures()).prescribed < painted.prescribed, "smoothing lowers the peak");

            await hand.key("c");
            await page.getByLabel("Radius", { exact: true }).last().fill("5.4");
            await page.keyboard.press("Enter");
            await page.getByRole("complementary").getByRole("button", { name: "Apply" }).click();
            await hand.stepsAre("start_circle", "paint", "smooth", "rim_circle");
            const held = await page.evaluate(() => auxshell.session.documentState.value.rim);
            assert.equal(held[0].curve.kind, "circle");

            await page.getByLabel("Deployed by").selectOption("gravity");
            await hand.stepsAre("start_circle", "paint", "smooth", "rim_circle", "gravity");
            assert.ok((await hand.figures()).simulated, "gravity gives a simulated state");

            await page.getByRole("button", { name: "Finish" }).click();
            await page.waitForFunction(() => auxshell.session.status.value?.state === "exact", null, { timeout: 180000 });
            await hand.rest();

            await hand.key("Control+e");
            await page.getByRole("radio", { name: /\.svg$/ }).click();
            const dialog = page.getByRole("dialog");
            await dialog.getByLabel("Joint").selectOption("ring");
            await dialog.getByLabel("Material").selectOption("plywood-6");
            await dialog.getByLabel("Hole", { exact: true }).last().fill("8");
            await page.keyboard.press("Enter");
            await dialog.getByRole("row", { name: /^Ring, / }).waitFor({ timeout: 60000 });
            await dialog.getByRole("button", { name: /^Export/, disabled: false }).waitFor();
            const svg = await exported(hand, /\.svg$/);
            assert.match(svg, /hole/i, "panels have holes for the rings");
            assert.match(svg, /<svg/);
            assert.equal((svg.match(/id="cut-/g) ?? []).length, (await hand.figures()).panels, "one outline for every panel");
            if (await page.getByRole("dialog").isVisible()) await page.getByRole("radio", { name: /[^e]\.json$/ }).click();
            const text = await exported(hand, /\.json$/);
            const design = JSON.parse(text);
            judge(design);
            writeFileSync(join(studio.folder, "design.json"), text);
            const judged = spawnSync("/usr/bin/python3", [join(root, "tests/judge_design.py"), join(studio.folder, "design.json")], { encoding: "utf8" });
            assert.equal(judged.status, 0, judged.stdout + judged.stderr);
            assert.deepEqual(hand.errors, []);
        } finally {
            await studio.remove();
        }
    },

    async "a mesh is dragged in, judged and designed"(browser) {
        await withStudio(browser, [circle], async (hand) => {
            await hand.drop("spherical_cap.obj", readFileSync(join(surfaces, "spherical_cap.obj")));
            const dialog = hand.page.getByRole("dialog");
            await dialog.getByText("It can deploy").waitFor({ timeout: 60000 });
            const picture = dialog.getByRole("img", { name: /Mean curvature/ });
            assert.ok(await picture.evaluate((e) => e.complete && e.naturalWidth > 100), "the verdict comes with a picture");
            await dialog.getByLabel("Panels", { exact: true }).fill("1000");
            await hand.page.keyboard.press("Enter");
            await hand.page.evaluate(() => {
                // states of what is being made, of another linkage than the old one's: of the surface's own solver, and under load
                window.seen = { onSurface: 0, loaded: 0 };
                const before = auxshell.shell().linkage.panels;
                const settled = auxshell.stage.value.onBefore;
                auxshell.stage.value.onBefore = () => {
                    if (auxshell.session.making.value && auxshell.shell().linkage.panels !== before) window.seen[auxshell.shell().simulated ? "loaded" : "onSurface"]++;
                    settled();
                };
            });
            await dialog.getByRole("button", { name: "Design it" }).click();
            await hand.page.waitForFunction(() => auxshell.session.documentState.value?.steps[0].operator.op === "start_target", null, { timeout: 120000 });
            await hand.rest();
            const f = await hand.figures();
            assert.ok(f.panels > 900 && f.panels < 1100, `${f.panels} panels`);
            const seen = await hand.page.evaluate(() => window.seen);
            assert.ok(seen.onSurface >= 2, `it was watched while it was made: ${JSON.stringify(seen)}`);
            assert.notEqual(await hand.page.evaluate(() => auxshell.session.report.value.verdict.word), "No");
            assert.deepEqual(await hand.page.evaluate(() => {
                const stage = auxshell.stage.value;
                return stage.shown.filter((id) => {
                    const { state, rect } = stage.views[id];
                    const { min, max } = stage.scenes[state].bounds;
                    const at = stage.project(stage.views[id], stage.skins[state].centre(0, new stage.views[id].orbit.camera.position.constructor()).fromArray(min.map((v, k) => (v + max[k]) / 2)));
                    return Math.abs(at.x - rect.x - rect.width / 2) > 0.2 * rect.width || Math.abs(at.y - rect.y - rect.height / 2) > 0.2 * rect.height;
                });
            }), [], "views that lost the shell");
            assert.equal(await dialog.count(), 0, "with nothing in the way");
            assert.ok(f.least >= 1 - 1e-3 && f.most <= 2 + 1e-3, `lambda ${f.least} to ${f.most}`);
        });
    },

    async "a coarse mesh in millimetres that lies on its side is stood up, taken in its unit and refined"(browser) {
        await withStudio(browser, [circle], async (hand) => {
            const side = [-2, -1, 0, 1, 2];
            let mesh = side.flatMap((x) => side.map((y) => `v ${1000 * x} ${1200 - 150 * (x * x + y * y)} ${-1000 * y}\n`)).join("");
            for (let row = 0; row < 4; ++row) for (let a = 5 * row + 1; a < 5 * row + 5; ++a) mesh += `f ${a} ${a + 5} ${a + 6} ${a + 1}\n`;
            await hand.drop("coarse.obj", Buffer.from(mesh));
            const dialog = hand.page.getByRole("dialog");
            await dialog.getByText("no height field").waitFor({ timeout: 60000 });
            await dialog.getByLabel("Up axis").selectOption("y");
            await dialog.getByText("and by gravity").waitFor({ timeout: 60000 });
            assert.equal(await dialog.getByLabel("Unit").inputValue(), "mm", "four kilometres are four metres");
            assert.ok(await dialog.getByRole("checkbox").isChecked(), "its facets are wider than its panels");
            await dialog.getByLabel("Panels", { exact: true }).fill("200");
            await hand.page.keyboard.press("Enter");
            await dialog.getByRole("button", { name: "Design it" }).click();
            await hand.page.waitForFunction(() => auxshell.session.documentState.value?.steps[0].operator.op === "start_target", null, { timeout: 120000 });
            await hand.rest();
            const step = await hand.page.evaluate(() => auxshell.session.documentState.value.steps[0].operator);
            assert.deepEqual([step.unit, step.up, step.refine], ["mm", "y", true]);
            const places = await hand.places();
            assert.ok(places.length > 0);
        });
    },

    async "what is being made is watched, and cancelled: the old one is there again"(browser) {
        await withStudio(browser, [circle], async (hand) => {
            const { page } = hand;
            const before = await hand.places();
            const heights = await page.evaluate(async (operators) => {
                const seen = [];
                const stop = auxshell.session.onShell((shell) => {
                    if (auxshell.session.making.value && shell.deployed.length) seen.push(Math.max(...(shell.simulated ?? shell.deployed).filter((_, k) => k % 3 === 2)));
                    if (new Set(seen.map((h) => h.toFixed(2))).size === 4) auxshell.session.tell("cancel");
                });
                window.answer = await auxshell.session.command("new", { recipe: operators });
                stop();
                return seen;
            }, [{ ...circle, triangles: 12000 }, ...bowl.slice(1)]); // so many that the hand is quicker
            assert.equal(await page.evaluate(() => window.answer), null);
            assert.ok(heights.length >= 4, `${heights.length} states were seen`);
            await page.waitForFunction(() => !auxshell.session.making.value);
            await hand.rest();
            assert.deepEqual(await hand.places(), before);
            assert.equal(await page.getByRole("button", { name: "Cancel" }).count(), 0);
        });
    },

    async "a large recipe is served at once and watched; cancelled, the page says so"(browser) {
        const studio = new Studio();
        writeFileSync(join(studio.folder, "shell.json"), JSON.stringify({ format: "auxshell-recipe", version: 1, operators: [{ ...circle, triangles: 8000 }, ...bowl.slice(1)] }));
        try {
            const began = Date.now();
            await studio.start("shell.json");
            assert.ok(Date.now() - began < 5000, `its address came after ${Date.now() - began} ms`);
            const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
            const page = await context.newPage();
            await page.goto(studio.address);
            await page.waitForFunction(() => globalThis.auxshell?.shell()?.linkage.panels > 7000, null, { timeout: 30000 });
            assert.ok(await page.evaluate(() => auxshell.session.documentState.value === null && auxshell.session.making.value), "it is not made yet");
            await page.getByRole("button", { name: "Cancel", exact: true }).click();
            await page.getByRole("alert").getByRole("button", { name: "Start page" }).waitFor({ timeout: 30000 });
            await context.close();
        } finally {
            await studio.remove();
        }
    },

    async "the legend tells the range that the check judges; the curve of a rim follows its fields"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            const [told, judged] = await page.evaluate(() => [document.querySelector(".legend .range").textContent, auxshell.session.report.value.checks.find((c) => c.key === "scale").answer]);
            assert.equal(told, judged);
            await hand.key("c");
            const drawn = () => page.evaluate(async () => {
                await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
                return auxshell.stage.value.canvases.overlay.toDataURL();
            });
            const circled = await drawn();
            await page.getByLabel("Rim", { exact: true }).selectOption("rim_free");
            const free = await drawn();
            assert.notEqual(free, circled, "a free rim has no curve");
            await page.getByLabel("Rim", { exact: true }).selectOption("rim_circle");
            assert.equal(await drawn(), circled);
            await page.getByLabel("Radius", { exact: true }).last().fill("6");
            await page.keyboard.press("Enter");
            assert.notEqual(await drawn(), circled, "the circle is as wide as its field says");
        });
    },

    async "a surface that cannot deploy is said so, and why"(browser) {
        await withStudio(browser, [circle], async (hand) => {
            await hand.drop("saddle.obj", readFileSync(join(surfaces, "saddle.obj")));
            const dialog = hand.page.getByRole("dialog");
            await dialog.getByText("It cannot deploy").waitFor({ timeout: 60000 });
            assert.equal(await dialog.getByRole("button", { name: /Design|nearest/ }).count(), 0);
        });
    },

    async "what is no mesh is refused beside the views, which stay"(browser) {
        await withStudio(browser, [circle], async (hand) => {
            const before = await hand.places();
            await hand.drop("dome.obj", Buffer.from("v 0 0 0\nf 1 2 three\n"));
            await hand.page.getByRole("alert").filter({ hasText: /./ }).first().waitFor({ timeout: 30000 });
            await hand.key("Escape");
            await hand.drop("holiday.jpg", Buffer.from([0xff, 0xd8, 0xff]));
            await hand.page.getByText(/holiday\.jpg is no mesh/).waitFor();
            await hand.drop("broken.json", Buffer.from('{"format": "auxshell-recipe", "version": 1, "operators": [{"op": "start_circle", "radios": 3}]}'));
            await hand.page.getByText(/radios/).waitFor({ timeout: 30000 });
            assert.deepEqual(await hand.places(), before);
            assert.equal((await hand.steps()).length, 1);
        });
    },

    async "undo all, redo all: the same bits"(browser) {
        await withStudio(browser, [circle], async (hand) => {
            const states = [await hand.places()];
            await hand.key("b");
            for (let k = 0; k < 3; k++) {
                await hand.drag(await hand.flat(0.35 + 0.1 * k, 0.4), await hand.flat(0.4 + 0.1 * k, 0.55), 6);
                await hand.atIs(k + 2);
                states.push(await hand.places());
            }
            for (let k = 2; k >= 0; k--) {
                await hand.key("Control+z");
                await hand.atIs(k + 1);
                assert.deepEqual(await hand.places(), states[k], `after undoing to step ${k + 1}`);
            }
            for (let k = 1; k <= 3; k++) {
                await hand.key(k % 2 ? "Control+Shift+Z" : "Control+y");
                await hand.atIs(k + 1);
                assert.deepEqual(await hand.places(), states[k], `after redoing to step ${k + 1}`);
            }
        });
    },

    async "the recipe: go back, change a number, play again"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            const before = await hand.figures();
            await page.locator(".step").nth(0).click();
            await hand.atIs(1);
            assert.equal(await page.locator(".step-line.ahead").count(), 3);
            await page.locator(".step").nth(3).click();
            await hand.atIs(4);
            await page.locator(".step-line").nth(1).hover();
            await page.getByRole("button", { name: "Change step 2" }).click();
            await page.locator(".step-edit").getByLabel("Inner value", { exact: true }).last().fill("1.3");
            await page.keyboard.press("Enter");
            await page.locator(".step-edit").getByRole("button", { name: "Change", exact: true }).click();
            await page.waitForFunction(() => auxshell.session.documentState.value.steps[1].operator.inner === 1.3, null, { timeout: 120000 });
            await hand.rest();
            assert.equal((await hand.steps()).length, 4);
            assert.ok((await hand.figures()).prescribed < before.prescribed - 0.1, "the whole recipe was played again");
        });
    },

    async "a reload in the middle finds everything again"(browser) {
        await withStudio(browser, [circle], async (hand) => {
            await hand.key("b");
            await hand.drag(await hand.flat(0.4, 0.45), await hand.flat(0.6, 0.5), 8);
            await hand.atIs(2);
            const before = await hand.places();
            // and once more with the button still down: the stroke was never a step
            await hand.page.mouse.move(...(await hand.flat(0.5, 0.4)));
            await hand.page.mouse.down();
            await hand.page.mouse.move(...(await hand.flat(0.55, 0.6)), { steps: 5 });
            await hand.page.reload();
            await hand.ready();
            await hand.atIs(2);
            assert.deepEqual(await hand.places(), before);
        });
    },

    async "the server is killed in the middle: the page says so, and nothing is lost"(browser) {
        const studio = await new Studio().start(".");
        try {
            const hand = await Hand.open(browser, studio.address);
            const steps = await hand.steps();
            await hand.key("b");
            await hand.drag(await hand.flat(0.4, 0.45), await hand.flat(0.6, 0.5), 8);
            await hand.atIs(steps.length + 1);
            const before = await hand.places();
            await studio.stop("SIGKILL");
            await hand.page.getByText("Server stopped. Work is saved").first().waitFor();
            assert.deepEqual(await hand.places(), before, "the last state stays on screen");
            await hand.page.getByRole("button", { name: "Reconnect" }).waitFor();
            await studio.start(".");
            // the new address with the old document's name, as a user has it who copies what the terminal says
            const again = await Hand.open(browser, studio.address + new URL(hand.page.url()).hash);
            await again.atIs(steps.length + 1);
            assert.deepEqual(await again.steps(), [...steps, "paint"]);
            // the origin that places are sent against is another; a millionth of the sheet is single precision
            const after = await again.places();
            assert.equal(after.length, before.length);
            assert.ok(Math.max(...after.map((v, k) => Math.abs(v - before[k]))) < 5e-6, "every place is where it was");
            assert.deepEqual([...hand.errors, ...again.errors], []);
        } finally {
            await studio.remove();
        }
    },

    async "the same server comes back: the page finds it by itself"(browser) {
        await withStudio(browser, [circle], async (hand) => {
            await hand.page.context().setOffline(true);
            await hand.page.evaluate(() => auxshell.session.reconnect());
            await hand.page.waitForFunction(() => auxshell.session.connection.value !== "open");
            await hand.page.context().setOffline(false);
            await hand.page.waitForFunction(() => auxshell.session.connection.value === "open", null, { timeout: 30000 });
            await hand.key("b");
            await hand.drag(await hand.flat(0.4, 0.45), await hand.flat(0.6, 0.5), 6);
            await hand.atIs(2);
        });
    },

    async "two tabs see the same"(browser) {
        await withStudio(browser, [circle], async (hand, studio) => {
            const other = await Hand.open(browser, studio.address + new URL(hand.page.url()).hash);
            await hand.key("b");
            await hand.drag(await hand.flat(0.4, 0.45), await hand.flat(0.6, 0.5), 8);
            await hand.atIs(2);
            await other.atIs(2);
            await hand.sameAs(other);
            await other.key("Control+z");
            await hand.atIs(1);
            await other.atIs(1);
            await hand.sameAs(other);
            assert.deepEqual(other.errors, []);
        });
    },

    async "a rim on a circle is widened by its handle: one step, undone at once"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            await hand.key("c");
            assert.equal(await page.getByRole("complementary").getByLabel("Radius", { exact: true }).last().inputValue(), "5.50");
            const at = (x) => page.evaluate((x) => {
                const stage = auxshell.stage.value;
                const view = stage.views.deployed;
                const [ox, oy, oz] = auxshell.shell().origin;
                const p = stage.project(view, view.orbit.camera.position.clone().set(x - ox, -oy, -oz));
                const r = stage.canvas.getBoundingClientRect();
                return [r.left + p.x, r.top + p.y];
            }, x);
            await hand.drag(await at(-5.5), await at(-5.8), 6);
            await hand.atIs(5);
            const last = await page.evaluate(() => auxshell.session.documentState.value.steps.at(-1).operator);
            assert.equal(last.op, "rim_circle");
            assert.ok(last.radius > 5.6 && last.radius < 6, `radius ${last.radius}`);
            await hand.key("Control+z");
            await hand.atIs(4);
        });
    },

    async "a line of hinges, the way between two of them and a loop of panels are selected, and kept by name"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            await hand.key("v");
            const panel = page.getByRole("complementary");
            /** Where a hinge of the flat view is on the page, inwards of it by `inside` of the way to the middle of one of its panels. */
            const hinge = (h, inside = 0.2) => page.evaluate(([h, inside]) => {
                const stage = auxshell.stage.value;
                const view = stage.views.flat;
                const { places, linkage } = stage.skins.flat;
                const place = (k) => view.orbit.camera.position.clone().fromArray(places, 3 * k);
                const t = linkage.around[2 * h];
                const middle = place(linkage.triangles[3 * t]).add(place(linkage.triangles[3 * t + 1])).add(place(linkage.triangles[3 * t + 2])).divideScalar(3);
                const p = stage.project(view, place(h).lerp(middle, inside));
                const r = stage.canvas.getBoundingClientRect();
                return [r.left + p.x, r.top + p.y];
            }, [h, inside]);
            /** Inner hinges nearest to two places of the flat view, in shares of the sheet. */
            const near = (x, y) => page.evaluate(([x, y]) => {
                const { places, linkage } = auxshell.stage.value.skins.flat;
                let [best, least, size] = [-1, Infinity, 0];
                for (let k = 0; k < places.length; k++) size = Math.max(size, Math.abs(places[k]));
                for (let h = 0; 3 * h < places.length; h++) {
                    const d = Math.hypot(places[3 * h] - x * size, places[3 * h + 1] - y * size);
                    if (d < least && linkage.around[2 * h + 1] >= 0) [best, least] = [h, d];
                }
                return best;
            }, [x, y]);
            const [from, to] = [await near(-0.4, -0.3), await near(0.4, 0.2)];
            await panel.getByRole("radio", { name: "Line" }).check({ force: true });
            await page.mouse.click(...await hinge(from));
            const line = await panel.getByText(/^\d+ hinges/).textContent();
            assert.ok(parseInt(line) >= 5, line);
            await hand.key("Escape");
            await panel.getByRole("radio", { name: "Curve" }).check({ force: true });
            await page.mouse.click(...await hinge(from));
            await panel.getByText("Click where the way ends.").waitFor();
            await page.mouse.click(...await hinge(to));
            const way = await panel.getByText(/^\d+ hinges/).textContent();
            assert.ok(parseInt(way) >= 5, way);
            await panel.getByLabel("Name of the selection").fill("spine");
            await panel.getByRole("region", { name: "Select" }).getByRole("button", { name: "Keep", exact: true }).click();
            await hand.atIs(5);
            const kept = await page.evaluate(() => auxshell.session.documentState.value.steps.at(-1).operator);
            assert.deepEqual([kept.op, kept.name], ["select", "spine"]);
            await hand.key("Escape");
            await panel.getByRole("radio", { name: "Panels" }).check({ force: true });
            const [a, b] = [await hinge(from), await hinge(to)];
            await page.mouse.move(a[0], a[1]);
            await page.mouse.down();
            for (const [x, y] of [[a[0], b[1]], b, [b[0], a[1]]]) await page.mouse.move(x, y, { steps: 6 });
            await page.mouse.up();
            const loop = await panel.getByText(/^\d+ panels/).textContent();
            assert.ok(parseInt(loop) >= 10, loop);
        });
    },

    async "the deployment is played through states of the solver, while it computes them"(browser) {
        const large = [{ ...circle, triangles: 1500 }, ...bowl.slice(1)];
        for (const operators of [large, [...large.slice(0, -1), { op: "expand" }]]) await withStudio(browser, operators, async (hand) => {
            const { page } = hand;
            const rest = await page.evaluate(() => {
                window.shown = []; // of each state on screen: its place, and whether the last one was there yet
                auxshell.motion.subscribe(({ shown, frames, total }) => shown !== null && window.shown.push([shown, frames.length < total]));
                return [...(auxshell.shell().simulated ?? auxshell.shell().deployed)];
            });
            await hand.key("Space");
            await page.waitForFunction(() => auxshell.motion.value.frames.length > 3 && !auxshell.motion.value.playing, null, { timeout: 120000 });
            const way = await page.evaluate(() => ({
                shown: window.shown,
                shares: auxshell.motion.value.shares,
                heights: auxshell.motion.value.frames.map((f) => Math.max(...f.filter((_, k) => k % 3 === 2)) - Math.min(...f.filter((_, k) => k % 3 === 2))),
                last: [...auxshell.motion.value.frames.at(-1)],
            }));
            assert.ok(way.shown.some(([, before]) => before), "the first states are shown before the last one is computed");
            const places = way.shown.map(([place]) => place).filter((place, k, all) => place !== all[k - 1]);
            assert.deepEqual(places, way.shares.map((_, k) => k), "every state is shown, in order");
            assert.ok(way.heights[0] < 0.02 * way.heights.at(-1), `from ${way.heights[0]} to ${way.heights.at(-1)} high`);
            assert.ok(way.heights.length > 30 && way.heights.every((h, k) => k === 0 || Math.abs(h - way.heights[k - 1]) < 0.1 * way.heights.at(-1)), `it does not jump: ${way.heights}`);
            assert.ok(Math.abs(way.shares.at(-1) - 1) < 1e-6);
            // what overhangs the rim, six hinges of 2,300, lies inwards or outwards with equal ease
            const apart = way.last.map((v, k) => Math.abs(v - rest[k])).sort((a, b) => a - b), edge = 0.2;
            assert.ok(apart[Math.floor(0.99 * apart.length)] < edge / 2, "it ends where the document is");
            assert.ok(apart.at(-1) < 1.5 * edge);
            await hand.key("Home");
            await hand.key(",");
            await page.getByText(/State \d+ of \d+/).waitFor();
        });
    },

    async "from flat, then run: the sheet opens before one's eyes, a hinge is pulled meanwhile, and undo goes back"(browser) {
        for (const load of ["inflation", "expand"]) await withStudio(browser, [{ ...circle, triangles: 900 }, ...bowl.slice(1, -1), { op: load }], async (hand) => {
            const { page } = hand;
            const before = await hand.places();
            await hand.key("d");
            const panel = page.getByRole("complementary");
            await panel.getByRole("button", { name: "From flat" }).click();
            const height = () => page.evaluate(() => {
                const z = (auxshell.shell().simulated ?? auxshell.shell().deployed).filter((_, k) => k % 3 === 2);
                return Math.max(...z) - Math.min(...z);
            });
            const rest = Math.max(...before.filter((_, k) => k % 3 === 2));
            await page.waitForFunction((h) => Math.max(...(auxshell.shell().simulated ?? auxshell.shell().deployed).filter((_, k) => k % 3 === 2)) + auxshell.shell().origin[2] < h, 0.3 * rest);
            assert.ok(await height() < 0.2 * rest, "it lies flat");
            await page.evaluate(() => {
                window.heights = [];
                auxshell.session.onShell((shell) => {
                    const z = (shell.simulated ?? shell.deployed).filter((_, k) => k % 3 === 2);
                    window.heights.push([performance.now(), Math.max(...z) - Math.min(...z)]);
                });
            });
            await panel.getByRole("button", { name: "Run" }).click();
            await page.waitForFunction((h) => window.heights.some(([, z]) => z > h), 0.9 * rest, { timeout: 60000 });
            const heights = await page.evaluate(() => window.heights);
            const [rising, risen] = [0.2, 0.9].map((share) => heights.findIndex(([, z]) => z > share * rest));
            assert.ok(heights[risen][0] - heights[rising][0] > 300, `it is seen to open: ${heights.map(([t, z]) => `${t.toFixed(0)} ${z.toFixed(2)}`)}`);
            // pulled up at its crown
            const crown = await page.evaluate(() => {
                const stage = auxshell.stage.value;
                const { places } = stage.skins.space;
                let top = 0;
                for (let h = 1; 3 * h < places.length; h++) if (places[3 * h + 2] > places[3 * top + 2]) top = h;
                const p = stage.project(stage.views.deployed, stage.views.deployed.orbit.camera.position.clone().fromArray(places, 3 * top));
                const r = stage.canvas.getBoundingClientRect();
                return [r.left + p.x, r.top + p.y + 3];
            });
            const free = await height();
            await page.mouse.move(...crown);
            await page.mouse.down();
            await page.mouse.move(crown[0], crown[1] - 60, { steps: 10 });
            await page.waitForFunction((h) => window.heights.at(-1)[1] > h, 1.05 * free, { timeout: 20000 });
            await page.mouse.up();
            await hand.key("Control+z"); // while it runs
            await hand.atIs(3);
            await hand.key("Control+y");
            await hand.atIs(4);
            assert.deepEqual(await hand.places(), before, "the document's state is as it was");
        });
    },

    async "every check and finding leads to its place: selected, and in the middle of the views"(browser) {
        const small = { ...circle, triangles: 200 };
        const site = "v -9 -9 0.2\nv 9 -9 0.2\nv 9 9 0.2\nv -9 9 0.2\nf 1 2 3\nf 1 3 4\n";
        const shells = {
            "a load": [bowl, ["scale", "mouth", "curvature", "rim", "match", "force"]],
            "panels that overlap": [[small, { op: "fill", value: 2 }, { op: "paint", points: [[1, 0], [2, 1]], value: 1, radius: 1 }, { op: "inflation" }], ["mouth", "overlap"]],
            "panels folded together": [[small, { op: "fill", value: 2 }, { op: "rim_circle", radius: 3 }, { op: "inflation" }], ["overlap"]],
            "a site that is near": [[...bowl, { op: "underlay", name: "ground", file: "ground.obj", clearance: 1 }], ["overlap"]],
        };
        for (const [name, [operators, wanted]] of Object.entries(shells))
            await withStudio(browser, operators, async (hand) => {
                const { page } = hand;
                // the middle of what is selected, over the size of the view; and that it is in sight
                const place = () => page.evaluate(() => {
                    const stage = auxshell.stage.value;
                    const view = stage.views.deployed;
                    const panels = [...auxshell.selection.selected.value];
                    const centre = view.orbit.camera.position.clone().set(0, 0, 0);
                    for (const t of panels) centre.addScaledVector(stage.skins.space.centre(t, centre.clone()), 1 / panels.length);
                    const p = stage.project(view, centre);
                    return { panels, off: Math.max(Math.abs(p.x - view.rect.x - view.rect.width / 2) / view.rect.width, Math.abs(p.y - view.rect.y - view.rect.height / 2) / view.rect.height) };
                });
                const leadsTo = async (button, what) => {
                    await page.evaluate(() => (auxshell.selection.clearSelection(), auxshell.stage.value.views.deployed.orbit.pan(200, 100, 600)));
                    await button.click();
                    await page.waitForTimeout(50);
                    const { panels, off } = await place();
                    assert.ok(panels.length === 1 || panels.length === 2, `${name}, ${what}: ${panels.length} panels are selected`);
                    assert.ok(off < 0.02, `${name}, ${what}: ${off} off the middle of the view`);
                    return panels;
                };
                const report = await page.evaluate(() => auxshell.session.report.value);
                for (const key of wanted) {
                    const c = report.checks.find((x) => x.key === key);
                    await hand.key(["match", "force"].includes(key) ? "Alt+2" : "Alt+1");
                    const panels = await leadsTo(page.locator(`.checks [data-check="${key}"]`), key);
                    if (c.triangle >= 0) assert.equal(panels[0], c.triangle);
                    if (c.other >= 0) assert.deepEqual(panels, [c.triangle, c.other], "both of a pair");
                }
                await page.getByRole("button", { name: "Can it deploy?" }).click();
                const findings = page.getByRole("region", { name: "Findings" });
                for (const [k, f] of report.findings.filter((x) => x.triangle >= 0 || x.hinge >= 0).entries()) await leadsTo(findings.getByRole("button").nth(k), f.kind);
                if (name === "panels folded together") assert.match(await page.locator('.checks [data-check="match"]').innerText(), /^Material\s+(Slack, \d+ % open|Taut)/);
                if (name === "a site that is near") assert.ok(report.findings.some((f) => f.kind === "clearance"));
            }, { reducedMotion: "reduce" }, { "ground.obj": site });
    },

    async "variants are kept and compared"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            await page.getByRole("region", { name: "Variants" }).getByRole("button", { name: "Keep" }).click();
            await page.locator(".variant img").waitFor({ timeout: 30000 });
            await hand.key("u");
            await page.getByLabel("Value", { exact: true }).last().fill("1.35");
            await page.keyboard.press("Enter");
            await page.getByRole("complementary").getByRole("button", { name: "Fill" }).click();
            await hand.atIs(5);
            await page.getByRole("button", { name: "Keep this one" }).click();
            await page.waitForFunction(() => auxshell.session.variants.value.length === 2);
            await hand.key("Alt+3");
            assert.equal(await page.getByRole("article").count(), 2);
            await page.getByRole("article", { name: "Variant A" }).getByRole("button", { name: "Take" }).click();
            await page.waitForFunction(() => auxshell.session.documentState.value.steps.length === 4, null, { timeout: 60000 });
        });
    },

    async "variants are there again after a crash, with their figures and pictures"(browser) {
        const studio = await new Studio().start(".");
        try {
            const hand = await Hand.open(browser, studio.address);
            await hand.page.getByRole("region", { name: "Variants" }).getByRole("button", { name: "Keep" }).click();
            await hand.page.locator(".variant img").waitFor({ timeout: 30000 });
            const kept = await hand.page.evaluate(() => auxshell.session.variants.value);
            const document = new URL(hand.page.url()).hash;
            await studio.stop("SIGKILL");
            await studio.start(".");
            const again = await Hand.open(browser, studio.address + document);
            await again.page.locator(".variant img").waitFor({ timeout: 30000 });
            assert.deepEqual(await again.page.evaluate(() => auxshell.session.variants.value), kept);
            assert.deepEqual([...hand.errors, ...again.errors], []);
        } finally {
            await studio.remove();
        }
    },

    async "everything by keyboard: panels by name, numbers with units, a step, its undoing"(browser) {
        await withStudio(browser, [circle], async (hand) => {
            const { page } = hand;
            await hand.key("n");
            const name = await page.evaluate(() => auxshell.shell().name([...auxshell.selection.selected.value][0]));
            await page.getByText(`Panel ${name} selected`).waitFor();
            await hand.key("u");
            const value = page.getByLabel("Value", { exact: true }).last();
            await value.focus();
            await value.fill("1.2+0.25");
            await hand.key("Enter");
            assert.equal(await value.inputValue(), "1.45");
            await value.fill("2.4");
            await hand.key("Enter");
            await page.getByText("Between 1 and 2").waitFor();
            await value.fill("1.45");
            await hand.key("Enter");
            await page.getByRole("complementary").getByRole("button", { name: "Fill" }).focus();
            await hand.key("Enter");
            await hand.stepsAre("start_circle", "fill");
            const changed = await page.evaluate(() => [...auxshell.shell().prescribed].filter((v) => Math.abs(v - 1.45) < 1e-3).length);
            assert.ok(changed >= 1 && changed < 10, `${changed} panels were filled: the selection alone`);
            await hand.key("Control+z");
            await hand.atIs(1);
            await hand.key("t");
            await page.getByRole("dialog", { name: "Panels" }).getByLabel("Find a panel by name").fill(name);
            assert.equal(await page.getByRole("dialog").locator("tbody tr td button").first().innerText(), name);
            await hand.key("Escape");
            await hand.key("?");
            await page.getByRole("dialog", { name: "Keyboard and pointer" }).waitFor();
        });
    },

    async "axe finds nothing serious, light and dark, and at 200 %"(browser) {
        for (const options of [{ colorScheme: "light" }, { colorScheme: "dark" }, { viewport: { width: 720, height: 450 } }])
            // without transitions: colours half way are no colours
            await withStudio(browser, bowl, async (hand) => {
                await hand.page.evaluate(axe);
                const check = async (where) => {
                    await hand.page.waitForTimeout(200);
                    const found = await hand.page.evaluate(async () => (await globalThis.axe.run(document, { resultTypes: ["violations"] })).violations
                        .filter((v) => v.impact === "serious" || v.impact === "critical").map((v) => `${v.id}: ${v.nodes.map((n) => n.html.slice(0, 120)).join(" | ")}`));
                    assert.deepEqual(found, [], `${JSON.stringify(options)}, ${where}`);
                };
                await check("design");
                for (const key of ["b", "u", "g", "s", "i", "c", "p", "d", "m"]) {
                    await hand.key(key);
                    await check(`tool ${key}`);
                }
                for (const [key, where] of [["?", "shortcuts"], ["t", "table"], ["Control+o", "open"], ["Control+Shift+S", "save"], ["Control+e", "export"]]) {
                    await hand.key(key);
                    await check(where);
                    await hand.key("Escape");
                }
                await hand.key("Alt+2");
                await check("analyse");
                await hand.key("Alt+3");
                await check("variants");
                await hand.key("Control+Alt+n");
                await check("start");
            }, { ...options, reducedMotion: "reduce", bypassCSP: true });
    },

    async "at 200 % and on small screens no figure is cut, and the legend leaves the shell free"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            await hand.key("b");
            for (const [width, height] of [[640, 360], [720, 450], [960, 540], [1280, 720], [1440, 900], [1920, 1080]]) {
                await page.setViewportSize({ width, height });
                for (const mode of ["Alt+1", "Alt+2"]) {
                    await hand.key(mode);
                    await page.waitForTimeout(150);
                    const { cut, share } = await page.evaluate(() => {
                        const leaves = [...document.querySelectorAll(".checks *, .legend *, .view-title *, .timeline *, .form-row .segments")].filter((e) => (e.children.length === 0 || e.matches(".segments")) && e.clientWidth > 0);
                        const legend = document.querySelector(".legend").getBoundingClientRect();
                        const view = document.querySelector(".views").getBoundingClientRect();
                        return { cut: leaves.filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.textContent), share: (legend.width * legend.height) / (view.width * view.height) };
                    });
                    assert.deepEqual(cut, [], `${width} x ${height}, ${mode}`);
                    assert.ok(share < 0.15, `the legend covers ${share} of the views at ${width} x ${height}`);
                }
            }
        }, { reducedMotion: "reduce" });
    },

    async "a Rhino document is made in the page, under its policy, and holds every panel by its name"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            await hand.key("Control+e");
            await hand.page.getByRole("radio", { name: /\.3dm$/ }).click();
            const download = hand.page.waitForEvent("download");
            await hand.page.getByRole("dialog").getByRole("button", { name: /^Export/ }).click();
            const file = await download;
            assert.match(file.suggestedFilename(), /\.3dm$/);
            const rhino = await rhino3dm();
            const read = rhino.File3dm.fromByteArray(readFileSync(await file.path()));
            const panels = { flat: new Set(), deployed: new Set() };
            for (let k = 0; k < read.objects().count; ++k) {
                const attributes = read.objects().get(k).attributes();
                const [state, row] = read.layers().get(attributes.layerIndex).fullPath.split("::");
                if (row !== "supports") panels[state]?.add(attributes.name);
            }
            const names = await hand.page.evaluate(() => auxshell.shell().names);
            for (const state of ["flat", "deployed"]) assert.deepEqual([...panels[state]].sort(), [...names].sort(), state);
        });
    },

    async "every format is seen before it is exported"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            await hand.key("Control+e");
            const dialog = page.getByRole("dialog");
            const formats = await dialog.getByRole("radio").count();
            assert.ok(formats >= 20, `${formats} formats`);
            for (let k = 0; k < formats; k++) {
                await dialog.getByRole("radio").nth(k).click();
                await page.waitForFunction(() => {
                    const seen = document.querySelector('[aria-label="Preview"]');
                    const picture = seen.querySelector(".paper img");
                    return (picture?.complete && picture.naturalWidth > 100) || seen.querySelectorAll("tbody tr").length > 3;
                }, null, { timeout: 60000 }).catch(async () => assert.fail(`nothing is seen of ${await dialog.getByRole("radio").nth(k).textContent()}`));
            }
        });
    },

    async "four views: the shell is free of legend and buttons, and a view that is enlarged stays what it is"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            await hand.key("4");
            for (const [width, height] of [[1280, 800], [1440, 900], [1920, 1080]]) {
                await page.setViewportSize({ width, height });
                await page.waitForTimeout(300);
                const covered = await page.evaluate(() => {
                    const stage = auxshell.stage.value;
                    const corner = stage.canvas.getBoundingClientRect();
                    const Place = stage.views.top.orbit.camera.position.constructor;
                    const boxes = [...document.querySelectorAll(".legend, .view-tools .segments")].map((e) => [e.className, e.getBoundingClientRect()]);
                    const found = {};
                    for (const id of stage.shown) {
                        const { places } = stage.skins[stage.views[id].state];
                        for (let k = 0; k < places.length; k += 3) {
                            const at = stage.project(stage.views[id], new Place().fromArray(places, k));
                            for (const [name, box] of boxes) {
                                const [x, y] = [at.x + corner.left, at.y + corner.top];
                                if (x > box.left && x < box.right && y > box.top && y < box.bottom) found[`${id} ${name}`] = (found[`${id} ${name}`] ?? 0) + 1;
                            }
                        }
                    }
                    return found;
                });
                assert.deepEqual(covered, {}, `hinges that are covered at ${width} x ${height}`);
            }
            await page.getByRole("button", { name: "Only front" }).click();
            await page.waitForFunction(() => auxshell.stage.value.shown.length === 1);
            assert.deepEqual(await page.evaluate(() => {
                const { deployed } = auxshell.stage.value.views;
                return [auxshell.stage.value.shown[0], deployed.orbit.preset, deployed.orbit.pose.projection];
            }), ["deployed", "front", "parallel"]);
        }, { reducedMotion: "reduce" });
    },

    async "videos hold every picture at its time; recording is cancelled"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            const make = async (name) => {
                await hand.key("Control+e");
                await page.getByRole("radio", { name }).click();
                await page.getByRole("dialog").getByRole("button", { name: /^(Export|Record)/ }).click();
            };
            const download = page.waitForEvent("download", { timeout: 120000 });
            await make(/^Deployment/);
            const file = await download;
            assert.match(file.suggestedFilename(), /deployment\.webm$/);
            const states = await page.evaluate(() => auxshell.motion.value.frames.length);
            const player = await browser.newPage();
            const seen = await player.evaluate(async (bytes) => {
                const video = document.createElement("video");
                video.muted = true;
                video.src = URL.createObjectURL(new Blob([Uint8Array.from(bytes)], { type: "video/webm" }));
                await new Promise((resolve, reject) => ((video.onloadeddata = resolve), (video.onerror = () => reject(new Error(video.error.message)))));
                const { duration, videoWidth } = video;
                await new Promise((resolve) => ((video.onended = resolve), video.play()));
                return { duration, videoWidth, shown: video.getVideoPlaybackQuality().totalVideoFrames };
            }, [...readFileSync(await file.path())]);
            await player.close();
            assert.ok(Math.abs(seen.duration - 6) < 0.2 && seen.videoWidth > 200, JSON.stringify(seen));
            assert.ok(seen.shown >= states - 1, `${seen.shown} pictures of ${states} states`);
            await make(/^Turntable/);
            await page.getByText(/^Recording, /).waitFor({ state: "attached" }); // said by a ring alone in a narrow window
            await page.waitForFunction(() => Math.abs(auxshell.stage.value.views.deployed.orbit.pose.azimuth + 62) > 1); // it turns
            await page.getByRole("button", { name: "Cancel", exact: true }).click();
            await page.waitForFunction(() => !document.querySelector(".bar .chip")?.textContent.startsWith("Recording"));
            assert.equal(await page.evaluate(() => auxshell.stage.value.views.deployed.orbit.pose.azimuth), -62, "and is back");
        }, { viewport: { width: 700, height: 450 }, reducedMotion: "reduce" });
    },

    async "a renderer that turns out to be slow still shows the shell at rest"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            const atRest = () => page.waitForFunction(() => auxshell.stage.value.atRest, null, { timeout: 60000 });
            await atRest();
            await page.evaluate(() => {
                const stage = auxshell.stage.value;
                stage.wholeTimes = [0, 1000]; // the last two pictures: the next one decides
                stage.invalidateBackdrop();
            });
            await atRest();
            await page.waitForTimeout(300);
            await atRest();
            const picture = [...(await page.screenshot())];
            const coloured = await page.evaluate(async (bytes) => {
                const image = await createImageBitmap(new Blob([Uint8Array.from(bytes)], { type: "image/png" }));
                const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
                context.drawImage(image, 0, 0);
                const { data } = context.getImageData(0, 0, image.width, image.height / 2); // above the legend
                let count = 0;
                for (let k = 0; k < data.length; k += 4) if (Math.max(data[k], data[k + 1], data[k + 2]) - Math.min(data[k], data[k + 1], data[k + 2]) > 50) count++;
                return count;
            }, picture);
            assert.ok(coloured > 5000, `${coloured} pixels have the colour of panels`);
        }, { refines: true });
    },

    async "by touch: one finger selects, turns and paints, two pan and zoom"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            const touchscreen = await page.context().newCDPSession(page);
            const touch = (type, places) => touchscreen.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(([x, y], id) => ({ x, y, id })) });
            const swipe = async (from, by) => {
                await touch("touchStart", from);
                for (let k = 1; k <= 8; k++) await touch("touchMove", from.map(([x, y], i) => [x + (by[i][0] * k) / 8, y + (by[i][1] * k) / 8]));
                await touch("touchEnd", []);
            };
            const pose = (view) => page.evaluate((v) => auxshell.stage.value.views[v].orbit.pose, view);
            const middle = await page.evaluate(() => {
                const { canvas, views } = auxshell.stage.value;
                const r = canvas.getBoundingClientRect();
                return [r.left + views.deployed.rect.x + views.deployed.rect.width / 2, r.top + views.deployed.rect.height / 2];
            });
            const start = await pose("deployed");
            await swipe([middle], [[60, 0]]);
            const turned = await pose("deployed");
            assert.ok(Math.abs(turned.azimuth - start.azimuth) > 5, "one finger turns the view");
            assert.equal(turned.distance, start.distance);
            const pair = [[middle[0] - 50, middle[1]], [middle[0] + 50, middle[1]]];
            await swipe(pair, [[-50, 0], [50, 0]]);
            const near = await pose("deployed");
            assert.ok(near.distance < 0.6 * turned.distance && near.azimuth === turned.azimuth, "two fingers zoom");
            await swipe(pair, [[0, 60], [0, 60]]);
            const moved = await pose("deployed");
            assert.ok(moved.azimuth === near.azimuth && Math.abs(moved.distance / near.distance - 1) < 1e-9 && Math.hypot(...moved.target.map((v, k) => v - near.target[k])) > 0.1, "and pan");
            await touch("touchStart", [await hand.flat(0.5, 0.5)]);
            await touch("touchEnd", []);
            assert.equal(await page.evaluate(() => auxshell.selection.selected.value.size), 1, "a tap selects");
            await hand.key("b");
            await swipe([await hand.flat(0.45, 0.45)], [[40, 0]]);
            await hand.stepsAre("start_circle", "gradient_radial", "rim_circle", "inflation", "paint");
        }, { hasTouch: true, reducedMotion: "reduce" });
    },

    async "the tour has five steps, once"(browser) {
        const studio = await studioOn([circle]);
        try {
            const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
            const page = await context.newPage();
            await page.goto(studio.address);
            for (let k = 1; k <= 5; k++) {
                await page.getByText(`${k} of 5`).waitFor({ timeout: 60000 });
                await page.getByRole("button", { name: k < 5 ? "Next" : "Close", exact: true }).click();
            }
            await page.reload();
            await page.waitForFunction(() => auxshell.shell() !== null && auxshell.session.report.value !== null, null, { timeout: 60000 });
            assert.equal(await page.locator(".tour").count(), 0);
            await context.close();
        } finally {
            await studio.remove();
        }
    },

    async "while the hand moves: every movement is shown, none is queued, and a picture at a time is drawn"(browser, note) {
        await withStudio(browser, [{ ...circle, triangles: 1000 }, ...bowl.slice(1)], async (hand) => {
            const { page } = hand;
            await hand.key("b");
            await page.evaluate(() => {
                auxshell.latency.samples.length = 0;
                const stage = auxshell.stage.value;
                window.most = 0;
                let flying = 0;
                const submitted = stage.onSubmitted;
                stage.onSubmitted = (began) => {
                    const done = submitted(began);
                    window.most = Math.max(window.most, ++flying);
                    return () => (flying--, done());
                };
            });
            const [from, to] = [await hand.flat(0.35, 0.4), await hand.flat(0.65, 0.5)];
            await page.mouse.move(...from);
            await page.mouse.down();
            for (let k = 1; k <= 40; k++) await page.mouse.move(from[0] + ((to[0] - from[0]) * k) / 40, from[1] + ((to[1] - from[1]) * k) / 40);
            await page.waitForFunction(() => auxshell.latency.pending() === 0);
            const { samples, most } = await page.evaluate(() => ({ samples: auxshell.latency.samples, most: window.most }));
            await page.mouse.up();
            await hand.stepsAre("start_circle", "gradient_radial", "rim_circle", "inflation", "paint");
            assert.ok(samples.length >= 5, `${samples.length} previews were shown`);
            assert.equal(most, 1, "pictures with the renderer");
            const step = 0.2; // two threads' clocks are rounded, each by itself
            for (const s of samples) {
                const times = [s.moved, s.sent, s.arrived, s.came, s.began, s.submitted, s.drawn];
                assert.ok(times.every((v, k) => k === 0 || times[k - 1] <= v + step), JSON.stringify(s));
            }
            const all = samples.map((s) => s.drawn - s.moved).sort((a, b) => a - b);
            note(`${all.length} previews shown, median ${all[all.length >> 1].toFixed(0)} ms, p95 ${all[Math.floor(0.95 * all.length)].toFixed(0)} ms from hand to screen, in software`);
        });
    },

    async "what moves is drawn apart from the page, the same as by itself, and the page hears of it meanwhile"(browser) {
        await withStudio(browser, bowl, async (hand) => {
            const { page } = hand;
            await hand.key("b");
            const [from, to] = [await hand.flat(0.35, 0.4), await hand.flat(0.65, 0.5)];
            await page.mouse.move(...from);
            await page.mouse.down();
            for (let k = 1; !(await page.evaluate(() => auxshell.stage.value.isLive)); k++) {
                assert.ok(k < 400, "the worker's pictures did not come");
                await page.mouse.move(from[0] + (to[0] - from[0]) * Math.abs(Math.sin(k / 20)), from[1] + (to[1] - from[1]) * Math.abs(Math.cos(k / 20)));
            }
            const before = await page.evaluate(() => auxshell.session.frames.value);
            for (let k = 0; k < 30; k++) await page.mouse.move(from[0] + 3 * k, from[1] + k);
            await page.waitForFunction((n) => auxshell.session.frames.value > n, before); // states come to the page too
            await page.evaluate(() => auxshell.session.tell("pause"));
            await page.waitForFunction(() => !auxshell.shell().moving);
            await page.waitForTimeout(500);
            const pixels = (name) => page.evaluate((name) => {
                const { ground, [name]: canvas } = auxshell.stage.value.canvases;
                const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
                copy.drawImage(ground, 0, 0);
                copy.drawImage(canvas, 0, 0);
                window.pictures = { ...window.pictures, [name]: copy.getImageData(0, 0, canvas.width, canvas.height).data };
                return !canvas.hidden;
            }, name);
            await pixels("ground");
            assert.ok(await pixels("apart"), "the worker's canvas is seen");
            await page.evaluate(() => {
                const stage = auxshell.stage.value;
                stage.watch = null; // as in a browser without workers that draw
                stage.live.stop();
                stage.invalidate();
            });
            await page.waitForFunction(() => !auxshell.stage.value.isLive);
            assert.ok(await pixels("quick"), "the page draws itself");
            const [drawn, other] = await page.evaluate(() => {
                const { ground, apart, quick } = window.pictures;
                const unlike = (other) => (other.length === apart.length ? apart.filter((v, k) => Math.abs(v - other[k]) > 2).length : -1); // shares of a pixel are rounded
                return [unlike(ground), unlike(quick)];
            });
            assert.ok(drawn > 20000, `${drawn} bytes of the picture are drawn`);
            // the planes of a camera follow the bounds, and rounding says which of two equally far panels is seen
            assert.ok(other >= 0 && other < 1e-3 * drawn, `${other} of ${drawn} bytes differ`);
            await page.mouse.up();
            await hand.stepsAre("start_circle", "gradient_radial", "rim_circle", "inflation", "paint");
        });
    },
};
