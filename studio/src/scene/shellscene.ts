// One state in its own light: panels, ground shadow and grid. The flat view and the deployed views have one each.
import * as THREE from "three";
import { type Bounds, type Linkage, boundsOf } from "../panels/linkage";
import { niceBelow } from "../panels/colour";
import { GroundShadow } from "./ground";
import { Grid } from "./grid";
import { type Look, keyFrom } from "./look";
import { PanelMesh } from "./panelmesh";
import { radiusOf } from "./camera";

/** Towards key, fill and rim light. */
const lamps = (planar: boolean) => [planar ? keyFrom.plane : keyFrom.space, [1, -1, 0.6], [0.4, 1.6, 0.5]] as const;

export class ShellScene {
    readonly scene = new THREE.Scene();
    readonly panels: PanelMesh;
    bounds: Bounds = { min: [0, 0, 0], max: [1, 1, 1] };
    private readonly ground: GroundShadow;
    private readonly grid = new Grid();
    private readonly key = new THREE.DirectionalLight("#fff6ea");
    private readonly fill = new THREE.DirectionalLight("#dfe9ff");
    private readonly rim = new THREE.DirectionalLight("#9fc0ff");
    private readonly sky = new THREE.HemisphereLight();
    private gridRadius = 0;

    constructor(linkage: Linkage, look: Look, private readonly planar: boolean, frugal: boolean) {
        this.panels = new PanelMesh(linkage, look);
        this.ground = new GroundShadow(planar ? keyFrom.plane : keyFrom.space, frugal ? 256 : 2048);
        this.key.castShadow = !planar; // panels in one plane cast none on each other, and what a shadow map makes of that is stripes
        this.key.shadow.autoUpdate = false;
        this.key.shadow.radius = 3;
        this.key.shadow.bias = -0.0006;
        this.key.shadow.intensity = 0.7;
        this.key.shadow.mapSize.set(frugal ? 1024 : 4096, frugal ? 1024 : 4096);
        this.sky.position.set(0, 0, 1);
        this.scene.add(this.sky, this.key, this.key.target, this.fill, this.fill.target, this.rim, this.rim.target);
        this.scene.add(this.grid.plane, this.ground.plane, this.panels.group);
        this.setLook(look);
    }

    setLook(look: Look): void {
        this.panels.setLook(look);
        this.ground.setLook(look);
        this.grid.setLook(look);
        this.sky.color.set(look.sky);
        this.sky.groundColor.set(look.ground);
        this.sky.intensity = look.hemisphere;
        this.key.intensity = look.key;
        this.fill.intensity = look.fill;
        this.rim.intensity = look.rim;
        this.rim.visible = look.rim > 0;
        const lit = (colour: THREE.Color, intensity: number) => colour.clone().multiplyScalar(intensity).toArray();
        this.panels.setLights({
            lamps: [this.key, this.fill, this.rim].map((light, k) => ({
                from: new THREE.Vector3(...lamps(this.planar)[k]).normalize().toArray(), colour: lit(light.color, light.intensity),
            })),
            sky: lit(this.sky.color, look.hemisphere), ground: lit(this.sky.groundColor, look.hemisphere),
        });
    }

    setPlaces(places: Float32Array): void {
        this.panels.setPlaces(places);
        this.bounds = boundsOf(this.panels.places);
        const { min, max } = this.bounds;
        const centre = [0, 1, 2].map((k) => (min[k] + max[k]) / 2);
        const radius = radiusOf(this.bounds);
        const aim = (light: THREE.DirectionalLight, from: readonly number[]) => {
            const length = Math.hypot(from[0], from[1], from[2]);
            light.target.position.set(centre[0], centre[1], centre[2]);
            light.position.set(...(from.map((v, k) => centre[k] + (v / length) * 3 * radius) as [number, number, number]));
        };
        [this.key, this.fill, this.rim].forEach((light, k) => aim(light, lamps(this.planar)[k]));
        const reach = 1.5 * radius;
        const camera = this.key.shadow.camera;
        Object.assign(camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.5 * radius, far: 6 * radius });
        camera.updateProjectionMatrix();
        // where panels are small, a texel of the shadow map is not
        this.key.shadow.normalBias = Math.max(0.03 * this.panels.edge, (1.5 * 2 * reach) / this.key.shadow.mapSize.x);
        // the grid stays where it is while the shell moves a little: it is what the eye measures by
        if (Math.abs(radius - this.gridRadius) > 0.15 * radius || this.gridRadius === 0) {
            this.gridRadius = radius;
            this.grid.place(centre[0], centre[1], this.floor, radius, niceBelow(radius / (this.planar ? 8 : 4)));
        }
        this.grid.plane.position.z = this.floor - 1e-3 * radius;
    }

    get floor(): number {
        return this.bounds.min[2] - 0.1 * this.panels.edge;
    }

    /** Self shadow of this frame. */
    castShadows(): void {
        this.key.shadow.needsUpdate = true;
    }

    drawGround(renderer: THREE.WebGLRenderer): void {
        const { min, max } = this.bounds;
        this.ground.draw(renderer, this.panels, (min[0] + max[0]) / 2, (min[1] + max[1]) / 2,
            Math.hypot(max[0] - min[0], max[1] - min[1]) / 2, this.floor, Math.max(max[2] - this.floor, 0.2 * this.panels.edge));
    }

    dispose(): void {
        this.panels.dispose();
        this.ground.dispose();
        this.grid.dispose();
        this.key.dispose();
    }
}
