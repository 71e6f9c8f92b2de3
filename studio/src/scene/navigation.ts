// Which gesture orbits, pans and zooms, as in the program the user comes from. The left button is always the tool's.
import type { Navigation } from "../state/settings";

export type Gesture = "orbit" | "pan" | "zoom" | null;
interface Press {
    button: number;
    shiftKey: boolean;
    ctrlKey: boolean;
    altKey: boolean;
}

/** What a press of a button begins; null: the tool's. `planar`: a parallel view seen straight on, where Rhino pans. */
export function gestureOf(preset: Navigation, press: Press, planar: boolean): Gesture {
    const { button, shiftKey, ctrlKey, altKey } = press;
    switch (preset) {
        case "rhino":
            if (button !== 2 && button !== 1) return null;
            if (ctrlKey) return "zoom";
            return shiftKey || planar ? "pan" : "orbit";
        case "blender":
            if (button === 2) return "pan";
            if (button !== 1) return null;
            return ctrlKey ? "zoom" : shiftKey || planar ? "pan" : "orbit";
        case "touchpad":
            if (button === 2) return planar ? "pan" : "orbit";
            if (button === 0 && altKey) return shiftKey || planar ? "pan" : "orbit";
            return null;
    }
}

/** What a wheel event does: a touchpad pans with two fingers and zooms with a pinch (which browsers send as Ctrl). */
export function wheelOf(preset: Navigation, event: { ctrlKey: boolean; shiftKey: boolean }, planar: boolean): Gesture {
    if (preset !== "touchpad" || event.ctrlKey) return "zoom";
    return event.shiftKey || planar ? "pan" : "orbit";
}

export const navigationWords: Record<Navigation, { title: string; lines: [string, string][] }> = {
    rhino: { title: "Rhino", lines: [["Orbit", "right drag"], ["Pan", "Shift right drag"], ["Zoom", "wheel"]] },
    blender: { title: "Blender", lines: [["Orbit", "middle drag"], ["Pan", "Shift middle drag"], ["Zoom", "wheel"]] },
    touchpad: { title: "Touchpad", lines: [["Orbit", "two fingers"], ["Pan", "Shift two fingers"], ["Zoom", "pinch"]] },
};
