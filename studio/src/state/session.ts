// What the server said last. Components read the signals; the scene listens to `onShell`, which is called for every frame.
import { batch, computed, signal } from "@preact/signals";
import { type Frame, kinds, section } from "../protocol/frames";
import { CommandError, type Connect, Link } from "../protocol/link";
import type {
    Check, DocumentEvent, Hello, LinkageEvent, OperatorCall, OperatorSchema, Problem, ProgressEvent, ReportEvent, ServerEvent,
    StatusEvent, VariantsEvent,
} from "../protocol/types";
import { medianEdge } from "../panels/linkage";
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

/** The shell itself is no signal: it changes 60 times a second. `topology` rises with every linkage, `revision`
 *  with every frame. */
let shell: Shell | null = null;
export const topology = signal(0);
/** Rises with every frame, at most once per animation frame. */
export const revision = signal(0);
export const currentShell = () => shell;

/** The panel edge L, for figures that are given over it. */
export const panelEdge = () => (shell ? medianEdge(shell.linkage, shell.flat) : 1);

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
    link = new Link(to, { event: receive, frame: receiveFrame, opened: () => undefined, lost: () => (connection.value = "lost") });
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

async function join(event: Hello): Promise<void> {
    const known = documentState.value?.id ?? rememberedDocument();
    try {
        await link!.ask("join", known ? { document: known } : {});
    } catch (error) {
        if (!known) throw error;
        // the server was started anew; what was no file then is among the recovered
        if (event.recovered.some((r) => r.name === known)) await link!.ask("open", { recovered: known });
        else await link!.ask("join", {});
    }
    connection.value = "open";
}

function receive(event: ServerEvent): void {
    switch (event.event) {
        case "hello":
            hello.value = event;
            closedMessage.value = null;
            join(event).catch((error: unknown) => showProblem(error, "join"));
            break;
        case "document":
            remember(event.id);
            documentState.value = event;
            break;
        case "linkage":
            if (event.variant === undefined) announced = event;
            else announcedVariant = event;
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

let pendingRevision = false;
function receiveFrame(frame: Frame): void {
    if (frame.kind !== kinds.state) {
        for (const listener of frameListeners) listener(frame, frame.kind === kinds.variant ? announcedVariant : null);
        return;
    }
    let linkage = false;
    // documents count their linkages alike: what makes a new one is that its triangles come
    if (!shell || frame.topology !== shell.topology || frame.sections.has(section.triangles)) {
        if (!announced || announced.topology !== frame.topology || !frame.sections.has(section.triangles)) return; // of a linkage that was replaced meanwhile
        shell = new Shell(announced, frame);
        linkage = true;
        batch(() => {
            topology.value++;
            revision.value++;
        });
    } else shell.take(frame);
    for (const listener of shellListeners) listener(shell, { linkage, frame });
    if (!pendingRevision) {
        pendingRevision = true;
        requestAnimationFrame(() => {
            pendingRevision = false;
            revision.value++;
        });
    }
}

/** A command whose failure is shown; resolves to null then. */
export async function command(name: string, parameters: Record<string, unknown> = {}): Promise<Record<string, unknown> | null> {
    if (problem.value?.about === name) problem.value = null;
    try {
        return await link!.ask(name, parameters);
    } catch (error) {
        showProblem(error, name);
        return null;
    }
}

/** A command whose failure the caller handles. */
export function ask(name: string, parameters: Record<string, unknown> = {}): Promise<Record<string, unknown>> {
    return link ? link.ask(name, parameters) : Promise.reject(new Error("There is no server."));
}

export function nextCommandId(): number {
    return link?.nextId ?? 0;
}

/** Sent when a preview leaves: the page measures from here to the frame that shows it. */
export const latency: { sent: Map<number, number>; samples: number[] } = { sent: new Map(), samples: [] };

export function preview(operator: OperatorCall | null): number {
    if (!link) return 0;
    const serial = link.nextSerial();
    latency.sent.set(serial, performance.now());
    link.tell("preview", { serial, operator });
    return serial;
}

export function grab(hinge: number, to: [number, number, number]): void {
    if (link) link.tell("grab", { hinge, to, serial: link.nextSerial() });
}

export function tell(name: string, parameters: Record<string, unknown> = {}): void {
    link?.tell(name, parameters);
}

export async function apply(operator: OperatorCall): Promise<boolean> {
    return (await command("apply", { operator })) !== null;
}
