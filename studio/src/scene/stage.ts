// The views: one canvas under all of them, drawn only when something changed. Two scenes (flat, space) are shown by up to four
// cameras. Everything over the shell (rings, handles, measures) is drawn on a plain canvas above by whoever registers for it, and
// can be drawn anew without the scenes.
//
// One picture at a time is with the renderer, and the next is of whatever is newest then: a slow renderer shows fewer pictures, not
// older ones. If whole pictures take it too long, panels that move are drawn without it, on a canvas of their own over its ground:
// while the cameras rest by a worker, as states come in; else here. Once nothing has changed for a moment a better picture follows, then
// the whole one.
import * as THREE from "three";
import { type Picture, type Window, clear, makePicture } from "../panels/raster";
import type { Shell } from "../panels/shell";
import { type Detail, detailFor } from "../panels/template";
import type { Stamp } from "../state/latency";
import { OrbitCamera, type Pose, type Preset, presets, radiusOf } from "./camera";
import { Live, type LiveScene, type Watch } from "./live";
import { type Look, light } from "./look";
import type { PanelMesh } from "./panelmesh";
import { ShellScene } from "./shellscene";
import { Skin, type SkinPoint } from "./skin";

export type ViewId = "flat" | "deployed" | "top" | "front";
export type StateId = "flat" | "space";
export interface Rect {
    x: number;
    y: number;
    width: number;
    height: number;
}

export class View {
    readonly orbit = new OrbitCamera();
    rect: Rect = { x: 0, y: 0, width: 0, height: 0 };
    detail: Detail = "full";

    constructor(readonly id: ViewId, readonly state: StateId, preset: Preset) {
        this.usePreset(preset);
    }

    usePreset(preset: Preset): void {
        this.orbit.preset = preset;
        Object.assign(this.orbit.pose, presets[preset]);
    }
}

/** A whole picture may take this long, milliseconds. */
const wholeLimit = 40;
/** While a hand works on a slow renderer the page itself follows at this pace: every frame of it delays the hand, and the states that
 *  are on their way. */
const pace = 50;
/** What must not have changed for this long before a better picture is drawn, and before the whole one. */
const rests = [250, 1500];

/** How much goes into a picture: what moves on a slow renderer; its first picture at rest, without bevels and joints; everything. */
type Effort = "quick" | "plain" | "whole";

type QuickPicture = Picture & { image: ImageData; context: CanvasRenderingContext2D };

/** One over the other and equally large. */
export interface Canvases {
    canvas: HTMLCanvasElement;
    /** A copy of what lies under quick panels. */
    ground: HTMLCanvasElement;
    /** Panels drawn without the renderer: here, and by a worker. */
    quick: HTMLCanvasElement;
    apart: HTMLCanvasElement;
    overlay: HTMLCanvasElement;
}

export type Overlay = (context: CanvasRenderingContext2D, stage: Stage) => void;
export type Drawn = (view: View) => void;

export class Stage {
    readonly views: Record<ViewId, View> = {
        flat: new View("flat", "flat", "top"),
        deployed: new View("deployed", "space", "perspective"),
        top: new View("top", "space", "top"),
        front: new View("front", "space", "front"),
    };
    shown: ViewId[] = ["flat", "deployed"];
    shell: Shell | null = null;
    skins: Record<StateId | "sheet", Skin> | null = null;
    scenes: Record<StateId, ShellScene> | null = null;
    readonly overlays = new Set<Overlay>();
    readonly drawn = new Set<Drawn>();
    /** A picture that was begun at that time is with the browser or the graphics card; what it returns is called when it is done. */
    onSubmitted: ((began: number) => () => void) | null = null;
    /** How states get to the worker that draws them as they come; null: there is no way. */
    watch: Watch | null = null;
    /** What it draws them in. */
    colouring: Pick<LiveScene, "field" | "lo" | "hi" | "map"> | null = null;
    onStamped: (stamps: Stamp[]) => void = () => undefined;
    /** Called before drawing: what is still to be told to the scenes. */
    onBefore: (() => void) | null = null;
    animated = true;
    /** A hand is at work: nothing better than what moves is drawn meanwhile. */
    private held = false;
    /** Whether a slow renderer draws better pictures at rest at all. */
    refines = true;
    /** Views that nobody has turned keep the shell in sight while it is made. */
    private following = false;
    readonly renderer: THREE.WebGLRenderer;
    readonly rendererName: string;
    /** No graphics card: smaller shadows. */
    private readonly frugal: boolean;

    private readonly context2d: CanvasRenderingContext2D;
    private look: Look = light;
    private request = 0;
    private restTimer: ReturnType<typeof setTimeout> | undefined;
    private dirtyShadows = false;
    private dirtyGround = false;
    private dirtyPlaces = false;
    /** Places of a motion's state that are shown instead of the shell's. */
    private override: Float32Array | undefined;
    private stale = false;
    private staleOverlay = false;
    private laterTimer: ReturnType<typeof setTimeout> | undefined;
    private followed: (() => void) | null = null;
    /** A picture is on its way to the screen. */
    private flying = false;
    /** When something was last to be drawn anew. */
    private changed = 0;
    private drawnWith: Effort = "whole";
    /** Whether the renderer had a part in the last picture. */
    private rendered = false;
    /** What the renderer's picture is made for if it is that under quick panels, and its copy; empty: it is not. */
    private backdrop = "";
    private copied = "";
    /** Copies so far. */
    private grounds = 0;
    /** States are about to come. */
    private expecting = false;
    private practised = false;
    private quickPicture: QuickPicture | null = null;
    private live: Live | null = null;
    /** Milliseconds that the last two whole pictures took: one alone may have had shaders to compile. */
    private wholeTimes: [number, number];
    private width = 0;
    private height = 0;

    readonly canvas: HTMLCanvasElement;

    constructor(private readonly canvases: Canvases) {
        const { canvas } = canvases;
        this.canvas = canvas;
        this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: false });
        this.renderer.toneMapping = THREE.NoToneMapping;
        this.renderer.outputColorSpace = THREE.SRGBColorSpace;
        this.renderer.shadowMap.enabled = true;
        this.renderer.shadowMap.type = THREE.PCFShadowMap;
        this.renderer.autoClear = false;
        const info = this.renderer.getContext().getExtension("WEBGL_debug_renderer_info");
        const name = info ? String(this.renderer.getContext().getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
        this.rendererName = name;
        this.frugal = /swiftshader|llvmpipe|software/i.test(name);
        this.wholeTimes = this.frugal ? [Infinity, Infinity] : [0, 0];
        this.context2d = canvases.overlay.getContext("2d")!;
    }

    resize(width: number, height: number): void {
        this.width = width;
        this.height = height;
        this.renderer.setPixelRatio(this.screenRatio);
        this.renderer.setSize(width, height, false);
        this.backdrop = this.copied = "";
        this.canvases.overlay.width = Math.round(width * this.screenRatio);
        this.canvases.overlay.height = Math.round(height * this.screenRatio);
        this.invalidate();
    }

    private get screenRatio(): number {
        return Math.min(2, window.devicePixelRatio || 1);
    }

    private get slow(): boolean {
        return Math.min(...this.wholeTimes) > wholeLimit;
    }

    /** The renderer is at a picture: a newer state could not be shown yet. */
    get rendering(): boolean {
        return this.flying && this.rendered;
    }

    /** Everything that was to be drawn has been, as well as it can be. */
    get atRest(): boolean {
        return !this.stale && !this.flying && !this.dirtyGround && (this.drawnWith === "whole" || !this.refines);
    }

    /** Places of the views within the canvas, and which are shown. */
    arrange(rects: Partial<Record<ViewId, Rect>>): void {
        this.shown = Object.keys(rects) as ViewId[];
        for (const id of this.shown) {
            const view = this.views[id];
            view.rect = rects[id]!;
            view.orbit.resize(view.rect.width, view.rect.height);
            if (!view.orbit.touched && this.scenes && view.rect.width > 0) this.frame(view, false);
        }
        this.invalidate();
    }

    setLook(look: Look): void {
        this.look = look;
        for (const scene of Object.values(this.scenes ?? {})) scene.setLook(look);
        this.dirtyGround = true;
        this.invalidateBackdrop();
    }

    /** A new linkage, or (null) none. */
    setShell(shell: Shell | null): void {
        const before = this.scenes;
        this.shell = shell;
        if (!shell) {
            this.scenes = this.skins = null;
        } else {
            const scenes = {
                flat: new ShellScene(shell.linkage, this.look, true, this.frugal),
                space: new ShellScene(shell.linkage, this.look, false, this.frugal),
            };
            this.scenes = scenes;
            this.override = undefined;
            this.placeShell();
            this.skins = {
                sheet: new Skin(shell.linkage, shell.sheet),
                flat: new Skin(shell.linkage, scenes.flat.panels.places),
                space: new Skin(shell.linkage, scenes.space.panels.places),
            };
            for (const view of Object.values(this.views)) {
                view.orbit.touched = false;
                if (view.rect.width > 0) this.frame(view, false);
            }
        }
        for (const scene of Object.values(before ?? {})) scene.dispose();
        this.dirtyShadows = this.dirtyGround = true;
        this.invalidateBackdrop();
    }

    /** The shell's places changed. `space` overrides the state in space: a frame of a motion. Only what is drawn is computed with. */
    setPlaces(space?: Float32Array): void {
        this.override = space;
        this.dirtyPlaces = true;
        this.invalidate();
    }

    private placeShell(): void {
        this.dirtyPlaces = false;
        if (!this.shell || !this.scenes) return;
        this.scenes.flat.setPlaces(this.shell.flat);
        this.scenes.space.setPlaces(this.override ?? this.shell.simulated ?? this.shell.deployed);
        this.skins?.flat.touch();
        this.skins?.space.touch();
        this.dirtyShadows = this.dirtyGround = true;
        if (this.following) this.keepInSight();
    }

    follows(making: boolean): void {
        if (this.following && !making) for (const view of this.seen) if (!view.orbit.touched) this.frame(view);
        this.following = making;
    }

    private keepInSight(): void {
        for (const view of this.seen) {
            const { x, y, width, height } = view.rect;
            const { min, max } = this.scenes![view.state].bounds;
            const at = this.project(view, new THREE.Vector3(...min).add(new THREE.Vector3(...max)).multiplyScalar(0.5));
            if (!view.orbit.touched && Math.max(Math.abs(at.x - x - width / 2) / width, Math.abs(at.y - y - height / 2) / height) > 0.25) this.frame(view, false);
        }
    }

    each(change: (scene: ShellScene) => void): void {
        for (const scene of Object.values(this.scenes ?? {})) change(scene);
        this.invalidate();
    }

    /** Something is to be drawn anew. */
    invalidate(): void {
        this.stale = true;
        this.changed = performance.now();
        if (this.isLive && this.held) this.scheduleLater();
        else this.schedule();
    }

    /** Also what does not move with the panels. */
    invalidateBackdrop(): void {
        this.backdrop = this.copied = "";
        this.invalidate();
    }

    /** Only what lies over the scenes is. */
    invalidateOverlay(): void {
        this.staleOverlay = true;
        if (this.slow && this.held) this.scheduleLater();
        else this.schedule();
    }

    /** What the pointer's last move changes: carried out with the next picture or overlay. */
    follow(move: () => void): void {
        this.followed = move;
        this.invalidateOverlay();
    }

    /** A hand begins or ends its work on the views. */
    hold(held: boolean): void {
        const ends = this.held && !held;
        this.held = held;
        if (ends) this.invalidate();
        this.expecting = false;
    }

    /** What the hand does will move panels: where that is slow, they are drawn in the quick way from now on. */
    expect(): void {
        if (this.expecting || !this.held || !this.slow) return;
        this.expecting = true;
        if (!this.override && this.copied && this.copied === this.backdropNow()) this.showLive(); // before the hand's first word leaves
        this.invalidate();
    }

    private schedule(): void {
        if (!this.request) this.request = requestAnimationFrame((now) => this.tick(now));
    }
    private scheduleLater(): void {
        this.laterTimer ??= setTimeout(() => this.schedule(), pace);
    }

    /** Moves the camera so that the shell fills the view. */
    frame(view: View, animated = this.animated): void {
        const scene = this.scenes?.[view.state];
        if (!scene || view.rect.width === 0) return;
        const { azimuth, elevation, projection } = view.orbit.pose;
        const share = view.state === "flat" ? 0.86 : 0.88;
        // in low views titles and buttons take much of the top, and the legend stands beside the sheet
        const { width, height } = view.rect;
        const low = height < 420;
        const legend = low ? 220 : 270;
        const beside = view.state === "flat" && height < 560 && width - legend > 0.8 * height ? legend : 0;
        const pose = view.orbit.framed(scene.panels.places, { azimuth, elevation, projection }, width - beside, height, share, low ? -0.05 : view.state === "flat" ? 0.04 : 0.05);
        const across = (pose.distance * Math.tan(Math.PI / 12) * beside) / height;
        const right = azimuth * (Math.PI / 180);
        pose.target = [pose.target[0] + Math.sin(right) * across, pose.target[1] - Math.cos(right) * across, pose.target[2]];
        view.orbit.go(pose, animated);
        view.orbit.touched = false;
        this.invalidate();
    }

    usePreset(view: View, preset: Preset): void {
        const pose: Pose = { ...view.orbit.pose, ...presets[preset] };
        view.orbit.preset = preset;
        const scene = this.scenes?.[view.state];
        if (!scene) return;
        view.orbit.go(view.orbit.framed(scene.panels.places, pose, view.rect.width, view.rect.height, 0.88, 0.06), this.animated);
        this.invalidate();
    }

    /** Brings panels to the middle of the views, from near by and from the side that they face. */
    lookAt(panels: readonly number[]): void {
        for (const id of this.shown) {
            const view = this.views[id];
            const skin = this.skins?.[view.state];
            const scene = this.scenes?.[view.state];
            if (!skin || !scene || panels.length === 0) continue;
            const { pose } = view.orbit;
            const centre = new THREE.Vector3();
            const facing = new THREE.Vector3();
            const place = new THREE.Vector3();
            for (const panel of panels) {
                centre.addScaledVector(skin.centre(panel, place), 1 / panels.length);
                facing.add(skin.normal(panel, place));
            }
            const reach = panels.reduce((most, panel) => Math.max(most, skin.centre(panel, place).distanceTo(centre)), 0);
            const distance = Math.min(pose.distance, Math.max(6 * scene.panels.edge, 1.5 * reach) / Math.tan(Math.PI / 12));
            const [from, to] = [pose.azimuth * (Math.PI / 180), Math.atan2(facing.y, facing.x)];
            const steep = Math.hypot(facing.x, facing.y) > 0.3 * Math.abs(facing.z);
            // turned away, it would be hidden by the shell itself
            const turned = pose.projection === "perspective" && steep && Math.cos(from - to) < 0.3;
            view.orbit.go({ ...pose, target: [centre.x, centre.y, centre.z], distance, azimuth: turned ? to * (180 / Math.PI) : pose.azimuth }, this.animated);
            view.orbit.touched = true;
        }
        this.invalidate();
    }

    viewAt(x: number, y: number): View | null {
        for (const id of this.shown) {
            const { rect } = this.views[id];
            if (x >= rect.x && x < rect.x + rect.width && y >= rect.y && y < rect.y + rect.height) return this.views[id];
        }
        return null;
    }

    ray(view: View, x: number, y: number): THREE.Ray {
        const caster = new THREE.Raycaster();
        caster.setFromCamera(new THREE.Vector2(2 * ((x - view.rect.x) / view.rect.width) - 1, 1 - 2 * ((y - view.rect.y) / view.rect.height)), view.orbit.camera);
        return caster.ray;
    }

    pick(view: View, x: number, y: number): SkinPoint | null {
        return this.skins ? this.skins[view.state].cast(this.ray(view, x, y)) : null;
    }

    /** Page coordinates within the canvas; z above 1 is behind the camera. */
    project(view: View, place: THREE.Vector3): { x: number; y: number; z: number } {
        const p = place.clone().project(view.orbit.camera);
        return { x: view.rect.x + ((p.x + 1) / 2) * view.rect.width, y: view.rect.y + ((1 - p.y) / 2) * view.rect.height, z: p.z };
    }

    get theme(): Look {
        return this.look;
    }

    private tick(now: number): void {
        this.request = 0;
        clearTimeout(this.laterTimer);
        this.laterTimer = undefined;
        const follow = this.followed;
        this.followed = null;
        follow?.();
        if (this.dirtyPlaces && !this.flying) this.placeShell();
        this.onBefore?.();
        if (this.stale && !this.flying) {
            clearTimeout(this.restTimer);
            const waits = this.slow && (this.held || performance.now() - this.changed < rests[0]);
            const began = performance.now();
            const moving = this.draw(now, waits ? "quick" : this.slow && this.plainDiffers && performance.now() - this.changed < rests[1] ? "plain" : "whole");
            this.fly(this.onSubmitted?.(began));
            if (moving) this.invalidate();
        }
        if (this.staleOverlay) this.drawOverlay();
    }

    /** Whole pictures show more than plain ones: where panels are small they do not, and are not drawn twice. */
    private get plainDiffers(): boolean {
        return this.seen.some((view) => detailFor(view.orbit.pixels(this.scenes![view.state].panels.edge, view.rect.height), view.detail) === "full");
    }

    /** The views that are drawn. */
    private get seen(): View[] {
        return this.scenes ? this.shown.map((id) => this.views[id]).filter(({ rect }) => rect.width >= 2 && rect.height >= 2) : [];
    }

    /** True while a camera is on its way. */
    private draw(now: number, effort: Effort): boolean {
        const before = this.drawnWith;
        this.stale = false;
        this.staleOverlay = true;
        this.drawnWith = effort;
        if (this.dirtyPlaces) this.placeShell();
        let moving = false;
        for (const { orbit, state } of this.seen) moving = orbit.update(now, radiusOf(this.scenes![state].bounds)) || moving;
        const quick = effort === "quick";
        const backdrop = quick ? this.backdropNow() : "";
        this.rendered = !quick || (backdrop !== this.copied && backdrop !== this.backdrop);
        if (effort === "whole" && this.slow) this.copyBackdrop();
        if (this.rendered) {
            this.render(effort);
            this.backdrop = backdrop;
        }
        const still = quick && !this.rendered && !this.override;
        const live = still && this.showLive();
        if (!still) this.live?.stop();
        const copied = quick && backdrop === this.copied;
        if (copied && before !== "quick" && this.live?.coming) {
            this.drawnWith = before; // for a moment what is there will do
            return moving;
        }
        if (quick && !live) this.drawQuick();
        this.canvas.style.visibility = copied ? "hidden" : "";
        this.canvases.ground.hidden = !copied || live;
        this.canvases.quick.hidden = !quick || live;
        this.canvases.apart.hidden = !live;
        return moving;
    }

    /** A worker draws states as they come in. */
    get isLive(): boolean {
        return !this.canvases.apart.hidden;
    }

    /** True when the worker's picture is there. */
    private showLive(): boolean {
        const { shell } = this;
        const scene = shell && (shell.moving || this.expecting || this.isLive) && this.liveScene();
        return scene ? this.live!.show(shell, scene) : false;
    }

    private liveScene(): LiveScene | null {
        const { watch, colouring } = this;
        if (!watch || !colouring || !this.scenes || !Live.possible) return null;
        this.copyBackdrop();
        this.live ??= new Live(this.canvases.apart, watch, () => this.groundPixels(), () => this.invalidate(), (stamps) => this.onStamped(stamps));
        const sights = this.seen.map((view) => ({ ...this.setDetail(view, "quick").sight(this.windowOf(view)), state: view.state }));
        return { sights, marks: this.scenes.flat.panels.shownMarks.slice(), ground: this.grounds, ...colouring };
    }

    /** A picture of what lies under quick panels, so that they can begin without the renderer. It covers what it lies on itself. */
    private copyBackdrop(): void {
        const backdrop = this.backdropNow();
        if (backdrop === this.copied) return;
        this.render("quick");
        const { ground } = this.canvases;
        Object.assign(ground, this.pictureSize);
        const context = this.groundContext;
        context.fillStyle = getComputedStyle(this.canvas.parentElement!).backgroundColor;
        context.fillRect(0, 0, ground.width, ground.height);
        this.paintGround(context);
        context.drawImage(this.canvas, 0, 0);
        this.copied = backdrop;
        this.grounds++;
    }

    private get groundContext(): CanvasRenderingContext2D {
        return this.canvases.ground.getContext("2d", { willReadFrequently: true })!;
    }
    private groundPixels(): ImageData {
        const { width, height } = this.canvases.ground;
        return this.groundContext.getImageData(0, 0, width, height);
    }

    /** As the style sheet does it. */
    private paintGround(context: CanvasRenderingContext2D): void {
        for (const { rect } of this.shown.map((id) => this.views[id])) {
            const [x, y, width, height] = [rect.x, rect.y, rect.width, rect.height].map((v) => Math.round(v * this.screenRatio));
            const [cx, cy] = [x + 0.5 * width, y + 0.38 * height];
            const gradient = context.createRadialGradient(cx, cy, 0, cx, cy, Math.hypot(0.5 * width, 0.62 * height));
            gradient.addColorStop(0, this.look.backdrop[0]);
            gradient.addColorStop(1, this.look.backdrop[1]);
            context.fillStyle = gradient;
            context.fillRect(x, y, width, height);
        }
    }

    /** While nothing else is to be done. */
    private getReady(): void {
        const { grounds } = this;
        const scene = this.slow && this.liveScene();
        if (this.grounds !== grounds) this.invalidate(); // the picture at rest made room for that of the ground
        if (!scene) return;
        if (this.practised) this.live!.prepare(scene);
        else this.live!.practise(this.shell!, scene);
        this.practised = true;
    }

    /** A view's part of the picture, in pixels. */
    private windowOf({ rect, orbit: { camera } }: View): Window {
        const [x, y, width, height] = [rect.x, rect.y, rect.width, rect.height].map((v) => Math.round(v * this.screenRatio));
        return { x, y, width, height, matrix: new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements };
    }

    /** What the picture under quick panels depends on. */
    private backdropNow(): string {
        return JSON.stringify(this.seen.map(({ rect, orbit }) => [rect, orbit.pose]));
    }

    private setDetail(view: View, effort: Effort): PanelMesh {
        const { panels } = this.scenes![view.state];
        const pixels = view.orbit.pixels(panels.edge, view.rect.height);
        view.detail = detailFor(pixels, view.detail);
        panels.setDetail(effort === "quick" ? "flat" : effort === "plain" && view.detail === "full" ? "prism" : view.detail, pixels);
        return panels;
    }

    private render(effort: Effort): void {
        const { renderer, scenes } = this;
        renderer.setScissorTest(false);
        renderer.setRenderTarget(null);
        renderer.setClearColor(0x000000, 0);
        renderer.clear();
        if (!scenes) return;
        if (this.dirtyShadows && effort !== "quick") {
            for (const state of new Set(this.shown.map((id) => this.views[id].state))) scenes[state].castShadows();
            this.dirtyShadows = false;
        }
        renderer.setScissorTest(true);
        for (const view of this.seen) {
            const { x, y, width, height } = view.rect;
            this.setDetail(view, effort).group.visible = effort !== "quick";
            renderer.setViewport(x, this.height - y - height, width, height);
            renderer.setScissor(x, this.height - y - height, width, height);
            renderer.render(scenes[view.state].scene, view.orbit.camera);
            for (const listener of this.drawn) listener(view);
        }
    }

    private drawQuick(): void {
        const { width, height } = this.pictureSize;
        const picture = this.quickPictureOf(width, height);
        if (!picture) return;
        clear(picture);
        for (const view of this.seen) this.setDetail(view, "quick").drawQuick(picture, this.windowOf(view));
        picture.context.putImageData(picture.image, 0, 0);
    }

    private quickPictureOf(width: number, height: number): QuickPicture | null {
        if (!(width * height > 0)) return null; // not laid out yet
        if (this.quickPicture?.width === width && this.quickPicture.height === height) return this.quickPicture;
        Object.assign(this.canvases.quick, { width, height });
        const picture = makePicture(width, height);
        const bytes = new Uint8ClampedArray(picture.pixels.buffer as ArrayBuffer);
        const context = this.quickPicture?.context ?? this.canvases.quick.getContext("2d", { willReadFrequently: true })!;
        return (this.quickPicture = { ...picture, image: new ImageData(bytes, width, height), context });
    }

    private drawOverlay(): void {
        this.staleOverlay = false;
        const ratio = this.canvases.overlay.width / Math.max(1, this.width);
        this.context2d.setTransform(ratio, 0, 0, ratio, 0, 0);
        this.context2d.clearRect(0, 0, this.width, this.height);
        this.drawFloors();
        for (const overlay of this.overlays) overlay(this.context2d, this);
    }

    /** Seen from the side the grid is a line. */
    private drawFloors(): void {
        for (const { rect, state, orbit } of this.seen) {
            if (state !== "space" || orbit.pose.projection !== "parallel" || Math.abs(orbit.pose.elevation) > 0.5) continue;
            const { min } = this.scenes!.space.bounds;
            const y = Math.round(rect.y + ((1 - new THREE.Vector3(min[0], min[1], this.scenes!.space.floor).project(orbit.camera).y) / 2) * rect.height) + 0.5;
            if (y < rect.y || y > rect.y + rect.height) continue;
            this.context2d.strokeStyle = this.look.gridMajor;
            this.context2d.lineWidth = 1;
            this.context2d.beginPath();
            this.context2d.moveTo(rect.x, y);
            this.context2d.lineTo(rect.x + rect.width, y);
            this.context2d.stroke();
        }
    }

    /** Calls `done` when all that was drawn so far is, and learns from how long whole pictures take. */
    private fly(done?: () => void): void {
        const began = performance.now();
        const { drawnWith: effort, rendered } = this;
        const land = () => {
            this.flying = false;
            if (rendered && effort === "whole") this.wholeTimes = [this.wholeTimes[1], performance.now() - began];
            done?.();
            if (this.stale) this.schedule();
            else this.refineAfterRest();
        };
        this.flying = true;
        if (!this.rendered) {
            setTimeout(land); // after the frame that it goes into
            return;
        }
        const gl = this.renderer.getContext() as WebGL2RenderingContext;
        const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        gl.flush();
        const look = () => {
            if (fence && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED && !gl.isContextLost()) {
                setTimeout(look, 1);
                return;
            }
            gl.deleteSync(fence);
            land();
        };
        setTimeout(look, 1);
    }

    /** What was left out while something moved is drawn soon after nothing does: better pictures, and the soft ground shadow. */
    private refineAfterRest(): void {
        if (this.drawnWith === "whole") this.getReady();
        if (this.drawnWith === "whole" ? !this.dirtyGround : !this.refines) return;
        const due = this.changed + (!this.slow ? 80 : rests[this.drawnWith === "quick" ? 0 : 1]);
        this.restTimer = setTimeout(() => {
            if (this.held || this.flying || this.stale) return;
            if (this.dirtyGround && (this.drawnWith !== "quick" || !this.slow || !this.plainDiffers)) this.drawGrounds();
            this.stale = true;
            this.schedule();
        }, Math.max(20, due - performance.now()));
    }

    private drawGrounds(): void {
        this.dirtyGround = false;
        this.copied = "";
        for (const scene of Object.values(this.scenes ?? {})) scene.drawGround(this.renderer);
    }

    /** Pixels of a whole picture. */
    get pictureSize(): { width: number; height: number } {
        return { width: Math.floor(this.width * this.screenRatio), height: Math.floor(this.height * this.screenRatio) };
    }

    /** The views as they are, on their ground. */
    paintOn(context: CanvasRenderingContext2D, ground = true): void {
        if (this.dirtyGround) this.drawGrounds();
        this.draw(performance.now(), "whole");
        context.clearRect(0, 0, this.canvas.width, this.canvas.height);
        if (ground) this.paintGround(context);
        context.drawImage(this.canvas, 0, 0);
    }

    async picture(ground = true): Promise<Blob> {
        const out = Object.assign(document.createElement("canvas"), this.pictureSize);
        this.paintOn(out.getContext("2d")!, ground);
        return new Promise((resolve, reject) => out.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The picture could not be made."))), ground ? "image/png" : "image/webp", 0.9));
    }

    dispose(): void {
        cancelAnimationFrame(this.request);
        clearTimeout(this.restTimer);
        clearTimeout(this.laterTimer);
        this.live?.dispose();
        this.setShell(null);
        cancelAnimationFrame(this.request);
        this.renderer.dispose();
    }
}
