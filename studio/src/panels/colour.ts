// Colour maps and the scales behind them: Tide for magnitudes, Level for signed values.

export type Rgb = [number, number, number];

const tideStops = ["#31357d", "#2e5292", "#216e9b", "#24899e", "#36a39b", "#62b88f", "#9ac77c", "#ccd77a", "#fbe786"];
const levelStops = ["#17397b", "#3064a4", "#5990c7", "#9ab8d8", "#e4dcd6", "#e1ae8c", "#db7b40", "#b0512b", "#862919"];

export function hexToRgb(hex: string): Rgb {
    const v = parseInt(hex.slice(1), 16);
    return [v >> 16, (v >> 8) & 255, v & 255];
}

export interface ColourMap {
    name: "tide" | "level";
    /** 256 colours, 3 bytes each. */
    table: Uint8Array;
    /** For style sheets. */
    stops: string[];
}

function mapOf(name: ColourMap["name"], stops: string[]): ColourMap {
    const colours = stops.map(hexToRgb);
    const table = new Uint8Array(256 * 3);
    for (let i = 0; i < 256; i++) {
        const x = (i / 255) * (stops.length - 1);
        const k = Math.min(stops.length - 2, Math.floor(x));
        for (let c = 0; c < 3; c++) table[3 * i + c] = Math.round(colours[k][c] + (x - k) * (colours[k + 1][c] - colours[k][c]));
    }
    return { name, table, stops };
}

export const tide = mapOf("tide", tideStops);
export const level = mapOf("level", levelStops);
export const colourMaps = { tide, level };

export interface Scale {
    map: ColourMap;
    lo: number;
    hi: number;
}

/** Colour of a value; what lies outside takes the end colour, what is missing a grey. */
export function colourOf(scale: Scale, value: number): Rgb {
    if (Number.isNaN(value)) return [168, 174, 184];
    const x = Math.max(0, Math.min(1, (value - scale.lo) / (scale.hi - scale.lo || 1)));
    const i = 3 * Math.round(255 * x);
    return [scale.map.table[i], scale.map.table[i + 1], scale.map.table[i + 2]];
}

/** Fills 4 bytes per value, alpha 255. */
export function paint(scale: Scale, values: Float32Array, out: Uint8Array): void {
    const { table } = scale.map;
    const span = 255 / (scale.hi - scale.lo || 1);
    for (let t = 0; t < values.length; t++) {
        const v = values[t];
        const o = 4 * t;
        if (v !== v) {
            out[o] = 168;
            out[o + 1] = 174;
            out[o + 2] = 184;
        } else {
            const i = 3 * Math.max(0, Math.min(255, Math.round((v - scale.lo) * span)));
            out[o] = table[i];
            out[o + 1] = table[i + 1];
            out[o + 2] = table[i + 2];
        }
        out[o + 3] = 255;
    }
}

/** The next of 1, 2, 5, 6 x 10^n at or above. */
export function niceAbove(value: number): number {
    if (!(value > 0) || !Number.isFinite(value)) return 1;
    const ten = 10 ** Math.floor(Math.log10(value));
    for (const m of [1, 2, 5, 6, 10]) if (m * ten >= value * (1 - 1e-9)) return m * ten;
    return 10 * ten;
}

/** The largest of 1, 2, 5 x 10^n that is not above: the length of a scale bar. */
export function niceBelow(value: number): number {
    const ten = 10 ** Math.floor(Math.log10(value));
    for (const m of [5, 2, 1]) if (m * ten <= value * (1 + 1e-9)) return m * ten;
    return ten;
}

export function percentile(values: Float32Array, share: number): number {
    const sorted = values.filter((v) => !Number.isNaN(v)).sort();
    return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : NaN;
}

/** Counts per bin, values outside the scale in the end bins. */
export function histogram(values: Float32Array, lo: number, hi: number, bins: number): Uint32Array {
    const out = new Uint32Array(bins);
    const span = bins / (hi - lo || 1);
    for (const v of values) if (v === v) out[Math.max(0, Math.min(bins - 1, Math.floor((v - lo) * span)))]++;
    return out;
}
