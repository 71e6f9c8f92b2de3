// The views: canvas, titles, presets, divider, legend, scale bar and axes; pointer and wheel go to navigation or to the tool.
import { effect, useSignal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import * as THREE from "three";
import { niceBelow } from "../panels/colour";
import { boundsOf } from "../panels/linkage";
import { bindScene } from "../scene/binding";
import type { Preset } from "../scene/camera";
import { type Gesture, gestureOf, wheelOf } from "../scene/navigation";
import { type Rect, Stage, type View, type ViewId } from "../scene/stage";
import { division, layout, narrow, navigation } from "../state/settings";
import { hovered, hoveredHinge } from "../state/selection";
import { currentShell, documentState, making, revision, topology } from "../state/session";
import { dialog, mode, stage as stageSignal } from "../state/view";
import { handMoved } from "../state/latency";
import { motion } from "../state/motion";
import { tool } from "../tools";
import { type Hit, pointer } from "../tools/tool";
import { Segments, Tool } from "./controls";
import { type LengthUnit, count, extent, length } from "./format";
import { Legend } from "./legend";
import { AnalyseFields } from "./analyse";

/** Where the views lie, for a layout and the size of their place. */
function rectsFor(width: number, height: number): Partial<Record<ViewId, Rect>> {
    const whole = { x: 0, y: 0, width, height };
    const chosen = mode.value === "analyse" ? "deployed" : layout.value;
    if (chosen === "flat") return { flat: whole };
    if (chosen === "deployed" || narrow.value) return { deployed: whole };
    if (chosen === "both") {
        const x = Math.round(width * division.value);
        return { flat: { ...whole, width: x }, deployed: { ...whole, x: x + 1, width: width - x - 1 } };
    }
    const w = Math.floor(width / 2);
    const h = Math.floor(height / 2);
    return {
        flat: { x: 0, y: 0, width: w, height: h }, deployed: { x: w + 1, y: 0, width: width - w - 1, height: h },
        top: { x: 0, y: h + 1, width: w, height: height - h - 1 }, front: { x: w + 1, y: h + 1, width: width - w - 1, height: height - h - 1 },
    };
}

const titles: Record<ViewId, string> = { flat: "Flat", deployed: "Deployed", top: "Top", front: "Front" };

export function Views() {
    const place = useRef<HTMLDivElement>(null);
    const canvas = useRef<HTMLCanvasElement>(null);
    const quick = useRef<HTMLCanvasElement>(null);
    const ground = useRef<HTMLCanvasElement>(null);
    const apart = useRef<HTMLCanvasElement>(null);
    const overlay = useRef<HTMLCanvasElement>(null);
    const rects = useSignal<Partial<Record<ViewId, Rect>>>({});
    const size = useSignal({ width: 0, height: 0 });
    const failed = useSignal("");

    useLayoutEffect(() => {
        let stage: Stage;
        try {
            stage = new Stage({ canvas: canvas.current!, ground: ground.current!, quick: quick.current!, apart: apart.current!, overlay: overlay.current! });
        } catch {
            failed.value = "This browser has no WebGL 2, which the views need. Switch it on, or use another browser.";
            return;
        }
        stageSignal.value = stage;
        const unbind = bindScene(stage);
        const observer = new ResizeObserver(([entry]) => {
            const { width, height } = entry.contentRect;
            size.value = { width: Math.floor(width), height: Math.floor(height) };
        });
        observer.observe(place.current!);
        const stop = effect(() => {
            const { width, height } = size.value;
            if (width < 1) return;
            rects.value = rectsFor(width, height);
            stage.resize(width, height);
            stage.arrange(rects.value);
        });
        const leave = pointerEvents(place.current!, stage);
        return () => {
            leave();
            stop();
            observer.disconnect();
            unbind();
            stageSignal.value = null;
            stage.dispose();
        };
    }, []);

    const ids = Object.keys(rects.value) as ViewId[];
    return (
        <div class="views" ref={place} role="region" aria-label="Views" style={{ cursor: tool.value.cursor }}>
            {ids.map((id) => <div key={id} class="view-ground" style={box(rects.value[id]!)} />)}
            <canvas ref={canvas} aria-hidden="true" />
            <canvas ref={ground} class="over" aria-hidden="true" hidden />
            <canvas ref={quick} class="over" aria-hidden="true" hidden />
            <canvas ref={apart} class="over" aria-hidden="true" hidden />
            <canvas ref={overlay} class="over" aria-hidden="true" />
            {ids.map((id) => <ViewFrame key={id} id={id} rect={rects.value[id]!} many={ids.length > 1} />)}
            {ids.includes("flat") && ids.includes("deployed") && ids.length === 2 && <Divider width={size.value.width} />}
            <CursorTag />
            {failed.value && <p class="note bad banner" role="alert">{failed.value}</p>}
            <p class="hidden-text">
                The views show the shell as a picture. <button type="button" onClick={() => (dialog.value = "table")}>Open the panel table</button> for the same as text.
            </p>
        </div>
    );
}

const box = (r: Rect) => ({ left: `${r.x}px`, top: `${r.y}px`, width: `${r.width}px`, height: `${r.height}px` });

function ViewFrame({ id, rect, many }: { id: ViewId; rect: Rect; many: boolean }) {
    const stage = stageSignal.value;
    const view = stage?.views[id];
    const toggle = () => {
        if (mode.value === "analyse") return;
        layout.value = many ? (id === "flat" ? "flat" : "deployed") : "both";
        if (many && (id === "top" || id === "front")) stage?.views.deployed.usePreset(id);
    };
    return (
        <div class="view-frame" style={box(rect)}>
            <div class="view-title" onDblClick={toggle}><ViewTitle id={id} short={rect.width < (mode.value === "analyse" ? 760 : id === "deployed" ? 520 : 260)} /></div>
            <div class="view-tools">
                {id === "deployed" && mode.value === "analyse" && <AnalyseFields />}
                {id === "deployed" && mode.value !== "analyse" && rect.width > 520 && view && <Presets view={view} />}
                {mode.value !== "analyse" && <Tool icon={many ? "expand" : "shrink"} name={many ? `Only ${titles[id].toLowerCase()}` : "Both views"} small onClick={toggle} />}
            </div>
            {(id === "flat" || (id === "deployed" && (!many || narrow.value))) && <Legend compact={rect.height < 420 || rect.width < 340} />}
            {id === "deployed" && mode.value === "analyse" && <ForceKey />}
            {view && <ScaleBar view={view} hidden={id === "deployed"} />}
            {id === "deployed" && view && <Axes view={view} />}
        </div>
    );
}

function ViewTitle({ id, short }: { id: ViewId; short: boolean }) {
    revision.value;
    topology.value;
    const shell = currentShell();
    if (!shell || !shell.deployed.length) return <b>{titles[id]}</b>;
    const unit = (documentState.value?.unit ?? "m") as LengthUnit;
    const flat = id === "flat";
    const { shown, frames } = motion.value;
    const b = boundsOf(flat ? shell.flat : (shown !== null && frames[shown]) || (shell.simulated ?? shell.deployed));
    const name = flat ? "Flat" : id !== "deployed" ? titles[id] : shown !== null ? "On the way" : mode.value === "analyse" && shell.simulated ? "Simulated" : "Deployed";
    return (
        <>
            <b>{name}</b>
            {!short && <span>{flat || mode.value === "analyse" ? `${count(shell.linkage.panels)} panels, ` : ""}{id === "front" ? extent([b.min[0], b.min[2]], [b.max[0], b.max[2]], 2, unit) : extent(b.min, b.max, flat || id === "top" ? 2 : 3, unit)}</span>}
        </>
    );
}

/** What the cones and arrows stand for. */
function ForceKey() {
    revision.value;
    const shell = currentShell();
    if (!shell?.supports.some((s) => s === 1)) return null;
    let largest = 0;
    const r = shell.reactions;
    if (r) for (let k = 0; k < r.length; k += 3) largest = Math.max(largest, Math.hypot(r[k], r[k + 1], r[k + 2]));
    return (
        <div class="force-key float">
            <span><svg width="16" height="12" viewBox="0 0 16 12" aria-hidden="true"><path d="M8 1l5 10H3z" fill="currentColor" /></svg>Support</span>
            {r && <span><svg width="16" height="12" viewBox="0 0 16 12" aria-hidden="true"><path d="M0 6h11M10 2.5l6 3.5-6 3.5z" fill="currentColor" stroke="currentColor" /></svg>Reaction, 0 to {count(largest)} N</span>}
        </div>
    );
}

function Presets({ view }: { view: View }) {
    const at = useSignal<Preset | "">(view.orbit.preset ?? "");
    useEffect(() => {
        const stage = stageSignal.value!;
        const look = (v: View) => {
            if (v === view && at.peek() !== (v.orbit.preset ?? "")) at.value = v.orbit.preset ?? "";
        };
        stage.drawn.add(look);
        return () => void stage.drawn.delete(look);
    }, [view]);
    return (
        <Segments<string> name="View preset" floating value={at.value} options={[
            { value: "perspective", title: "Perspective" }, { value: "top", title: "Top" }, { value: "front", title: "Front" }, { value: "right", title: "Right" },
        ]} onChange={(p) => stageSignal.value?.usePreset(view, p as Preset)} />
    );
}

function ScaleBar({ view, hidden }: { view: View; hidden: boolean }) {
    const bar = useRef<HTMLDivElement>(null);
    useEffect(() => {
        const stage = stageSignal.value!;
        const update = (v: View) => {
            if (v !== view || !bar.current) return;
            const units = (v.orbit.halfHeight * 2) / Math.max(1, v.rect.height);
            const size = niceBelow(Math.min(150, v.rect.width / 5) * units);
            const [text, line] = [bar.current.firstElementChild as HTMLElement, bar.current.lastElementChild as HTMLElement];
            text.textContent = length(size, (documentState.value?.unit ?? "m") as LengthUnit).replace(/\.0+ /, " ");
            line.style.width = `${size / units}px`;
        };
        stage.drawn.add(update);
        stage.invalidate();
        return () => void stage.drawn.delete(update);
    }, [view]);
    return hidden ? null : <div class="scale-bar" ref={bar} aria-hidden="true"><span /><i /></div>;
}

function Axes({ view }: { view: View }) {
    const mark = useRef<SVGSVGElement>(null);
    useEffect(() => {
        const stage = stageSignal.value!;
        const directions = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 1, 0), new THREE.Vector3(0, 0, 1)];
        const update = (v: View) => {
            if (v !== view || !mark.current) return;
            const turn = v.orbit.camera.quaternion.clone().invert();
            directions.forEach((d, k) => {
                const p = d.clone().applyQuaternion(turn);
                const group = mark.current!.children[k];
                const [line, text] = [group.children[0], group.children[1]];
                line.setAttribute("x2", String(36 + 21 * p.x));
                line.setAttribute("y2", String(42 - 21 * p.y));
                text.setAttribute("x", String(36 + 29 * p.x));
                text.setAttribute("y", String(46 - 29 * p.y));
            });
        };
        stage.drawn.add(update);
        stage.invalidate();
        return () => void stage.drawn.delete(update);
    }, [view]);
    return (
        <svg class="axes" ref={mark} viewBox="0 0 72 72" aria-hidden="true">
            {["x", "y", "z"].map((a) => (
                <g key={a} stroke={`var(--axis-${a})`} fill={`var(--axis-${a})`}>
                    <line x1="36" y1="42" x2="36" y2="42" stroke-width="1.5" stroke-linecap="round" />
                    <text text-anchor="middle" stroke="none">{a.toUpperCase()}</text>
                </g>
            ))}
        </svg>
    );
}

function Divider({ width }: { width: number }) {
    const share = division.value;
    const move = (event: PointerEvent) => {
        if (!(event.currentTarget as HTMLElement).hasPointerCapture(event.pointerId)) return;
        const left = (event.currentTarget as HTMLElement).parentElement!.getBoundingClientRect().left;
        division.value = Math.max(0.15, Math.min(0.85, (event.clientX - left) / width));
    };
    const keys = (event: KeyboardEvent) => {
        const d = event.key === "ArrowLeft" ? -0.02 : event.key === "ArrowRight" ? 0.02 : 0;
        if (!d) return;
        event.stopPropagation();
        division.value = Math.max(0.15, Math.min(0.85, division.value + d));
    };
    return (
        <div class="divider" role="separator" tabIndex={0} aria-orientation="vertical" aria-label="Between the views" aria-valuenow={Math.round(100 * share)}
            style={{ left: `${Math.round(share * width)}px` }} onDblClick={() => (division.value = 0.4)} onKeyDown={keys}
            onPointerDown={(e) => (e.stopPropagation(), e.currentTarget.setPointerCapture(e.pointerId))} onPointerMove={move} />
    );
}

/** Words beside the cursor: outside the ring, inside the view. */
function CursorTag() {
    const box_ = useRef<HTMLDivElement>(null);
    const hit = pointer.value;
    const words = hit && tool.value.tag ? tool.value.tag(hit) : null;
    const size = useRef({ letters: 0, width: 0, height: 0 });
    useLayoutEffect(() => {
        const e = box_.current;
        if (!e || !hit) return;
        const letters = e.textContent!.length;
        if (letters !== size.current.letters) size.current = { letters, width: e.offsetWidth, height: e.offsetHeight }; // which lays out the page
        const { width, height } = size.current;
        const { rect } = hit.view;
        const x = Math.max(rect.x + 4, Math.min(rect.x + rect.width - width - 4, hit.x - width / 2));
        const above = hit.y - tagDistance(hit) - height;
        const y = above < rect.y + 4 ? hit.y + tagDistance(hit) : above;
        e.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
    });
    return words ? <div class="tag" ref={box_} aria-hidden="true"><b>{words.strong}</b> {words.rest}</div> : null;
}

function tagDistance(hit: Hit): number {
    if (tool.value.id !== "brush") return 16;
    return 12 + hit.view.orbit.pixels(tool.value.reach?.() ?? 0, hit.view.rect.height);
}

/** A finger that moves less clicks; pixels. */
const tapReach = 8;

/** Presses, drags and wheels on the views. Returns what takes them off again. */
function pointerEvents(place: HTMLElement, stage: Stage): () => void {
    let gesture: { kind: Gesture | "tool"; view: View; x: number; y: number; id: number } | null = null;
    /** A finger that turns the view would have been a click, had it not moved. */
    let tap: PointerEvent | null = null;
    const touches = new Map<number, { x: number; y: number }>();
    let corner = place.getBoundingClientRect();
    const local = (event: { clientX: number; clientY: number }) => {
        if (!gesture) corner = place.getBoundingClientRect(); // which may lay out the page
        return { x: event.clientX - corner.left, y: event.clientY - corner.top };
    };
    const hitOf = (event: PointerEvent, view: View, double = false): Hit => {
        const { x, y } = local(event);
        const on = stage.pick(view, x, y);
        const skin = stage.skins?.[view.state];
        return {
            stage, view, x, y, on, panel: on && skin ? skin.panelAt(on) : -1, shift: event.shiftKey, control: event.ctrlKey || event.metaKey,
            alt: event.altKey, pressure: event.pressure, double,
        };
    };
    const hover = (hit: Hit) => {
        pointer.value = hit;
        hovered.value = hit.panel;
        const skin = stage.skins?.[hit.view.state];
        hoveredHinge.value = hit.on && skin ? skin.hingeAt(hit.on) : -1;
    };
    const onControl = (event: Event) => (event.target as HTMLElement).closest("button, select, input, .legend, .divider, .banner") !== null;
    let lastDown = 0;
    const down = (event: PointerEvent) => {
        if (onControl(event)) return;
        const at = local(event);
        const view = stage.viewAt(at.x, at.y);
        if (!view) return;
        (document.activeElement as HTMLElement | null)?.blur();
        if (event.pointerType === "touch") {
            touches.set(event.pointerId, at);
            if (touches.size === 2) {
                if (gesture?.kind === "tool") tool.value.cancel?.();
                tap = null;
                gesture = { kind: "pan", view, ...at, id: event.pointerId };
                return;
            }
        }
        const planar = view.state === "flat" || (view.orbit.pose.projection === "parallel" && view.orbit.preset !== null);
        const turns = event.pointerType === "touch" && (tool.value.id === "select" || making.value || !stage.pick(view, at.x, at.y));
        const kind = turns ? (planar ? "pan" : "orbit") : gestureOf(navigation.value, event, planar);
        place.setPointerCapture(event.pointerId);
        stage.hold(true);
        tap = turns ? event : null;
        if (kind) gesture = { kind, view, ...at, id: event.pointerId };
        else if (event.button === 0 && !making.value) {
            const double = event.timeStamp - lastDown < 350;
            lastDown = event.timeStamp;
            const hit = hitOf(event, view, double);
            hover(hit);
            handMoved(event.timeStamp);
            if (tool.value.down?.(hit)) gesture = { kind: "tool", view, ...at, id: event.pointerId };
        }
        event.preventDefault();
    };
    const move = (event: PointerEvent) => {
        const at = local(event);
        if (event.pointerType === "touch" && touches.has(event.pointerId)) {
            const before = [...touches.values()];
            touches.set(event.pointerId, at);
            const after = [...touches.values()];
            if (before.length === 2 && gesture) {
                const spread = (p: typeof before) => Math.hypot(p[0].x - p[1].x, p[0].y - p[1].y);
                const middle = (p: typeof before) => ({ x: (p[0].x + p[1].x) / 2, y: (p[0].y + p[1].y) / 2 });
                const [a, b] = [middle(before), middle(after)];
                const { orbit, rect } = gesture.view;
                orbit.pan(b.x - a.x, b.y - a.y, rect.height);
                orbit.zoom(spread(before) / Math.max(1, spread(after)), (2 * (b.x - rect.x)) / rect.width - 1, 1 - (2 * (b.y - rect.y)) / rect.height);
                stage.invalidate();
                return;
            }
        }
        if (gesture && gesture.kind !== "tool") {
            const [dx, dy] = [at.x - gesture.x, at.y - gesture.y];
            if (tap && Math.hypot(dx, dy) < tapReach) return;
            tap = null;
            const { orbit, rect } = gesture.view;
            if (gesture.kind === "orbit") orbit.orbit(dx, dy);
            else if (gesture.kind === "pan") orbit.pan(dx, dy, rect.height);
            else orbit.zoom(Math.exp(dy * 0.006), 0, 0);
            Object.assign(gesture, at);
            stage.invalidate();
            return;
        }
        const view = gesture?.view ?? stage.viewAt(at.x, at.y);
        if (!view || (!gesture && onControl(event))) {
            if (pointer.value) leave();
            return;
        }
        if (gesture) {
            if (!hearsAll) work(event);
            stage.follow(() => hover(hitOf(event, view)));
            return;
        }
        const hit = hitOf(event, view);
        hover(hit);
        tool.value.move?.(hit, false);
        stage.invalidateOverlay();
    };
    // while a tool is at work it hears of movements at once, where the browser tells of them before the next frame
    const hearsAll = "onpointerrawupdate" in place;
    const work = (event: PointerEvent) => {
        if (gesture?.kind !== "tool") return;
        handMoved(event.timeStamp);
        // browsers gather what moved meanwhile; a stroke wants every place
        const events = event.getCoalescedEvents?.() ?? [];
        for (const e of events.length ? events.slice(-6) : [event]) tool.value.move?.(hitOf(e, gesture.view), true);
    };
    const up = (event: PointerEvent) => {
        touches.delete(event.pointerId);
        const ended = gesture;
        gesture = null;
        stage.hold(false);
        if (ended?.kind === "tool") tool.value.up?.(hitOf(event, ended.view));
        else if (tap && ended && !making.value) {
            const hit = hitOf(event, ended.view);
            if (tool.value.down?.(hit)) tool.value.up?.(hit);
        }
        tap = null;
        // the finger that stays goes on where it is
        const [id] = touches.keys();
        if (touches.size === 1 && ended) gesture = { kind: ended.view.state === "flat" ? "pan" : "orbit", view: ended.view, ...touches.get(id)!, id };
    };
    const lost = (event: PointerEvent) => {
        touches.delete(event.pointerId);
        if (gesture?.kind === "tool") tool.value.cancel?.();
        gesture = tap = null;
        stage.hold(false);
    };
    const leave = () => {
        if (gesture) return;
        pointer.value = null;
        hovered.value = -1;
        hoveredHinge.value = -1;
        tool.value.leave?.();
        stage.invalidateOverlay();
    };
    const wheel = (event: WheelEvent) => {
        if (onControl(event) && (event.target as HTMLElement).closest("select")) return;
        event.preventDefault();
        const { x, y } = local(event);
        const view = stage.viewAt(x, y);
        if (!view) return;
        const { orbit, rect } = view;
        const unit = event.deltaMode === 1 ? 16 : 1;
        switch (wheelOf(navigation.value, event, view.state === "flat")) {
            case "pan":
                orbit.pan(-event.deltaX * unit, -event.deltaY * unit, rect.height);
                break;
            case "orbit":
                orbit.orbit(-event.deltaX * unit * 0.7, -event.deltaY * unit * 0.7);
                break;
            default:
                orbit.zoom(Math.exp(Math.max(-80, Math.min(80, event.deltaY * unit)) * 0.0025), (2 * (x - rect.x)) / rect.width - 1, 1 - (2 * (y - rect.y)) / rect.height);
        }
        stage.invalidate();
    };
    const menu = (event: Event) => event.preventDefault();
    const events: [string, (event: never) => void, AddEventListenerOptions?][] = [
        ["pointerdown", down], ["pointermove", move], ["pointerrawupdate", work], ["pointerup", up], ["pointercancel", lost], ["pointerleave", leave],
        ["wheel", wheel, { passive: false }], ["contextmenu", menu],
    ];
    for (const [name, listener, options] of events) place.addEventListener(name, listener as EventListener, options);
    return () => {
        for (const [name, listener] of events) place.removeEventListener(name, listener as EventListener);
    };
}
