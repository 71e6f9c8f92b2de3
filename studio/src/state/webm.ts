// Encoded pictures as a WebM file: a header, one track, and clusters that each begin with a key picture (RFC 8794, RFC 9559).
export interface Block {
    bytes: Uint8Array;
    /** Milliseconds. */
    time: number;
    key: boolean;
}

type Part = Uint8Array | Part[];

function flatten(parts: Part, into: Uint8Array[] = []): Uint8Array[] {
    if (parts instanceof Uint8Array) into.push(parts);
    else for (const p of parts) flatten(p, into);
    return into;
}

const bytesOf = (value: number, count: number) => Uint8Array.from({ length: count }, (_, k) => Math.floor(value / 256 ** (count - 1 - k)) % 256);

/** An element: its identifier, its size in eight bytes, what is in it. */
function element(id: number, ...content: Part[]): Part {
    const size = flatten(content).reduce((sum, p) => sum + p.length, 0);
    const length = bytesOf(size, 8);
    length[0] = 1;
    return [bytesOf(id, id > 0xffffff ? 4 : id > 0xffff ? 3 : id > 0xff ? 2 : 1), length, ...content];
}
const number = (id: number, value: number) => element(id, bytesOf(value, 4));
const text = (id: number, value: string) => element(id, new TextEncoder().encode(value));
function real(id: number, value: number): Part {
    const bytes = new Uint8Array(8);
    new DataView(bytes.buffer).setFloat64(0, value);
    return element(id, bytes);
}

/** `duration` in milliseconds; the first block is a key picture, and none is further than half a minute from the next one. */
export function webm(codec: "V_VP8", width: number, height: number, duration: number, blocks: readonly Block[]): Blob {
    const clusters: { time: number; blocks: Part[] }[] = [];
    for (const { bytes, time, key } of blocks) {
        if (key) clusters.push({ time, blocks: [] });
        const cluster = clusters.at(-1)!;
        cluster.blocks.push(element(0xa3, Uint8Array.of(0x81), bytesOf(time - cluster.time, 2), Uint8Array.of(key ? 0x80 : 0), bytes));
    }
    const file: Part[] = [
        element(0x1a45dfa3, number(0x4286, 1), number(0x42f7, 1), number(0x42f2, 4), number(0x42f3, 8), text(0x4282, "webm"), number(0x4287, 2), number(0x4285, 2)),
        element(0x18538067,
            element(0x1549a966, number(0x2ad7b1, 1e6), real(0x4489, duration), text(0x4d80, "Auxshell"), text(0x5741, "Auxshell")),
            element(0x1654ae6b, element(0xae, number(0xd7, 1), number(0x73c5, 1), number(0x83, 1), text(0x86, codec), element(0xe0, number(0xb0, width), number(0xba, height)))),
            ...clusters.map((c) => element(0x1f43b675, number(0xe7, c.time), ...c.blocks))),
    ];
    return new Blob(flatten(file) as BlobPart[], { type: "video/webm" });
}
