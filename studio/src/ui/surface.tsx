// A mesh that was dropped: shown at once, then judged, then designed with one click.
import { signal } from "@preact/signals";
import type { Problem, Screen } from "../protocol/types";
import { CommandError, upload } from "../protocol/link";
import { ask, command, problem, progress } from "../state/session";
import { dialog, page } from "../state/view";
import { Button, CheckBox, Dialog, NumberRow, Row, Choice, severityClass, severityIcon } from "./controls";
import { type LengthUnit, count, number, plural } from "./format";
import { Icon } from "./icons";

interface Candidate {
    name: string;
    token: string;
    screen: Screen | null;
    error: Problem | null;
    triangles: number;
    unit: LengthUnit;
    unitChosen: boolean; // by hand: else the likely one is taken
    up: "file" | "y" | "z";
    refine: boolean | null; // null: as the facets want it
}
export const candidate = signal<Candidate | null>(null);

const meshEndings = /\.(obj|stl|ply|off|glb|gltf|3dm|fbx|dae|3ds)$/i;
const designEndings = /\.(auxshell|json)$/i;

/** Any file given to the studio: meshes are screened, designs and recipes opened, outlines become a start. */
export async function takeFile(file: File): Promise<void> {
    const refuse = (message: string) => (problem.value = { about: "file", error: { status: 3, word: "bad_input", message } });
    try {
        if (designEndings.test(file.name)) {
            if (await command("open", { upload: await upload(file, file.name) })) page.value = "work";
        } else if (/\.(svg|dxf)$/i.test(file.name)) {
            const token = await upload(file, file.name);
            if (await command("new", { recipe: [{ op: "start_curve", file: file.name }], files: { [file.name]: token }, name: file.name.replace(/\.\w+$/, "") })) page.value = "work";
        } else if (meshEndings.test(file.name)) {
            candidate.value = { name: file.name, token: await upload(file, file.name), screen: null, error: null, triangles: 600, unit: "m", unitChosen: false, up: "file", refine: null };
            dialog.value = "surface";
            await screen();
        } else refuse(`${file.name} is no mesh, outline, design or recipe. The studio reads OBJ, STL, PLY, GLB, SVG, DXF, .auxshell and recipe JSON.`);
    } catch (error) {
        refuse(`${file.name}: ${error instanceof Error ? error.message : String(error)}`);
    }
}

async function screen(): Promise<void> {
    const c = candidate.value;
    if (!c) return;
    candidate.value = { ...c, screen: null, error: null };
    try {
        const answer = (await ask("check", { upload: c.token, unit: c.unit, up: c.up })) as unknown as Screen;
        const now = candidate.value;
        if (now?.token === c.token) candidate.value = { ...now, screen: answer, unit: now.unitChosen ? now.unit : answer.likely_unit };
    } catch (error) {
        const p: Problem = error instanceof CommandError ? error.problem : { status: 1, word: "failed", message: String(error) };
        if (candidate.value?.token === c.token) candidate.value = { ...candidate.value, error: p };
    }
}

/** Flat facets wider than the panels carry no load; open, a panel and its share of the holes take sqrt(3) times its edge squared. */
function isCoarse(c: Candidate): boolean {
    return c.screen !== null && Math.sqrt((4 * c.screen.area) / (Math.sqrt(3) * c.screen.faces)) > Math.sqrt(c.screen.area / (Math.sqrt(3) * c.triangles));
}

const close = () => {
    dialog.value = null;
    candidate.value = null;
};

export function SurfaceDialog() {
    const c = candidate.value;
    if (!c) return null;
    const s = c.screen;
    const refine = c.refine ?? isCoarse(c);
    const severity = s ? { deployable: "pass", deployable_projected: "warning", not_deployable: "failure" }[s.verdict] : "unknown";
    const design = async (project: boolean) => {
        const { name, token, triangles, unit, up } = c;
        const recipe: Record<string, unknown>[] = [{ op: "start_target", file: name, triangles, unit, ...(up === "file" ? {} : { up }), ...(refine ? { refine } : {}), ...(project ? { project: true } : {}) }];
        const load = s?.by_inflation ? "inflation" : s?.by_gravity ? "gravity" : null;
        if (load) recipe.push({ op: load, adapt: false }); // the panels have the sizes that open on the surface
        if (await command("new", { recipe, files: { [name]: token }, name: name.replace(/\.\w+$/, "") })) {
            page.value = "work";
            close();
        }
    };
    return (
        <Dialog title={c.name} size="middle-size" onClose={close} footer={
            <>
                <span class="grow small" role="status">{progress.value ? `${progress.value.stage || progress.value.job} ${number(100 * progress.value.fraction, 0)} %` : ""}</span>
                <Button onClick={close}>Cancel</Button>
                {s?.verdict === "deployable" && <Button primary onClick={() => void design(false)}>Design it</Button>}
                {s?.verdict === "deployable_projected" && <Button primary onClick={() => void design(true)}>Use the nearest one that can</Button>}
            </>
        }>
            <div class="body" style={{ display: "grid", gap: "16px", gridTemplateColumns: s ? "minmax(0, 1fr) 300px" : "1fr" }}>
                {s && <div style={{ background: "var(--sunken)", borderRadius: "12px", overflow: "hidden", display: "grid", placeItems: "center", minHeight: "280px" }}><img src={s.pictures.curvature} alt={`Mean curvature of ${c.name}`} style={{ maxWidth: "100%" }} /></div>}
                <div>
                    {!s && !c.error && <p class="row" role="status"><i class="ring" />Looking at the surface.</p>}
                    {c.error && <p class="note bad" role="alert"><Icon name="crossed" />{c.error.message}</p>}
                    {problem.value?.about === "new" && <p class="note bad" role="alert"><Icon name="crossed" />{problem.value.error.message}</p>}
                    {s && (
                        <>
                            <p class={`row ${severityClass[severity]}`} style={{ alignItems: "flex-start" }}><Icon name={severityIcon[severity]} /><b style={{ font: "600 15px/20px var(--font)" }}>{{ deployable: "It can deploy", deployable_projected: "It can, after a small change", not_deployable: "It cannot deploy" }[s.verdict]}</b></p>
                            <p style={{ margin: "8px 0 12px" }}>{s.words}</p>
                            <table class="figures">
                                <tbody>
                                    <tr><th scope="row">Mesh</th><td>{plural(s.faces, "face")}</td></tr>
                                    <tr><th scope="row">Size</th><td>{[0, 1, 2].map((k) => number(s.bounds[1][k] - s.bounds[0][k], 2)).join(" × ")} {c.unit}</td></tr>
                                    <tr><th scope="row">By</th><td>{s.by_inflation && s.by_gravity ? "Inflation or gravity" : s.by_inflation ? "Inflation" : s.by_gravity ? "Gravity" : "–"}</td></tr>
                                    {s.scale.ratio !== null && <tr><th scope="row">Scale factors</th><td>{number(s.scale.lo, 2)} to {number(s.scale.hi, 2)}</td></tr>}
                                    {s.projection && <tr><th scope="row">Moves at most</th><td>{number(s.projection.largest_move, 3)} {c.unit}</td></tr>}
                                    {s.repairs.welded_vertices > 0 && <tr><th scope="row">Welded</th><td>{plural(s.repairs.welded_vertices, "vertex", "vertices")}</td></tr>}
                                </tbody>
                            </table>
                        </>
                    )}
                    <div class="form" style={{ marginTop: "8px" }}>
                        <NumberRow label="Panels" value={c.triangles} documentUnit="m" integer lo={24} hi={2000000} onChange={(triangles) => (candidate.value = { ...c, triangles })} />
                        <Row label="Unit">{(id) => <Choice id={id} value={c.unit} options={["mm", "cm", "m"].map((u) => ({ value: u as LengthUnit, title: u }))} onChange={(unit) => {
                            candidate.value = { ...c, unit, unitChosen: true };
                            void screen();
                        }} />}</Row>
                        <Row label="Up axis">{(id) => <Choice id={id} value={c.up} options={[{ value: "file", title: "As the file says" }, { value: "z", title: "z" }, { value: "y", title: "y" }]} onChange={(up) => {
                            candidate.value = { ...c, up };
                            void screen();
                        }} />}</Row>
                        <Row label="Refine" title="Divide and round the surface until its facets are half as wide as the panels">{(id) => <CheckBox id={id} value={refine} title={isCoarse(c) ? "Facets are wider than panels" : "Round the facets"} onChange={(refine) => (candidate.value = { ...c, refine })} />}</Row>
                    </div>
                    <p class="small faint">{count(c.triangles)} panels take {c.triangles > 5000 ? "some seconds" : "about a second"}.</p>
                </div>
            </div>
        </Dialog>
    );
}
