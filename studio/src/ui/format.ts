// Numbers and words for people, and the other way round.

export type LengthUnit = "mm" | "cm" | "m";
const metres: Record<string, number> = { mm: 0.001, cm: 0.01, m: 1, km: 1000, in: 0.0254, '"': 0.0254, "″": 0.0254, ft: 0.3048, "'": 0.3048, "′": 0.3048 };

/** Digits after the point so that about `significant` figures show, trailing zeros kept as tables want them. */
export function decimals(value: number, significant: number): number {
    if (value === 0 || !Number.isFinite(value)) return 0;
    return Math.max(0, Math.min(6, significant - 1 - Math.floor(Math.log10(Math.abs(value)))));
}

const formats = new Map<number, Intl.NumberFormat>(); // making one takes far longer than using it
function format(digits: number): Intl.NumberFormat {
    const known = formats.get(digits);
    if (known) return known;
    const made = new Intl.NumberFormat("en-US", { minimumFractionDigits: digits, maximumFractionDigits: digits });
    formats.set(digits, made);
    return made;
}

export function number(value: number | null | undefined, digits: number): string {
    if (value === null || value === undefined || !Number.isFinite(value)) return "–";
    const text = format(digits).format(Math.abs(value));
    const zero = !/[1-9]/.test(text);
    return value < 0 && !zero ? `−${text}` : text;
}

export function count(value: number): string {
    return number(value, 0);
}

export function plural(n: number, one: string, many = `${one}s`): string {
    return `${count(n)} ${n === 1 ? one : many}`;
}

/** 0.0000000012 as 1.2e-9, others plainly. */
export function scientific(value: number | null): string {
    if (value === null || !Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    if (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6) return value.toExponential(0).replace("e+", "e").replace("-", value < 0 ? "−" : "-");
    return number(value, decimals(value, 2));
}

/** A length in the unit that reads best: metres above one, millimetres below a tenth. */
export function length(value: number, unit: LengthUnit): string {
    if (!Number.isFinite(value)) return "–";
    const m = value * metres[unit];
    const size = Math.abs(m);
    if (size >= 0.1) return `${number(m, size >= 100 ? 0 : size >= 10 ? 1 : 2)} m`;
    const mm = 1000 * m;
    return size < 5e-7 ? "0 mm" : `${number(mm, Math.abs(mm) >= 10 ? 0 : Math.abs(mm) >= 0.1 ? 1 : 3)} mm`;
}

export function extent(min: readonly number[], max: readonly number[], dimensions: number, unit: LengthUnit): string {
    const sizes = Array.from({ length: dimensions }, (_, k) => (max[k] - min[k]) * metres[unit]);
    const large = Math.max(...sizes) >= 0.5;
    const text = sizes.map((s) => number(large ? s : 1000 * s, large ? (s >= 100 ? 0 : 1) : 0));
    return `${text.join(" × ")} ${large ? "m" : "mm"}`;
}

export function bytes(n: number): string {
    return n < 1000 ? `${n} B` : n < 1e6 ? `${number(n / 1e3, 0)} kB` : `${number(n / 1e6, 1)} MB`;
}

export function time(seconds: number): string {
    const date = new Date(seconds * 1000);
    const today = new Date();
    const clock = date.toLocaleTimeString("en-GB", { hour: "2-digit", minute: "2-digit" });
    if (date.toDateString() === today.toDateString()) return `Today, ${clock}`;
    return date.toLocaleDateString("en-GB", { day: "numeric", month: "long" });
}

/** What stands behind a number of this unit in a document of that unit. */
export function unitLabel(unit: string, documentUnit: LengthUnit): string {
    return unit.replace(/\blength\b/, documentUnit).replace("deg", "°").replace("m2", "m²");
}

/** Reads what people type into a number field: `1.2m`, `48"`, `3'6"`, `1200/3`, `2*(0.4+0.1) m`, `60 %`, `30°`. The answer is in
 *  the field's unit; numbers without one are too. Null when it cannot be read. */
export function parseQuantity(text: string, unit: string, documentUnit: LengthUnit): number | null {
    const source = text.trim().replace(/[−–]/g, "-").replace(/(\d),(\d{3})\b/g, "$1$2").replace(/(\d),(\d)/g, "$1.$2");
    if (source === "") return null;
    const isLength = unit === "length" || unit in metres;
    const own = unit === "length" ? documentUnit : unit;
    // one unit behind a whole sum or quotient stands for all of it: 1200/3 mm is 400 mm
    const whole = /^([-+*/×().\d\se]*[-+*/×][-+*/×().\d\se]*?)(mm|cm|km|m|in|ft|["'″′])$/.exec(source);
    if (whole && isLength && /[\d)]\s*$/.test(whole[1])) {
        const v = parseQuantity(whole[1], "", documentUnit);
        return v === null ? null : (v * metres[whole[2]]) / metres[own];
    }
    let at = 0;
    const skip = () => {
        while (source[at] === " ") at++;
    };
    const fail = (): never => {
        throw new SyntaxError(text);
    };
    const atom = (): number => {
        skip();
        if (source[at] === "(") {
            at++;
            const v = sum();
            skip();
            if (source[at++] !== ")") fail();
            return v;
        }
        const match = /^(\d+(\.\d*)?|\.\d+)(e[-+]?\d+)?/i.exec(source.slice(at));
        if (!match) return fail();
        at += match[0].length;
        return Number(match[0]);
    };
    const quantity = (): number => {
        let v = atom();
        skip();
        const match = /^(mm|cm|km|m(?![a-z²2])|in\b|ft\b|["'″′])/.exec(source.slice(at));
        if (match) {
            if (!isLength) fail();
            at += match[0].length;
            v *= metres[match[0]] / metres[own];
            if ("'′".includes(match[0])) {
                // feet may be followed by inches
                skip();
                const inches = /^(\d+(\.\d*)?)\s*["″]?/.exec(source.slice(at));
                if (inches) {
                    at += inches[0].length;
                    v += (Number(inches[1]) * metres.in) / metres[own];
                }
            }
        }
        return v;
    };
    const signed = (): number => {
        skip();
        if (source[at] === "-") {
            at++;
            return -signed();
        }
        if (source[at] === "+") at++;
        return quantity();
    };
    const product = (): number => {
        let v = signed();
        for (;;) {
            skip();
            if (source[at] === "*" || source[at] === "×") {
                at++;
                v *= signed();
            } else if (source[at] === "/") {
                at++;
                v /= signed();
            } else return v;
        }
    };
    const sum = (): number => {
        let v = product();
        for (;;) {
            skip();
            if (source[at] === "+") {
                at++;
                v += product();
            } else if (source[at] === "-") {
                at++;
                v -= product();
            } else return v;
        }
    };
    try {
        let v = sum();
        skip();
        // what is left may name the field's own unit
        const rest = source.slice(at).trim().toLowerCase();
        const label = unitLabel(unit, documentUnit).toLowerCase();
        if (rest && rest !== label && rest !== unit.toLowerCase()) {
            if (unit === "deg" && rest === "rad") v *= 180 / Math.PI;
            else return null;
        }
        return Number.isFinite(v) ? v : null;
    } catch {
        return null;
    }
}
