// Everything that a key, a button or the shortcuts list can do, once. A key is written as people read it: "Ctrl+Shift+Z".
import { signal } from "@preact/signals";
import { tools } from "../tools";
import { pointer, toolId } from "../tools/tool";
import { playMotion, scrub, stepMotion } from "./motion";
import { clearSelection, select, selected } from "./selection";
import { command, currentShell, documentState, progress, readOnly, status } from "./session";
import { layout, theme, darkTheme } from "./settings";
import { dialog, drawerOpen, mode, page, stage, tourStep } from "./view";

export interface Command {
    id: string;
    title: string;
    keys: string[];
    group: "File" | "Edit" | "View" | "Deployment" | "Tools";
    run(): void;
    when?(): boolean;
}

/** What a screen reader should say next. */
export const announcement = signal("");

const open = () => documentState.value !== null;
const editable = () => open() && readOnly.value === null;

export async function finish(): Promise<void> {
    const answer = await command("finish");
    if (answer) announcement.value = answer.exact ? "The design is exact." : String(answer.reason);
}

export async function save(): Promise<void> {
    if (!documentState.value?.path) {
        dialog.value = "save";
        return;
    }
    if (await command("save")) announcement.value = "Saved.";
}

export async function savePicture(): Promise<void> {
    const blob = await stage.value?.picture();
    if (blob) download(URL.createObjectURL(blob), `${documentState.value?.name ?? "shell"}.png`);
}

export function download(url: string, name: string): void {
    const link = document.createElement("a");
    link.href = url;
    link.download = name;
    link.click();
}

export function togglePlay(): void {
    if (status.value?.solver === "playing") void command("pause");
    else void command("play");
}

function cyclePanel(by: number): void {
    const n = currentShell()?.linkage.panels ?? 0;
    if (!n) return;
    const last = [...selected.value].at(-1);
    select([last === undefined ? 0 : (last + by + n) % n]);
    announcement.value = `Panel ${currentShell()!.name([...selected.value][0])}`;
}

const mainView = () => stage.value?.views[stage.value.shown.includes("deployed") ? "deployed" : stage.value.shown[0]];

export const commands: Command[] = [
    { id: "start", title: "Start page", keys: ["Ctrl+Alt+N"], group: "File", run: () => (page.value = "start") },
    { id: "open", title: "Open", keys: ["Ctrl+O"], group: "File", run: () => (dialog.value = "open") },
    { id: "save", title: "Save", keys: ["Ctrl+S"], group: "File", run: () => void save(), when: editable },
    { id: "save-as", title: "Save under a name", keys: ["Ctrl+Shift+S"], group: "File", run: () => (dialog.value = "save"), when: open },
    { id: "export", title: "Export", keys: ["Ctrl+E"], group: "File", run: () => (dialog.value = "export"), when: open },
    { id: "picture", title: "Picture of the view", keys: ["Ctrl+Shift+E"], group: "File", run: () => void savePicture(), when: open },
    { id: "undo", title: "Undo", keys: ["Ctrl+Z"], group: "Edit", run: () => void command("undo"), when: () => editable() && documentState.value!.undo !== null },
    { id: "redo", title: "Redo", keys: ["Ctrl+Shift+Z", "Ctrl+Y"], group: "Edit", run: () => void command("redo"), when: () => editable() && documentState.value!.redo !== null },
    { id: "finish", title: "Finish: make it exact", keys: ["Ctrl+Enter"], group: "Edit", run: () => void finish(), when: () => editable() && progress.value === null },
    { id: "cancel", title: "Cancel what is computed", keys: ["Ctrl+."], group: "Edit", run: () => void command("cancel"), when: () => progress.value !== null },
    {
        id: "all", title: "Select all panels", keys: ["Ctrl+A"], group: "Edit", when: open,
        run: () => select(Array.from({ length: currentShell()?.linkage.panels ?? 0 }, (_, k) => k)),
    },
    { id: "none", title: "Select nothing", keys: ["Ctrl+Shift+A"], group: "Edit", run: clearSelection },
    { id: "next", title: "Next panel", keys: ["N"], group: "Edit", run: () => cyclePanel(1), when: open },
    { id: "previous", title: "Previous panel", keys: ["Shift+N"], group: "Edit", run: () => cyclePanel(-1), when: open },
    { id: "flat", title: "Flat view", keys: ["1"], group: "View", run: () => (layout.value = "flat") },
    { id: "deployed", title: "Deployed view", keys: ["2"], group: "View", run: () => (layout.value = "deployed") },
    { id: "both", title: "Both views", keys: ["3"], group: "View", run: () => (layout.value = "both") },
    { id: "four", title: "Four views", keys: ["4"], group: "View", run: () => (layout.value = "four") },
    { id: "frame", title: "Show all", keys: ["Home", "A"], group: "View", run: () => stage.value?.shown.forEach((id) => stage.value!.frame(stage.value!.views[id])) },
    {
        id: "frame-selection", title: "Show the selection", keys: ["."], group: "View",
        run: () => void (selected.value.size && stage.value?.lookAt([...selected.value])),
    },
    { id: "perspective", title: "From the corner", keys: ["0"], group: "View", run: () => preset("perspective") },
    { id: "top", title: "From the top", keys: ["7"], group: "View", run: () => preset("top") },
    { id: "front", title: "From the front", keys: ["8"], group: "View", run: () => preset("front") },
    { id: "right", title: "From the right", keys: ["9"], group: "View", run: () => preset("right") },
    {
        id: "projection", title: "Perspective or parallel", keys: ["5"], group: "View",
        run: () => {
            const view = mainView();
            if (!view) return;
            view.orbit.pose = { ...view.orbit.pose, projection: view.orbit.pose.projection === "parallel" ? "perspective" : "parallel" };
            stage.value!.invalidate();
        },
    },
    ...([["Left", -1, 0], ["Right", 1, 0], ["Up", 0, -1], ["Down", 0, 1]] as const).map(([name, x, y]): Command => ({
        id: `orbit-${name}`, title: `Turn the view ${name.toLowerCase()}`, keys: [`Arrow${name}`], group: "View",
        run: () => {
            const view = mainView();
            if (view?.state === "flat") view.orbit.pan(-40 * x, -40 * y, view.rect.height);
            else view?.orbit.orbit(-30 * x, -30 * y);
            stage.value?.invalidate();
        },
    })),
    { id: "closer", title: "Closer", keys: ["+", "="], group: "View", run: () => zoom(0.85) },
    { id: "further", title: "Further away", keys: ["-"], group: "View", run: () => zoom(1 / 0.85) },
    { id: "table", title: "Panel table", keys: ["T"], group: "View", run: () => (dialog.value = "table"), when: open },
    { id: "theme", title: "Light or dark", keys: ["Ctrl+Alt+T"], group: "View", run: () => (theme.value = darkTheme.value ? "light" : "dark") },
    { id: "design", title: "Design", keys: ["Alt+1"], group: "View", run: () => (mode.value = "design") },
    { id: "analyse", title: "Analyse", keys: ["Alt+2"], group: "View", run: () => (mode.value = "analyse") },
    { id: "variants", title: "Variants", keys: ["Alt+3"], group: "View", run: () => (mode.value = "variants") },
    { id: "inspector", title: "Inspector", keys: ["Alt+I"], group: "View", run: () => (drawerOpen.value = !drawerOpen.value) },
    { id: "shortcuts", title: "Keyboard shortcuts", keys: ["?"], group: "View", run: () => (dialog.value = "shortcuts") },
    { id: "tour", title: "Tour", keys: ["Ctrl+Alt+H"], group: "View", run: () => (tourStep.value = 0) },
    { id: "motion", title: "Play the deployment", keys: ["Space"], group: "Deployment", run: () => void playMotion(), when: open },
    { id: "motion-back", title: "One frame back", keys: [","], group: "Deployment", run: () => stepMotion(-1), when: open },
    { id: "motion-on", title: "One frame on", keys: ["Shift+."], group: "Deployment", run: () => stepMotion(1), when: open },
    { id: "motion-end", title: "At rest", keys: ["End"], group: "Deployment", run: () => void scrub(1), when: open },
    { id: "play", title: "Run or pause the solver", keys: ["R"], group: "Deployment", run: togglePlay, when: editable },
    { id: "step", title: "One step of the solver", keys: ["Shift+R"], group: "Deployment", run: () => void command("step", { iterations: 1 }), when: editable },
    { id: "settle", title: "Settle", keys: ["Shift+Space"], group: "Deployment", run: () => void command("settle"), when: editable },
    ...tools.map((t): Command => ({
        id: `tool-${t.id}`, title: t.title, keys: [t.shortcut], group: "Tools",
        run: () => {
            toolId.value = t.id;
            mode.value = mode.value === "variants" ? "design" : mode.value;
            pointer.value?.stage.invalidateOverlay();
        },
    })),
];

function preset(p: "perspective" | "top" | "front" | "right"): void {
    const view = mainView();
    if (view && view.state === "space") stage.value!.usePreset(view, p);
}

function zoom(factor: number): void {
    mainView()?.orbit.zoom(factor, 0, 0);
    stage.value?.invalidate();
}

export function commandNamed(id: string): Command {
    return commands.find((c) => c.id === id)!;
}

/** A key press as it is written in `keys`. */
export function keyOf(event: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "altKey" | "shiftKey">): string {
    let key = event.key === " " ? "Space" : event.key.length === 1 ? event.key.toUpperCase() : event.key;
    // signs that need Shift on many keyboards are named by the sign alone
    const sign = event.key.length === 1 && !/[a-z0-9.,]/i.test(event.key) && event.key !== " ";
    if (key === ">") key = ".";
    const parts = [event.ctrlKey || event.metaKey ? "Ctrl" : "", event.altKey ? "Alt" : "", event.shiftKey && (!sign || event.key === ">") ? "Shift" : "", key];
    return parts.filter(Boolean).join("+");
}

const byKey = new Map(commands.flatMap((c) => c.keys.map((k) => [k, c] as const)));

export function commandFor(event: KeyboardEvent): Command | undefined {
    return byKey.get(keyOf(event));
}
