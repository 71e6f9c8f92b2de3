#!/usr/bin/python3
"""The Grasshopper script, run as the component runs it, against files that the program writes. AUXSHELL names the program."""
import ast
import json
import sys
import unittest
from unittest import mock

import support.rhino as rhino
import support.tap
from support.command import ROOT, SURFACES, CommandCase

FOLDER = ROOT / "examples/grasshopper"
SCRIPT = FOLDER / "read_design.py"
METRES = {"mm": 0.001, "cm": 0.01, "m": 1.0}
OUTPUTS = ("panels", "mesh", "names", "rows", "scale", "hinges", "supports", "holes", "forces")


def run_component(path, state, model_unit):
    """The global names after the script has run with these inputs, in a document of that unit."""
    names = {"path": str(path), "state": state}
    with mock.patch.dict(sys.modules, {"Rhino": rhino.module(model_unit)}):
        exec(compile(SCRIPT.read_text(), str(SCRIPT), "exec"), names)
    return names


class Grasshopper(CommandCase):
    def make(self, units):
        document, path = self.folder / "dome.auxshell", self.folder / f"dome-{units}.json"
        self.succeed("design", SURFACES / "spherical_cap.obj", "-o", document, "--triangles", "80", "--units", units, "--load", "gravity")
        self.succeed("export", document, "-o", path)
        return path

    def compare(self, path, state, model_unit, metres):
        design, got = json.loads(path.read_text()), run_component(path, state, model_unit)
        self.assertLessEqual(set(OUTPUTS), set(got))
        factor = METRES[design["units"]] / metres
        points = [[factor * x for x in p] + [0.0] * (3 - len(p)) for p in design[state or "deployed"]]

        def near(p, q):
            for a, b in zip((p.X, p.Y, p.Z), q):
                self.assertAlmostEqual(a, b, delta=1e-12 * factor * 10)

        def along(curve, loop):
            self.assertTrue(curve.IsClosed)
            self.assertEqual(curve.PointCount, len(loop) + 1)
            for k, h in enumerate(loop):
                near(curve.Point(k), points[h])

        self.assertEqual(len(got["hinges"]), len(points))
        for p, q in zip(got["hinges"], points):
            near(p, q)
        self.assertEqual([len(got["panels"]), len(got["holes"])], [len(design["triangles"]), len(design["holes"])])
        for curve, loop in zip(got["panels"] + got["holes"], design["triangles"] + design["holes"]):
            along(curve, loop)
        self.assertEqual([list(f) for f in got["mesh"].Faces._faces], design["triangles"])
        for p, q in zip(got["mesh"].Vertices._points, points):
            near(p, q)
        for p, h in zip(got["supports"], design["supports"]):
            near(p, points[h])
        self.assertEqual(len(got["supports"]), len(design["supports"]))
        self.assertEqual(got["names"], design["report"]["panels"])
        for row, name in zip(got["rows"], got["names"]):
            self.assertTrue(name.startswith(row) and name[len(row):].lstrip("-").isdigit(), (row, name))
        self.assertEqual(got["scale"], design["scale"])
        self.assertEqual([[f.X, f.Y, f.Z] for f in got["forces"]], design["load"]["forces"])

    def test_every_state_arrives_in_the_units_of_the_document(self):
        metres = self.make("m")
        for state in ("flat", "deployed", "simulated", None):
            for unit, length in (("Millimeters", 0.001), ("Centimeters", 0.01), ("Meters", 1.0)):
                self.compare(metres, state, unit, length)
        self.compare(self.make("mm"), "deployed", "Meters", 1.0)

    def test_the_example_is_a_design_of_this_version(self):
        example, fresh = json.loads((FOLDER / "dome.json").read_text()), json.loads(self.make("m").read_text())
        self.assertEqual(list(example), list(fresh))
        self.assertEqual(set(example["report"]), set(fresh["report"]))
        for state in ("flat", "deployed", "simulated"):
            self.compare(FOLDER / "dome.json", state, "Millimeters", 0.001)

    def test_faults_are_named(self):
        path = self.make("m")
        design = json.loads(path.read_text())
        for change, state, word in (({"format": "other"}, "flat", "no design"), ({"version": 2}, "flat", "version 2"),
                                    ({"simulated": None}, "simulated", "simulate"), ({}, "folded", "folded")):
            path.write_text(json.dumps({**design, **change}))
            with self.assertRaisesRegex(ValueError, word):
                run_component(path, state, "Meters")
        path.write_text("solid dome")
        with self.assertRaisesRegex(ValueError, "not JSON"):
            run_component(path, "flat", "Meters")

    def test_rows_of_names_before_the_origin(self):
        names = {}
        exec(SCRIPT.read_text(), names)  # without inputs nothing runs
        self.assertNotIn("panels", names)
        self.assertEqual(names["row_names"](["C14", "-B-3", "AA1", "-C7", "D-12"]), ["C", "-B", "AA", "-C", "D"])

    def test_it_keeps_to_what_ironpython_knows(self):
        text = SCRIPT.read_text()
        self.assertTrue(text.isascii())
        later = (ast.JoinedStr, ast.AnnAssign, ast.NamedExpr, ast.Nonlocal, ast.AsyncFunctionDef, ast.YieldFrom)
        for node in ast.walk(ast.parse(text)):
            self.assertNotIsInstance(node, later)
            if isinstance(node, ast.FunctionDef):
                self.assertFalse(node.args.kwonlyargs or node.returns)
            if isinstance(node, ast.Raise):
                self.assertIsNone(node.cause)
            if isinstance(node, (ast.List, ast.Tuple, ast.Set)):
                self.assertFalse(any(isinstance(e, ast.Starred) for e in node.elts))


if __name__ == "__main__":
    support.tap.main()
