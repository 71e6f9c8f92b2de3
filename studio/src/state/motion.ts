// The way from flat to deployed, as the solver went it: frames that it computed, shown one by one and never in between.
import { signal } from "@preact/signals";
import { kinds, section } from "../protocol/frames";
import { CommandError } from "../protocol/link";
import { ask, currentShell, onOtherFrame, onShell, problem } from "./session";
import { reducedMotion } from "./settings";

interface Motion {
    frames: Float32Array[];
    shares: number[];
    total: number;
    computing: boolean;
    playing: boolean;
    /** Which frame is shown; null: the document's own state. */
    shown: number | null;
}
const none: Motion = { frames: [], shares: [], total: 0, computing: false, playing: false, shown: null };
export const motion = signal<Motion>(none);

let ofRevision = -1;
const change = (part: Partial<Motion>) => (motion.value = { ...motion.value, ...part });

onOtherFrame((frame) => {
    if (frame.kind !== kinds.motion || !motion.value.computing) return;
    const place = frame.sections.get(section.place);
    const places = frame.sections.get(section.deployed);
    const share = frame.sections.get(section.share);
    if (!place || !places || !share) return;
    const frames = motion.value.frames.slice();
    const shares = motion.value.shares.slice();
    frames[place[0]] = places as Float32Array;
    shares[place[0]] = share[0];
    change({ frames, shares, total: place[1] });
});

// a frame of another state: the motion no longer leads to what the document is
onShell((shell, { linkage }) => {
    if (linkage || (motion.value.frames.length > 0 && shell.revision !== ofRevision && !motion.value.computing)) motion.value = none;
});

/** Asks the solver for the way, unless it is known; false if there is none. */
export async function computeMotion(): Promise<boolean> {
    const shell = currentShell();
    if (!shell) return false;
    if (motion.value.frames.length && ofRevision === shell.revision) return true;
    motion.value = { ...none, computing: true, playing: motion.value.playing };
    try {
        await ask("motion", { frames: 90 });
        ofRevision = currentShell()?.revision ?? -1;
        change({ computing: false });
        return motion.value.frames.length > 0;
    } catch (error) {
        motion.value = none;
        if (!(error instanceof CommandError && error.problem.word === "cancelled"))
            problem.value = { about: "motion", error: error instanceof CommandError ? error.problem : { status: 1, word: "failed", message: String(error) } };
        return false;
    }
}

let timer: ReturnType<typeof setInterval> | undefined;
const pace = 33; // ms between states, where the solver is no slower

/** States follow one another as soon as they are there. */
export async function playMotion(): Promise<void> {
    if (motion.value.playing) {
        stopMotion();
        return;
    }
    const known = motion.value.frames.length > 0 && ofRevision === currentShell()?.revision;
    change({ playing: true });
    if (reducedMotion.value) {
        await computeMotion();
        change({ playing: false, shown: motion.value.frames.length ? 0 : null });
        return;
    }
    const from = known ? motion.value.shown ?? Infinity : Infinity;
    let k = from < motion.value.frames.length - 1 ? from : 0;
    clearInterval(timer);
    timer = setInterval(() => {
        const { frames, computing, playing } = motion.value;
        if (!playing) clearInterval(timer);
        else if (frames[k]) change({ shown: k++ });
        else if (!computing && k >= frames.length) {
            stopMotion();
            change({ shown: null });
        }
    }, pace);
    if (!(await computeMotion())) stopMotion();
}

export function stopMotion(): void {
    clearInterval(timer);
    if (motion.value.computing) void ask("cancel").catch(() => undefined);
    change({ playing: false });
}

/** Shows the computed state nearest to a share of the way, 0 flat to 1 at rest. */
export async function scrub(share: number): Promise<void> {
    clearInterval(timer);
    if (share >= 1) {
        change({ shown: null, playing: false });
        return;
    }
    change({ playing: false });
    if (!motion.value.frames.length && !motion.value.computing && !(await computeMotion())) return;
    const { shares } = motion.value;
    let best = 0;
    shares.forEach((s, k) => {
        if (Math.abs(s - share) < Math.abs(shares[best] - share)) best = k;
    });
    change({ shown: best });
}

/** One state of the way; null: the document's own. */
export function showFrame(shown: number | null): void {
    change({ shown, playing: false });
}

export function stepMotion(by: number): void {
    const { frames, shown } = motion.value;
    if (!frames.length) return void scrub(by < 0 ? 0.98 : 0);
    const next = (shown ?? frames.length) + by;
    change({ playing: false, shown: next >= frames.length ? null : Math.max(0, next) });
}

/** 0 to 1: where the slider stands. */
export function shownShare(): number {
    const { shown, shares } = motion.value;
    return shown === null ? 1 : (shares[shown] ?? shown / Math.max(1, motion.value.total - 1));
}
