// What a theme means for the scene; the interface's own colours are in styles/tokens.css.

export interface Look {
    dark: boolean;
    line: string;
    lineAlpha: number;
    accent: string;
    joint: string;
    sky: string;
    ground: string;
    hemisphere: number;
    key: number;
    fill: number;
    rim: number;
    shadowTint: string;
    shadowAlpha: number;
    gridMinor: string;
    gridMajor: string;
    gridAlpha: [number, number];
    /** Radial ground of a view, from its centre outwards. */
    backdrop: [string, string];
    ink: string;
}

export const light: Look = {
    dark: false, line: "#10141b", lineAlpha: 0.34, accent: "#9a2577", joint: "#3a3f48", sky: "#ffffff", ground: "#cfd2d9",
    hemisphere: 1.55, key: 2.35, fill: 0.7, rim: 0, shadowTint: "#2b3140", shadowAlpha: 0.46, gridMinor: "#c9ced6",
    gridMajor: "#b3bac5", gridAlpha: [0.55, 0.75], backdrop: ["#fafbfc", "#e4e7eb"], ink: "#1a1d23",
};

export const dark: Look = {
    dark: true, line: "#dfe6f0", lineAlpha: 0.26, accent: "#f08fce", joint: "#697180", sky: "#dfe6f2", ground: "#2a2d33",
    hemisphere: 1.45, key: 2.9, fill: 0.8, rim: 1, shadowTint: "#000000", shadowAlpha: 0.85, gridMinor: "#333943",
    gridMajor: "#424955", gridAlpha: [0.55, 0.75], backdrop: ["#30353d", "#1a1d22"], ink: "#e9ebef",
};

/** Unit direction towards the key light, deployed and flat view. */
export const keyFrom = { space: [-0.8, -0.22, 1.15], plane: [-0.35, 0.55, 1.4] } as const;
