// A small patch of fully open kagome for tests: hinges are the points of a triangular lattice of spacing 1 without those whose
// coordinates are both odd; those are the middles of the holes.
import { type Linkage, loopsOf, makeLinkage } from "../src/panels/linkage";

export function patch(n: number): { linkage: Linkage; places: Float32Array; at(i: number, j: number): number } {
    const hinges = new Map<string, number>();
    const places: number[] = [];
    const is = (i: number, j: number) => i >= 0 && j >= 0 && i <= n && j <= n && !((i & 1) === 1 && (j & 1) === 1);
    for (let j = 0; j <= n; j++)
        for (let i = 0; i <= n; i++)
            if (is(i, j)) {
                hinges.set(`${i},${j}`, hinges.size);
                places.push(i + j / 2, (j * Math.sqrt(3)) / 2, 0);
            }
    const at = (i: number, j: number) => hinges.get(`${i},${j}`)!;
    const triangles: number[] = [];
    const holes: number[][] = [];
    for (let j = 0; j <= n; j++)
        for (let i = 0; i <= n; i++) {
            if (is(i, j) && is(i + 1, j) && is(i, j + 1)) triangles.push(at(i, j), at(i + 1, j), at(i, j + 1));
            if (is(i + 1, j) && is(i + 1, j + 1) && is(i, j + 1)) triangles.push(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            const round = [[1, 0], [0, 1], [-1, 1], [-1, 0], [0, -1], [1, -1]].map(([a, b]) => [i + a, j + b]);
            if ((i & 1) === 1 && (j & 1) === 1 && round.every(([a, b]) => is(a, b))) holes.push(round.map(([a, b]) => at(a, b)));
        }
    return { linkage: makeLinkage(hinges.size, Uint32Array.from(triangles), loopsOf(holes), loopsOf([])), places: Float32Array.from(places), at };
}
