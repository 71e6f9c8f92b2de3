// Supports as small cones and their reactions as thin arrows, in ink.
import * as THREE from "three";
import type { Shell } from "../panels/shell";

const up = new THREE.Vector3(0, 0, 1);

export class Supports {
    readonly group = new THREE.Group();
    private readonly ink = new THREE.MeshBasicMaterial();
    private readonly cone = new THREE.ConeGeometry(1, 2, 12).rotateX(Math.PI / 2).translate(0, 0, -1);
    private readonly shaft = new THREE.CylinderGeometry(1, 1, 1, 6).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    private readonly head = new THREE.ConeGeometry(1, 1, 10).rotateX(Math.PI / 2).translate(0, 0, -0.5);

    /** Largest reaction, N. */
    show(shell: Shell, places: Float32Array, edge: number, radius: number, ink: string): number {
        for (const child of this.group.children) (child as THREE.InstancedMesh).dispose();
        this.group.clear();
        this.ink.color.setStyle(ink);
        const held: number[] = [];
        shell.supports.forEach((on, h) => on && held.push(h));
        if (held.length === 0) return 0;
        const cone = Math.max(0.2 * edge, 0.007 * radius);
        const cones = new THREE.InstancedMesh(this.cone, this.ink, held.length);
        const matrix = new THREE.Matrix4();
        const at = new THREE.Vector3();
        const size = new THREE.Vector3().setScalar(cone);
        const none = new THREE.Quaternion();
        held.forEach((h, k) => cones.setMatrixAt(k, matrix.compose(at.fromArray(places, 3 * h), none, size)));
        this.group.add(cones);
        let largest = 0;
        const r = shell.reactions;
        if (r) {
            for (const h of held) largest = Math.max(largest, Math.hypot(r[3 * h], r[3 * h + 1], r[3 * h + 2]));
            const shafts = new THREE.InstancedMesh(this.shaft, this.ink, held.length);
            const heads = new THREE.InstancedMesh(this.head, this.ink, held.length);
            const way = new THREE.Vector3();
            const turn = new THREE.Quaternion();
            held.forEach((h, k) => {
                way.fromArray(r, 3 * h);
                const length = (0.1 * radius * way.length()) / (largest || 1);
                turn.setFromUnitVectors(up, way.normalize());
                at.fromArray(places, 3 * h);
                shafts.setMatrixAt(k, matrix.compose(at, turn, new THREE.Vector3(0.12 * cone, 0.12 * cone, Math.max(1e-6, length))));
                const s = Math.min(1.6 * cone, length);
                heads.setMatrixAt(k, matrix.compose(at.addScaledVector(way, length), turn, new THREE.Vector3(0.35 * s, 0.35 * s, s)));
            });
            this.group.add(shafts, heads);
        }
        for (const child of this.group.children) child.frustumCulled = false;
        return largest;
    }

    dispose(): void {
        for (const child of this.group.children) (child as THREE.InstancedMesh).dispose();
        for (const g of [this.cone, this.shaft, this.head]) g.dispose();
        this.ink.dispose();
    }
}
