// A form drawn from an operator's schema: a new operator appears in the studio without a change here.
import type { FieldSchema, OperatorSchema } from "../protocol/types";
import { documentState } from "../state/session";
import { selectionWords } from "../state/selection";
import { type Arguments, sheetRadius, valueOf } from "../tools/calls";
import { Button, CheckBox, Choice, NumberField, NumberRow, Row, Segments } from "./controls";
import { type LengthUnit, count } from "./format";

const capital = (word: string) => /^[mc]?m$/.test(word) ? word : word.charAt(0).toUpperCase() + word.slice(1).replace(/[_-]/g, " ");

export function OperatorForm({ schema, args, onChange, omit = [] }: {
    schema: OperatorSchema; args: Arguments; onChange(name: string, value: unknown): void; omit?: readonly string[];
}) {
    return (
        <div class="form">
            {schema.fields.filter((f) => !omit.includes(f.name)).map((f) => (
                <FieldRow key={f.name} field={f} sized={!schema.starts} value={valueOf(args, f)} onChange={(v) => onChange(f.name, v)} />
            ))}
        </div>
    );
}

/** Bounds that are only there to keep numbers finite are none for people. */
const bound = (v: number | null) => (v !== null && Math.abs(v) < 1e8 ? v : null);

/** `sized`: there is a sheet that lengths can be compared with. */
function sliderOf(field: FieldSchema, value: number | null, sized: boolean): [number, number] | undefined {
    const [lo, hi] = [bound(field.lo), bound(field.hi)];
    if (field.unit === "length" && field.required) return sized ? [0.01 * sheetRadius(), 2 * sheetRadius()] : undefined;
    return lo !== null && hi !== null && hi - lo <= 400 && (field.required || value !== null) ? [lo, hi] : undefined;
}

function FieldRow({ field, value, sized, onChange }: { field: FieldSchema; value: unknown; sized: boolean; onChange(value: unknown): void }) {
    const unit = (documentState.value?.unit ?? "m") as LengthUnit;
    switch (field.kind) {
        case "number":
        case "integer": {
            const v = typeof value === "number" ? value : null;
            return <NumberRow label={field.title} title={field.doc} value={v} unit={field.unit} documentUnit={unit} lo={bound(field.lo)} hi={bound(field.hi)} integer={field.kind === "integer"}
                placeholder={field.required ? "" : "by itself"} slider={sliderOf(field, v, sized)} onChange={onChange} onClear={field.required ? undefined : () => onChange(undefined)} />;
        }
        case "flag":
            return <Row label={field.title} title={field.doc}>{(id) => <CheckBox id={id} value={value === true} onChange={onChange} />}</Row>;
        case "choice": {
            const options = field.choices.map((c) => ({ value: c, title: capital(c) }));
            const words = field.choices.join("").length;
            return (
                <Row label={field.title} title={field.doc}>
                    {(id) => field.choices.length <= 4 && words <= 18
                        ? <Segments fill name={field.title} value={String(value ?? field.choices[0])} options={options} onChange={onChange} />
                        : <Choice id={id} value={String(value ?? field.choices[0])} options={options} onChange={onChange} />}
                </Row>
            );
        }
        case "text":
            return field.name === "hinges" ? <HingesRow field={field} value={String(value ?? "")} onChange={onChange} /> : (
                <Row label={field.title} title={field.doc}>
                    {(id) => <div class="field"><input id={id} type="text" value={String(value ?? "")} onChange={(e) => onChange(e.currentTarget.value || undefined)} /></div>}
                </Row>
            );
        case "vector": {
            const v = Array.isArray(value) ? (value as number[]) : null;
            return (
                <Row label={field.title} title={field.doc}>
                    {() => (
                        <div class="row" role="group" aria-label={field.title}>
                            {Array.from({ length: field.width }, (_, k) => (
                                <div class="grow" key={k}>
                                    <NumberField name={`${field.title}, ${"xyz"[k] ?? k}`} value={v?.[k] ?? null} unit={field.unit === "length" ? "" : field.unit} documentUnit={unit} lo={bound(field.lo)} hi={bound(field.hi)} mark={field.unit === "length" || field.unit === "" ? "xyz"[k] : undefined}
                                        onChange={(n) => onChange(Array.from({ length: field.width }, (_, i) => (i === k ? n : (v?.[i] ?? 0))))} />
                                </div>
                            ))}
                        </div>
                    )}
                </Row>
            );
        }
        case "points": {
            const n = Array.isArray(value) ? value.length : 0;
            return <Row label={field.title} title={field.doc}>{() => <span class="muted">{n ? `${count(n)} points` : "none yet"}</span>}</Row>;
        }
    }
}

/** Which hinges: words of the operators, or what is selected. */
function HingesRow({ field, value, onChange }: { field: FieldSchema; value: string; onChange(value: unknown): void }) {
    const chosen = selectionWords.value;
    const named = documentState.value?.selections ?? [];
    return (
        <>
            <Row label={field.title} title={field.doc}>
                {(id) => (
                    <div class="field">
                        <input id={id} type="text" list="hinge-words" value={value} placeholder={field.required ? "rim, or select hinges" : "all"} onChange={(e) => onChange(e.currentTarget.value || undefined)} />
                        <datalist id="hinge-words">
                            {["all", "rim", ...named.map((s) => `#${s.name}`)].map((w) => <option key={w} value={w} />)}
                        </datalist>
                    </div>
                )}
            </Row>
            {chosen && chosen !== value && (
                <div class="form-row"><span /><div><Button small onClick={() => onChange(chosen)}>Use the selection</Button></div></div>
            )}
        </>
    );
}
