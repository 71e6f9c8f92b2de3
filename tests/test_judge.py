#!/usr/bin/python3
"""The judge of designs against cases whose figures are known by other means."""
import unittest

import numpy as np

import judge_design as judge
import support.tap


def kagome(rows, theta_deg):
    """A rhombus of base triangles as a design: flat at `theta_deg`, deployed fully open in the plane, edges 1."""
    theta, spacing = np.radians(theta_deg), 2.0  # the base edge when fully open
    hinge_of, triangles, holes, flat, opened = {}, [], {}, {}, {}
    corner = lambda i, j: spacing * (i + j * np.exp(1j * np.pi / 3))
    for i in range(rows):
        for j in range(rows):
            for sign, base in ((1, ((i, j), (i + 1, j), (i, j + 1))), (-1, ((i + 1, j), (i + 1, j + 1), (i, j + 1)))):
                centre = sum(corner(*c) for c in base) / 3
                triangle = []
                for k in range(3):
                    a, b = base[(k + 1) % 3], base[(k + 2) % 3]
                    hinge = hinge_of.setdefault(frozenset((a, b)), len(hinge_of))
                    middle = (corner(*a) + corner(*b)) / 2
                    opened[hinge] = middle
                    flat[hinge] = centre * np.cos(theta) + (middle - centre) * np.exp(1j * sign * theta)
                    triangle.append(hinge)
                triangles.append(triangle)
                for k in range(3):  # turned edge k lies on the hole around base corner k
                    holes.setdefault(base[k], {})[triangle[(k + 2) % 3]] = triangle[(k + 1) % 3]
    loops, openings = [], []
    for following in holes.values():
        start = (set(following) - set(following.values())) or {min(following)}
        loop = [min(start)]
        while loop[-1] in following and following[loop[-1]] != loop[0]:
            loop.append(following[loop[-1]])
        (loops if loop[-1] in following else openings).append(loop)
    points = lambda z: [[z[h].real, z[h].imag] for h in range(len(z))]
    return {"triangles": triangles, "holes": loops, "openings": openings, "supports": [], "flat": points(flat),
            "deployed": [[*p, 0.0] for p in points(opened)], "simulated": None,
            "scale": [1 / np.cos(theta)] * len(triangles), "load": None, "edge_forces": None}


class Figures(unittest.TestCase):
    def test_uniform_lattice_has_its_analytic_figures(self):
        for theta in (10, 30, 55):
            figures = judge.judge(kagome(6, theta))
            self.assertEqual(figures["triangles"], 72)
            self.assertEqual((figures["components"], figures["loop_faults"]), (1, 0))
            self.assertEqual((figures["flipped_flat"], figures["overlap_pairs"]), (0, 0))
            self.assertLess(figures["congruence_max"], 1e-14)
            self.assertLess(figures["equilateral_inner_max"], 1e-14)
            self.assertAlmostEqual(figures["mouth_min_deg"], 120 - 2 * theta, 9)
            self.assertAlmostEqual(figures["mouth_median_deg"], 120 - 2 * theta, 9)
            self.assertAlmostEqual(figures["hole_angle_median_deg"], 120, 5)

    def test_overclosed_lattice_overlaps_and_its_mouths_are_negative(self):
        figures = judge.judge(kagome(6, 62))
        self.assertAlmostEqual(figures["mouth_min_deg"], -4, 9)
        self.assertGreater(figures["overlap_pairs"], 72)

    def test_stretched_edge_and_flipped_triangle_are_seen(self):
        design = kagome(4, 20)
        design["deployed"][design["triangles"][0][0]][2] += 0.01
        self.assertGreater(judge.judge(design)["congruence_max"], 1e-5)
        design = kagome(4, 20)
        a, b, c = design["triangles"][5]
        design["triangles"][5] = [a, c, b]
        figures = judge.judge(design)
        self.assertEqual(figures["flipped_flat"], 1)
        self.assertGreater(figures["loop_faults"], 0)

    def test_force_balance_of_a_hung_triangle(self):
        """Two corners held, a weight at the third: both sides pull with weight / (2 cos 30 degrees)."""
        height = np.sqrt(3) / 2
        triangles, simulated = np.array([[0, 1, 2]]), np.array([[0, 0, 0], [1, 0, 0], [0.5, 0, -height]])
        loads = np.array([[0, 0, 0], [0, 0, 0], [0, 0, -6.0]])
        pull = 6 / (2 * height)
        balanced = judge.force_residual(triangles, simulated, np.array([[pull, pull, 0.0]]), loads, [0, 1])
        self.assertLess(balanced, 1e-15)
        pushed = judge.force_residual(triangles, simulated, np.array([[-pull, -pull, 0.0]]), loads, [0, 1])
        self.assertAlmostEqual(pushed, 2)

    def test_distances_to_a_mesh_are_those_of_trying_every_face(self):
        random = np.random.default_rng(1)
        vertices = random.normal(size=(60, 3)) * [1, 1, 0.1]
        faces = random.choice(60, size=(120, 3))
        faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
        points = random.normal(size=(200, 3))
        a, b, c = (vertices[faces[:, k]] for k in range(3))
        every = [judge.closest_on_triangles(np.repeat(p[None], len(faces), 0), a, b, c).min() for p in points]
        self.assertLess(np.abs(judge.distance_to_mesh(points, vertices, faces) - every).max(), 1e-14)

    def test_distances_to_one_triangle_are_known(self):
        a, b, c = (np.array([p], float) for p in ([0, 0, 0], [1, 0, 0], [0, 1, 0]))
        for point, expected in (([0.2, 0.2, 3], 3), ([-3, -4, 0], 5), ([0.5, -2, 0], 2), ([1, 1, 0], np.sqrt(0.5))):
            self.assertAlmostEqual(judge.closest_on_triangles(np.array([point], float), a, b, c)[0], expected)

    def test_boundary_of_a_square_is_its_four_sides(self):
        vertices, faces = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]), np.array([[0, 1, 2], [0, 2, 3]])
        self.assertEqual(judge.boundary_edges(faces).tolist(), [[0, 1], [0, 3], [1, 2], [2, 3]])
        self.assertAlmostEqual(judge.distance_to_boundary(np.array([[0.5, 0.4, 0.0]]), vertices, faces)[0], 0.4)

    def test_limits_fail_on_missing_figures_and_on_nan(self):
        figures = {"a": 1.0, "b": float("nan")}
        self.assertEqual(judge.broken_limits(figures, [("a", "LE", "1"), ("a", "GE", "1")]), [])
        self.assertEqual(len(judge.broken_limits(figures, [("b", "LE", "1"), ("b", "GE", "0"), ("c", "LE", "9")])), 3)


if __name__ == "__main__":
    support.tap.main()
