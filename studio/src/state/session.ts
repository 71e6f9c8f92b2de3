// What the server said last. Components read the signals; the scene listens to `onShell`, which is called for every frame.
import { batch, computed, signal } from "@preact/signals";
import { type Frame, kinds, section } from "../protocol/frames";
import { CommandError, type Connect, Link } from "../protocol/link";
import type {
    Check, DocumentEvent, Hello, LinkageEvent, OperatorCall, OperatorSchema, Problem, ProgressEvent, ReportEvent, ServerEvent,
    StatusEvent, VariantsEvent,
} from "../protocol/types";
import { medianEdge } from "../panels/linkage";
import { Newest } from "./newest";
import { gestureEnded, previewLeft, stateArrived, statesGathered } from "./latency";
import { Shell } from "../panels/shell";

export type Connection = "connecting" | "open" | "lost";

export const connection = signal<Connection>("connecting");
export const hello = signal<Hello | null>(null);
export const documentState = signal<DocumentEvent | null>(null);
export const status = signal<StatusEvent | null>(null);
export const report = signal<ReportEvent | null>(null);
export const variants = signal<VariantsEvent["variants"]>([]);
export const progress = signal<ProgressEvent | null>(null);
/** The last thing that went wrong, shown beside its cause until dismissed or superseded. */
export const problem = signal<{ error: Problem; about: string } | null>(null);
export const closedMessage = signal<string | null>(null);
/** States are shown of a document that is still being made. */
export const making = signal(false);

/** The shell itself is no signal: it changes 60 times a second. `topology` rises with every linkage, `revision`
 *  with every frame. */
let shell: Shell | null = null;
export const topology = signal(0);
/** Rises with the frames, at most once per animation frame: for what is seen to move. */
export const frames = signal(0);
/** The same for words and figures: a few times a second while things move. */
export const revision = signal(0);
const readings = 150; // ms
/** What is drawn elsewhere can wait here for the next picture. */
const unhurried = 50; // ms
export const currentShell = () => shell;

/** The panel edge L, for figures that are given over it. */
export const panelEdge = computed(() => {
    topology.value;
    report.value;
    return shell ? medianEdge(shell.linkage, shell.flat) : 1;
});

export type ShellListener = (shell: Shell, change: { linkage: boolean; frame: Frame }) => void;
const shellListeners = new Set<ShellListener>();
export function onShell(listener: ShellListener): () => void {
    shellListeners.add(listener);
    return () => shellListeners.delete(listener);
}
type FrameListener = (frame: Frame, linkage: LinkageEvent | null) => void;
const frameListeners = new Set<FrameListener>();
/** Frames that are not the document's state: surfaces, motions, variants. */
export function onOtherFrame(listener: FrameListener): () => void {
    frameListeners.add(listener);
    return () => frameListeners.delete(listener);
}

let link: Link | null = null;
let announced: LinkageEvent | null = null;
let announcedVariant: LinkageEvent | null = null;

export const operators = computed(() => hello.value?.operators ?? []);
export function operatorNamed(name: string): OperatorSchema | undefined {
    return operators.value.find((o) => o.name === name);
}
export const checks = computed<Check[]>(() => report.value?.checks ?? []);
export const readOnly = computed(() => documentState.value?.read_only ?? null);

export function connect(to: Connect): void {
    link = new Link(to, { event: receive, frame: receiveBinary, opened: () => undefined, lost: () => (connection.value = "lost") });
    link.start();
}

export function reconnect(): void {
    connection.value = "connecting";
    link?.start();
}

function rememberedDocument(): string | null {
    return new URLSearchParams(location.hash.slice(1)).get("document");
}

function remember(id: string): void {
    const url = `#document=${encodeURIComponent(id)}`;
    if (location.hash !== url) history.replaceState(null, "", url);
}

/** States that may be on their way to the screen. */
const ahead = 2;

async function join(event: Hello): Promise<void> {
    const known = documentState.value?.id ?? rememberedDocument();
    try {
        await link!.ask("join", known ? { document: known, ahead } : { ahead });
    } catch (error) {
        if (!known) throw error;
        // the server was started anew; what was no file then is among the recovered
        if (event.recovered.some((r) => r.name === known)) await link!.ask("open", { recovered: known });
        else await link!.ask("join", { ahead });
    }
    connection.value = "open";
}

function receive(event: ServerEvent): void {
    switch (event.event) {
        case "hello":
            hello.value = event;
            unseen = 0;
            closedMessage.value = null;
            join(event).catch((error: unknown) => showProblem(error, "join"));
            break;
        case "document":
            remember(event.id);
            making.value = false;
            documentState.value = event;
            break;
        case "linkage":
            if (event.variant !== undefined) announcedVariant = event;
            else {
                announced = event;
                making.value = event.document !== documentState.value?.id;
            }
            break;
        case "status":
            status.value = event;
            break;
        case "report":
            report.value = event;
            break;
        case "variants":
            variants.value = event.variants;
            break;
        case "progress":
            progress.value = event.done ? null : event;
            break;
        case "problem":
            problem.value = { error: event.error, about: event.do ?? "" };
            break;
        case "closed":
            making.value = false;
            progress.value = null;
            closedMessage.value = event.message;
            break;
        case "bye":
            closedMessage.value = event.message;
            break;
    }
}

function showProblem(error: unknown, about: string): void {
    const p: Problem = error instanceof CommandError ? error.problem
        : { status: 1, word: "failed", message: error instanceof Error ? error.message : String(error) };
    if (p.word !== "cancelled") problem.value = { error: p, about };
}

// The server sends a state when the last one was acknowledged, and then the newest: none waits here, and none is drawn late. They are
// acknowledged as they come, unless the renderer is at a picture.
let unseen = 0;
const never = () => false;
let held: () => boolean = never;
export function acknowledge(): void {
    for (; unseen > 0; unseen--) link?.tell("seen");
}

/** Every state goes to the port at once and comes here gathered, from when `begun` is called, until null is given. */
export const watchStates = (port: MessagePort | null, begun?: () => void): boolean => link?.watch(port, begun) ?? false;

/** From now on states that come while `busy` wait for `acknowledge`, until the function that is returned is called. */
export function holdStates(busy: () => boolean): () => void {
    held = busy;
    return () => {
        held = never;
        acknowledge();
    };
}
if (typeof document !== "undefined") document.addEventListener("visibilitychange", acknowledge);

let pendingFrame = false;
let readAt = -Infinity;
let reading: ReturnType<typeof setTimeout> | undefined;
/** Tells everyone that the shell has changed, if it has. */
export function settleFrames(): void {
    if (!pendingFrame) return;
    pendingFrame = false;
    const wait = shell?.moving ? readAt + readings - performance.now() : 0;
    batch(() => {
        frames.value++;
        if (wait <= 0) read();
        else reading ??= setTimeout(read, wait);
    });
}
function read(): void {
    clearTimeout(reading);
    reading = undefined;
    readAt = performance.now();
    revision.value++;
}

function receiveBinary(frame: Frame, gathered: boolean): void {
    if (frame.kind !== kinds.state) {
        for (const listener of frameListeners) listener(frame, frame.kind === kinds.variant ? announcedVariant : null);
        return;
    }
    if (gathered) statesGathered(frame);
    else {
        stateArrived(frame);
        unseen++;
    }
    if (!receiveState(frame, gathered) || !held() || document.hidden) acknowledge();
}

/** False when it is of a linkage that was replaced meanwhile. */
function receiveState(frame: Frame, gathered: boolean): boolean {
    let linkage = false;
    // documents count their linkages alike: what makes a new one is that its triangles come
    if (!shell || frame.topology !== shell.topology || frame.sections.has(section.triangles)) {
        if (!announced || announced.topology !== frame.topology || !frame.sections.has(section.triangles)) return false;
        shell = new Shell(announced, frame);
        linkage = true;
        batch(() => {
            topology.value++;
            frames.value++;
            revision.value++;
        });
    } else shell.take(frame);
    for (const listener of shellListeners) listener(shell, { linkage, frame });
    if (!pendingFrame) {
        pendingFrame = true;
        if (gathered) setTimeout(settleFrames, unhurried);
        else requestAnimationFrame(settleFrames);
    }
    return true;
}

/** A command whose failure is shown; resolves to null then. */
export async function command(name: string, parameters: Record<string, unknown> = {}): Promise<Record<string, unknown> | null> {
    if (problem.value?.about === name) problem.value = null;
    try {
        return await link!.ask(name, parameters);
    } catch (error) {
        showProblem(error, name);
        return null;
    } finally {
        if (name === "new" || name === "open") progress.value = null; // of a document that may never have come
    }
}

/** A command whose failure the caller handles. */
export function ask(name: string, parameters: Record<string, unknown> = {}): Promise<Record<string, unknown>> {
    return link ? link.ask(name, parameters) : Promise.reject(new Error("There is no server."));
}

export function nextCommandId(): number {
    return link?.nextId ?? 0;
}

const previews = new Newest<OperatorCall | null>((operator) => {
    if (!link) return;
    const serial = link.nextSerial();
    if (operator) previewLeft(serial);
    link.tell("preview", { serial, operator });
});
const grabs = new Newest<{ hinge: number; to: [number, number, number] }>((g) => link?.tell("grab", { ...g, serial: link.nextSerial() }));

/** Rises when the hand asks for states. */
export const handAsks = signal(0);

/** What the operator would do is shown at once; null: it is not to be done. */
export function preview(operator: OperatorCall | null): void {
    previews.put(operator);
    if (operator) handAsks.value++;
}
/** Holds a hinge at a place of the document's frame while the solver runs. */
export function grab(hinge: number, to: [number, number, number]): void {
    grabs.put({ hinge, to });
    handAsks.value++;
}

export function release(): void {
    grabs.drop();
    link?.tell("release");
}

export function tell(name: string, parameters: Record<string, unknown> = {}): void {
    link?.tell(name, parameters);
}

export async function apply(operator: OperatorCall): Promise<boolean> {
    previews.drop(); // the step holds all of the gesture
    gestureEnded();
    return (await command("apply", { operator })) !== null;
}
