// Sets of hinges that people mean: kagome lines, shortest ways along panel edges, what lies within a lasso.
import type { Linkage } from "./linkage";

/** The hinge opposite across hinge h when coming from hinge `from` along a panel edge: kagome lines run straight through. */
export function straightOn(linkage: Linkage, from: number, h: number): number {
    const { triangles, around } = linkage;
    const came = panelOf(linkage, from, h);
    const other = around[2 * h] === came ? around[2 * h + 1] : around[2 * h];
    if (came < 0 || other < 0) return -1;
    // In the panel come from, `from` follows or precedes h; the line leaves the other panel by the corner on the same side.
    const k = cornerOf(triangles, came, h);
    const follows = triangles[3 * came + ((k + 1) % 3)] === from;
    const j = cornerOf(triangles, other, h);
    return triangles[3 * other + ((j + (follows ? 1 : 2)) % 3)];
}

function cornerOf(triangles: Uint32Array, t: number, h: number): number {
    return triangles[3 * t] === h ? 0 : triangles[3 * t + 1] === h ? 1 : 2;
}

/** The panel that two hinges share, or -1. */
export function panelOf(linkage: Linkage, a: number, b: number): number {
    for (const t of [linkage.around[2 * a], linkage.around[2 * a + 1]])
        if (t >= 0 && [0, 1, 2].some((k) => linkage.triangles[3 * t + k] === b)) return t;
    return -1;
}

/** The kagome line through neighbouring hinges a and b, from rim to rim. */
export function kagomeLine(linkage: Linkage, a: number, b: number): number[] {
    const walk = (from: number, to: number) => {
        const out = [to];
        for (let limit = linkage.hinges; limit > 0; limit--) {
            const next = straightOn(linkage, from, to);
            if (next < 0 || next === a) break;
            out.push(next);
            [from, to] = [to, next];
        }
        return out;
    };
    if (panelOf(linkage, a, b) < 0) return [];
    return [...walk(b, a).reverse(), ...walk(a, b)];
}

/** The shortest way along panel edges, lengths measured on the sheet. */
export function shortestWay(linkage: Linkage, sheet: Float32Array, a: number, b: number): number[] {
    const distance = new Float64Array(linkage.hinges).fill(Infinity);
    const before = new Int32Array(linkage.hinges).fill(-1);
    const heap: [number, number][] = [];
    const push = (item: [number, number]) => {
        let k = heap.push(item) - 1;
        while (k > 0 && heap[(k - 1) >> 1][0] > heap[k][0]) {
            [heap[k], heap[(k - 1) >> 1]] = [heap[(k - 1) >> 1], heap[k]];
            k = (k - 1) >> 1;
        }
    };
    const pop = () => {
        const top = heap[0];
        const last = heap.pop()!;
        if (heap.length) {
            heap[0] = last;
            for (let k = 0; ; ) {
                let least = k;
                for (const c of [2 * k + 1, 2 * k + 2]) if (c < heap.length && heap[c][0] < heap[least][0]) least = c;
                if (least === k) break;
                [heap[k], heap[least]] = [heap[least], heap[k]];
                k = least;
            }
        }
        return top;
    };
    distance[a] = 0;
    push([0, a]);
    while (heap.length) {
        const [d, h] = pop();
        if (h === b) break;
        if (d > distance[h]) continue;
        for (const t of [linkage.around[2 * h], linkage.around[2 * h + 1]]) {
            if (t < 0) continue;
            for (let k = 0; k < 3; k++) {
                const n = linkage.triangles[3 * t + k];
                const e = d + Math.hypot(sheet[3 * n] - sheet[3 * h], sheet[3 * n + 1] - sheet[3 * h + 1]);
                if (n !== h && e < distance[n]) {
                    distance[n] = e;
                    before[n] = h;
                    push([e, n]);
                }
            }
        }
    }
    if (distance[b] === Infinity) return [];
    const way: number[] = [];
    for (let h = b; h >= 0; h = before[h]) way.push(h);
    return way.reverse();
}

export function insidePolygon(polygon: readonly { x: number; y: number }[], x: number, y: number): boolean {
    let inside = false;
    for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
        const a = polygon[i];
        const b = polygon[j];
        if (a.y > y !== b.y > y && x < ((b.x - a.x) * (y - a.y)) / (b.y - a.y) + a.x) inside = !inside;
    }
    return inside;
}

/** Hinges in the words of the operators: 0-12,40. Runs are written as ranges when the order allows. */
export function hingeWords(hinges: readonly number[]): string {
    const out: string[] = [];
    for (let i = 0; i < hinges.length; ) {
        let j = i;
        while (j + 1 < hinges.length && hinges[j + 1] === hinges[j] + 1) j++;
        out.push(j > i + 1 ? `${hinges[i]}-${hinges[j]}` : hinges[i] + (j > i ? `,${hinges[j]}` : ""));
        i = j + 1;
    }
    return out.join(",");
}

export function hingesOf(linkage: Linkage, panels: Iterable<number>): number[] {
    const out = new Set<number>();
    for (const t of panels) for (let k = 0; k < 3; k++) out.add(linkage.triangles[3 * t + k]);
    return [...out].sort((a, b) => a - b);
}

export function panelsAround(linkage: Linkage, hinges: Iterable<number>): number[] {
    const out = new Set<number>();
    for (const h of hinges) for (const t of [linkage.around[2 * h], linkage.around[2 * h + 1]]) if (t >= 0) out.add(t);
    return [...out];
}
