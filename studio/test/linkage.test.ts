import { describe, expect, it } from "vitest";
import * as THREE from "three";
import { boundsOf, gather, loopCount, medianEdge } from "../src/panels/linkage";
import { hingeWords, hingesOf, insidePolygon, kagomeLine, panelOf, panelsAround, shortestWay, straightOn } from "../src/panels/lines";
import { awayFromRim, distances, hingeNormals, leastAtCorners, panelNormals, rangeOf } from "../src/panels/measures";
import { Skin } from "../src/scene/skin";
import { patch } from "./kagome";

describe("a linkage", () => {
    it("knows the two panels of every hinge and the three neighbours of every panel", () => {
        const { linkage } = patch(8);
        for (let t = 0; t < linkage.panels; t++)
            for (let k = 0; k < 3; k++) {
                const n = linkage.neighbours[3 * t + k];
                if (n < 0) continue;
                expect([0, 1, 2].map((i) => linkage.neighbours[3 * n + i])).toContain(t);
                expect([0, 1, 2].map((i) => linkage.triangles[3 * n + i])).toContain(linkage.triangles[3 * t + k]);
            }
    });
    it("is covered by its skin: panels and holes, once", () => {
        const { linkage, places } = patch(8);
        let area = 0;
        for (let i = 0; i < linkage.skin.length; i += 3) {
            const [a, b, c] = [0, 1, 2].map((k) => new THREE.Vector3().fromArray(places, 3 * linkage.skin[i + k]));
            area += b.sub(a).cross(c.sub(a)).length() / 2;
        }
        expect(area).toBeCloseTo((Math.sqrt(3) / 4) * (linkage.panels + 6 * loopCount(linkage.holes)), 4);
    });
    it("has the edge, bounds and corners that it was made with", () => {
        const { linkage, places } = patch(6);
        expect(medianEdge(linkage, places)).toBeCloseTo(1, 6);
        expect(boundsOf(places).max[0]).toBeCloseTo(9, 6);
        const corners = new Float32Array(9 * linkage.panels);
        gather(linkage.triangles, places, corners);
        expect([...corners.slice(0, 3)]).toEqual([...places.slice(3 * linkage.triangles[0], 3 * linkage.triangles[0] + 3)]);
    });
});

describe("the range that is told", () => {
    it("leaves out panels at the rim and beside those", () => {
        const { linkage } = patch(10);
        const judged = awayFromRim(linkage);
        const values = new Float32Array(linkage.panels).fill(1.5);
        let inside = 0;
        for (let t = 0; t < linkage.panels; t++) {
            const near = [0, 1, 2].map((k) => linkage.neighbours[3 * t + k]);
            const far = near.every((n) => n >= 0 && [0, 1, 2].every((k) => linkage.neighbours[3 * n + k] >= 0));
            expect(judged[t]).toBe(Number(far));
            if (far) inside++;
            else values[t] = 1.01;
        }
        expect(inside).toBeGreaterThan(10);
        expect(rangeOf(values, judged)).toEqual([1.5, 1.5]);
        expect(rangeOf(values)[0]).toBeCloseTo(1.01, 6);
    });
    it("is of all panels where none is far inside", () => {
        expect([...awayFromRim(patch(2).linkage)].every((v) => v === 1)).toBe(true);
    });
});

describe("lines", () => {
    it("run straight through every hinge", () => {
        const { linkage, places, at } = patch(10);
        expect(straightOn(linkage, at(2, 4), at(3, 4))).toBe(at(4, 4));
        const row = kagomeLine(linkage, at(3, 4), at(4, 4));
        expect(row).toEqual(Array.from({ length: 11 }, (_, i) => at(i, 4)));
        for (const h of row) expect(places[3 * h + 1]).toBeCloseTo(2 * Math.sqrt(3), 5);
        expect(kagomeLine(linkage, at(4, 2), at(4, 3))).toEqual(Array.from({ length: 11 }, (_, j) => at(4, j)));
        expect(kagomeLine(linkage, at(0, 0), at(5, 4))).toEqual([]);
    });
    it("between two hinges are the shortest", () => {
        const { linkage, places, at } = patch(10);
        const way = shortestWay(linkage, places, at(2, 2), at(6, 6));
        expect([way[0], way.at(-1)]).toEqual([at(2, 2), at(6, 6)]);
        let length = 0;
        for (let k = 1; k < way.length; k++) {
            expect(panelOf(linkage, way[k - 1], way[k])).toBeGreaterThanOrEqual(0);
            length += 1;
        }
        expect(length).toBe(8);
        expect(shortestWay(linkage, places, at(2, 2), at(2, 2))).toEqual([at(2, 2)]);
    });
    it("are written as operators read them", () => {
        expect(hingeWords([0, 1, 2, 3, 40, 7, 8])).toBe("0-3,40,7,8");
        expect(hingeWords([5])).toBe("5");
        expect(hingeWords([])).toBe("");
    });
    it("and panels find each other", () => {
        const { linkage } = patch(4);
        const hinges = hingesOf(linkage, [0]);
        expect(hinges.length).toBe(3);
        expect(panelsAround(linkage, hinges)).toContain(0);
    });
    it("of a lasso have an inside", () => {
        const square = [{ x: 0, y: 0 }, { x: 2, y: 0 }, { x: 2, y: 2 }, { x: 0, y: 2 }];
        expect(insidePolygon(square, 1, 1)).toBe(true);
        expect(insidePolygon(square, 3, 1)).toBe(false);
    });
});

describe("measures", () => {
    it("take normals from the side on which corners run counter-clockwise", () => {
        const { linkage, places } = patch(4);
        const normals = new Float32Array(3 * linkage.panels);
        panelNormals(linkage.triangles, places, normals);
        for (let t = 0; t < linkage.panels; t++) expect(normals[3 * t + 2]).toBeCloseTo(1, 6);
        const ups = new Float32Array(3 * linkage.hinges);
        hingeNormals(linkage, normals, ups);
        expect(ups[2]).toBeCloseTo(1, 6);
    });
    it("skip what is missing", () => {
        const { linkage } = patch(4);
        const perHinge = new Float32Array(linkage.hinges).fill(NaN);
        perHinge[linkage.triangles[1]] = 3;
        expect(leastAtCorners(linkage, perHinge)[0]).toBe(3);
        expect(rangeOf(Float32Array.of(NaN, 2, -1))).toEqual([-1, 2]);
        expect(rangeOf(Float32Array.of(NaN))).toEqual([NaN, NaN]);
    });
    it("give the largest distance of a panel's hinges", () => {
        const { linkage, places } = patch(4);
        const moved = places.slice();
        moved[3 * linkage.triangles[2] + 2] = 0.25;
        expect(distances(linkage, places, moved)[0]).toBeCloseTo(0.25, 6);
    });
});

describe("the skin", () => {
    it("finds panel, hinge and hole under a ray, and carries a place to another state", () => {
        const { linkage, places, at } = patch(8);
        const flat = new Skin(linkage, places);
        const raised = places.map((v, k) => (k % 3 === 2 ? 5 : v + 1));
        const space = new Skin(linkage, raised);
        const down = new THREE.Vector3(0, 0, -1);
        const centre = flat.centre(0, new THREE.Vector3());
        const on = flat.cast(new THREE.Ray(centre.clone().setZ(9), down))!;
        expect(on.face).toBe(0);
        expect(flat.panelAt(on)).toBe(0);
        const there = space.carry(on, new THREE.Vector3());
        expect([there.x, there.y, there.z]).toEqual([centre.x + 1, centre.y + 1, 5].map((v) => expect.closeTo(v, 5)));
        // in a hole (its middle is at lattice place 3, 3) the nearest panel is meant
        const hole = flat.cast(new THREE.Ray(new THREE.Vector3(4.5 + 0.8, 3 * Math.sqrt(0.75), 9), down))!;
        expect(hole.face).toBeGreaterThanOrEqual(linkage.panels);
        expect(flat.hingeAt(hole)).toBe(at(4, 3));
        expect(linkage.triangles.slice(3 * flat.panelAt(hole), 3 * flat.panelAt(hole) + 3)).toContain(at(4, 3));
        expect(flat.cast(new THREE.Ray(new THREE.Vector3(-5, -5, 9), down))).toBeNull();
    });
    it("follows places that move", () => {
        const { linkage, places } = patch(6);
        const skin = new Skin(linkage, places);
        const from = new THREE.Vector3(3, 1, 100);
        expect(skin.nearest(from)!.point.z).toBe(0);
        for (let i = 2; i < places.length; i += 3) places[i] = 40;
        skin.touch();
        expect(skin.nearest(from)!.point.z).toBeCloseTo(40, 4);
    });
});
