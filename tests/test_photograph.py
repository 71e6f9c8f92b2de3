#!/usr/bin/python3
"""Photographs show the shell, its people and its frame: drawn small, where Blender is installed. AUXSHELL names the program."""
import shutil
import subprocess
import unittest

import numpy

import support.tap
from support.command import ROOT, CommandCase
from support.png import read

SCENE = ROOT / "tools/photograph/scene.py"
DOME = ROOT / "examples/grasshopper/dome.json"


@unittest.skipUnless(shutil.which("blender"), "Blender is not installed")
class Photograph(CommandCase):
    def shoot(self, *options):
        picture = self.folder / "picture.png"
        subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", SCENE, "--", DOME, picture,
                        "--size", "160x100", "--samples", "4", *options], check=True, capture_output=True, timeout=170)
        pixels = read(picture)[..., :3].astype(float)
        self.assertEqual(pixels.shape, (100, 160, 3))
        return pixels

    def test_the_shell_is_in_the_middle_and_the_backdrop_round_it(self):
        pixels = self.shoot()
        busy = numpy.abs(numpy.diff(pixels.sum(axis=2), axis=1))
        self.assertGreater(busy[30:80, 40:120].mean(), 10)
        self.assertLess(busy[:, :4].mean(), 6)
        self.assertLess(busy[:8].mean(), 6)

    def test_materials_differ(self):
        ply, metal = self.shoot("--material", "ply"), self.shoot("--material", "metal")
        redness = [(p[..., 0] - p[..., 2])[30:80, 40:120].mean() for p in (ply, metal)]
        self.assertGreater(redness[0], redness[1] + 10)


if __name__ == "__main__":
    support.tap.main()
