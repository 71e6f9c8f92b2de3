// The canvas of live-worker.ts. It lies hidden until its first picture is there, and while another shows what is newer or better.
import type { Sight } from "../panels/raster";
import type { Shell } from "../panels/shell";
import type { Stamp } from "../state/latency";
import type { ColourMap } from "../panels/colour";

export interface LiveScene {
    sights: (Sight & { state: "flat" | "space" })[];
    marks: Uint8Array;
    /** Another number whenever what lies under the panels is another picture. */
    ground: number;
    /** What panels are coloured by, and the scale. */
    field: string;
    lo: number;
    hi: number;
    map: ColourMap["name"];
}
export type ToLive = { canvas: OffscreenCanvas; origin: number } | { ground: ArrayBuffer; width: number; height: number } | { states: MessagePort } | { shell: Shell; scene: LiveScene; run: number } | { practice: Shell; scene: LiveScene } | { scene: LiveScene | null };

/** Every state goes to the port from when `begun` is called, until null is given; false where that cannot be. */
export type Watch = (port: MessagePort | null, begun?: () => void) => boolean;

const patience = 150; // ms

export class Live {
    private readonly worker: Worker;
    private run: { shell: Shell; number: number; since: number; drawn: boolean; begun: boolean; scene: LiveScene; key: string } | null = null;
    private runs = 0;
    private ground = 0;

    static readonly possible = typeof Worker !== "undefined" && typeof HTMLCanvasElement !== "undefined" && "transferControlToOffscreen" in HTMLCanvasElement.prototype;

    /** `pixels` are those of the ground. `ready` is called when the first picture is there, `stamped` with what was when. */
    constructor(readonly canvas: HTMLCanvasElement, private readonly watch: Watch, private readonly pixels: () => ImageData, ready: () => void, stamped: (stamps: Stamp[]) => void) {
        this.worker = new Worker(new URL("./live-worker.ts", import.meta.url), { type: "module", name: "live" });
        const offscreen = canvas.transferControlToOffscreen();
        this.tell({ canvas: offscreen, origin: performance.timeOrigin }, [offscreen]);
        this.worker.onmessage = ({ data }: MessageEvent<Stamp[] | number>) => {
            if (typeof data !== "number") stamped(data);
            else if (this.run?.number === data) {
                this.run.drawn = true;
                ready();
            }
        };
    }

    private tell(message: ToLive, transfer: Transferable[] = []): void {
        this.worker.postMessage(message, transfer);
    }

    /** What the scene lies on, if that is new there. */
    prepare({ ground }: LiveScene): void {
        if (ground === this.ground) return;
        this.ground = ground;
        const { data: { buffer }, width, height } = this.pixels();
        this.tell({ ground: buffer as ArrayBuffer, width, height }, [buffer]);
    }

    /** Its first picture will be there soon. */
    get coming(): boolean {
        return this.run !== null && !this.run.drawn && performance.now() - this.run.since < patience;
    }

    /** Has states drawn so, as they come. True when a picture of them is there. */
    show(shell: Shell, scene: LiveScene): boolean {
        this.prepare(scene);
        const key = keyOf(scene);
        if (this.run && this.run.shell !== shell) this.stop();
        const { run } = this;
        if (!run) {
            const { port1, port2 } = new MessageChannel();
            const next = { shell, number: ++this.runs, since: performance.now(), drawn: false, begun: false, scene, key };
            const begin = () => {
                if (this.run !== next || next.begun) return;
                next.begun = true;
                this.tell({ shell, scene: next.scene, run: next.number });
            };
            if (!this.watch(port1, begin)) return false; // what came before is in the shell when that is called
            this.tell({ states: port2 }, [port2]);
            this.run = next;
            if (!shell.moving) begin(); // nothing is on its way here
            return false;
        }
        if (key === run.key && sameBytes(scene.marks, run.scene.marks)) return run.drawn;
        Object.assign(run, { scene, key });
        if (run.begun) this.tell({ scene });
        return run.drawn;
    }

    /** What is not shown is drawn some times: code that has not run yet takes five times as long. */
    practise(shell: Shell, scene: LiveScene): void {
        this.prepare(scene);
        if (!this.run) this.tell({ practice: shell, scene });
    }

    stop(): void {
        if (!this.run) return;
        this.run = null;
        this.watch(null);
        this.tell({ scene: null });
    }

    dispose(): void {
        this.stop();
        this.worker.terminate();
    }
}

/** What a scene is but for marks, and for matrices: those follow the bounds of what moves, by planes that cut nothing here; where a camera
 *  moves, the stage draws itself. */
function keyOf({ marks: _, sights, ...rest }: LiveScene): string {
    return JSON.stringify([rest, sights.map(({ window: { matrix: _, ...window }, ...sight }) => [window, sight])]);
}

const sameBytes = (a: Uint8Array, b: Uint8Array) => a.length === b.length && a.every((v, k) => v === b[k]);
