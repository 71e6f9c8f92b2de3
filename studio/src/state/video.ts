// Videos of the views as they are drawn: a turn about the shell, or the states of the deployment one after the other.
import { signal } from "@preact/signals";
import { announcement, download } from "./commands";
import { computeMotion, motion, showFrame } from "./motion";
import { documentState, problem } from "./session";
import { stage } from "./view";

export const recording = signal("");

const next = () => new Promise((resolve) => requestAnimationFrame(resolve));

export async function record(what: "turntable" | "deployment"): Promise<void> {
    const views = stage.value;
    if (!views || recording.value) return;
    if (typeof MediaRecorder === "undefined" || !MediaRecorder.isTypeSupported("video/webm")) {
        problem.value = { about: "video", error: { status: 1, word: "failed", message: "This browser cannot record videos. Export GLB instead, which holds the motion." } };
        return;
    }
    if (what === "deployment" && !(await computeMotion())) return;
    const canvas = Object.assign(document.createElement("canvas"), views.pictureSize);
    const context = canvas.getContext("2d")!;
    const parts: Blob[] = [];
    const recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: "video/webm", videoBitsPerSecond: 12e6 });
    recorder.ondataavailable = (event) => void parts.push(event.data);
    const ended = new Promise((resolve) => (recorder.onstop = resolve));
    const space = views.shown.map((id) => views.views[id]).filter((v) => v.state === "space");
    const before = space.map((v) => v.orbit.pose);
    recording.value = what;
    announcement.value = "Recording.";
    recorder.start();
    try {
        const seconds = what === "turntable" ? 12 : 6;
        const start = performance.now();
        for (let share = 0; share < 1; ) {
            share = Math.min(1, (performance.now() - start) / 1000 / seconds);
            if (what === "turntable") space.forEach((v, k) => v.orbit.go({ ...before[k], azimuth: before[k].azimuth + 360 * share }, false));
            else showFrame(Math.min(motion.value.frames.length - 1, Math.floor(share * motion.value.frames.length)));
            views.paintOn(context);
            await next();
        }
    } finally {
        recorder.stop();
        await ended;
        space.forEach((v, k) => v.orbit.go(before[k], false));
        showFrame(null);
        views.invalidate();
        recording.value = "";
    }
    download(URL.createObjectURL(new Blob(parts, { type: "video/webm" })), `${documentState.value?.name ?? "shell"}-${what}.webm`);
}
