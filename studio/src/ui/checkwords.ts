// A check in the few words that fit its cell. What the page has no shorter words for stays as the server put it.
import type { Check } from "../protocol/types";
import { type LengthUnit, length, number, scientific } from "./format";

export interface CheckWords {
    question: string;
    answer: string;
    limit: string;
}

const capital = (s: string) => s.charAt(0).toUpperCase() + s.slice(1);

/** `edge` is the panel edge L in the document's unit. */
export function checkWords(c: Check, unit: LengthUnit, edge: number): CheckWords {
    const v = c.value;
    const limit = capital(c.limit.replace("mean curvature above", "mean curvature >").replace(/ on \d+ (of \d+ )?panels.*$/, "").replace(/^1 to 2, asked within/, "off by up to").replace(/ deg\b/, "°").replace(/^([\d.]+) L\b/, (_, n: string) => `Limit ${length(Number(n) * edge, unit)}`).replace(/^([\d.e-]+) (mm|cm|m)$/, (_, n: string, u: string) => `Limit ${length(Number(n), u as LengthUnit)}`));
    const words = (question: string, answer: string | null): CheckWords => ({ question, answer: answer ?? capital(c.answer), limit });
    switch (c.key) {
        case "scale": return words("Scale factor λ", null);
        case "mouth": return words("Smallest mouth", v === null ? null : `${number((v * 180) / Math.PI, 1)}°`);
        case "overlap": return words("Collisions", v === 0 ? "None" : null);
        case "curvature": return words("Bulges outward", v === 0 ? "Everywhere" : v === null ? null : `Not on ${number(100 * v, v < 0.1 ? 1 : 0)} %`);
        case "rim": return words("Rim and constraints", v === null ? null : v < 1e-9 ? "Exactly met" : `${length(v, unit)} off`);
        case "match": return /^(slack|taut)/.test(c.answer) ? words("Material", capital(c.answer)) : words("Simulated to design", v === null ? null : `${length(v * edge, unit)} rms`);
        case "force": return c.answer.startsWith("exact") && v !== null ? { question: "Forces in balance", answer: "Exact", limit: `Residual ${scientific(v)}` } : words("Forces in balance", c.severity === "unknown" ? "Not exact yet" : capital(c.answer.replace(/^edges off by/, "off by")));
        default: return words(c.title, null);
    }
}
