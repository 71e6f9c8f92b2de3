#!/usr/bin/python3
"""Cut files as other programs read them: ezdxf, poppler, zip and csv. AUXSHELL names the program."""
import csv
import itertools
import json
import math
import os
import re
import subprocess
import time
import unittest
import xml.etree.ElementTree as ElementTree
import zipfile

import ezdxf

import support.tap
from support.command import SURFACES, CommandCase


def distance(a, b):
    return math.hypot(a[0] - b[0], a[1] - b[1])


class CutFiles(CommandCase):
    """One design, a small one in metres, and all of its files."""

    def setUp(self):
        super().setUp()
        self.document = self.folder / "dome.auxshell"
        self.make("kidney_dome.obj")

    def make(self, surface):
        self.succeed("design", SURFACES / surface, "-o", self.document, "--triangles", "200", "--units", "m")
        self.design = json.loads(self.export("dome.json").read_text())
        corners = [[self.design["flat"][h] for h in t] for t in self.design["triangles"]]
        self.edges = [sorted(1000 * distance(t[k], t[(k + 1) % 3]) for k in range(3)) for t in corners]

    def export(self, name, *words):
        path = self.folder / name
        self.succeed("export", self.document, "-o", path, *words)
        return path

    def read_dxf(self, path):
        drawing = ezdxf.readfile(path)
        audit = drawing.audit()
        self.assertEqual([e.message for e in audit.errors + audit.fixes], [])
        return drawing

    def test_dxf_of_bare_panels_has_their_edges(self):
        for name, version, kind in (("dome.dxf", "AC1015", "LWPOLYLINE"), ("dome.r12.dxf", "AC1009", "POLYLINE")):
            drawing = self.read_dxf(self.export(name))
            self.assertEqual(drawing.dxfversion, version)
            if version == "AC1015":
                self.assertEqual(drawing.header["$INSUNITS"], 4)
                self.assertEqual(drawing.header["$MEASUREMENT"], 1)
            cuts = [e for e in drawing.modelspace() if e.dxf.layer == "CUT"]
            self.assertEqual({e.dxftype() for e in cuts}, {kind})
            self.assertTrue(all(e.is_closed for e in cuts))
            found = []
            for e in cuts:
                points = [p[:2] for p in e.get_points()] if kind == "LWPOLYLINE" else [v.dxf.location for v in e.vertices]
                self.assertEqual(len(points), 3)
                found.append(sorted(distance(points[k], points[(k + 1) % 3]) for k in range(3)))
            self.assertEqual(len(found), len(self.edges))
            for ours, theirs in zip(sorted(self.edges), sorted(found)):
                for a, b in zip(ours, theirs):
                    self.assertAlmostEqual(a, b, delta=0.01)

    def test_dxf_of_ring_joints_counts_holes_and_outlines(self):
        words = ("--joint", "ring", "--material", "plywood-3")
        modern = self.read_dxf(self.export("dome.dxf", *words)).modelspace()
        old = self.read_dxf(self.export("dome.r12.dxf", *words)).modelspace()
        count = len(self.edges)
        for space in (modern, old):
            holes = [e for e in space if e.dxf.layer == "HOLE"]
            self.assertEqual({e.dxftype() for e in holes}, {"CIRCLE"})
            inner = sum(len(t) for t in self.design["triangles"])
            self.assertLessEqual(len(holes), inner)
            self.assertGreater(len(holes), 2 * count)
            self.assertEqual(sum(1 for e in space if e.dxf.layer == "CUT"), count)
        self.assertEqual(len({e.dxf.handle for e in modern}), len(modern))

    def test_dxf_keeps_to_its_profile(self):
        for profile in ("generic", "lightburn", "plotter"):
            drawing = self.read_dxf(self.export("dome.dxf", "--profile", profile))
            declared = {layer.dxf.name for layer in drawing.layers}
            self.assertLessEqual({e.dxf.layer for e in drawing.modelspace()}, declared)

    def pdf_pages(self, path):
        text = subprocess.run(["pdfinfo", "-f", "1", "-l", "100000", path], capture_output=True, text=True, check=True).stdout
        sizes = re.findall(r"Page +\d+ size: +([\d.]+) x ([\d.]+)", text)
        return [tuple(float(x) * 25.4 / 72 for x in size) for size in sizes]

    def test_pdf_has_a_page_of_true_size_for_every_sheet(self):
        self.make("spherical_cap.obj")
        one = self.pdf_pages(self.export("dome.pdf"))
        drawing = self.read_dxf(self.export("dome.dxf"))
        self.assertEqual(len(one), 1)
        for a, b in zip(one[0], drawing.header["$EXTMAX"]):
            self.assertAlmostEqual(a, b, delta=2e-6 * b)  # pdfinfo prints six digits
        sheets = self.pdf_pages(self.export("sheets.pdf", "--sheet", "900x600"))
        self.assertGreater(len(sheets), 2)
        for size in sheets[1:]:
            self.assertAlmostEqual(size[0], 900, delta=0.01)
            self.assertAlmostEqual(size[1], 600, delta=0.01)

    def test_pages_that_not_all_programs_show_are_refused(self):
        said = self.refuse(4, "5080 mm", "export", self.document, "-o", self.folder / "dome.pdf", "-o", self.folder / "dome.svg")
        self.assertIn(".a4.pdf", said.stderr)
        self.export("dome.pdf", "--sheet", "5000x5000")

    def pdf_lines(self, path, page=1):
        """The stroked paths of a page, by colour, as lists of points in mm: what poppler draws."""
        exact = ("-svg", "-nocenter", "-noshrink", "-f", str(page), "-l", str(page))
        subprocess.run(["pdftocairo", *exact, path, self.folder / "page.svg"], check=True)
        found = {}
        for e in ElementTree.parse(self.folder / "page.svg").getroot().iter("{http://www.w3.org/2000/svg}path"):
            colour = re.search(r"stroke:rgb\(([^)]*)\)", e.attrib.get("style", ""))
            if not colour:
                continue
            rgb = tuple(round(2.55 * float(n.strip("%"))) for n in colour[1].split(","))
            a, b, c, d, x, y = (float(n) for n in re.findall(r"[-\d.e]+", e.attrib.get("transform", "1 0 0 1 0 0").strip("matrix")))
            for path_text in re.findall(r"M[^M]*", e.attrib["d"]):
                n = [float(t) for t in re.findall(r"[-\d.e]+", path_text)]
                points = [(25.4 / 72 * (a * u + c * v + x), 25.4 / 72 * (b * u + d * v + y)) for u, v in zip(n[::2], n[1::2])]
                if len(points) > 1:  # cairo begins anew where it has closed
                    found.setdefault(rgb, []).append((points, "Z" in path_text))
        return found

    def test_pdf_of_bare_panels_has_their_edges(self):
        self.make("spherical_cap.obj")
        cuts = self.pdf_lines(self.export("dome.pdf"))[255, 0, 0]
        self.assertTrue(all(closed for _, closed in cuts))
        self.assertEqual(len(cuts), len(self.edges))
        found = []
        for points, _ in cuts:
            points = [p for k, p in enumerate(points) if k == 0 or distance(p, points[k - 1]) > 0.1]
            self.assertEqual(len(points), 3)
            found.append(sorted(distance(points[k], points[(k + 1) % 3]) for k in range(3)))
        for ours, theirs in zip(sorted(self.edges), sorted(found)):
            for a, b in zip(ours, theirs):
                self.assertAlmostEqual(a, b, delta=0.01)

    def test_pdf_of_ring_joints_has_the_lines_of_the_drawing(self):
        words = ("--joint", "ring", "--material", "plywood-3", "--sheet", "3000x2000", "--profile", "lightburn")
        pages = self.pdf_pages(self.export("dome.pdf", *words))
        self.export("dome.dxf", *words)
        for number in range(1, len(pages)):
            lines = self.pdf_lines(self.folder / "dome.pdf", number + 1)
            space = self.read_dxf(self.folder / f"dome-{number}.dxf").modelspace()
            holes, cuts = lines[0, 224, 0], lines[255, 0, 0]
            self.assertEqual(len(cuts), sum(1 for e in space if e.dxf.layer.endswith("CUT")))
            circles = [(e.dxf.center.x, e.dxf.center.y, e.dxf.radius) for e in space if e.dxf.layer.endswith("HOLE")]
            self.assertEqual(len(holes), len(circles))
            boxes = []
            for points, _ in holes:
                xs, ys = [p[0] for p in points], [2000 - p[1] for p in points]
                boxes.append(((min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2, (max(xs) - min(xs)) / 2))
            for x, y, r in circles:
                box = min(boxes, key=lambda other: distance((x, y), other))
                for ours, theirs in zip((x, y, r), box):
                    self.assertAlmostEqual(ours, theirs, delta=0.01)

    def test_title_of_a_pdf_is_the_documents_name(self):
        self.make("spherical_cap.obj")
        other = self.document.with_name("Kuppel ä).auxshell")
        self.document.rename(other)
        self.document = other
        text = subprocess.run(["pdfinfo", self.export("dome.pdf")], capture_output=True, text=True, check=True).stdout
        self.assertIn("Kuppel ä)", text)

    def dxf_sheets(self, *words):
        """What ezdxf reads of all sheets: per sheet its size and, by layer, its lines: whether they are closed, and their vertices with bulges."""
        main = self.export("dome.dxf", *words)
        paths = sorted(self.folder.glob("dome-*.dxf")) or [main]
        for path in paths:
            drawing, lines = self.read_dxf(path), {}
            for e in drawing.modelspace():
                if e.dxftype() == "CIRCLE":
                    x, y, r = e.dxf.center.x, e.dxf.center.y, e.dxf.radius
                    line = (True, [(x - r, y, 1), (x + r, y, 1)])
                else:
                    line = (e.is_closed, e.get_points("xyb"))
                lines.setdefault(e.dxf.layer, []).append(line)
            yield tuple(drawing.header["$EXTMAX"][:2]), lines

    def svg_sheets(self, *words):
        """The same from SVG, y turned up."""
        name, number = "{http://www.w3.org/2000/svg}", r"-?[\d.]+"
        main = self.export("dome.svg", *words)
        for path in sorted(self.folder.glob("dome-*.svg")) or [main]:
            root, lines = ElementTree.parse(path).getroot(), {}
            width, height = (float(root.attrib[k].removesuffix("mm")) for k in ("width", "height"))
            for layer in root.findall(f"{name}g"):
                for text in (t for item in layer.findall(f"{name}path") for t in re.findall("M[^M]*", item.attrib["d"])):
                    points = []
                    for command, words_ in re.findall(r"([MLA])([^MLAZ]*)", text):
                        n = [float(x) for x in re.findall(number, words_)]
                        at = (n[-2], height - n[-1])
                        if command == "A":
                            chord = distance(points[-1], at)
                            quarter = math.asin(min(1, chord / 2 / n[0])) / 2
                            points[-1] = (*points[-1][:2], math.tan(quarter) * (-1 if n[4] else 1))
                        points.append((*at, 0))
                    closed = text.rstrip().endswith("Z")
                    if closed and distance(points[0], points[-1]) < 1e-9:
                        points.pop()  # an arc leads back
                    lines.setdefault(layer.attrib["id"], []).append((closed, points))
            yield (width, height), lines

    @staticmethod
    def arc(a, b):
        """Centre, radius, angle of the start and sweep of the arc from vertex a to b."""
        chord, sweep = distance(a, b), 4 * math.atan(a[2])
        height = chord / 2 / math.tan(sweep / 2) if abs(abs(a[2]) - 1) > 1e-9 else 0
        x, y = (a[0] + b[0]) / 2 - height * (b[1] - a[1]) / chord, (a[1] + b[1]) / 2 + height * (b[0] - a[0]) / chord
        return (x, y), distance((x, y), a), math.atan2(a[1] - y, a[0] - x), sweep

    def flatten(self, closed, points):
        """A line as points, closed ones with the first one again."""
        out = []
        for a, b in zip(points, points[1:] + points[:1]):
            out.append(a[:2])
            if a[2] and (closed or b is not points[0]):
                centre, r, start, sweep = self.arc(a, b)
                steps = math.ceil(abs(sweep) / 0.1)
                out += [(centre[0] + r * math.cos(start + sweep * k / steps), centre[1] + r * math.sin(start + sweep * k / steps))
                        for k in range(1, steps)]
        return out + out[:1] if closed else out

    def sheets_of(self, *words, reader=None):
        """Of all sheets: size and, by layer, closed outlines and open lines as points, and circles."""
        for size, all_lines in (reader or self.dxf_sheets)(*words):
            lines, circles = {}, {}
            for layer, several in all_lines.items():
                for closed, points in several:
                    if closed and len(points) == 2 and all(abs(abs(p[2]) - 1) < 1e-4 for p in points):
                        a, b = points
                        circles.setdefault(layer, []).append(((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, distance(a, b) / 2))
                    else:
                        lines.setdefault(layer, []).append((self.flatten(closed, points), closed))
            yield size, lines, circles

    def assert_clean(self, size, lines, circles):
        """Everything lies within the sheet; no two cuts coincide or cross."""
        segments, cells = [], {}
        for layer, all_lines in lines.items():
            for points, _ in all_lines:
                self.assertTrue(all(-1e-6 <= p[0] <= size[0] + 1e-6 and -1e-6 <= p[1] <= size[1] + 1e-6 for p in points))
                if layer in ("SLIT", "CUT"):
                    segments += [(a, b) for a, b in zip(points, points[1:]) if distance(a, b) > 1e-9]
        for x, y, r in circles.get("HOLE", []):
            self.assertTrue(r <= x <= size[0] - r and r <= y <= size[1] - r)
            ring = [(x + r * math.cos(k * math.pi / 6), y + r * math.sin(k * math.pi / 6)) for k in range(13)]
            segments += list(zip(ring, ring[1:]))
        cell = 20
        for i, (a, b) in enumerate(segments):
            for u in range(int(min(a[0], b[0]) // cell), int(max(a[0], b[0]) // cell) + 1):
                for v in range(int(min(a[1], b[1]) // cell), int(max(a[1], b[1]) // cell) + 1):
                    cells.setdefault((u, v), []).append(i)

        def side(a, b, c):
            return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        for near in cells.values():
            for n, i in enumerate(near):
                (a, b) = segments[i]
                for k in near[:n]:
                    (c, d) = segments[k]
                    same = min(distance(a, c) + distance(b, d), distance(a, d) + distance(b, c))
                    self.assertGreater(same, 1e-3, (a, b))
                    deep = 1e-6 * distance(a, b) * distance(c, d)
                    crossing = side(a, b, c) * side(a, b, d) < -deep**2 and side(c, d, a) * side(c, d, b) < -deep**2
                    self.assertFalse(crossing, (a, b, c, d))

    def assert_edges(self, found):
        self.assertEqual(len(found), len(self.edges))
        for ours, theirs in zip(sorted(self.edges), sorted(sorted(edges) for edges in found)):
            for a, b in zip(ours, theirs):
                self.assertAlmostEqual(a, b, delta=0.01)

    def test_sheets_are_clean_and_panels_hinge_at_the_linkages_edges(self):
        """The kerf cut away and the holes hinged again, from what is in the file."""
        def within(point, outline):
            inside = False
            for a, b in zip(outline, outline[1:]):
                if (a[1] > point[1]) != (b[1] > point[1]) and \
                        point[0] < a[0] + (point[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1]):
                    inside = not inside
            return inside

        def middle_lines(p):  # unit bisectors of a triangle's corners, outward
            out = []
            for k in range(3):
                u = [sum((p[k][c] - p[o][c]) / distance(p[k], p[o]) for o in range(3) if o != k) for c in (0, 1)]
                out.append([x / math.hypot(*u) for x in u])
            return out
        for (joint, reach), reader in itertools.product((("pin", 0), ("ring:ring=16,hole=4", 16 / 2 + 4 / 2)), (self.dxf_sheets, self.svg_sheets)):
            found, holes = [], 0
            for size, lines, circles in self.sheets_of("--joint", joint, "--material", "plywood-3", "--sheet", "3000x2000", "--kerf", "0.3", reader=reader):
                self.assert_clean(size, lines, circles)
                for outline, closed in lines["CUT"]:
                    self.assertTrue(closed)
                    own = [c for c in circles["HOLE"] if within(c, outline)]
                    holes += len(own)
                    self.assertTrue(all(abs(2 * c[2] + 0.3 - 4) < 1e-3 or joint == "pin" for c in own))
                    if len(own) < 3:  # on the rim nothing is joined
                        continue
                    p = [c[:2] for c in own]
                    for _ in range(50):  # from the holes back to the hinges, along the bisectors that these make
                        p = [[c[k] + reach * b[k] for k in (0, 1)] for c, b in zip(own, middle_lines(p))]
                    found.append([distance(p[k], p[(k + 1) % 3]) for k in range(3)])
            held = [h for t in self.design["triangles"] for h in t]
            self.assertEqual(holes, len(held))
            self.assert_edges(found)

    def test_bare_panels_have_their_edges_when_the_kerf_is_cut_away(self):
        kerf = 0.4
        for reader in (self.dxf_sheets, self.svg_sheets):
            found = []
            for size, lines, circles in self.sheets_of("--sheet", "3000x2000", "--kerf", kerf, reader=reader):
                self.assert_clean(size, lines, circles)
                for outline, _ in lines["CUT"]:
                    p = outline[:3]
                    area = abs(sum(p[k][0] * p[(k + 1) % 3][1] - p[(k + 1) % 3][0] * p[k][1] for k in range(3))) / 2
                    edges = [distance(p[k], p[(k + 1) % 3]) for k in range(3)]
                    inscribed = 2 * area / sum(edges)  # offset inward, a triangle is the same one, smaller
                    found.append([e * (inscribed - kerf / 2) / inscribed for e in edges])
            self.assert_edges(found)

    def ligaments(self, lines, ligament, kerf):
        """Their middles: two openings meet there in arcs about one centre, between which the beam leaves the ligament."""
        arcs, found = {}, []
        for closed, points in lines["SLIT"] + lines["CUT"]:
            self.assertTrue(closed)
            for a, b in zip(points, points[1:] + points[:1]):
                if a[2]:
                    centre, r, start, sweep = self.arc(a, b)
                    arcs.setdefault((round(centre[0]), round(centre[1])), []).append((centre, r, start + sweep / 2))
        for (x, y), here in arcs.items():
            near = [arc for i in (-1, 0, 1) for j in (-1, 0, 1) for arc in arcs.get((x + i, y + j), [])]
            for centre, r, middle in here:
                for other, r2, _ in near:
                    if abs(r2 - r - ligament - kerf) < 0.01 and distance(centre, other) < 0.01:
                        out = (r + r2) / 2
                        found.append((centre[0] + out * math.cos(middle), centre[1] + out * math.sin(middle)))
        return found

    def test_ligaments_hinge_at_the_linkages_edges(self):
        """The middles of ligaments, from what is in the file, are as far from each other as the hinges of the linkage."""
        ligament, kerf = 3, 0.2
        words = ("--joint", f"living-hinge:ligament={ligament}", "--material", "polypropylene-0.8", "--kerf", kerf)
        held = [h for t in self.design["triangles"] for h in t]
        for reader in (self.dxf_sheets, self.svg_sheets):
            (size, lines), = reader(*words)  # one sheet: the flat state, moved
            found = self.ligaments(lines, ligament, kerf)
            joined = {h: [1000 * x for x in self.design["flat"][h]] for h in held if held.count(h) == 2}
            self.assertEqual(len(found), len(joined))
            shift = [min(p[k] for p in found) - min(p[k] for p in joined.values()) for k in (0, 1)]
            place, panels = {}, 0
            for h, p in joined.items():
                place[h] = min(found, key=lambda q: distance(q, (p[0] + shift[0], p[1] + shift[1])))
            self.assertEqual(len(set(place.values())), len(found))
            for triangle, edges in zip(self.design["triangles"], self.edges):
                if all(h in place for h in triangle):
                    panels += 1
                    p = [place[h] for h in triangle]
                    for a, b in zip(edges, sorted(distance(p[k], p[(k + 1) % 3]) for k in range(3))):
                        self.assertAlmostEqual(a, b, delta=0.01)
            self.assertGreater(panels, len(self.edges) / 2)

    def test_sheets_of_living_hinges_are_clean(self):
        for reader in (self.dxf_sheets, self.svg_sheets):
            for size, lines, circles in self.sheets_of("--joint", "living-hinge", "--material", "polypropylene-0.8", "--sheet", "3000x2000", reader=reader):
                self.assert_clean(size, lines, circles)
                self.assertTrue(all(closed for _, closed in lines["CUT"]))

    def test_svg_counts_and_measures_what_the_drawing_does(self):
        words = ("--joint", "ring", "--material", "plywood-3", "--sheet", "3000x2000")
        sheets = list(self.sheets_of(*words))
        self.export("dome.svg", *words)
        name = "{http://www.w3.org/2000/svg}"
        for number, (size, lines, circles) in enumerate(sheets, 1):
            path = self.folder / f"dome-{number}.svg"
            root = ElementTree.parse(path).getroot()
            self.assertEqual((root.attrib["width"], root.attrib["height"]), ("3000mm", "2000mm"))
            layers = {g.attrib["id"]: g.findall(f"{name}path") for g in root.findall(f"{name}g")}
            self.assertEqual(len(layers["CUT"]), len(lines["CUT"]))
            self.assertEqual(len(layers["HOLE"]), len(circles["HOLE"]))
            strokes = sum(p.attrib["d"].count("M") for p in layers["LABEL"])
            self.assertEqual(strokes, len(lines["LABEL"]))
            # as librsvg draws it
            drawn = self.folder / "drawn.pdf"
            subprocess.run(["rsvg-convert", "-f", "pdf", "-o", drawn, path], check=True)
            self.assertEqual([round(x) for x in self.pdf_pages(drawn)[0]], [3000, 2000])
            red = self.pdf_lines(drawn)[255, 0, 0]
            self.assertEqual(len(red), len(lines["CUT"]) + len(circles["HOLE"]))
            boxes = []
            for points, closed in red:
                self.assertTrue(closed)
                xs, ys = [p[0] for p in points], [2000 - p[1] for p in points]
                boxes.append(((min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2, (max(xs) - min(xs)) / 2))
            for x, y, r in circles["HOLE"]:
                box = min(boxes, key=lambda other: distance((x, y), other) + abs(r - other[2]))
                for ours, theirs in zip((x, y, r), box):
                    self.assertAlmostEqual(ours, theirs, delta=0.01)

    def test_what_is_written_is_said_and_the_overview_is_no_sheet(self):
        before = set(self.files())
        out = self.folder / "c.r12.dxf"
        words = self.succeed("export", self.document, "-o", out, "--sheet", "2000x2000")
        first, last, overview = re.search(r"Wrote (\S+) to (\S+), and (\S+), an overview that is not to be cut", words).groups()
        sheets = int(re.search(r"-(\d+)\.r12\.dxf$", last)[1])
        self.assertEqual((first, overview), (str(self.folder / "c-1.r12.dxf"), str(out)))
        self.assertEqual(set(self.files()) - before, {"c.r12.dxf", *(f"c-{k}.r12.dxf" for k in range(1, sheets + 1))})
        for path in (first, last):
            self.assertTrue(self.read_dxf(path).modelspace().query('*[layer=="CUT"]'), path)
        self.assertIn(f"Wrote {self.folder / 'c.pdf'}\n", self.succeed("export", self.document, "-o", self.folder / "c.pdf", "--sheet", "2000x2000"))

    def test_sheets_bear_the_day_of_the_recipe(self):
        """That of the last step, of a finished design that of the file; never the day of export."""
        self.make("spherical_cap.obj")
        def day(*words):
            text = subprocess.run(["pdfinfo", "-isodates", self.export("dated.pdf", *words)], capture_output=True, text=True, check=True)
            found = re.search(r"CreationDate: +([\d-]+)", text.stdout)
            return found and found[1]
        os.utime(self.document, (86400 * 365.2425 * 30, 86400 * 365.2425 * 30))
        self.assertEqual(day(), "2000-01-01")
        self.assertEqual(day("--date", "2024-02-29"), "2024-02-29")
        self.assertIsNone(day("--date", "none"))
        with_note, without = (self.export("dome.svg", "--date", word).read_text() for word in ("2024-02-29", "none"))
        self.assertGreater(len(re.search(r'id="note" d="([^"]*)"', with_note)[1]), len(re.search(r'id="note" d="([^"]*)"', without)[1]))
        self.document = self.folder / "sheet.auxshell"
        recipe = self.folder / "sheet.json"
        recipe.write_text(json.dumps({"format": "auxshell-recipe", "version": 1, "operators": [{"op": "start_circle", "radius": 1, "triangles": 100, "scale": 1.2}]}))
        self.succeed("run", recipe, "-o", self.document)
        moments = json.loads(self.succeed("history", self.document, "--json"))["moments"]
        os.utime(self.document, (0, 0))
        self.assertEqual(day(), time.strftime("%Y-%m-%d", time.gmtime(moments[-1]["time"])))
        self.refuse(2, "--date", "export", self.document, "-o", self.folder / "dated.pdf", "--date", "yesterday")

    def test_tiles_cover_the_sheet(self):
        self.make("spherical_cap.obj")
        tiles = self.pdf_pages(self.export("dome.a4.pdf"))
        width, height = self.pdf_pages(self.export("dome.pdf"))[0]
        self.assertEqual({tuple(round(x) for x in size) for size in tiles}, {(210, 297)})
        self.assertEqual(len(tiles), math.ceil(width / 180) * math.ceil(height / 267))

    def test_files_are_the_same_bytes_again(self):
        self.make("spherical_cap.obj")
        for name in ("dome.dxf", "dome.r12.dxf", "dome.pdf", "dome.csv", "dome.3mf"):
            first = self.export(name).read_bytes()
            self.assertEqual(first, self.export(name).read_bytes(), name)

    def test_schedule_lists_everything_once(self):
        text = self.export("dome.csv", "--joint", "ring", "--material", "plywood-3").read_bytes().decode()
        tables = [list(csv.DictReader(part.splitlines())) for part in text.split("\r\n\r\n")]
        panels, hinges, sizes, parts, totals = tables
        self.assertEqual(len(panels), len(self.edges))
        self.assertEqual(len({row["panel"] for row in panels}), len(panels))
        for row, edges in zip(panels, self.edges):
            listed = sorted(float(row[f"edge {k} mm"]) for k in range(3))
            for a, b in zip(listed, edges):
                self.assertAlmostEqual(a, b, delta=0.01)
        held = [h for t in self.design["triangles"] for h in t]
        self.assertEqual(len(hinges), sum(1 for h in set(held) if held.count(h) == 2))
        total = {row["total"]: float(row["value"]) for row in totals}
        self.assertEqual(total["panels"], len(panels))
        self.assertAlmostEqual(total["mass"] * 1000, sum(float(row["mass g"]) for row in panels), delta=1)
        self.assertEqual(total["sizes"], len(sizes))
        self.assertEqual([int(row["panels"]) for row in sizes],
                         [sum(1 for p in panels if p["size"] == row["size"]) for row in sizes])
        self.assertTrue(parts and all(int(row["count"]) > 0 for row in parts))

    def test_sizes_are_as_close_as_said(self):
        for count in (1, 5, 40):
            text = self.export("dome.csv", "--clusters", count).read_bytes().decode()
            panels, _, sizes, _, totals = [list(csv.DictReader(part.splitlines())) for part in text.split("\r\n\r\n")]
            total = {row["total"]: float(row["value"]) for row in totals}
            self.assertLessEqual(len(sizes), count)
            worst = 0
            for row in panels:
                size = sizes[int(row["size"]) - 1]
                ours, theirs = ([float(r[f"edge {k} mm"]) for k in range(3)] for r in (row, size))
                error = min(max(abs(ours[(k + turn) % 3] - theirs[k]) for k in range(3)) for turn in range(3))
                self.assertLessEqual(error, float(size["error mm"]) + 0.002)
                worst = max(worst, error)
            self.assertAlmostEqual(worst, total["sizes: largest edge error"], delta=0.002)
            # panels are equilateral, but for a ten thousandth at the rim: equal intervals would do as well
            means = [sum(edges) / 3 for edges in self.edges]
            self.assertLessEqual(worst, (max(means) - min(means)) / 2 / count + 2e-4 * max(means))
        within = self.export("dome.csv").read_bytes().decode()
        self.assertLessEqual(float(re.search(r"largest edge error,([\d.]+)", within)[1]), 0.1001)

    def test_gaps_of_fewer_sizes_are_as_said(self):
        """Every panel of the schedule's size, laid on the deployed panel by best fit: what corners at a hinge miss each other by."""
        def add(p, q, factor=1):
            return [a + factor * b for a, b in zip(p, q)]

        def dot(p, q):
            return sum(a * b for a, b in zip(p, q))
        corner_of = {h: [] for t in self.design["triangles"] for h in t}
        text = self.export("dome.csv", "--clusters", 12).read_bytes().decode()
        panels, _, sizes, _, totals = [list(csv.DictReader(part.splitlines())) for part in text.split("\r\n\r\n")]
        for row, triangle in zip(panels, self.design["triangles"]):
            p = [[1000 * x for x in self.design["deployed"][h]] for h in triangle]
            size = sizes[int(row["size"]) - 1]
            own, edges = ([float(r[f"edge {k} mm"]) for k in range(3)] for r in (row, size))
            turn = min(range(3), key=lambda n: max(abs(own[k] - edges[(k + n) % 3]) for k in range(3)))
            a, b, c = (edges[(k + turn) % 3] for k in range(3))  # opposite corners 0, 1, 2
            x = (b * b + c * c - a * a) / (2 * c)
            flat = [(0, 0), (c, 0), (x, math.sqrt(b * b - x * x))]
            middle = [sum(q[k] for q in flat) / 3 for k in (0, 1)]
            flat = [(q[0] - middle[0], q[1] - middle[1]) for q in flat]
            centre = [sum(q[k] for q in p) / 3 for k in range(3)]
            u = add(p[1], p[0], -1)
            u = [k / math.sqrt(dot(u, u)) for k in u]
            v = add(p[2], p[0], -1)
            v = add(v, u, -dot(u, v))
            v = [k / math.sqrt(dot(v, v)) for k in v]
            here = [(dot(add(q, centre, -1), u), dot(add(q, centre, -1), v)) for q in p]
            angle = math.atan2(sum(f[0] * h[1] - f[1] * h[0] for f, h in zip(flat, here)), sum(dot(f, h) for f, h in zip(flat, here)))
            for h, f in zip(triangle, flat):
                s, t = math.cos(angle) * f[0] - math.sin(angle) * f[1], math.sin(angle) * f[0] + math.cos(angle) * f[1]
                corner_of[h].append(add(add(centre, u, s), v, t))
        gaps = [math.dist(*two) for two in corner_of.values() if len(two) == 2]
        total = {row["total"]: float(row["value"]) for row in totals}
        self.assertGreater(max(gaps), 1)
        self.assertAlmostEqual(total["sizes: largest gap at a hinge"], max(gaps), delta=0.01)

    def test_3mf_holds_closed_prisms(self):
        with zipfile.ZipFile(self.export("dome.3mf", "--material", "plywood-3")) as archive:
            self.assertIsNone(archive.testzip())
            model = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
        space = {"m": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}
        self.assertEqual(model.attrib["unit"], "millimeter")
        objects = model.findall("m:resources/m:object", space)
        self.assertEqual(len(objects), len(self.edges))
        self.assertEqual(len(model.findall("m:build/m:item", space)), len(objects))
        for body in objects[::37]:
            points = [[float(v.attrib[c]) for c in "xyz"] for v in body.findall(".//m:vertex", space)]
            sides, volume = {}, 0
            for t in body.findall(".//m:triangle", space):
                v = [int(t.attrib[f"v{k}"]) for k in (1, 2, 3)]
                for k in range(3):
                    sides[(v[k], v[(k + 1) % 3])] = sides.get((v[k], v[(k + 1) % 3]), 0) + 1
                (a, b, c), (d, e, f), (g, h, i) = (points[n] for n in v)
                volume += (a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)) / 6
            self.assertTrue(all(n == 1 and (b, a) in sides for (a, b), n in sides.items()))
            p = points[:3]
            u, w = ([p[k][c] - p[0][c] for c in range(3)] for k in (1, 2))
            cross = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]]
            self.assertAlmostEqual(volume, 3 * math.hypot(*cross) / 2, delta=1e-3 * volume)


if __name__ == "__main__":
    support.tap.main()
