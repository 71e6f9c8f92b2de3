// What the pointer is over and what is selected. Panels are what one sees selected; hinges are what operators are told, in order
// where there is one.
import { batch, computed, signal } from "@preact/signals";
import { hingeWords, hingesOf } from "../panels/lines";
import { currentShell } from "./session";
import { mode } from "./view";

export const hovered = signal(-1);
export const hoveredHinge = signal(-1);
export const selected = signal<ReadonlySet<number>>(new Set());
/** A line or curve of hinges, when that is what was selected. */
export const selectedHinges = signal<readonly number[]>([]);
/** Panels at the place that a check or a finding leads to. */
export const shown = signal<{ panels: number[]; count: number } | null>(null);

export type SelectMode = "replace" | "add" | "remove";

export function select(panels: Iterable<number>, mode: SelectMode = "replace"): void {
    const next = new Set(mode === "replace" ? [] : selected.value);
    for (const p of panels) {
        if (mode === "remove") next.delete(p);
        else next.add(p);
    }
    selectedHinges.value = [];
    selected.value = next;
}

export function selectHinges(hinges: readonly number[]): void {
    selected.value = new Set();
    selectedHinges.value = hinges;
}

export function clearSelection(): void {
    selected.value = new Set();
    selectedHinges.value = [];
}

export interface Place {
    triangle: number;
    hinge: number;
    other?: number;
}

/** Selects what is at a place (a panel, a pair of panels, or those that meet at a hinge) and brings it into sight. */
export function show({ triangle, hinge, other = -1 }: Place): void {
    const around = currentShell()?.linkage.around;
    const panels = (triangle >= 0 ? [triangle, other] : hinge >= 0 && around ? [around[2 * hinge], around[2 * hinge + 1]] : []).filter((t) => t >= 0);
    if (panels.length === 0) return;
    batch(() => {
        if (mode.value === "variants") mode.value = "design";
        select(panels);
        shown.value = { panels, count: (shown.value?.count ?? 0) + 1 };
    });
}

/** The selection in the words of the operators; empty when nothing is selected. */
export const selectionWords = computed(() => {
    const shell = currentShell();
    if (selectedHinges.value.length) return hingeWords(selectedHinges.value);
    if (!shell || selected.value.size === 0) return "";
    return hingeWords(hingesOf(shell.linkage, selected.value));
});
