#!/usr/bin/python3
"""Shade and room as users meet them: shade, space. AUXSHELL names the program."""
import json
import re
import unittest

import support.tap
from support.command import CommandCase

BOWL = [
    {"op": "start_circle", "radius": 2, "triangles": 150, "scale": 1.2},
    {"op": "paint", "points": [[0, 0]], "radius": 1.8, "value": 1.5},
    {"op": "rim_circle", "radius": 2.2},
    {"op": "gravity", "adopt": True},
    {"op": "finish"},
]
NOON = ("--sun", "180,65")


class Shade(CommandCase):
    def design(self, name, operators):
        recipe = self.folder / f"{name}.json"
        recipe.write_text(json.dumps({"format": "auxshell-recipe", "version": 1, "operators": operators}))
        self.succeed("run", recipe, "-o", self.folder / f"{name}.auxshell")
        return self.folder / f"{name}.auxshell"

    def shade(self, *words):
        return json.loads(self.succeed("shade", *words, "--json"))

    def test_layers_add_and_are_arranged(self):
        bowl = self.design("bowl", BOWL)
        wish = ("--want", "0,1.2,0.8,0.5")
        one = self.shade(bowl, *NOON, *wish)
        same = self.shade(bowl, bowl, *NOON, *wish)
        two = self.shade(bowl, f"{bowl}:turn=20,x=0.1", *NOON, *wish)
        self.assertAlmostEqual(same["wishes"][0]["opacity"], one["wishes"][0]["opacity"], 6)
        self.assertGreater(two["wishes"][0]["opacity"], one["wishes"][0]["opacity"] + 0.05)
        found = self.shade(bowl, bowl, *NOON, *wish, "--arrange", "--png", self.folder / "map.png")
        self.assertLess(found["missed"], abs(one["wishes"][0]["opacity"] - 0.5))
        self.assertTrue((self.folder / "map.png").read_bytes().startswith(b"\x89PNG"))
        again = self.shade(*found["layers"], *NOON, *wish)
        self.assertAlmostEqual(again["wishes"][0]["opacity"], found["wishes"][0]["opacity"], 2)

    def test_a_day(self):
        bowl = self.design("bowl", BOWL)
        place = ("--place", "47.38,8.54", "--zone", 2)
        day = self.shade(bowl, *place, "--date", "2026-06-21")
        noon = self.shade(bowl, *place, "--date", "2026-06-21", "--hours", "13.4,13.4")
        self.assertEqual(noon["directions"], 1)
        self.assertTrue(30 <= day["directions"] <= 34, day["directions"])  # 16 of 24 hours in steps of half an hour
        self.assertTrue(0.05 < day["opacity"] < 0.5)
        self.refuse(4, "does not rise", "shade", bowl, "--place", "85,0", "--date", "2026-12-21")

    def test_a_small_shell_stands_near_its_shadow(self):
        height = {}
        for radius in (0.2, 20):  # a model, and a roof
            scaled = [dict(BOWL[0], radius=radius), dict(BOWL[1], radius=0.9 * radius),
                      {"op": "rim_circle", "radius": 1.1 * radius}, {"op": "gravity", "adopt": True}]
            shell = self.design(f"bowl-{radius}", scaled)
            words = self.succeed("shade", shell, *NOON, "--want", f"0,0,{radius / 2},0.3")
            height[radius] = float(re.search(r"at height (\S+),", words).group(1)) / radius
            opacity = float(re.search(r"disc 1 +([0-9.]+)", words).group(1))
            self.assertGreater(opacity, 0.05, words)
        self.assertLess(height[0.2], -1.1 * 2 / 3)
        self.assertGreater(height[20], height[0.2] + 0.4)  # 2.5 m under a roof of 44 m

    def test_what_is_wrong_is_named(self):
        bowl = self.design("bowl", BOWL)
        self.refuse(2, "--place and --date, or --sun", "shade", bowl)
        self.refuse(2, "not by \"w=3\"", "shade", f"{bowl}:w=3", *NOON)
        self.refuse(2, "--want takes", "shade", bowl, *NOON, "--want", "0,0,1")
        self.refuse(2, "give --want", "shade", bowl, *NOON, "--arrange")
        self.refuse(2, "--date takes", "shade", bowl, "--place", "0,0", "--date", "2026-13-01")
        self.refuse(2, "--date takes", "shade", bowl, "--place", "0,0", "--date", "2026-02-30")
        self.refuse(2, "far off", "shade", bowl, *NOON, "--want", "9999,0,1,0.5")
        self.refuse(3, "none", "shade", self.folder / "none.auxshell", *NOON)

    def test_room_under_a_dome(self):
        dome = self.design("dome", [*BOWL[:3], {"op": "inflation", "adopt": True}, BOWL[4]])
        room = json.loads(self.succeed("space", dome, "--headroom", "0.5", "--json"))
        self.assertTrue(0.8 * 3.14 * 2.2 ** 2 < room["floor"] < 3.15 * 2.2 ** 2)
        self.assertTrue(0 < room["headroom_area"] < room["floor"] < room["surface"])
        self.assertIn("% of the floor", self.succeed("space", dome))
        self.refuse(3, "covers nothing", "space", self.design("bowl", BOWL))


if __name__ == "__main__":
    support.tap.main()
