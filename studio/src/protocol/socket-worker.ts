// Sockets apart from the page: a state comes in dozens of pieces, and each would wait until the page has drawn. Asked for by address,
// with a port: text that comes in through it is sent, null closes; told through it are true for open, false for closed, and what came.
//
// With a port of its own somebody may watch: every state of the linkage goes there at once, and to the page, gathered, when it has taken
// the last ones and some time has passed. `undefined` tells the page from where on; false ends it.
import { type Frame, decodeFrame, encodeFrame, isState, mergeFrames, section } from "./frames";

const every = 80; // ms

addEventListener("message", ({ data: address, ports: [port] }: MessageEvent<string>) => {
    const socket = new WebSocket(address);
    let watcher: MessagePort | null = null;
    let gathered: Frame | null = null;
    let waiting = false; // for the page to take what it was given
    let timer: ReturnType<typeof setTimeout> | undefined;
    let due = 0;

    const forward = () => {
        clearTimeout(timer);
        timer = undefined;
        if (!gathered) return;
        const states = encodeFrame(gathered);
        gathered = null;
        waiting = true;
        due = performance.now() + every;
        port.postMessage({ states }, [states]);
    };
    const forwardLater = () => {
        if (gathered && !waiting) timer ??= setTimeout(forward, Math.max(0, due - performance.now()));
    };
    const take = (data: ArrayBuffer) => {
        const frame = watcher && isState(data) ? decodeFrame(data) : null;
        if (!frame || frame.sections.has(section.triangles)) {
            forward();
            port.postMessage(data, [data]);
            return;
        }
        socket.send('{"do":"seen"}');
        const copy = data.slice(0);
        watcher!.postMessage([copy, performance.timeOrigin + performance.now()], [copy]);
        if (gathered && gathered.topology !== frame.topology) forward();
        gathered = mergeFrames(gathered, frame);
        forwardLater();
    };

    socket.binaryType = "arraybuffer";
    socket.onopen = () => port.postMessage(true);
    socket.onclose = () => port.postMessage(false);
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
        if (typeof data !== "string") return take(data);
        forward();
        port.postMessage(data);
    };
    port.onmessage = ({ data, ports }: MessageEvent<string | null | boolean | undefined>) => {
        if (typeof data === "string") socket.send(data);
        else if (data === null) socket.close();
        else if (data === undefined) {
            watcher = ports[0];
            port.postMessage(undefined);
        } else if (data) {
            waiting = false;
            forwardLater();
        } else {
            forward();
            watcher = null;
        }
    };
});
