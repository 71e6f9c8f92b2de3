// The messages of docs/protocol.md, as far as they are JSON.

export interface Problem {
    status: 1 | 2 | 3 | 4 | 130;
    word: "failed" | "usage" | "bad_input" | "cannot_realise" | "cancelled";
    message: string;
}

export type Answer = { re: number; ok: true; [result: string]: unknown } | { re: number; ok: false; error: Problem };

export type Severity = "pass" | "note" | "warning" | "failure" | "unknown";
export type Unit = "mm" | "cm" | "m";
export type Point = [number, number, number];

export interface FieldSchema {
    name: string;
    title: string;
    doc: string;
    unit: string;
    kind: "number" | "integer" | "flag" | "choice" | "text" | "vector" | "points";
    required: boolean;
    default: number | boolean | string | number[] | null;
    lo: number | null;
    hi: number | null;
    width: number;
    choices: string[];
}

export interface OperatorSchema {
    name: string;
    title: string;
    doc: string;
    reference: string;
    group: "start" | "scale" | "boundary" | "dynamics" | "constraint" | "selection" | "site" | "finish";
    starts: boolean;
    settles: boolean;
    fields: FieldSchema[];
}

export interface Exporter {
    ending: string;
    name: string;
    doc: string;
    states: StateName[];
    default_state: StateName;
}
export type StateName = "flat" | "deployed" | "simulated";

export interface Named {
    name: string;
    doc: string;
}
/** What cut files can be made for; lengths in mm. */
export interface Making {
    joints: (Named & { parameters: { name: string; unit: string; doc: string; lo: number; hi: number; default: number | null }[] })[];
    materials: (Named & { thickness: number; kerf: number })[];
    sheets: { name: string; width: number; height: number }[];
    profiles: Named[];
}
/** Of a cut file: metres, seconds, kilograms, a share of the sheets. */
export interface Plan {
    sheets: number;
    cut_length: number;
    seconds: number;
    mass: number;
    utilisation: number;
    clashes: number;
    /** The first of them: millimetres, and for those between flat and open the share of the way. */
    collisions: { panels: [number, number]; hinge: number; when: "flat" | "deployed" | "simulated" | "between" | "turning"; opening: number | null; overlap: number | null }[];
    seams: number;
    parts: { name: string; count: number }[];
    /** Neighbours folded onto each other when open, and the panels of the first. */
    folds: number;
    fold: [number, number] | null;
    /** What speaks against the joint here; empty: nothing. */
    doubt: string;
}

export interface Hello {
    event: "hello";
    protocol: number;
    version: string;
    client: number;
    folder: string;
    start: string;
    operators: OperatorSchema[];
    exporters: Exporter[];
    making: Making;
    examples: { name: string; title: string; doc: string }[];
    recovered: { name: string; title?: string; time: number }[];
    limits: { message: number; upload: number; triangles: number };
}

export type OperatorCall = { op: string; [field: string]: unknown };

export interface Step {
    operator: OperatorCall;
    words: string;
    type: string;
    state: "applied" | "ahead" | "failed";
    problem?: string;
}

export interface Curve {
    kind: "line" | "circle" | "ellipse" | "polyline" | "spline";
    closed: boolean;
    points: Point[];
}

export interface Held {
    name: string;
    kind: string;
    hinges: number[];
    weight: number | null;
    residual: number;
    /** The hinge that is furthest off. */
    hinge: number;
    multiplier: number;
    curve?: Curve;
}

export interface DocumentEvent {
    event: "document";
    id: string;
    name: string;
    path: string | null;
    read_only: string | null;
    autosaved: number | null;
    unit: Unit;
    at: number;
    steps: Step[];
    undo: string | null;
    redo: string | null;
    selections: { name: string; hinges: number[] }[];
    constraints: Held[];
    rim: Held[];
    underlays: { name: string; clearance: number }[];
    load: { kind: "none" | "gravity" | "inflation"; direction: Point; pressure: number; density: number };
}

export interface LinkageEvent {
    event: "linkage";
    document: string;
    variant?: string;
    topology: number;
    triangles: number;
    hinges: number;
    holes: number;
    openings: number;
    origin: Point;
    flat_origin: [number, number];
    spacing: number;
    unit: Unit;
}

export interface StatusEvent {
    event: "status";
    solver: "idle" | "preview" | "playing" | "settling" | "working";
    state: "unsettled" | "settled" | "exact" | "edited";
    iterations: number;
    milliseconds: number;
    residual: number | null;
    hand: number;
    words: string;
}

export interface Check {
    key: "scale" | "mouth" | "overlap" | "curvature" | "rim" | "match" | "force";
    title: string;
    answer: string;
    limit: string;
    value: number | null;
    severity: Severity;
    triangle: number;
    hinge: number;
    /** The second panel of a pair. */
    other: number;
}

export interface Finding {
    severity: Severity;
    kind: string;
    text: string;
    value: number | null;
    limit: number | null;
    triangle: number;
    hinge: number;
    other: number;
}

export interface Figure {
    key: string;
    label: string;
    unit: string;
    group: string;
    value: number | boolean | number[] | null;
    limit: number | null;
    holds: boolean;
}

export interface ReportEvent {
    event: "report";
    revision: number;
    verdict: { word: string; severity: Severity };
    checks: Check[];
    findings: Finding[];
    held: { name: string; kind: string; count: number; residual: number; hinge: number; multiplier: number }[];
    figures: Figure[];
}

export interface ProgressEvent {
    event: "progress";
    re: number;
    job: string;
    stage: string;
    fraction: number;
    residual: number | null;
    done: boolean;
}

export interface ProblemEvent {
    event: "problem";
    error: Problem;
    do?: string;
    serial?: number;
}

export interface VariantsEvent {
    event: "variants";
    variants: { name: string; triangles: number; steps: number; exact: boolean; time: number; checks: Check[]; current: boolean }[];
}

export type ServerEvent =
    | Hello
    | DocumentEvent
    | LinkageEvent
    | StatusEvent
    | ReportEvent
    | ProgressEvent
    | ProblemEvent
    | VariantsEvent
    | { event: "closed"; document: string; message: string }
    | { event: "bye"; message: string };

export interface Screen {
    verdict: "deployable" | "deployable_projected" | "not_deployable";
    words: string;
    by_inflation: boolean;
    by_gravity: boolean;
    name: string;
    vertices: number;
    faces: number;
    bounds: [Point, Point];
    area: number;
    diagonal: number;
    rim_length: number;
    repairs: {
        welded_vertices: number;
        degenerate_faces: number;
        duplicate_faces: number;
        unused_vertices: number;
        flipped_faces: number;
        turned_outward: boolean;
    };
    curvature: { min: number; q01: number; median: number; q95: number; nonpositive_share: number; worst: Point };
    height_field: boolean;
    lies_on_side: boolean; // it would be one with y up
    likely_unit: "mm" | "cm" | "m";
    scale: { ratio: number | null; lo: number | null; hi: number | null; fits: boolean };
    projection: { moved_area_share: number; largest_move: number; steps: number } | null;
    pictures: { curvature: string; scale: string | null };
    origin: Point;
}

export interface ExportedFile {
    name: string;
    url: string;
    bytes: number;
}
export interface FolderEntry {
    name: string;
    bytes: number;
    time: number;
    folder: boolean;
}
