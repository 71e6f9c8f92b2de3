// Dialogs that are more than a question: open, save, shortcuts, the panel table.
import { useSignal } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import type { FolderEntry } from "../protocol/types";
import { upload } from "../protocol/link";
import { ask, command, currentShell, documentState, hello, problem, revision } from "../state/session";
import { navigation, type Navigation } from "../state/settings";
import { commands } from "../state/commands";
import { select, selected, show } from "../state/selection";
import { dialog, page } from "../state/view";
import { navigationWords } from "../scene/navigation";
import { Button, Dialog, Row, Segments } from "./controls";
import { bytes, number, time } from "./format";
import { Icon } from "./icons";

const close = () => (dialog.value = null);

export function OpenDialog() {
    const files = useSignal<FolderEntry[] | null>(null);
    const folder = useSignal("");
    const chooser = useRef<HTMLInputElement>(null);
    useEffect(() => {
        files.value = null;
        ask("files", folder.value ? { folder: folder.value } : {}).then((a) => (files.value = a.files as FolderEntry[]), () => (files.value = []));
    }, [folder.value]);
    const open = async (parameters: Record<string, unknown>) => {
        if (await command("open", parameters)) {
            page.value = "work";
            close();
        }
    };
    const take = async (file: File | undefined) => {
        if (!file) return;
        try {
            await open({ upload: await upload(file, file.name) });
        } catch (error) {
            problem.value = { about: "open", error: { status: 3, word: "bad_input", message: `${file.name}: ${(error as Error).message}` } };
        }
    };
    return (
        <Dialog title="Open a design" onClose={close} footer={<><span class="grow small">In the folder {hello.value?.folder}</span><Button onClick={() => chooser.current?.click()} icon="file">From elsewhere</Button></>}>
            <div class="body">
                <input ref={chooser} type="file" hidden accept=".auxshell,.json" onChange={(e) => void take(e.currentTarget.files?.[0])} />
                {problem.value?.about === "open" && <p class="note bad" role="alert"><Icon name="crossed" />{problem.value.error.message}</p>}
                <ul class="recent">
                    {folder.value && <li><button type="button" onClick={() => (folder.value = folder.value.split("/").slice(0, -1).join("/"))}><Icon name="folder" size={16} />Up</button></li>}
                    {files.value?.map((f) => (
                        <li key={f.name}>
                            <button type="button" style={{ width: "100%" }} onClick={() => {
                                const path = folder.value ? `${folder.value}/${f.name}` : f.name;
                                if (f.folder) folder.value = path;
                                else void open({ path });
                            }}>
                                <Icon name={f.folder ? "folder" : "file"} size={16} />
                                <span class="grow ellipsis">{f.name}</span>
                                {!f.folder && <span class="when">{bytes(f.bytes)}, {time(f.time)}</span>}
                            </button>
                        </li>
                    ))}
                </ul>
                {files.value?.length === 0 && <p class="empty">No designs and recipes in this folder yet. Save one, or open one from elsewhere.</p>}
            </div>
        </Dialog>
    );
}

export function SaveDialog() {
    const name = useSignal(documentState.value?.path ?? `${(documentState.value?.name ?? "shell").toLowerCase().replace(/[^a-z0-9]+/g, "-")}.auxshell`);
    const exists = useSignal(false);
    const save = async (overwrite: boolean) => {
        const path = /\.(auxshell|json)$/.test(name.value) ? name.value : `${name.value}.auxshell`;
        if (await command("save", overwrite ? { path, overwrite } : { path })) close();
        else exists.value = /exist|already/i.test(problem.value?.error.message ?? "");
    };
    return (
        <Dialog title="Save" onClose={close} footer={<><Button onClick={close}>Cancel</Button>{exists.value ? <Button primary onClick={() => void save(true)}>Replace it</Button> : <Button primary onClick={() => void save(false)}>Save</Button>}</>}>
            <form class="body" onSubmit={(e) => (e.preventDefault(), void save(exists.value))}>
                <Row label="File">{(id) => <div class="field"><input id={id} type="text" value={name.value} onInput={(e) => ((name.value = e.currentTarget.value), (exists.value = false))} /></div>}</Row>
                <p class="small muted" style={{ marginTop: "8px" }}>In the folder {hello.value?.folder}. What you do is kept at every gesture, also without a name.</p>
                {problem.value?.about === "save" && <p class="note bad" role="alert" style={{ marginTop: "12px" }}><Icon name="crossed" />{problem.value.error.message}</p>}
            </form>
        </Dialog>
    );
}

export function ShortcutsDialog() {
    const groups = ["Tools", "Edit", "View", "Deployment", "File"] as const;
    return (
        <Dialog title="Keyboard and pointer" size="middle-size" onClose={close}>
            <div class="body" tabIndex={0} role="region" aria-label="Shortcuts">
                <Row label="Navigate">{() => <Segments<Navigation> name="Navigate as in" value={navigation.value} options={(Object.keys(navigationWords) as Navigation[]).map((n) => ({ value: n, title: navigationWords[n].title }))} onChange={(n) => (navigation.value = n)} />}</Row>
                <p class="muted" style={{ margin: "8px 0 24px" }}>{navigationWords[navigation.value].lines.map(([what, how]) => `${what}: ${how}`).join(". ")}. The left button is always the tool's. On a touch screen one finger works with the tool on the shell and turns the view beside it, two fingers pan and zoom.</p>
                <div class="shortcuts">
                    {groups.map((g) => (
                        <section key={g}>
                            <h3>{g}</h3>
                            <dl>{commands.filter((c) => c.group === g).flatMap((c) => [<dt key={c.id} class="muted">{c.title}</dt>, <dd key={`${c.id}-keys`}>{c.keys.map((k) => <kbd key={k}>{k.replace("Arrow", "")}</kbd>)}</dd>])}</dl>
                        </section>
                    ))}
                    <section>
                        <h3>Brush</h3>
                        <dl>
                            <dt class="muted">Radius</dt><dd><kbd>F</kbd><kbd>[</kbd><kbd>]</kbd></dd>
                            <dt class="muted">Strength</dt><dd><kbd>Shift+F</kbd></dd>
                            <dt class="muted">Lower while held</dt><dd><kbd>Ctrl</kbd></dd>
                            <dt class="muted">Smooth while held</dt><dd><kbd>Shift</kbd></dd>
                        </dl>
                    </section>
                    <section>
                        <h3>Numbers</h3>
                        <dl>
                            <dt class="muted">Up, down; ten times; a tenth</dt><dd><kbd>Up</kbd><kbd>Shift</kbd><kbd>Alt</kbd></dd>
                            <dt class="muted">Units and sums</dt><dd><kbd>1.2 m</kbd><kbd>3'6"</kbd><kbd>1200/3 mm</kbd></dd>
                        </dl>
                    </section>
                </div>
            </div>
        </Dialog>
    );
}

interface Row_ {
    panel: number;
    name: string;
    asked: number;
    reached: number;
    mouth: number;
    residual: number;
    force: number;
}
const columns: { key: keyof Row_; title: string; digits: number }[] = [
    { key: "name", title: "Panel", digits: 0 }, { key: "asked", title: "λ asked", digits: 3 }, { key: "reached", title: "λ reached", digits: 3 },
    { key: "mouth", title: "Mouth °", digits: 1 }, { key: "residual", title: "Residual %", digits: 3 }, { key: "force", title: "Force N", digits: 1 },
];

/** The twin of the canvas: every panel with its figures, selectable by keyboard. Rows outside the window are not made. */
export function TableDialog() {
    revision.value;
    const shell = currentShell();
    const sort = useSignal<{ key: keyof Row_; down: boolean }>({ key: "name", down: false });
    const scroll = useSignal(0);
    const search = useSignal("");
    const wrap = useRef<HTMLDivElement>(null);
    const rows = useMemo(() => {
        if (!shell) return [];
        const out: Row_[] = [];
        for (let t = 0; t < shell.linkage.panels; t++) {
            let mouth = NaN;
            let force = NaN;
            for (let k = 0; k < 3; k++) {
                const m = shell.mouth[shell.linkage.triangles[3 * t + k]] * (180 / Math.PI);
                if (!(m >= mouth)) mouth = Number.isNaN(m) ? mouth : m;
                if (shell.forces && !(Math.abs(shell.forces[3 * t + k]) <= Math.abs(force))) force = shell.forces[3 * t + k];
            }
            out.push({ panel: t, name: shell.name(t), asked: shell.prescribed[t], reached: shell.realised[t], mouth, residual: 100 * shell.residual[t], force });
        }
        const { key, down } = sort.value;
        const collator = new Intl.Collator("en", { numeric: true });
        out.sort((a, b) => (key === "name" ? collator.compare(a.name, b.name) : ((Number.isNaN(a[key] as number) ? Infinity : (a[key] as number)) - (Number.isNaN(b[key] as number) ? Infinity : (b[key] as number)))) * (down ? -1 : 1));
        const wanted = search.value.trim().toUpperCase();
        return wanted ? out.filter((r) => r.name.startsWith(wanted)) : out;
    }, [shell?.revision, shell?.topology, sort.value, search.value]);
    const height = 32;
    const first = Math.max(0, Math.floor(scroll.value / height) - 10);
    const window_ = rows.slice(first, first + 50);
    return (
        <Dialog title="Panels" size="middle-size" onClose={close} footer={<span class="grow small">{number(rows.length, 0)} panels, {number(selected.value.size, 0)} selected</span>}>
            <div style={{ display: "grid", gridTemplateRows: "auto minmax(0, 1fr)", height: "min(640px, 70vh)" }}>
                <div style={{ padding: "12px 24px" }}><div class="field"><input type="search" aria-label="Find a panel by name" placeholder="Find a panel: C14" value={search.value} onInput={(e) => (search.value = e.currentTarget.value)} /></div></div>
                <div class="table-wrap" ref={wrap} tabIndex={0} role="region" aria-label="Panels" onScroll={(e) => (scroll.value = e.currentTarget.scrollTop)}>
                    <table class="panel-table" aria-rowcount={rows.length + 1}>
                        <thead>
                            <tr>
                                {columns.map((c) => (
                                    <th key={c.key} scope="col" aria-sort={sort.value.key === c.key ? (sort.value.down ? "descending" : "ascending") : "none"}>
                                        <button type="button" onClick={() => (sort.value = { key: c.key, down: sort.value.key === c.key && !sort.value.down })}>{c.title}{sort.value.key === c.key ? (sort.value.down ? " ↓" : " ↑") : ""}</button>
                                    </th>
                                ))}
                            </tr>
                        </thead>
                        <tbody>
                            {first > 0 && <tr aria-hidden="true" style={{ height: `${first * height}px` }}><td colSpan={6} /></tr>}
                            {window_.map((r, k) => (
                                <tr key={r.panel} aria-rowindex={first + k + 2} aria-selected={selected.value.has(r.panel)} style={{ height: `${height}px` }}>
                                    <td><button type="button" aria-pressed={selected.value.has(r.panel)} onClick={(e) => {
                                        select([r.panel], e.shiftKey || e.ctrlKey ? (selected.value.has(r.panel) ? "remove" : "add") : "replace");
                                        show({ triangle: r.panel, hinge: -1 });
                                    }}>{r.name}</button></td>
                                    {columns.slice(1).map((c) => <td key={c.key}>{number(r[c.key] as number, c.digits)}</td>)}
                                </tr>
                            ))}
                            {first + 50 < rows.length && <tr aria-hidden="true" style={{ height: `${(rows.length - first - 50) * height}px` }}><td colSpan={6} /></tr>}
                        </tbody>
                    </table>
                </div>
            </div>
        </Dialog>
    );
}
