// One shell as the server last described it: the linkage and every section that came, kept up to date frame by frame.
import { type Frame, type Numbers, flag, section } from "../protocol/frames";
import type { LinkageEvent } from "../protocol/types";
import { type Linkage, makeLinkage } from "./linkage";

const none = new Float32Array(0);

export class Shell {
    readonly topology: number;
    readonly unit: string;
    readonly spacing: number;
    readonly origin: [number, number, number];
    readonly flatOrigin: [number, number];
    readonly linkage: Linkage;
    readonly onRim: Uint8Array;
    /** Column, row, up or down: 3 per panel. */
    readonly places: Int32Array;
    readonly names: string[];
    /** 3 per hinge, z = 0, like the flat state: every state has the same shape of array. */
    readonly sheet: Float32Array;
    readonly flat: Float32Array;
    deployed: Float32Array = none;
    simulated: Float32Array | null = null;
    prescribed: Float32Array = none;
    realised: Float32Array = none;
    opening: Float32Array = none;
    material: Float32Array = none;
    mouth: Float32Array = none;
    residual: Float32Array = none;
    curvature: Float32Array = none;
    forces: Float32Array | null = null;
    supports: Uint8Array = new Uint8Array(0);
    reactions: Float32Array | null = null;
    revision = 0;
    serial = 0;
    flags = 0;

    constructor(event: LinkageEvent, first: Frame) {
        const get = <T extends Numbers>(name: number) => (first.sections.get(name) ?? none) as T;
        this.topology = event.topology;
        this.unit = event.unit;
        this.spacing = event.spacing;
        this.origin = event.origin;
        this.flatOrigin = event.flat_origin;
        this.linkage = makeLinkage(event.hinges, unsigned(get(section.triangles)),
            { start: unsigned(get(section.holeStart)), items: unsigned(get(section.holeHinges)) },
            { start: unsigned(get(section.openingStart)), items: unsigned(get(section.openingHinges)) });
        this.onRim = get<Uint8Array>(section.onRim).slice();
        this.places = get<Int32Array>(section.panels).slice();
        this.names = new TextDecoder().decode(get<Uint8Array>(section.names)).split("\n").slice(0, this.linkage.panels);
        this.sheet = new Float32Array(3 * event.hinges);
        this.flat = new Float32Array(3 * event.hinges);
        this.supports = new Uint8Array(event.hinges);
        lift(get(section.sheet), this.sheet);
        this.take(first);
    }

    /** A shell that came from another thread: its fields alone do. */
    static from(fields: Shell): Shell {
        return Object.assign(Object.create(Shell.prototype) as Shell, fields);
    }

    /** What a later frame changed. */
    take(frame: Frame): void {
        const floats = (name: number, present: Float32Array) => (frame.sections.get(name) as Float32Array | undefined) ?? present;
        const orNone = (name: number, present: Float32Array | null) => {
            const data = frame.sections.get(name) as Float32Array | undefined;
            return data === undefined ? present : data.length ? data : null;
        };
        const flat = frame.sections.get(section.flat);
        if (flat) lift(flat as Float32Array, this.flat);
        this.deployed = floats(section.deployed, this.deployed);
        this.simulated = orNone(section.simulated, this.simulated);
        this.prescribed = floats(section.prescribed, this.prescribed);
        this.realised = floats(section.realised, this.realised);
        this.opening = floats(section.opening, this.opening);
        this.material = floats(section.material, this.material);
        this.mouth = floats(section.mouth, this.mouth);
        this.residual = floats(section.residual, this.residual);
        this.curvature = floats(section.curvature, this.curvature);
        this.forces = orNone(section.forces, this.forces);
        this.reactions = orNone(section.reactions, this.reactions);
        this.supports = (frame.sections.get(section.supports) as Uint8Array | undefined) ?? this.supports;
        this.revision = frame.revision;
        this.serial = frame.serial;
        this.flags = frame.flags;
    }

    get moving(): boolean {
        return (this.flags & flag.moving) !== 0;
    }
    get exact(): boolean {
        return (this.flags & flag.exact) !== 0;
    }

    name(panel: number): string {
        return this.names[panel] ?? String(panel);
    }
}

/** Two numbers per hinge to three. */
function lift(from: Float32Array, to: Float32Array): void {
    for (let h = 0; 2 * h < from.length; h++) {
        to[3 * h] = from[2 * h];
        to[3 * h + 1] = from[2 * h + 1];
    }
}

function unsigned(data: Numbers): Uint32Array {
    return new Uint32Array(data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength));
}
