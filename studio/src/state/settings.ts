// What the user chose about the interface: kept by the browser, never in the document.
import { computed, effect, signal } from "@preact/signals";

export type Theme = "system" | "light" | "dark";
export type Navigation = "rhino" | "blender" | "touchpad";
export type Layout = "both" | "flat" | "deployed" | "four";

const stored = <T extends string | number | boolean>(key: string, initial: T) => {
    let value: T = initial;
    try {
        const text = localStorage.getItem(`auxshell.${key}`);
        if (text !== null) value = JSON.parse(text) as T;
    } catch {
        // private windows have no storage: the choice then lasts as long as the page
    }
    const s = signal<T>(value);
    effect(() => {
        try {
            localStorage.setItem(`auxshell.${key}`, JSON.stringify(s.value));
        } catch {
            // as above
        }
    });
    return s;
};

const matching = (query: string) => {
    const list = typeof matchMedia === "undefined" ? null : matchMedia(query);
    const s = signal(list?.matches ?? false);
    list?.addEventListener("change", () => (s.value = list.matches));
    return s;
};

export const theme = stored<Theme>("theme", "system");
export const navigation = stored<Navigation>("navigation", "rhino");
export const layout = stored<Layout>("layout", "both");
/** Share of the flat view when both are shown. */
export const division = stored<number>("division", 0.4);
export const tourSeen = stored<boolean>("tour", false);

const systemDark = matching("(prefers-color-scheme: dark)");
export const reducedMotion = matching("(prefers-reduced-motion: reduce)");
export const darkTheme = computed(() => (theme.value === "system" ? systemDark.value : theme.value === "dark"));
export const narrow = matching("(max-width: 959px)");
/** The inspector is a drawer over the views. */
export const drawer = matching("(max-width: 1179px)");
