// Videos of the views as they are drawn: a turn about the shell, or the states of the deployment one after the other. Every picture has its
// place in time, however long it takes to draw.
import { signal } from "@preact/signals";
import { announcement, download } from "./commands";
import { computeMotion, motion, showFrame } from "./motion";
import { documentState, problem } from "./session";
import { stage } from "./view";
import { type Block, webm } from "./webm";

/** What is recorded, and how much of it has been, 0 to 1. */
export const recording = signal<{ what: "turntable" | "deployment"; share: number } | null>(null);
let cancelled = false;
export const cancelRecording = () => void (cancelled = true);

const next = () => new Promise((resolve) => setTimeout(resolve));
const seconds = { turntable: 12, deployment: 6 };
/** Pictures of the turn; fewer where one takes longer than `patience`, milliseconds. */
const turns = { many: 300, few: 144 };
const patience = 100;

export async function record(what: "turntable" | "deployment"): Promise<void> {
    const views = stage.value;
    if (!views || recording.value) return;
    if (typeof VideoEncoder === "undefined") {
        problem.value = { about: "video", error: { status: 1, word: "failed", message: "This browser cannot make videos. Chromium, Safari 16.4 and Firefox 130 can." } };
        return;
    }
    if (what === "deployment" && !(await computeMotion())) return;
    cancelled = false;
    recording.value = { what, share: 0 };
    announcement.value = "Recording.";
    const size = views.pictureSize;
    const canvas = Object.assign(document.createElement("canvas"), size);
    const context = canvas.getContext("2d", { willReadFrequently: true })!;
    const [width, height] = [size.width & ~1, size.height & ~1];
    const blocks: Block[] = [];
    let fault: DOMException | null = null;
    const encoder = new VideoEncoder({
        output: (chunk) => {
            const bytes = new Uint8Array(chunk.byteLength);
            chunk.copyTo(bytes);
            blocks.push({ bytes, time: Math.round(chunk.timestamp / 1000), key: chunk.type === "key" });
        },
        error: (e) => (fault = e),
    });
    const space = views.shown.map((id) => views.views[id]).filter((v) => v.state === "space");
    const before = space.map((v) => v.orbit.pose);
    try {
        views.paintOn(context); // with shaders to compile
        const began = performance.now();
        views.paintOn(context);
        const count = what === "deployment" ? motion.value.frames.length : performance.now() - began > patience ? turns.few : turns.many;
        const duration = 1e6 * seconds[what];
        encoder.configure({ codec: "vp8", width, height, bitrate: 12e6, framerate: (1e6 * count) / duration });
        for (let k = 0; k < count && !cancelled && !fault; k++) {
            if (what === "turntable") space.forEach((v, i) => v.orbit.go({ ...before[i], azimuth: before[i].azimuth + (360 * k) / count }, false));
            else showFrame(k);
            views.paintOn(context);
            const frame = new VideoFrame(canvas, { timestamp: Math.round((duration * k) / count), visibleRect: { x: 0, y: 0, width, height } });
            encoder.encode(frame, { keyFrame: k % 48 === 0 });
            frame.close();
            recording.value = { what, share: (k + 1) / count };
            do await next();
            while (encoder.encodeQueueSize > 4);
        }
        if (!cancelled && !fault) await encoder.flush();
        if (fault) throw fault as DOMException;
        if (!cancelled) download(URL.createObjectURL(webm("V_VP8", width, height, duration / 1000, blocks)), `${documentState.value?.name ?? "shell"}-${what}.webm`);
    } catch (error) {
        problem.value = { about: "video", error: { status: 1, word: "failed", message: `The video could not be made: ${error instanceof Error ? error.message : String(error)}` } };
    } finally {
        if (encoder.state !== "closed") encoder.close();
        space.forEach((v, k) => v.orbit.go(before[k], false));
        showFrame(null);
        views.invalidate();
        recording.value = null;
    }
}
