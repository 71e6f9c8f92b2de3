"""Renders a state of a design as a photograph of the built shell. Runs inside Blender:

    blender --background --factory-startup --python scene.py -- DESIGN.json PICTURE [options]

DESIGN.json is what `auxshell export P.auxshell -o DESIGN.json` writes, PICTURE ends in .png or .jpg; photograph.sh starts it so. Panels get a thickness, cut corners and the grain of the one
sheet they are cut from; hinges become pins, supports a frame along the rim. Path-traced by Cycles on the processor.
"""
import argparse
import json
import math
import random
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

METRES = {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": 0.0254, "ft": 0.3048}


def arguments():
    parser = argparse.ArgumentParser(usage="tools/photograph.sh P.auxshell -o PICTURE [options]")
    parser.add_argument("design", help=argparse.SUPPRESS)
    parser.add_argument("picture", help=argparse.SUPPRESS)
    parser.add_argument("--state", choices=["flat", "deployed", "simulated"], default="simulated")
    parser.add_argument("--material", choices=["fabric", "ply", "metal", "translucent"], default="ply")
    parser.add_argument("--size", default="1280x800", help="pixels, WxH")
    parser.add_argument("--samples", type=int, default=96, help="light paths per pixel")
    parser.add_argument("--azimuth", type=float, default=-60, help="degrees from x, where the camera stands")
    parser.add_argument("--elevation", type=float, default=17, help="degrees above the horizon")
    parser.add_argument("--lens", type=float, default=50, help="focal length in mm on a 36 mm frame")
    parser.add_argument("--sun", default="-125,52", help="azimuth,elevation of the sun in degrees")
    parser.add_argument("--lift", type=float, default=0, help="metres of air under the lowest hinge; the frame stands on posts")
    parser.add_argument("--posts", type=int, default=0, help="posts under the first design's frame: one where it is highest, the others far apart")
    parser.add_argument("--people", type=int, default=0, help="figures of 1.72 m for scale")
    parser.add_argument("--balloon", action="store_true", help="what blows the shell up: a skin beneath it")
    parser.add_argument("--layers", nargs="*", default=[], help="more documents, drawn in the same place")
    parser.add_argument("--reference", nargs="*", default=[], help="OBJ files of what stands there, in the design's unit")
    parser.add_argument("--threads", type=int, default=0)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


# ---------------------------------------------------------------- materials

def shader(name, build):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(build(nodes, links).outputs[0], output.inputs["Surface"])
    return material


def principled(nodes, colour, roughness, metallic=0.0):
    node = nodes.new("ShaderNodeBsdfPrincipled")
    node.inputs["Base Color"].default_value = (*colour, 1)
    node.inputs["Roughness"].default_value = roughness
    node.inputs["Metallic"].default_value = metallic
    return node


def plain(name, colour, roughness, metallic=0.0):
    return shader(name, lambda nodes, links: principled(nodes, colour, roughness, metallic))


def ramp(nodes, links, factor, low, high):
    node = nodes.new("ShaderNodeMixRGB")
    links.new(factor, node.inputs[0])
    node.inputs[1].default_value = (*low, 1)
    node.inputs[2].default_value = (*high, 1)
    return node.outputs[0]


def ply(nodes, links):
    """Birch: fibres along the sheet's x, and each panel a little lighter or darker than the next."""
    place = nodes.new("ShaderNodeUVMap")
    stretch = nodes.new("ShaderNodeMapping")
    stretch.inputs["Scale"].default_value = (1.2, 26, 1)
    links.new(place.outputs[0], stretch.inputs[0])
    fibre = nodes.new("ShaderNodeTexNoise")
    fibre.inputs["Scale"].default_value = 3
    fibre.inputs["Detail"].default_value = 6
    links.new(stretch.outputs[0], fibre.inputs["Vector"])
    tone = nodes.new("ShaderNodeAttribute")
    tone.attribute_name = "tone"
    shade = nodes.new("ShaderNodeMath")
    shade.operation = "MULTIPLY_ADD"
    links.new(tone.outputs["Fac"], shade.inputs[0])
    shade.inputs[1].default_value = 0.35
    links.new(fibre.outputs["Fac"], shade.inputs[2])
    node = principled(nodes, (0.6, 0.4, 0.2), 0.48)
    links.new(ramp(nodes, links, shade.outputs[0], (0.72, 0.49, 0.27), (0.50, 0.29, 0.125)), node.inputs["Base Color"])
    return node


def blend(nodes, links, share, first, second):
    """`share` of the second, the rest of the first."""
    node = nodes.new("ShaderNodeMixShader")
    node.inputs[0].default_value = share
    links.new(first.outputs[0], node.inputs[1])
    links.new(second.outputs[0], node.inputs[2])
    return node


def tinted(nodes, kind, colour):
    node = nodes.new(kind)
    node.inputs[0].default_value = (*colour, 1)
    return node


def fabric(nodes, links):
    through = tinted(nodes, "ShaderNodeBsdfTranslucent", (0.9, 0.83, 0.70))
    return blend(nodes, links, 0.28, principled(nodes, (0.86, 0.83, 0.77), 0.9), through)


def translucent(nodes, links):
    through = tinted(nodes, "ShaderNodeBsdfTranslucent", (0.80, 0.92, 0.95))
    clear = tinted(nodes, "ShaderNodeBsdfTransparent", (0.86, 0.95, 0.97))
    skin = blend(nodes, links, 0.55, principled(nodes, (0.72, 0.83, 0.86), 0.18), through)
    return blend(nodes, links, 0.35, skin, clear)


def metal(nodes, links):
    tone = nodes.new("ShaderNodeAttribute")
    tone.attribute_name = "tone"
    node = principled(nodes, (0.8, 0.8, 0.8), 0.27, 1.0)
    links.new(ramp(nodes, links, tone.outputs["Fac"], (0.86, 0.84, 0.80), (0.70, 0.69, 0.67)), node.inputs["Base Color"])
    return node


# thickness, gap beside a panel and pin radius, as parts of the mean edge
KINDS = {
    "ply": dict(build=ply, thickness=0.055, inset=0.025, pin=0.05),
    "fabric": dict(build=fabric, thickness=0.012, inset=0.03, pin=0.06),
    "metal": dict(build=metal, thickness=0.02, inset=0.02, pin=0.045),
    "translucent": dict(build=translucent, thickness=0.03, inset=0.025, pin=0.045),
}


# ---------------------------------------------------------------- the shell

class Shell:
    def __init__(self, path, state):
        with open(path, encoding="utf-8") as file:
            design = json.load(file)
        self.metres = scale = METRES.get(design["units"], 1.0)
        points = design.get(state) or design["deployed"]
        self.points = [Vector((*p, 0.0)[:3]) * scale for p in points]
        self.flat = [Vector((*p[:2], 0.0)) * scale for p in design["flat"]]
        self.triangles = design["triangles"]
        self.holes = design["holes"]
        self.openings = design["openings"]
        self.supports = design["supports"] if state != "flat" else []
        lengths = [(self.flat[t[k]] - self.flat[t[k - 1]]).length for t in self.triangles for k in range(3)]
        self.edge = sum(lengths) / len(lengths)

    def normal(self, triangle):
        a, b, c = (self.points[i] for i in triangle)
        return (b - a).cross(c - a).normalized()

    def rim(self):
        """The supports in the order of the boundary, as closed or open chains."""
        held = set(self.supports)
        beside = {}
        for opening in self.openings:
            ends = [opening[0], opening[-1]]
            if ends[0] in held and ends[1] in held:
                beside.setdefault(ends[0], []).append(ends[1])
                beside.setdefault(ends[1], []).append(ends[0])
        chains, seen = [], set()
        starts = sorted(beside, key=lambda i: (len(beside[i]), i))
        for start in starts:
            if start in seen:
                continue
            chain = [start]
            seen.add(start)
            while True:
                onward = [i for i in beside[chain[-1]] if i not in seen]
                if not onward:
                    break
                chain.append(onward[0])
                seen.add(onward[0])
            closed = len(chain) > 2 and chain[0] in beside[chain[-1]]
            chains.append(([self.points[i] for i in chain], closed))
        return chains


def shrink(corners, inset, cut):
    """A triangle drawn in by `inset`, its corners cut off at `cut` from the hinge: six corners, as barycentric coordinates."""
    out = []
    for k in range(3):
        here, ahead, behind = corners[k], corners[(k + 1) % 3], corners[k - 1]
        to_ahead, to_behind = (ahead - here).normalized(), (behind - here).normalized()
        half = to_ahead.angle(to_behind) / 2
        apex = here + (to_ahead + to_behind).normalized() * (inset / max(math.sin(half), 0.2))
        reach = min(cut, 0.3 * (ahead - here).length, 0.3 * (behind - here).length)
        out += [apex + to_behind * reach, apex + to_ahead * reach]
    return out


def add_mesh(name, vertices, faces, material, uvs=None, tones=None):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    if uvs:
        layer = mesh.uv_layers.new(name="sheet")
        for loop in mesh.loops:
            layer.data[loop.index].uv = uvs[loop.vertex_index]
    if tones:
        attribute = mesh.attributes.new("tone", "FLOAT", "POINT")
        attribute.data.foreach_set("value", tones)
    mesh.materials.append(material)
    item = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(item)
    return item


def add_panels(shell, kind, material):
    chance = random.Random(1)
    vertices, faces, uvs, tones = [], [], [], []
    thickness, inset = kind["thickness"] * shell.edge, kind["inset"] * shell.edge
    for triangle in shell.triangles:
        outline = shrink([shell.points[i] for i in triangle], inset, 0.05 * shell.edge)
        sheet = shrink([shell.flat[i] for i in triangle], inset, 0.05 * shell.edge)
        up = shell.normal(triangle) * (thickness / 2)
        first, n, tone = len(vertices), len(outline), chance.random()
        for side in (-1, 1):
            vertices += [p + side * up for p in outline]
            uvs += [(p.x / shell.edge / 4, p.y / shell.edge / 4) for p in sheet]
            tones += [tone] * n
        faces.append([first + k for k in reversed(range(n))])
        faces.append([first + n + k for k in range(n)])
        faces += [[first + k, first + (k + 1) % n, first + n + (k + 1) % n, first + n + k] for k in range(n)]
    return add_mesh("panels", vertices, faces, material, uvs, tones)


def add_pins(shell, kind, material):
    """A pin through the two panels of each hinge, along their mean normal."""
    around = {}
    for triangle in shell.triangles:
        for i in triangle:
            around.setdefault(i, []).append(shell.normal(triangle))
    radius, half, sides = kind["pin"] * shell.edge, (0.6 * kind["thickness"] + 0.012) * shell.edge, 12
    vertices, faces = [], []
    for i, normals in around.items():
        axis = sum(normals, Vector())
        axis = axis.normalized() if axis.length > 1e-9 else normals[0]
        turn = Vector((0, 0, 1)).rotation_difference(axis).to_matrix()
        first = len(vertices)
        for z in (-half, half):
            for k in range(sides):
                angle = 2 * math.pi * k / sides
                vertices.append(shell.points[i] + turn @ Vector((radius * math.cos(angle), radius * math.sin(angle), z)))
        faces.append([first + k for k in reversed(range(sides))])
        faces.append([first + sides + k for k in range(sides)])
        faces += [[first + k, first + (k + 1) % sides, first + sides + (k + 1) % sides, first + sides + k] for k in range(sides)]
    return add_mesh("pins", vertices, faces, material)


def add_balloon(shell, depth, material):
    """A smooth skin just beneath the panels, which bulges a little into the holes."""
    vertices = list(shell.points)
    normals = [Vector() for _ in vertices]
    for triangle in shell.triangles:
        for i in triangle:
            normals[i] += shell.normal(triangle)
    faces = [list(f) for f in shell.triangles + shell.holes + shell.openings]
    down = [p - n.normalized() * depth for p, n in zip(vertices, normals)]
    item = add_mesh("balloon", down, faces, material)
    item.modifiers.new("smooth", "SUBSURF").render_levels = 2
    for polygon in item.data.polygons:
        polygon.use_smooth = True


def add_tube(points, radius, closed, material, smooth=True):
    curve = bpy.data.curves.new("tube", "CURVE")
    curve.dimensions = "3D"
    curve.bevel_depth = radius
    curve.bevel_resolution = 4
    curve.use_fill_caps = True
    spline = curve.splines.new("BEZIER" if smooth and len(points) > 2 else "POLY")
    if spline.type == "BEZIER":
        spline.bezier_points.add(len(points) - 1)
        for knot, point in zip(spline.bezier_points, points):
            knot.co = point
            knot.handle_left_type = knot.handle_right_type = "AUTO"
    else:
        spline.points.add(len(points) - 1)
        for knot, point in zip(spline.points, points):
            knot.co = (*point, 1)
    spline.use_cyclic_u = closed
    curve.materials.append(material)
    item = bpy.data.objects.new("tube", curve)
    bpy.context.collection.objects.link(item)


def add_frame(shell, ground, posts, material):
    radius = 0.1 * shell.edge
    for points, closed in shell.rim():
        if len(points) < 2:
            continue
        add_tube(points, radius, closed, material)
        chosen = [max(points, key=lambda p: p.z)][:posts]
        while len(chosen) < min(posts, len(points)):
            chosen.append(max(points, key=lambda p: min((p - other).length for other in chosen)))
        for point in chosen:
            add_tube([point, Vector((point.x, point.y, ground))], radius, False, material, smooth=False)


# ---------------------------------------------------------------- figures for scale

# joints of a standing figure, 1.72 m tall: name, (across, forward, up), radius
BODY = [
    ("ankle", (0.09, 0.0, 0.04), 0.045), ("knee", (0.085, 0.01, 0.48), 0.058), ("hip", (0.08, 0.0, 0.90), 0.085),
    ("pelvis", (0.0, 0.0, 0.98), 0.115), ("chest", (0.0, 0.0, 1.28), 0.125), ("neck", (0.0, 0.0, 1.46), 0.055),
    ("head", (0.0, 0.01, 1.58), 0.092), ("crown", (0.0, 0.0, 1.66), 0.075), ("shoulder", (0.17, 0.0, 1.38), 0.062),
    ("elbow", (0.22, -0.02, 1.10), 0.042), ("hand", (0.22, 0.05, 0.84), 0.036),
]
BONES = [("ankle", "knee"), ("knee", "hip"), ("hip", "pelvis"), ("pelvis", "chest"), ("chest", "neck"), ("neck", "head"),
         ("head", "crown"), ("chest", "shoulder"), ("shoulder", "elbow"), ("elbow", "hand")]


def add_figure(place, facing, stride, height, material):
    vertices, radii, index, edges = [], [], {}, set()
    for side in (-1, 1):
        for name, (across, forward, up), radius in BODY:
            middle = across == 0
            if middle and side == 1:
                index[name, 1] = index[name, -1]
                continue
            swing = side * stride if name in ("ankle", "hand", "knee", "elbow") else 0
            swing *= {"ankle": 0.26, "knee": 0.12, "elbow": -0.06, "hand": -0.16}.get(name, 0)
            index[name, side] = len(vertices)
            vertices.append(Vector((side * across, forward + swing, up)) * (height / 1.72))
            radii.append(radius * height / 1.72)
        edges |= {(index[a, side], index[b, side]) for a, b in BONES}
    mesh = bpy.data.meshes.new("figure")
    mesh.from_pydata(vertices, sorted(edges), [])
    mesh.materials.append(material)
    item = bpy.data.objects.new("figure", mesh)
    bpy.context.collection.objects.link(item)
    item.modifiers.new("skin", "SKIN")
    for vertex, radius in zip(mesh.skin_vertices[0].data, radii):
        vertex.radius = (radius, radius * 0.8)
    mesh.skin_vertices[0].data[index["pelvis", -1]].use_root = True
    item.modifiers.new("smooth", "SUBSURF").render_levels = 3
    item.matrix_world = Matrix.Translation(place) @ Matrix.Rotation(facing, 4, "Z")
    return item


def add_people(count, points, ground, azimuth, material):
    """Figures under the shell where it leaves them room, and before it. Returns where their feet and heads are."""
    chance = random.Random(4)
    low, high = (Vector([least(p[k] for p in points) for k in range(3)]) for least in (min, max))
    centre, reach = (low + high) / 2, (high - low).xy.length / 2
    toward = direction(azimuth, 0)
    across = Vector((-toward.y, toward.x, 0))
    taken = []
    while len(taken) < count and chance.random() > 1e-3:
        place = centre + reach * (chance.uniform(-0.8, 1.25) * toward + chance.uniform(-0.85, 0.85) * across)
        place.z = ground
        near = [p for p in points if (p - place).xy.length < 0.7]
        near_others = [(other - place).xy.length for other in taken]
        if any(p.z < ground + 2.0 for p in near) or any(d < 0.75 for d in near_others):
            continue
        if (place - centre).dot(toward) > 0.35 * reach and len(taken) < count / 2 or len(taken) % 2 and min(near_others) > 1.1:
            continue  # the first half stands inside, and every second one beside another
        taken.append(place)
        add_figure(place - Vector((0, 0, 0.03)), chance.uniform(0, 2 * math.pi), chance.uniform(0.1, 0.9), chance.uniform(1.6, 1.82),
                   material)
    return [place + Vector((0, 0, height)) for place in taken for height in (0, 1.82)]


# ---------------------------------------------------------------- light, camera, picture

def direction(azimuth, elevation):
    a, e = math.radians(azimuth), math.radians(elevation)
    return Vector((math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)))


def add_light(sun):
    light = bpy.data.lights.new("sun", "SUN")
    light.energy = 2.6
    light.angle = math.radians(4)
    light.color = (1.0, 0.955, 0.89)
    item = bpy.data.objects.new("sun", light)
    item.rotation_euler = direction(*sun).to_track_quat("Z", "Y").to_euler()
    bpy.context.collection.objects.link(item)
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs[0].default_value = (0.80, 0.88, 1.0, 1)
    background.inputs[1].default_value = 0.55


def add_ground(z, size):
    material = plain("ground", (0.80, 0.79, 0.77), 0.9)
    item = add_mesh("ground", [(-size, -size, z), (size, -size, z), (size, size, z), (-size, size, z)], [[0, 1, 2, 3]], material)
    item.is_shadow_catcher = True


def add_camera(points, options):
    """Stands where asked and steps back until every point is in the picture."""
    scene = bpy.context.scene
    width, height = (int(n) for n in options.size.split("x"))
    camera = bpy.data.cameras.new("camera")
    camera.lens, camera.sensor_width = options.lens, 36
    item = bpy.data.objects.new("camera", camera)
    bpy.context.collection.objects.link(item)
    scene.camera = item
    back = direction(options.azimuth, options.elevation)
    turn = back.to_track_quat("Z", "Y")
    right, up = turn @ Vector((1, 0, 0)), turn @ Vector((0, 1, 0))
    tan_x = 18 / options.lens * 0.86
    tan_y = 18 / options.lens * height / width * 0.80
    # A point (x, y, z) along right, up, back is in the picture of an eye (X, Y, Z) where |x - X| <= tan_x (Z - z), likewise y.
    seen = [(p.dot(right), p.dot(up), p.dot(back)) for p in points]
    east, west = (max(sign * x + tan_x * z for x, _, z in seen) for sign in (1, -1))
    north, south = (max(sign * y + tan_y * z for _, y, z in seen) for sign in (1, -1))
    depth = max((east + west) / (2 * tan_x), (north + south) / (2 * tan_y))
    item.location = right * (east - west) / 2 + up * (north - south) / 2 + back * depth
    item.rotation_euler = turn.to_euler()
    camera.clip_end = 1000 + 100 * depth


def compose(scene):
    """Lays the picture, whose ground is only a shadow, over a backdrop: light behind the shell, darker towards the corners."""
    width, height = scene.render.resolution_x, scene.render.resolution_y
    y, x = numpy.mgrid[0:height, 0:width]
    away = numpy.hypot((x / width - 0.5) / 0.75, (y / height - 0.60) / 0.80)
    light = numpy.clip(1 - away, 0, 1) ** 1.2
    pixels = numpy.ones((height, width, 4), numpy.float32)
    for k, (near, far) in enumerate(zip((0.74, 0.75, 0.765), (0.38, 0.395, 0.415))):
        pixels[..., k] = far + (near - far) * light
    backdrop = bpy.data.images.new("backdrop", width, height, float_buffer=True)
    backdrop.pixels.foreach_set(pixels.ravel())

    scene.use_nodes = True
    nodes, links = scene.node_tree.nodes, scene.node_tree.links
    nodes.clear()
    layers, behind = nodes.new("CompositorNodeRLayers"), nodes.new("CompositorNodeImage")
    over, result = nodes.new("CompositorNodeAlphaOver"), nodes.new("CompositorNodeComposite")
    behind.image = backdrop
    links.new(behind.outputs[0], over.inputs[1])
    links.new(layers.outputs["Image"], over.inputs[2])
    links.new(over.outputs[0], result.inputs[0])


def main():
    options = arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    shells = [Shell(path, options.state) for path in [options.design, *options.layers]]
    kind = KINDS[options.material]
    material = shader(options.material, kind["build"])
    steel = plain("steel", (0.035, 0.037, 0.04), 0.38, 0.6)
    points = [p for shell in shells for p in shell.points]
    low = Vector([min(p[k] for p in points) for k in range(3)])
    high = Vector([max(p[k] for p in points) for k in range(3)])
    thickest = max(kind["thickness"] * shell.edge for shell in shells)
    ground = low.z - options.lift - thickest
    for shell in shells:
        add_panels(shell, kind, material)
        add_pins(shell, kind, steel)
        add_frame(shell, ground, options.posts if shell is shells[0] else 0, steel)
        if options.balloon:
            add_balloon(shell, 0.09 * shell.edge, plain("rubber", (0.42, 0.035, 0.03), 0.3))
    for path in options.reference:
        bpy.ops.import_scene.obj(filepath=path, axis_forward="Y", axis_up="Z")
        for item in bpy.context.selected_objects:
            item.scale = [shells[0].metres] * 3
            item.data.materials.clear()
            item.data.materials.append(plain("reference", (0.62, 0.61, 0.59), 0.8))
    sun = [float(v) for v in options.sun.split(",")]
    ray = direction(*sun)
    feet = [Vector((p.x, p.y, ground)) for p in points] if options.lift else []
    on_ground = options.lift and not options.reference  # within walls it falls on them
    shadow = [p - ray * ((p.z - ground) / ray.z) for p in points] if on_ground else []
    people = add_people(options.people, points, ground, options.azimuth, plain("figure", (0.16, 0.165, 0.18), 0.65))
    add_camera(points + feet + shadow + people, options)
    add_ground(ground, 60 * (high - low).length)
    add_light(sun)

    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = options.samples
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.adaptive_threshold = 0.015
    scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 8
    scene.cycles.seed = 0
    scene.render.film_transparent = True
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = (int(n) for n in options.size.split("x"))
    if options.threads:
        scene.render.threads_mode, scene.render.threads = "FIXED", options.threads
    compose(scene)
    picture = scene.render.image_settings
    picture.file_format, picture.quality = ("PNG", 90) if options.picture.endswith(".png") else ("JPEG", 92)
    scene.render.filepath = options.picture
    bpy.ops.render.render(write_still=True)


main()
