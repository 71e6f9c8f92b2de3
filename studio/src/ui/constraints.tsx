// What holds the shell, and how far each is from being met.
import { apply, documentState, operatorNamed, readOnly } from "../state/session";
import { selectHinges, show } from "../state/selection";
import { toolId } from "../tools/tool";
import type { Held } from "../protocol/types";
import { Button, Section, Tool } from "./controls";
import { type LengthUnit, length, number } from "./format";

const words: Record<string, string> = { slide: "Rim on curve", fixed: "Rim fixed", plane: "In a plane", plane_given: "In a given plane", line: "On a line", circle: "On a circle", curve: "On a curve", surface: "On a surface", mirror: "Mirrored", rotation: "Turned copies", fair: "Fair" };

export function Constraints() {
    const d = documentState.value;
    if (!d) return null;
    const unit = d.unit as LengthUnit;
    const all: { held: Held; rim: boolean }[] = [...d.rim.map((held) => ({ held, rim: true })), ...d.constraints.map((held) => ({ held, rim: false }))];
    const release = operatorNamed("release");
    return (
        <Section title="Constraints" aside="Off by">
            {all.length === 0 && (
                <div class="empty"><span>Nothing holds the shell.</span><Button small onClick={() => (toolId.value = "rim")}>Boundary</Button></div>
            )}
            {all.map(({ held, rim }) => {
                const off = held.residual > 1e-3 * (held.hinges.length ? 1 : 0) && held.multiplier > 1;
                return (
                    <div class="held" key={`${rim}-${held.name}`}>
                        <button type="button" class="link plain ellipsis" title={`${words[held.kind] ?? held.kind}, ${held.hinges.length} hinges: select them`} onClick={() => selectHinges(held.hinges)}>
                            {words[held.kind] ?? held.kind}{held.name && !rim ? ` “${held.name}”` : held.curve && rim ? ` (${held.curve.kind})` : ""}{held.weight !== null && held.weight !== 1 ? `, weight ${number(held.weight, 1)}` : ""}
                        </button>
                        <button type="button" class={`link plain ${off ? "warning" : ""}`} style={{ fontWeight: 600 }} title="Show where it is furthest off" onClick={() => show({ triangle: -1, hinge: held.hinge })}>{length(held.residual, unit)}</button>
                        {!rim && release && readOnly.value === null ? <Tool small icon="close" name={`Release ${held.name}`} onClick={() => void apply({ op: "release", name: held.name })} /> : <span />}
                    </div>
                );
            })}
        </Section>
    );
}
