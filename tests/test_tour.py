#!/usr/bin/python3
"""What the README says to type works, in its order. AUXSHELL names the program."""
import re
import shlex
import shutil
import unittest

import support.tap
from support.command import QUICK, ROOT, CommandCase, run

REFUSED = {"check examples/surfaces/saddle.obj": 4}  # as the README says


class Tour(CommandCase):
    @unittest.skipIf(QUICK, "every command has tests of its own")
    def test_commands_of_the_readme(self):
        text = (ROOT / "README.md").read_text()
        (self.folder / "examples").symlink_to(ROOT / "examples")
        shutil.copy(ROOT / "examples/surfaces/kidney_dome.obj", self.folder / "dome.obj")  # the reader's own mesh
        (self.folder / "bowl.json").write_text(re.search(r'^    \{\n      "format".*?\n    \}\n', text, re.M | re.S)[0])
        commands = [line for line in re.findall(r"^    \./run (.*)$", text, re.M) if not line.startswith(("studio", "gallery"))]
        self.assertGreater(len(commands), 15)
        for line in commands:
            with self.subTest(command=line):
                done = run(*shlex.split(line), cwd=self.folder)
                self.assertEqual(done.returncode, REFUSED.get(line, 0), done.stdout + done.stderr)


if __name__ == "__main__":
    support.tap.main()
