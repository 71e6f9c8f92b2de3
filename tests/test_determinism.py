#!/usr/bin/python3
"""The same design, to the last bit, from every build and every run."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import support.tap

ROOT = Path(__file__).resolve().parent.parent
BUILDS = ["release", "release", "debug", "clang"]  # AUXSHELL is the first of them
SURFACES = ROOT / "examples/surfaces"


def make(build, folder, *options):
    """The exported design of one build, without the times it took."""
    program = ROOT / "build" / build / "bin/auxshell"
    document, exported = Path(folder, "d.auxshell"), Path(folder, "d.json")
    threads = dict(os.environ, OPENBLAS_NUM_THREADS="2", OMP_NUM_THREADS="2") if build == "clang" else None
    subprocess.run([program, "design", *options, "-o", document], check=True, capture_output=True, env=threads)
    subprocess.run([program, "export", document, "-o", exported], check=True, capture_output=True)
    design = json.loads(exported.read_text())
    design["report"] = {key: value for key, value in design["report"].items() if not key.startswith("seconds_")}
    return design


class Determinism(unittest.TestCase):
    def assert_same_everywhere(self, *options):
        designs = []
        for build in BUILDS:
            with tempfile.TemporaryDirectory() as folder:
                designs.append(make(build, folder, *options))
        for build, design in zip(BUILDS[1:], designs[1:]):
            for key, value in designs[0].items():
                self.assertEqual(value, design[key], f"{key} of the {build} build")

    def test_by_inflation(self):
        self.assert_same_everywhere(SURFACES / "kidney_dome.obj", "--triangles", "600")

    def test_by_gravity_after_projection(self):
        self.assert_same_everywhere(SURFACES / "valley_roof.obj", "--triangles", "300", "--project", "--load", "gravity")


if __name__ == "__main__":
    support.tap.main()
