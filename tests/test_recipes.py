#!/usr/bin/python3
"""Recipes as users meet them: run, operators. AUXSHELL names the program."""
import json
import re
import signal
import subprocess
import time
import unittest

import numpy as np

import support.tap
from judge_design import judge
from support.command import AUXSHELL, ROOT, CommandCase, run

SMALL = [
    {"op": "start_circle", "radius": 1, "triangles": 150, "scale": 1.2},
    {"op": "paint", "points": [[0, 0]], "radius": 0.9, "value": 1.7},
    {"op": "rim_circle", "radius": 1.1},
    {"op": "gravity"},
]


class Recipes(CommandCase):
    def write(self, operators, name="recipe.json"):
        path = self.folder / name
        beside = self.folder / "beside"
        beside.write_text(json.dumps({"format": "auxshell-recipe", "version": 1, "operators": operators}, indent=1))
        beside.rename(path)
        return path

    def export(self, document):
        self.succeed("export", document, "-o", self.folder / "x.json")
        return (self.folder / "x.json").read_text()

    def test_a_recipe_becomes_a_document(self):
        out = self.folder / "x.auxshell"
        words = self.succeed("run", self.write(SMALL), "-o", out)
        self.assertIn("  1  Start from a circle: radius 1 m, triangles 150, scale 1.2", words)
        self.assertIn("Settled after", words)
        self.assertIn("boundary", words)
        self.assertIn(f"Wrote {out}", words)
        first = self.export(out)
        self.succeed("run", self.write(SMALL), "-o", out)
        self.assertEqual(self.export(out), first)
        self.assertEqual(json.loads(first)["units"], "m")

    def test_finished_it_is_exact(self):
        out = self.folder / "x.auxshell"
        words = self.succeed("run", self.write([*SMALL, {"op": "finish"}]), "-o", out)
        self.assertIn("Exact after", words)
        report = json.loads(self.succeed("info", out, "--json"))
        text = json.dumps(report)
        self.assertIn("congruence", text)
        design = json.loads(self.export(out))
        self.assertIsNotNone(design["simulated"])
        self.assertLess(design["report"]["congruence_max"], 1e-9)

    def test_what_run_says_of_a_form_info_and_export_say_too(self):
        (self.folder / "floor.obj").write_text("v -9 -9 -0.1\nv 9 -9 -0.1\nv 0 9 -0.1\nf 1 2 3\n")
        site = [*SMALL, {"op": "underlay", "file": "floor.obj", "name": "floor", "clearance": 0.05}]
        out = self.folder / "x.auxshell"
        words = self.succeed("run", self.write([*site, {"op": "finish"}]), "-o", out)
        found = [line for line in words.splitlines() if "'floor'" in line and "clearance" in line]
        self.assertEqual(len(found), 1)
        told = self.succeed("info", out)
        self.assertIn(found[0], told)
        self.assertRegex(told, r"boundary +circle")
        report = json.loads(self.succeed("info", out, "--json"))
        self.assertIn(found[0], [finding["text"] for finding in report["findings"]])
        self.assertEqual([held["name"] for held in report["held"]], ["boundary"])
        seconds = report["report"]
        self.assertGreater(seconds["seconds_joint"], 0)
        self.assertGreaterEqual(seconds["seconds_total"], seconds["seconds_joint"] + seconds["seconds_deploy"])
        self.assertNotIn("Congruence", self.succeed("export", out, "-o", self.folder / "x.svg"))
        self.succeed("undo", out)  # of the last step: flat and open are not congruent
        told = self.succeed("export", out, "-o", self.folder / "x.svg")
        self.assertRegex(told, r"Not kept:\n  Congruence.*FAILS")
        self.assertIn(f'"auxshell finish {out}"', told)

    def test_a_load_on_what_nothing_holds_is_refused(self):
        start, out = SMALL[:2], ("-o", self.folder / "x.auxshell")
        line = {"op": "rim_line", "point": [1, 0, 0], "direction": [0, 1, 0], "hinges": "rim:-40..40"}
        one = {"op": "hold_fixed", "hinges": "0"}
        for load in ({"op": "gravity"}, {"op": "inflation"}):
            for words, operators in (("Nothing holds the sheet", [*start, load]),
                                     ("straight line", [*start, line, load]),
                                     ("straight line", [*start, one, load]),
                                     ("Nothing holds the sheet", [*SMALL[:3], load, {"op": "rim_free"}])):
                done = run("run", self.write(operators), *out)
                self.assertEqual(done.returncode, 4, operators)
                self.assertIn(words, done.stderr)
            self.succeed("run", self.write([*start, line, one, load]), *out)

    def test_exact_states_have_no_panel_turned_over(self):
        """Rims so tight that, with much room for border panels, one of them turns over in the flat state."""
        out, design = self.folder / "x.auxshell", self.folder / "x.json"
        for start, corners, load in (
                ({"op": "start_rectangle", "width": 2, "height": 1.41, "triangles": 168, "scale": 1.24},
                 [[0.754, 0.531, 0], [-0.754, 0.531, 0], [-0.754, -0.531, 0], [0.754, -0.531, 0]], "gravity"),
                ({"op": "start_outline", "points": [[0, 0], [2, 0], [2, 0.6], [0.7, 0.6], [0.7, 1.8], [0, 1.8]],
                  "triangles": 253, "scale": 1.47},
                 [[0, 0, 0], [1.698, 0, 0], [1.698, 0.509, 0], [0.594, 0.509, 0], [0.594, 1.528, 0], [0, 1.528, 0]],
                 "expand")):
            operators = [start, {"op": "rim_polyline", "points": corners}, {"op": "drape", "depth": 0.3}, {"op": load},
                         {"op": "finish"}]
            words = self.succeed("run", self.write(operators), "-o", out)
            self.assertIn("Exact after", words)
            self.succeed("export", out, "-o", design)
            figures = judge(json.loads(design.read_text()))
            self.assertEqual((figures["flipped_flat"], figures["overlap_pairs"]), (0, 0), words)
            self.assertLess(figures["congruence_max"], 1e-9)

    def test_a_shell_that_slides_on_the_floor_is_finished(self):
        out = self.folder / "x.auxshell"
        floor = {"op": "hold_plane_given", "name": "floor", "hinges": "rim", "normal": [0, 0, 1], "support": True}
        peg = {"op": "hold_fixed", "name": "peg", "hinges": "0", "at": "sheet"}
        rest = [{"op": "inflation"}, {"op": "finish"}]
        words = self.succeed("run", self.write([*SMALL[:2], floor, peg, *rest]), "-o", out)
        self.assertIn("Exact after", words)
        figures = judge(json.loads(self.export(out)))
        self.assertLess(figures["force_residual"], 1e-8)
        done = run("run", self.write([*SMALL[:2], floor, *rest]), "-o", out)
        self.assertEqual(done.returncode, 4)
        self.assertIn("slide away. Fix at least one hinge", done.stderr)

    def test_parts_of_the_rim_have_names_of_their_own(self):
        parts = [{"op": "rim_circle", "hinges": "rim:20..160", "radius": 1.1},
                 {"op": "rim_line", "hinges": "rim:250..290", "point": [0, -1.1, 0], "direction": [1, 0, 0]}]
        words = self.succeed("run", self.write([*SMALL[:2], *parts, {"op": "gravity"}]), "-o", self.folder / "x.auxshell")
        self.assertRegex(words, r"boundary 1 +circle +\d")
        self.assertRegex(words, r"boundary 2 +line +\d")

    def test_exact_panels_are_no_edges_that_are_off(self):
        words = self.succeed("run", self.write([*SMALL[:3], {"op": "gravity", "adapt": False}, {"op": "finish"}]), "-o",
                             self.folder / "x.auxshell")
        self.assertIn("Exact after", words)
        self.assertNotIn("Edges are off", words)

    def test_panels_that_cannot_stay_equilateral_are_told(self):
        """Pegs where the sheet lay, which the open sheet has to leave."""
        operators = [{"op": "start_circle", "radius": 1, "triangles": 206, "scale": 1.258, "angle": 17},
                     {"op": "formula", "formula": "2"}, {"op": "rim_fixed", "at": "sheet"},
                     {"op": "hold_fixed", "name": "peg", "hinges": "disc(0,0,0.2)", "at": "sheet"},
                     {"op": "gravity", "direction": [0, 0, 1]}, {"op": "finish"}]
        words = self.succeed("run", self.write(operators), "-o", self.folder / "x.auxshell")
        self.assertIn("with edges that differ", words)

    def test_what_stands_in_the_way_is_told_with_its_place(self):
        cube = "".join(f"v {x} {y} {z}\n" for z in (-2, -0.1) for y in (-0.2, 0.2) for x in (-0.2, 0.2))
        (self.folder / "column.obj").write_text(
            cube + "".join(f"f {face}\n" for face in ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6")))
        underlay = {"op": "underlay", "file": "column.obj", "name": "column", "clearance": 0.1}
        words = self.succeed("run", self.write([*SMALL, underlay]), "-o", self.folder / "x.auxshell")
        self.assertRegex(words, "The shell runs into 'column' at panel .* on the sheet.; a clearance of 0.1 m is asked")
        words = self.succeed("run", self.write([*SMALL, {**underlay, "at": [0, 0, -5]}]), "-o", self.folder / "x.auxshell")
        self.assertNotIn("The shell", words)

    def test_a_rim_may_be_anywhere_in_space(self):
        """A rim that is far off, or upright, gives the shape that it gives beside the sheet."""
        out = self.folder / "x.auxshell"

        def deployed(*operators):
            self.succeed("run", self.write(operators), "-o", out)
            return np.array(json.loads(self.export(out))["deployed"])

        def rim(**fields):
            return {"op": "rim_circle", "radius": 1.15, **fields}

        load = {"op": "inflation"}
        here = deployed(*SMALL[:2], rim(), load)
        far = deployed(*SMALL[:2], rim(centre=[20, -7, 5]), load)
        self.assertLess(np.abs(far - here - [20, -7, 5]).max(), 1e-3)
        later = deployed(*SMALL[:2], rim(), load, rim(centre=[4, 0, 0]))
        self.assertLess(np.abs(later - here - [4, 0, 0]).max(), 1e-3)
        upright = deployed(*SMALL[:2], rim(normal=[0, 1, 0]), load)
        self.assertLess(np.abs(upright[:, 1] - here[:, 2]).max(), 1e-3)
        self.assertLess(np.abs(np.hypot(upright[:, 0], upright[:, 2]) - np.hypot(here[:, 0], here[:, 1])).max(), 1e-3)

    def test_a_rim_that_no_sheet_can_span_is_told(self):
        out = self.folder / "x.auxshell"
        rim = {"op": "rim_circle", "radius": 2.5}
        self.assertIn("The rim's curve encloses 19.6 m2", self.succeed("run", self.write([*SMALL[:2], rim, SMALL[3]]), "-o", out))
        done = run("run", self.write([*SMALL[:2], rim, SMALL[3], {"op": "finish"}]), "-o", out)
        self.assertEqual(done.returncode, 4)
        self.assertIn("even with scale factors of 2", done.stderr)

    def test_what_is_only_flat_says_so(self):
        words = self.succeed("run", self.write(SMALL[:2]), "-o", self.folder / "x.auxshell")
        self.assertIn("Only the flat state is solved yet", words)

    def test_supports_are_selected_as_in_recipes(self):
        out = self.folder / "x.auxshell"
        self.succeed("run", self.write([*SMALL, {"op": "finish"}]), "-o", out)
        rim = set(json.loads(self.export(out))["supports"])
        for words, share in (("rim", 1), ("rim/2", 0.5), ("rim, !rim:-5..5", 0.97), ("disc(0,0,2) & rim", 1)):
            self.succeed("simulate", out, "--support", words)
            supports = set(json.loads(self.export(out))["supports"])
            self.assertLessEqual(supports, rim, words)
            self.assertAlmostEqual(len(supports) / len(rim), share, delta=0.05, msg=words)
        for words, said in (("rim/0", "--support: The selection"), ("0-99999", "99999"), ("#arch", "arch"),
                            ("3,9", "at least three")):
            self.refuse(2, said, "simulate", out, "--support", words)

    def test_until_stops_early(self):
        words = self.succeed("run", self.write(SMALL), "-o", self.folder / "x.auxshell", "--until", 2)
        self.assertIn("  2  Paint", words)
        self.assertNotIn("Rim", words)

    def test_files_are_looked_for_beside_the_recipe(self):
        (self.folder / "scale.csv").write_text("x,y,lambda\n-1,0,1.2\n1,0,1.6\n0,1,1.4\n0,-1,1.4\n")
        self.succeed("run", self.write([*SMALL, {"op": "table", "file": "scale.csv"}]), "-o", self.folder / "x.auxshell",
                     cwd="/")

    def test_what_is_wrong_is_named_and_nothing_is_written(self):
        out = ("-o", self.folder / "x.auxshell")
        for code, word, operators in (
            (3, 'recipe.json, line 13, column 4: paint has no field "radus". Did you mean "radius"?',
             [SMALL[0], {"op": "paint", "radus": 1}]),
            (3, "no operators", []),
            (3, "Operator 2, formula: ", [SMALL[0], {"op": "formula", "formula": "1 +"}]),
            (3, "none.csv", [SMALL[0], {"op": "table", "file": "none.csv"}]),
            (3, "gives values from 2.1", [SMALL[0], {"op": "formula", "formula": "3.1 + 0*x - 1"}]),
            (3, "crosses itself after its point 0,",
             [{"op": "start_outline", "points": [[0, 0], [4, 0], [4, 2], [1, -1], [0, 2]], "triangles": 300}]),
            (3, "no area", [{"op": "start_outline", "points": [[0, 0], [2, 2], [2, 0], [0, 2]]}]),
            (3, "12 to 2000000", [{"op": "start_circle", "radius": 1, "edge": 1}]),
        ):
            with self.subTest(word=word):
                self.refuse(code, word, "run", self.write(operators), *out)
        self.refuse(3, "cannot be read", "run", self.folder / "none.json", *out)
        (self.folder / "bad.json").write_text('{"format": "auxshell-recipe",}')
        self.refuse(3, "bad.json, line 1, column", "run", self.folder / "bad.json", *out)

    def test_sheets_that_do_not_open_at_once_are_opened_otherwise_and_the_report_says_how(self):
        ell = [[-1, -1], [1, -1], [1, 0], [0, 0], [0, 1], [-1, 1]]
        # the rectangle's corners fold over on the oval; the re-entrant corner of the L holds projective steps up
        cases = [({"op": "start_rectangle", "width": 3, "height": 1.5, "triangles": 1000, "scale": 1.4},
                  {"op": "rim_ellipse", "a": [2, 0, 0], "b": [0, 1.1, 0]}, "gravity"),
                 ({"op": "start_outline", "points": ell, "triangles": 400, "scale": 1.4},
                  {"op": "rim_polyline", "points": [[1.1 * x, 1.1 * y, 0] for x, y in ell]}, "inflation")]
        for start, rim, load in cases:
            with self.subTest(start=start["op"]):
                out = self.folder / "x.auxshell"
                words = self.succeed("run", self.write([start, rim, {"op": load}, {"op": "finish"}]), "-o", out)
                self.assertIn("Exact after", words)
                report = json.loads(self.succeed("info", out, "--json"))["report"]
                self.assertLess(report["force_residual"], 1e-10)
                self.assertLess(report["simulated_edge_error_max"], 1e-10)
                self.assertTrue(report["stable"])
                flat, stages = report["from_flat"], report["rim_stages"]
                self.assertIn(stages, (1, 4) if flat else (0,))
                told = "opened from flat" if flat else "started from the designed state: does not show that it opens by itself"
                self.assertRegex(words, rf"Simulated .* L rms from the design, {told}")

    def test_a_few_panels_that_did_not_settle_do_not_keep_a_form_from_being_exact(self):
        # a corner folds where the outline has one and the rim has none, and edges there are off when it rests
        slack = [{"op": "start_polygon", "sides": 3, "radius": 1, "triangles": 300, "scale": 1.35},
                 {"op": "rim_circle", "radius": 1.25}, {"op": "gravity"}]
        out = self.folder / "x.auxshell"
        self.assertIn("Not settled", self.succeed("run", self.write(slack), "-o", out))
        self.succeed("run", self.write([*slack, {"op": "finish"}]), "-o", out)
        report = json.loads(self.succeed("info", out, "--json"))["report"]
        self.assertLess(report["congruence_max"], 1e-9)
        self.assertLess(report["force_residual"], 1e-10)
        self.assertEqual(report["overlap_pairs"] + report["flipped_flat"], 0)

    def test_a_first_dome_settles(self):
        # its sheet starts on the wrong side of what its rim has room for
        bowl = [{"op": "start_circle", "radius": 5, "triangles": 600, "scale": 1.2},
                {"op": "gradient_radial", "radius": 5, "inner": 1.5, "outer": 1.15},
                {"op": "rim_circle", "radius": 5.5}, {"op": "inflation"}]
        words = self.succeed("run", self.write(bowl), "-o", self.folder / "x.auxshell")
        self.assertIn("Settled after", words)
        self.assertNotIn("Edges are off", words)

    def test_a_sheet_without_room_to_bulge_is_refused_in_words(self):
        taut = [{"op": "start_circle", "radius": 1, "triangles": 200, "scale": 1.5}, {"op": "rim_circle", "radius": 1.55},
                {"op": "gravity"}, {"op": "finish"}]
        done = run("run", self.write(taut), "-o", self.folder / "x.auxshell")
        self.assertEqual(done.returncode, 4)
        self.assertRegex(done.stderr, r"pulled taut between its supports, most at panel [A-Z]+\d+ at \(")

    def test_a_corner_of_the_sheet_in_a_wide_arc_of_its_rim_is_told_and_cured(self):
        corners = [[-2.5, -1.5, 0], [2.5, -1.5, 0], [2.5, 1.5, 0], [-2.5, 1.5, 0]]
        for fillet in (0, 0.64):
            sheet = [{"op": "start_rectangle", "width": 4, "height": 2.4, "triangles": 600, "scale": 1.25, "fillet": fillet},
                     {"op": "rim_polyline", "points": corners, "fillet": 0.8}, {"op": "drape", "depth": 0.4}, {"op": "gravity"}]
            words = self.succeed("run", self.write(sheet), "-o", self.folder / "x.auxshell")
            told = re.findall(r"panel [A-Z]+\d+ \((-?[\d.]+), (-?[\d.]+) on the sheet\)[^(]*the sheet has a corner there", words)
            if fillet:
                self.assertIn("Settled after", words)
                self.assertEqual(told, [])
            else:
                self.assertTrue(told, words)
                for x, y in told:
                    self.assertLess(abs(abs(float(x)) - 2) + abs(abs(float(y)) - 1.2), 0.4)

    def test_what_cannot_be_made_congruent_is_told_with_its_places_and_what_to_do(self):
        # two neighbouring hinges are held far above and far below the rim: the sheet between them cannot reach both
        torn = [{"op": "start_circle", "radius": 1, "triangles": 300, "scale": 1.2}, {"op": "rim_circle", "radius": 1},
                {"op": "hold_fixed", "hinges": "200", "at": "points", "points": [[0, 0, 3]]},
                {"op": "hold_fixed", "hinges": "205", "at": "points", "points": [[0, 0, -3]]}, {"op": "expand"}, {"op": "finish"}]
        done = run("run", self.write(torn), "-o", self.folder / "x.auxshell")
        self.assertEqual(done.returncode, 4)
        words = done.stderr
        self.assertRegex(words, r"cannot be made congruent: where they begin edges differ by up to \d+ %, at panel [A-Z]+\d+ \(")
        self.assertRegex(words, r"Too little material at panel [A-Z]+\d+ \([-\d., ]+ on the sheet\): .* Paint larger scale factors")
        self.assertRegex(words, r"Too much material at panel [A-Z]+\d+ \([-\d., ]+ on the sheet\): .* Paint smaller scale factors")

    def test_what_cannot_exist_leaves_what_came_before(self):
        out = self.folder / "x.auxshell"
        too_much = {"op": "paint_curvature", "points": [[0, 0]], "radius": 1, "curvature": 20}
        done = run("run", self.write([SMALL[0], too_much, {"op": "settle"}]), "-o", out)
        self.assertEqual(done.returncode, 4)
        self.assertIn("Operator 2, paint_curvature: ", done.stderr)
        self.assertIn("holds what came before", done.stderr)
        self.assertIn("1 of 3 steps is applied", self.succeed("history", out))
        self.export(out)

    def test_watching_plays_from_the_first_change(self):
        recipe = self.write(SMALL)
        process = subprocess.Popen([AUXSHELL, "run", recipe, "-o", self.folder / "x.auxshell", "--watch"],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(process.kill)
        self.addCleanup(process.stdout.close)

        def until_watching():
            lines = []
            for line in process.stdout:
                lines.append(line)
                if line.startswith("Watching"):
                    return "".join(lines)
            self.fail("".join(lines))

        self.assertIn("  1  Start", until_watching())
        self.write([*SMALL[:2], {"op": "rim_circle", "radius": 1.15}, SMALL[3]])
        again = until_watching()
        self.assertNotIn("  2  Paint", again)
        self.assertIn("  3  Rim on a circle: radius 1.15 m", again)
        self.assertIn("  4  Gravity", again)
        self.write([*SMALL[:3], {"op": "nothing"}])
        self.assertIn('no operator "nothing"', until_watching())
        process.send_signal(signal.SIGINT)
        for _ in range(100):
            if process.poll() is not None:
                break
            time.sleep(0.1)
        self.assertEqual(process.returncode, 0)

    def test_operators_are_listed_and_explained(self):
        listed = self.succeed("operators")
        self.assertIn("\n  paint ", listed)
        explained = self.succeed("operators", "paint")
        self.assertIn("\n  falloff ", explained)
        for text in (listed, explained):
            self.assertLessEqual(max(map(len, text.splitlines())), 100)
        self.refuse(2, 'Did you mean "paint"?', "operators", "pain")

    def test_the_page_of_operators_is_up_to_date(self):
        self.assertEqual((ROOT / "docs/operators.md").read_text(), self.succeed("operators", "--markdown"),
                         "write it again: ./run operators --markdown > docs/operators.md")


if __name__ == "__main__":
    support.tap.main()
