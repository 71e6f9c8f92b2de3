// Variants as shells to look at: asked for one by one, each with a small picture.
import { effect, signal } from "@preact/signals";
import { kinds } from "../protocol/frames";
import type { LinkageEvent } from "../protocol/types";
import { Shell } from "../panels/shell";
import { pictureUrl, thumbnail } from "../scene/thumbnail";
import { ask, documentState, onOtherFrame, variants } from "./session";

export interface VariantLook {
    shell: Shell;
    picture: string;
    /** What the server said of it when this was asked: changes ask again. */
    stamp: string;
}
export const looks = signal<Record<string, VariantLook>>({});
const asked = new Map<string, string>();

onOtherFrame((frame, linkage: LinkageEvent | null) => {
    if (frame.kind !== kinds.variant || !linkage?.variant) return;
    const shell = new Shell(linkage, frame);
    const name = linkage.variant;
    void pictureUrl(thumbnail(shell.linkage, shell.simulated ?? shell.deployed, shell.realised, 480, 320)).then((picture) => {
        const before = looks.value[name];
        if (before) URL.revokeObjectURL(before.picture);
        looks.value = { ...looks.value, [name]: { shell, picture, stamp: asked.get(name) ?? "" } };
    });
});

effect(() => {
    for (const v of variants.value) {
        const stamp = JSON.stringify([documentState.value?.id, v.time, v.checks]);
        if (asked.get(v.name) === stamp) continue;
        asked.set(v.name, stamp);
        void ask("variant_look", { name: v.name }).catch(() => asked.delete(v.name));
    }
});
