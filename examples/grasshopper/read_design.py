"""Reads a design that `auxshell export P.auxshell -o dome.json` wrote, in a Python component of Grasshopper (Rhino 7 and 8).

Inputs, both of item access:
    path      text: the file
    state     text: "flat", "deployed" or "simulated"; deployed if empty
Outputs, in the units of the Rhino document; lists are in the order of the design, panel k beside name k and scale factor k:
    panels    closed curves, one per panel
    mesh      one mesh: vertex k is hinge k, face k is panel k
    names     "C14": as engraved on the panels and listed in the schedule
    rows      the letters of the names: rows of the lattice
    scale     lambda of each panel
    hinges    points
    supports  points: hinges that are held
    holes     closed curves round the holes
    forces    vectors, N per hinge, of a simulated design; else empty

Runs in IronPython 2.7 as well as in Python 3.
"""
import json

METRES = {"mm": 0.001, "cm": 0.01, "m": 1.0}
STATES = ("flat", "deployed", "simulated")


def parse(text):
    """The design as a dictionary; ValueError in words if it is none."""
    try:
        design = json.loads(text)
    except ValueError as error:
        raise ValueError("This is not JSON: %s" % error)
    if not isinstance(design, dict) or design.get("format") != "auxshell-design":
        raise ValueError("This is no design: export it with `auxshell export P.auxshell -o NAME.json`.")
    if design.get("version") != 1:
        raise ValueError("This design has version %s; this script reads version 1." % design.get("version"))
    return design


def places(design, state, unit_in_metres):
    """[(x, y, z), ...] of all hinges, in units of `unit_in_metres` metres; the flat state lies in z = 0."""
    state = (state or "deployed").strip().lower()
    if state not in STATES:
        raise ValueError("There is no state \"%s\": use flat, deployed or simulated." % state)
    points = design[state]
    if points is None:
        raise ValueError("The design was not simulated: run `auxshell simulate` and export it again.")
    factor = METRES[design["units"]] / unit_in_metres
    return [tuple(factor * x for x in point) + (0.0,) * (3 - len(point)) for point in points]


def panel_names(design):
    return [str(name) for name in design["report"]["panels"]]


def row_names(names):
    """ "-B" of "-B-3", "C" of "C14"."""
    return [name[:1] + name[1:].rstrip("0123456789").rstrip("-") for name in names]


def closed_curve(geometry, corners):
    line = geometry.Polyline()
    for x, y, z in list(corners) + [corners[0]]:
        line.Add(x, y, z)
    return geometry.PolylineCurve(line)


def make_mesh(geometry, points, triangles):
    mesh = geometry.Mesh()
    for x, y, z in points:
        mesh.Vertices.Add(x, y, z)
    for a, b, c in triangles:
        mesh.Faces.AddFace(a, b, c)
    mesh.Normals.ComputeNormals()
    return mesh


def build(geometry, design, state, unit_in_metres):
    """All outputs, by name; `geometry` is Rhino.Geometry."""
    points = places(design, state, unit_in_metres)
    names = panel_names(design)
    forces = (design["load"] or {}).get("forces") or []
    return {
        "panels": [closed_curve(geometry, [points[h] for h in t]) for t in design["triangles"]],
        "mesh": make_mesh(geometry, points, design["triangles"]),
        "names": names,
        "rows": row_names(names),
        "scale": list(design["scale"]),
        "hinges": [geometry.Point3d(*p) for p in points],
        "supports": [geometry.Point3d(*points[h]) for h in design["supports"]],
        "holes": [closed_curve(geometry, [points[h] for h in hole]) for hole in design["holes"]],
        "forces": [geometry.Vector3d(*f) for f in forces],
    }


def read_file(name):
    with open(name, "rb") as file:
        return file.read().decode("utf-8")


if globals().get("path"):  # within Grasshopper, whose inputs are global names
    import Rhino

    unit = Rhino.RhinoMath.UnitScale(Rhino.RhinoDoc.ActiveDoc.ModelUnitSystem, Rhino.UnitSystem.Meters)
    globals().update(build(Rhino.Geometry, parse(read_file(path)), globals().get("state"), unit))  # noqa: F821
