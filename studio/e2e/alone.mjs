// A browser whose page nobody listens to: Playwright has every state that comes through the socket told to it, which takes as much of a
// small machine as the page itself. The DevTools protocol by a pipe, and what the measurement needs of it.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const flags = [
    "--headless", "--remote-debugging-pipe", "--use-angle=swiftshader-webgl", "--enable-unsafe-swiftshader", "--no-sandbox", "--disable-dev-shm-usage",
    "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-extensions", "--disable-field-trial-config",
    "--disable-breakpad", "--disable-stack-profiler", "--disable-features=Translate,OptimizationHints,MediaRouter", "--password-store=basic", "--mute-audio",
];

export class Browser {
    constructor(executable) {
        this.profile = mkdtempSync(join(tmpdir(), "auxshell-browser-"));
        this.process = spawn(executable, [...flags, `--user-data-dir=${this.profile}`, "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
        this.ended = new Promise((resolve) => this.process.once("exit", resolve));
        this.waiting = new Map();
        this.heard = () => undefined;
        this.count = 0;
        let rest = "";
        this.process.stdio[4].setEncoding("utf8").on("data", (chunk) => {
            const messages = (rest + chunk).split("\0");
            rest = messages.pop();
            messages.map((text) => JSON.parse(text)).forEach((message) => this.take(message));
        });
    }

    take({ id, result, error, method, params }) {
        if (!id) return this.heard(method, params);
        const { resolve, reject } = this.waiting.get(id);
        this.waiting.delete(id);
        if (error) reject(new Error(error.message));
        else resolve(result);
    }

    /** A command of the protocol, to the page. */
    send(method, params = {}) {
        return this.tell({ method, params, sessionId: this.session });
    }
    tell(message) {
        const id = ++this.count;
        this.process.stdio[3].write(`${JSON.stringify({ id, ...message })}\0`);
        return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
    }

    async open(address, width, height) {
        const { targetInfos } = await this.tell({ method: "Target.getTargets" });
        const { targetId } = targetInfos.find((t) => t.type === "page");
        this.session = (await this.tell({ method: "Target.attachToTarget", params: { targetId, flatten: true } })).sessionId;
        await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
        await this.send("Page.enable");
        await this.send("Page.addScriptToEvaluateOnNewDocument", { source: 'localStorage.setItem("auxshell.tour", "true")' });
        await this.send("Page.navigate", { url: address });
    }

    /** What an expression is in the page. */
    async value(expression) {
        const { result, exceptionDetails } = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
        if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
        return result.value;
    }

    async until(expression, timeout = 60000) {
        for (const end = Date.now() + timeout; !(await this.value(expression)); await new Promise((resolve) => setTimeout(resolve, 100)))
            if (Date.now() > end) throw new Error(`still not: ${expression}`);
    }

    async key(key) {
        const of = { key, code: `Key${key.toUpperCase()}`, windowsVirtualKeyCode: key.toUpperCase().charCodeAt(0) };
        await this.send("Input.dispatchKeyEvent", { type: "keyDown", text: key, ...of });
        await this.send("Input.dispatchKeyEvent", { type: "keyUp", ...of });
    }

    /** Does something and returns what the browser traced meanwhile. */
    async traced(includedCategories, action) {
        const events = [];
        const complete = new Promise((resolve) => {
            this.heard = (method, params) => {
                if (method === "Tracing.dataCollected") events.push(...params.value);
                else if (method === "Tracing.tracingComplete") resolve();
            };
        });
        await this.tell({ method: "Tracing.start", params: { transferMode: "ReportEvents", traceConfig: { includedCategories, excludedCategories: ["*"] } } });
        await action();
        await this.tell({ method: "Tracing.end" });
        await complete;
        return events;
    }

    async close() {
        await this.tell({ method: "Browser.close" });
        await this.ended;
        rmSync(this.profile, { recursive: true, force: true });
    }
}
