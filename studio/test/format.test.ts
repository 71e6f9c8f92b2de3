import { describe, expect, it } from "vitest";
import { bytes, extent, length, number, parseQuantity, plural, scientific, unitLabel } from "../src/ui/format";

describe("what people type", () => {
    it.each([
        ["1.2m", "m", 1.2], ["1200 mm", "m", 1.2], ["1200/3 mm", "m", 0.4], ["(2 + 3)*2 cm", "m", 0.1], ["3 m - 20 cm", "m", 2.8], ["48\"", "m", 1.2192], ["3'6\"", "m", 1.0668], ["3' 6", "m", 1.0668],
        ["2*(0.4+0.1)", "m", 1], ["-0.5", "m", -0.5], ["−0.5", "m", -0.5], ["1,5", "m", 1.5], ["1,200", "mm", 1200], [".5 m", "cm", 50], ["1e-3", "m", 0.001], ["2 m + 30 cm", "m", 2.3],
    ])("%s in a document of %s", (text, unit, value) => {
        expect(parseQuantity(text, "length", unit as "m")).toBeCloseTo(value, 9);
    });
    it("takes the field's own unit and no other", () => {
        expect(parseQuantity("30°", "deg", "m")).toBe(30);
        expect(parseQuantity("0.5 rad", "deg", "m")).toBeCloseTo(28.6479, 4);
        expect(parseQuantity("60 %", "%", "m")).toBe(60);
        expect(parseQuantity("2.4 kg/m²", "kg/m2", "m")).toBe(2.4);
        expect(parseQuantity("100 Pa", "Pa", "m")).toBe(100);
        expect(parseQuantity("3 mm", "Pa", "m")).toBeNull();
    });
    it.each(["", "abc", "1..2", "(1", "1 + ", "2 kg", "1/0", "--"])("cannot read %j", (text) => expect(parseQuantity(text, "length", "m")).toBeNull());
});

describe("what people read", () => {
    it("has true minus signs, and no minus before zero", () => {
        expect(number(-24.1, 1)).toBe("−24.1");
        expect(number(-0.001, 1)).toBe("0.0");
        expect(number(2488, 0)).toBe("2,488");
        expect(number(NaN, 1)).toBe("–");
    });
    it("names lengths in the unit that reads best", () => {
        expect(length(0.014, "m")).toBe("14 mm");
        expect(length(1.234, "m")).toBe("1.23 m");
        expect(length(1234, "mm")).toBe("1.23 m");
        expect(length(0.0004, "m")).toBe("0.4 mm");
        expect(extent([0, 0, 0], [11.6, 9, 2.4], 3, "m")).toBe("11.6 × 9.0 × 2.4 m");
        expect(extent([0, 0], [120, 80], 2, "mm")).toBe("120 × 80 mm");
    });
    it("counts and scales", () => {
        expect(plural(1, "panel")).toBe("1 panel");
        expect(plural(12, "hinge")).toBe("12 hinges");
        expect(scientific(8.2e-11)).toBe("8e-11");
        expect(scientific(0.0312)).toBe("0.031");
        expect(bytes(1234567)).toBe("1.2 MB");
        expect(unitLabel("1/length2", "m")).toBe("1/length2");
        expect(unitLabel("kg/m2", "m")).toBe("kg/m²");
    });
});
