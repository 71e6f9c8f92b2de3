// The views: one canvas under all of them, drawn only when something changed. Two scenes (flat, space) are shown by up to four
// cameras. Everything over the shell (rings, handles, measures) is drawn on a plain canvas above by whoever registers for it.
import * as THREE from "three";
import type { Shell } from "../panels/shell";
import { type Detail, detailFor } from "../panels/template";
import { OrbitCamera, type Pose, type Preset, presets, radiusOf } from "./camera";
import { type Look, light } from "./look";
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
    /** Called after a frame was drawn: latency is measured to here. */
    onPainted: (() => void) | null = null;
    animated = true;
    readonly renderer: THREE.WebGLRenderer;
    /** No graphics card: smaller shadows. */
    readonly frugal: boolean;
    /** Milliseconds that drawing the last frame took, the graphics card's own work apart. */
    drawTime = 0;

    private readonly context2d: CanvasRenderingContext2D;
    private look: Look = light;
    private request = 0;
    private restTimer: ReturnType<typeof setTimeout> | undefined;
    // without a graphics card both kinds of shadow wait until the shell rests
    private dirtyShadows = false;
    private dirtyGround = false;
    /** Places came in less than a moment ago. */
    private moving = false;
    private width = 0;
    private height = 0;

    constructor(readonly canvas: HTMLCanvasElement, readonly overlay: HTMLCanvasElement) {
        this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: false });
        this.renderer.toneMapping = THREE.NoToneMapping;
        this.renderer.outputColorSpace = THREE.SRGBColorSpace;
        this.renderer.shadowMap.enabled = true;
        this.renderer.shadowMap.type = THREE.PCFShadowMap;
        this.renderer.autoClear = false;
        const info = this.renderer.getContext().getExtension("WEBGL_debug_renderer_info");
        const name = info ? String(this.renderer.getContext().getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
        this.frugal = /swiftshader|llvmpipe|software/i.test(name);
        this.context2d = overlay.getContext("2d")!;
    }

    resize(width: number, height: number): void {
        this.width = width;
        this.height = height;
        const ratio = Math.min(2, window.devicePixelRatio || 1);
        this.renderer.setPixelRatio(ratio);
        this.renderer.setSize(width, height, false);
        this.overlay.width = Math.round(width * ratio);
        this.overlay.height = Math.round(height * ratio);
        this.invalidate();
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
        this.invalidate();
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
            this.setPlaces();
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
        this.invalidate();
    }

    /** The shell's places changed. `space` overrides the state in space: a frame of a motion. */
    setPlaces(space?: Float32Array): void {
        if (!this.shell || !this.scenes) return;
        this.scenes.flat.setPlaces(this.shell.flat);
        this.scenes.space.setPlaces(space ?? this.shell.simulated ?? this.shell.deployed);
        this.skins?.flat.touch();
        this.skins?.space.touch();
        this.moving = true;
        this.dirtyShadows = this.dirtyGround = true;
        this.invalidate();
    }

    each(change: (scene: ShellScene) => void): void {
        for (const scene of Object.values(this.scenes ?? {})) change(scene);
        this.invalidate();
    }

    invalidate(): void {
        if (!this.request) this.request = requestAnimationFrame((now) => this.draw(now));
    }

    /** Moves the camera so that the shell fills the view. */
    frame(view: View, animated = this.animated): void {
        const scene = this.scenes?.[view.state];
        if (!scene || view.rect.width === 0) return;
        const { azimuth, elevation, projection } = view.orbit.pose;
        const share = view.state === "flat" ? 0.86 : 0.88;
        const pose = view.orbit.framed(scene.panels.places, { azimuth, elevation, projection }, view.rect.width, view.rect.height, share,
            view.state === "flat" ? 0.04 : 0.05);
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

    /** Brings a place of the model to the middle of the views, from near by. */
    lookAt(panel: number): void {
        for (const id of this.shown) {
            const view = this.views[id];
            const skin = this.skins?.[view.state];
            const scene = this.scenes?.[view.state];
            if (!skin || !scene) continue;
            const centre = skin.centre(panel, new THREE.Vector3());
            view.orbit.go({ ...view.orbit.pose, target: [centre.x, centre.y, centre.z], distance: Math.min(view.orbit.pose.distance, 24 * scene.panels.edge / Math.tan(Math.PI / 12) / 4) }, this.animated);
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

    private draw(now: number): void {
        this.request = 0;
        const began = performance.now();
        const { renderer } = this;
        const scenes = this.scenes;
        renderer.setScissorTest(false);
        renderer.setRenderTarget(null);
        renderer.setClearColor(0x000000, 0);
        renderer.clear();
        let moving = false;
        if (scenes) {
            const shownStates = new Set(this.shown.map((id) => this.views[id].state));
            if (this.dirtyShadows && !(this.frugal && this.dirtyGround)) {
                for (const state of shownStates) scenes[state].castShadows();
                this.dirtyShadows = false;
            }
            if (this.dirtyGround) this.groundAfterRest();
            renderer.setScissorTest(true);
            for (const id of this.shown) {
                const view = this.views[id];
                const { rect } = view;
                if (rect.width < 2 || rect.height < 2) continue;
                const scene = scenes[view.state];
                moving = view.orbit.update(now, radiusOf(scene.bounds)) || moving;
                const pixels = view.orbit.pixels(scene.panels.edge, rect.height);
                view.detail = detailFor(pixels, view.detail);
                // drawn in software, a moving shell goes without bevels and joints
                scene.panels.setDetail(this.frugal && this.moving && view.detail === "full" ? "prism" : view.detail, pixels);
                renderer.setViewport(rect.x, this.height - rect.y - rect.height, rect.width, rect.height);
                renderer.setScissor(rect.x, this.height - rect.y - rect.height, rect.width, rect.height);
                renderer.render(scene.scene, view.orbit.camera);
                for (const listener of this.drawn) listener(view);
            }
        }
        const ratio = this.overlay.width / Math.max(1, this.width);
        this.context2d.setTransform(ratio, 0, 0, ratio, 0, 0);
        this.context2d.clearRect(0, 0, this.width, this.height);
        for (const overlay of this.overlays) overlay(this.context2d, this);
        this.drawTime = performance.now() - began;
        this.onPainted?.();
        if (moving) this.invalidate();
    }

    /** The soft ground shadow is drawn within 100 ms of rest; while the shell moves its last picture stays. */
    private groundAfterRest(): void {
        clearTimeout(this.restTimer);
        this.dirtyGround = false;
        this.restTimer = setTimeout(() => {
            this.moving = false;
            if (!this.scenes) return;
            for (const scene of Object.values(this.scenes)) scene.drawGround(this.renderer);
            this.dirtyShadows ||= this.frugal;
            this.invalidate();
        }, 80);
    }

    /** The views as they are, on their ground. */
    paintOn(context: CanvasRenderingContext2D, ground = true): void {
        this.draw(performance.now());
        const ratio = this.canvas.width / this.width;
        context.clearRect(0, 0, this.canvas.width, this.canvas.height);
        if (ground)
            for (const id of this.shown) {
                const { x, y, width, height } = this.views[id].rect;
                const [cx, cy] = [(x + width / 2) * ratio, (y + 0.38 * height) * ratio];
                const gradient = context.createRadialGradient(cx, cy, 0, cx, cy, Math.max(width, height) * 0.75 * ratio);
                gradient.addColorStop(0, this.look.backdrop[0]);
                gradient.addColorStop(1, this.look.backdrop[1]);
                context.fillStyle = gradient;
                context.fillRect(x * ratio, y * ratio, width * ratio, height * ratio);
            }
        context.drawImage(this.canvas, 0, 0);
    }

    async picture(ground = true): Promise<Blob> {
        const out = document.createElement("canvas");
        out.width = this.canvas.width;
        out.height = this.canvas.height;
        this.paintOn(out.getContext("2d")!, ground);
        return new Promise((resolve, reject) => out.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The picture could not be made."))), ground ? "image/png" : "image/webp", 0.9));
    }

    dispose(): void {
        cancelAnimationFrame(this.request);
        clearTimeout(this.restTimer);
        this.setShell(null);
        cancelAnimationFrame(this.request);
        this.renderer.dispose();
    }
}
