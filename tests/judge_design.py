#!/usr/bin/python3
"""Independent judge of an exported design (design JSON, version 1): every figure is computed from the positions in the file,
nothing is taken from its report. L is the mean flat edge.

usage: judge_design.py DESIGN.json [--target MESH.obj] [--limit KEY LE|GE VALUE]...
Prints every figure; with limits it exits with 1 if one does not hold. A figure that is missing holds no limit."""
import argparse
import json
import sys

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

CORNERS = ((1, 2), (2, 0), (0, 1))  # the ends of edge k, which lies opposite corner k


def edge_vectors(points, triangles):
    """Triangle by edge by coordinate."""
    return np.stack([points[triangles[:, j]] - points[triangles[:, i]] for i, j in CORNERS], axis=1)


def edge_lengths(points, triangles):
    return np.linalg.norm(edge_vectors(points, triangles), axis=2)


def equilateral_error(lengths):
    """Largest |edge / mean edge of its triangle - 1|; None without triangles."""
    if len(lengths) == 0:
        return None
    return float(np.abs(lengths / lengths.mean(axis=1, keepdims=True) - 1).max())


def overlap_depths(flat, triangles):
    """For every pair of flat triangles that may touch, how deep they overlap: the smallest overlap of their projections on
    the normals of their edges (separating axis theorem), negative or zero when apart."""
    centre = flat[triangles].mean(axis=1)
    reach = np.linalg.norm(flat[triangles] - centre[:, None], axis=2).max()
    pairs = cKDTree(centre).query_pairs(2 * reach, output_type="ndarray")
    depth = np.full(len(pairs), np.inf)
    both = [flat[triangles[pairs[:, side]]] for side in (0, 1)]
    for corners in both:
        for i, j in CORNERS:
            edge = corners[:, j] - corners[:, i]
            normal = np.stack([-edge[:, 1], edge[:, 0]], axis=1)
            normal /= np.linalg.norm(normal, axis=1, keepdims=True)
            a, b = [np.einsum("pkx,px->pk", side, normal) for side in both]
            depth = np.minimum(depth, np.minimum(a.max(1) - b.min(1), b.max(1) - a.min(1)))
    return depth


def mouth_angles(flat, triangles):
    """The smaller of the two gaps at each hinge that two triangles share, in degrees; negative where they overlap there."""
    hinge, corner = triangles.ravel(), np.arange(triangles.size) % 3
    owner = np.arange(triangles.size) // 3
    first = flat[triangles[owner, (corner + 1) % 3]] - flat[hinge]  # the corner spans, counter-clockwise, first to second
    second = flat[triangles[owner, (corner + 2) % 3]] - flat[hinge]
    order = np.argsort(hinge, kind="stable")
    shared = np.flatnonzero(hinge[order][1:] == hinge[order][:-1])
    a, b = order[shared], order[shared + 1]

    def turn(u, v):
        return np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1))

    # With the gaps g1 (from a to b) and g2 (from b to a), g1 + g2 is what the two corners leave of a full turn. The gap
    # g1 is known up to full turns: take the one nearest to half of that sum, where both gaps are equal.
    left = 2 * np.pi - turn(first[a], second[a]) - turn(first[b], second[b])
    g1 = turn(second[a], first[b])
    g1 += 2 * np.pi * np.round((left / 2 - g1) / (2 * np.pi))
    return np.degrees(np.minimum(g1, left - g1))


def closest_on_segments(points, starts, ends):
    """Distance of points to segments, row by row."""
    along = ends - starts
    t = ((points - starts) * along).sum(-1) / np.maximum((along * along).sum(-1), 1e-300)
    return np.linalg.norm(points - starts - np.clip(t, 0, 1)[..., None] * along, axis=-1)


def closest_on_triangles(points, a, b, c):
    """Distance of points to triangles, row by row: to the plane if the foot lies inside, else to the nearest edge."""
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    inside = length > 0
    for start, end in ((a, b), (b, c), (c, a)):
        inside &= (np.cross(end - start, points - start) * normal).sum(axis=1) >= 0
    edge = np.minimum(np.minimum(closest_on_segments(points, a, b), closest_on_segments(points, b, c)),
                      closest_on_segments(points, c, a))
    height = np.abs(((points - a) * normal).sum(axis=1)) / np.maximum(length, 1e-300)
    return np.where(inside, height, edge)


def distance_to_mesh(points, vertices, faces):
    """Exact distance of points to a triangle mesh. A face can only be nearest if its bounding sphere comes closer than the
    nearest vertex; faces of like size are searched together, so that a few large ones do not make every search wide."""
    centre = vertices[faces].mean(axis=1)
    radius = np.linalg.norm(vertices[faces] - centre[:, None], axis=2).max(axis=1)
    best = cKDTree(vertices[np.unique(faces)]).query(points)[0]
    for group in np.array_split(np.argsort(radius, kind="stable"), 12):
        if len(group) == 0:
            continue
        near = cKDTree(centre[group]).query_ball_point(points, best + radius[group].max() * (1 + 1e-12))
        count = np.array([len(faces_near) for faces_near in near])
        point = np.repeat(np.arange(len(points)), count)
        face = group[np.concatenate([np.asarray(faces_near, int) for faces_near in near])]
        for start in range(0, len(point), 1_000_000):
            part = slice(start, start + 1_000_000)
            corners = vertices[faces[face[part]]]
            np.minimum.at(best, point[part],
                          closest_on_triangles(points[point[part]], corners[:, 0], corners[:, 1], corners[:, 2]))
    return best


def boundary_edges(faces):
    """Edges that one face has, as pairs of vertices."""
    edges = np.concatenate([faces[:, [i, j]] for i, j in CORNERS])
    unique, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    return unique[count == 1]


def distance_to_boundary(points, vertices, faces):
    edges = boundary_edges(faces)
    return np.array([closest_on_segments(point, vertices[edges[:, 0]], vertices[edges[:, 1]]).min() for point in points])


def read_obj(path):
    vertices, faces = [], []
    with open(path) as lines:
        for line in lines:
            words = line.split()
            if words[:1] == ["v"]:
                vertices.append([float(word) for word in words[1:4]])
            elif words[:1] == ["f"]:
                corners = [int(word.split("/")[0]) for word in words[1:]]
                corners = [k - 1 if k > 0 else len(vertices) + k for k in corners]
                faces += [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]
    return np.array(vertices), np.array(faces)


def force_residual(triangles, simulated, edge_forces, loads, supports):
    """|force at free hinges| over the sum of the loads, from tensions along the edges."""
    force = loads.copy()
    edges = edge_vectors(simulated, triangles)
    pull = edge_forces[:, :, None] * edges / np.linalg.norm(edges, axis=2, keepdims=True)
    for k, (i, j) in enumerate(CORNERS):
        np.add.at(force, triangles[:, i], pull[:, k])
        np.add.at(force, triangles[:, j], -pull[:, k])
    free = np.ones(len(simulated), bool)
    free[supports] = False
    return float(np.linalg.norm(force[free]) / np.linalg.norm(loads, axis=1).sum())


def loop_faults(triangles, holes, openings):
    """Triangle edges that do not lie, turned round, on exactly one hole or opening, plus loop edges that are no triangle's."""
    turned = sorted((int(t[j]), int(t[i])) for t in triangles for i, j in CORNERS)
    sides = [(loop[k - 1], loop[k]) for loop in holes for k in range(len(loop))]
    sides += [(path[k], path[k + 1]) for path in openings for k in range(len(path) - 1)]
    return len(set(turned) ^ set(sides)) + len(turned) - len(set(turned)) + len(sides) - len(set(sides))


def hole_angles(points, holes):
    """Interior angles of hexagonal holes, degrees: 120 where fully open."""
    corner = points[holes]
    before, after = np.roll(corner, 1, axis=1) - corner, np.roll(corner, -1, axis=1) - corner
    cosine = (before * after).sum(-1) / (np.linalg.norm(before, axis=-1) * np.linalg.norm(after, axis=-1))
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def judge(design, target=None):
    """All figures of a design (the parsed JSON) in a dictionary; `target` is (vertices, faces)."""
    triangles = np.array(design["triangles"])
    flat, deployed = np.array(design["flat"], float), np.array(design["deployed"], float)
    count = np.bincount(triangles.ravel(), minlength=len(flat))
    rim = np.flatnonzero(count == 1)
    flat_lengths = edge_lengths(flat, triangles)
    L = float(flat_lengths.mean())
    inner = (count[triangles] == 2).all(axis=1)
    corners = triangles.ravel()
    graph = coo_matrix((np.ones(len(corners)), (corners, np.roll(triangles, 1, axis=1).ravel())), (len(flat), len(flat)))
    area = np.cross(flat[triangles[:, 1]] - flat[triangles[:, 0]], flat[triangles[:, 2]] - flat[triangles[:, 0]]) / 2
    depth = overlap_depths(flat, triangles)
    mouths = mouth_angles(flat, triangles)
    scale = np.array(design["scale"], float)

    figures = {
        "triangles": len(triangles),
        "hinges": len(flat),
        "hinge_valence_max": int(count.max()),
        "hinge_valence_min": int(count.min()),
        "components": int(connected_components(graph)[0]),
        "loop_faults": loop_faults(triangles, design["holes"], design["openings"]),
        "edge_mean": L,
        "congruence_max": float(np.abs(flat_lengths / edge_lengths(deployed, triangles) - 1).max()),
        "equilateral_inner_max": equilateral_error(flat_lengths[inner]),
        "equilateral_border_max": equilateral_error(flat_lengths[~inner]),
        "flipped_flat": int((area <= 0).sum()),
        "overlap_pairs": int((depth > 1e-6 * L).sum()),
        "mouth_min_deg": float(mouths.min()),
        "mouth_median_deg": float(np.median(mouths)),
        "scale_min": float(scale.min()),
        "scale_max": float(scale.max()),
    }
    hexagons = np.array([hole for hole in design["holes"] if len(hole) == 6])
    if len(hexagons):
        quantiles = np.percentile(hole_angles(deployed, hexagons), [5, 50, 95])
        figures.update(zip(("hole_angle_q05_deg", "hole_angle_median_deg", "hole_angle_q95_deg"), map(float, quantiles)))
    if target is not None:
        distance = distance_to_mesh(deployed, *target)
        figures["surface_max_over_L"] = float(distance.max() / L)
        figures["surface_rms_over_L"] = float(np.sqrt((distance**2).mean()) / L)
        figures["rim_max_over_L"] = float(distance_to_boundary(deployed[rim], *target).max() / L)
        figures["cover_p99_over_L"] = float(np.percentile(distance_to_mesh(target[0], deployed, triangles), 99) / L)
    if design["simulated"]:
        simulated = np.array(design["simulated"], float)
        supports = np.array(design["supports"], int)
        distance = np.linalg.norm(simulated - deployed, axis=1)
        figures["simulated_rms_over_L"] = float(np.sqrt((distance**2).mean()) / L)
        figures["simulated_max_over_L"] = float(distance.max() / L)
        figures["simulated_edge_error_max"] = float(np.abs(edge_lengths(simulated, triangles) / flat_lengths - 1).max())
        figures["support_move_max_over_L"] = float(distance[supports].max() / L)
        forces, loads = np.array(design["edge_forces"], float), np.array(design["load"]["forces"], float)
        figures["force_residual"] = force_residual(triangles, simulated, forces, loads, supports)
        figures["compressed_share"] = float((forces < 0).mean())
    return figures


def broken_limits(figures, limits):
    """Words for each (key, LE or GE, value) that does not hold."""
    broken = []
    for key, relation, value in limits:
        figure = figures.get(key)
        holds = figure is not None and (figure <= float(value) if relation == "LE" else figure >= float(value))
        if not holds:
            broken.append(f"{key} is {figure}, not {relation} {value}")
    return broken


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("design")
    parser.add_argument("--target", help="the target surface, an OBJ file")
    parser.add_argument("--limit", nargs=3, action="append", default=[], metavar=("KEY", "LE|GE", "VALUE"))
    arguments = parser.parse_args()
    with open(arguments.design) as file:
        design = json.load(file)
    figures = judge(design, read_obj(arguments.target) if arguments.target else None)
    for key, figure in figures.items():
        print(f"{key:28} {figure}")
    broken = broken_limits(figures, arguments.limit)
    print("\n".join(broken) if broken else f"all {len(arguments.limit)} limits hold")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
