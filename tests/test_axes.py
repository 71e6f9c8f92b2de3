#!/usr/bin/python3
"""Which axis of a file points up, and in which unit it is drawn. AUXSHELL names the program."""
import base64
import json
import struct
import unittest

import support.tap
from support.command import CommandCase

SIDE = 12
CORNERS = [(4 * i / SIDE - 2, 4 * j / SIDE - 2) for i in range(SIDE + 1) for j in range(SIDE + 1)]
DOME = [(x, 1.5 - 0.18 * (x * x + z * z), z) for x, z in CORNERS]  # y points up
FACES = [face for i in range(SIDE) for j in range(SIDE) for a in [i * (SIDE + 1) + j]
         for face in [(a, a + SIDE + 1, a + 1), (a + 1, a + SIDE + 1, a + SIDE + 2)]]


def upright(x):
    return x[0], -x[2], x[1]


def obj(vertices):
    return "".join("v %r %r %r\n" % x for x in vertices) + "".join("f %d %d %d\n" % tuple(v + 1 for v in f) for f in FACES)


def gltf(vertices):
    places, corners = (b"".join(struct.pack(form, *row) for row in rows) for form, rows in (("<3f", vertices), ("<3I", FACES)))
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": len(places)},
             {"buffer": 0, "byteOffset": len(places), "byteLength": len(corners)}]
    accessors = [{"bufferView": 0, "componentType": 5126, "count": len(vertices), "type": "VEC3",
                  "min": [min(c) for c in zip(*vertices)], "max": [max(c) for c in zip(*vertices)]},
                 {"bufferView": 1, "componentType": 5125, "count": 3 * len(FACES), "type": "SCALAR"}]
    data = "data:application/octet-stream;base64," + base64.b64encode(places + corners).decode()
    return json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                       "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                       "buffers": [{"byteLength": len(places + corners), "uri": data}],
                       "bufferViews": views, "accessors": accessors})


def collada(up, vertices):
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><up_axis>{up}</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="{3 * len(vertices)}">
{" ".join("%r %r %r" % x for x in vertices)}</float_array><technique_common><accessor source="#a" count="{len(vertices)}" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="{len(FACES)}">
<input semantic="VERTEX" source="#v" offset="0"/><p>{" ".join("%d %d %d" % f for f in FACES)}</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


class Axes(CommandCase):
    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def stands(self, path, *words):
        figures = json.loads(self.succeed("check", path, "--json", *words))
        lo, hi = figures["bounds"]
        if figures["height_field"]:
            for got, wanted in zip((*lo, *hi), (-2, -2, 0.06, 2, 2, 1.5)):
                self.assertAlmostEqual(got, wanted, 5)
        self.assertEqual(figures["by_gravity"], figures["height_field"])
        self.assertEqual(figures["lies_on_side"], not figures["height_field"])
        return figures["height_field"]

    def test_files_stand_as_their_format_says(self):
        self.assertTrue(self.stands(self.write("z.obj", obj(map(upright, DOME)))))
        self.assertTrue(self.stands(self.write("y.gltf", gltf(DOME))))
        self.assertTrue(self.stands(self.write("y.dae", collada("Y_UP", DOME))))
        self.assertTrue(self.stands(self.write("z.dae", collada("Z_UP", list(map(upright, DOME))))))

    def test_what_is_given_counts(self):
        lying = self.write("y.obj", obj(DOME))
        self.assertFalse(self.stands(lying))
        self.assertTrue(self.stands(lying, "--up", "y"))
        self.assertTrue(self.stands(self.write("z.gltf", gltf(list(map(upright, DOME)))), "--up", "z"))
        self.assertTrue(self.stands(self.write("wrong.dae", collada("Y_UP", list(map(upright, DOME)))), "--up", "z"))
        self.refuse(2, "file, y or z", "check", lying, "--up", "x")

    def test_a_surface_on_its_side_is_told_so(self):
        lying = self.write("y.obj", obj(DOME))
        self.assertIn("--up y", " ".join(self.succeed("check", lying).split()))
        few = ("--triangles", "100", "--load", "gravity")
        self.refuse(4, "--up y", "design", lying, "-o", self.folder / "a.auxshell", *few)
        self.assertIn("Every limit holds", self.succeed("design", lying, "-o", self.folder / "a.auxshell", *few, "--up", "y"))
        wall = self.write("wall.obj", obj([(z, x, y) for x, y, z in DOME]))  # along x: no file has that up
        self.assertNotIn("--up", self.succeed("check", wall))

    def test_recipes_stand_files_up_too(self):
        self.write("y.obj", obj(DOME))
        surface = {"op": "start_target", "file": "y.obj", "triangles": 100, "border": "released"}
        heights = {}
        for up in ("file", "y"):
            recipe = {"format": "auxshell-recipe", "version": 1, "operators": [dict(surface, up=up)]}
            self.succeed("run", self.write("r.json", json.dumps(recipe)), "-o", self.folder / f"{up}.auxshell")
            out = self.folder / f"{up}.json"
            self.succeed("export", self.folder / f"{up}.auxshell", "-o", out)
            deployed = json.loads(out.read_text())["deployed"]
            heights[up] = max(x[2] for x in deployed) - min(x[2] for x in deployed)
        self.assertGreater(heights["file"], 3)
        self.assertLess(heights["y"], 1.6)

    def test_an_unlikely_size_is_questioned(self):
        millimetres = self.write("mm.obj", obj([tuple(1000 * c for c in upright(x)) for x in DOME]))
        out = ("-o", self.folder / "a.auxshell", "--triangles", "100")
        self.assertIn("give --units mm", self.succeed("design", millimetres, *out))
        self.assertNotIn("--units", self.succeed("design", millimetres, *out, "--units", "mm"))
        self.assertNotIn("--units", self.succeed("design", self.write("m.obj", obj(map(upright, DOME))), *out))


if __name__ == "__main__":
    support.tap.main()
