#!/usr/bin/python3
"""The studio as a process: its protocol, who may speak with it, and what it survives."""
import contextlib
import json
import math
import os
import random
import re
import signal
import socket
import sqlite3
import struct
import subprocess
import time
import unittest
from pathlib import Path

import judge_design
import support.tap
from support.command import AUXSHELL, QUICK, ROOT, SURFACES, CommandCase
from support.studio import EXACT, SECTIONS, SETTLED, Closed, Page, Socket, Studio

DOME = [{"op": "start_circle", "radius": 2, "triangles": 300, "scale": 1.3},
        {"op": "gradient_radial", "radius": 1.9, "inner": 1.7, "outer": 1.25},
        {"op": "rim_circle", "radius": 2.3},
        {"op": "inflation"}]
STROKE = {"op": "paint", "points": [[0, 0], [0.5, 0]], "value": 1.4, "radius": 0.6}


def recipe(steps):
    return json.dumps({"format": "auxshell-recipe", "version": 1, "operators": steps})


class StudioCase(CommandCase):
    def start(self, *words, steps=DOME, **options):
        if steps:
            (self.folder / "dome.json").write_text(recipe(steps))
            options["document"] = self.folder / "dome.json"
        studio = Studio(self.folder, *words, **options)
        self.addCleanup(self.end, studio)
        return studio

    def end(self, studio):
        """Whatever was done to it, it ends cleanly: sanitizers speak here too."""
        if studio.process.poll() is None:
            code, said = studio.stop()
            self.assertEqual(code, 0, said)

    def page(self, studio, joined=True, **options):
        page = Page(studio, **options)
        self.addCleanup(page.close)
        if joined:
            self.agree(page.ask("join"))
            page.until(lambda: page.frames)
            page.rest()
        return page

    def same_places(self, one, two):
        for name in ("prescribed", "realised", "flat", "deployed", "simulated"):
            self.assertEqual(one[name], two[name], name)

    def agree(self, answer):
        self.assertTrue(answer["ok"], answer)
        return answer

    def disagree(self, word, text, answer):
        self.assertFalse(answer["ok"], answer)
        self.assertEqual(answer["error"]["word"], word, answer)
        self.assertIn(text, answer["error"]["message"])


class Protocol(StudioCase):
    def test_a_page_is_told_everything_once_and_then_what_changes(self):
        page = self.page(self.start())
        link, state = page.events["linkage"], page.state
        count = {name: link[name] for name in ("triangles", "hinges", "holes")}
        for name, each, of in (("triangles", 3, "triangles"), ("sheet", 2, "hinges"), ("flat", 2, "hinges"), ("deployed", 3, "hinges"),
                               ("simulated", 3, "hinges"), ("realised", 1, "triangles"), ("opening", 1, "holes"),
                               ("mouth", 1, "hinges"), ("residual", 1, "triangles"), ("supports", 1, "hinges")):
            self.assertEqual(len(state[name]), each * count[of], name)
        self.assertEqual(len(bytes(state["names"]).split()), count["triangles"])
        self.assertEqual(state["edge_forces"], ())  # there are none before it is exact
        self.assertLess(max(state["residual"]), 1e-2)
        self.assertEqual(sum(state["supports"]), sum(state["on_rim"]))
        self.assertEqual([check["key"] for check in page.events["report"]["checks"]],
                         ["scale", "mouth", "overlap", "curvature", "rim", "match", "force"])
        self.assertEqual(len(page.events["document"]["steps"]), 4)
        # edges in the frame are those of the linkage: lambda times half the spacing
        edges = sorted(math.dist(state["flat"][2 * a:2 * a + 2], state["flat"][2 * b:2 * b + 2])
                       for a, b, _ in zip(*[iter(state["triangles"])] * 3))
        self.assertLess(abs(edges[-1] / (max(state["realised"]) * link["spacing"] / 2) - 1), 0.2)

        frames = page.frames
        self.agree(page.ask("apply", operator={"op": "gravity"}))
        page.rest()
        self.assertGreater(page.frames, frames)
        self.assertNotIn("triangles", page.last.sections)  # the linkage is the same

    def test_the_example_that_it_opens_on_deploys_without_reserve(self):
        page = self.page(self.start(), joined=False)
        self.agree(page.ask("new", name="welcome", example="welcome"))
        page.rest()
        report = page.events["report"]
        self.assertEqual(report["verdict"]["word"], "Yes", report["checks"])

    def test_the_protocol_page_names_every_command_and_section(self):
        page = (ROOT / "docs/protocol.md").read_text()
        tables = [path.read_text() for path in (ROOT / "src/studio").glob("job_*.c")]
        commands = {name for text in tables for name in re.findall(r'^    \{"(\w+)", (?:true|false), ', text, re.MULTILINE)}
        hub = (ROOT / "src/studio/hub.c").read_text()
        commands |= set(re.findall(r'strcmp\(m->action, "(\w+)"\)', hub)) | set(re.findall(r'\{"(\w+)", \w+\}', hub))
        self.assertLess({"apply", "preview", "join", "export", "variant_look", "close"}, commands)
        for name in commands:
            self.assertRegex(page, rf"\| (`\w+`, )?`{name}`[ ,]", name)
        rows = set(map(int, re.findall(r"\d+", " ".join(re.findall(r"^\| ([\d, ]+) \| ", page, re.MULTILINE)))))
        for number in SECTIONS:
            self.assertIn(number, rows)

    def test_hello_describes_every_operator(self):
        hello = self.page(self.start(), joined=False).hello
        operators = {operator["name"]: operator for operator in hello["operators"]}
        self.assertLess({"paint", "fill", "smooth", "rim_circle", "gravity", "start_circle", "start_target"}, set(operators))
        fields = {field["name"]: field for field in operators["start_circle"]["fields"]}
        self.assertTrue(fields["radius"]["required"])
        self.assertEqual((fields["scale"]["kind"], fields["scale"]["lo"], fields["scale"]["hi"]), ("number", 1, 2))
        self.assertEqual(fields["unit"]["choices"], ["mm", "cm", "m"])
        examples = {example["name"]: example for example in hello["examples"]}
        recipes = {path.stem for path in (ROOT / "examples").glob("*.json")}
        self.assertEqual(set(examples), recipes)  # all of them have a title and a place in the gallery
        self.assertEqual(hello["examples"][0]["name"], "welcome")
        self.assertTrue(all(example["doc"] for example in examples.values()), examples)
        self.assertIn(".svg", [exporter["ending"] for exporter in hello["exporters"]])

    def test_previews_show_and_leave_no_trace(self):
        page = self.page(self.start())
        before = dict(page.state)
        page.tell("preview", serial=1, operator=STROKE)
        page.tell("preview", serial=2, operator=dict(STROKE, value=1.5))
        page.until(lambda: page.last.serial == 2)
        self.assertNotEqual(page.state["prescribed"], before["prescribed"])
        page.tell("preview", serial=3, operator=None)
        page.until(lambda: page.last.serial == 0 and page.last.flags & SETTLED)
        page.rest()
        self.same_places(page.state, before)
        self.assertEqual(len(page.events["document"]["steps"]), 4)

    def test_a_gesture_is_one_undo_step_and_redo_gives_the_same_bits(self):
        page = self.page(self.start())
        start = dict(page.state)
        for serial in range(1, 6):
            page.tell("preview", serial=serial, operator=dict(STROKE, points=STROKE["points"][:1 + serial // 4]))
        self.assertEqual(self.agree(page.ask("apply", operator=STROKE))["at"], 5)
        page.rest()
        applied = dict(page.state)
        self.assertNotEqual(applied["simulated"], start["simulated"])
        self.agree(page.ask("undo"))
        page.rest()
        self.assertEqual(page.state["simulated"], start["simulated"])
        self.assertTrue(page.events["document"]["redo"])
        self.agree(page.ask("redo"))
        page.rest()
        self.same_places(page.state, applied)

    def test_steps_are_edited_removed_and_gone_to(self):
        page = self.page(self.start())
        self.agree(page.ask("goto", at=2))
        self.assertEqual([step["state"] for step in page.events["document"]["steps"]], ["applied", "applied", "ahead", "ahead"])
        self.agree(page.ask("goto", at=4))
        self.agree(page.ask("edit", step=1, operator=dict(DOME[1], inner=1.5)))
        page.rest()
        self.assertLess(max(page.state["prescribed"]), 1.51)
        self.agree(page.ask("remove", step=1))
        page.rest()
        self.assertLess(max(page.state["prescribed"]), 1.31)
        self.assertEqual(len(page.events["document"]["steps"]), 3)
        self.disagree("usage", "has 3", page.ask("goto", at=9))
        self.disagree("usage", "3", page.ask("edit", step=-1, operator=DOME[1]))
        self.disagree("bad_input", "radus", page.ask("apply", operator={"op": "rim_circle", "radus": 1}))
        self.assertIn('"rim_circle"', self.agree(page.ask("recipe"))["text"])

    def test_a_step_that_fails_later_is_marked(self):
        page = self.page(self.start())
        self.agree(page.ask("apply", operator={"op": "hold_fair", "hinges": "300"}))
        self.agree(page.ask("edit", step=0, operator=dict(DOME[0], triangles=60)))  # there is no hinge 300 any more
        page.rest()
        document = page.events["document"]
        self.assertEqual((document["at"], len(document["steps"])), (4, 5))
        self.assertEqual(document["steps"][4]["state"], "failed")
        self.assertIn("300", document["steps"][4]["problem"])
        self.assertLess(page.events["linkage"]["triangles"], 80)

    def test_dynamics_play_pause_step_and_come_to_rest(self):
        page = self.page(self.start())
        rest = page.state["simulated"]
        self.agree(page.ask("restart", height=0.02))
        page.until(lambda: page.state["simulated"] != rest)
        low, whole = (max(z) - min(z) for z in (page.state["simulated"][2::3], rest[2::3]))
        self.assertLess(low, 0.25 * whole, (low, whole))
        self.agree(page.ask("step", iterations=30))
        frames = page.frames
        self.agree(page.ask("play"))
        page.until(lambda: page.frames > frames + 3)
        page.rest()
        span = max(page.state["simulated"][2::3]) - min(page.state["simulated"][2::3])
        self.assertLess(abs(span / whole - 1), 0.05)  # it rose by itself to where it was
        self.agree(page.ask("settle"))
        page.until(lambda: page.state["simulated"] == rest)

    def test_a_hinge_is_grabbed_and_let_go(self):
        page = self.page(self.start())
        origin, places = page.events["linkage"]["origin"], page.state["simulated"]
        hinge = max(range(len(places) // 3), key=lambda h: places[3 * h + 2])
        place = [places[3 * hinge + c] + origin[c] for c in range(3)]
        target = [place[0], place[1], place[2] - 0.3]
        page.tell("grab", hinge=hinge, to=target, serial=7)
        page.until(lambda: page.last.serial == 7)
        page.rest()
        pulled = page.state["simulated"][3 * hinge + 2] + origin[2]
        self.assertLess(pulled, place[2] - 0.05)
        self.agree(page.ask("release"))
        page.until(lambda: page.state["simulated"][3 * hinge + 2] + origin[2] > place[2] - 0.05)

    def test_motion_leads_from_flat_to_deployed(self):
        page = self.page(self.start())
        answer = self.agree(page.ask("motion", frames=12))
        frames = [frame for frame in page.others if frame.kind == 3]
        self.assertEqual(answer["frames"], len(frames))
        self.assertEqual([frame.sections["place"] for frame in frames], [(k, len(frames)) for k in range(len(frames))])
        shares = [frame.sections["share"][0] for frame in frames]
        self.assertEqual(shares, sorted(shares))
        height = [max(frame.sections["deployed"][2::3]) - min(frame.sections["deployed"][2::3]) for frame in frames]
        self.assertLess(height[0], 0.1)
        self.assertGreater(height[-1], 0.9 * (max(page.state["simulated"][2::3]) - min(page.state["simulated"][2::3])))

    def test_collisions_name_panels_that_do_collide(self):
        page = self.page(self.start(steps=[dict(DOME[0], triangles=200), {"op": "fill", "value": 2},
                                           dict(STROKE, value=1), {"op": "inflation"}]))
        page.rest()
        report = page.events["report"]
        check = next(check for check in report["checks"] if check["key"] == "overlap")
        flat, triangles = page.state["flat"], page.state["triangles"]

        def corners(t):
            a, b, c = (complex(flat[2 * h], flat[2 * h + 1]) for h in triangles[3 * t:3 * t + 3])
            return (a, b, c) if ((b - a).conjugate() * (c - a)).imag > 0 else (a, c, b)  # some are turned over

        def apart(a, b):  # an edge of one has the other beyond it
            return any(all(((b[k] - b[k - 1]).conjugate() * (p - b[k - 1])).imag < 1e-9 for p in a) for k in range(3))
        pair = corners(check["triangle"]), corners(check["other"])
        self.assertFalse(apart(*pair) or apart(*reversed(pair)), check)
        self.assertEqual((check["severity"], report["verdict"]["word"]), ("failure", "No"))
        plan = self.agree(page.ask("export", ending=".svg"))["plan"]
        self.assertEqual(len(plan["collisions"]), min(plan["clashes"], 100))
        flat_ones = [[corners(t) for t in c["panels"]] for c in plan["collisions"] if c["when"] == "flat"]
        self.assertTrue(flat_ones)
        for a, b in flat_ones:
            self.assertFalse(apart(a, b) or apart(b, a))

    def test_slack_sheets_are_told_as_such_and_their_folds_in_the_plan(self):
        page = self.page(self.start(steps=[{"op": "start_circle", "radius": 1, "triangles": 24, "scale": 1.9},
                                           {"op": "rim_circle", "radius": 0.3}, {"op": "inflation"}]))
        page.rest()
        check = next(check for check in page.events["report"]["checks"] if check["key"] == "match")
        self.assertEqual(check["severity"], "warning")
        self.assertRegex(check["answer"], r"^slack, \d+ % open$")
        plan = self.agree(page.ask("export", ending=".svg"))["plan"]
        self.assertGreater(plan["folds"], 0)
        self.assertEqual(len(set(plan["fold"])), 2)
        self.assertIsInstance(plan["doubt"], str)

    def test_variants_are_kept_compared_and_taken(self):
        page = self.page(self.start())
        self.agree(page.ask("variant", name="low"))
        self.agree(page.ask("apply", operator={"op": "fill", "value": 1.5}))
        self.agree(page.ask("variant", name="even"))
        page.rest()
        variants = {variant["name"]: variant for variant in page.events["variants"]["variants"]}
        self.assertEqual((variants["low"]["steps"], variants["even"]["steps"], variants["even"]["current"]), (4, 5, True))
        self.agree(page.ask("variant_look", name="low"))
        look = page.others[-1]
        self.assertEqual((look.kind, page.events["linkage"]["variant"]), (4, "low"))
        self.assertGreater(max(look.sections["prescribed"]), 1.6)
        self.agree(page.ask("variant_take", name="low"))
        page.rest()
        self.assertEqual(len(page.events["document"]["steps"]), 4)
        self.agree(page.ask("variant_drop", name="low"))
        self.disagree("bad_input", "no variant", page.ask("variant_take", name="low"))

    def test_variants_are_in_the_document(self):
        studio = self.start()
        page = self.page(studio)
        self.agree(page.ask("save", path="roof"))
        self.agree(page.ask("variant", name="low"))
        self.agree(page.ask("apply", operator={"op": "fill", "value": 1.5}))
        self.agree(page.ask("variant", name="even"))
        page.rest()
        before = page.events["variants"]
        studio.stop(signal.SIGKILL)
        self.assertIn("Variant low: 4 steps", self.succeed("history", self.folder / "roof.auxshell"))
        page = self.page(self.start(steps=None, document=self.folder / "roof.auxshell"))
        page.rest()
        self.assertEqual(page.events["variants"], before)
        self.agree(page.ask("variant_look", name="low"))
        self.assertGreater(max(page.others[-1].sections["prescribed"]), 1.6)
        self.agree(page.ask("variant_take", name="low"))
        page.rest()
        self.assertEqual(len(page.events["document"]["steps"]), 4)

    def test_tabs_on_one_document_see_the_same(self):
        studio = self.start()
        one, two = self.page(studio), self.page(studio)
        self.same_places(one.state, two.state)
        one.tell("preview", serial=1, operator=STROKE)
        one.until(lambda: one.last.serial == 1)
        two.tell("preview", serial=1, operator=dict(STROKE, value=1.9))  # the hand is the other page's
        self.agree(two.ask("recipe"))
        two.until(lambda: two.last.flags & 8)
        self.assertEqual(two.last.serial, 0)
        self.agree(one.ask("apply", operator=STROKE))
        one.rest()
        two.until(lambda: two.state["simulated"] == one.state["simulated"] and two.events["document"]["at"] == 5)
        self.assertEqual(one.events["document"]["steps"], two.events["document"]["steps"])
        # another document in one of them leaves the other alone
        self.agree(two.ask("new", recipe=[{"op": "start_circle", "radius": 1, "triangles": 60}]))
        two.rest()
        self.assertNotEqual(two.events["document"]["id"], one.events["document"]["id"])
        self.agree(two.ask("join", document=one.events["document"]["id"]))
        two.until(lambda: two.last.topology and len(two.state["flat"]) == len(one.state["flat"]))
        two.rest()
        self.same_places(one.state, two.state)

    def test_finish_is_exact_and_exports_are_fetched_once(self):
        studio = self.start()
        page = self.page(studio)
        self.assertFalse(self.agree(page.ask("export", ending=".obj"))["exact"])
        answer = self.agree(page.ask("finish"))
        self.assertTrue(answer["exact"], answer)
        page.rest()
        self.assertTrue(page.last.flags & EXACT)
        self.assertEqual(page.events["status"]["state"], "exact")
        self.assertEqual(len(page.state["edge_forces"]), 3 * page.events["linkage"]["triangles"])
        reactions = page.state["reactions"]
        self.assertGreater(max(map(abs, reactions)), 0)
        for ending in (".json", ".svg", ".obj"):
            file, = self.agree(page.ask("export", ending=ending))["files"]
            status, headers, body = studio.request("GET", "/" + file["url"])
            self.assertEqual((status, len(body)), (200, file["bytes"]))
            self.assertIn("dome" + ending, headers["Content-Disposition"])
            self.assertEqual(studio.request("GET", "/" + file["url"])[0], 404)
            if ending == ".json":
                figures = judge_design.judge(json.loads(body))
                self.assertLess(figures["congruence_max"], 1e-9)
        self.disagree("usage", "known", page.ask("export", ending=".xyz"))
        self.agree(page.ask("apply", operator={"op": "fill", "value": 1.4}))
        page.rest()
        self.assertEqual((page.events["status"]["state"], page.state["edge_forces"]), ("edited", ()))

    def test_long_work_reports_and_is_cancelled(self):
        page = self.page(self.start())
        before = dict(page.state)
        page.number += 1
        page.tell("new", id=page.number, recipe=[dict(DOME[0], triangles=40000), *DOME[1:]])
        time.sleep(0.3)
        page.tell("cancel")
        while True:
            message = page.read()
            if isinstance(message, dict) and message.get("re") == page.number and "ok" in message:
                break
        self.disagree("cancelled", "", message)
        page.rest()
        self.assertEqual([key for key in before if page.state.get(key) != before[key]], [], "what was there is there again")
        self.agree(page.ask("apply", operator=STROKE))


class Documents(StudioCase):
    def drafts(self):
        return sorted(path.name for path in (self.folder / "state/auxshell").glob("*.auxshell"))

    def test_what_was_acknowledged_survives_a_kill(self):
        studio = self.start()
        page = self.page(studio)
        draft = page.events["document"]["id"]
        self.agree(page.ask("apply", operator=STROKE))
        self.agree(page.ask("undo"))
        self.agree(page.ask("redo"))
        page.rest()
        before, origin = dict(page.state), page.events["linkage"]["flat_origin"]
        for serial in range(1, 4):  # and in the middle of a gesture, which is not
            page.tell("preview", serial=serial, operator=dict(STROKE, value=1.8))
        page.tell("apply", operator=dict(STROKE, value=1.9))
        studio.stop(signal.SIGKILL)
        again = self.start(steps=None)
        page = self.page(again, joined=False)
        self.assertEqual([(found["name"], found["title"]) for found in page.hello["recovered"]], [(draft, "dome")])
        self.agree(page.ask("join", document=draft))
        page.until(lambda: page.frames)
        page.rest()
        self.assertIn(len(page.events["document"]["steps"]), (5, 6))  # the last one was not acknowledged: either way
        if len(page.events["document"]["steps"]) == 5:
            moved = [a - b for a, b in zip(origin, page.events["linkage"]["flat_origin"])]
            off = max(abs(a - b - moved[k % 2]) for k, (a, b) in enumerate(zip(page.state["flat"], before["flat"])))
            self.assertLess(off, 1e-6)  # single precision
        self.agree(page.ask("undo"))

    def test_kills_at_any_moment_leave_a_sound_document(self):
        run = random.Random(seed := int(os.environ.get("AX_SEED", "1")))
        print(f"# seed {seed}")
        studio = self.start(steps=[dict(DOME[0], triangles=60), *DOME[2:]])
        page = self.page(studio)
        self.agree(page.ask("save", path="roof"))
        acknowledged = page.events["document"]["at"]
        for _ in range(2 if QUICK else 12):
            for _ in range(run.randrange(3)):
                acknowledged = self.agree(page.ask("apply", operator=dict(STROKE, value=1.2 + 0.5 * run.random())))["at"]
            page.tell("apply", operator=STROKE)
            time.sleep(run.random() * 0.1)
            studio.stop(signal.SIGKILL)
            studio = self.start(steps=None, document=self.folder / "roof.auxshell")
            page = self.page(studio)
            at = page.events["document"]["at"]
            self.assertIn(at, (acknowledged, acknowledged + 1))
            acknowledged = at
        with contextlib.closing(sqlite3.connect(self.folder / "roof.auxshell")) as base:
            self.assertEqual(base.execute("PRAGMA integrity_check").fetchone(), ("ok",))

    def test_documents_are_saved_under_names_and_opened(self):
        studio = self.start()
        page = self.page(studio)
        draft = page.events["document"]["id"]
        self.assertIsNone(page.events["document"]["path"])
        self.disagree("usage", "name", page.ask("save"))
        self.disagree("bad_input", "outside", page.ask("save", path="../roof"))
        self.agree(page.ask("apply", operator=STROKE))
        page.rest()
        answer = self.agree(page.ask("save", path="roof"))
        self.assertEqual((answer["path"], answer["document"]), ("roof.auxshell", "roof.auxshell"))
        document = page.events["document"]
        self.assertEqual((document["id"], document["name"], document["path"]), ("roof.auxshell", "roof", "roof.auxshell"))
        self.assertEqual((self.drafts(), draft in document["id"]), ([], False))
        self.assertTrue(document["undo"])  # the history came along
        self.agree(page.ask("undo"))
        self.assertEqual(len(page.events["document"]["steps"]), 4)

        self.agree(page.ask("new", recipe=[{"op": "start_circle", "radius": 1, "triangles": 60}], name="disc"))
        self.disagree("bad_input", "already", page.ask("save", path="roof.auxshell"))
        self.assertFalse(page.ask("save", path="roof.auxshell", overwrite=True)["ok"])  # it is open here
        self.agree(page.ask("save", path="disc"))
        self.agree(page.ask("open", path="roof.auxshell"))
        page.until(lambda: page.events["document"]["id"] == "roof.auxshell")
        self.assertEqual({file["name"] for file in self.agree(page.ask("files"))["files"]} & {"roof.auxshell", "disc.auxshell", "dome.json"},
                         {"roof.auxshell", "disc.auxshell", "dome.json"})
        code, said = studio.stop()
        self.assertEqual((code, said, self.drafts()), (0, "", []))

        again = self.start(steps=None, document=self.folder / "roof.auxshell")
        page = self.page(again)
        self.assertEqual((page.events["document"]["id"], page.events["document"]["redo"] is not None), ("roof.auxshell", True))
        # who comes second may look only
        other = self.start(steps=None, document=self.folder / "roof.auxshell")
        looker = self.page(other)
        self.assertIn("open", looker.events["document"]["read_only"])
        self.disagree("failed", "open", looker.ask("apply", operator=STROKE))
        self.agree(page.ask("redo"))

    def test_closing_tells_everyone_and_keeps_what_was_edited(self):
        studio = self.start()
        one, two = self.page(studio), self.page(studio)
        self.agree(one.ask("apply", operator=STROKE))
        self.agree(one.ask("close"))
        two.until(lambda: "closed" in two.events)
        self.disagree("usage", "join", two.ask("undo"))
        kept, = self.drafts()
        self.agree(two.ask("open", recovered=kept.removesuffix(".auxshell")))
        two.until(lambda: len(two.events["document"]["steps"]) == 5)
        self.agree(two.ask("close", discard=True))
        self.assertEqual(self.drafts(), [])

    def test_examples_open_and_the_first_is_exact(self):
        studio = self.start(steps=None)
        page = self.page(studio)
        self.assertTrue(page.last.flags & EXACT)
        self.assertEqual(page.events["report"]["checks"][-1]["severity"], "pass")
        self.disagree("bad_input", "no example", page.ask("new", example="../tests/x"))
        if not QUICK:
            self.agree(page.ask("new", example="hybrid-shell"))
            page.until(lambda: page.events["document"]["name"] == "hybrid-shell")
            self.assertIn("arch1", [selection["name"] for selection in page.events["document"]["selections"]])

    @unittest.skipIf(QUICK, "times are of the release build")
    def test_every_example_opens_within_a_second(self):
        build = Path(AUXSHELL).resolve().parent.parent
        subprocess.run(["ninja", "--quiet", "-C", build, "example_documents"], check=True, stdout=subprocess.DEVNULL)
        studio = self.start(steps=None)
        page = self.page(studio)
        slowest = 0
        for example in page.hello["examples"]:
            name = example["name"]
            with self.subTest(example=name):
                start = time.monotonic()
                self.agree(page.ask("new", example=name))
                page.until(lambda: page.events["document"]["name"] == name and page.last.flags & EXACT)
                slowest = max(slowest, time.monotonic() - start)
                self.assertGreater(len(page.events["document"]["steps"]), 2)
        print(f"# the slowest of {len(page.hello['examples'])} examples took {slowest:.2f} s")
        self.assertLess(slowest, 1)
        page.ask("close", discard=True)

    def test_what_nobody_edited_is_not_kept(self):
        studio = self.start()
        page = self.page(studio)
        page.tell("play")
        self.agree(page.ask("motion", frames=2))
        self.assertEqual(len(self.drafts()), 1)
        studio.stop()
        self.assertEqual(self.drafts(), [])

    def test_cut_files_take_their_options_and_come_sheet_by_sheet(self):
        studio = self.start()
        page = self.page(studio)
        making = page.hello["making"]
        self.assertIn("ring", [joint["name"] for joint in making["joints"]])
        self.assertIn("generic", [profile["name"] for profile in making["profiles"]])
        answer = self.agree(page.ask("export", ending=".svg", sheet="1000x1000", kerf=0.2))
        names = [file["name"] for file in answer["files"]]
        self.assertEqual(len(names), answer["plan"]["sheets"] + 1)
        self.assertLess({"dome.svg", "dome-1.svg", "dome-2.svg"}, set(names))
        for file in answer["files"]:
            self.assertEqual(len(studio.request("GET", "/" + file["url"])[2]), file["bytes"])
        for wrong in ({"sheet": "1x1x1"}, {"kerf": -1}, {"joint": "glue"}, {"profile": "/etc/passwd"}, {"profile": "a.json"}, {"margin": 1e9}):
            self.assertFalse(page.ask("export", ending=".svg", **wrong)["ok"], wrong)
        recipe_file, = self.agree(page.ask("export", ending=".recipe.json"))["files"]
        self.assertEqual(len(json.loads(studio.request("GET", "/" + recipe_file["url"])[2])["operators"]), 4)
        self.page(studio)  # whoever comes now finds a state at rest

    def test_whoever_waits_for_a_document_hears_how_far_it_is(self):
        page = self.page(self.start())
        page.events.pop("progress", None)
        heard = []
        page.number += 1
        page.tell("new", id=page.number, recipe=[dict(DOME[0], triangles=2000 if QUICK else 12000), *DOME[1:]])
        message = None
        while not isinstance(message, dict) or message.get("re") != page.number or "ok" not in message:
            message = page.read()
            if isinstance(message, dict) and message.get("event") == "progress":
                heard.append(message)
        self.assertTrue(message["ok"], message)
        self.assertTrue(heard, "nothing was said")
        self.assertTrue(all(0 <= progress["fraction"] <= 1 for progress in heard))
        page.until(lambda: page.events.get("progress", {}).get("done"))

    def test_whoever_waits_for_a_document_sees_it_being_made(self):
        studio = self.start()
        page = self.page(studio)
        page.rest()
        old, before, topology = page.events["document"]["id"], dict(page.state), page.events["linkage"]["topology"]
        steps = [dict(DOME[0], triangles=2000), *DOME[1:]]

        def making():  # its linkage and states come, while the document is still the old one
            page.number += 1
            page.tell("new", id=page.number, recipe=steps)
            heights = []
            while len(heights) < 6 or len({round(h, 3) for h in heights}) < 3:
                message = page.read()
                self.assertNotIn("ok", message if isinstance(message, dict) and message.get("re") == page.number else {}, "it was made unseen")
                if not isinstance(message, dict) and message.kind == 1 and page.events["linkage"]["document"] != old:
                    heights.append(max((page.state["simulated"] or page.state["deployed"])[2::3]))
                    self.assertFalse(message.flags & SETTLED)
            self.assertEqual(page.events["document"]["id"], old)
            self.assertNotEqual(page.events["linkage"]["document"], old)
            return page.number

        number = making()
        self.agree(page.ask("cancel"))
        refused = lambda message: isinstance(message, dict) and message.get("re") == number and message.get("ok") is False
        while not refused(page.read()):
            pass
        page.until(lambda: page.events["linkage"]["document"] == old and page.state["flat"] == before["flat"])
        self.assertEqual({name for name in before if page.state[name] != before[name]}, set())
        self.assertEqual(page.events["linkage"]["topology"], topology)
        self.agree(page.ask("apply", operator=STROKE))  # and it goes on

        number = making()
        self.disagree("usage", "made", page.ask("close"))
        while True:
            message = page.read()
            if isinstance(message, dict) and message.get("re") == number and "ok" in message:
                break
        self.assertTrue(message["ok"], message)
        self.assertEqual(page.events["document"]["id"], message["document"])
        page.rest()
        self.assertGreater(len(page.state["triangles"]), 3 * 1500)


class Surfaces(StudioCase):
    def test_a_mesh_is_checked_shown_and_designed(self):
        studio = self.start()
        page = self.page(studio)
        mesh = (SURFACES / "oval_dome.obj")
        if not mesh.exists():
            mesh = sorted(SURFACES.glob("*.obj"))[0]
        token = studio.upload("roof.obj", mesh.read_bytes())
        answer = self.agree(page.ask("check", upload=token))
        self.assertIn(answer["verdict"], ("deployable", "deployable_projected"))
        surface = page.others[-1]
        self.assertEqual(surface.kind, 2)
        self.assertEqual(len(surface.sections["vertices"]), 3 * answer["vertices"])
        self.assertEqual(len(surface.sections["faces"]), 3 * answer["faces"])
        self.assertEqual(len(surface.sections["vertex_curvature"]), answer["vertices"])
        status, headers, picture = studio.request("GET", "/" + answer["pictures"]["curvature"])
        self.assertEqual((status, picture[:4], headers["Content-Type"]), (200, b"\x89PNG", "image/png"))
        self.agree(page.ask("new", files={"roof.obj": token}, recipe=[{"op": "start_target", "file": "roof.obj", "triangles": 300},
                                                                       {"op": "inflation"}]))
        page.rest()
        self.assertLess(abs(page.events["linkage"]["triangles"] / 300 - 1), 0.1)

    def test_a_surface_may_lie_on_its_side_and_be_drawn_in_millimetres(self):
        studio = self.start()
        page = self.page(studio)
        lying = ""
        for kind, *words in filter(None, map(str.split, (SURFACES / "spherical_cap.obj").read_text().splitlines())):
            if kind == "v":
                x, y, z = (1000 * float(word) for word in words)
                words = map(str, (x, z, -y))
            lying += " ".join((kind, *words)) + "\n"
        token = studio.upload("lying.obj", lying.encode())
        answer = self.agree(page.ask("check", upload=token))
        self.assertEqual((answer["lies_on_side"], answer["by_gravity"], answer["likely_unit"]), (True, False, "mm"))
        self.assertEqual(self.agree(page.ask("check", upload=token, up="y"))["by_gravity"], True)
        self.disagree("usage", "file, y or z", page.ask("check", upload=token, up="x"))
        self.disagree("usage", "mm, cm or m", page.ask("check", upload=token, unit="ft"))

    def test_what_is_no_surface_is_refused_in_words(self):
        studio = self.start()
        page = self.page(studio)
        for name, data in (("nothing.obj", b""), ("text.obj", b"hello"), ("sphere.stl", os.urandom(5000))):
            answer = page.ask("check", upload=studio.upload(name, data))
            self.disagree("bad_input", name, answer)  # by its name, not by where it lies
            self.assertNotIn(str(self.folder), answer["error"]["message"])
        self.disagree("bad_input", "upload", page.ask("check", upload="x" * 20))
        self.disagree("usage", "", page.ask("check"))
        self.disagree("bad_input", "outside", page.ask("check", path="../../etc/passwd"))
        self.disagree("bad_input", "", page.ask("check", path="/etc/passwd"))


class Safety(StudioCase):
    def test_who_does_not_know_the_secret_is_told_nothing(self):
        studio = self.start()
        status, headers, body = studio.request("GET", "/")
        self.assertEqual(status, 200)
        self.assertIn("text/html", headers["Content-Type"])
        policy = headers["Content-Security-Policy"]
        self.assertIn("default-src 'none'", policy)
        self.assertNotIn("unsafe-inline", policy)
        self.assertNotIn("'unsafe-eval'", policy)
        self.assertEqual((headers["X-Content-Type-Options"], headers["Referrer-Policy"]), ("nosniff", "no-referrer"))
        right, studio.secret = studio.secret, "a" * len(studio.secret)
        for path in ("/", "/file/x", "/index.html"):
            self.assertEqual(studio.request("GET", path)[0], 404)
        self.assertEqual(studio.request("POST", "/upload?name=a.obj", b"x", {"Origin": f"http://127.0.0.1:{studio.port}"})[0], 404)
        self.assertEqual(Page(studio).status, 404)
        studio.secret = right[:-1]
        self.assertEqual(Page(studio).status, 404)
        self.assertEqual(studio.request("GET", "")[0], 404)
        studio.secret = right
        self.assertEqual(Socket(studio.port, f"/{right}/ws").status, 404)
        self.assertEqual(Socket(studio.port, "/ws").status, 404)
        self.page(studio)

    def test_other_sites_are_kept_out(self):
        studio = self.start()
        own = f"http://127.0.0.1:{studio.port}"
        for host in ("evil.example", f"evil.example:{studio.port}", "127.0.0.1", f"127.0.0.1:{studio.port + 1}", "0.0.0.0"):
            self.assertEqual(studio.request("GET", "/", headers={"Host": host})[0], 403, host)
            self.assertEqual(Page(studio, host=host).status, 403, host)
        for origin in ("http://evil.example", "null", own.replace("http", "https"), own + ".evil.example", f"http://127.0.0.1:{studio.port + 1}"):
            self.assertEqual(studio.request("GET", "/", headers={"Origin": origin})[0], 403, origin)
            self.assertEqual(studio.request("POST", "/upload?name=a.obj", b"x", {"Origin": origin})[0], 403, origin)
            self.assertEqual(Page(studio, origin=origin).status, 403, origin)
        self.assertEqual(Page(studio, origin="").status, 403)  # browsers always send it
        self.assertEqual(studio.request("POST", "/upload?name=a.obj", b"x")[0], 403)
        local = f"localhost:{studio.port}"
        self.assertEqual(Page(studio, host=local, origin=f"http://{local}").status, 101)

    def test_it_listens_on_the_loopback_interface_only(self):
        studio = self.start()
        with open("/proc/net/tcp", encoding="ascii") as table:
            listening = [line.split()[1] for line in table if line.split()[3] == "0A"]
        mine = [address for address in listening if int(address.split(":")[1], 16) == studio.port]
        self.assertEqual(mine, [f"0100007F:{studio.port:04X}"])

    def test_paths_and_methods_lead_nowhere_else(self):
        studio = self.start()
        for path in ("/../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/assets/../../etc/passwd", "//etc/passwd", "/file/../state",
                     "/nothing.js", "/index.html/", "/file/", "/" + "a" * 3000):
            self.assertIn(studio.request("GET", path)[0], (400, 404, 414, None), path)
        self.assertEqual(studio.request("PUT", "/upload?name=a.obj", b"x")[0], 405)
        self.assertEqual(studio.request("DELETE", "/")[0], 405)
        origin = {"Origin": f"http://127.0.0.1:{studio.port}"}
        for name in ("..%2fa.obj", ".hidden", "", "a%00b", "a" * 300):
            self.assertIn(studio.request("POST", f"/upload?name={name}", b"x", origin)[0], (400, 404, None), name)
        self.assertEqual(studio.request("POST", "/upload?name=a.obj", None, {**origin, "Content-Length": str(65 << 20)})[0], 413)
        page = self.page(studio)
        outside = self.folder.parent / "outside.auxshell"
        (self.folder / "link.json").symlink_to("/etc/hostname")
        for path in (str(outside), "../outside.auxshell", "link.json", "state/../../outside.json", ""):
            self.assertFalse(page.ask("open", path=path)["ok"], path)


class Survival(StudioCase):
    def alive(self, studio):
        page = self.page(studio, joined=False)
        self.agree(page.ask("join"))
        self.agree(page.ask("recipe"))
        page.until(lambda: page.frames)
        page.close()

    def expect_close(self, page, code):
        with self.assertRaises((Closed, ConnectionError)) as caught:
            for _ in range(1000):
                page.receive()
        if isinstance(caught.exception, Closed) and code:
            # the word may be lost where the server hangs up on what we are still sending
            self.assertIn(caught.exception.code, (code, None) if code == 1009 else (code,))

    def test_messages_that_are_none_are_answered_and_forgotten(self):
        studio = self.start()
        page = self.page(studio)
        for text in ("", "{", "[]", "7", "null", '"do"', "{}", '{"do": 3}', '{"do": ""}', '{"do": "x" , "do": "y"}', '{"id": 1.5, "do": "undo"}',
                     '{"do": "' + "x" * 1000 + '"}', "[" * 100000, '{"a":' * 40 + "1" + "}" * 40, '{"do": "undo", "id": 99999999999}',
                     "\x00", '{"do": "\\ud800"}', "nan", '{"do": "preview", "serial": "1", "operator": {}}',
                     '{"do": "preview", "serial": 1, "operator": []}', '{"do": "grab", "hinge": -1, "to": [0, 0, 0]}',
                     '{"do": "grab", "hinge": 0, "to": [0, 0]}', '{"do": "join", "ahead": 100}'):
            before = len(page.problems)
            page.send(text)
            page.until(lambda: len(page.problems) > before)
        for action, parameters in (("undo", {"extra": 1}), ("goto", {}), ("goto", {"at": "x"}), ("step", {"iterations": 0}), ("nonsense", {}),
                                   ("apply", {"operator": None}), ("apply", {"operator": {"op": "launch"}}), ("join", {"document": "d99"}),
                                   ("new", {}), ("new", {"recipe": []}), ("new", {"recipe": [1]}), ("open", {}), ("files", {"folder": "/"}),
                                   ("restart", {"height": 1e9}), ("motion", {"frames": 1}), ("check", {"path": 3}), ("select", {}),
                                   ("keep", {"upload": "x"}), ("variant", {"name": ""}), ("variant_look", {"name": "x"})):
            self.assertFalse(page.ask(action, **parameters)["ok"], action)
        page.tell("grab", hinge=10 ** 6, to=[0, 0, 0])
        page.until(lambda: page.problems[-1].get("do") == "grab")
        self.alive(studio)

    def test_commands_before_join_are_refused(self):
        page = self.page(self.start(), joined=False)
        for action in ("undo", "apply", "play", "finish", "grab", "preview"):
            self.disagree("usage", "join", page.ask(action))

    def test_broken_frames_close_only_their_connection(self):
        studio = self.start()
        cases = [(1003, lambda page: page.send(b"\x00\x01", 2)),
                 (1009, lambda page: page.send("x" * ((1 << 20) + 1))),
                 (1009, lambda page: page.raw(b"\x81\xff" + struct.pack(">Q", 1 << 40) + b"mask" + bytes(100))),
                 (1007, lambda page: page.send(b"\xff\xfe{}")),
                 (None, lambda page: page.send("x", 3)),
                 (None, lambda page: page.send("x", 0)),
                 (None, lambda page: page.raw(b"\xf1\x80mask"))]
        for code, break_it in cases:
            page = self.page(studio)
            try:
                break_it(page)
            except ConnectionError:
                pass  # it hung up while we were still sending
            self.expect_close(page, code)
        long = self.page(studio)
        for part in range(40):  # a message in parts grows too long as well
            try:
                long.send("x" * 50000, 0 if part else 1, final=False)
            except ConnectionError:
                break
        self.expect_close(long, 1009)
        self.alive(studio)

    def test_parts_pings_and_half_closed_connections(self):
        studio = self.start()
        page = self.page(studio)
        text = '{"do": "recipe", "id": 77}'
        for k, letter in enumerate(text):
            page.send(letter, 0 if k else 1, final=k == len(text) - 1)
            if k % 5 == 0:
                page.send("ping", 9)
        while (message := page.read()) and (not isinstance(message, dict) or message.get("re") != 77):
            pass
        self.agree(message)
        for cut in (b"", b"\x81", b"\x81\xfe\x10\x00mask{", b"GET / HT"):
            half = self.page(studio, joined=False)
            half.raw(cut)
            half.socket.shutdown(1)
            self.expect_close(half, None)
        for _ in range(5):  # gone in the middle of everything
            gone = self.page(studio)
            gone.tell("play")
            gone.tell("grab", hinge=3, to=[0, 0, 3], serial=1)
            gone.close()
        for start in ("GET / HTTP/1.1\r\nHost", "\x16\x03\x01 no tls here", "POST /x HTTP/1.1\r\nContent-Length: -5\r\n\r\n"):
            request = socket.create_connection(("127.0.0.1", studio.port))
            request.sendall(start.encode())
            request.close()
        self.alive(studio)

    def test_too_many_pages_are_turned_away(self):
        studio = self.start()
        pages = [self.page(studio, joined=False) for _ in range(16)]
        one_more = Page.__new__(Page)
        Socket.__init__(one_more, studio.port, f"/ws?key={studio.secret}")
        with self.assertRaises((Closed, ConnectionError)):
            one_more.receive()
        pages[3].close()
        time.sleep(0.2)
        self.alive(studio)

    def test_a_flood_of_previews_keeps_only_the_newest(self):
        studio = self.start()
        page = self.page(studio)
        count, start, before = 1000, time.monotonic(), page.frames
        for serial in range(1, count + 1):
            page.tell("preview", serial=serial, operator=dict(STROKE, value=1.3 + 0.3 * serial / count))
        page.until(lambda: page.last.serial == count)
        took = time.monotonic() - start
        self.assertLess(page.frames - before, 0.8 * count)
        self.assertGreater(took, (count - 400) / 200 - 0.5)  # the rate is limited, nothing is lost
        self.alive(studio)

    def test_a_page_that_does_not_read_holds_up_nobody(self):
        studio = self.start()
        lazy, page = self.page(studio), self.page(studio)

        def memory():
            with open(f"/proc/{studio.process.pid}/statm", encoding="ascii") as file:
                return int(file.read().split()[1]) * 4096

        def opened():
            self.agree(page.ask("restart"))
            self.agree(page.ask("play"))
            page.rest()

        opened()  # what the solvers take, they take once
        before = memory()
        for _ in range(3):
            opened()
        self.assertLess(memory() - before, 64 << 20)
        for _ in range(100):
            lazy.tell("recipe", id=5)
        self.agree(page.ask("recipe"))
        lazy.rest()  # and it catches up when it reads again

    def test_frames_ahead_of_the_page_are_limited(self):
        studio = self.start()
        page = self.page(studio, joined=False)
        self.agree(page.ask("join", ahead=2))
        page.until(lambda: page.frames == 1)
        page.tell("seen")
        self.agree(page.ask("restart"))
        page.tell("play")
        time.sleep(1)
        for _ in range(3):
            self.agree(page.ask("recipe"))
        self.assertLessEqual(page.frames, 3)
        page.tell("seen")
        frames = page.frames
        page.until(lambda: page.frames > frames)


class Life(StudioCase):
    def test_an_interrupt_ends_it_and_leaves_nothing(self):
        studio = self.start()
        page = self.page(studio)
        studio.upload("a.obj", b"x")
        page.tell("play")
        self.assertEqual(studio.stop(), (0, ""))
        with self.assertRaises((Closed, ConnectionError)):
            while True:
                page.read()
        self.assertIn("bye", page.events)
        self.assertEqual([path for path in self.folder.iterdir() if path.name.startswith("auxshell-")], [])

    def test_wrong_starts_are_refused(self):
        self.refuse(2, "65535", "studio", "--port", "80")
        self.refuse(3, "missing", "studio", self.folder / "missing.auxshell", "--no-browser")
        (self.folder / "bad.json").write_text("{")
        self.refuse(3, "JSON", "studio", self.folder / "bad.json", "--no-browser")
        studio = self.start()
        (self.folder / "other.json").write_text(recipe(DOME[:1]))
        self.refuse(1, "port", "studio", self.folder / "other.json", "--no-browser", "--port", studio.port)

    @unittest.skipIf(QUICK, "sanitizers are slow")
    def test_the_latency_of_the_hand(self):
        page = self.page(self.start(steps=[dict(DOME[0], triangles=2000), *DOME[1:]]))
        took = []
        for serial in range(1, 101):
            start = time.monotonic()
            page.tell("preview", serial=serial, operator=dict(STROKE, points=[[0.9 * math.cos(0.05 * k), 0.9 * math.sin(0.05 * k)]
                                                                             for k in range(serial)]))
            page.until(lambda: page.last.serial >= serial)
            took.append(1000 * (time.monotonic() - start))
            time.sleep(max(0, 1 / 60 - took[-1] / 1000))
        took.sort()
        print(f"# hand to frame at {page.events['linkage']['triangles']} triangles: median {took[50]:.1f}, 95 % {took[95]:.1f} ms")
        self.assertLess(took[95], 150)


if __name__ == "__main__":
    support.tap.main()
