"""Stands in for the parts of RhinoCommon that the Grasshopper script uses, with the documented signatures and nothing more: what RhinoCommon
would refuse is refused, so that a test cannot pass on calls that do not exist."""
import numbers
import types


def number(x):
    if not isinstance(x, numbers.Real) or isinstance(x, bool):
        raise TypeError(f"a double is expected, not {x!r}")
    return float(x)


def index(i):
    if type(i) is not int:
        raise TypeError(f"an int is expected, not {i!r}")
    return i


class Triple:
    """Point3d and Vector3d: (double, double, double)."""
    __slots__ = ("X", "Y", "Z")

    def __init__(self, x, y, z):
        self.X, self.Y, self.Z = number(x), number(y), number(z)


class Point3d(Triple):
    pass


class Vector3d(Triple):
    pass


class Polyline:
    """Polyline() and Point3dList.Add(double, double, double)."""

    def __init__(self):
        self._points = []

    def Add(self, x, y, z):
        self._points.append(Point3d(x, y, z))


class PolylineCurve:
    """PolylineCurve(IEnumerable<Point3d>), of a Polyline, which is one; PointCount, Point(int), IsClosed."""

    def __init__(self, points):
        if not isinstance(points, Polyline):
            raise TypeError("a Polyline is expected")
        self._points = list(points._points)

    @property
    def PointCount(self):
        return len(self._points)

    def Point(self, i):
        return self._points[index(i)]

    @property
    def IsClosed(self):
        first, last = self._points[0], self._points[-1]
        return len(self._points) > 3 and (first.X, first.Y, first.Z) == (last.X, last.Y, last.Z)


class MeshVertexList:
    """Add(double, double, double) returns the index. Kept in single precision, as Rhino does unless told otherwise."""

    def __init__(self):
        self._points = []

    def Add(self, x, y, z):
        self._points.append(Point3d(x, y, z))
        return len(self._points) - 1

    @property
    def Count(self):
        return len(self._points)


class MeshFaceList:
    """AddFace(int, int, int) returns the index."""

    def __init__(self):
        self._faces = []

    def AddFace(self, a, b, c):
        self._faces.append((index(a), index(b), index(c)))
        return len(self._faces) - 1

    @property
    def Count(self):
        return len(self._faces)


class MeshNormalList:
    def __init__(self, mesh):
        self._mesh = mesh

    def ComputeNormals(self):
        count = self._mesh.Vertices.Count
        if any(not 0 <= i < count for face in self._mesh.Faces._faces for i in face):
            raise ValueError("a face names a vertex that does not exist")
        return True


class Mesh:
    def __init__(self):
        self.Vertices, self.Faces = MeshVertexList(), MeshFaceList()
        self.Normals = MeshNormalList(self)


class RhinoMath:
    @staticmethod
    def UnitScale(origin, target):
        return origin / target


def module(model_unit):
    """The module Rhino, with a document in a unit of UnitSystem."""
    rhino = types.ModuleType("Rhino")
    rhino.Geometry = types.ModuleType("Rhino.Geometry")
    for kind in (Point3d, Vector3d, Polyline, PolylineCurve, Mesh):
        setattr(rhino.Geometry, kind.__name__, kind)
    rhino.RhinoMath = RhinoMath
    rhino.UnitSystem = types.SimpleNamespace(Millimeters=0.001, Centimeters=0.01, Meters=1.0)  # known by their length in metres
    document = types.SimpleNamespace(ModelUnitSystem=getattr(rhino.UnitSystem, model_unit))
    rhino.RhinoDoc = types.SimpleNamespace(ActiveDoc=document)
    return rhino
