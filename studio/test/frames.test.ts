import { describe, expect, it } from "vitest";
import { decodeFrame, encodeFrame, isState, kinds, mergeFrames, section, type Numbers } from "../src/protocol/frames";

const frame = () => encodeFrame({
    kind: kinds.state, re: 0, topology: 7, revision: 12, serial: 41, flags: 9,
    sections: new Map<number, Numbers>([
        [section.flat, Float32Array.of(1, -2, 0.5, 3)], [section.names, new TextEncoder().encode("A1\nB2\n")],
        [section.triangles, Int32Array.of(0, 1, 2)], [section.simulated, new Float32Array(0)],
    ]),
});

describe("frames", () => {
    it("come back as they were sent", () => {
        const f = decodeFrame(frame());
        expect([f.kind, f.topology, f.revision, f.serial, f.flags]).toEqual([1, 7, 12, 41, 9]);
        expect([...f.sections.get(section.flat)!]).toEqual([1, -2, 0.5, 3]);
        expect(new TextDecoder().decode(f.sections.get(section.names) as Uint8Array)).toBe("A1\nB2\n");
        expect([...f.sections.get(section.triangles)!]).toEqual([0, 1, 2]);
    });
    it("are one of what changed last, of the later state", () => {
        const before = decodeFrame(frame());
        const after = { ...before, revision: 13, serial: 0, sections: new Map<number, Numbers>([[section.flat, Float32Array.of(5, 6)], [section.deployed, Float32Array.of(7)]]) };
        const both = decodeFrame(encodeFrame(mergeFrames(before, after)));
        expect([both.revision, both.serial, both.topology]).toEqual([13, 0, 7]);
        expect([...both.sections.get(section.flat)!]).toEqual([5, 6]);
        expect([...both.sections.get(section.deployed)!]).toEqual([7]);
        expect([...both.sections.get(section.triangles)!]).toEqual([0, 1, 2]);
        expect(mergeFrames(null, after)).toEqual(after);
    });
    it("tell states from others before they are taken apart", () => {
        expect(isState(frame())).toBe(true);
        expect(isState(encodeFrame({ ...decodeFrame(frame()), kind: kinds.motion }))).toBe(false);
        expect(isState(new ArrayBuffer(4))).toBe(false);
    });
    it("say by an empty section that there is no such thing", () => {
        const f = decodeFrame(frame());
        expect(f.sections.get(section.simulated)!.length).toBe(0);
        expect(f.sections.has(section.deployed)).toBe(false);
    });
    it("are laid out as docs/protocol.md says, byte by byte", () => {
        const bytes = new DataView(frame());
        expect(bytes.getUint32(0, true)).toBe(0x31465841);
        expect([4, 8, 12, 16, 20, 24, 28].map((at) => bytes.getUint32(at, true))).toEqual([1, 0, 7, 12, 41, 9, 4]);
        expect([32, 36, 40].map((at) => bytes.getUint32(at, true))).toEqual([16, 1, 4]);
        expect(bytes.getFloat32(44 + 4, true)).toBe(-2);
    });
    it("that are cut off anywhere are refused", () => {
        const whole = frame();
        for (let n = 0; n < whole.byteLength; n++) expect(() => decodeFrame(whole.slice(0, n)), `${n} bytes`).toThrow();
    });
    it("that are not frames are refused", () => {
        expect(() => decodeFrame(new ArrayBuffer(64))).toThrow(/start/);
        const wrongType = frame();
        new DataView(wrongType).setUint32(36, 9, true);
        expect(() => decodeFrame(wrongType)).toThrow(/type/);
    });
});
