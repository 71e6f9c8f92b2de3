// Start: from an outline, from a surface, from what there is.
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { FolderEntry } from "../protocol/types";
import { ask, command, documentState, hello, operatorNamed, problem } from "../state/session";
import { dialog, page } from "../state/view";
import { colourOf, tide } from "../panels/colour";
import { callOf, argumentsOf, resetArguments, setArgument } from "../tools/calls";
import { ThemeButton } from "./bar";
import { Button, Dialog, Tool } from "./controls";
import { time } from "./format";
import { Icon, Mark, type IconName } from "./icons";
import { OperatorForm } from "./operatorform";
import { takeFile } from "./surface";

const outlines: { op: string; title: string; icon: IconName; given: Record<string, unknown> }[] = [
    { op: "start_circle", title: "Circle", icon: "circle", given: { radius: 5 } },
    { op: "start_rectangle", title: "Rectangle", icon: "rectangle", given: { width: 10, height: 7 } },
    { op: "start_polygon", title: "Polygon", icon: "polygon", given: { sides: 6, radius: 5 } },
];

export function StartPage() {
    const recent = useSignal<FolderEntry[]>([]);
    const outline = useSignal<string | null>(null);
    const over = useSignal(false);
    const chooser = useRef<HTMLInputElement>(null);
    const curve = useRef<HTMLInputElement>(null);
    useEffect(() => {
        ask("files").then((a) => (recent.value = (a.files as FolderEntry[]).filter((f) => !f.folder && f.name.endsWith(".auxshell")).sort((x, y) => y.time - x.time).slice(0, 5)), () => undefined);
    }, [hello.value]);
    const go = async (name: string, parameters: Record<string, unknown>) => {
        if (await command(name, parameters)) page.value = "work";
    };
    const recovered = (hello.value?.recovered ?? []).filter((r) => r.name !== documentState.value?.id);
    return (
        <div class="start-page">
            <header class="bar">
                <div class="start"><span class="home" style={{ cursor: "default" }}><Mark /></span><span class="name" style={{ fontWeight: 600 }}>Auxshell Studio</span></div>
                <div class="end">
                    <ThemeButton />
                    <Tool icon="help" name="Keyboard shortcuts" shortcut="?" onClick={() => (dialog.value = "shortcuts")} />
                    {documentState.value && <Button onClick={() => (page.value = "work")}>Back to {documentState.value.name}</Button>}
                </div>
            </header>
            <main>
                <div class="spread" style={{ alignItems: "center" }}>
                    <h1>Start a shell</h1>
                    <Button icon="file" onClick={() => (dialog.value = "open")}>Open a design</Button>
                </div>
                {problem.value && <p class="note bad" role="alert"><Icon name="crossed" /><span class="grow">{problem.value.error.message}</span><Tool small icon="close" name="Dismiss" onClick={() => (problem.value = null)} /></p>}
                <div class="cards">
                    <section class="card" aria-labelledby="from-outline">
                        <div class="lead">
                            <div><h2 id="from-outline">From an outline</h2><p>An even linkage inside your outline. Paint it, then watch it rise.</p></div>
                            <Kagome />
                        </div>
                        <div class="row wrap" style={{ marginTop: "12px" }}>
                            {outlines.map((o) => <Button key={o.op} icon={o.icon} disabled={!operatorNamed(o.op)} onClick={() => {
                                resetArguments(o.op);
                                for (const [k, v] of Object.entries(o.given)) setArgument(o.op, k, v);
                                outline.value = o.op;
                            }}>{o.title}</Button>)}
                            <Button icon="rim" disabled={!operatorNamed("start_curve")} onClick={() => curve.current?.click()}>Import a curve</Button>
                            <input ref={curve} type="file" hidden accept=".svg,.dxf" aria-label="Curve file" onChange={(e) => e.currentTarget.files?.[0] && void takeFile(e.currentTarget.files[0])} />
                        </div>
                    </section>
                    <section class={`card drop${over.value ? " over" : ""}`} aria-labelledby="from-surface" onDragOver={() => (over.value = true)} onDragLeave={() => (over.value = false)} onDrop={() => (over.value = false)}>
                        <div class="lead">
                            <div><h2 id="from-surface">From a target surface</h2><p>Drop a mesh here. You see at once whether it can deploy.</p></div>
                            <Dome />
                        </div>
                        <div class="row wrap" style={{ marginTop: "12px" }}>
                            <Button primary icon="export" onClick={() => chooser.current?.click()}>Choose a file</Button>
                            <span class="small muted">OBJ, STL, PLY, GLB</span>
                            <input ref={chooser} type="file" hidden accept=".obj,.stl,.ply,.off,.glb,.gltf" aria-label="Mesh file" onChange={(e) => e.currentTarget.files?.[0] && void takeFile(e.currentTarget.files[0])} />
                        </div>
                    </section>
                    <section class="card" aria-labelledby="recent">
                        <h2 id="recent">Recent</h2>
                        <div class="recent">
                            {recovered.map((r) => <button key={r.name} type="button" onClick={() => void go("open", { recovered: r.name })}><Icon name="restart" size={16} /><span class="ellipsis">{r.title ?? r.name}</span><span class="when">Recovered, {time(r.time)}</span></button>)}
                            {recent.value.map((f) => <button key={f.name} type="button" onClick={() => void go("open", { path: f.name })}><Icon name="file" size={16} /><span class="ellipsis">{f.name.replace(/\.auxshell$/, "")}</span><span class="when">{time(f.time)}</span></button>)}
                        </div>
                        {recent.value.length + recovered.length === 0 && <p class="muted">Designs that you save in {hello.value?.folder ?? "the folder"} are listed here.</p>}
                    </section>
                </div>
                {hello.value && hello.value.examples.length > 0 && (
                    <>
                        <div class="row" style={{ alignItems: "baseline", marginTop: "8px" }}><h2>Examples</h2><span class="muted">Open one and change anything.</span></div>
                        <div class="examples">
                            {hello.value.examples.map((e) => (
                                <button key={e.name} type="button" class="example" onClick={() => void go("new", { example: e.name })}>
                                    <div class="picture"><ExamplePicture name={e.name} /></div>
                                    <div class="words"><b>{e.title}</b><small title={e.doc}>{e.doc.replace(/^[^:.]{3,30}: /, "").replace(/^./, (c) => c.toUpperCase())}</small></div>
                                </button>
                            ))}
                        </div>
                    </>
                )}
            </main>
            {outline.value && <OutlineDialog op={outline.value} onClose={() => (outline.value = null)} onStart={(call, name) => void go("new", { recipe: [call], name })} />}
        </div>
    );
}

function ExamplePicture({ name }: { name: string }) {
    const missing = useSignal(false);
    return missing.value ? null : <img src={`./examples/${name}.webp`} alt="" loading="lazy" onError={() => (missing.value = true)} />;
}

function OutlineDialog({ op, onClose, onStart }: { op: string; onClose(): void; onStart(call: Record<string, unknown>, name: string): void }) {
    const schema = operatorNamed(op)!;
    const title = outlines.find((o) => o.op === op)?.title ?? schema.title;
    return (
        <Dialog title={schema.title} onClose={onClose} footer={<><Button onClick={onClose}>Cancel</Button><Button primary onClick={() => onStart(callOf(schema, {}), title)}>Start</Button></>}>
            <div class="body"><OperatorForm schema={schema} args={argumentsOf(op)} onChange={(name, value) => setArgument(op, name, value)} /></div>
        </Dialog>
    );
}

/** A disc of the flat linkage: triangles of two senses, turned against each other about the lattice they came from. */
function Kagome() {
    const side = 5.6;
    const panels: { path: string; colour: string }[] = [];
    const place = (i: number, j: number) => [43 + side * (i + j / 2), 43 + side * j * 0.866] as const;
    const add = (corners: [number, number][], sense: number) => {
        const p = corners.map(([i, j]) => place(i, j));
        const [x, y] = [0, 1].map((k) => p.reduce((s, q) => s + q[k], 0) / 3);
        const away = Math.hypot(x - 43, y - 43);
        if (away > 37) return;
        const [c, s] = [0.86 * Math.cos(0.5), 0.86 * Math.sin(0.5) * sense];
        const turned = p.map(([u, v]) => `${(x + c * (u - x) - s * (v - y)).toFixed(1)} ${(y + s * (u - x) + c * (v - y)).toFixed(1)}`);
        const [r, g, b] = colourOf({ map: tide, lo: 0, hi: 1 }, 0.7 * Math.exp(-((away / 28) ** 2)) + 0.15);
        panels.push({ path: `M${turned.join("L")}z`, colour: `rgb(${r} ${g} ${b})` });
    };
    for (let j = -10; j <= 10; j += 2)
        for (let i = -14; i <= 14; i += 2) {
            add([[i, j], [i + 1, j], [i, j + 1]], 1);
            add([[i, j - 1], [i, j], [i - 1, j]], -1);
        }
    return (
        <svg width="86" height="86" viewBox="0 0 86 86" aria-hidden="true">
            <circle cx="43" cy="43" r="42" fill="none" stroke="currentColor" stroke-dasharray="3 3" />
            {panels.map((p) => <path key={p.path} d={p.path} fill={p.colour} />)}
        </svg>
    );
}

function Dome() {
    const rings = [0, 0.2, 0.4, 0.6, 0.8, 0.95].map((t) => ({ r: 60 * Math.sqrt(1 - t * t), y: 66 - 54 * t }));
    return (
        <svg width="132" height="86" viewBox="0 0 132 86" fill="none" stroke="currentColor" aria-hidden="true">
            {rings.map(({ r, y }) => <ellipse key={y} cx="66" cy={y} rx={r} ry={r * 0.22} />)}
            {[-1, -0.66, -0.33, 0, 0.33, 0.66, 1].map((t) => <path key={t} d={`M${66 + 60 * t} ${66 + 13 * Math.sqrt(1 - t * t)}Q${66 + 52 * t} 12 66 12`} />)}
        </svg>
    );
}
