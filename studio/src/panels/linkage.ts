// The linkage as the page knows it: topology once, states as often as they change.

/** Closed or open loops of hinges, one after the other: loop k is items[start[k]] .. items[start[k + 1] - 1]. */
export interface Loops {
    start: Uint32Array;
    items: Uint32Array;
}

export interface Linkage {
    hinges: number;
    panels: number;
    /** 3 per panel, counter-clockwise in the flat state. */
    triangles: Uint32Array;
    holes: Loops;
    openings: Loops;
    /** Two panels of each hinge; -1 where there is none. */
    around: Int32Array;
    /** Three neighbours of each panel, across corner k; -1 on the rim. */
    neighbours: Int32Array;
    /** Triangles over panels (first), holes and openings: what the pointer meets also where there is no panel. */
    skin: Uint32Array;
}

export function loopCount(loops: Loops): number {
    return loops.start.length - 1;
}

export function loopsOf(lists: number[][]): Loops {
    const start = new Uint32Array(lists.length + 1);
    lists.forEach((list, k) => (start[k + 1] = start[k] + list.length));
    return { start, items: Uint32Array.from(lists.flat()) };
}

export function makeLinkage(hinges: number, triangles: Uint32Array, holes: Loops, openings: Loops): Linkage {
    const panels = triangles.length / 3;
    const around = new Int32Array(2 * hinges).fill(-1);
    for (let t = 0; t < panels; t++)
        for (let k = 0; k < 3; k++) {
            const h = triangles[3 * t + k];
            around[2 * h + (around[2 * h] < 0 ? 0 : 1)] = t;
        }
    const neighbours = new Int32Array(3 * panels);
    for (let t = 0; t < panels; t++)
        for (let k = 0; k < 3; k++) {
            const h = triangles[3 * t + k];
            neighbours[3 * t + k] = around[2 * h] === t ? around[2 * h + 1] : around[2 * h];
        }
    return { hinges, panels, triangles, holes, openings, around, neighbours, skin: skinOf(triangles, holes, openings) };
}

/** Fans over the holes after the panels. Openings on the rim are covered only where three or more hinges bound them. */
function skinOf(triangles: Uint32Array, holes: Loops, openings: Loops): Uint32Array {
    const fans: number[] = [];
    for (const loops of [holes, openings])
        for (let k = 0; k < loopCount(loops); k++)
            for (let i = loops.start[k] + 1; i + 1 < loops.start[k + 1]; i++)
                fans.push(loops.items[loops.start[k]], loops.items[i], loops.items[i + 1]);
    const skin = new Uint32Array(triangles.length + fans.length);
    skin.set(triangles);
    skin.set(fans, triangles.length);
    return skin;
}

/** Corner positions, 9 numbers per triangle, from places of 3 numbers per hinge. */
export function gather(triangles: Uint32Array, places: Float32Array, out: Float32Array): void {
    for (let i = 0, o = 0; i < triangles.length; i++) {
        const p = 3 * triangles[i];
        out[o++] = places[p];
        out[o++] = places[p + 1];
        out[o++] = places[p + 2];
    }
}

export interface Bounds {
    min: [number, number, number];
    max: [number, number, number];
}

export function boundsOf(places: Float32Array): Bounds {
    const min: [number, number, number] = [Infinity, Infinity, Infinity];
    const max: [number, number, number] = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < places.length; i += 3)
        for (let k = 0; k < 3; k++) {
            const v = places[i + k];
            if (v < min[k]) min[k] = v;
            if (v > max[k]) max[k] = v;
        }
    return { min, max };
}

/** The median panel edge, over a sample of the panels when there are many. */
export function medianEdge(linkage: Linkage, places: Float32Array): number {
    const step = Math.max(1, Math.floor(linkage.panels / 2000));
    const lengths: number[] = [];
    for (let t = 0; t < linkage.panels; t += step) {
        const a = 3 * linkage.triangles[3 * t];
        const b = 3 * linkage.triangles[3 * t + 1];
        lengths.push(Math.hypot(places[a] - places[b], places[a + 1] - places[b + 1], places[a + 2] - places[b + 2]));
    }
    lengths.sort((x, y) => x - y);
    return lengths.length ? lengths[lengths.length >> 1] : 1;
}
