// A studio as a process, a browser, and the page in it: what every scenario stands on.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const command = process.env.AUXSHELL;

/** As on a computer without a graphics card: WebGL in software, and the page put together without it. */
export function launch() {
    return chromium.launch({
        executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
        args: ["--use-angle=swiftshader-webgl", "--enable-unsafe-swiftshader", "--no-sandbox", "--disable-dev-shm-usage"],
    });
}

export class Studio {
    constructor(folder) {
        this.folder = folder ?? mkdtempSync(join(tmpdir(), "auxshell-page-"));
    }

    async start(...words) {
        this.process = spawn(command, ["studio", ...(words.length ? words : ["."]), "--no-browser"], {
            cwd: this.folder, env: { ...process.env, XDG_STATE_HOME: join(this.folder, ".state"), TMPDIR: this.folder }, stdio: ["ignore", "pipe", "pipe"],
        });
        this.ended = new Promise((resolve) => this.process.once("exit", resolve));
        this.address = await new Promise((resolve, reject) => {
            let text = "";
            const take = (chunk) => {
                text += chunk;
                const found = /http:\/\/127\.0\.0\.1:\d+\/\w+\//.exec(text);
                if (found) resolve(found[0]);
            };
            this.process.stdout.on("data", take);
            this.process.stderr.on("data", (chunk) => (text += chunk));
            this.process.once("exit", (code) => reject(new Error(`the studio ended with ${code}: ${text}`)));
        });
        return this;
    }

    async stop(signal = "SIGINT") {
        if (this.process && this.process.exitCode === null && this.process.signalCode === null) this.process.kill(signal);
        await this.ended;
    }

    async remove() {
        await this.stop("SIGKILL");
        rmSync(this.folder, { recursive: true, force: true });
    }
}

/** The page as a user has it, with what scenarios ask of it again and again. */
export class Hand {
    constructor(page) {
        this.page = page;
        this.errors = [];
        page.on("pageerror", (error) => this.errors.push(String(error.stack ?? error)));
        page.on("console", (m) => {
            // a lost link and a missing gallery picture are said by the browser itself
            if (m.type() === "error" && !/WebSocket|Failed to load resource|ERR_/.test(m.text())) this.errors.push(m.text());
        });
    }

    /** `refines`: pictures at rest are whole. Without a graphics card they take longer than what is tried meanwhile. */
    static async open(browser, address, options = {}) {
        const { refines = false, ...rest } = options;
        const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true, ...rest });
        await context.addInitScript(() => localStorage.setItem("auxshell.tour", "true"));
        const hand = new Hand(await context.newPage());
        await hand.page.goto(address);
        if (!refines) await hand.page.waitForFunction(() => auxshell.stage.value && ((auxshell.stage.value.refines = false), true));
        await hand.ready();
        return hand;
    }

    /** A shell is there, and its report. */
    async ready() {
        await this.page.waitForFunction(() => auxshell.shell() !== null, null, { timeout: 60000 });
        await this.rest();
    }

    /** Nothing is solved any more, the checks are in, and the shell here is the one that they are about. */
    async rest(timeout = 120000) {
        await this.page.waitForFunction(() => {
            const s = auxshell.session;
            const shell = auxshell.shell();
            return s.status.value?.solver === "idle" && s.progress.value === null && shell !== null && (shell.flags & 4) === 0
                && s.report.value?.revision === shell.revision;
        }, null, { timeout });
    }

    steps() {
        return this.page.evaluate(() => auxshell.session.documentState.value.steps.map((s) => s.operator.op));
    }
    at() {
        return this.page.evaluate(() => auxshell.session.documentState.value.at);
    }
    async stepsAre(...ops) {
        await this.page.waitForFunction((wanted) => {
            const d = auxshell.session.documentState.value;
            return d && JSON.stringify(d.steps.map((s) => s.operator.op)) === JSON.stringify(wanted);
        }, ops, { timeout: 120000 });
        await this.rest();
    }
    async atIs(n) {
        await this.page.waitForFunction((wanted) => auxshell.session.documentState.value?.at === wanted, n, { timeout: 120000 });
        await this.rest();
    }

    /** All places in the document's frame: flat, deployed, simulated. */
    places() {
        return this.page.evaluate(() => {
            const s = auxshell.shell();
            const moved = (places, origin) => [...(places ?? [])].map((v, k) => v + origin[k % 3]);
            return [...moved(s.flat, [...s.flatOrigin, 0]), ...moved(s.deployed, s.origin), ...moved(s.simulated, s.origin)];
        });
    }
    /** The other tab comes to show the same: frames reach every client, though not at one moment. */
    async sameAs(other) {
        const end = Date.now() + 30000;
        let [mine, theirs] = [await this.places(), await other.places()];
        while (JSON.stringify(mine) !== JSON.stringify(theirs)) {
            if (Date.now() > end) throw new Error("two tabs show different places");
            await this.page.waitForTimeout(100);
            [mine, theirs] = [await this.places(), await other.places()];
        }
    }
    figures() {
        return this.page.evaluate(() => {
            const s = auxshell.shell();
            return { panels: s.linkage.panels, least: Math.min(...s.realised), most: Math.max(...s.realised), prescribed: Math.max(...s.prescribed), lowest: Math.min(...s.deployed.filter((_, k) => k % 3 === 2)), simulated: s.simulated !== null };
        });
    }

    key(key) {
        return this.page.keyboard.press(key);
    }
    /** A place of the flat view (0 to 1 both ways) in page coordinates. */
    async flat(u, v) {
        const box = await this.page.evaluate(() => {
            const s = auxshell.stage.value;
            const r = s.canvas.getBoundingClientRect();
            const view = s.views.flat.rect;
            return { x: r.left + view.x, y: r.top + view.y, width: view.width, height: view.height };
        });
        return [box.x + u * box.width, box.y + v * box.height];
    }
    async drag(from, to, moves = 12, pause = 16) {
        const { mouse } = this.page;
        await mouse.move(...from);
        await mouse.down();
        for (let k = 1; k <= moves; k++) {
            await mouse.move(from[0] + ((to[0] - from[0]) * k) / moves, from[1] + ((to[1] - from[1]) * k) / moves);
            await this.page.waitForTimeout(pause);
        }
        await mouse.up();
    }

    /** Files dropped on the page, as from a folder. */
    async drop(name, bytes) {
        const transfer = await this.page.evaluateHandle(([n, b]) => {
            const t = new DataTransfer();
            t.items.add(new File([Uint8Array.from(b)], n));
            return t;
        }, [name, [...bytes]]);
        await this.page.dispatchEvent("body", "dragover", { dataTransfer: transfer });
        await this.page.dispatchEvent("body", "drop", { dataTransfer: transfer });
    }
}
