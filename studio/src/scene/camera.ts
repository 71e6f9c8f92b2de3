// An orbiting camera, Z up, perspective or parallel, framed to what it shows. Angles in degrees: azimuth from +X, elevation from
// the ground. `distance` is from the target in perspective and sets the height of a parallel view alike, so that switching
// between them keeps the size of what is at the target.
import * as THREE from "three";
import { type Bounds } from "../panels/linkage";

export type Projection = "perspective" | "parallel";
export interface Pose {
    azimuth: number;
    elevation: number;
    distance: number;
    target: [number, number, number];
    projection: Projection;
}

const fov = 30;
const radians = Math.PI / 180;

export const presets = {
    perspective: { azimuth: -62, elevation: 36, projection: "perspective" },
    top: { azimuth: -90, elevation: 90, projection: "parallel" },
    front: { azimuth: -90, elevation: 0, projection: "parallel" },
    right: { azimuth: 0, elevation: 0, projection: "parallel" },
} as const;
export type Preset = keyof typeof presets;

export class OrbitCamera {
    pose: Pose = { azimuth: -62, elevation: 36, distance: 10, target: [0, 0, 0], projection: "perspective" };
    preset: Preset | null = "perspective";
    /** The user moved it: it is not framed anew by itself. */
    touched = false;
    private readonly perspective = new THREE.PerspectiveCamera(fov, 1, 0.1, 100);
    private readonly parallel = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 100);
    private aspect = 1;
    private goal: { from: Pose; to: Pose; start: number } | null = null;

    get camera(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
        return this.pose.projection === "perspective" ? this.perspective : this.parallel;
    }

    /** World units from the target to the top of the view. */
    get halfHeight(): number {
        return this.pose.distance * Math.tan((fov / 2) * radians);
    }

    /** Pixels that a length at the target takes up in a view of this height. */
    pixels(length: number, viewHeight: number): number {
        return (length * viewHeight) / (2 * this.halfHeight);
    }

    resize(width: number, height: number): void {
        this.aspect = width / Math.max(1, height);
    }

    /** Places the three.js camera; true while a move is under way. */
    update(now: number, extent: number): boolean {
        let moving = false;
        if (this.goal) {
            const x = Math.min(1, (now - this.goal.start) / 240);
            const e = x < 0.5 ? 2 * x * x : 1 - 2 * (1 - x) * (1 - x);
            const { from, to } = this.goal;
            const mix = (a: number, b: number) => a + (b - a) * e;
            this.pose = {
                azimuth: mix(from.azimuth, to.azimuth), elevation: mix(from.elevation, to.elevation), distance: mix(from.distance, to.distance),
                target: [0, 1, 2].map((k) => mix(from.target[k], to.target[k])) as Pose["target"], projection: to.projection,
            };
            if (x >= 1) this.goal = null;
            else moving = true;
        }
        const { azimuth, elevation, distance, target } = this.pose;
        const a = azimuth * radians;
        const e = Math.max(-89.99, Math.min(89.99, elevation)) * radians;
        const camera = this.camera;
        const direction = new THREE.Vector3(Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e));
        const far = distance + 8 * extent;
        const back = this.pose.projection === "parallel" ? Math.max(distance, 4 * extent) : distance;
        camera.up.set(0, 0, 1);
        camera.position.set(...target).addScaledVector(direction, back);
        camera.lookAt(...target);
        if (camera === this.perspective) {
            this.perspective.aspect = this.aspect;
            this.perspective.near = Math.max(distance / 200, distance - 6 * extent);
            this.perspective.far = far;
        } else {
            const h = this.halfHeight;
            Object.assign(this.parallel, { left: -h * this.aspect, right: h * this.aspect, top: h, bottom: -h, near: back / 100, far: back + 8 * extent });
        }
        camera.updateProjectionMatrix();
        camera.updateMatrixWorld();
        return moving;
    }

    go(to: Pose, animated: boolean): void {
        if (!animated) {
            this.goal = null;
            this.pose = to;
            return;
        }
        // the short way round
        let d = (to.azimuth - this.pose.azimuth) % 360;
        if (d > 180) d -= 360;
        if (d < -180) d += 360;
        this.goal = { from: { ...this.pose, azimuth: to.azimuth - d }, to, start: performance.now() };
    }

    /** The pose in which the points fill this share of the view; their middle lies `rise` of the height above the view's. */
    framed(points: Float32Array, pose: Omit<Pose, "distance" | "target">, width: number, height: number, share: number, rise: number): Pose {
        const a = pose.azimuth * radians;
        const e = Math.max(-89.99, Math.min(89.99, pose.elevation)) * radians;
        const back = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
        const right = [-Math.sin(a), Math.cos(a), 0];
        const up = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
        const dot = (v: number[], i: number) => v[0] * points[i] + v[1] * points[i + 1] + v[2] * points[i + 2];
        const tan = Math.tan((fov / 2) * radians);
        const aspect = width / Math.max(1, height);
        // The middle of the box that the picture fills and the distance that makes it fill: a few rounds settle perspective.
        let x = 0, y = 0, z = 0, distance = 0;
        const step = 3 * Math.max(1, Math.floor(points.length / 3 / 4000));
        for (let round = 0; round < (pose.projection === "perspective" ? 8 : 2); round++) {
            let left = Infinity, rightmost = -Infinity, low = Infinity, high = -Infinity, near = -Infinity, far = Infinity;
            for (let i = 0; i < points.length; i += step) {
                const depth = dot(back, i);
                near = Math.max(near, depth);
                far = Math.min(far, depth);
                const s = pose.projection === "perspective" && round > 0 ? distance / Math.max(1e-9, distance - (depth - z)) : 1;
                const u = (dot(right, i) - x) * s;
                const v = (dot(up, i) - y) * s;
                left = Math.min(left, u);
                rightmost = Math.max(rightmost, u);
                low = Math.min(low, v);
                high = Math.max(high, v);
            }
            if (round === 0) {
                z = (near + far) / 2;
            }
            x += (left + rightmost) / 2;
            y += (low + high) / 2;
            distance = Math.max((rightmost - left) / 2 / (tan * aspect * share), (high - low) / 2 / (tan * Math.min(0.72, share)), 1e-6);
        }
        y -= rise * 2 * distance * tan;
        return { ...pose, distance, target: [0, 1, 2].map((k) => right[k] * x + up[k] * y + back[k] * z) as Pose["target"] };
    }

    orbit(dx: number, dy: number): void {
        this.goal = null;
        this.touched = true;
        this.preset = null;
        this.pose = { ...this.pose, azimuth: this.pose.azimuth - dx * 0.3, elevation: Math.max(-89.9, Math.min(90, this.pose.elevation + dy * 0.3)) };
    }

    pan(dx: number, dy: number, viewHeight: number): void {
        this.goal = null;
        this.touched = true;
        const scale = (2 * this.halfHeight) / viewHeight;
        const m = this.camera.matrixWorld.elements;
        this.pose = { ...this.pose, target: this.pose.target.map((v, k) => v - (dx * m[k] - dy * m[4 + k]) * scale) as Pose["target"] };
    }

    /** Zooms by a factor about a point of the view, -1 to 1 both ways. */
    zoom(factor: number, x: number, y: number): void {
        this.goal = null;
        this.touched = true;
        const h = this.halfHeight;
        const m = this.camera.matrixWorld.elements;
        const k = 1 - factor;
        this.pose = {
            ...this.pose,
            distance: this.pose.distance * factor,
            target: this.pose.target.map((v, i) => v + k * h * (x * this.aspect * m[i] + y * m[4 + i])) as Pose["target"],
        };
    }
}

export function radiusOf(b: Bounds): number {
    return Math.max(1e-6, Math.hypot(b.max[0] - b.min[0], b.max[1] - b.min[1], b.max[2] - b.min[2]) / 2);
}
