#!/usr/bin/python3
"""What is installed is enough for a program and a script of one's own. AUXSHELL names the program whose build is installed."""
import csv
import io
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import support.tap
from support.command import AUXSHELL, ROOT, SURFACES, CommandCase

BUILD = Path(AUXSHELL).resolve().parent.parent
EXAMPLES = ROOT / "examples/library"


class Library(CommandCase):
    def do(self, *words, code=0, **options):
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=120, **options)
        self.assertEqual(done.returncode, code, f"{words}\n{done.stdout}{done.stderr}")
        return done.stdout

    def install(self):
        """The prefix, moved after it was installed, and the environment in which it is found."""
        self.do("cmake", "--install", BUILD, "--prefix", self.folder / "first")
        prefix = (self.folder / "first").rename(self.folder / "second")
        config = next(prefix.rglob("auxshell.pc"))
        return prefix, {**os.environ, "PKG_CONFIG_PATH": str(config.parent), "PATH": f"{prefix / 'bin'}:{os.environ['PATH']}"}

    def check_shape(self, program, environment):
        made = self.folder / "shape.obj"
        words = self.do(program, SURFACES / "kidney_dome.obj", made, env=environment)
        off, opening = re.search(r"edges off by (\S+), holes open to (\S+) %, settled", words).groups()
        self.assertLess(float(off), 1e-3)
        self.assertGreater(float(opening), 99)
        extents = []
        for path in (made, SURFACES / "kidney_dome.obj"):
            places = [[float(x) for x in line.split()[1:4]] for line in path.read_text().splitlines() if line.startswith("v ")]
            extents.append([max(axis) - min(axis) for axis in zip(*places)])
        for shape, surface in zip(*extents):  # the surface comes back: its height is what 600 panels tell least surely
            self.assertAlmostEqual(shape, surface, delta=0.005 * max(extents[1]))

    def test_a_program_is_built_by_pkg_config_and_by_cmake(self):
        prefix, environment = self.install()
        flags = self.do("pkg-config", "--cflags", "--libs", "auxshell", env=environment).split()
        self.do("gcc", "-std=c17", "-Wall", "-Wextra", "-Werror", EXAMPLES / "shape.c", "-o", self.folder / "shape", *flags)
        self.check_shape(self.folder / "shape", environment)
        self.do("cmake", "-S", EXAMPLES, "-B", self.folder / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
        self.do("cmake", "--build", self.folder / "build")
        self.check_shape(self.folder / "build/shape", environment)

    def test_headers_stand_alone_in_c_and_cpp(self):
        for header in sorted((ROOT / "include/ax").glob("*.h")):
            include = f"#include <ax/{header.name}>\n"
            for language, text in (("c", include), ("c++", f'extern "C" {{\n{include}}}\n')):
                with self.subTest(header=header.name, language=language):
                    self.do("gcc", "-x", language, "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I", ROOT / "include", "-", input=text)

    def test_the_command_takes_its_examples_along(self):
        prefix, _ = self.install()
        shutil.copy(SURFACES / "kidney_dome.obj", self.folder)
        command = prefix / "bin/auxshell"
        self.do(command, "design", "kidney_dome.obj", "-o", "dome.auxshell", "--triangles", "80", cwd=self.folder)
        (prefix / "share/auxshell/examples/gallery/bounds.json").unlink()
        done = subprocess.run([command, "gallery", "--quick"], capture_output=True, text=True)
        self.assertIn(str(prefix), done.stderr)

    def test_the_script_sweeps_and_passes_refusals_on(self):
        environment = {**os.environ, "AUXSHELL": AUXSHELL}
        rows = list(csv.DictReader(io.StringIO(self.do(sys.executable, EXAMPLES / "sweep.py", SURFACES / "kidney_dome.obj", env=environment))))
        self.assertEqual([row["load"] for row in rows], 3 * ["inflation"] + 3 * ["gravity"])
        self.assertTrue(all(float(row["simulated_rms_over_L"]) < 0.1 for row in rows))
        self.do(sys.executable, EXAMPLES / "sweep.py", SURFACES / "saddle.obj", env=environment, code=4)


if __name__ == "__main__":
    support.tap.main()
