// The first section of the inspector: what the active tool can be told.
import { signal, useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import type { FieldSchema, OperatorSchema } from "../protocol/types";
import { apply, command, currentShell, documentState, operatorNamed, operators, revision, status } from "../state/session";
import { select, selectionWords, selected, selectedHinges } from "../state/selection";
import { announcement } from "../state/commands";
import { argumentsOf, callOf, missing, setArgument, sheetRadius } from "../tools/calls";
import { brushMode, brushRadius, brushStrength, brushValue } from "../tools/brush";
import { measureCount, measured } from "../tools/measure";
import { constraintOp } from "../tools/pin";
import { fillCall, fillValue, gradientKind, smoothAmount, smoothCall } from "../tools/paintbox";
import { activePoint, applyRim, boundaryOperators, pointsFromRim, previewRim, rimArguments, rimCall, rimOp, rimPoints, rimSchema, setRimPoints, snapping } from "../tools/rim";
import { pointsField } from "../tools/rimhandles";
import { selectKind, type SelectKind } from "../tools/select";
import { toolId } from "../tools/tool";
import { Button, CheckBox, Choice, NumberField, NumberRow, Row, Section, Segments } from "./controls";
import { type LengthUnit, length, plural } from "./format";
import { OperatorForm } from "./operatorform";

const unit = () => (documentState.value?.unit ?? "m") as LengthUnit;
const set = (op: string) => (name: string, value: unknown) => setArgument(op, name, value);

const lackingWords = (fields: readonly FieldSchema[]) => `Give ${fields.map((f) => f.title.toLowerCase()).join(", ")}`;

/** Form of one operator with a button that applies it. */
export function OperatorPanel({ schema, label = "Apply", extra = {} }: { schema: OperatorSchema; label?: string; extra?: Record<string, unknown> }) {
    const call = callOf(schema, extra);
    const lacking = missing(schema, call);
    const confined = schema.fields.some((f) => f.name === "hinges") && selectionWords.value && !argumentsOf(schema.name).hinges;
    return (
        <>
            <OperatorForm schema={schema} args={{ ...extra, ...argumentsOf(schema.name) }} onChange={set(schema.name)} />
            <div class="row" style={{ marginTop: "8px" }}>
                <Button small disabled={lacking.length > 0 && !(confined && lacking.length === 1)} title={schema.doc}
                    onClick={() => void apply(confined ? { ...call, hinges: selectionWords.value } : call)}>{label}</Button>
                {confined ? <span class="small muted">to the selection</span> : lacking.length > 0 ? <span class="small muted">{lackingWords(lacking)}</span> : null}
            </div>
        </>
    );
}

export function ToolPanel() {
    switch (toolId.value) {
        case "brush": return <BrushPanel />;
        case "fill": return <SimplePanel title="Fill" op="fill" call={fillCall} label="Fill" values={{ value: fillValue() }} />;
        case "smooth": return <SimplePanel title="Smooth" op="smooth" call={smoothCall} label="Smooth" values={{ amount: smoothAmount() }} />;
        case "gradient": return <GradientPanel />;
        case "pipette": return <Section title="Eyedropper" aside="Scale factor"><p class="muted small">Click a panel: the brush and the fill take its scale factor.</p></Section>;
        case "rim": return <RimPanel />;
        case "pin": return <PinPanel />;
        case "dynamics": return <DynamicsPanel />;
        case "measure": return <MeasurePanel />;
        default: return <SelectPanel />;
    }
}

function Missing({ title }: { title: string }) {
    return <Section title={title}><p class="muted small">This version of the program has no operator for it.</p></Section>;
}

function BrushPanel() {
    const schema = operatorNamed("paint");
    if (!schema) return <Missing title="Brush" />;
    const mode = brushMode();
    const args: Record<string, unknown> = { ...argumentsOf("paint"), radius: brushRadius(), strength: brushStrength(), value: brushValue(), mode };
    const middle = schema.fields.filter((f) => ["copies", "mirror", "mirror_angle", "centre", "along", "hinges"].includes(f.name));
    const fold = Number(argumentsOf("paint").copies ?? 1);
    const mirrored = argumentsOf("paint").mirror === true;
    const symmetry = `${fold}${mirrored ? "m" : ""}`;
    const known = ["1", "1m", "2", "3", "3m", "6", "6m"];
    const falloff = schema.fields.find((f) => f.name === "falloff");
    return (
        <Section title="Brush" aside="Scale factor">
            <div class="form">
                {mode !== "smooth" && <NumberRow label={mode === "set" ? "Value λ" : "Amount λ"} value={brushValue()} documentUnit={unit()} lo={mode === "set" ? 1 : 0} hi={mode === "set" ? 2 : 1} slider={mode === "set" ? [1, 2] : [0, 0.5]} onChange={(v) => setArgument("paint", "value", v)} />}
                <NumberRow label="Radius" unit="length" value={brushRadius()} documentUnit={unit()} lo={1e-6} slider={[0.02 * sheetRadius(), sheetRadius()]} onChange={(v) => setArgument("paint", "radius", Number(v.toPrecision(3)))} />
                <NumberRow label="Strength" unit="%" value={100 * brushStrength()} documentUnit={unit()} lo={1} hi={100} slider={[1, 100]} onChange={(v) => setArgument("paint", "strength", v / 100)} />
                {falloff && <Row label="Falloff" title={falloff.doc}>{(id) => <Choice id={id} value={String(args.falloff ?? falloff.default)} options={falloff.choices.map((c) => ({ value: c, title: c.charAt(0).toUpperCase() + c.slice(1) }))} onChange={(v) => setArgument("paint", "falloff", v)} />}</Row>}
                <Row label="Mode" short>{() => <Segments fill name="Mode" value={mode} options={[{ value: "set", title: "Set" }, { value: "add", title: "Add" }, { value: "subtract", title: "Lower" }, { value: "smooth", title: "Smooth" }]}
                    onChange={(m) => {
                        setArgument("paint", "mode", m);
                        setArgument("paint", "value", undefined);
                    }} />}</Row>
                {middle.length > 0 && (
                    <Row label="Symmetry">{(id) => <Choice id={id} value={known.includes(symmetry) ? symmetry : "own"} options={[{ value: "1", title: "None" }, { value: "1m", title: "Mirrored" }, { value: "2", title: "2-fold" }, { value: "3", title: "3-fold" }, { value: "3m", title: "3-fold, mirrored" }, { value: "6", title: "6-fold" }, { value: "6m", title: "6-fold, mirrored" }, ...(known.includes(symmetry) ? [] : [{ value: "own", title: `${fold}-fold` }])]}
                        onChange={(v) => {
                            setArgument("paint", "copies", parseInt(v, 10) || 1);
                            setArgument("paint", "mirror", v.endsWith("m") || undefined);
                        }} />}</Row>
                )}
            </div>
            {middle.length > 0 && <More><OperatorForm schema={{ ...schema, fields: middle }} args={argumentsOf("paint")} onChange={set("paint")} /></More>}
        </Section>
    );
}

function More({ children }: { children: ComponentChildren }) {
    const open = useSignal(false);
    return (
        <>
            <button type="button" class="link" aria-expanded={open.value} onClick={() => (open.value = !open.value)}>{open.value ? "Less" : "More"}</button>
            {open.value && children}
        </>
    );
}

function SimplePanel({ title, op, call, label, values }: { title: string; op: string; call: () => ReturnType<typeof fillCall>; label: string; values: Record<string, unknown> }) {
    const schema = operatorNamed(op);
    if (!schema) return <Missing title={title} />;
    return (
        <Section title={title} aside={selectionWords.value ? "The selection" : "Everything"}>
            <OperatorForm schema={schema} args={{ ...values, ...argumentsOf(op) }} onChange={set(op)} />
            <div class="row" style={{ marginTop: "8px" }}>
                <Button small onClick={() => {
                    const operator = call();
                    if (operator) void apply(operator);
                }}>{label}</Button>
                <span class="small muted">or click on a view</span>
            </div>
        </Section>
    );
}

function GradientPanel() {
    const radial = gradientKind.value === "radial";
    const schema = operatorNamed(radial ? "gradient_radial" : "gradient_linear");
    return (
        <Section title="Gradient" aside="Scale factor">
            <div class="form">
                <Row label="Kind">{() => <Segments fill name="Kind" value={gradientKind.value} options={[{ value: "linear", title: "Linear" }, { value: "radial", title: "Radial" }]} onChange={(k) => (gradientKind.value = k)} />}</Row>
            </div>
            {schema ? <OperatorPanel schema={schema} extra={radial ? { inner: 1.6, outer: 1.2, ...argumentsOf(schema.name) } : { from_value: 1.2, to_value: 1.6, ...argumentsOf(schema.name) }} /> : null}
            <p class="small muted" style={{ marginTop: "8px" }}>Drag on a view: from the first place to the last.</p>
        </Section>
    );
}

const selectKinds: { value: SelectKind; title: string }[] = [
    { value: "click", title: "Panels" }, { value: "line", title: "Line" }, { value: "curve", title: "Curve" },
];

const selectHints: Record<SelectKind, string> = {
    click: "Click a panel; drag a loop round several. Shift adds, Ctrl takes away.",
    line: "Click near a hinge: all hinges of the kagome line through it are selected.",
    curve: "Click two hinges: the shortest way between them is selected.",
};

function SelectionFacts() {
    revision.value;
    const n = selected.value.size;
    const h = selectedHinges.value.length;
    const name = useSignal("");
    const shell = currentShell();
    const schema = operatorNamed("select");
    if (!n && !h) return <p class="small muted">{selectHints[selectKind.value]}</p>;
    let [lo, hi] = [Infinity, -Infinity];
    for (const t of selected.value) {
        lo = Math.min(lo, shell?.realised[t] ?? NaN);
        hi = Math.max(hi, shell?.realised[t] ?? NaN);
    }
    return (
        <>
            <p class="small muted">{h ? plural(h, "hinge") : plural(n, "panel")}{h === 1 && selectKind.value === "curve" ? ". Click where the way ends." : ""}{n ? `, λ ${lo.toFixed(2)} to ${hi.toFixed(2)}` : ""}</p>
            {schema && (
                <form class="row" style={{ marginTop: "8px" }} onSubmit={(e) => {
                    e.preventDefault();
                    if (name.value) void apply({ op: "select", name: name.value, hinges: selectionWords.value }).then((ok) => ok && (announcement.value = "The selection is kept."));
                }}>
                    <div class="field grow"><input type="text" aria-label="Name of the selection" placeholder="Name" value={name.value} onInput={(e) => (name.value = e.currentTarget.value)} /></div>
                    <Button small type="submit" disabled={!name.value}>Keep</Button>
                </form>
            )}
        </>
    );
}

function SelectPanel() {
    return (
        <Section title="Select" aside={<button type="button" class="link" aria-expanded={byName.value} onClick={() => (byName.value = !byName.value)}>By name</button>}>
            <div class="form">
                <Row label="What">{() => <Segments fill name="What to select" value={selectKind.value} options={selectKinds} onChange={(k) => (selectKind.value = k)} />}</Row>
            </div>
            {byName.value && <ByName />}
            <SelectionFacts />
        </Section>
    );
}

const byName = signal(false);

/** Panels by name, for hands that use no pointer. */
function ByName() {
    const wrong = useSignal("");
    return (
        <form class="row" style={{ margin: "4px 0" }} onSubmit={(e) => {
            e.preventDefault();
            const words = String(new FormData(e.currentTarget as HTMLFormElement).get("names")).split(/[\s,]+/).filter(Boolean);
            const shell = currentShell();
            const panels = words.map((w) => shell?.names.indexOf(w.toUpperCase()) ?? -1);
            wrong.value = panels.includes(-1) ? `There is no panel ${words[panels.indexOf(-1)]}.` : "";
            if (!wrong.value) select(panels);
        }}>
            <div class="grow">
                <div class={`field${wrong.value ? " wrong" : ""}`}><input name="names" type="text" aria-label="Names of panels" placeholder="C14, C15" aria-invalid={wrong.value !== ""} /></div>
                {wrong.value && <div class="problem" role="alert">{wrong.value}</div>}
            </div>
            <Button small type="submit">Select</Button>
        </form>
    );
}

function RimPanel() {
    const all = boundaryOperators();
    const schema = rimSchema();
    revision.value;
    if (!schema) return <Missing title="Boundary" />;
    const field = pointsField(schema);
    const points = rimPoints();
    const k = activePoint.value;
    const args = rimArguments(schema);
    const call = rimCall();
    const lacking = call ? missing(schema, call) : [];
    return (
        <Section title="Boundary" aside={documentState.value?.rim.length ? plural(documentState.value.rim.length, "part") : "Free"}>
            <div class="form">
                <Row label="Rim">{(id) => <Choice id={id} value={schema.name} options={all.map((o) => ({ value: o.name, title: o.title, group: /_point_/.test(o.name) ? "Control points" : undefined }))} onChange={(v) => (rimOp.value = v)} />}</Row>
            </div>
            <OperatorForm schema={schema} args={args} omit={field ? [field.name] : []} onChange={(name, value) => {
                setArgument(schema.name, name, value);
            }} />
            {schema.fields.some((f) => f.name === "radius") && schema.fields.some((f) => f.name === "centre") && (
                <div class="row" style={{ marginTop: "4px" }}><Button small onClick={() => fitCircle(schema.name)}>Fit to the rim</Button></div>
            )}
            {field && (
                <>
                    <div class="form">
                        <Row label="Points">{() => (
                            <div class="row wrap">
                                {[4, 6, 8, 12].map((n) => <Button key={n} small onClick={() => (setRimPoints(pointsFromRim(n)), (activePoint.value = -1))} aria-label={`${n} points from the rim`}>{n}</Button>)}
                            </div>
                        )}</Row>
                        {points.length > 0 && <Row label="Point">{(id) => <Choice id={id} value={String(k)} options={[{ value: "-1", title: "None" }, ...points.map((_, i) => ({ value: String(i), title: `${i + 1} of ${points.length}` }))]} onChange={(v) => (activePoint.value = Number(v))} />}</Row>}
                        {k >= 0 && points[k] && (
                            <Row label="Place">{() => (
                                <div class="row" role="group" aria-label="Place of the point">
                                    {points[k].map((v, i) => (
                                        <div class="grow" key={i}><NumberField name={"XYZ"[i]} mark={"xyz"[i]} value={v} unit="" documentUnit={unit()} onChange={(n) => {
                                            setRimPoints(points.map((p, j) => (j === k ? (p.map((x, c) => (c === i ? n : x)) as [number, number, number]) : p)));
                                            previewRim();
                                        }} /></div>
                                    ))}
                                </div>
                            )}</Row>
                        )}
                        <Row label="Snap">{(id) => <CheckBox id={id} value={snapping.value} title="to grid, hinges, points" onChange={(v) => (snapping.value = v)} />}</Row>
                    </div>
                    {points.length === 0 && <p class="empty" style={{ marginTop: "8px" }}>No points yet. Take some from the rim as it is, then drag them on the deployed view.</p>}
                </>
            )}
            <div class="row" style={{ marginTop: "8px" }}>
                <Button small disabled={lacking.length > 0} title={schema.doc} onClick={() => void applyRim()}>Apply</Button>
                {lacking.length > 0 && <span class="small muted">{lackingWords(lacking)}</span>}
            </div>
        </Section>
    );
}

/** Mean circle of the rim in the deployed state, level. */
function fitCircle(op: string): void {
    const shell = currentShell();
    if (!shell) return;
    const points = pointsFromRim(200);
    const centre = [0, 1, 2].map((k) => points.reduce((s, p) => s + p[k], 0) / points.length);
    const radius = points.reduce((s, p) => s + Math.hypot(p[0] - centre[0], p[1] - centre[1]), 0) / points.length;
    setArgument(op, "radius", Number(radius.toPrecision(3)));
    setArgument(op, "centre", centre.map((v) => Number(v.toFixed(3))));
}

function PinPanel() {
    const all = operators.value.filter((o) => o.group === "constraint");
    const schema = operatorNamed(constraintOp.value) ?? all.find((o) => o.name !== "release");
    if (!schema) return <Missing title="Constrain" />;
    return (
        <Section title="Constrain" aside={selectionWords.value ? "The selection" : "Select hinges"}>
            <div class="form">
                <Row label="Select">{() => <Segments fill name="What to select" value={selectKind.value} options={selectKinds} onChange={(k) => (selectKind.value = k)} />}</Row>
                <Row label="Hold">{(id) => <Choice id={id} value={schema.name} options={all.map((o) => ({ value: o.name, title: o.title }))} onChange={(v) => (constraintOp.value = v)} />}</Row>
            </div>
            <OperatorPanel schema={schema} label="Hold" />
        </Section>
    );
}

function DynamicsPanel() {
    const all = operators.value.filter((o) => o.group === "dynamics");
    const op = dynamicsOp.value;
    const schema = operatorNamed(op) ?? all[0];
    const running = status.value?.solver === "playing";
    return (
        <Section title="Dynamics" aside={status.value ? `${status.value.iterations} steps` : undefined}>
            <div class="row wrap">
                <Button small icon={running ? "pause" : "play"} onClick={() => void command(running ? "pause" : "play")}>{running ? "Pause" : "Run"}</Button>
                <Button small icon="step" onClick={() => void command("step", { iterations: 1 })}>Step</Button>
                <Button small icon="settle" onClick={() => void command("settle")}>Settle</Button>
                <Button small icon="restart" onClick={() => void command("restart")} title="Lays it flat; Run then opens it, slowly enough to be watched">From flat</Button>
            </div>
            <p class="small muted" style={{ margin: "8px 0" }}>Drag a hinge on the deployed view: the shell follows while the solver runs.</p>
            {schema && (
                <>
                    <div class="form">
                        <Row label="By">{(id) => <Choice id={id} value={schema.name} options={all.map((o) => ({ value: o.name, title: o.title }))} onChange={(v) => (dynamicsOp.value = v)} />}</Row>
                    </div>
                    <OperatorPanel schema={schema} />
                </>
            )}
        </Section>
    );
}
const dynamicsOp = signal("gravity");

function MeasurePanel() {
    revision.value;
    const m = measured();
    const u = unit();
    return (
        <Section title="Measure" aside={m ? length(m.straight, u) : undefined}>
            {m ? (
                <table class="figures">
                    <tbody>
                        <tr><th scope="row">Straight</th><td>{length(m.straight, u)}</td></tr>
                        <tr><th scope="row">Along the panels</th><td>{length(m.along, u)}</td></tr>
                        <tr><th scope="row">X, Y, Z</th><td>{length(m.dx, u)}, {length(m.dy, u)}, {length(m.dz, u)}</td></tr>
                    </tbody>
                </table>
            ) : <p class="small muted">{measureCount() ? "Click the second place." : "Click two places of the shell."}</p>}
        </Section>
    );
}
