// The way from flat to deployed, through states the solver went through, and the load that drives it.
import { callOf } from "../tools/calls";
import { apply, documentState, operators, progress } from "../state/session";
import { motion, playMotion, scrub, shownShare } from "../state/motion";
import { Choice, NumberField, Slider } from "./controls";
import { number } from "./format";
import { Icon } from "./icons";

/** Operators of the group dynamics that stand for a way of deploying. */
const drives = () => operators.value.filter((o) => o.group === "dynamics" && ["gravity", "inflation", "inflate", "expand"].includes(o.name));

/** The panels have the sizes that open on a given surface: they are not to give way for another shape. */
const onTarget = () => documentState.value?.steps[0]?.operator.op === "start_target";

function present(): string {
    const d = documentState.value;
    if (!d) return "";
    const last = d.steps.slice(0, d.at).map((s) => s.operator.op).filter((op) => drives().some((o) => o.name === op)).at(-1);
    if (last) return last;
    return d.load.kind === "inflation" ? (drives().find((o) => o.name.startsWith("inflat"))?.name ?? "") : d.load.kind === "gravity" ? "gravity" : "";
}

export function Timeline() {
    const m = motion.value;
    const share = shownShare();
    const words = m.computing ? `Computing, ${m.frames.length} of ${m.total || 60} states` : m.shown !== null ? `State ${m.shown + 1} of ${m.frames.length}` : "";
    const all = drives();
    return (
        <section class="timeline" aria-label="Deployment">
            <button type="button" class="round" aria-label={m.playing ? "Pause the deployment" : "Play the deployment"} aria-keyshortcuts="Space" disabled={progress.value !== null && !m.computing} onClick={() => void playMotion()}>
                <Icon name={m.playing ? "pause" : "play"} />
            </button>
            <div class="track">
                <Slider name="Share of the way" lo={0} hi={100} step={1} value={Math.round(100 * share)} text={`${number(100 * share, 0)} % deployed`} onChange={(v) => m.frames.length || v === 100 ? void scrub(v / 100) : undefined} onCommit={(v) => void scrub(v / 100)} />
                <div class="marks"><span>Flat</span>{words && <span role="status">{words}</span>}<span>Deployed</span></div>
            </div>
            <NumberField name="Share of the way" unit="%" documentUnit="m" lo={0} hi={100} integer value={Math.round(100 * share)} onChange={(v) => void scrub(v / 100)} />
            {all.length > 0 && (
                <Choice name="Deployed by" value={present()} options={[...(present() ? [] : [{ value: "", title: "By…", disabled: true }]), ...all.map((o) => ({ value: o.name, title: o.title }))]}
                    onChange={(name) => {
                        const schema = all.find((o) => o.name === name);
                        if (schema) void apply(callOf(schema, onTarget() ? { adapt: false } : {}));
                    }} />
            )}
        </section>
    );
}
