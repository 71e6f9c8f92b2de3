// The recipe as history: each row is a state to go back to; a step's parameters can be changed and what follows is played again.
import { useSignal } from "@preact/signals";
import type { Step } from "../protocol/types";
import { command, currentShell, documentState, operatorNamed, operators, readOnly } from "../state/session";
import { callOf, missing, type Arguments } from "../tools/calls";
import { Button, Choice, Section, Tool } from "./controls";
import { count, plural } from "./format";
import { Icon, operatorIcon } from "./icons";
import { OperatorForm } from "./operatorform";
import { OperatorPanel } from "./toolpanel";

const groupTitles: Record<string, string> = {
    scale: "Scale factors", boundary: "Boundary", dynamics: "Dynamics", constraint: "Constraints", selection: "Selection", site: "Site", finish: "Finish",
};
const groupOrder = Object.keys(groupTitles);

export function Recipe() {
    const d = documentState.value;
    const editing = useSignal(-1);
    const adding = useSignal("");
    if (!d) return null;
    const all = operators.value.filter((o) => !o.starts).sort((a, b) => groupOrder.indexOf(a.group) - groupOrder.indexOf(b.group));
    const schema = operatorNamed(adding.value);
    return (
        <Section title="Recipe" id="recipe" aside={`${count(d.steps.length)} ${d.steps.length === 1 ? "step" : "steps"}`}>
            <ol class="steps">
                {d.steps.map((s, k) => <StepRow key={k} step={s} index={k} at={d.at} editing={editing.value === k} onEdit={() => (editing.value = editing.value === k ? -1 : k)} />)}
            </ol>
            {readOnly.value === null && (
                <div style={{ marginTop: "8px" }}>
                    <Choice name="Add a step" value={adding.value} options={[{ value: "", title: "Add a step…" }, ...all.map((o) => ({ value: o.name, title: o.title, group: groupTitles[o.group] ?? o.group }))]} onChange={(v) => (adding.value = v)} />
                    {schema && <div style={{ marginTop: "8px" }}><p class="small muted">{schema.doc}</p><OperatorPanel schema={schema} label="Add" /></div>}
                </div>
            )}
        </Section>
    );
}

function StepRow({ step, index, at, editing, onEdit }: { step: Step; index: number; at: number; editing: boolean; onEdit(): void }) {
    const schema = operatorNamed(step.operator.op);
    const current = index === at - 1;
    const [title, all] = split(step.words, schema?.title ?? step.operator.op);
    const line = short(all, step.operator.hinges);
    const words = index === 0 && !line ? `${count(currentShell()?.linkage.panels ?? 0)} panels` : line;
    return (
        <li class={`step-line${step.state === "ahead" ? " ahead" : ""}`}>
            <button type="button" class="step" aria-current={current ? "step" : undefined} onClick={() => void command("goto", { at: index + 1 })}>
                <Icon name={step.state === "failed" ? "crossed" : operatorIcon(step.operator.op, schema?.group ?? "")} size={16} />
                <span style={{ minWidth: 0 }}><b class="ellipsis">{title}</b><small>{step.state === "failed" ? step.problem : words}</small></span>
                {current && <span class="now">Now</span>}
            </button>
            {readOnly.value === null && (
                <span class="step-tools">
                    {schema && <Tool small icon="edit" name={`Change step ${index + 1}`} pressed={editing} onClick={onEdit} />}
                    {index > 0 && <Tool small icon="trash" name={`Remove step ${index + 1}`} onClick={() => void command("remove", { step: index })} />}
                </span>
            )}
            {editing && schema && <EditStep step={step} index={index} onDone={onEdit} />}
        </li>
    );
}

/** "Paint: 1.6 within 0.3 m" as a name and a line. */
function split(words: string, title: string): [string, string] {
    const at = words.indexOf(": ");
    return at > 0 ? [words.slice(0, at), words.slice(at + 2)] : [words || title, ""];
}

/** Lists of numbers say no more than how many there are. */
function short(line: string, hinges: unknown): string {
    const listed = typeof hinges === "string" && /^\d+(,\d+)+$/.test(hinges) ? hinges : null;
    const from = listed ? line.indexOf(listed.slice(0, 12)) : -1;
    const named = from < 0 ? line : `${line.slice(0, from)}${plural(listed!.split(",").length, "hinge")}${/, [^\d].*$/.exec(line.slice(from))?.[0] ?? ""}`;
    return named.replace(/points (\d+ points?)\b/, "$1");
}

function EditStep({ step, index, onDone }: { step: Step; index: number; onDone(): void }) {
    const schema = operatorNamed(step.operator.op)!;
    const { op: _, ...given } = step.operator;
    const args = useSignal<Arguments>(given);
    const call = { ...callOf({ ...schema, fields: [] }, {}), ...Object.fromEntries(Object.entries(args.value).filter(([, v]) => v !== undefined && v !== "")) };
    const lacking = missing(schema, call);
    return (
        <div class="step-edit">
            <OperatorForm schema={schema} args={args.value} onChange={(name, value) => (args.value = { ...args.value, [name]: value })} />
            <div class="row" style={{ marginTop: "8px" }}>
                <Button small primary disabled={lacking.length > 0} onClick={() => void command("edit", { step: index, operator: call }).then((a) => a && onDone())}>Change</Button>
                <Button small onClick={onDone}>Leave it</Button>
            </div>
        </div>
    );
}
