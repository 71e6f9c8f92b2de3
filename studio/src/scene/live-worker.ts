// Panels that move, drawn apart from the page: its own thread has the hand to listen to, and a frame of the page to put together. A
// state is drawn as soon as it is here, unless the last picture has not left yet; then the newest is, when that has.
import { colourMaps, paint } from "../panels/colour";
import { fieldById } from "../panels/fields";
import { type Picture, clear, drawShell, makePicture } from "../panels/raster";
import { Shell } from "../panels/shell";
import { decodeFrame } from "../protocol/frames";
import { type Stamp, serverTimes } from "../state/latency";
import type { LiveScene, ToLive } from "./live";

let context: OffscreenCanvasRenderingContext2D;
let states: MessagePort | null = null;
let shell: Shell | null = null;
let scene: LiveScene | null = null;
let picture: Picture | null = null;
let image: ImageData;
let tints = new Uint8Array(0);
let normals = new Float32Array(0);
/** A picture has not left yet. */
let leaving = false;
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

function makeRoom({ width, height }: LiveScene, panels: number): Picture {
    if (tints.length !== 4 * panels) [tints, normals] = [new Uint8Array(4 * panels), new Float32Array(3 * panels)];
    if (picture?.width === width && picture.height === height) return picture;
    Object.assign(context.canvas, { width, height });
    picture = makePicture(width, height);
    image = new ImageData(new Uint8ClampedArray(picture.pixels.buffer as ArrayBuffer), width, height);
    return picture;
}

function drawInto(shell: Shell, scene: LiveScene): void {
    const { linkage } = shell;
    const { sights, marks, field, lo, hi, map } = scene;
    const into = makeRoom(scene, linkage.panels);
    clear(into);
    paint({ map: colourMaps[map], lo, hi }, fieldById(field).values(shell), tints);
    for (const sight of sights)
        drawShell(into, sight, linkage.triangles, sight.state === "flat" ? shell.flat : shell.simulated ?? shell.deployed, tints, marks, normals);
}

function draw(): void {
    stale = false;
    if (!shell || !scene) return;
    const began = now();
    drawInto(shell, scene);
    context.putImageData(image, 0, 0);
    const { serial } = shell;
    note(serial, { began, submitted: now(), apart: true });
    leaving = true;
    const begun = first;
    first = 0;
    requestAnimationFrame(() => {
        leaving = false;
        note(serial, { drawn: now() });
        if (begun) postMessage(begun);
        if (stale) draw();
    });
}

/** Until something is to be shown. */
function practise(model: Shell, of: LiveScene, times: number): void {
    if (states) return;
    drawInto(model, of);
    if (times > 1) setTimeout(() => practise(model, of, times - 1), 10);
}

function invalidate(): void {
    stale = true;
    if (!leaving) draw();
}

addEventListener("message", ({ data }: MessageEvent<ToLive>) => {
    if ("canvas" in data) {
        context = data.canvas.getContext("2d", { willReadFrequently: true })!;
        origin = data.origin;
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
        context.clearRect(0, 0, context.canvas.width, context.canvas.height);
    }
});
