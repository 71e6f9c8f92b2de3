#!/usr/bin/python3
"""Random recipes as a designer might write them, judged by their files alone: whatever is called settled has no flipped panel, no overlap in
the flat state and one set of edges; whatever is called exact is so, and its rim lies on its curve. AUXSHELL names the program, AX_SEED another
beginning, AX_RECIPES another number of recipes and AX_PANELS the most panels of one."""
import json
import math
import os
import random
import unittest

import numpy as np

import support.tap
from judge_design import closest_on_segments, judge
from support.command import QUICK, CommandCase, run

SEED, COUNT, PANELS = (int(os.environ.get(name, usual)) for name, usual in
                       (("AX_SEED", 1), ("AX_RECIPES", 8 if QUICK else 24), ("AX_PANELS", 250)))


def rounded(operator):
    """With numbers as people write them."""
    return json.loads(json.dumps(operator), parse_float=lambda text: round(float(text), 3))


def sheet(draw):
    """An operator that starts a design, and half its extents."""
    common = {"triangles": round(math.exp(draw.uniform(math.log(100), math.log(PANELS)))), "scale": draw.uniform(1.1, 1.6),
              "angle": draw.choice([0, 0, 30, 17])}
    kind = draw.choice(["circle", "circle", "rectangle", "polygon", "outline"])
    fillet = draw.choice([0, 0.2])
    if kind == "circle":
        return {"op": "start_circle", "radius": 1, **common}, (1, 1)
    if kind == "rectangle":
        width, height = draw.uniform(1.4, 3), draw.uniform(1.2, 2)
        return {"op": "start_rectangle", "width": width, "height": height, "fillet": fillet, **common}, (width / 2, height / 2)
    if kind == "polygon":
        return {"op": "start_polygon", "sides": draw.randint(3, 8), "radius": 1.2, "fillet": fillet, **common}, (1.1, 1.1)
    corners = draw.randint(5, 9)
    points = [[draw.uniform(0.85, 1.2) * math.cos(2 * math.pi * k / corners), draw.uniform(0.7, 1.2) * math.sin(2 * math.pi * k / corners)]
              for k in range(corners)]
    return {"op": "start_outline", "points": points, "fillet": fillet / 2, **common}, (1, 1)


def stroke(draw, half):
    at = [draw.uniform(-0.7, 0.7) * half[0], draw.uniform(-0.7, 0.7) * half[1]]
    kind = draw.choice(["paint", "paint", "paint", "add", "linear", "radial", "formula", "smooth", "clamp", "fill", "curvature"])
    if kind == "paint":
        return {"op": "paint", "points": [at], "radius": draw.uniform(0.2, 1.2), "value": draw.uniform(1, 2),
                "falloff": draw.choice(["sphere", "flat", "linear", "gauss"]), "copies": draw.choice([1, 1, 2, 3, 6]),
                "mirror": draw.random() < 0.3}
    if kind == "add":
        return {"op": "paint", "mode": draw.choice(["add", "subtract"]), "points": [at, [-at[1], at[0]]], "radius": draw.uniform(0.2, 1),
                "value": draw.uniform(0.05, 0.5)}
    if kind == "linear":
        return {"op": "gradient_linear", "from": at, "to": [at[0] + 1, at[1] + draw.uniform(-1, 1)],
                "from_value": draw.uniform(1.05, 1.8), "to_value": draw.uniform(1.05, 1.8)}
    if kind == "radial":
        return {"op": "gradient_radial", "radius": draw.uniform(0.5, 1.5), "inner": draw.uniform(1.1, 1.95),
                "outer": draw.uniform(1.05, 1.5), "falloff": draw.choice(["sphere", "flat", "linear", "gauss"])}
    if kind == "formula":
        return {"op": "formula", "formula": draw.choice([
            "1.3 + 0.4*exp(-(x^2+y^2)/0.5)", "r < 0.5 ? 1.9 : 1.2", "1.4 + 0.2*cos(3*theta)*r", "s + 0.2*sin(4*x)*sin(4*y)",
            "1.9/(1 + 0.5*r^2)", "2.4 - r"])}
    if kind == "smooth":
        return {"op": "smooth", "amount": draw.uniform(0.05, 0.5)}
    if kind == "clamp":
        return {"op": "clamp", "lo": draw.uniform(1, 1.3), "hi": draw.uniform(1.4, 1.9)}
    if kind == "fill":
        return {"op": "fill", "value": draw.uniform(1.05, 1.95),
                "hinges": draw.choice(["all", "disc(0,0,0.5)", "box(-1,-1,0,1)", "disc(0.3,0.2,0.6), !rim"])}
    return {"op": "paint_curvature", "points": [at], "radius": draw.uniform(0.3, 0.9), "curvature": draw.uniform(-0.5, 0.8)}


def rim(draw, half, words="rim"):
    larger = draw.uniform(0.9, 1.35)
    a, b = half[0] * larger, half[1] * larger * draw.uniform(0.9, 1.1)
    part = {"hinges": words} if words != "rim" else {}
    kind = draw.choice(["circle", "ellipse", "ellipse", "rectangle", "polyline", "spline", "fixed", "fixed sheet"])
    if kind == "circle":
        return {"op": "rim_circle", "radius": (a + b) / 2, **part}
    if kind == "ellipse":
        return {"op": "rim_ellipse", "a": [a, 0, 0], "b": [0, b, 0], **part}
    if kind == "rectangle":
        return {"op": "rim_rectangle", "width": 2 * a, "height": 2 * b, "fillet": draw.choice([0, 0.3 * min(a, b)]), **part}
    if kind in ("polyline", "spline"):
        count = draw.randint(4, 10)
        points = [[a * math.cos(2 * math.pi * k / count), b * math.sin(2 * math.pi * k / count), draw.uniform(0, 0.3)] for k in range(count)]
        return {"op": "rim_" + kind, "points": points, **part}
    return {"op": "rim_fixed", "at": "sheet" if kind == "fixed sheet" else "flat", **part}


def hold(draw, number):
    line = draw.choice(["box(-9,-0.05,9,0.05)", "box(-0.05,-9,0.05,9)", "disc(0,0,0.3)", "line(10,40)"])
    return draw.choice([
        {"op": "hold_fair", "weight": draw.choice([0.02, 0.1])},
        {"op": "hold_plane", "hinges": line, "weight": draw.choice([0.3, 1, 5])},
        {"op": "hold_plane_given", "hinges": "box(-9,-0.05,9,0.05)", "normal": [0, 1, 0]},
        {"op": "hold_mirror", "angle": draw.choice([0, 90])},
        {"op": "hold_rotation", "order": draw.choice([2, 3, 6])},
        {"op": "hold_fixed", "name": f"peg-{number}", "hinges": "disc(0,0,0.2)", "at": "sheet"},
        {"op": "hold_line", "hinges": "line(10,40)"},
        {"op": "hold_curve", "hinges": "box(-9,-0.05,9,0.05)", "points": [[-1.1, 0, 0], [0, 0, -0.5], [1.1, 0, 0]]},
    ])


def motion(draw):
    return draw.choice([
        {"op": "gravity"}, {"op": "gravity"}, {"op": "gravity", "adopt": True}, {"op": "gravity", "direction": [0, 0, 1]},
        {"op": "gravity", "adapt": False}, {"op": "inflation"}, {"op": "inflation"}, {"op": "expand"}, {"op": "expand", "give": 10}])


def recipe(draw):
    start, half = sheet(draw)
    operators = [start] + [stroke(draw, half) for _ in range(draw.randint(0, 3))]
    if draw.random() < 0.15:
        operators.append({"op": "collisions"})
    if draw.random() < 0.15:
        operators.append({"op": "mouth", "angle": draw.choice([0, 5, 10])})
    if draw.random() < 0.1:
        operators.append({"op": "border", "released": False})
    shape = draw.random()
    if shape < 0.7:
        operators.append(rim(draw, half))
    elif shape < 0.9:
        operators += [rim(draw, half, "rim:20..160"), rim(draw, half, draw.choice(["rim:200..340", "rim:200..340/4"]))]
    for number in range(draw.choice([0, 0, 0, 1, 2])):
        operators.append(hold(draw, number))
    operators.append(motion(draw))
    for _ in range(draw.choice([0, 0, 1, 2])):
        operators.append(draw.choice([lambda: stroke(draw, half), lambda: rim(draw, half), lambda: motion(draw),
                                      lambda: {"op": "tighten", "rounds": 2}, lambda: {"op": "restart", "height": -0.3}])())
    if draw.random() < 0.6:
        operators.append({"op": "finish"})
    return [rounded(operator) for operator in operators]


def distance_from_rim(operator, points):
    """Of points from the curve that an operator holds the whole rim on; None where that is not simply told."""
    if operator["op"] == "rim_circle":
        return np.hypot(np.hypot(points[:, 0], points[:, 1]) - operator["radius"], points[:, 2]).max()
    if operator["op"] == "rim_ellipse":
        a, b = operator["a"][0], operator["b"][1]
        angles = np.linspace(0, 2 * np.pi, 10001)
        curve = np.stack([a * np.cos(angles), b * np.sin(angles)], axis=1)
        flat = max(closest_on_segments(point[:2], curve[:-1], curve[1:]).min() for point in points)
        return math.hypot(flat, np.abs(points[:, 2]).max())
    return None


class RandomRecipes(CommandCase):
    def test_what_is_settled_has_no_flip_and_no_overlap(self):
        print(f"# AX_SEED={SEED}")
        words = {"Exact": 0, "Settled": 0, "Not settled": 0, "refused": 0}
        for number in range(COUNT):
            with self.subTest(seed=SEED, recipe=number):
                words[self.check(number)] += 1
        print(f"# {words}")
        self.assertGreater(words["Exact"] + words["Settled"], COUNT // 3)

    def check(self, number):
        operators = recipe(random.Random(f"{SEED}/{number}"))
        text = json.dumps({"format": "auxshell-recipe", "version": 1, "operators": operators})
        path, out, design = (self.folder / name for name in ("recipe.json", "x.auxshell", "x.json"))
        path.write_text(text)
        out.unlink(missing_ok=True)
        done = run("run", path, "-o", out)
        said = f"AX_SEED={SEED}, recipe {number}: {text}\n{done.stdout}{done.stderr}"
        self.assertIn(done.returncode, (0, 3, 4), said)
        state = next((word for word in ("Exact", "Settled", "Not settled") if f"\n{word} after" in done.stdout), "refused")
        self.assertEqual(state == "refused", done.returncode == 3, said)
        if state in ("refused", "Not settled"):
            return state
        self.succeed("export", out, "-o", design)
        design = json.loads(design.read_text())
        figures = judge(design)
        self.assertEqual((figures["flipped_flat"], figures["overlap_pairs"]), (0, 0), said)
        if any(figures_of in done.stdout for figures_of in ("  Gravity", "  Expand", "  Inflation")):
            self.assertLess(figures["congruence_max"], 1e-9 if state == "Exact" else 1e-2, said)
        if state == "Exact":
            self.assertTrue(figures["equilateral_inner_max"] < 1e-2 or "edges that differ" in done.stdout, said)
            self.assertNotIn("Edges are off", done.stdout, said)
            self.assertLess(figures.get("simulated_edge_error_max", 0), 1e-9, said)
            self.assertLess(figures.get("force_residual", 0), 1e-8, said)
            rims = [operator for operator in operators if operator["op"].startswith("rim_")]
            if rims and "hinges" not in rims[-1]:
                triangles = np.array(design["triangles"])
                on_rim = np.bincount(triangles.ravel()) == 1
                off = distance_from_rim(rims[-1], np.array(design["deployed"])[on_rim])
                self.assertLess(off or 0, 1e-6, said)
        return state


if __name__ == "__main__":
    support.tap.main()
