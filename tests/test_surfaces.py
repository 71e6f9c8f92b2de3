#!/usr/bin/python3
"""The example surfaces and the room are what tools/make_surfaces.c and make_room.c make today."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import support.tap

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
MADE = {"make_surfaces": EXAMPLES / "surfaces", "make_room": EXAMPLES / "room"}


class Surfaces(unittest.TestCase):
    def test_are_made_again_byte_for_byte(self):
        for program, committed in MADE.items():
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run([Path(os.environ["AUXSHELL"]).parent / program, folder], check=True)
                made = sorted(path.name for path in Path(folder).iterdir())
                self.assertEqual(made, sorted(path.name for path in committed.iterdir()))
                for name in made:
                    self.assertEqual(Path(folder, name).read_bytes(), (committed / name).read_bytes(), name)

    def test_are_small(self):
        for folder in MADE.values():
            for path in folder.iterdir():
                self.assertLess(path.stat().st_size, 500_000, path.name)


if __name__ == "__main__":
    support.tap.main()
