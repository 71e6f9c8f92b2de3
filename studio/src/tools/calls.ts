// Calls of operators with what the user last set: fields of their schemas, kept while the page is open.
import { signal } from "@preact/signals";
import type { FieldSchema, OperatorCall, OperatorSchema } from "../protocol/types";
import { boundsOf } from "../panels/linkage";
import type { Shell } from "../panels/shell";
import { currentShell, operatorNamed } from "../state/session";

const kept = signal<Record<string, Record<string, unknown>>>({});

export type Arguments = Record<string, unknown>;

export function argumentsOf(op: string): Arguments {
    return kept.value[op] ?? {};
}

export function setArgument(op: string, name: string, value: unknown): void {
    const next = { ...kept.value[op] };
    if (value === undefined) delete next[name];
    else next[name] = value;
    kept.value = { ...kept.value, [op]: next };
}

export function resetArguments(op: string): void {
    const { [op]: _, ...rest } = kept.value;
    kept.value = rest;
}

/** The value shown for a field: the user's, or the operator's default. */
export function valueOf(args: Arguments, field: FieldSchema): unknown {
    return field.name in args ? args[field.name] : field.default;
}

/** A number of a tool's operator: the user's, the default, or a start that fits the design when the operator leaves it open. */
export function numberOf(op: string, name: string, otherwise: number): number {
    const field = operatorNamed(op)?.fields.find((f) => f.name === name);
    const value = field ? valueOf(argumentsOf(op), field) : undefined;
    return typeof value === "number" && (value > 0 || name !== "radius") ? value : otherwise;
}

/** The operator as it would be sent; only fields that its schema has. */
export function callOf(schema: OperatorSchema, extra: Arguments): OperatorCall {
    const call: OperatorCall = { op: schema.name };
    const args = argumentsOf(schema.name);
    for (const field of schema.fields) {
        const value = field.name in extra ? extra[field.name] : args[field.name];
        if (value !== undefined && value !== null && value !== "") call[field.name] = value;
    }
    return call;
}

/** Fields that must be given before the operator can be applied. */
export function missing(schema: OperatorSchema, call: OperatorCall): FieldSchema[] {
    return schema.fields.filter((f) => f.required && call[f.name] === undefined);
}

/** Half the larger extent of the sheet: what slider ranges of lengths hang on. */
export function sheetRadius(): number {
    const shell = currentShell();
    if (!shell) return 1;
    if (known.shell !== shell) {
        const { min, max } = boundsOf(shell.sheet);
        known = { shell, radius: Math.max(max[0] - min[0], max[1] - min[1]) / 2 || 1 };
    }
    return known.radius;
}
let known: { shell: Shell | null; radius: number } = { shell: null, radius: 1 };
