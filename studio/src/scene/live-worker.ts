// Panels that move, drawn apart from the page: its own thread has the hand to listen to, and a frame of the page to put together. The
// newest state is drawn as soon as it is here, over a picture that has not left yet: what is drawn when the browser asks for the next
// frame comes too late for it.
import { colourMaps, paint } from "../panels/colour";
import { fieldById } from "../panels/fields";
import { type Box, type Picture, clear, drawShell, makePicture } from "../panels/raster";
import { Shell } from "../panels/shell";
import { decodeFrame } from "../protocol/frames";
import { type Stamp, serverTimes } from "../state/latency";
import type { LiveScene, ToLive } from "./live";

let context: OffscreenCanvasRenderingContext2D;
let states: MessagePort | null = null;
let shell: Shell | null = null;
let scene: LiveScene | null = null;
let ground: { width: number; height: number; pixels: Uint32Array };
let picture: Picture | null = null;
let image: ImageData;
let tints = new Uint8Array(0);
let normals = new Float32Array(0);
/** Serials of pictures that have not left yet. */
let leaving: number[] = [];
let stale = false;
const practices = 12;
/** The number of what was begun last, until its first picture is on its way. */
let first = 0;

// what was when, told now and then: each message takes the page some time
let origin = 0; // of the page's clock
const now = () => performance.timeOrigin - origin + performance.now();
let stamps: Stamp[] = [];
let telling: ReturnType<typeof setTimeout> | undefined;
function note(serial: number, at: Stamp[1]): void {
    stamps.push([serial, at]);
    telling ??= setTimeout(() => {
        telling = undefined;
        postMessage(stamps);
        stamps = [];
    }, 200);
}

function makeRoom(panels: number): Picture {
    if (tints.length !== 4 * panels) [tints, normals] = [new Uint8Array(4 * panels), new Float32Array(3 * panels)];
    const { width, height, pixels } = ground;
    if (picture?.ground === pixels) return picture;
    if (context.canvas.width !== width || context.canvas.height !== height) Object.assign(context.canvas, { width, height });
    picture = makePicture(width, height, pixels);
    image = new ImageData(new Uint8ClampedArray(picture.pixels.buffer as ArrayBuffer), width, height);
    context.putImageData(image, 0, 0);
    return picture;
}

/** Returns where the picture is another than before. */
function drawInto(shell: Shell, scene: LiveScene): Box[] {
    const { linkage } = shell;
    const { sights, marks, field, lo, hi, map } = scene;
    const into = makeRoom(linkage.panels);
    const before = into.drawn;
    clear(into);
    paint({ map: colourMaps[map], lo, hi }, fieldById(field).values(shell), tints);
    for (const sight of sights)
        drawShell(into, sight, linkage.triangles, sight.state === "flat" ? shell.flat : shell.simulated ?? shell.deployed, tints, marks, normals);
    return into.drawn.map((box, k) => (before[k] ? around(box, before[k]) : box)); // window by window
}

const around = ([a, b, c, d]: Box, [left, top, right, bottom]: Box): Box => [Math.min(a, left), Math.min(b, top), Math.max(c, right), Math.max(d, bottom)];

function draw(): void {
    stale = false;
    if (!shell || !scene) return;
    const began = now();
    for (const [left, top, right, bottom] of drawInto(shell, scene)) context.putImageData(image, 0, 0, left, top, right - left, bottom - top);
    note(shell.serial, { began, submitted: now(), apart: true });
    leaving.push(shell.serial);
    const begun = first;
    first = 0;
    if (leaving.length > 1) return;
    requestAnimationFrame(() => {
        const drawn = now();
        for (const serial of leaving) note(serial, { drawn });
        leaving = [];
        if (begun) postMessage(begun);
    });
}

/** Until something is to be shown. */
function practise(model: Shell, of: LiveScene, times: number): void {
    if (states) return;
    drawInto(model, of);
    if (times > 1) setTimeout(() => practise(model, of, times - 1), 10);
}

// behind states that are here already
const { port1: later, port2: soon } = new MessageChannel();
later.onmessage = draw;
function invalidate(): void {
    if (!stale) soon.postMessage(null);
    stale = true;
}

addEventListener("message", ({ data }: MessageEvent<ToLive>) => {
    if ("canvas" in data) {
        context = data.canvas.getContext("2d", { willReadFrequently: true, alpha: false })!;
        origin = data.origin;
    } else if ("ground" in data) {
        ground = { ...data, pixels: new Uint32Array(data.ground) };
    } else if ("states" in data) {
        states?.close();
        states = data.states;
        shell = null;
    } else if ("practice" in data) {
        practise(Shell.from(data.practice), data.scene, practices);
    } else if ("shell" in data) {
        const begun = Shell.from(data.shell);
        shell = begun;
        scene = data.scene;
        first = data.run;
        states!.onmessage = ({ data: [bytes, arrived] }: MessageEvent<[ArrayBuffer, number]>) => {
            const frame = decodeFrame(bytes);
            if (shell !== begun || frame.topology !== begun.topology) return;
            begun.take(frame);
            note(frame.serial, { arrived: arrived - origin, came: now(), ...serverTimes(frame) });
            invalidate();
        };
        invalidate();
    } else if (data.scene) {
        scene = data.scene;
        invalidate();
    } else {
        states?.close();
        states = shell = scene = null;
    }
});
