import { describe, expect, it } from "vitest";
import * as THREE from "three";
import { OrbitCamera, presets } from "../src/scene/camera";
import { gestureOf, wheelOf } from "../src/scene/navigation";

const box = Float32Array.from([-5, -4, 0, 5, -4, 0, 5, 4, 0, -5, 4, 0, 0, 0, 2.4]);

describe("framing", () => {
    it.each(Object.keys(presets) as (keyof typeof presets)[])("%s fills the share asked and no more", (name) => {
        const orbit = new OrbitCamera();
        orbit.resize(900, 700);
        orbit.go(orbit.framed(box, presets[name], 900, 700, 0.88, 0), false);
        orbit.update(0, 7);
        let [x, y] = [0, 0];
        const p = new THREE.Vector3();
        for (let i = 0; i < box.length; i += 3) {
            p.fromArray(box, i).project(orbit.camera);
            x = Math.max(x, Math.abs(p.x));
            y = Math.max(y, Math.abs(p.y));
        }
        expect(Math.max(x / 0.88, y / 0.72)).toBeCloseTo(1, 2);
    });
    it("keeps the size of what is at the target between perspective and parallel", () => {
        const orbit = new OrbitCamera();
        orbit.resize(800, 600);
        const heights = (["perspective", "parallel"] as const).map((projection) => {
            orbit.go({ ...orbit.pose, projection }, false);
            orbit.update(0, 5);
            const right = new THREE.Vector3(1, 0, 0).applyQuaternion(orbit.camera.quaternion);
            return right.project(orbit.camera).x;
        });
        expect(heights[0]).toBeCloseTo(heights[1], 2);
    });
    it("zooms about the pointer: what is under it stays there", () => {
        const orbit = new OrbitCamera();
        orbit.resize(800, 600);
        orbit.go({ ...orbit.pose, ...presets.top, distance: 12 }, false);
        orbit.update(0, 5);
        const place = new THREE.Vector3(0.4, -0.3, 0).unproject(orbit.camera);
        orbit.zoom(0.5, 0.4, -0.3);
        orbit.update(0, 5);
        const again = place.project(orbit.camera);
        expect([again.x, again.y]).toEqual([expect.closeTo(0.4, 3), expect.closeTo(-0.3, 3)]);
    });
    it("turns the short way round", () => {
        const orbit = new OrbitCamera();
        orbit.go({ ...orbit.pose, azimuth: 350 }, false);
        orbit.go({ ...orbit.pose, azimuth: 10 }, true);
        orbit.update(performance.now() + 120, 5);
        expect(Math.cos((orbit.pose.azimuth * Math.PI) / 180)).toBeGreaterThan(0.98);
    });
});

describe("navigation", () => {
    const press = (button: number, keys: Partial<{ shiftKey: boolean; ctrlKey: boolean; altKey: boolean }> = {}) => ({ button, shiftKey: false, ctrlKey: false, altKey: false, ...keys });
    it("leaves the left button to the tool", () => {
        for (const preset of ["rhino", "blender", "touchpad"] as const) expect(gestureOf(preset, press(0), false)).toBeNull();
    });
    it("is as in Rhino and in Blender", () => {
        expect([gestureOf("rhino", press(2), false), gestureOf("rhino", press(2, { shiftKey: true }), false), gestureOf("rhino", press(2), true)]).toEqual(["orbit", "pan", "pan"]);
        expect([gestureOf("blender", press(1), false), gestureOf("blender", press(1, { shiftKey: true }), false)]).toEqual(["orbit", "pan"]);
        expect([wheelOf("rhino", { ctrlKey: false, shiftKey: false }, false), wheelOf("touchpad", { ctrlKey: false, shiftKey: false }, false), wheelOf("touchpad", { ctrlKey: true, shiftKey: false }, false)]).toEqual(["zoom", "orbit", "zoom"]);
    });
});
