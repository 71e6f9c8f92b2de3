// One WebSocket to the server: commands with their answers, events, frames, and coming back when it breaks.
import { type Frame, decodeFrame } from "./frames";
import type { Answer, Problem, ServerEvent } from "./types";

export interface Transport {
    send(text: string): void;
    close(): void;
    /** From when `begun` is called every state goes to the port at once, and here gathered, until null is given. */
    watch?(port: MessagePort | null, begun?: () => void): void;
}
export interface TransportEvents {
    open(): void;
    text(message: string): void;
    /** `gathered`: states that were watched, and acknowledged. */
    binary(message: ArrayBuffer, gathered?: boolean): void;
    closed(): void;
}
export type Connect = (events: TransportEvents) => Transport;

export class CommandError extends Error {
    constructor(readonly problem: Problem) {
        super(problem.message);
    }
}

export interface LinkEvents {
    event(event: ServerEvent): void;
    frame(frame: Frame, gathered: boolean): void;
    opened(): void;
    lost(): void;
}

const lostProblem: Problem = { status: 1, word: "failed", message: "The server stopped before it answered. Work up to the last gesture is saved." };

export class Link {
    private transport: Transport | null = null;
    private next = 1;
    private serial = 0;
    private readonly waiting = new Map<number, { resolve(answer: Record<string, unknown>): void; reject(error: Error): void }>();
    private tries = 0;
    private timer: ReturnType<typeof setTimeout> | undefined;
    private open = false;

    constructor(private readonly connect: Connect, private readonly events: LinkEvents) {}

    start(): void {
        clearTimeout(this.timer);
        this.transport?.close();
        const transport = this.connect({
            open: () => {
                this.open = true;
                this.tries = 0;
                this.events.opened();
            },
            text: (message) => this.receive(message),
            binary: (message, gathered = false) => this.events.frame(decodeFrame(message), gathered),
            closed: () => {
                if (this.transport === transport) this.broken();
            },
        });
        this.transport = transport;
    }

    /** A command with its answer; rejects with a CommandError. */
    ask(name: string, parameters: Record<string, unknown> = {}): Promise<Record<string, unknown>> {
        if (!this.open) return Promise.reject(new CommandError(lostProblem));
        const id = this.next++;
        return new Promise((resolve, reject) => {
            this.waiting.set(id, { resolve, reject });
            this.transport!.send(JSON.stringify({ do: name, id, ...parameters }));
        });
    }

    /** The id that the next `ask` will have: frames name the command they belong to. */
    get nextId(): number {
        return this.next;
    }

    /** A command without an answer. */
    tell(name: string, parameters: Record<string, unknown> = {}): void {
        if (this.open) this.transport!.send(JSON.stringify({ do: name, ...parameters }));
    }

    /** False where states cannot be watched. */
    watch(port: MessagePort | null, begun?: () => void): boolean {
        if (!this.open || !this.transport?.watch) return false;
        this.transport.watch(port, begun);
        return true;
    }

    /** A serial for previews and grabs, rising over the life of the connection. */
    nextSerial(): number {
        return ++this.serial;
    }

    private receive(message: string): void {
        const data = JSON.parse(message) as Answer | ServerEvent;
        if ("re" in data && !("event" in data)) {
            const waiting = this.waiting.get(data.re);
            if (!waiting) return;
            this.waiting.delete(data.re);
            if (data.ok) waiting.resolve(data);
            else waiting.reject(new CommandError(data.error));
        } else this.events.event(data as ServerEvent);
    }

    private broken(): void {
        this.open = false;
        this.transport = null;
        for (const { reject } of this.waiting.values()) reject(new CommandError(lostProblem));
        this.waiting.clear();
        this.events.lost();
        this.timer = setTimeout(() => this.start(), Math.min(4000, 250 * 2 ** this.tries++));
    }
}

/** The server's socket, found from the page's own address: the secret is the first part of the path. */
export function socketTo(location: Location): Connect {
    const secret = location.pathname.split("/")[1] ?? "";
    const address = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws?key=${encodeURIComponent(secret)}`;
    // one for as long as the page lasts: without a server there is none to be had
    const worker = new Worker(new URL("./socket-worker.ts", import.meta.url), { type: "module", name: "socket" });
    return (events) => {
        const { port1: port, port2 } = new MessageChannel();
        let watched: (() => void) | undefined;
        port.onmessage = ({ data }: MessageEvent<boolean | string | ArrayBuffer | { states: ArrayBuffer } | undefined>) => {
            if (data === true) events.open();
            else if (data === false) events.closed();
            else if (data === undefined) watched?.();
            else if (typeof data === "string") events.text(data);
            else if (data instanceof ArrayBuffer) events.binary(data);
            else {
                events.binary(data.states, true);
                port.postMessage(true);
            }
        };
        worker.postMessage(address, [port2]);
        return {
            send: (text) => port.postMessage(text),
            close: () => port.postMessage(null),
            watch: (watcher, begun) => {
                watched = begun;
                if (watcher) port.postMessage(undefined, [watcher]);
                else port.postMessage(false);
            },
        };
    };
}

export async function upload(file: Blob, name: string): Promise<string> {
    const response = await fetch(`upload?name=${encodeURIComponent(name)}`, { method: "POST", body: file });
    if (!response.ok) {
        const reasons: Record<number, string> = { 413: "The file is larger than 64 MiB.", 507: "The server has no room for the file." };
        throw new Error(reasons[response.status] ?? `The upload was refused (${response.status}).`);
    }
    return ((await response.json()) as { upload: string }).upload;
}
