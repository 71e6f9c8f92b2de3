import { describe, expect, it } from "vitest";
import { detailFor, makeTemplate, type Detail } from "../src/panels/template";

describe("the panel template", () => {
    it.each(["full", "prism", "flat"] as Detail[])("%s: weights sum to one and lie within the panel", (detail) => {
        const t = makeTemplate(detail);
        for (let i = 0; i < t.bary.length; i += 3) {
            expect(t.bary[i] + t.bary[i + 1] + t.bary[i + 2]).toBeCloseTo(1, 6);
            for (let k = 0; k < 3; k++) expect(t.bary[i + k]).toBeGreaterThanOrEqual(-1e-7);
        }
        expect(Math.max(...t.index)).toBeLessThan(t.bary.length / 3);
    });
    it.each(["full", "prism"] as Detail[])("%s: is closed, every edge is used once in either direction", (detail) => {
        const t = makeTemplate(detail);
        const key = (v: number) => [...t.bary.slice(3 * v, 3 * v + 3), t.level[3 * v] - 0.1 * t.level[3 * v + 1]].map((x) => x.toFixed(5)).join();
        const edges = new Map<string, number>();
        for (let i = 0; i < t.index.length; i += 3)
            for (let k = 0; k < 3; k++) {
                const [a, b] = [key(t.index[i + k]), key(t.index[i + ((k + 1) % 3)])];
                edges.set(`${a}>${b}`, (edges.get(`${a}>${b}`) ?? 0) + 1);
            }
        for (const [edge, n] of edges) {
            expect(n).toBe(1);
            expect(edges.get(edge.split(">").reverse().join(">"))).toBe(1);
        }
    });
    it("keeps its level of detail within a fifth about the limits", () => {
        expect(detailFor(20, "flat")).toBe("full");
        expect(detailFor(3, "full")).toBe("flat");
        expect(detailFor(7.5, "full")).toBe("full");
        expect(detailFor(6, "full")).toBe("prism");
        expect(detailFor(9, "prism")).toBe("prism");
        expect(detailFor(10, "prism")).toBe("full");
        expect(detailFor(4.5, "flat")).toBe("flat");
    });
});
