#!/usr/bin/python3
"""The command as its users meet it: usage, answers, exit codes, and what it leaves behind. AUXSHELL names the program."""
import json
import os
import pty
import signal
import subprocess
import tempfile
import time
import unittest
from contextlib import contextmanager
from pathlib import Path

import support.tap
from support.command import AUXSHELL, QUICK, ROOT, SURFACES, CommandCase, run, with_file_size_limit

DOME, SADDLE, HEMISPHERE = SURFACES / "ellipse_dome.obj", SURFACES / "saddle.obj", SURFACES / "hemisphere.obj"


def wait_for_handler(process, number):
    """Until the program catches the signal: before, it would die of it, as any program that has not begun."""
    status = Path(f"/proc/{process.pid}/status")
    while process.poll() is None:
        caught = next(line for line in status.read_text().splitlines() if line.startswith("SigCgt"))
        if int(caught.split()[1], 16) >> (number - 1) & 1:
            return
        time.sleep(0.005)


class Usage(CommandCase):
    def test_alone_it_prints_the_help(self):
        for words in ((), ("--help",), ("-h",)):
            output = self.succeed(*words)
            for name in ("check", "design", "simulate", "info", "export"):
                self.assertIn(f"\n  {name} ", output)

    def test_every_command_explains_itself(self):
        for name in ("check", "design", "simulate", "info", "export"):
            output = self.succeed(name, "--help")
            self.assertTrue(output.startswith(f"usage: auxshell {name} "), output)
            self.assertLessEqual(max(map(len, output.splitlines())), 100)

    def test_version_is_that_of_the_project(self):
        version = (ROOT / "CMakeLists.txt").read_text().split("VERSION ")[2].split()[0]
        self.assertEqual(self.succeed("--version"), f"auxshell {version}\n")

    def test_reference_in_the_docs_is_up_to_date(self):
        self.assertEqual((ROOT / "docs/command.md").read_text(), self.succeed("--reference"),
                         "write it again: ./run --reference > docs/command.md")

    def test_wrong_usage_is_named(self):
        out = ("-o", self.folder / "x.auxshell")
        design = ("design", DOME, *out)
        for word, words in (
            ('"design"', ("desing", DOME)),
            ('no command "zzz"', ("zzz",)),
            ("TARGET is missing", ("check",)),
            ("-o P.auxshell is missing", ("design", DOME)),
            ("-o needs a value", ("design", DOME, "-o")),
            ("-o needs a value", ("design", DOME, "-o", "--triangles", "600")),
            ("must end in .auxshell", ("design", DOME, "-o", self.folder / "x.obj")),
            ("must end in .auxshell", ("design", DOME, "-o", self.folder / ".auxshell" / "")),
            ("/none cannot be used", ("design", DOME, "-o", "/none/x.auxshell")),
            ("is no folder", ("design", DOME, "-o", f"{DOME}/x.auxshell")),
            ("in the folder /proc", ("design", DOME, "-o", "/proc/x.auxshell")),
            ("one name too many", (*design, "other.obj")),
            ("Did you mean --triangles?", (*design, "--triangels", "600")),
            ("--help", (*design, "--zzzzzzzzzzzz")),
            ("24 to 2000000", (*design, "--triangles", "23")),
            ("24 to 2000000", (*design, "--triangles=2000001")),
            ("whole number", (*design, "--triangles", "600.5")),
            ("whole number", (*design, "--triangles", "99999999999999999999")),
            ("cannot be given together", (*design, "--triangles", "600", "--edge", "1")),
            ("more than 0", (*design, "--edge", "0")),
            ("more than 0", (*design, "--edge", "nan")),
            ("more than 0", (*design, "--edge", "inf")),
            ("gravity or inflation", (*design, "--load", "wind")),
            ("mm, cm or m", (*design, "--units", "inch")),
            ("LO,HI", (*design, "--scale", "1.9,1.1")),
            ("LO,HI", (*design, "--scale", "1.5,1.5")),
            ("within 1 to 2", (*design, "--scale", "0.9,1.5")),
            ("within 1 to 2", (*design, "--scale", "1.2,2.1")),
            ("LO,HI", (*design, "--scale", "1.2")),
            ("0 to 59 degrees", (*design, "--mouth-min", "-1")),
            ("takes no value", (*design, "--project=yes")),
            ("free, disk or polygon", (*design, "--flatten", "square")),
            ("free, disk or polygon", (*design, "--flatten", "polygon:90,90,90,x")),
            ("sum to 180 degrees", (*design, "--flatten", "polygon:90,90,90,80")),
            ("equilateral, released or inside", (*design, "--border", "none")),
            ("or edge", (*design, "--angle", "steep")),
            ("is a folder", ("design", DOME, "-o", self.folder_named("d.auxshell"))),
            ("is no folder", ("check", DOME, "--png", DOME)),
            ("cannot be used", ("check", DOME, "--png", "/none/at/all")),
        ):
            with self.subTest(words=words):
                self.refuse(2, word, *words)

    def folder_named(self, name):
        (self.folder / name).mkdir()
        return self.folder / name

    def test_usage_is_checked_before_long_work(self):
        start = time.monotonic()
        self.refuse(2, "/none", "design", DOME, "-o", "/none/x.auxshell", "--triangles", "40000")
        self.assertLess(time.monotonic() - start, 2 if QUICK else 0.5)

    def test_options_may_stand_anywhere(self):
        a = self.succeed("check", "--json", DOME)
        self.assertEqual(a, self.succeed("check", DOME, "--json"))
        self.assertEqual(a, self.succeed("check", "--json", "--", DOME))

    def test_answer_that_cannot_be_written_is_a_failure(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([AUXSHELL, "check", "--json", DOME], stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 1)
        self.assertIn(b"standard output", done.stderr)


class Check(CommandCase):
    def test_dome_is_deployable_and_its_figures_are_those_of_its_making(self):
        figures = json.loads(self.succeed("check", DOME, "--json"))
        self.assertEqual(figures["verdict"], "deployable")
        self.assertTrue(figures["by_inflation"] and figures["by_gravity"] and figures["height_field"])
        self.assertAlmostEqual(figures["curvature"]["median"], 0.2, 3)  # it was made with H = 0.2
        self.assertEqual(figures["curvature"]["nonpositive_share"], 0)
        self.assertAlmostEqual(figures["bounds"][1][0] - figures["bounds"][0][0], 11, 6)
        self.assertEqual(figures["repairs"]["turned_outward"], False)

    def test_hemisphere_is_refused_by_its_exact_ratio(self):
        done = run("check", HEMISPHERE, "--json")
        self.assertEqual(done.returncode, 4, done.stderr)
        figures = json.loads(done.stdout)
        self.assertEqual(figures["verdict"], "not deployable")
        self.assertAlmostEqual(figures["scale"]["ratio"], 2, 2)  # stereographic projection
        self.assertTrue(figures["scale"]["needs_cones"])
        self.assertIn("2.0", figures["words"])
        self.assertIn("--scale", figures["words"])

    def test_hemisphere_fits_the_widest_band(self):
        self.assertEqual(json.loads(self.succeed("check", HEMISPHERE, "--scale", "1,2", "--json"))["verdict"], "deployable")

    def test_saddle_is_refused_and_shown_another_way(self):
        done = run("check", SADDLE, "--nearest", self.folder / "none.obj")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("Not deployable", done.stdout)
        self.assertIn("drape", done.stdout)
        self.assertEqual(self.files(), [])

    def test_nearest_surface_is_deployable_as_it_is(self):
        nearest = self.folder / "nearest.obj"
        self.succeed("check", SURFACES / "valley_roof.obj", "--nearest", nearest)
        self.assertEqual(json.loads(self.succeed("check", nearest, "--json"))["verdict"], "deployable")

    def test_valley_is_turned_outward_and_deployable_after_projection(self):
        figures = json.loads(self.succeed("check", SURFACES / "valley_roof.obj", "--json"))
        self.assertEqual(figures["verdict"], "deployable after projection")
        self.assertTrue(figures["repairs"]["turned_outward"])
        self.assertGreater(figures["curvature"]["nonpositive_share"], 0.05)

    def test_pictures_are_drawn(self):
        self.succeed("check", DOME, "--png", self.folder / "new")
        self.assertEqual(self.files(), ["new", "new/curvature.png", "new/scale.png"])
        for name in self.files()[1:]:
            self.assertEqual((self.folder / name).read_bytes()[:8], b"\x89PNG\r\n\x1a\n")


class Size(CommandCase):
    def test_a_target_is_scaled_to_the_length_wanted(self):
        recipe, words = self.folder / "r.json", ("--size", "1200", "--units", "mm", "--triangles", "300")
        self.succeed("design", DOME, "-o", self.folder / "a.auxshell", *words)
        start = {"op": "start_target", "file": str(DOME), "unit": "mm", "size": 1200, "triangles": 300}
        recipe.write_text(json.dumps({"format": "auxshell-recipe", "version": 1, "operators": [start]}))
        self.succeed("run", recipe, "-o", self.folder / "b.auxshell")
        for name in ("a.auxshell", "b.auxshell"):
            bounds = json.loads(self.succeed("info", self.folder / name, "--json"))["report"]["deployed_bounds"]
            self.assertAlmostEqual(max(bounds) / 1200, 1, delta=0.02)
        self.refuse(2, "more than 0", "design", DOME, "-o", self.folder / "c.auxshell", "--size", "0")


class Awkward(CommandCase):
    """The zoo of awkward meshes is fed to every command that reads."""

    @classmethod
    def setUpClass(cls):
        cls.keeper = subprocess.Popen([Path(AUXSHELL).parent / "zoo_keeper"], stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, text=True)
        cls.animals = [line.rstrip("\n").split("\t") for line in cls.keeper.stdout]

    @classmethod
    def tearDownClass(cls):
        cls.keeper.stdin.close()
        cls.keeper.stdout.close()
        cls.keeper.wait()

    def test_there_are_animals(self):
        self.assertGreater(len(self.animals), 20)

    def test_commands_that_read_surfaces_say_what_is_wrong(self):
        out = ("-o", self.folder / "x.auxshell", "--triangles", "60")
        for path, expected, word in self.animals:
            for words in (("check", path), ("design", path, *out)):
                with self.subTest(words=words):
                    if expected != "0":
                        self.refuse(int(expected), word, *words, seconds=30)
                        continue
                    done = run(*words, seconds=60)
                    self.assertIn(done.returncode, (0, 1, 4), done.stderr)  # 1: its deployment reached no exact state
                    written = ["x.auxshell"] if words[0] == "design" and done.returncode < 4 else []
                    self.assertEqual(self.files(), written)
                    for name in written:
                        (self.folder / name).unlink()

    def test_commands_that_read_documents_say_that_it_is_none(self):
        for path, _, _ in self.animals:
            for words in (("info", path), ("simulate", path), ("export", path, "-o", self.folder / "x.svg")):
                with self.subTest(words=words):
                    self.refuse(3, str(path), *words, seconds=20)


def can_mount():
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", folder], capture_output=True)
        if done.returncode == 0:
            subprocess.run(["umount", folder], check=True)
        return done.returncode == 0


@contextmanager
def small_disk(size, options=""):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}{options}", "tmpfs", folder], check=True)
        try:
            yield Path(folder)
        finally:
            subprocess.run(["umount", folder], check=True)


@contextmanager
def read_only_folder(files):
    """Permissions do not hold root back, a mount does."""
    root = os.geteuid() == 0
    if root and not can_mount():
        raise unittest.SkipTest("no right to mount a read-only disk")
    with small_disk("2m") if root else tempfile.TemporaryDirectory() as folder:
        for name, content in files.items():
            Path(folder, name).write_bytes(content)
        if root:
            subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
        else:
            os.chmod(folder, 0o555)
        try:
            yield Path(folder)
        finally:
            if not root:
                os.chmod(folder, 0o755)


class Trouble(CommandCase):
    """Disks that are full, folders that are read only, and being stopped half way."""

    def setUp(self):
        super().setUp()
        self.document = self.folder / "a.auxshell"
        self.succeed("design", DOME, "-o", self.document, "--triangles", "300")

    def assert_unchanged(self, files, content):
        self.assertEqual(self.files(), files)
        self.assertEqual(self.document.read_bytes(), content)

    def writers(self):
        """Every command that writes, as words."""
        yield "design", DOME, "-o", self.document, "--triangles", "320"
        yield "simulate", self.document, "--pressure", "200"
        for ending in ("json", "obj", "stl", "ply", "glb", "svg", "png"):
            yield "export", self.document, "-o", self.folder / f"x.{ending}"
        yield "info", self.document, "--png", self.folder
        yield "check", DOME, "--png", self.folder

    def test_file_that_cannot_grow_is_an_error_and_leaves_the_old_one(self):
        content = self.document.read_bytes()
        for words in self.writers():
            with self.subTest(words=words):
                done = run(*words, preexec_fn=with_file_size_limit(2000))
                self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
                self.assertTrue(done.stderr.startswith(f"auxshell {words[0]}: "), done.stderr)
                self.assert_unchanged(["a.auxshell"], content)

    @unittest.skipUnless(can_mount(), "no right to mount a small disk")
    def test_full_disk_is_an_error_and_leaves_the_old_file(self):
        content = self.document.read_bytes()
        for words in self.writers():
            with self.subTest(words=words), small_disk("320k") as disk:
                document = disk / "a.auxshell"
                document.write_bytes(content)
                with open(disk / "ballast", "wb") as ballast:  # leaves 8 kB
                    ballast.write(bytes(320 * 1024 - (len(content) + 4095) // 4096 * 4096 - 8192 - 4096))
                moved = [str(word).replace(str(self.folder), str(disk)) for word in words]
                done = run(*moved)
                self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
                self.assertRegex(done.stderr, "space|full")
                self.assertEqual(document.read_bytes(), content)
                self.assertEqual(sorted(path.name for path in disk.iterdir()), ["a.auxshell", "ballast"])

    def test_read_only_folder_is_refused_before_long_work(self):
        with read_only_folder({"a.auxshell": self.document.read_bytes()}) as folder:
            for words in self.writers():
                with self.subTest(words=words):
                    moved = [str(word).replace(str(self.folder), str(folder)) for word in words]
                    self.refuse(2, "No file can be written", *moved, seconds=20)

    def test_interrupt_ends_with_130_and_leaves_nothing(self):
        count = "4000" if QUICK else "30000"
        for number in (signal.SIGINT, signal.SIGTERM):
            for delay in (0.5, 1.0) if QUICK else (0.1, 0.3, 1.0):  # by then it has started
                with self.subTest(signal=number, delay=delay):
                    process = subprocess.Popen([AUXSHELL, "design", DOME, "-o", self.folder / "b.auxshell",
                                                "--triangles", count], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                    wait_for_handler(process, number)
                    time.sleep(delay)
                    process.send_signal(number)
                    sent = time.monotonic()
                    _, errors = process.communicate(timeout=60)
                    self.assertEqual(process.returncode, 130, errors)
                    self.assertIn(b"Cancelled", errors)
                    self.assertLess(time.monotonic() - sent, 30 if QUICK else 3)
                    self.assertEqual(self.files(), ["a.auxshell"])

    def test_interrupted_simulation_keeps_the_document(self):
        document = self.folder / "b.auxshell"
        self.succeed("design", DOME, "-o", document, "--triangles", "4000" if QUICK else "8000")
        content = document.read_bytes()
        process = subprocess.Popen([AUXSHELL, "simulate", document, "--load", "gravity"], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        wait_for_handler(process, signal.SIGINT)
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(document.read_bytes(), content)
        self.assertEqual(self.files(), ["a.auxshell", "b.auxshell"])

    def test_killed_while_saving_leaves_the_old_or_the_new_document(self):
        words = ("design", DOME, "-o", self.document, "--triangles", "400")
        before = json.loads(self.succeed("info", self.document, "--json"))["triangles"]
        start = time.monotonic()
        self.succeed("design", DOME, "-o", self.folder / "b.auxshell", "--triangles", "400")
        duration = time.monotonic() - start
        after = json.loads(self.succeed("info", self.folder / "b.auxshell", "--json"))["triangles"]
        self.assertNotEqual(before, after)
        content, seen = self.document.read_bytes(), set()
        rounds = 6 if QUICK else 40
        for k in range(rounds):  # closer together towards the end, where it saves
            self.document.write_bytes(content)
            process = subprocess.Popen([AUXSHELL, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(duration * (1.2 - 0.7 * (k / rounds) ** 2))
            process.kill()
            process.wait()
            seen.add(json.loads(self.succeed("info", self.document, "--json"))["triangles"])
        self.assertLessEqual(seen, {before, after})

    def test_terminal_sees_progress_on_one_line(self):
        try:
            main, terminal = pty.openpty()
        except OSError as reason:
            self.skipTest(f"no pseudo terminal: {reason}")
        process = subprocess.Popen([AUXSHELL, "design", DOME, "-o", self.folder / "b.auxshell", "--triangles",
                                    "1000" if QUICK else "6000"], stdout=subprocess.DEVNULL, stderr=terminal)
        os.close(terminal)
        shown = b""
        while True:
            try:
                part = os.read(main, 4096)
            except OSError:
                break
            if not part:
                break
            shown += part
        os.close(main)
        self.assertEqual(process.wait(), 0, shown)
        self.assertGreater(shown.count(b"\r\x1b[K"), 3)
        self.assertIn(b" %", shown)
        self.assertNotIn(b"\n", shown)
        self.assertTrue(shown.endswith(b"\r\x1b[K"), shown)


if __name__ == "__main__":
    support.tap.main()
