// The grid: lines of one pixel drawn in the fragment shader, fading out at the size of the shell.
import * as THREE from "three";
import type { Look } from "./look";

export class Grid {
    readonly plane: THREE.Mesh<THREE.PlaneGeometry, THREE.ShaderMaterial>;

    constructor() {
        this.plane = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({
            transparent: true, depthWrite: false, side: THREE.DoubleSide,
            uniforms: {
                step: { value: 1 }, middle: { value: new THREE.Vector2() }, reach: { value: 1 }, minor: { value: new THREE.Color() },
                major: { value: new THREE.Color() }, alpha: { value: new THREE.Vector2() },
            },
            vertexShader: /* glsl */ `varying vec2 vPlace; void main() { vec4 p = modelMatrix * vec4(position, 1.0); vPlace = p.xy;
                gl_Position = projectionMatrix * viewMatrix * p; }`,
            fragmentShader: /* glsl */ `
                varying vec2 vPlace; uniform float step; uniform vec2 middle; uniform float reach; uniform vec3 minor; uniform vec3 major; uniform vec2 alpha;
                float lines(float every) {
                    vec2 g = vPlace / every;
                    vec2 w = fwidth(g);
                    vec2 d = abs(fract(g - 0.5) - 0.5) / max(w, vec2(1e-6));
                    vec2 crowd = 1.0 - smoothstep(0.15, 0.5, w);
                    vec2 l = (1.0 - smoothstep(0.0, 1.0, d)) * crowd;
                    return max(l.x, l.y);
                }
                void main() {
                    float away = 1.0 - smoothstep(0.2, 1.0, length(vPlace - middle) / reach);
                    float b = lines(step * 5.0);
                    float s = lines(step);
                    gl_FragColor = vec4(mix(minor, major, b), max(s * alpha.x, b * alpha.y) * away);
                }`,
        }));
        this.plane.renderOrder = -2;
    }

    setLook(look: Look): void {
        const u = this.plane.material.uniforms;
        u.minor.value.setStyle(look.gridMinor).convertLinearToSRGB();
        u.major.value.setStyle(look.gridMajor).convertLinearToSRGB();
        u.alpha.value.set(...look.gridAlpha);
    }

    place(x: number, y: number, z: number, radius: number, step: number): void {
        const u = this.plane.material.uniforms;
        const reach = 2.4 * radius;
        u.step.value = step;
        u.middle.value.set(x, y);
        u.reach.value = reach;
        this.plane.position.set(x, y, z);
        this.plane.scale.set(reach, reach, 1);
    }

    dispose(): void {
        this.plane.geometry.dispose();
        this.plane.material.dispose();
    }
}
