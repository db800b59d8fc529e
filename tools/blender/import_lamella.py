"""Loads films and bubbles of lamella into Blender and gives them the look of soap films.

    lamella export RUN --to ply --baked --rate 240 --out sequence
    blender --python tools/blender/import_lamella.py -- sequence

FOLDER or FILE after "--" is what `lamella export --to ply --baked` wrote. A folder becomes an animation: frame k of the
timeline shows the k-th file. Vertices carry the attributes thickness_nm, velocity, color; faces region_back and
region_front. Options: --save FILE.blend, --render FILE.png (the current frame, with Cycles), --size WxH,
--samples N, --scale F (lengths are multiplied by it; by default films become about 2 units large), --report (prints what was
loaded as JSON). Works with Blender 3.4 and later; in the text editor, set SOURCE below and run it.
"""

import json
import pathlib
import sys

import bpy
import numpy as np

SOURCE = ""  # a folder or file, when there is no command line

WATER = 1.333
TABLE_REACH = 1500.0  # nm
TABLE_SIZE = 1024
TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4",
         "double": "<f8"}


def read_ply(path):
    """Vertices and faces of a binary PLY of triangles, as two arrays with named columns."""
    data = pathlib.Path(path).read_bytes()
    head, mark, body = data.partition(b"end_header\n")
    if not mark or b"format binary_little_endian" not in head:
        raise ValueError(f"{path}: no binary PLY as lamella writes it")
    counts, columns, element = {}, {}, None
    for words in (line.split() for line in head.decode().splitlines()):
        if words[:1] == ["element"]:
            element = words[1]
            counts[element], columns[element] = int(words[2]), []
        elif words[:2] == ["property", "list"]:
            columns[element] += [("corners", "u1"), (words[4], TYPES[words[3]], (3,))]
        elif words[:1] == ["property"]:
            columns[element].append((words[2], TYPES[words[1]]))
    vertices = np.frombuffer(body, columns["vertex"], counts["vertex"])
    faces = np.frombuffer(body, columns["face"], counts["face"], vertices.nbytes)
    return vertices, faces


def vectors(table, names):
    """Columns of a table side by side."""
    return np.stack([table[name] for name in names], axis=1).astype(np.float32)


def icosphere():
    """42 vertices and 80 triangles."""
    mesh = bpy.data.meshes.new("sphere")
    import bmesh
    shape = bmesh.new()
    bmesh.ops.create_icosphere(shape, subdivisions=2, radius=1.0)
    shape.to_mesh(mesh)
    shape.free()
    places = np.array([v.co[:] for v in mesh.vertices], np.float32)
    faces = np.array([p.vertices[:] for p in mesh.polygons], np.int32)
    bpy.data.meshes.remove(mesh)
    return places, faces


def new_mesh(name, places, triangles):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places.tolist(), [], triangles.tolist())
    mesh.polygons.foreach_set("use_smooth", np.ones(len(triangles), bool))
    return mesh


def set_attribute(mesh, name, kind, domain, values):
    """One value per vertex or face; colors have four components."""
    attribute = mesh.attributes.new(name, kind, domain)
    key = {"FLOAT_VECTOR": "vector", "FLOAT_COLOR": "color"}.get(kind, "value")
    attribute.data.foreach_set(key, np.ascontiguousarray(values).ravel())


def linear(encoded):
    c = encoded / 255.0
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def colors_of(table):
    if "red" not in table.dtype.names:
        return None
    rgb = linear(vectors(table, ("red", "green", "blue")))
    return np.concatenate([rgb, np.ones((len(rgb), 1), np.float32)], axis=1).astype(np.float32)


def film_mesh(name, vertices, faces, scale):
    """The films alone: the first vertices, which faces use."""
    triangles = faces["vertex_indices"].astype(np.int32)
    vertices = vertices[:int(triangles.max()) + 1]
    mesh = new_mesh(name, scale * vectors(vertices, "xyz"), triangles)
    names = vertices.dtype.names
    for field in names:
        if field in ("x", "y", "z", "nx", "ny", "nz", "red", "green", "blue") or field.endswith(("_x", "_y", "_z")):
            continue
        set_attribute(mesh, field, "FLOAT", "POINT", np.nan_to_num(vertices[field]).astype(np.float32))
    for field in (n[:-2] for n in names if n.endswith("_x")):
        parts = [f"{field}_{k}" for k in "xyz"]
        if all(p in names for p in parts):
            set_attribute(mesh, field, "FLOAT_VECTOR", "POINT", np.nan_to_num(vectors(vertices, parts)))
    for field in ("region_back", "region_front"):
        set_attribute(mesh, field, "INT", "FACE", faces[field].astype(np.int32))
    color = colors_of(vertices)
    if color is not None:
        set_attribute(mesh, "color", "FLOAT_COLOR", "POINT", color)
    if "nx" in names:
        if hasattr(mesh, "use_auto_smooth"):  # until Blender 4.0
            mesh.use_auto_smooth = True
        mesh.normals_split_custom_set_from_vertices(vectors(vertices, ("nx", "ny", "nz")).tolist())
    return mesh


def ball_mesh(name, points, scale):
    """A small polyhedron for each point that has a radius."""
    sphere, sphere_faces = icosphere()
    places = scale * (vectors(points, "xyz")[:, None] + points["radius"].astype(np.float32)[:, None, None] * sphere)
    offsets = len(sphere) * np.arange(len(points), dtype=np.int32)
    triangles = sphere_faces[None] + offsets[:, None, None]
    mesh = new_mesh(name, places.reshape(-1, 3), triangles.reshape(-1, 3))
    color = colors_of(points)
    if color is not None:
        set_attribute(mesh, "color", "FLOAT_COLOR", "POINT", np.repeat(color, len(sphere), axis=0))
    return mesh


def color_matching(nm):
    """The CIE 1931 observer, fit of Wyman, Sloan and Shirley (2013)."""
    def lobe(middle, below, above):
        t = (nm - middle) * np.where(nm < middle, below, above)
        return np.exp(-0.5 * t * t)
    return np.stack([0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323) - 0.065 * lobe(501.1, 0.0490, 0.0382),
                     0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322),
                     1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725)])


def film_colors():
    """Linear red, green, blue of films in white light at normal incidence, up to TABLE_REACH, relative to a mirror; the parts
    that sRGB cannot hold are cut."""
    nm = np.arange(380.0, 781.0, 5.0)
    phase = 2.0 * np.pi * WATER * np.linspace(0.0, TABLE_REACH, TABLE_SIZE)[:, None] / nm
    power = ((WATER - 1.0) / (WATER + 1.0)) ** 2
    sine = 4.0 * power * np.sin(phase) ** 2
    reflected = sine / ((1.0 - power) ** 2 + sine)
    observer = color_matching(nm)
    xyz = reflected @ observer.T / observer.sum(axis=1) * np.array([0.95047, 1.0, 1.08883])
    to_rgb = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]])
    return np.clip(xyz @ to_rgb.T, 0.0, None)


def table_image():
    """The colors as a picture of one row, for a texture."""
    image = bpy.data.images.new("film colors", TABLE_SIZE, 1, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    pixels = np.ones((TABLE_SIZE, 4), np.float32)
    pixels[:, :3] = film_colors()
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    return image


def film_material():
    """A thin mirror that lets the rest of the light through: its color from the texture at h sqrt(1 - sin^2 / n^2), brighter
    towards grazing incidence as one interface of water is."""
    material = bpy.data.materials.new("soap film")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    new = tree.nodes.new

    def math(operation, a, b=None):
        node = new("ShaderNodeMath")
        node.operation = operation
        for socket, value in zip(node.inputs, (a, b)):
            if isinstance(value, (int, float)):
                socket.default_value = value
            elif value is not None:
                tree.links.new(value, socket)
        return node.outputs[0]

    thickness = new("ShaderNodeAttribute")
    thickness.attribute_name = "thickness_nm"
    geometry = new("ShaderNodeNewGeometry")
    product = new("ShaderNodeVectorMath")
    product.operation = "DOT_PRODUCT"
    tree.links.new(geometry.outputs["Incoming"], product.inputs[0])
    tree.links.new(geometry.outputs["Normal"], product.inputs[1])
    cosine = math("ABSOLUTE", product.outputs["Value"])
    sine_square = math("SUBTRACT", 1.0, math("MULTIPLY", cosine, cosine))
    inside = math("SQRT", math("SUBTRACT", 1.0, math("DIVIDE", sine_square, WATER * WATER)))
    place = math("DIVIDE", math("MULTIPLY", thickness.outputs["Fac"], inside), TABLE_REACH)
    vector = new("ShaderNodeCombineXYZ")
    tree.links.new(math("MINIMUM", place, 0.9995), vector.inputs[0])
    vector.inputs[1].default_value = 0.5
    texture = new("ShaderNodeTexImage")
    texture.image = table_image()
    texture.extension = "EXTEND"
    tree.links.new(vector.outputs[0], texture.inputs["Vector"])
    fresnel = math("ADD", 0.02, math("MULTIPLY", 0.98, math("POWER", math("SUBTRACT", 1.0, cosine), 5.0)))
    gain = math("MINIMUM", math("DIVIDE", fresnel, 0.02), 12.0)
    mirror, clear = new("ShaderNodeVectorMath"), new("ShaderNodeVectorMath")
    mirror.operation, clear.operation = "SCALE", "SUBTRACT"
    tree.links.new(texture.outputs["Color"], mirror.inputs[0])
    tree.links.new(gain, mirror.inputs["Scale"])
    clear.inputs[0].default_value = (1.0, 1.0, 1.0)
    tree.links.new(mirror.outputs[0], clear.inputs[1])
    glossy, transparent, both, output = (new(f"ShaderNode{kind}") for kind in
                                         ("BsdfGlossy", "BsdfTransparent", "AddShader", "OutputMaterial"))
    glossy.inputs["Roughness"].default_value = 0.0
    tree.links.new(mirror.outputs[0], glossy.inputs["Color"])
    tree.links.new(clear.outputs[0], transparent.inputs["Color"])
    tree.links.new(glossy.outputs[0], both.inputs[0])
    tree.links.new(transparent.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], output.inputs["Surface"])
    if hasattr(material, "blend_method"):
        material.blend_method = "BLEND"
    return material


def ball_material():
    material = bpy.data.materials.new("bubble")
    material.use_nodes = True
    color = material.node_tree.nodes.new("ShaderNodeAttribute")
    color.attribute_name = "color"
    surface = material.node_tree.nodes["Principled BSDF"]
    material.node_tree.links.new(color.outputs["Color"], surface.inputs["Base Color"])
    surface.inputs["Roughness"].default_value = 0.3
    return material


class Sequence:
    """The files of a folder and the two objects that show one of them."""

    def __init__(self, source, scale=None):
        source = pathlib.Path(source)
        self.files = sorted(source.glob("*.ply")) if source.is_dir() else [source]
        if not self.files:
            raise ValueError(f"{source} has no .ply files")
        self.scale = scale or self.natural_scale()
        self.films, self.balls = film_material(), ball_material()
        self.objects = {}
        self.shown = None

    def natural_scale(self):
        places = vectors(read_ply(self.files[0])[0], "xyz")
        return 2.0 / max(float(np.ptp(places, axis=0).max()), 1e-30)

    def show(self, number):
        number = min(max(number, 0), len(self.files) - 1)
        if number == self.shown:
            return
        self.shown = number
        vertices, faces = read_ply(self.files[number])
        meshes = {}
        if len(faces):
            meshes["lamella films"] = film_mesh("films", vertices, faces, self.scale)
        if "radius" in vertices.dtype.names:
            meshes["lamella bubbles"] = ball_mesh("bubbles", vertices[np.isfinite(vertices["radius"])], self.scale)
        for name in ("lamella films", "lamella bubbles"):
            self.put(name, meshes.get(name) or bpy.data.meshes.new("nothing"))

    def put(self, name, mesh):
        mesh.materials.append(self.films if name == "lamella films" else self.balls)
        if name not in self.objects:
            self.objects[name] = bpy.data.objects.new(name, mesh)
            bpy.context.scene.collection.objects.link(self.objects[name])
            return
        old, self.objects[name].data = self.objects[name].data, mesh
        bpy.data.meshes.remove(old)

    def report(self):
        films = self.objects["lamella films"].data
        return {"files": len(self.files), "vertices": len(films.vertices), "faces": len(films.polygons),
                "attributes": sorted(a.name for a in films.attributes if not a.name.startswith(".")),
                "bubble_vertices": len(self.objects["lamella bubbles"].data.vertices), "material": self.films.name}


def load(source, scale=None):
    """Shows a file or an animated folder; returns the Sequence."""
    sequence = Sequence(source, scale)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 0, len(sequence.files) - 1
    scene.frame_set(0)
    sequence.show(0)
    bpy.app.handlers.frame_change_pre.append(lambda scene, *_: sequence.show(scene.frame_current))
    return sequence


def studio():
    """A camera, two lamps and a dim room, for pictures from the command line."""
    scene = bpy.context.scene
    for thing in [o for o in scene.objects if not o.name.startswith("lamella")]:
        bpy.data.objects.remove(thing)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    corners = [o.matrix_world @ v.co for o in scene.objects if o.type == "MESH" for v in o.data.vertices]
    places = np.array([c[:] for c in corners])
    middle = (places.min(axis=0) + places.max(axis=0)) / 2
    reach = float(np.linalg.norm(places - middle, axis=1).max())
    camera.location = middle + reach * np.array([2.2, -4.2, 1.4])
    target = bpy.data.objects.new("target", None)
    target.location = middle
    scene.collection.objects.link(target)
    follow = camera.constraints.new("TRACK_TO")
    follow.target, follow.track_axis, follow.up_axis = target, "TRACK_NEGATIVE_Z", "UP_Y"
    for place, size, power in (((-5, -4, 5), 7.0, 6000.0), ((5, -2, 3), 4.0, 2000.0)):
        lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "AREA"))
        lamp.data.size, lamp.data.energy = size * reach, power * reach * reach
        lamp.location = middle + reach * np.array(place)
        aim = lamp.constraints.new("TRACK_TO")
        aim.target, aim.track_axis, aim.up_axis = target, "TRACK_NEGATIVE_Z", "UP_Y"
        scene.collection.objects.link(lamp)


    world = scene.world or bpy.data.worlds.new("studio")
    scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    tree.nodes.clear()
    path, mix, room, backdrop, output = (tree.nodes.new(f"ShaderNode{kind}") for kind in
                                         ("LightPath", "MixShader", "Background", "Background", "OutputWorld"))
    room.inputs["Color"].default_value = (0.75, 0.78, 0.85, 1.0)      # what films mirror
    backdrop.inputs["Color"].default_value = (0.012, 0.014, 0.018, 1.0)  # what the camera sees
    tree.links.new(path.outputs["Is Camera Ray"], mix.inputs["Fac"])
    tree.links.new(room.outputs[0], mix.inputs[1])
    tree.links.new(backdrop.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    scene.view_settings.view_transform = "Standard"


def main(words):
    import argparse
    parser = argparse.ArgumentParser(prog="import_lamella.py", description=__doc__.splitlines()[0])
    parser.add_argument("source")
    parser.add_argument("--save")
    parser.add_argument("--render")
    parser.add_argument("--size", default="960x720")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--scale", type=float)
    parser.add_argument("--report", action="store_true")
    options = parser.parse_args(words)
    for thing in list(bpy.data.objects):
        if thing.type == "MESH":
            bpy.data.objects.remove(thing)  # the cube that Blender starts with
    sequence = load(options.source, options.scale)
    if options.report:
        print("lamella " + json.dumps(sequence.report()))
    if options.render:
        studio()
        scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.cycles.samples = options.samples
        scene.cycles.use_denoising = False  # not every Blender can
        scene.cycles.transparent_max_bounces = 64
        scene.render.resolution_x, scene.render.resolution_y = map(int, options.size.split("x"))
        scene.render.filepath = str(pathlib.Path(options.render).resolve())
        bpy.ops.render.render(write_still=True)
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(pathlib.Path(options.save).resolve()))


if __name__ == "__main__":
    if "--" in sys.argv:
        try:
            main(sys.argv[sys.argv.index("--") + 1:])
        except Exception as error:  # Blender would go on and exit with 0
            print(f"import_lamella.py: {error}", file=sys.stderr)
            sys.exit(1)
    elif SOURCE:
        load(SOURCE)
