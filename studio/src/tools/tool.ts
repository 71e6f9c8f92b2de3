// What a tool is: pointer gestures on the shell that end in one operator.
import { signal } from "@preact/signals";
import type { Overlay, Stage, View } from "../scene/stage";
import type { SkinPoint } from "../scene/skin";
import type { IconName } from "../ui/icons";

export interface Hit {
    stage: Stage;
    view: View;
    /** Within the canvas. */
    x: number;
    y: number;
    on: SkinPoint | null;
    panel: number;
    shift: boolean;
    control: boolean;
    alt: boolean;
    pressure: number;
    double: boolean;
}

export interface Tool {
    id: string;
    title: string;
    icon: IconName;
    shortcut: string;
    cursor: string;
    /** Begins a gesture; false leaves the press alone. */
    down?(hit: Hit): boolean;
    /** While pressed (`dragging`) or hovering. */
    move?(hit: Hit, dragging: boolean): void;
    up?(hit: Hit): void;
    /** Escape, or the pointer was lost. */
    cancel?(): void;
    leave?(): void;
    key?(event: KeyboardEvent): boolean;
    overlay?: Overlay;
    /** How far what is drawn round the cursor reaches, in lengths of the sheet. */
    reach?(): number;
    /** The words beside the cursor. */
    tag?(hit: Hit): { strong: string; rest: string } | null;
}

export const toolId = signal("select");
/** The last place of the pointer on the views; tools and tags read it. */
export const pointer = signal<Hit | null>(null);
