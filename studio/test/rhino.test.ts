// The Rhino document, read again by McNeel's library.
import load from "rhino3dm/rhino3dm.module.js";
import { beforeAll, describe, expect, it } from "vitest";
import type { RhinoModule } from "rhino3dm";
import { type DesignFile, release, rhinoFile, rowOf } from "../src/rhino/design";

let rhino: RhinoModule;
beforeAll(async () => {
    rhino = await load();
});
const design: DesignFile = {
    units: "m",
    triangles: [[0, 1, 2], [2, 3, 4], [4, 5, 6]],
    supports: [0, 4],
    flat: [[0, 0], [1, 0], [0.5, 0.8], [1.1, 1.5], [0.1, 1.6], [0.6, 2.1], [-0.4, 2.3]],
    deployed: [[0, 0, 0], [1, 0, 1 / 3], [0.5, 0.8, 0.1], [1.1, 1.5, 0.3], [0.1, 1.6, 0.2], [0.6, 2.1, 0.4], [-0.4, 2.3, 0.7]],
    simulated: [[0, 0, 0], [1, 0, 0.3], [0.5, 0.8, 1 / 7], [1.1, 1.5, 0.3], [0.1, 1.6, 0.2], [0.6, 2.1, 0.4], [-0.4, 2.3, 0.7]],
    report: { panels: ["A1", "B1", "B2"] },
};

describe("a Rhino document", () => {
    it("has every panel of every state by its name, on the layer of its row, to the last bit", () => {
        const file = rhino.File3dm.fromByteArray(rhinoFile(rhino, design, "deployed"));
        expect(file.settings().modelUnitSystem).toBe(rhino.UnitSystem.Meters);
        const places = { flat: design.flat.map(([x, y]) => [x, y, 0]), deployed: design.deployed, simulated: design.simulated };
        const counts = { flat: 0, deployed: 0, simulated: 0 };
        let supports = 0;
        for (let k = 0; k < file.objects().count; ++k) {
            const object = file.objects().get(k);
            const attributes = object.attributes();
            const geometry = object.geometry();
            const path = file.layers().get(attributes.layerIndex).fullPath.split("::");
            const state = path[0] as keyof typeof counts;
            if (path[1] === "supports") {
                ++supports;
                continue;
            }
            const panel = design.report.panels.indexOf(attributes.name);
            expect(panel).toBeGreaterThanOrEqual(0);
            expect(path).toEqual([state, rowOf(attributes.name)]);
            const vertices = (geometry as InstanceType<RhinoModule["Mesh"]>).vertices();
            for (let corner = 0; corner < 3; ++corner) {
                const hinge = design.triangles[panel][corner];
                expect(vertices.point3dAt(corner)).toEqual(places[state]![hinge]);
            }
            ++counts[state];
        }
        expect(counts).toEqual({ flat: design.triangles.length, deployed: design.triangles.length, simulated: design.triangles.length });
        expect(supports).toBe(2 * design.supports.length);
        release(file);
    });
    it("leaves out what was not simulated, and takes the design's unit", () => {
        const file = rhino.File3dm.fromByteArray(rhinoFile(rhino, { ...design, units: "mm", simulated: null }, "deployed"));
        expect(file.settings().modelUnitSystem).toBe(rhino.UnitSystem.Millimeters);
        expect(file.objects().count).toBe(2 * design.triangles.length + design.supports.length);
        release(file);
    });
    it("shows one state", () => {
        const file = rhino.File3dm.fromByteArray(rhinoFile(rhino, design, "flat"));
        for (let k = 0; k < file.layers().count; ++k) {
            const layer = file.layers().get(k);
            expect(layer.visible).toBe(layer.fullPath.startsWith("flat"));
        }
        release(file);
    });
});
