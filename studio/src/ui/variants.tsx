// Variants: copies of the recipe under a name, small in the inspector, side by side in their own mode.
import { useSignal } from "@preact/signals";
import { medianEdge } from "../panels/linkage";
import { command, documentState, panelEdge, variants } from "../state/session";
import { looks } from "../state/variants";
import { mode } from "../state/view";
import { Button, Section, severityClass, severityIcon } from "./controls";
import { checkWords } from "./checkwords";
import { type LengthUnit, count } from "./format";
import { Icon } from "./icons";

const edgeOf = (name: string) => {
    const shell = looks.value[name]?.shell;
    return shell ? medianEdge(shell.linkage, shell.flat) : panelEdge.value;
};

function nextName(): string {
    const taken = new Set(variants.value.map((v) => v.name));
    for (let k = 0; k < 26; k++) {
        const name = String.fromCharCode(65 + k);
        if (!taken.has(name)) return name;
    }
    return `Variant ${taken.size + 1}`;
}

const keep = () => void command("variant", { name: nextName() });
const figure = (v: (typeof variants.value)[number]) => v.checks.find((c) => c.key === "scale")?.answer ?? `${count(v.triangles)} panels`;

export function Variants() {
    const all = variants.value;
    return (
        <Section title="Variants" aside={all.length ? <button type="button" class="link" onClick={keep}>Keep this one</button> : undefined}>
            {all.length === 0 ? (
                <div class="empty"><span>Keep the shell as it is now, to compare it later.</span><Button small onClick={keep}>Keep</Button></div>
            ) : (
                <div class="variants">
                    {all.map((v) => (
                        <button key={v.name} type="button" class="variant" aria-current={v.current ? "true" : undefined} onClick={() => (mode.value = "variants")}>
                            {looks.value[v.name] ? <img src={looks.value[v.name].picture} alt="" /> : <span class="none" />}
                            <b class="ellipsis">{v.name}{v.current ? ", this" : ""}</b>
                            <small>λ {figure(v)}</small>
                        </button>
                    ))}
                </div>
            )}
        </Section>
    );
}

export function VariantsPage() {
    const all = variants.value;
    const name = useSignal("");
    const unit = (documentState.value?.unit ?? "m") as LengthUnit;
    return (
        <div class="compare" tabIndex={0} role="region" aria-label="Variants side by side">
            {all.map((v) => (
                <article class="example" key={v.name} style={{ cursor: "default" }} aria-label={`Variant ${v.name}`}>
                    <div class="picture">{looks.value[v.name] && <img src={looks.value[v.name].picture} alt={`The shell of variant ${v.name}`} />}</div>
                    <div class="words">
                        <div class="spread"><b>{v.name}{v.current ? ", this" : ""}</b><small>{count(v.triangles)} panels, {count(v.steps)} steps{v.exact ? ", exact" : ""}</small></div>
                        <table class="figures" style={{ margin: "8px 0" }}>
                            <tbody>
                                {v.checks.map((c) => (
                                    <tr key={c.key}><th scope="row">{checkWords(c, unit, edgeOf(v.name)).question}</th><td><span class="row" style={{ justifyContent: "flex-end" }}><Icon name={severityIcon[c.severity]} size={16} class={`icon ${severityClass[c.severity]}`} />{checkWords(c, unit, edgeOf(v.name)).answer}</span></td></tr>
                                ))}
                            </tbody>
                        </table>
                        <div class="row"><Button small disabled={v.current} onClick={() => void command("variant_take", { name: v.name })}>Take</Button><Button small onClick={() => void command("variant_drop", { name: v.name })}>Forget</Button></div>
                    </div>
                </article>
            ))}
            <form class="card" style={{ alignSelf: "start" }} onSubmit={(e) => {
                e.preventDefault();
                void command("variant", { name: name.value || nextName() });
                name.value = "";
            }}>
                <h2>Keep the present one</h2>
                <p class="muted">Its recipe and figures stay while you go on.</p>
                <div class="row" style={{ marginTop: "12px" }}>
                    <div class="field grow"><input type="text" aria-label="Name" placeholder={nextName()} value={name.value} onInput={(e) => (name.value = e.currentTarget.value)} /></div>
                    <Button small type="submit">Keep</Button>
                </div>
            </form>
        </div>
    );
}
