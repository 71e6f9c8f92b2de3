// What cut files are made for: joint, material, sheet and machine, drawn from what the server says it knows, and what comes of it.
import type { Making, Plan } from "../protocol/types";
import { show } from "../state/selection";
import { currentShell, hello } from "../state/session";
import { dialog } from "../state/view";
import { Choice, NumberRow, Row } from "./controls";
import { count, number, plural } from "./format";

export interface CutOptions {
    joint: string;
    /** Of the joint: only what differs from its defaults. */
    parameters: Record<string, number>;
    material: string;
    sheet: string;
    profile: string;
    kerf: number | null;
    margin: number | null;
    spacing: number | null;
}
export const cutDefaults: CutOptions = { joint: "none", parameters: {}, material: "card-0.5", sheet: "", profile: "generic", kerf: null, margin: null, spacing: null };

/** The options as the command `export` takes them. */
export function cutWords(o: CutOptions): Record<string, string | number> {
    const parameters = Object.entries(o.parameters).map(([name, value]) => `${name}=${value}`).join(",");
    const words: Record<string, string | number> = { joint: parameters ? `${o.joint}:${parameters}` : o.joint, material: o.material, profile: o.profile };
    if (o.sheet) words.sheet = o.sheet;
    for (const name of ["kerf", "margin", "spacing"] as const) if (o[name] !== null) words[name] = o[name];
    return words;
}

const capital = (word: string) => word.charAt(0).toUpperCase() + word.slice(1);
/** "living-hinge" is "Living hinge", "plywood-3" is "Plywood 3". */
const title = (name: string) => capital(name).replaceAll("-", " ");
const whenWords = { flat: "Flat", deployed: "Deployed", simulated: "Simulated", between: "On the way", turning: "Turning" };
const none: Making = { joints: [], materials: [], sheets: [], profiles: [] };

export function CutSettings({ value, onChange }: { value: CutOptions; onChange(value: CutOptions): void }) {
    const making = hello.value?.making ?? none;
    const set = (part: Partial<CutOptions>) => onChange({ ...value, ...part });
    const joint = making.joints.find((j) => j.name === value.joint);
    const material = making.materials.find((m) => m.name === value.material);
    const length = (name: "kerf" | "margin" | "spacing", label: string, doc: string, hi: number, placeholder: string) => (
        <NumberRow label={label} title={doc} value={value[name]} unit="mm" documentUnit="mm" lo={0} hi={hi} placeholder={placeholder} onChange={(v) => set({ [name]: v })} onClear={() => set({ [name]: null })} />
    );
    return (
        <div class="form">
            <Row label="Joint" title={joint?.doc}>{(id) => <Choice id={id} value={value.joint} options={making.joints.map((j) => ({ value: j.name, title: title(j.name) }))} onChange={(name) => set({ joint: name, parameters: {} })} />}</Row>
            {joint?.parameters.map((p) => (
                <NumberRow key={`${joint.name} ${p.name}`} label={capital(p.name)} title={capital(p.doc)} value={value.parameters[p.name] ?? p.default} unit={p.unit} documentUnit="mm" lo={p.lo} hi={p.hi}
                    onChange={(v) => set({ parameters: { ...value.parameters, [p.name]: v } })} />
            ))}
            <Row label="Material" title={material?.doc}>{(id) => <Choice id={id} value={value.material} options={making.materials.map((m) => ({ value: m.name, title: `${title(m.name)} mm` }))} onChange={(name) => set({ material: name })} />}</Row>
            <Row label="Sheet">{(id) => <Choice id={id} value={value.sheet} options={[{ value: "", title: "One for all" }, ...making.sheets.map((s) => ({ value: s.name, title: /^\d/.test(s.name) ? `${s.width} × ${s.height} mm` : `${s.name}, ${s.width} × ${s.height} mm` }))]} onChange={(sheet) => set({ sheet })} />}</Row>
            <Row label="Machine" title={making.profiles.find((p) => p.name === value.profile)?.doc}>{(id) => <Choice id={id} value={value.profile} options={making.profiles.map((p) => ({ value: p.name, title: title(p.name) }))} onChange={(profile) => set({ profile })} />}</Row>
            {length("kerf", "Kerf", "Full width of the cut", 10, "0")}
            {length("margin", "Margin", "Left free at the edge of a sheet", 1000, "by itself")}
            {length("spacing", "Spacing", "Between parts on a sheet", 1000, "by itself")}
        </div>
    );
}

/** Two panels by name; leads to them. */
function PanelsLink({ panels, hinge }: { panels: [number, number]; hinge: number }) {
    const lead = () => ((dialog.value = null), show({ triangle: panels[0], other: panels[1], hinge }));
    return <button type="button" class="link" title="Show them" onClick={lead}>{panels.map((t) => currentShell()?.name(t) ?? t).join(", ")}</button>;
}

/** What the cut files come to. */
export function PlanFigures({ plan }: { plan: Plan }) {
    const time = plan.seconds < 5400 ? `${number(plan.seconds / 60, 0)} min` : `${number(plan.seconds / 3600, 1)} h`;
    const rows: [string, string][] = [
        ["Sheets", count(plan.sheets)], ["Length of cut", `${number(plan.cut_length, plan.cut_length < 10 ? 1 : 0)} m`], ["On the machine", time],
        ["Mass", `${number(plan.mass, plan.mass < 10 ? 2 : 0)} kg`], ["Used of the sheets", `${number(100 * plan.utilisation, 0)} %`],
        ...(plan.seams ? [["Seams", count(plan.seams)] as [string, string]] : []), ...plan.parts.map((p): [string, string] => [capital(p.name), count(p.count)]),
    ];
    return (
        <>
            <table class="figures"><tbody>{rows.map(([name, figure]) => <tr key={name}><th scope="row">{name}</th><td>{figure}</td></tr>)}</tbody></table>
            {plan.doubt && <p class="note warning" role="status">{plan.doubt}</p>}
            {plan.fold && (
                <p class="note bad" role="alert">
                    <span>{plural(plan.folds, "pair")} of neighbours lie folded onto each other when open, <PanelsLink panels={plan.fold} hinge={-1} /> first: no joint bends so far. Paint smaller scale factors there, or tighten to load.</span>
                </p>
            )}
            {plan.clashes > 0 && (
                <>
                    <p class="note bad" role="alert">{plural(plan.clashes, "pair")} of panels meet on the way from flat to open. Take a smaller joint, or more distance.</p>
                    <table class="figures lined">
                        <thead><tr><th scope="col">Panels</th><th scope="col">When</th><th scope="col">Overlap</th></tr></thead>
                        <tbody>
                            {plan.collisions.slice(0, 12).map((c) => (
                                <tr key={`${c.panels} ${c.when}`}>
                                    <th scope="row"><PanelsLink panels={c.panels} hinge={c.hinge} /></th>
                                    <td>{whenWords[c.when]}{c.when === "between" && c.opening !== null ? `, ${number(100 * c.opening, 0)} % open` : ""}</td>
                                    <td>{c.overlap === null ? "" : `${number(c.overlap, 1)} mm`}</td>
                                </tr>
                            ))}
                        </tbody>
                    </table>
                    {plan.clashes > 12 && <p class="muted">and {count(plan.clashes - 12)} more</p>}
                </>
            )}
        </>
    );
}
