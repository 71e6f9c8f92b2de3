// The soft shadow on the ground: panels are drawn along the key light in bands of height, from the highest down, and what is
// there is blurred a little more before each band is added. So a band's blur grows with its height, at the cost of one small
// blur per band. Widths add as squares.
import * as THREE from "three";
import type { PanelMesh } from "./panelmesh";
import type { Look } from "./look";

const bands = 9; // of a sheet that lies flat: one
const flatShadow = /* glsl */ `
uniform vec3 towards; uniform float floorZ; uniform vec2 middle; uniform float halfSize;
varying float vHeight;
void main() {
    vHeight = position.z - floorZ;
    vec2 q = position.xy - towards.xy / towards.z * vHeight;
    gl_Position = vec4((q - middle) / halfSize, 0.0, 1.0);
}`;
const inBand = /* glsl */ `
varying float vHeight; uniform vec2 band;
void main() { if (vHeight < band.x || vHeight >= band.y) discard; gl_FragColor = vec4(1.0); }`;
const screen = /* glsl */ `varying vec2 vUv; void main() { vUv = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }`;
const gauss = /* glsl */ `
varying vec2 vUv; uniform sampler2D source; uniform vec2 direction; uniform float sigma;
void main() {
    float sum = 0.0; float weight = 0.0;
    for (int i = -6; i <= 6; i++) {
        float x = float(i) * 0.5;
        float w = exp(-0.5 * x * x);
        sum += w * texture2D(source, vUv + direction * (x * sigma)).r;
        weight += w;
    }
    gl_FragColor = vec4(sum / weight);
}`;

export class GroundShadow {
    readonly plane: THREE.Mesh<THREE.PlaneGeometry, THREE.ShaderMaterial>;
    private targets: THREE.WebGLRenderTarget[] = [];
    private readonly caster: THREE.ShaderMaterial;
    private readonly blur: THREE.ShaderMaterial;
    private readonly casterScene = new THREE.Scene();
    private readonly casterMesh: THREE.Mesh;
    private readonly blurScene = new THREE.Scene();
    private readonly camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    private readonly towards: THREE.Vector3;

    constructor(towards: readonly [number, number, number], private readonly size: number) {
        this.towards = new THREE.Vector3(...towards);
        // panels are drawn into the first one: where they are as small as its texels, each takes a share of them
        this.targets = [4, 0].map((samples) => new THREE.WebGLRenderTarget(size, size, {
            format: THREE.RedFormat, type: THREE.UnsignedByteType, depthBuffer: false, generateMipmaps: false, samples,
        }));
        this.caster = new THREE.ShaderMaterial({
            vertexShader: flatShadow, fragmentShader: inBand, side: THREE.DoubleSide, depthTest: false, depthWrite: false,
            uniforms: {
                towards: { value: this.towards }, floorZ: { value: 0 }, middle: { value: new THREE.Vector2() },
                halfSize: { value: 1 }, band: { value: new THREE.Vector2() },
            },
        });
        this.blur = new THREE.ShaderMaterial({
            vertexShader: screen, fragmentShader: gauss, depthTest: false, depthWrite: false,
            uniforms: { source: { value: null }, direction: { value: new THREE.Vector2() }, sigma: { value: 1 } },
        });
        this.casterMesh = new THREE.Mesh(new THREE.BufferGeometry(), this.caster);
        this.casterMesh.frustumCulled = false;
        this.casterScene.add(this.casterMesh);
        this.blurScene.add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.blur));
        this.plane = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({
            transparent: true, depthWrite: false,
            vertexShader: /* glsl */ `varying vec2 vUv; void main() { vUv = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
            fragmentShader: /* glsl */ `varying vec2 vUv; uniform sampler2D shadow; uniform vec3 tint; uniform float alpha;
                void main() { gl_FragColor = vec4(tint, alpha * texture2D(shadow, vUv).r); }`,
            uniforms: { shadow: { value: this.targets[0].texture }, tint: { value: new THREE.Color() }, alpha: { value: 0 } },
        }));
        this.plane.renderOrder = -1;
        this.plane.visible = false;
    }

    setLook(look: Look): void {
        (this.plane.material.uniforms.tint.value as THREE.Color).setStyle(look.shadowTint).convertLinearToSRGB();
        this.plane.material.uniforms.alpha.value = look.shadowAlpha;
    }

    /** Draws the shadow of panels standing between floorZ and floorZ + height, about (x, y), within `radius` of it. */
    draw(renderer: THREE.WebGLRenderer, panels: PanelMesh, x: number, y: number, radius: number, floorZ: number, height: number): void {
        const u = this.caster.uniforms;
        const reach = 1.25 * radius + (Math.hypot(this.towards.x, this.towards.y) / this.towards.z) * height * 0.5;
        const shift = (height * 0.5) / this.towards.z;
        const cx = x - this.towards.x * shift;
        const cy = y - this.towards.y * shift;
        u.floorZ.value = floorZ;
        u.middle.value.set(cx, cy);
        u.halfSize.value = reach;
        this.casterMesh.geometry = panels.plainGeometry;
        const autoClear = renderer.autoClear;
        const before = renderer.getRenderTarget();
        renderer.autoClear = false;
        renderer.setClearColor(0x000000, 0);
        renderer.setRenderTarget(this.targets[0]);
        renderer.clear();
        // sharp where the shell touches, softer the higher it stands: no lace is left under the crown
        const pixels = (this.size / (2 * reach)) * panels.edge;
        // what is finer than the texture is made even: stripes otherwise
        const least = 0.1 + 0.9 * Math.max(0, Math.min(1, (24 - pixels) / 12));
        const width = (k: number) => Math.max(1.5, pixels * least) + pixels * ((0.55 * ((k + 0.5) / bands) * height) / panels.edge);
        const first = height < panels.edge ? 0 : bands - 1;
        for (let k = first; k >= 0; k--) {
            u.band.value.set(k === 0 ? -Infinity : (k / bands) * height, k === first ? Infinity : ((k + 1) / bands) * height);
            renderer.setRenderTarget(this.targets[0]);
            renderer.render(this.casterScene, this.camera);
            const below = k > 0 ? width(k - 1) : 0;
            this.soften(renderer, Math.sqrt(Math.max(0, width(k) ** 2 - below ** 2)));
        }
        renderer.setRenderTarget(before);
        renderer.autoClear = autoClear;
        this.plane.position.set(cx, cy, floorZ);
        this.plane.scale.set(reach, reach, 1);
        this.plane.visible = true;
    }

    private soften(renderer: THREE.WebGLRenderer, sigma: number): void {
        if (sigma < 0.3) return;
        const u = this.blur.uniforms;
        u.sigma.value = sigma;
        for (const [from, to, dx, dy] of [[0, 1, 1, 0], [1, 0, 0, 1]] as const) {
            u.source.value = this.targets[from].texture;
            u.direction.value.set(dx / this.size, dy / this.size);
            renderer.setRenderTarget(this.targets[to]);
            renderer.clear();
            renderer.render(this.blurScene, this.camera);
        }
    }

    dispose(): void {
        for (const t of this.targets) t.dispose();
        this.caster.dispose();
        this.blur.dispose();
        this.plane.material.dispose();
    }
}
