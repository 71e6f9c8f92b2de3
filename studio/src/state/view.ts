// What is open and how the shell is looked at: nothing here is part of the document.
import { computed, signal } from "@preact/signals";
import { type Scale, histogram, paint } from "../panels/colour";
import { type Field, fieldById, fields } from "../panels/fields";
import { rangeOf } from "../panels/measures";
import type { Stage } from "../scene/stage";
import { currentShell, frames, report, revision, topology } from "./session";

export type Page = "start" | "work";
export type Mode = "design" | "analyse" | "variants";
export type DialogName = "export" | "open" | "save" | "shortcuts" | "table" | "surface" | "about";

export const page = signal<Page>("work");
export const mode = signal<Mode>("design");
export const dialog = signal<DialogName | null>(null);
export const drawerOpen = signal(false);
export const tourStep = signal(-1);
export const stage = signal<Stage | null>(null);

const designField = signal("lambda");
const analyseField = signal("force");
export const fieldId = computed(() => {
    const wanted = mode.value === "analyse" ? analyseField.value : designField.value;
    revision.value;
    const shell = currentShell();
    return shell && !fieldById(wanted).available(shell) ? (mode.value === "analyse" ? "residual" : "lambda") : wanted;
});
export function useField(id: string): void {
    (mode.value === "analyse" ? analyseField : designField).value = id;
}

export interface FieldView {
    field: Field;
    values: Float32Array;
    scale: Scale;
    range: [number, number];
    bins: Uint32Array;
}

/** The field as it was read last: values, scale and histogram. */
export const fieldView = computed<FieldView | null>(() => {
    revision.value;
    topology.value;
    const shell = currentShell();
    if (!shell || shell.realised.length === 0) return null;
    const field = fieldById(fieldId.value);
    const values = field.values(shell);
    const scale = field.scale(values, shell);
    return { field, values, scale, range: rangeOf(values, field.judged?.(shell)), bins: histogram(values, scale.lo, scale.hi, 50) };
});

/** The panels' colours as they are now, on the scale as it was read last: 4 bytes each. */
export const tints = computed<Uint8Array | null>(() => {
    frames.value;
    const shell = currentShell();
    const view = fieldView.value;
    if (!shell || !view?.field.available(shell)) return null;
    const out = new Uint8Array(4 * shell.linkage.panels);
    paint(view.scale, view.field.values(shell), out);
    return out;
});

export const availableFields = computed(() => {
    revision.value;
    const shell = currentShell();
    return fields.filter((f) => shell !== null && f.available(shell));
});

/** Scale factors above this are hatched: the limit of the check, or the geometric one. */
export const scaleLimit = computed(() => {
    const limit = report.value?.findings.find((f) => f.kind === "scale" && f.limit !== null && f.limit > 1)?.limit;
    return limit ?? report.value?.figures.find((f) => f.key === "scale_max" || f.key === "lambda_max")?.limit ?? 2;
});
