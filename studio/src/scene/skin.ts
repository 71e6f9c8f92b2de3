// Where the pointer meets the shell: a bounding volume hierarchy over panels and holes of one state. The three states share the
// skin's triangles, so a place found in one is carried to another by its barycentric coordinates.
import * as THREE from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { Linkage } from "../panels/linkage";

export interface SkinPoint {
    /** Index of the skin's triangle; below the number of panels it is a panel. */
    face: number;
    bary: [number, number, number];
    point: THREE.Vector3;
}

export class Skin {
    private readonly geometry = new THREE.BufferGeometry();
    private readonly bvh: MeshBVH;
    private stale = false;
    private readonly a = new THREE.Vector3();
    private readonly b = new THREE.Vector3();
    private readonly c = new THREE.Vector3();
    private readonly order: Uint32Array;
    readonly places: Float32Array;

    constructor(readonly linkage: Linkage, places: Float32Array) {
        this.places = places;
        this.geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
        this.geometry.setIndex(new THREE.BufferAttribute(linkage.skin, 1));
        this.bvh = new MeshBVH(this.geometry, { indirect: true });
        this.order = linkage.skin;
    }

    /** Places moved: refitted when next asked. */
    touch(): void {
        this.stale = true;
    }

    private ready(): MeshBVH {
        if (this.stale) {
            this.bvh.refit();
            this.stale = false;
        }
        return this.bvh;
    }

    cast(ray: THREE.Ray): SkinPoint | null {
        const hit = this.ready().raycastFirst(ray, THREE.DoubleSide);
        return hit ? this.pointOn(hit.faceIndex!, hit.point) : null;
    }

    nearest(point: THREE.Vector3): SkinPoint | null {
        const hit = this.ready().closestPointToPoint(point);
        return hit ? this.pointOn(hit.faceIndex, hit.point) : null;
    }

    /** The same place on this state. */
    carry(p: { face: number; bary: [number, number, number] }, out: THREE.Vector3): THREE.Vector3 {
        this.corners(p.face);
        return out.set(0, 0, 0).addScaledVector(this.a, p.bary[0]).addScaledVector(this.b, p.bary[1]).addScaledVector(this.c, p.bary[2]);
    }

    normal(face: number, out: THREE.Vector3): THREE.Vector3 {
        this.corners(face);
        return out.subVectors(this.b, this.a).cross(this.c.sub(this.a)).normalize();
    }

    /** The panel at a place: the panel itself, or the one nearest across the hole. */
    panelAt(p: SkinPoint): number {
        if (p.face < this.linkage.panels) return p.face;
        const hinge = this.hingeAt(p);
        const [a, b] = [this.linkage.around[2 * hinge], this.linkage.around[2 * hinge + 1]];
        if (b < 0) return a;
        return this.distanceTo(a, p.point) <= this.distanceTo(b, p.point) ? a : b;
    }

    hingeAt(p: SkinPoint): number {
        let best = -1;
        let least = Infinity;
        for (let k = 0; k < 3; k++) {
            const h = this.order[3 * p.face + k];
            const d = Math.hypot(this.places[3 * h] - p.point.x, this.places[3 * h + 1] - p.point.y, this.places[3 * h + 2] - p.point.z);
            if (d < least) {
                least = d;
                best = h;
            }
        }
        return best;
    }

    centre(panel: number, out: THREE.Vector3): THREE.Vector3 {
        this.corners(panel);
        return out.copy(this.a).add(this.b).add(this.c).divideScalar(3);
    }

    private distanceTo(panel: number, point: THREE.Vector3): number {
        return this.centre(panel, new THREE.Vector3()).distanceToSquared(point);
    }

    private corners(face: number): void {
        const [i, j, k] = [3 * this.order[3 * face], 3 * this.order[3 * face + 1], 3 * this.order[3 * face + 2]];
        this.a.fromArray(this.places, i);
        this.b.fromArray(this.places, j);
        this.c.fromArray(this.places, k);
    }

    private pointOn(face: number, point: THREE.Vector3): SkinPoint {
        this.corners(face);
        const bary = new THREE.Vector3();
        const inside = THREE.Triangle.getBarycoord(point, this.a, this.b, this.c, bary);
        return { face, bary: inside ? [bary.x, bary.y, bary.z] : [1 / 3, 1 / 3, 1 / 3], point: point.clone() };
    }
}
