// Icons on a 20 px grid, 1.5 px stroke, drawn in the text's colour. Geometry first: a rim is an open curve with two points.
import type { ComponentChildren, SVGAttributes } from "preact";

const shapes: Record<string, ComponentChildren> = {
    undo: <path d="M7 4 3.5 7.5 7 11M3.5 7.5H12a4.5 4.5 0 0 1 0 9H8" />,
    redo: <path d="M13 4l3.5 3.5L13 11M16.5 7.5H8a4.5 4.5 0 0 0 0 9h4" />,
    moon: <path d="M16.5 11.8A7 7 0 1 1 8.2 3.5a5.6 5.6 0 0 0 8.3 8.3z" />,
    sun: <><circle cx="10" cy="10" r="3.2" /><path d="M10 2v2M10 16v2M2 10h2M16 10h2M4.3 4.3l1.4 1.4M14.3 14.3l1.4 1.4M4.3 15.7l1.4-1.4M14.3 5.7l1.4-1.4" /></>,
    help: <><circle cx="10" cy="10" r="7.2" /><path d="M7.9 7.9a2.1 2.1 0 1 1 3 2c-.6.3-.9.7-.9 1.4M10 13.7v.1" /></>,
    export: <path d="M10 12V3.5M6.8 6.5 10 3.3l3.2 3.2M4 11.5v4A1.5 1.5 0 0 0 5.5 17h9a1.5 1.5 0 0 0 1.5-1.5v-4" />,
    select: <path d="M4.5 3.5l11 5.2-4.7 1.6-1.9 4.7z" />,
    brush: <path d="M16.5 3.5 9 11M6.8 10.8a2.6 2.6 0 0 1 2.4 2.4c0 2-1.5 3.3-3.7 3.3-.9 0-1.7-.2-2-.5.9-.4 1.2-1.1 1.2-2.3a2.5 2.5 0 0 1 2.1-2.9z" />,
    fill: <path d="M9 3.5l6.5 6.5-5.7 5.7a1.2 1.2 0 0 1-1.7 0L3.8 11.4a1.2 1.2 0 0 1 0-1.7zM3.6 10.5h11.5M7 2l3 3M17 13.5s1.2 1.4 1.2 2.3a1.2 1.2 0 0 1-2.4 0c0-.9 1.2-2.3 1.2-2.3z" />,
    gradient: <><path d="M5.7 14.3l8.6-8.6" /><circle cx="4.3" cy="15.7" r="1.9" /><circle cx="15.7" cy="4.3" r="1.9" /></>,
    smooth: <path d="M2.5 8c1.3-1.7 2.5-2 4-.7s2.5 1.3 4 0 2.5-1.3 4 0 2 1.2 3 .4M2.5 13c1.3-1.1 2.5-1.3 4-.4s2.5.8 4 0 2.5-.8 4 0 2 .7 3 .2" />,
    pipette: <path d="M11 6l3 3M12.2 4.8l1.6-1.6a1.7 1.7 0 0 1 2.5 0l.5.5a1.7 1.7 0 0 1 0 2.5l-1.6 1.6zM11.5 6.5l-7 7-.8 2.8 2.8-.8 7-7" />,
    rim: <><path d="M4.7 14.5C6.5 13 5.5 8.5 9 8s4 1.5 6.3-2.5" /><circle cx="4" cy="15.5" r="1.6" /><circle cx="16" cy="4.5" r="1.6" /></>,
    pin: <path d="M7 3h6M8 3v4.5L5.5 10.5h9L12 7.5V3M10 10.5V17" />,
    move: <path d="M10 2.5v15M2.5 10h15M7.8 4.7 10 2.5l2.2 2.2M7.8 15.3 10 17.5l2.2-2.2M4.7 7.8 2.5 10l2.2 2.2M15.3 7.8l2.2 2.2-2.2 2.2" />,
    measure: <path d="M3 13.3 13.3 3 17 6.7 6.7 17zM6 10.3l1.6 1.6M8.4 7.9l2.2 2.2M10.8 5.5l1.6 1.6" />,
    load: <path d="M4 3v8M2.2 9.2 4 11l1.8-1.8M10 3v8M8.2 9.2 10 11l1.8-1.8M16 3v8M14.2 9.2 16 11l1.8-1.8M3 16c4-3 10-3 14 0" />,
    inflate: <path d="M2.5 14.5c2-7 13-7 15 0M10 8.2V2.5M8.3 4.2 10 2.5l1.7 1.7M5 10.3 2.8 6.5M2.7 8.8 2.8 6.5 5 6.9M15 10.3l2.2-3.8M15 6.9l2.2-.4.1 2.3" />,
    layout: <><rect x="3" y="4" width="14" height="12" rx="1.2" /><path d="M3 8h14M8 8v8" /></>,
    table: <><rect x="3" y="4" width="14" height="12" rx="1.2" /><path d="M3 8h14M3 12h14M9 4v12" /></>,
    expand: <path d="M11.5 8.5 16 4M12 4h4v4M8.5 11.5 4 16M4 12v4h4" />,
    shrink: <path d="M16 4l-4.5 4.5M11.5 4.5v4h4M4 16l4.5-4.5M4.5 11.5h4v4" />,
    play: <path d="M7 4.5v11l8.5-5.5z" fill="currentColor" />,
    pause: <path d="M7 4.5v11M13 4.5v11" />,
    step: <path d="M5 4.5v11l7.5-5.5zM15 4.5v11" />,
    settle: <path d="M10 3v9M6.8 9 10 12.2 13.2 9M4 16.5h12" />,
    restart: <path d="M4 10a6 6 0 1 0 2-4.5M4 3.5v3.3h3.3" />,
    tick: <><circle cx="10" cy="10" r="7.2" /><path d="M6.8 10.2l2.2 2.2 4.2-4.6" /></>,
    triangle: <path d="M10 3.2 17.3 16H2.7zM10 8.2v3.6M10 13.9v.1" />,
    crossed: <><rect x="3.8" y="3.2" width="12.4" height="13.6" rx="1" /><path d="M7.3 7.3l5.4 5.4M12.7 7.3l-5.4 5.4" /></>,
    unknown: <><circle cx="10" cy="10" r="7.2" stroke-dasharray="2.5 2.5" /><path d="M10 9.9v.2M6.5 9.9v.2M13.5 9.9v.2" /></>,
    unlinked: <path d="M3 17 17 3M6 14l-2-2 3-3M14 6l2 2-3 3M9 5l2-2M11 15l-2 2" />,
    chevron: <path d="M6 8l4 4 4-4" />,
    close: <path d="M5 5l10 10M15 5 5 15" />,
    file: <path d="M6 2.8h5.5L15 6.3v10.9H6zM11.3 3v3.5H15" />,
    folder: <path d="M3 5.5h5l1.5 2H17v8.5H3z" />,
    circle: <circle cx="10" cy="10" r="6.2" />,
    rectangle: <rect x="3.5" y="5.5" width="13" height="9" rx=".5" />,
    polygon: <path d="M10 3l6 3.5v7L10 17l-6-3.5v-7z" />,
    shell: <path d="M2.5 15c1.5-10 13.5-10 15 0M5 15c1.5-6 8.5-6 10 0M10 7.5V15" />,
    plus: <path d="M10 4v12M4 10h12" />,
    minus: <path d="M4 10h12" />,
    trash: <path d="M4 6h12M8 6V4h4v2M6 6l.7 10.5h6.6L14 6" />,
    edit: <path d="M4 16l.8-3.5L13.5 3.8l2.7 2.7-8.7 8.7zM11.7 5.6l2.7 2.7" />,
    lasso: <path d="M10 4c4 0 7 1.8 7 4.3s-3 4.2-7 4.2-7-1.8-7-4.2S6 4 10 4zM6.2 12c-1.5.8-1.7 2.3-.4 2.9s1.9 1.3 1.2 2.6" />,
    line: <path d="M3.5 16.5 16.5 3.5" />,
    curve: <><path d="M4.5 15C6 9 14 11 15.5 5" /><circle cx="4" cy="16" r="1.4" /><circle cx="16" cy="4" r="1.4" /></>,
    hand: <path d="M6 10V5.5a1.2 1.2 0 0 1 2.4 0V9V4a1.2 1.2 0 0 1 2.4 0v5V5a1.2 1.2 0 0 1 2.4 0v5.5-2a1.2 1.2 0 0 1 2.4 0V12c0 3-1.8 5.5-5 5.5-2.5 0-3.5-1-5-3.5L3.7 11c-.5-1 .7-1.8 1.5-1z" />,
    camera: <><path d="M3 6.5h3.5L8 4.5h4l1.5 2H17v9H3z" /><circle cx="10" cy="10.8" r="2.7" /></>,
    symmetry: <path d="M10 2.5v15M7.5 6 3 14h4.5zM12.5 6l4.5 8h-4.5z" />,
    selection: <rect x="3.5" y="3.5" width="13" height="13" rx="1" stroke-dasharray="2.6 2.2" />,
    site: <path d="M2.5 16.5h15M4.5 16.5v-8l5.5-5 5.5 5v8M8 16.5v-5h4v5" />,
    finish: <path d="M4.5 17V3.5M4.5 4c4-2 6.5 2 11 0v7.5c-4.5 2-7-2-11 0" />,
    show: <><circle cx="10" cy="10" r="5.5" /><path d="M10 2.5v4M10 13.5v4M2.5 10h4M13.5 10h4" /></>,
    copy: <path d="M7 7h9.5v9.5H7zM13 7V3.5H3.5V13H7" />,
    link: <path d="M8 12l4-4M7 9 5 11a2.8 2.8 0 0 0 4 4l2-2M13 11l2-2a2.8 2.8 0 0 0-4-4L9 7" />,
    more: <path d="M4.5 10h.01M10 10h.01M15.5 10h.01" stroke-width="2.4" />,
};

export type IconName = string;

export function Icon({ name, size = 20, ...rest }: { name: IconName; size?: number } & SVGAttributes<SVGSVGElement>) {
    return (
        <svg class="icon" viewBox="0 0 20 20" width={size} height={size} fill="none" stroke="currentColor" stroke-width="1.5" stroke-linecap="round"
            stroke-linejoin="round" aria-hidden="true" focusable="false" {...rest}>
            {shapes[name] ?? shapes.unknown}
        </svg>
    );
}

export function Mark() {
    return (
        <svg viewBox="0 0 20 20" width="20" height="20" aria-hidden="true" focusable="false">
            <path d="M5.4 2.5h9.2L10 10.2z" fill="currentColor" />
            <path d="M.6 11h8.2l-4.1 6.8zM11.2 11h8.2l-4.1 6.8z" fill="currentColor" opacity=".5" />
        </svg>
    );
}

/** The icon of an operator: its own, or its group's. */
export function operatorIcon(op: string, group: string): IconName {
    const own: Record<string, string> = { paint: "brush", fill: "fill", gradient: "gradient", smooth: "smooth", gravity: "load", inflation: "inflate", inflate: "inflate", expand: "inflate" };
    const groups: Record<string, string> = { start: "rectangle", scale: "brush", boundary: "rim", dynamics: "load", constraint: "pin", selection: "selection", site: "site", finish: "finish" };
    return own[op] ?? groups[group] ?? "unknown";
}
