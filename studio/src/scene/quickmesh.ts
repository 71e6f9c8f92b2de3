// The quick way to draw panels, for what moves on a slow renderer: one triangle each, seen from both sides, coloured here. A renderer
// without a graphics card takes longer for a thousand small instances than for a mesh of a hundred thousand triangles.
import * as THREE from "three";
import { type Lights, shadePanels } from "../panels/shade";

const vertex = /* glsl */ `
attribute vec4 bary; attribute vec4 top; attribute vec4 below;
varying vec3 vBary; varying vec4 vTop; varying vec3 vBelow;
void main() {
    vBary = bary.xyz;
    vTop = top;
    vBelow = below.rgb;
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}`;
const fragment = /* glsl */ `
varying vec3 vBary; varying vec4 vTop; varying vec3 vBelow;
uniform vec3 lineColour; uniform float lineAlpha; uniform vec3 accent; uniform vec3 hatchInk;
void main() {
    vec3 side = vBary / max(fwidth(vBary), vec3(1e-6));
    float inside = 1.0 - smoothstep(0.4, 1.2, min(side.x, min(side.y, side.z)));
    bool selected = vTop.a > 0.4 && vTop.a < 0.6;
    vec3 colour = gl_FrontFacing ? vTop.rgb : vBelow;
    if (selected) colour = mix(colour, accent, 0.12);
    else if (vTop.a > 0.7 && fract((gl_FragCoord.x + gl_FragCoord.y) / 8.0) > 0.56) colour = hatchInk;
    gl_FragColor = vec4(mix(colour, selected ? accent : lineColour, selected ? inside : inside * lineAlpha), 1.0);
}`;

export class QuickMesh {
    readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;
    private readonly places: THREE.BufferAttribute;
    private readonly top: THREE.BufferAttribute;
    private readonly below: THREE.BufferAttribute;

    /** `corners`: 9 numbers per panel, kept up to date by the caller; `uniforms` as the panels' own. */
    constructor(corners: Float32Array, uniforms: Record<string, { value: unknown }>) {
        const vertices = corners.length / 3;
        const geometry = new THREE.BufferGeometry();
        this.places = new THREE.BufferAttribute(corners, 3).setUsage(THREE.DynamicDrawUsage);
        this.top = new THREE.BufferAttribute(new Uint8Array(4 * vertices), 4, true).setUsage(THREE.DynamicDrawUsage);
        this.below = new THREE.BufferAttribute(new Uint8Array(4 * vertices), 4, true).setUsage(THREE.DynamicDrawUsage);
        const bary = Uint8Array.from({ length: 4 * vertices }, (_, k) => (k % 4 === (k >> 2) % 3 ? 255 : 0));
        geometry.setAttribute("position", this.places);
        geometry.setAttribute("bary", new THREE.BufferAttribute(bary, 4, true));
        geometry.setAttribute("top", this.top);
        geometry.setAttribute("below", this.below);
        const { lineColour, lineAlpha, accent, hatchInk } = uniforms;
        this.mesh = new THREE.Mesh(geometry, new THREE.ShaderMaterial({
            vertexShader: vertex, fragmentShader: fragment, side: THREE.DoubleSide, uniforms: { lineColour, lineAlpha, accent, hatchInk },
        }));
        this.mesh.frustumCulled = this.mesh.visible = false;
    }

    /** The corners moved. */
    moved(): void {
        this.places.needsUpdate = true;
    }

    paint(lights: Lights, normals: Float32Array, tints: Uint8Array, marks: Uint8Array): void {
        shadePanels(lights, normals, tints, marks, this.top.array as Uint8Array, this.below.array as Uint8Array);
        this.top.needsUpdate = this.below.needsUpdate = true;
    }

    dispose(): void {
        this.mesh.geometry.dispose();
        this.mesh.material.dispose();
    }
}
