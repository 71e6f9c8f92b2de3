// Export: every format that the program writes, with a look at what will be cut.
import { signal, useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { ExportedFile, Exporter, Plan, StateName } from "../protocol/types";
import { CommandError } from "../protocol/link";
import { ask, currentShell, documentState, hello, report, revision, status } from "../state/session";
import { download, savePicture } from "../state/commands";
import { record } from "../state/video";
import { saveRhino } from "../rhino/save";
import { pictureUrl, thumbnail } from "../scene/thumbnail";
import { dialog, stage } from "../state/view";
import { Button, Choice, Dialog, Row, Section } from "./controls";
import { bytes, count, plural } from "./format";
import { Icon } from "./icons";
import { CutSettings, PlanFigures, cutDefaults, cutWords } from "./making";

const groups: { title: string; endings: RegExp }[] = [
    { title: "Cut", endings: /\.(svg|dxf|pdf)$/ },
    { title: "Model", endings: /\.(glb|obj|stl|3mf|ply|3dm)$/ },
    { title: "Data", endings: /\.(json|csv)$/ },
    { title: "Picture", endings: /\.png$/ },
];
const dotted = (e: Exporter) => (e.ending.startsWith(".") ? e.ending : `.${e.ending}`);
/** What the page makes itself. */
const ownFormats = [
    { id: "rhino", group: "Model", title: "Rhino document", side: ".3dm", doc: "All states, panels named, on layers of their rows; Rhino 7 and later.", run: saveRhino },
    { id: "picture", group: "Picture", title: "PNG of the view", side: "screen", doc: "The views as they are now, as one PNG.", run: savePicture },
    { id: "turntable", group: "Picture", title: "Turntable", side: "video", doc: "The deployed shell turned once round, twelve seconds, as WebM.", run: () => record("turntable") },
    { id: "deployment", group: "Picture", title: "Deployment", side: "video", doc: "The states that the solver goes through from flat to deployed, as WebM.", run: () => record("deployment") },
];
const isCut = (ending: string) => groups[0].endings.test(ending);
/** The format whose pictures show what a file of this one holds: drawings of the sheets have the same parts. */
const seenAs = (ending: string) => (/^\.(svg|dxf|r12\.dxf|pdf|a4\.pdf)$/.test(ending) ? ".svg" : ending === ".png" || ending === ".csv" ? ending : null);
/** The first lines of a table. */
const rowsOf = (csv: string) => csv.split("\n").filter((line) => line && !line.startsWith("#")).slice(0, 24).map((line) => line.trimEnd().split(","));
/** A cut file as it is looked at: lines of a tenth of a millimetre on metres of sheet would not be seen. */
function seen(svg: string): string {
    const width = Number(/viewBox="[-\d.]+ [-\d.]+ ([\d.]+)/.exec(svg)?.[1] ?? 0);
    return width ? svg.replace(/stroke-width="[\d.]+"/g, `stroke-width="${(width / 1100).toPrecision(3)}"`) : svg;
}

/** What is asked for most stands first. */
const order = [".svg", ".dxf", ".pdf", ".glb", ".obj", ".stl", ".json", ".csv"];
const rank = (e: Exporter) => (order.indexOf(dotted(e)) + 100) % 100;
/** As they were last set: most exports are made again. */
const cutOptions = signal(cutDefaults);

export function ExportDialog() {
    revision.value;
    const exporters = (hello.value?.exporters ?? []).slice().sort((a, b) => rank(a) - rank(b));
    const ending = useSignal(exporters.some((e) => dotted(e) === ".svg") ? ".svg" : exporters[0] ? dotted(exporters[0]) : "picture");
    const state = useSignal<StateName | "">("");
    const plan = useSignal<Plan | null>(null);
    const files = useSignal<ExportedFile[] | null>(null);
    const busy = useSignal(false);
    const wrong = useSignal("");
    const looked = useSignal<{ urls: string[]; names: string[]; at: number } | null>(null);
    const rows = useSignal<string[][] | null>(null);
    const exporter = exporters.find((e) => dotted(e) === ending.value);
    const shell = currentShell();
    const has = (s: StateName) => s !== "simulated" || shell?.simulated !== null;

    const run = async (as = exporter): Promise<ExportedFile[] | null> => {
        if (!as) return null;
        wrong.value = "";
        busy.value = true;
        try {
            const answer = await ask("export", { ending: as.ending, ...(state.value ? { state: state.value } : {}), ...(isCut(ending.value) ? cutWords(cutOptions.value) : {}) });
            plan.value = answer.plan as Plan | null;
            return answer.files as ExportedFile[];
        } catch (error) {
            wrong.value = error instanceof CommandError ? error.problem.message : String(error);
            return null;
        } finally {
            busy.value = false;
        }
    };

    // the preview is the file itself, as it would be cut; of models it is the state that they hold
    useEffect(() => {
        let current = true;
        const made: string[] = [];
        looked.value = null;
        files.value = null;
        plan.value = null;
        rows.value = null;
        wrong.value = "";
        const as = exporters.find((e) => dotted(e) === seenAs(ending.value));
        const show = (canvas: HTMLCanvasElement | Blob, name: string) => void (canvas instanceof Blob ? Promise.resolve(URL.createObjectURL(canvas)) : pictureUrl(canvas)).then((url) => {
            made.push(url);
            if (current) looked.value = { urls: [url], names: [name], at: 0 };
        });
        if (ownFormats.some((o) => o.id === ending.value && o.group === "Picture")) void stage.value?.picture().then((blob) => show(blob, "The views as they are"));
        else if (!as && shell) {
            const shown: StateName = state.value || exporter?.default_state || "deployed";
            const places = shown === "flat" ? shell.flat : shown === "simulated" && shell.simulated ? shell.simulated : shell.deployed;
            show(thumbnail(shell.linkage, places, shell.realised, 1200, 760), `${shown.charAt(0).toUpperCase()}${shown.slice(1)} state`);
        } else if (as)
            void run(as).then(async (list) => {
                if (!list || !current) return;
                if (as === exporter) files.value = list;
                if (dotted(as) === ".csv") {
                    const table = rowsOf(await (await fetch(list[0].url)).text());
                    if (current) rows.value = table;
                    return;
                }
                const sheets = list.length > 1 ? list.filter((f) => /-\d+\.\w+$/.test(f.name)) : list;
                const urls: string[] = [];
                for (const f of sheets.slice(0, 12)) {
                    const response = await fetch(f.url);
                    urls.push(URL.createObjectURL(f.name.endsWith(".svg") ? new Blob([seen(await response.text())], { type: "image/svg+xml" })
                        : new Blob([await response.arrayBuffer()], { type: "image/png" })));
                }
                made.push(...urls);
                if (current) looked.value = { urls, names: sheets.map((f) => f.name), at: 0 };
            });
        return () => {
            current = false;
            made.forEach((u) => URL.revokeObjectURL(u));
        };
    }, [ending.value, state.value, isCut(ending.value) && cutOptions.value]);

    const exportNow = async () => {
        const own = ownFormats.find((o) => o.id === ending.value);
        if (own) {
            wrong.value = "";
            busy.value = true;
            try {
                if (own.group === "Picture") dialog.value = null; // they show the view
                await own.run();
                dialog.value = null;
            } catch (error) {
                wrong.value = error instanceof CommandError ? error.problem.message : String(error);
            } finally {
                busy.value = false;
            }
            return;
        }
        const list = await run();
        if (!list) return;
        for (const f of list) download(f.url, f.name);
        files.value = list;
    };
    const exact = status.value?.state === "exact";
    const states = exporter?.states.filter(has) ?? [];
    return (
        <Dialog title="Export" size="wide" onClose={() => (dialog.value = null)} footer={
            <>
                <span class="grow ellipsis small" role="status">{files.value ? `${files.value.map((f) => f.name).slice(0, 3).join(", ")}${files.value.length > 3 ? ` and ${files.value.length - 3} more` : ""}, ${bytes(files.value.reduce((s, f) => s + f.bytes, 0))}` : exporter?.doc}</span>
                <Button onClick={() => (dialog.value = null)}>Cancel</Button>
                <Button primary disabled={busy.value || (!exporter && !ownFormats.some((o) => o.id === ending.value))} onClick={() => void exportNow()}>{busy.value ? "Working" : files.value && files.value.length > 1 ? `Export ${plural(files.value.length, "file")}` : "Export"}</Button>
            </>
        }>
            <div class="export">
                <div class="formats" role="radiogroup" aria-label="Format">
                    {groups.map((g) => {
                        const all = exporters.filter((e) => g.endings.test(dotted(e)));
                        const own = ownFormats.filter((o) => o.group === g.title);
                        if (!all.length && !own.length) return null;
                        return (
                            <div key={g.title}>
                                <h3>{g.title}</h3>
                                {all.map((e) => (
                                    <button key={e.ending} type="button" role="radio" aria-checked={ending.value === dotted(e)} onClick={() => ((ending.value = dotted(e)), (state.value = ""))}>
                                        {/^[a-z]+ /.test(e.name) ? e.name.charAt(0).toUpperCase() + e.name.slice(1) : e.name}<span>{dotted(e)}</span>
                                    </button>
                                ))}
                                {own.map((o) => <button key={o.id} type="button" role="radio" aria-checked={ending.value === o.id} onClick={() => (ending.value = o.id)}>{o.title}<span>{o.side}</span></button>)}
                            </div>
                        );
                    })}
                    {exporters.filter((e) => !groups.some((g) => g.endings.test(dotted(e)))).map((e) => (
                        <button key={e.ending} type="button" role="radio" aria-checked={ending.value === dotted(e)} onClick={() => (ending.value = dotted(e))}>{e.name}</button>
                    ))}
                </div>
                <div class="sheet" tabIndex={0} role="region" aria-label="Preview">
                    {wrong.value && <p class="note bad" role="alert"><Icon name="crossed" />{wrong.value}</p>}
                    {looked.value && looked.value.urls.length > 0 ? (
                        <>
                            <div class="spread"><b>{looked.value.urls.length > 1 ? `Sheet ${looked.value.at + 1} of ${looked.value.names.length}` : seenAs(ending.value) === ending.value || !isCut(ending.value) ? looked.value.names[0] : "The sheet"}</b></div>
                            <div class="paper"><img src={looked.value.urls[looked.value.at]} alt={`What ${looked.value.names[looked.value.at]} holds`} /></div>
                            {looked.value.urls.length > 1 && (
                                <div class="thumbs">
                                    {looked.value.urls.map((u, k) => <button key={u} type="button" aria-label={`Sheet ${k + 1}`} aria-current={k === looked.value!.at ? "true" : undefined} onClick={() => (looked.value = { ...looked.value!, at: k })}><img src={u} alt="" /></button>)}
                                </div>
                            )}
                        </>
                    ) : rows.value ? (
                        <div class="table-view">
                            <table><thead><tr>{rows.value[0].map((c, k) => <th key={k} scope="col">{c}</th>)}</tr></thead><tbody>{rows.value.slice(1).map((r, i) => <tr key={i}>{r.map((c, k) => <td key={k}>{c}</td>)}</tr>)}</tbody></table>
                        </div>
                    ) : (
                        <div class="empty"><span>{busy.value ? "Making it." : ownFormats.find((o) => o.id === ending.value)?.doc ?? exporter?.doc ?? ""}</span></div>
                    )}
                </div>
                <div class="settings">
                    {exporter && (
                        <Section title={exporter.name} aside={ending.value}>
                            <p class="small muted" style={{ marginBottom: "8px" }}>{exporter.doc}</p>
                            {states.length > 1 && <Row label="State">{(id) => <Choice id={id} value={state.value || exporter.default_state} options={states.map((s) => ({ value: s, title: s.charAt(0).toUpperCase() + s.slice(1) }))} onChange={(s) => (state.value = s)} />}</Row>}
                            {isCut(ending.value) && <CutSettings value={cutOptions.value} onChange={(o) => (cutOptions.value = o)} />}
                        </Section>
                    )}
                    {plan.value && <Section title="What it takes"><PlanFigures plan={plan.value} /></Section>}
                    <Section title="Design">
                        <table class="figures">
                            <tbody>
                                <tr><th scope="row">Panels</th><td>{count(shell?.linkage.panels ?? 0)}</td></tr>
                                <tr><th scope="row">Unit</th><td>{documentState.value?.unit}</td></tr>
                                <tr><th scope="row">Can it deploy?</th><td>{report.value?.verdict.word ?? "–"}</td></tr>
                                <tr><th scope="row">State</th><td>{exact ? "Exact" : "Not exact yet"}</td></tr>
                            </tbody>
                        </table>
                        {!exact && <p class="note warning" style={{ marginTop: "8px" }}><Icon name="triangle" size={16} />Not exact yet. Finish first if it is to be built.</p>}
                    </Section>
                </div>
            </div>
        </Dialog>
    );
}
