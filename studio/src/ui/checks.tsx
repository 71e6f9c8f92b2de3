// "Can it deploy?", always in sight: a verdict and what it hangs on. A check leads to its place.
import { show } from "../state/selection";
import { documentState, making, panelEdge, report, status } from "../state/session";
import { drawerOpen, mode } from "../state/view";
import type { Check } from "../protocol/types";
import { severityClass, severityIcon } from "./controls";
import { checkWords } from "./checkwords";
import { type LengthUnit, plural } from "./format";
import { Icon } from "./icons";

/** Five of the seven have room; forces and match matter once there is a load, curvature and overlaps before. */
function shownChecks(all: Check[]): Check[] {
    const wanted = mode.value === "analyse" ? ["scale", "mouth", "curvature", "match", "force"] : ["scale", "mouth", "curvature", "overlap", "rim"];
    const rank = { failure: 0, warning: 1, note: 2, pass: 2, unknown: 3 };
    const chosen = all.filter((c) => wanted.includes(c.key));
    for (const c of all)
        if (!chosen.includes(c) && rank[c.severity] < 2) {
            // what needs a look takes the place of what does not
            const k = chosen.findLastIndex((x) => rank[x.severity] >= 2);
            if (k >= 0) chosen[k] = c;
        }
    return chosen.sort((a, b) => all.indexOf(a) - all.indexOf(b));
}

export function Checks() {
    const r = making.value ? null : report.value;
    const busy = status.value !== null && status.value.solver !== "idle";
    if (!r) return <section class="checks" aria-label="Can it deploy?"><div class="verdict"><span class="q">Can it deploy?</span><span class="answer muted">Not known yet</span></div></section>;
    const failed = r.checks.filter((c) => c.severity === "failure").length;
    const warned = r.checks.filter((c) => c.severity === "warning").length;
    const words = failed ? `${plural(failed, "check")} failed` : warned ? `${plural(warned, "check")} ${warned === 1 ? "needs" : "need"} a look` : r.verdict.severity === "unknown" ? (documentState.value?.load.kind === "none" ? "Choose what deploys it" : "Still measuring") : "All checks passed";
    return (
        <section class={`checks${busy ? " stale" : ""}`} aria-label="Can it deploy?">
            <button type="button" class="verdict" title="All findings" onClick={() => ((mode.value = "analyse"), (drawerOpen.value = true))}>
                <span class="q">Can it deploy?</span>
                <span class={`answer ${severityClass[r.verdict.severity]}`}><Icon name={severityIcon[r.verdict.severity]} size={20} /><span>{r.verdict.word}</span></span>
                <span class="l">{words}</span>
            </button>
            {shownChecks(r.checks).map((c) => {
                const w = checkWords(c, (documentState.value?.unit ?? "m") as LengthUnit, panelEdge.value);
                const leads = c.triangle >= 0 || c.hinge >= 0;
                return (
                    <button key={c.key} type="button" data-check={c.key} aria-disabled={!leads} title={`${c.title}: ${c.answer}. ${c.limit}${leads ? ". Show the place" : ""}`} onClick={() => show(c)}>
                        <span class="q">{w.question}</span>
                        <span class="answer"><Icon name={severityIcon[c.severity]} size={16} class={`icon ${severityClass[c.severity]}`} /><span>{w.answer}</span></span>
                        <span class="l">{w.limit}</span>
                    </button>
                );
            })}
        </section>
    );
}
