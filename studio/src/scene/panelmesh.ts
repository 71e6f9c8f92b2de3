// Panels and joints of one state as two instanced meshes. Per frame 9 numbers per panel and 6 per joint go to the graphics card.
// What moves on a slow renderer is drawn without it.
import * as THREE from "three";
import { hexToRgb } from "../panels/colour";
import { type Detail, drawn, makeTemplate } from "../panels/template";
import type { Linkage } from "../panels/linkage";
import { gather, medianEdge } from "../panels/linkage";
import { hingeNormals, panelNormals } from "../panels/measures";
import { type Inks, type Picture, type Sight, type Window, drawShell } from "../panels/raster";
import type { Lights } from "../panels/shade";
import type { Look } from "./look";

/** Marks of a panel, read by the fragment shader. */
export const mark = { none: 0, selected: 128, hatched: 192 };

const vertexHead = /* glsl */ `
attribute vec3 bary; attribute vec3 level; attribute vec3 outward; attribute vec3 along;
attribute vec3 cornerA; attribute vec3 cornerB; attribute vec3 cornerC;
attribute vec4 tint; attribute float marked; attribute vec3 force;
uniform float thickness; uniform float bevel;
varying vec3 vBary; varying vec3 vTint; varying float vMark; varying float vKind; varying vec3 vForce;
vec3 panelUp() { return normalize(cross(cornerB - cornerA, cornerC - cornerA)); }
vec3 panelPlace() {
    return bary.x * cornerA + bary.y * cornerB + bary.z * cornerC + panelUp() * (thickness * (level.x - 0.5) - bevel * level.y);
}
vec3 panelNormal() {
    vec3 up = panelUp();
    if (level.z < 0.5) return up;
    if (level.z > 2.5) return -up;
    vec3 d = normalize(along.x * cornerA + along.y * cornerB + along.z * cornerC);
    vec3 o = outward.x * cornerA + outward.y * cornerB + outward.z * cornerC;
    o = normalize(o - d * dot(o, d));
    return level.z < 1.5 ? normalize(o + up) : o;
}
`;

const fragmentHead = /* glsl */ `
varying vec3 vBary; varying vec3 vTint; varying float vMark; varying float vKind; varying vec3 vForce;
uniform vec3 lineColour; uniform float lineAlpha; uniform vec3 accent; uniform vec3 hatchInk; uniform float clip; uniform float inset;
uniform sampler2D forceMap; uniform float forceBars; uniform float fade;
vec3 fromDisplay(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
// Distance to the outline in pixels, from barycentric coordinates.
float outlinePixels() {
    vec3 side = (vBary - inset) / max(fwidth(vBary), vec3(1e-6));
    vec3 corner = (1.0 - clip - vBary) / max(fwidth(vBary), vec3(1e-6));
    float a = min(side.x, min(side.y, side.z));
    return clip > 0.0 ? min(a, min(corner.x, min(corner.y, corner.z))) : a;
}
`;

const tintChunk = /* glsl */ `
float shade = vKind < 1.5 ? 1.0 : vKind < 2.5 ? 0.62 : 0.55;
vec3 shown = vTint;
if (forceBars > 0.5) {
    vec3 near = vBary - inset;
    float width = 0.0;
    vec3 bar = vec3(0.0);
    for (int k = 0; k < 3; k++) {
        float w = (0.05 + 0.09 * abs(vForce[k])) * 1.1547;
        if (near[k] < w && vKind < 1.5) { bar = texture2D(forceMap, vec2(0.5 + 0.5 * clamp(vForce[k], -1.0, 1.0), 0.5)).rgb; width = 1.0; }
    }
    vec3 rest = mix(vec3(0.93), vTint, 0.42);
    shown = width > 0.5 ? bar : rest;
}
diffuseColor.rgb = fromDisplay(shown) * shade;
`;

const finishChunk = /* glsl */ `
if (vKind < 1.5) {
    float d = outlinePixels();
    bool selected = vMark > 0.4 && vMark < 0.6;
    bool hatched = vMark > 0.7;
    if (hatched) {
        float s = fract((gl_FragCoord.x + gl_FragCoord.y) / 8.0);
        gl_FragColor.rgb = mix(gl_FragColor.rgb, hatchInk, smoothstep(0.5, 0.62, s) * (1.0 - smoothstep(0.88, 1.0, s)));
    }
    if (selected) gl_FragColor.rgb = mix(gl_FragColor.rgb, accent, 0.12);
    float width = selected ? 2.0 : 1.0;
    float inside = 1.0 - smoothstep(width - 0.6, width + 0.2, d);
    vec3 colour = selected ? accent : hatched ? hatchInk : lineColour;
    gl_FragColor.rgb = mix(gl_FragColor.rgb, colour, inside * (selected ? 1.0 : lineAlpha));
}
if (fade > 0.0) gl_FragColor.rgb = mix(gl_FragColor.rgb, vec3(dot(gl_FragColor.rgb, vec3(0.299, 0.587, 0.114))), fade);
`;

interface Uniforms {
    [name: string]: { value: unknown };
}

function placeVertices(shader: { vertexShader: string; uniforms: Record<string, unknown> }, uniforms: Uniforms): void {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
        .replace("#include <common>", "#include <common>\n" + vertexHead)
        .replace("#include <beginnormal_vertex>", "vec3 objectNormal = panelNormal();")
        .replace("#include <begin_vertex>",
            "vec3 transformed = panelPlace();\nvBary = bary; vTint = tint.rgb; vMark = marked; vKind = level.z; vForce = force;");
}

/** 0xBBGGRR of a colour in style sheets. */
function inkOf(style: string): number {
    const [r, g, b] = hexToRgb(style);
    return (b << 16) | (g << 8) | r;
}

export class PanelMesh {
    readonly group = new THREE.Group();
    /** The panels as one mesh of triangles. */
    readonly plainGeometry = new THREE.BufferGeometry();
    /** Length of a median panel edge; all drawn sizes hang on it. */
    edge = 1;
    readonly places: Float32Array;
    private readonly linkage: Linkage;
    private readonly corners: Float32Array;
    private readonly cornerBuffer: THREE.InstancedInterleavedBuffer;
    private readonly tint: THREE.InstancedBufferAttribute;
    private readonly marks: THREE.InstancedBufferAttribute;
    private readonly force: THREE.InstancedBufferAttribute;
    private readonly geometries = new Map<Detail, THREE.InstancedBufferGeometry>();
    private readonly mesh: THREE.Mesh<THREE.InstancedBufferGeometry, THREE.MeshStandardMaterial>;
    private readonly plainPlaces: THREE.BufferAttribute;
    private lights: Lights = { lamps: [], sky: [0, 0, 0], ground: [0, 0, 0] };
    private readonly joints: THREE.Mesh<THREE.InstancedBufferGeometry, THREE.MeshStandardMaterial>;
    private readonly jointPlaces: THREE.InstancedBufferAttribute;
    private readonly jointUps: THREE.InstancedBufferAttribute;
    private readonly normals: Float32Array;
    private readonly uniforms: Uniforms;
    private readonly jointUniforms: Uniforms;
    private readonly forceMap: THREE.DataTexture;
    private detail: Detail = "full";
    private jointsStale = true;
    private normalsStale = true;
    private fixedEdge = false;

    constructor(linkage: Linkage, look: Look) {
        this.linkage = linkage;
        const n = linkage.panels;
        this.places = new Float32Array(3 * linkage.hinges);
        this.corners = new Float32Array(9 * n);
        this.cornerBuffer = new THREE.InstancedInterleavedBuffer(this.corners, 9);
        this.cornerBuffer.setUsage(THREE.DynamicDrawUsage);
        this.tint = new THREE.InstancedBufferAttribute(new Uint8Array(4 * n).fill(160), 4, true);
        this.marks = new THREE.InstancedBufferAttribute(new Uint8Array(n), 1, true);
        this.force = new THREE.InstancedBufferAttribute(new Float32Array(3 * n), 3);
        this.normals = new Float32Array(3 * n);
        this.forceMap = new THREE.DataTexture(new Uint8Array(4 * 256), 256, 1, THREE.RGBAFormat);
        this.forceMap.magFilter = this.forceMap.minFilter = THREE.LinearFilter;
        this.uniforms = {
            thickness: { value: 0 }, bevel: { value: 0 }, lineColour: { value: new THREE.Color() }, lineAlpha: { value: 0 },
            accent: { value: new THREE.Color() }, hatchInk: { value: new THREE.Color(0x0b0d10).convertLinearToSRGB() },
            clip: { value: drawn.clip }, inset: { value: drawn.inset * 1.1547 }, forceMap: { value: this.forceMap },
            forceBars: { value: 0 }, fade: { value: 0 },
        };
        const material = new THREE.MeshStandardMaterial({ roughness: 0.62, metalness: 0 });
        material.onBeforeCompile = (shader) => {
            placeVertices(shader, this.uniforms);
            shader.fragmentShader = shader.fragmentShader
                .replace("#include <common>", "#include <common>\n" + fragmentHead)
                .replace("#include <color_fragment>", tintChunk)
                .replace("#include <dithering_fragment>", finishChunk);
        };
        const depth = new THREE.MeshDepthMaterial({ depthPacking: THREE.RGBADepthPacking });
        depth.onBeforeCompile = (shader) => placeVertices(shader, this.uniforms);
        this.mesh = new THREE.Mesh(this.geometry("full"), material);
        this.mesh.customDepthMaterial = depth;
        this.mesh.frustumCulled = false;
        this.mesh.castShadow = this.mesh.receiveShadow = true;

        this.plainPlaces = new THREE.BufferAttribute(this.corners, 3).setUsage(THREE.DynamicDrawUsage);
        this.plainGeometry.setAttribute("position", this.plainPlaces);

        const cylinder = new THREE.CylinderGeometry(1, 1, 1, 16, 1).rotateX(Math.PI / 2);
        const joint = new THREE.InstancedBufferGeometry();
        joint.index = cylinder.index;
        joint.setAttribute("position", cylinder.getAttribute("position"));
        joint.setAttribute("normal", cylinder.getAttribute("normal"));
        this.jointPlaces = new THREE.InstancedBufferAttribute(this.places, 3);
        this.jointUps = new THREE.InstancedBufferAttribute(new Float32Array(3 * linkage.hinges), 3);
        this.jointPlaces.setUsage(THREE.DynamicDrawUsage);
        this.jointUps.setUsage(THREE.DynamicDrawUsage);
        joint.setAttribute("place", this.jointPlaces);
        joint.setAttribute("up", this.jointUps);
        joint.instanceCount = linkage.hinges;
        this.jointUniforms = { size: { value: new THREE.Vector2() } };
        const metal = new THREE.MeshStandardMaterial({ roughness: 0.38, metalness: 0.35 });
        metal.onBeforeCompile = (shader) => {
            Object.assign(shader.uniforms, this.jointUniforms);
            shader.vertexShader = shader.vertexShader
                .replace("#include <common>", `#include <common>
attribute vec3 place; attribute vec3 up; uniform vec2 size;
mat3 jointFrame() {
    vec3 x = normalize(cross(abs(up.x) < 0.8 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0), up));
    return mat3(x, cross(up, x), up);
}`)
                .replace("#include <beginnormal_vertex>", "vec3 objectNormal = jointFrame() * normal;")
                .replace("#include <begin_vertex>", "vec3 transformed = place + jointFrame() * (position * vec3(size.x, size.x, size.y));");
        };
        this.joints = new THREE.Mesh(joint, metal);
        this.joints.frustumCulled = false;
        this.joints.receiveShadow = true;
        this.group.add(this.mesh, this.joints);
        this.setLook(look);
    }

    setLook(look: Look): void {
        (this.uniforms.lineColour.value as THREE.Color).setStyle(look.line).convertLinearToSRGB();
        (this.uniforms.accent.value as THREE.Color).setStyle(look.accent).convertLinearToSRGB();
        this.uniforms.lineAlpha.value = look.lineAlpha;
        this.lineAlpha = look.lineAlpha;
        this.inks = { line: inkOf(look.line), accent: inkOf(look.accent), hatch: inkOf("#0b0d10") };
        this.joints.material.color.setStyle(look.joint);
    }
    private lineAlpha = 0;
    private inks: Omit<Inks, "lineAlpha"> = { line: 0, accent: 0, hatch: 0 };

    setLights(lights: Lights): void {
        this.lights = lights;
    }

    /** How panels look without the renderer, as strongly outlined as `setDetail` said last. */
    sight(window: Window): Sight {
        return { window, lights: this.lights, inks: { ...this.inks, lineAlpha: this.uniforms.lineAlpha.value as number } };
    }

    /** Into a picture: one triangle per panel. */
    drawQuick(picture: Picture, window: Window): void {
        drawShell(picture, this.sight(window), this.linkage.triangles, this.places, this.tint.array as Uint8Array, this.shownMarks, this.normals);
        this.normalsStale = false;
    }

    get shownMarks(): Uint8Array {
        return this.marks.array as Uint8Array;
    }

    /** Level of detail and the outline's strength for so many pixels per panel edge. */
    setDetail(detail: Detail, pixels: number): void {
        const fade = Math.max(0, Math.min(1, (pixels - 6) / 8));
        this.uniforms.lineAlpha.value = Math.min(this.lineAlpha, 0.12) + fade * (this.lineAlpha - Math.min(this.lineAlpha, 0.12));
        this.joints.visible = detail === "full";
        this.uniforms.clip.value = detail === "full" ? drawn.clip : 0;
        this.uniforms.inset.value = detail === "flat" ? 0 : drawn.inset * 1.1547;
        if (detail !== this.detail) {
            this.detail = detail;
            this.mesh.geometry = this.geometry(detail);
        }
        if (this.joints.visible && this.jointsStale) this.placeJoints();
    }

    setPlaces(places: Float32Array): void {
        this.places.set(places);
        gather(this.linkage.triangles, this.places, this.corners);
        this.cornerBuffer.needsUpdate = true;
        this.plainPlaces.needsUpdate = true;
        this.jointsStale = this.normalsStale = true;
        if (!this.fixedEdge) {
            this.edge = medianEdge(this.linkage, this.places);
            this.fixedEdge = true;
            this.uniforms.thickness.value = drawn.thickness * this.edge;
            this.uniforms.bevel.value = drawn.bevel * this.edge;
            (this.jointUniforms.size.value as THREE.Vector2).set(drawn.jointRadius * this.edge, drawn.jointHeight * this.edge);
        }
        if (this.joints.visible) this.placeJoints();
    }

    private placeJoints(): void {
        this.placeNormals();
        hingeNormals(this.linkage, this.normals, this.jointUps.array as Float32Array);
        this.jointPlaces.needsUpdate = this.jointUps.needsUpdate = true;
        this.jointsStale = false;
    }

    private placeNormals(): void {
        if (this.normalsStale) panelNormals(this.linkage.triangles, this.places, this.normals);
        this.normalsStale = false;
    }

    /** Four bytes per panel. */
    setTints(tints: Uint8Array): void {
        (this.tint.array as Uint8Array).set(tints);
        this.tint.needsUpdate = true;
    }

    setMarks(marks: Uint8Array): void {
        (this.marks.array as Uint8Array).set(marks);
        this.marks.needsUpdate = true;
    }

    /** Edge forces over their scale's end, 3 per panel, and the map they are drawn with; null draws none. */
    setForces(forces: Float32Array | null, table: Uint8Array): void {
        this.uniforms.forceBars.value = forces ? 1 : 0;
        if (!forces) return;
        (this.force.array as Float32Array).set(forces);
        this.force.needsUpdate = true;
        const pixels = this.forceMap.image.data as Uint8Array;
        for (let i = 0; i < 256; i++) pixels.set([table[3 * i], table[3 * i + 1], table[3 * i + 2], 255], 4 * i);
        this.forceMap.needsUpdate = true;
    }

    /** 0 as they are, 1 grey: when the link is lost. */
    setFade(fade: number): void {
        this.uniforms.fade.value = fade;
    }

    dispose(): void {
        for (const g of this.geometries.values()) g.dispose();
        this.joints.geometry.dispose();
        this.mesh.material.dispose();
        this.plainGeometry.dispose();
        this.mesh.customDepthMaterial?.dispose();
        this.joints.material.dispose();
        this.forceMap.dispose();
    }

    private geometry(detail: Detail): THREE.InstancedBufferGeometry {
        const known = this.geometries.get(detail);
        if (known) return known;
        const template = makeTemplate(detail);
        const geometry = new THREE.InstancedBufferGeometry();
        geometry.setIndex(new THREE.BufferAttribute(template.index, 1));
        const bary = new THREE.BufferAttribute(template.bary, 3);
        geometry.setAttribute("position", bary); // never read as a place; its count is
        geometry.setAttribute("bary", bary);
        geometry.setAttribute("level", new THREE.BufferAttribute(template.level, 3));
        geometry.setAttribute("outward", new THREE.BufferAttribute(template.outward, 3));
        geometry.setAttribute("along", new THREE.BufferAttribute(template.along, 3));
        geometry.setAttribute("cornerA", new THREE.InterleavedBufferAttribute(this.cornerBuffer, 3, 0));
        geometry.setAttribute("cornerB", new THREE.InterleavedBufferAttribute(this.cornerBuffer, 3, 3));
        geometry.setAttribute("cornerC", new THREE.InterleavedBufferAttribute(this.cornerBuffer, 3, 6));
        geometry.setAttribute("tint", this.tint);
        geometry.setAttribute("marked", this.marks);
        geometry.setAttribute("force", this.force);
        geometry.instanceCount = this.linkage.panels;
        this.geometries.set(detail, geometry);
        return geometry;
    }
}
