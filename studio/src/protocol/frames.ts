// Binary frames of docs/protocol.md.

export type Numbers = Float32Array | Int32Array | Uint8Array;

export const kinds = { state: 1, surface: 2, motion: 3, variant: 4 } as const;

export const section = {
    triangles: 1, holeStart: 2, holeHinges: 3, openingStart: 4, openingHinges: 5, onRim: 6, panels: 7, names: 8, sheet: 9,
    flat: 16, deployed: 17, simulated: 18, prescribed: 20, realised: 21, opening: 22, material: 23, mouth: 24, residual: 25,
    curvature: 26, forces: 27, supports: 28, reactions: 29, vertices: 32, faces: 33, meanCurvature: 34, scaleFactor: 35,
    place: 40, share: 41, times: 42,
} as const;

export const flag = { settled: 1, exact: 2, moving: 4, preview: 8 } as const;

export interface Frame {
    kind: number;
    re: number;
    topology: number;
    revision: number;
    serial: number;
    flags: number;
    sections: Map<number, Numbers>;
}

const magic = 0x31465841;
const bytesOf = [0, 4, 4, 1];

/** Views into the buffer, without copies. Throws when the frame is not one. */
export function decodeFrame(buffer: ArrayBuffer): Frame {
    if (buffer.byteLength < 32) throw new Error("The frame is shorter than its head.");
    const words = new DataView(buffer);
    const word = (at: number) => words.getUint32(at, true);
    if (word(0) !== magic) throw new Error("The frame does not start as frames do.");
    const sections = new Map<number, Numbers>();
    let at = 32;
    for (let k = word(28); k > 0; k--) {
        if (at + 12 > buffer.byteLength) throw new Error("The frame ends inside the head of a section.");
        const [name, type, count] = [word(at), word(at + 4), word(at + 8)];
        at += 12;
        if (type < 1 || type > 3) throw new Error(`Section ${name} has the unknown type ${type}.`);
        const bytes = count * bytesOf[type];
        if (at + bytes > buffer.byteLength) throw new Error(`The frame ends inside section ${name}.`);
        sections.set(name, type === 1 ? new Float32Array(buffer, at, count) : type === 2 ? new Int32Array(buffer, at, count) : new Uint8Array(buffer, at, count));
        at += (bytes + 3) & ~3;
    }
    return { kind: word(4), re: word(8), topology: word(12), revision: word(16), serial: word(20), flags: word(24), sections };
}

/** What two states of one linkage, the second of them later, are together. */
export function mergeFrames(before: Frame | null, after: Frame): Frame {
    return { ...after, sections: new Map([...(before?.sections ?? []), ...after.sections]) };
}

export const isState = (buffer: ArrayBuffer) => buffer.byteLength >= 8 && new DataView(buffer).getUint32(4, true) === kinds.state;

/** The same the other way round. */
export function encodeFrame(frame: Frame): ArrayBuffer {
    let size = 32;
    for (const data of frame.sections.values()) size += 12 + ((data.byteLength + 3) & ~3);
    const buffer = new ArrayBuffer(size);
    const words = new DataView(buffer);
    [magic, frame.kind, frame.re, frame.topology, frame.revision, frame.serial, frame.flags, frame.sections.size].forEach((v, k) =>
        words.setUint32(4 * k, v, true));
    let at = 32;
    for (const [name, data] of frame.sections) {
        const type = data instanceof Float32Array ? 1 : data instanceof Int32Array ? 2 : 3;
        [name, type, data.length].forEach((v, k) => words.setUint32(at + 4 * k, v, true));
        at += 12;
        new Uint8Array(buffer, at, data.byteLength).set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
        at += (data.byteLength + 3) & ~3;
    }
    return buffer;
}
