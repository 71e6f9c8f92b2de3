// The legend: which field, how its values are spread, and where the panel under the cursor lies. A drag on it selects a range.
import { useSignal } from "@preact/signals";
import { hovered, select } from "../state/selection";
import { documentState } from "../state/session";
import { availableFields, fieldId, fieldView, mode, scaleLimit, useField } from "../state/view";
import { Choice } from "./controls";
import { type LengthUnit, number, scientific, unitLabel } from "./format";

const width = 256;
const bar = 12;

/** Where the panel under the cursor lies: apart, for the cursor moves more often than the rest changes. */
function Under({ values, at, chart }: { values: Float32Array; at: (value: number) => number; chart: number }) {
    const v = values[hovered.value] ?? NaN;
    if (!Number.isFinite(v)) return null;
    return <g stroke="var(--accent)" fill="var(--accent)" stroke-width="2"><path d={`M${at(v)} ${chart && 4}V${chart + bar + 2}`} />{chart > 0 && <circle cx={at(v)} cy="3" r="2" />}</g>;
}

/** `compact`: where the view is low, the values' spread is left out so that the shell is not covered. */
export function Legend({ compact }: { compact: boolean }) {
    const chart = compact ? 0 : 36;
    const view = fieldView.value;
    const drag = useSignal<[number, number] | null>(null);
    if (!view) return null;
    const { field, scale, range, bins, values } = view;
    const unit = (documentState.value?.unit ?? "m") as LengthUnit;
    const label = unitLabel(field.unit, unit);
    const x = (v: number) => (width * (v - scale.lo)) / (scale.hi - scale.lo);
    const clampX = (v: number) => Math.max(0, Math.min(width, x(v)));
    const most = Math.max(...bins, 1);
    const tickDigits = field.id === "lambda" ? 2 : Math.max(0, Math.min(6, -Math.floor(Math.log10((scale.hi - scale.lo) / 4) + 1e-9)));
    const rangeDigits = Math.max(field.digits, tickDigits);
    const tiny = tickDigits > 3; // residuals after solving
    const figure = (v: number, digits: number) => (tiny ? scientific(v) : number(v, digits));
    const signed = scale.lo < 0;
    const limit = field.id === "lambda" && scaleLimit.value < scale.hi ? clampX(scaleLimit.value) : null;
    const valueAt = (event: PointerEvent) => {
        const box = (event.currentTarget as SVGElement).getBoundingClientRect();
        return scale.lo + ((event.clientX - box.left) / box.width) * (scale.hi - scale.lo);
    };
    const pick = (a: number, b: number) => {
        const [lo, hi] = a < b ? [a, b] : [b, a];
        const panels: number[] = [];
        values.forEach((v, t) => v >= lo && v <= hi && panels.push(t));
        select(panels);
    };
    const tickValue = (k: number) => scale.lo + (k / 4) * (scale.hi - scale.lo);
    // five long figures have no room beside each other
    const ticks = tiny || Math.max(...[0, 4].map((k) => figure(tickValue(k), tickDigits).length)) > 5 ? [0, 2, 4] : [0, 1, 2, 3, 4];
    return (
        <section class={`legend float${compact ? " compact" : ""}`} aria-label="Legend">
            <header>
                <Choice name="Colour by" bare value={fieldId.value} options={availableFields.value.map((f) => ({ value: f.id, title: f.unit && mode.value === "analyse" ? `${f.title}, ${unitLabel(f.unit, unit)}` : f.title }))} onChange={useField} />
                <span class="range" title={field.judged && "Of panels away from the rim"}>{figure(range[0], rangeDigits)} to {signed && range[1] > 0 ? "+" : ""}{figure(range[1], rangeDigits)}{label && mode.value !== "analyse" ? ` ${label}` : ""}</span>
            </header>
            <svg viewBox={`0 0 ${width} ${chart + bar + 24}`} role="img"
                aria-label={`${field.title}: values from ${number(range[0], field.digits)} to ${number(range[1], field.digits)} ${label}`}
                onPointerDown={(e) => {
                    e.currentTarget.setPointerCapture(e.pointerId);
                    drag.value = [valueAt(e), valueAt(e)];
                }}
                onPointerMove={(e) => drag.value && (drag.value = [drag.value[0], valueAt(e)])}
                onPointerUp={() => {
                    if (drag.value) pick(...drag.value);
                    drag.value = null;
                }}>
                <defs>
                    <linearGradient id={`map-${scale.map.name}`}>
                        {scale.map.stops.map((c, k) => <stop key={c} offset={k / (scale.map.stops.length - 1)} stop-color={c} />)}
                    </linearGradient>
                    <pattern id="beyond" width="5" height="5" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><path d="M0 0v5" stroke="#0b0d10" stroke-width="2" /></pattern>
                </defs>
                {!compact && [...bins].map((n, k) => n > 0 && (
                    <rect key={k} x={(k * width) / 50 + 0.5} width={width / 50 - 1} y={chart - Math.max(1, ((chart - 2) * n) / most)} height={Math.max(1, ((chart - 2) * n) / most)} fill="var(--text3)" />
                ))}
                <rect y={chart + 2} width={width} height={bar} fill={`url(#map-${scale.map.name})`} />
                {limit !== null && <rect x={limit} y={chart + 2} width={width - limit} height={bar} fill="url(#beyond)" />}
                {signed && <path d={`M${width / 2} ${chart && 6}V${chart + bar + 2}`} stroke="var(--text1)" />}
                {Number.isFinite(range[0]) && (
                    <path d={`M${clampX(range[0]) + 0.5} ${chart + bar + 3}v4H${clampX(range[1]) - 0.5}v-4`} fill="none" stroke="var(--text2)" />
                )}
                <Under values={values} at={clampX} chart={chart} />
                {drag.value && <rect x={Math.min(clampX(drag.value[0]), clampX(drag.value[1]))} width={Math.abs(clampX(drag.value[0]) - clampX(drag.value[1]))} y="0" height={chart + bar + 2} fill="var(--accent)" opacity="0.2" />}
                {ticks.map((k) => (
                    <text key={k} x={(k * width) / 4} y={chart + bar + 22} font-size="12" fill="var(--text2)" text-anchor={k === 0 ? "start" : k === 4 ? "end" : "middle"}>
                        {signed && k > 2 ? "+" : ""}{figure(tickValue(k), tickDigits)}
                    </text>
                ))}
            </svg>
            {field.ends && <div class="ends"><span>{field.ends[0]}</span><span>{field.ends[1]}</span></div>}
        </section>
    );
}
