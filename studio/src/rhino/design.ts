// Designs as Rhino documents, by McNeel's own library: every panel a mesh with its name, on a layer of its row within that of its state.
import type { RhinoModule } from "rhino3dm";

/** What is read of an exported design (docs/formats.md). */
export interface DesignFile {
    units: "mm" | "cm" | "m";
    triangles: [number, number, number][];
    supports: number[];
    flat: [number, number][];
    deployed: [number, number, number][];
    simulated: [number, number, number][] | null;
    report: { panels: string[] };
}
type Point = readonly [number, number, number];
const states = ["flat", "deployed", "simulated"] as const;
export type DesignState = (typeof states)[number];

const colours = {
    flat: { r: 90, g: 120, b: 150, a: 255 },
    deployed: { r: 40, g: 40, b: 40, a: 255 },
    simulated: { r: 150, g: 90, b: 60, a: 255 },
    supports: { r: 190, g: 30, b: 30, a: 255 },
};

/** What the library makes lies in its own memory; its types do not say how that is given back. */
export const release = (object: object) => (object as { delete(): void }).delete();

/** The row of a panel: "C" of "C14". */
export const rowOf = (panel: string) => /^[A-Z]+/.exec(panel)?.[0] ?? panel;

/** Only the layers of the state `shown` are visible. Readable from Rhino 7 on. */
export function rhinoFile(rhino: RhinoModule, design: DesignFile, shown: DesignState): Uint8Array {
    const file = new rhino.File3dm();
    const units = rhino.UnitSystem;
    file.settings().modelUnitSystem = { mm: units.Millimeters, cm: units.Centimeters, m: units.Meters }[design.units];
    const addLayer = (name: string, color: { r: number; g: number; b: number; a: number }, parent: string | null, visible: boolean) => {
        const layer = new rhino.Layer();
        layer.name = name;
        layer.color = color;
        layer.visible = visible;
        if (parent) layer.parentLayerId = parent;
        const index = file.layers().add(layer);
        release(layer);
        return { index, id: file.layers().get(index).id };
    };
    const addObject = (name: string, layer: number, add: (attributes: InstanceType<RhinoModule["ObjectAttributes"]>) => void) => {
        const attributes = new rhino.ObjectAttributes();
        attributes.name = name;
        attributes.layerIndex = layer;
        add(attributes);
        release(attributes);
    };
    for (const state of states) {
        const places: readonly Point[] | null = state === "flat" ? design.flat.map(([x, y]) => [x, y, 0]) : design[state];
        if (!places) continue;
        const top = addLayer(state, colours[state], null, state === shown);
        const rows = new Map<string, number>();
        design.triangles.forEach((corners, k) => {
            const name = design.report.panels[k];
            const row = rowOf(name);
            if (!rows.has(row)) rows.set(row, addLayer(row, colours[state], top.id, state === shown).index);
            const mesh = new rhino.Mesh();
            const vertices = mesh.vertices();
            corners.forEach((hinge, corner) => {
                vertices.add(...places[hinge]);
                vertices.setPoint3dAt(corner, [...places[hinge]]); // in double precision
            });
            mesh.faces().addTriFace(0, 1, 2);
            mesh.normals().computeNormals();
            addObject(name, rows.get(row)!, (attributes) => file.objects().addMesh(mesh, attributes));
            release(mesh);
        });
        if (state !== "flat" && design.supports.length) {
            const layer = addLayer("supports", colours.supports, top.id, state === shown).index;
            design.supports.forEach((hinge, k) => addObject(`S${k + 1}`, layer, (attributes) => file.objects().addPoint([...places[hinge]], attributes)));
        }
    }
    const options = new rhino.File3dmWriteOptions();
    options.version = 7;
    const bytes = file.toByteArrayOptions(options);
    release(file);
    return bytes;
}
