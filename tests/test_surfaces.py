#!/usr/bin/python3
"""The example surfaces are what tools/make_surfaces.c makes today."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import support.tap

SURFACES = Path(__file__).resolve().parent.parent / "examples/surfaces"
PROGRAM = Path(os.environ["AUXSHELL"]).parent / "make_surfaces"


class Surfaces(unittest.TestCase):
    def test_are_made_again_byte_for_byte(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PROGRAM, folder], check=True)
            made = sorted(path.name for path in Path(folder).iterdir())
            self.assertEqual(made, sorted(path.name for path in SURFACES.iterdir()))
            for name in made:
                self.assertEqual(Path(folder, name).read_bytes(), (SURFACES / name).read_bytes(), name)

    def test_are_small(self):
        for path in SURFACES.iterdir():
            self.assertLess(path.stat().st_size, 500_000, path.name)


if __name__ == "__main__":
    support.tap.main()
