#!/usr/bin/python3
"""History as users meet it: history, undo, redo, diff, finish, recipes out of documents. AUXSHELL names the program."""
import json
import re
import shutil
import sqlite3
import subprocess
import time
import unittest

import support.tap
from support.command import AUXSHELL, ROOT, CommandCase

SMALL = [
    {"op": "start_circle", "radius": 1, "triangles": 150, "scale": 1.2},
    {"op": "paint", "points": [[0, 0]], "radius": 0.9, "value": 1.7},
    {"op": "rim_circle", "radius": 1.1},
    {"op": "gravity"},
]
DOME = ROOT / "examples/surfaces/spherical_cap.obj"


class History(CommandCase):
    def setUp(self):
        super().setUp()
        self.document = self.folder / "roof.auxshell"

    def make(self, operators=SMALL):
        recipe = self.folder / "recipe.json"
        recipe.write_text(json.dumps({"format": "auxshell-recipe", "version": 1, "operators": operators}))
        self.succeed("run", recipe, "-o", self.document)

    def history(self, document=None):
        return json.loads(self.succeed("history", document or self.document, "--json"))

    def states(self, document=None):
        self.succeed("export", document or self.document, "-o", self.folder / "x.json")
        design = json.loads((self.folder / "x.json").read_text())
        return {key: design[key] for key in ("flat", "deployed", "simulated")}

    def test_every_step_of_a_recipe_is_a_moment(self):
        self.make()
        history = self.history()
        self.assertEqual([moment["at"] for moment in history["moments"]], [1, 2, 3, 4])
        self.assertEqual((history["now"], history["at"], history["failed"]), (3, 4, None))
        self.assertEqual(history["steps"], SMALL)
        self.assertLess(abs(history["moments"][-1]["time"] - time.time()), 100)
        table = self.succeed("history", self.document)
        self.assertEqual([line for line in table.splitlines() if line.startswith(">")],
                         [line for line in table.splitlines() if "Gravity" in line])
        self.assertIn("4 of 4 steps are applied.", table)

    def test_undo_and_redo(self):
        self.make()
        last = self.states()
        words = self.succeed("undo", self.document)
        self.assertIn("Undone: Gravity", words)
        self.assertIn("3 of 3 steps are applied.", words)
        before = self.states()
        self.assertNotEqual(before, last)
        self.assertIn("(undone) Gravity", self.succeed("history", self.document))
        words = self.succeed("undo", self.document, "--times", 9)  # as many as there are
        self.assertIn("1 of 1 steps is applied.", words)
        done = self.refuse(2, "nothing to undo", "undo", self.document)
        self.assertEqual(done.stdout, "")
        self.succeed("redo", self.document, "--times", 2)
        self.assertEqual(self.states(), before)
        self.assertIn("Done again: Gravity", self.succeed("redo", self.document))
        self.assertEqual(self.states(), last)
        self.refuse(2, "nothing to redo", "redo", self.document)

    def test_finishing_is_a_step_that_can_be_undone(self):
        self.make()
        before = self.states()
        words = self.succeed("finish", self.document)
        self.assertRegex(words, r"The flat state moved by 0\.\d+ L rms")
        report = json.loads(self.succeed("info", self.document, "--json"))["report"]
        self.assertLess(report["congruence_max"], 1e-9)
        self.assertTrue(report["simulated"])
        self.assertIn("finished already", self.succeed("finish", self.document))
        exact = self.states()
        self.succeed("simulate", self.document, "--density", 8)  # no moment of its own
        self.assertEqual(len(self.history()["moments"]), 5)
        self.succeed("undo", self.document)
        self.assertEqual(self.states(), before)
        self.refuse(3, "auxshell finish", "simulate", self.document)
        self.succeed("redo", self.document)
        self.assertEqual(self.states()["deployed"], exact["deployed"])

    def test_the_recipe_comes_out_as_it_went_in(self):
        self.make()
        self.succeed("export", self.document, "-o", self.folder / "out.recipe.json")
        self.assertEqual(json.loads((self.folder / "out.recipe.json").read_text())["operators"], SMALL)
        states = self.states()
        self.succeed("run", self.folder / "out.recipe.json", "-o", self.document)
        self.assertEqual(self.states(), states)
        self.succeed("undo", self.document)
        self.succeed("export", self.document, "-o", self.folder / "out.recipe.json")
        self.assertEqual(json.loads((self.folder / "out.recipe.json").read_text())["operators"], SMALL[:3])
        self.succeed("design", DOME, "-o", self.document, "--triangles", 100)
        self.refuse(3, "has no recipe", "export", self.document, "-o", self.folder / "none.recipe.json")

    def test_diff_names_steps_and_figures(self):
        self.make()
        other = self.folder / "other.auxshell"
        shutil.copy(self.document, other)
        same = self.succeed("diff", self.document, other)
        self.assertIn("The recipes are the same: 4 steps.", same)
        self.assertIn("All figures are the same.", same)
        self.assertIn("The shapes are the same.", same)
        self.make([SMALL[0], {**SMALL[1], "value": 1.6}, *SMALL[2:]])
        lines = self.succeed("diff", other, self.document).splitlines()
        self.assertEqual([line[:5] for line in lines if line[0] in "+-"], ["-   2", "+   2"])
        self.assertTrue(any("1 step the same" in line for line in lines))
        self.assertTrue(any("2 steps the same" in line for line in lines))
        largest = [line for line in lines if "Largest scale factor" in line]
        self.assertEqual(len(largest), 1)
        self.assertLess(float(largest[0].split()[-1]), float(largest[0].split()[-2]))
        shape = [line for line in lines if "surfaces are" in line]
        self.assertEqual([line.split()[0] for line in shape], ["deployed", "under"])
        self.assertRegex(shape[0], r"surfaces are \d+\.\d\d apart at most, \d+\.\d\d rms; points of the sheet \d+\.\d\d,")

    def test_diff_compares_shapes_of_other_panels(self):
        other = self.folder / "other.auxshell"
        self.make([{**SMALL[0], "triangles": 300}, *SMALL[1:]])
        shutil.copy(self.document, other)
        self.make([{**SMALL[0], "triangles": 400}, *SMALL[1:]])
        lines = self.succeed("diff", other, self.document).splitlines()
        figures = [float(x) for line in lines if "surfaces are" in line for x in re.findall(r"\d+\.\d\d", line)]
        self.assertTrue(figures and all(0 < x < 10 for x in figures), lines)
        self.make([{**SMALL[0], "unit": "mm"}, *SMALL[1:]])
        self.assertIn("Shapes are not compared: lengths are in m here and in mm there.", self.succeed("diff", other, self.document))

    def test_a_design_has_a_beginning(self):
        self.succeed("design", DOME, "-o", self.document, "--triangles", 100)
        content = self.document.read_bytes()
        history = self.history()
        self.assertEqual((len(history["moments"]), history["at"], history["steps"]), (1, 0, []))
        self.refuse(2, "nothing to undo", "undo", self.document)
        self.assertIn("finished already", self.succeed("finish", self.document))
        self.assertEqual(self.document.read_bytes(), content)

    def test_another_program_is_named(self):
        self.make()
        recipe = self.folder / "recipe.json"
        watching = subprocess.Popen([AUXSHELL, "run", recipe, "-o", self.document, "--watch"], stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, text=True)
        self.addCleanup(watching.wait)
        self.addCleanup(watching.kill)
        self.addCleanup(watching.stdout.close)
        while not (line := watching.stdout.readline()).startswith("Watching"):
            self.assertTrue(line)
        for words in (("undo", self.document), ("finish", self.document), ("simulate", self.document),
                      ("design", DOME, "-o", self.document, "--triangles", 100), ("run", recipe, "-o", self.document)):
            with self.subTest(words=words):
                self.refuse(1, f"is open in auxshell run (process {watching.pid}", *words)
        self.assertEqual(self.history()["at"], 4)  # reading goes on
        self.states()
        watching.kill()
        watching.wait()
        self.succeed("undo", self.document)
        self.assertEqual([name for name in self.files() if "lock" in name or "journal" in name], [])

    def test_killed_commands_leave_a_document(self):
        self.make()
        content = self.document.read_bytes()
        seen = set()
        for k in range(30):
            self.document.write_bytes(content)
            process = subprocess.Popen([AUXSHELL, "undo", self.document, "--times", "3"], stdout=subprocess.DEVNULL)
            time.sleep(0.004 * k)
            process.kill()
            process.wait()
            seen.add(self.history()["at"])
            with sqlite3.connect(self.document) as database:
                self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
        self.assertLessEqual(seen, {1, 2, 3, 4})
        self.assertIn(4, seen)


if __name__ == "__main__":
    support.tap.main()
