"""Reads USD's text format strictly: the part of its grammar that meshes, points and spheres need, and what the schemas of
UsdGeom demand of them. Anything else is an error, so a file that passes is one that USD's own reader takes."""

import math
import re

TOKEN = re.compile(r"""[ \t\n]*(?:(?P<text>"(?:[^"\\\n]|\\.)*")|(?P<number>[-+]?(?:inf|nan|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?![A-Za-z0-9_]))
                           |(?P<word>[A-Za-z_][A-Za-z0-9_]*(?::[A-Za-z_][A-Za-z0-9_]*)*)|(?P<mark>[()\[\]{}=,]))""", re.VERBOSE)
# Name: components, whether its numbers are whole.
TYPES = {"bool": (1, True), "int": (1, True), "int64": (1, True), "float": (1, False), "double": (1, False), "string": (0, False),
         "token": (0, False), "float3": (3, False), "double3": (3, False), "point3f": (3, False), "normal3f": (3, False),
         "color3f": (3, False), "vector3f": (3, False)}
# What UsdGeom's schemas say of the attributes that a kind of prim may have, beside primvars and transformations.
COMMON = {"extent": "float3[]", "xformOpOrder": "token[]", "xformOp:translate": "double3"}
SCHEMAS = {
    "Xform": COMMON,
    "Sphere": COMMON | {"radius": "double"},
    "Points": COMMON | {"points": "point3f[]", "velocities": "vector3f[]", "normals": "normal3f[]", "widths": "float[]"},
    "Mesh": COMMON | {"points": "point3f[]", "velocities": "vector3f[]", "normals": "normal3f[]", "doubleSided": "bool",
                      "subdivisionScheme": "token", "faceVertexCounts": "int[]", "faceVertexIndices": "int[]"},
}


class UsdError(Exception):
    pass


def require(condition, words):
    if not condition:
        raise UsdError(words)


class Prim:
    """A prim: its attributes by name, each (type, value, interpolation), and its children."""

    def __init__(self, kind, name):
        self.kind, self.name, self.attributes, self.children = kind, name, {}, []

    def value(self, name):
        return self.attributes[name][1] if name in self.attributes else None


class Parser:

    def __init__(self, text):
        require(text.startswith("#usda 1.0\n"), "does not begin with #usda 1.0")
        self.tokens, at, end = [], len("#usda 1.0\n"), len(text.rstrip())
        while at < end:
            match = TOKEN.match(text, at)
            require(match, f"not USD: {text[at:at + 40]!r}")
            self.tokens.append((match.lastgroup, match.group(match.lastgroup)))
            at = match.end()
        self.at = 0

    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else ("end", "")

    def take(self, kind=None, text=None):
        found = self.peek()
        require((kind is None or found[0] == kind) and (text is None or found[1] == text), f"{found[1]!r} instead of {text or kind}")
        self.at += 1
        return found[1]

    def optional(self, text):
        if self.peek()[1] != text:
            return False
        self.at += 1
        return True

    def metadata(self):
        entries = {}
        if self.optional("("):
            while not self.optional(")"):
                name = self.take("word")
                self.take("mark", "=")
                entries[name] = self.take()
        return entries

    def item(self, components, whole):
        if components == 0:
            return self.take("text")[1:-1]
        if components == 1:
            number = self.take("number")
            require(not whole or re.fullmatch(r"-?\d+", number), f"{number} is no whole number")
            return float(number)
        self.take("mark", "(")
        values = [self.item(1, whole)]
        for _ in range(components - 1):
            self.take("mark", ",")
            values.append(self.item(1, whole))
        self.take("mark", ")")
        return tuple(values)

    def items(self, components, whole):
        values = []
        self.take("mark", "[")
        while not self.optional("]"):
            if values:
                self.take("mark", ",")
            values.append(self.item(components, whole))
        return values

    def attribute(self, prim):
        custom, uniform = self.optional("custom"), self.optional("uniform")
        kind = self.take("word")
        require(kind in TYPES, f"there is no type {kind}")
        components, whole = TYPES[kind]
        is_list = self.optional("[")
        if is_list:
            self.take("mark", "]")
        name = self.take("word")
        self.take("mark", "=")
        value = self.items(components, whole) if is_list else self.item(components, whole)
        full_type = kind + ("[]" if is_list else "")
        require(name not in prim.attributes, f"{prim.name} has {name} twice")
        known = SCHEMAS[prim.kind].get(name)
        require(custom or known == full_type or (known is None and name.startswith("primvars:") and is_list),
                f"{name} of {prim.kind} is no {full_type}")
        require(uniform == (name in ("doubleSided", "subdivisionScheme", "xformOpOrder")), f"{name}: uniform or not?")
        prim.attributes[name] = (full_type, value, self.metadata().get("interpolation", '""')[1:-1])

    def prim(self):
        self.take("word", "def")
        kind = self.take("word")
        require(kind in SCHEMAS, f"there is no kind of prim {kind}")
        prim = Prim(kind, self.take("text")[1:-1])
        require(re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", prim.name), f"{prim.name!r} is no name")
        self.take("mark", "{")
        while not self.optional("}"):
            if self.peek()[1] == "def":
                prim.children.append(self.prim())
            else:
                self.attribute(prim)
        names = [child.name for child in prim.children]
        require(len(set(names)) == len(names), f"two prims have one name among {names}")
        check(prim)
        return prim


def check_counts(prim, sizes):
    """Every list that says how it is interpolated is as long as that, and has none that is meant for something else."""
    for name, (_, value, interpolation) in prim.attributes.items():
        if interpolation:
            require(interpolation in sizes, f"{name} of a {prim.kind} cannot be {interpolation}")
            require(len(value) == sizes[interpolation], f"{name} has {len(value)} values for {sizes[interpolation]}")
        elif name.startswith("primvars:") or name == "normals":
            require(len(value) == 1, f"{name} has {len(value)} values and does not say what for")


def check_extent(prim, low, high):
    extent = prim.value("extent")
    require(extent is not None and len(extent) == 2, f"{prim.name} has no extent")
    for k in range(3):
        require(extent[0][k] <= low[k] + 1e-9 and extent[1][k] >= high[k] - 1e-9, f"{prim.name} reaches beyond its extent")


def check(prim):
    if prim.kind == "Sphere":
        radius = prim.value("radius")
        require(radius and radius > 0, "a sphere without a radius")
        check_counts(prim, {})
        check_extent(prim, [-radius] * 3, [radius] * 3)
    if prim.kind in ("Mesh", "Points"):
        points = prim.value("points")
        require(points, f"{prim.name} has no points")
        require(all(map(math.isfinite, (x for p in points for x in p))), f"a point of {prim.name} is not finite")
        widths = prim.value("widths") or [0.0] * len(points)
        require(len(widths) == len(points), "widths and points do not fit together")
        check_extent(prim, [min(p[k] - w / 2 for p, w in zip(points, widths)) for k in range(3)],
                     [max(p[k] + w / 2 for p, w in zip(points, widths)) for k in range(3)])
        velocities = prim.value("velocities")
        require(velocities is None or len(velocities) == len(points), "velocities and points do not fit together")
    if prim.kind == "Points":
        check_counts(prim, {"vertex": len(points)})
    if prim.kind == "Mesh":
        faces, corners = prim.value("faceVertexCounts"), prim.value("faceVertexIndices")
        require(faces and all(n >= 3 for n in faces) and sum(faces) == len(corners), "faces and corners do not fit together")
        require(all(0 <= c < len(points) for c in corners), "a face has a corner that is not there")
        require(prim.value("subdivisionScheme") in ("none", "catmullClark", "loop", "bilinear"), "subdivisionScheme")
        check_counts(prim, {"vertex": len(points), "uniform": len(faces), "faceVarying": len(corners)})
    order = prim.value("xformOpOrder") or []
    require(order == [name for name in prim.attributes if name.startswith("xformOp:")], "transformations and their order differ")


def read_usda(text):
    """The default prim and the file's metadata. @throws UsdError  where the text is not what USD takes"""
    parser = Parser(text)
    metadata = parser.metadata()
    roots = []
    while parser.peek()[0] != "end":
        roots.append(parser.prim())
    named = [root for root in roots if f'"{root.name}"' == metadata.get("defaultPrim")]
    require(len(named) == 1 and len(roots) == 1, "the default prim is not there")
    require(metadata.get("upAxis") in ('"Y"', '"Z"'), "upAxis")
    return named[0], metadata
