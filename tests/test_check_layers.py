#!/usr/bin/python3
"""The layer check finds what it is there to find."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import support.tap

SCRIPT = Path(__file__).resolve().parent.parent / "tools/check_layers.py"
LAYERS = "# top\ncli\nhigh\nmiddle\nlow\n"
MODULES = "ax_module(low LIBRARIES m)\nax_module(middle DEPENDS low)\nax_module(high DEPENDS low LIBRARIES PkgConfig::X)\n"


class LayerCheck(unittest.TestCase):
    def check(self, files, modules=MODULES):
        """Exit code and output of the check on a tree with these files."""
        with tempfile.TemporaryDirectory() as folder:
            tree = {"src/layers.txt": LAYERS, "src/CMakeLists.txt": modules, "include/ax/base.h": "",
                    "src/low/low.h": '#include "ax/base.h"\n', "src/middle/middle.c": '#include "low/low.h"\n',
                    "src/high/high.c": "#include <math.h>\n", "cli/main.c": '#include "ax/base.h"\n', **files}
            for name, text in tree.items():
                path = Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True)
            return done.returncode, done.stdout

    def assert_fault(self, words, files, modules=MODULES):
        code, output = self.check(files, modules)
        self.assertEqual(code, 1, output)
        self.assertEqual(len(output.splitlines()), 1, output)
        self.assertIn(words, output)

    def test_sound_tree_passes(self):
        self.assertEqual(self.check({}), (0, "every include points down\n"))

    def test_include_pointing_up_is_found_with_its_line(self):
        self.assert_fault("src/low/low.c:2:", {"src/low/low.c": '\n#include "middle/middle.h"\n'})

    def test_include_pointing_down_but_not_declared_is_found(self):
        self.assert_fault("sideways", {"src/high/high.c": '#include "middle/middle.h"\n'})

    def test_angle_brackets_hide_nothing(self):
        self.assert_fault("points up", {"src/low/low.c": "#include <high/high.h>\n"})

    def test_include_without_its_module_is_found(self):
        self.assert_fault("names no module", {"src/middle/middle.c": '#include "../low/low.h"\n'})

    def test_dependency_on_a_higher_module_is_found(self):
        self.assert_fault("does not lie below", {}, "ax_module(low DEPENDS high)\nax_module(middle DEPENDS low)\n"
                          "ax_module(high DEPENDS low)\n")

    def test_module_that_is_not_declared_is_found(self):
        self.assert_fault("src/extra", {"src/extra/extra.c": ""})

    def test_command_sees_public_headers_and_its_own_files_only(self):
        self.assertEqual(self.check({"cli/commands/one.c": '#include "options.h"\n', "cli/options.h": ""})[0], 0)
        self.assert_fault("cli/main.c:1:", {"cli/main.c": '#include "low/low.h"\n'})

    def test_public_headers_see_only_each_other(self):
        self.assert_fault("include/ax/base.h:1:", {"include/ax/base.h": '#include "low/low.h"\n'})

    def test_this_project_passes(self):
        done = subprocess.run([sys.executable, SCRIPT], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    support.tap.main()
