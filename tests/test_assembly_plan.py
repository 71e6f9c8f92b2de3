#!/usr/bin/python3
"""The assembly plan and the frame's templates as other programs read them: poppler and ezdxf. AUXSHELL names the program."""
import json
import math
import re
import subprocess
import unittest

import ezdxf

import support.tap
from support.command import SURFACES, CommandCase


def read_pages(path):
    """The text of every page, its words in reading order."""
    text = subprocess.run(["pdftotext", "-layout", path, "-"], capture_output=True, text=True, check=True).stdout
    return text.split("\f")[:-1]


def page_sizes(path):
    text = subprocess.run(["pdfinfo", "-f", "1", "-l", "100000", path], capture_output=True, text=True, check=True).stdout
    return [tuple(round(float(x) * 25.4 / 72, 1) for x in size) for size in re.findall(r"Page +\d+ size: +([\d.]+) x ([\d.]+)", text)]


class AssemblyPlan(CommandCase):
    """One design, a small one in metres."""

    def setUp(self):
        super().setUp()
        self.document = self.folder / "dome.auxshell"
        self.succeed("design", SURFACES / "spherical_cap.obj", "-o", self.document, "--triangles", "200", "--units", "m")
        self.design = json.loads(self.export("dome.json").read_text())
        held = [h for t in self.design["triangles"] for h in t]
        self.inner = sum(1 for h in set(held) if held.count(h) == 2)

    def export(self, name, *words):
        path = self.folder / name
        self.succeed("export", self.document, "-o", path, *words)
        return path

    def places(self):
        """Of the supports, mm."""
        return [tuple(1000 * x for x in self.design["deployed"][h]) for h in self.design["supports"]]

    def page(self, pages, heading):
        found = [p for p in pages if p.lstrip().startswith(heading)]
        self.assertTrue(found, heading)
        return "".join(found)

    def test_every_page_is_a3_and_every_panel_is_named(self):
        path = self.export("dome.plan.pdf", "--joint", "ring", "--material", "plywood-3")
        self.assertEqual(set(page_sizes(path)), {(420.0, 297.0)})
        pages = read_pages(path)
        names = set(self.design["report"]["panels"])
        for heading in ("Flat layout", "Order of joining, step by step"):
            words = set(self.page(pages, heading).split())
            self.assertEqual(names - words, set(), heading)
        above = set(self.page(pages, "Deployed, from above").split())
        self.assertGreater(len(names & above), 0.9 * len(names))  # names where they fit
        for heading in ("Deployed, from the front", "Deployed, from the right", "Deployed, axonometric", "Frame 1: a circle"):
            self.page(pages, heading)
        title = " ".join(pages[0].split())
        self.assertIn(f"Panels {len(names)} ", title)
        self.assertIn(f"Hinges {self.inner} between panels", title)
        self.assertIn(f"Supports {len(self.design['supports'])} ", title)

    def test_steps_add_up(self):
        pages = read_pages(self.export("dome.plan.pdf"))
        rows = re.findall(r"^ *(\d+) +(\S+) to (\S+) +\S+ +(left|right) +(\S+) +(\d+) +(\d+) +(\d+) +(\d+) *$", self.page(pages, "Order of joining\n"), re.M)
        self.assertEqual([int(row[0]) for row in rows], list(range(1, len(rows) + 1)))
        joined = 0
        for row in rows:
            joined += int(row[5])
            self.assertEqual(int(row[8]), joined)
        self.assertEqual(joined, len(self.design["triangles"]))
        self.assertEqual(sum(int(row[6]) + int(row[7]) for row in rows), self.inner)
        self.assertTrue(all(int(row[7]) > 0 for row in rows[1:]))
        drawn = re.findall(r"Step (\d+)", self.page(pages, "Order of joining, step by step"))
        self.assertEqual([int(k) for k in drawn], list(range(1, len(rows) + 1)))

    def test_supports_are_listed_with_their_places_and_chords(self):
        table = self.page(read_pages(self.export("dome.plan.pdf")), "Frame: supports")
        rows = re.findall(r"S(\d+) +\S+ +(-?[\d.]+) +(-?[\d.]+) +(-?[\d.]+) +([\d.]+) +([\d.]+) +(\d+)", table)
        places = self.places()
        self.assertEqual(len(rows), len(places))
        listed = [tuple(float(x) for x in row[1:4]) for row in rows]
        for place in places:
            self.assertLess(min(math.dist(place, p) for p in listed), 0.1)
        for k, row in enumerate(rows):
            self.assertAlmostEqual(math.dist(listed[k], listed[(k + 1) % len(rows)]), float(row[4]), delta=0.2)
        radius = [float(x) for x in re.findall(r"circle of radius ([\d.]+) mm", read_pages(self.export("again.plan.pdf"))[0])]
        self.assertEqual(len(radius), 1)
        for place in places:
            self.assertAlmostEqual(math.hypot(*place[:2]), radius[0], delta=1e-3 * radius[0])

    def test_one_piece_has_nothing_to_join_and_pieces_have_seams(self):
        whole = self.export("whole.plan.pdf", "--joint", "living-hinge", "--material", "polypropylene-0.8")
        self.assertIn("nothing to join", self.page(read_pages(whole), "Order of joining"))
        pieces = self.export("pieces.plan.pdf", "--joint", "living-hinge", "--material", "polypropylene-0.8", "--sheet", "900x600")
        text = self.page(read_pages(pieces), "Order of joining, step by step")
        closed = [int(n) for n in re.findall(r"close (\d+) numbered seams", text)]
        self.assertEqual(closed[0], 0)
        self.assertIn(f"{sum(closed)} hinges to close", " ".join(read_pages(pieces)[0].split()))

    def test_frame_template_has_the_distances_of_the_supports(self):
        drawing = ezdxf.readfile(self.export("dome.frame.dxf"))
        audit = drawing.audit()
        self.assertEqual([e.message for e in audit.errors + audit.fixes], [])
        self.assertEqual(drawing.header["$INSUNITS"], 4)
        curves = [e for e in drawing.modelspace() if e.dxf.layer == "CUT"]
        self.assertEqual(len(curves), 1)
        self.assertTrue(curves[0].is_closed)
        corners = curves[0].get_points("xyb")
        places = self.places()
        self.assertEqual(len(corners), len(places))
        # all distances between supports, whatever the order and the position on the sheet
        ours = sorted(math.dist(a, b) for a in places for b in places)
        theirs = sorted(math.dist(a[:2], b[:2]) for a in corners for b in corners)
        for a, b in zip(ours, theirs):
            self.assertAlmostEqual(a, b, delta=0.01)
        # arcs of one circle: chord = 2 r sin(2 atan(bulge))
        radii = [math.dist(p[:2], q[:2]) / 2 / abs(math.sin(2 * math.atan(p[2]))) for p, q in zip(corners, corners[1:] + corners[:1])]
        self.assertLess(max(radii) - min(radii), 0.01)

    def test_frame_template_is_tiled_on_a3_where_there_is_something(self):
        path = self.export("dome.frame.pdf")
        sizes = page_sizes(path)
        self.assertEqual(set(sizes), {(420.0, 297.0)})
        drawing = ezdxf.readfile(self.export("dome.frame.dxf"))
        width, height = drawing.header["$EXTMAX"][:2]
        self.assertLess(len(sizes), math.ceil(width / 390) * math.ceil(height / 267))
        length = sum(math.dist(a[:2], b[:2]) for e in drawing.modelspace() if e.dxf.layer == "CUT"
                     for a, b in zip(e.get_points(), list(e.get_points())[1:]))
        self.assertGreater(len(sizes), length / math.hypot(390, 267))

    def test_the_same_bytes_again(self):
        for name in ("dome.plan.pdf", "dome.frame.pdf", "dome.frame.dxf"):
            first = self.export(name).read_bytes()
            self.assertEqual(first, self.export(name).read_bytes(), name)

    def test_what_cannot_be_drawn_is_refused(self):
        self.refuse(2, "coupon", "coupon", "kerf", "-o", self.folder / "kerf.plan.pdf")
        self.refuse(2, "flat", "export", self.document, "-o", self.folder / "x.frame.dxf", "--state", "flat")

    def test_panels_that_collide_are_listed_and_red(self):
        thick = ("--joint", "none:inset=3", "--material", "plywood-3:thickness=60")
        path = self.export("dome.plan.pdf", *thick)
        found = json.loads(self.succeed("fabricate", self.document, "--json", *thick))
        self.assertGreater(found["clashes_found"], 0)
        page = self.page(read_pages(path), "Collisions")
        for clash in found["clashes"]:
            row = rf"\b{clash['a']} +{clash['b']} .*{100 * clash['opening']:.0f} % of the way to open +{clash['overlap']:.2f}"
            self.assertTrue(clash["frame"] < 3 or re.search(row, page), row)
        colliding = {c[side] for c in found["clashes"] for side in "ab"}
        subprocess.run(["pdftocairo", "-svg", "-f", "2", "-l", "2", path, self.folder / "layout.svg"], check=True)
        red = re.findall(r"fill:rgb\((?:9\d|8\d)[\d.]*%,(?:5\d|4\d)[\d.]*%[^>]* d=\"([^\"]*)\"", (self.folder / "layout.svg").read_text())
        self.assertEqual(sum(d.count("Z") for d in red), len(colliding))
        self.assertNotIn("Collisions", "".join(read_pages(self.export("thin.plan.pdf", *thick[:2]))))


if __name__ == "__main__":
    support.tap.main()
