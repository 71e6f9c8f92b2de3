// What Analyse adds: a switch of fields over the view, and the sections of its inspector.
import { leadingForce } from "../panels/fields";
import { currentShell, documentState, report, revision, status } from "../state/session";
import { type Place, selected, show } from "../state/selection";
import { availableFields, fieldId, useField } from "../state/view";
import { Section, Segments, severityClass, severityIcon } from "./controls";
import { Icon } from "./icons";
import { type LengthUnit, count, decimals, length, number, scientific } from "./format";

export function AnalyseFields() {
    const wanted = ["force", "residual", "distance", "mouth"];
    const open = availableFields.value.map((f) => f.id);
    const titles: Record<string, string> = { force: "Edge force", residual: "Residual", distance: "Distance to design", mouth: "Mouth angle" };
    return (
        <Segments<string> name="Colour by" floating value={fieldId.value} onChange={useField}
            options={wanted.map((id) => ({ value: id, title: titles[id], disabled: !open.includes(id) }))} />
    );
}

function newtons(v: number): string {
    return Math.abs(v) >= 1000 ? `${number(v / 1000, decimals(v / 1000, 2))} kN` : `${number(v, Math.abs(v) < 10 ? 1 : 0)} N`;
}

export function AnalysePanel() {
    revision.value;
    const shell = currentShell();
    const unit = (documentState.value?.unit ?? "m") as LengthUnit;
    const load = documentState.value?.load;
    const r = report.value;
    if (!shell) return null;
    const forces = shell.forces;
    const strongest = forces ? [...leadingForce(forces)].map((f, t) => ({ f, t })).sort((a, b) => Math.abs(b.f) - Math.abs(a.f)).slice(0, 6) : [];
    let supports = 0;
    const sum = [0, 0, 0];
    let largest = 0;
    shell.supports.forEach((on, h) => {
        if (!on) return;
        supports++;
        const at = shell.reactions;
        if (!at) return;
        for (let k = 0; k < 3; k++) sum[k] += at[3 * h + k];
        largest = Math.max(largest, Math.hypot(at[3 * h], at[3 * h + 1], at[3 * h + 2]));
    });
    const leads = (p: Place) => p.triangle >= 0 || p.hinge >= 0;
    return (
        <>
            {r && (
                <Section title="Findings" aside={r.findings.length ? count(r.findings.length) : undefined}>
                    {r.findings.length === 0 && <p class="empty">Nothing needs a look.</p>}
                    {r.findings.map((f, k) => {
                        const words = <><Icon name={severityIcon[f.severity]} size={16} class={`icon ${severityClass[f.severity]}`} /><span class="grow">{f.text}</span></>;
                        return leads(f) ? <button key={k} type="button" class="finding" title="Show the place" onClick={() => show(f)}>{words}<Icon name="show" size={16} class="icon muted" /></button>
                            : <div key={k} class="finding">{words}</div>;
                    })}
                </Section>
            )}
            <Section title="Load" aside={load ? { none: "None", gravity: "Gravity", inflation: "Inflation" }[load.kind] : undefined}>
                {load && load.kind !== "none" && (
                    <table class="figures">
                        <tbody>
                            {load.kind === "inflation" && <tr><th scope="row">Pressure</th><td>{number(load.pressure, 0)} Pa</td></tr>}
                            {load.kind === "gravity" && <tr><th scope="row">Weight</th><td>{number(load.density, 1)} kg/m²</td></tr>}
                            {load.kind === "gravity" && <tr><th scope="row">Direction</th><td>{load.direction.map((v) => number(v, 1)).join(", ")}</td></tr>}
                        </tbody>
                    </table>
                )}
                {load?.kind === "none" && <p class="empty">No load. Choose gravity or inflation beside the timeline.</p>}
            </Section>
            <Section title="Equilibrium" aside={shell.exact ? "Exact" : "Not exact yet"}>
                <table class="figures">
                    <tbody>
                        <tr><th scope="row">Largest edge error</th><td>{scientific(status.value?.residual ?? null)}</td></tr>
                        {r?.figures.filter((f) => ["force_residual", "simulated_rms", "simulated_max", "stable"].includes(f.key)).map((f) => (
                            <tr key={f.key}><th scope="row">{f.label}</th><td>{typeof f.value === "boolean" ? (f.value ? "Yes" : "No") : typeof f.value === "number" ? scientific(f.value) : "–"} {f.unit === "L" ? "L" : ""}</td></tr>
                        ))}
                    </tbody>
                </table>
                {!shell.exact && <p class="empty">Forces come with the exact state. Finish computes it.</p>}
            </Section>
            {strongest.length > 0 && (
                <Section title="Largest forces" aside="Axial">
                    <table class="figures lined">
                        <thead><tr><th scope="col">Panel</th><th scope="col">Sense</th><th scope="col">Force</th></tr></thead>
                        <tbody>
                            {strongest.map(({ f, t }) => (
                                <tr key={t} aria-selected={selected.value.has(t)}>
                                    <th scope="row"><button type="button" class="link" onClick={() => show({ triangle: t, hinge: -1 })}>{shell.name(t)}</button></th>
                                    <td>{f < 0 ? "compressed" : "pulled"}</td>
                                    <td>{f > 0 ? "+" : ""}{newtons(f)}</td>
                                </tr>
                            ))}
                        </tbody>
                    </table>
                </Section>
            )}
            {supports > 0 && (
                <Section title="Supports" aside={`${count(supports)} hinges`}>
                    {shell.reactions ? (
                        <table class="figures">
                            <tbody>
                                <tr><th scope="row">Sum of reactions, z</th><td>{newtons(sum[2])}</td></tr>
                                <tr><th scope="row">Largest at one hinge</th><td>{newtons(largest)}</td></tr>
                            </tbody>
                        </table>
                    ) : <p class="muted">Their reactions come with the exact state.</p>}
                </Section>
            )}
            {r && r.held.length > 0 && (
                <Section title="Held" aside="Off by">
                    <table class="figures">
                        <tbody>{r.held.map((h) => <tr key={h.name}><th scope="row"><button type="button" class="link" title="Show where it is furthest off" onClick={() => show({ triangle: -1, hinge: h.hinge })}>{h.name}</button></th><td>{length(h.residual, unit)}</td></tr>)}</tbody>
                    </table>
                </Section>
            )}
        </>
    );
}
