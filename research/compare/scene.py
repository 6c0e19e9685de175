"""What stands round the water, for both programs: meshes, a glTF file of them, and an environment with a sun in it."""
import io
import json
import math
import struct

import numpy as np

TILE = 0.1  # metres
TILES = 8  # in the texture, a side
GROUND, SOLID = (0.32, 0.29, 0.25), (0.55, 0.20, 0.10)  # albedo
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


class Mesh:
    """Triangles with normals and texture coordinates; its color is an albedo, or None where it is tiled."""

    def __init__(self, positions, normals, places, triangles, color):
        self.positions = np.asarray(positions, "f4")
        self.normals = np.asarray(normals, "f4")
        self.places = np.asarray(places, "f4")
        self.triangles = np.asarray(triangles, "u4")
        self.color = color


def to_srgb(linear):
    x = np.clip(linear, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


def tiles(light=(0.62, 0.66, 0.66), dark=(0.10, 0.22, 0.34), grout=(0.45, 0.43, 0.40)):
    """Checkered tiles, sRGB bytes. The same upside down: then no convention about rows matters."""
    texels, random = 64, np.random.default_rng(3)
    shades = 1 + 0.12 * (random.random((TILES, TILES)) - 0.5)
    shades[TILES // 2:] = shades[:TILES // 2][::-1]
    image = np.empty((TILES * texels, TILES * texels, 3))
    for row in range(TILES):
        for column in range(TILES):
            odd = (min(row, TILES - 1 - row) + column) % 2
            tile = np.full((texels, texels, 3), np.array(dark if odd else light) * shades[row, column])
            tile[:2] = tile[-2:] = grout
            tile[:, :2] = tile[:, -2:] = grout
            image[row * texels:(row + 1) * texels, column * texels:(column + 1) * texels] = tile
    return (255 * to_srgb(image) + 0.5).astype("u1")


def cuboid(low, high, color):
    positions, normals, places, triangles = [], [], [], []
    for axis in range(3):
        u, v = (other for other in range(3) if other != axis)
        for side in (0, 1):
            first = len(positions)
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = np.array([(low, high)[side][i] for i in range(3)], "f8")
                corner[u], corner[v] = (low, high)[a][u], (low, high)[b][v]
                positions.append(corner)
                normals.append(np.eye(3)[axis] * (2 * side - 1))
                places.append([corner[u] / (TILE * TILES), corner[v] / (TILE * TILES)])
            quad = [0, 1, 2, 0, 2, 3]
            if (side == 1) == (axis == 1):
                quad = quad[::-1]
            triangles += [[first + i for i in quad[:3]], [first + i for i in quad[3:]]]
    return Mesh(positions, normals, places, triangles, color)


def sphere(center, radius, rows=48):
    theta, phi = np.linspace(0, math.pi, rows + 1), np.linspace(0, 2 * math.pi, 2 * rows + 1)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    normals = np.stack([np.sin(t) * np.sin(p), np.cos(t), np.sin(t) * np.cos(p)], -1).reshape(-1, 3)
    wide = 2 * rows + 1
    triangles = []
    for i in range(rows):
        for j in range(2 * rows):
            a, b = i * wide + j, (i + 1) * wide + j
            triangles += [[a, b, b + 1], [a, b + 1, a + 1]]
    return Mesh(np.array(center) + radius * normals, normals, np.zeros((len(normals), 2)), triangles, SOLID)


def cylinder(center, radius, height, sides=96):
    """Upright."""
    angle = np.arange(sides) * 2 * math.pi / sides
    ring = np.stack([np.sin(angle), np.zeros(sides), np.cos(angle)], 1)
    up = np.array([0.0, 1.0, 0.0])
    top, foot = radius * ring + height / 2 * up, radius * ring - height / 2 * up
    positions = np.concatenate([foot, top, top, foot, [height / 2 * up, -height / 2 * up]])
    normals = np.concatenate([ring, ring, 0 * ring + up, 0 * ring - up, [up, -up]])
    triangles = []
    for i in range(sides):
        j = (i + 1) % sides
        triangles += [[i, j, sides + j], [i, sides + j, sides + i]]
        triangles += [[4 * sides, 2 * sides + i, 2 * sides + j], [4 * sides + 1, 3 * sides + j, 3 * sides + i]]
    return Mesh(np.array(center) + positions, normals, np.zeros((len(positions), 2)), triangles, SOLID)


def solid(kind, **numbers):
    if kind == "box":
        return cuboid(numbers["low"], numbers["high"], SOLID)
    return {"sphere": sphere, "cylinder": cylinder}[kind](**numbers)


def basin(points, radius, box, eye, walls=None):
    """A tiled basin whose inner faces stand half a radius beyond the outermost water, so that its surface ends in them and
    no air is left between; those that the water has not reached are the box's. Low walls towards the eye. On the ground."""
    low, high = np.quantile(points, 0.002, axis=0) - radius / 2, np.quantile(points, 0.998, axis=0) + radius / 2
    for axis in (0, 2):
        least, most = box[2 * axis:2 * axis + 2]
        low[axis] = least if low[axis] > least + 6 * radius else max(low[axis], least)
        high[axis] = most if high[axis] < most - 6 * radius else min(high[axis], most)
    floor = max(low[1], box[2])
    wide = max(high[0] - low[0], high[2] - low[2])
    thick = 0.03 * wide
    under = [low[0] - thick / 2, floor - 0.9 * thick, low[2] - thick / 2]
    meshes = [cuboid(under, [high[0] + thick / 2, floor, high[2] + thick / 2], None)]
    for axis in (0, 2):
        for side in (-1, 1):
            face = (low if side < 0 else high)[axis]
            towards = side * (eye[axis] - face) > 0
            top = floor + walls[0 if towards else 1] if walls else _top(points, radius, axis, face, towards, (low, high, floor, wide))
            a, b = low - thick, high + thick
            a[1], b[1] = floor - thick, top
            if axis == 2:  # no two faces in one plane
                a[0], b[0] = a[0] + 0.02 * thick, b[0] - 0.02 * thick
            (a if side > 0 else b)[axis] = face
            meshes.append(cuboid(a, b, None))
    middle, far = (low + high) / 2, 1.6 * wide
    ground = floor - thick
    meshes.append(cuboid([middle[0] - far, ground - 0.05, middle[2] - far], [middle[0] + far, ground, middle[2] + far], GROUND))
    return meshes


def _top(points, radius, axis, face, towards, where):
    """Height of a wall: over the water that stands at most of it."""
    low, high, floor, wide = where
    near = points[np.abs(points[:, axis] - face) < 4 * radius]
    across = 2 - axis
    bins = ((near[:, across] - low[across]) / (high[across] - low[across]) * 24).clip(0, 23).astype(int)
    tops = [near[bins == i, 1].max() for i in range(24) if (bins == i).any()] or [floor]
    level = np.quantile(tops, 0.35 if towards else 0.9) + 2 * radius
    return float(np.clip(level, floor + 0.03 * wide, floor + (0.16 if towards else 0.30) * wide))


def write_glb(meshes, path):
    """glTF 2.0, binary, its texture inside."""
    from PIL import Image

    picture = io.BytesIO()
    Image.fromarray(tiles()).save(picture, "PNG")
    body, views, accessors = b"", [], []

    def view(data):
        nonlocal body
        views.append({"buffer": 0, "byteOffset": len(body), "byteLength": len(data)})
        body += data + bytes(-len(data) % 4)
        return len(views) - 1

    def accessor(array, kind):
        component = 5125 if array.dtype == np.uint32 else 5126
        entry = {"bufferView": view(array.tobytes()), "componentType": component, "count": array.size if kind == "SCALAR" else len(array), "type": kind}
        if kind == "VEC3":
            entry |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
        accessors.append(entry)
        return len(accessors) - 1

    materials, parts = [], []
    for mesh in meshes:
        rough = {"roughnessFactor": 1.0, "metallicFactor": 0.0}
        look = {"baseColorTexture": {"index": 0}} if mesh.color is None else {"baseColorFactor": [*mesh.color, 1.0]}
        materials.append({"pbrMetallicRoughness": rough | look})
        attributes = {"POSITION": accessor(mesh.positions, "VEC3"), "NORMAL": accessor(mesh.normals, "VEC3"), "TEXCOORD_0": accessor(mesh.places, "VEC2")}
        parts.append({"primitives": [{"attributes": attributes, "indices": accessor(mesh.triangles.reshape(-1), "SCALAR"), "material": len(materials) - 1}]})
    image = view(picture.getvalue())
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(parts)))}],
        "nodes": [{"mesh": i} for i in range(len(parts))], "meshes": parts, "materials": materials,
        "textures": [{"source": 0, "sampler": 0}], "images": [{"bufferView": image, "mimeType": "image/png"}],
        "samplers": [{"wrapS": 10497, "wrapT": 10497}], "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(body)}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(b"glTF" + struct.pack("<II", 2, 28 + len(text) + len(body)))
        file.write(struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(body)) + b"BIN\0" + body)


def environment(mi, source, sun, path):
    """Writes an equirectangular picture with a disc for a sun: degrees of azimuth (from -z to x), elevation and width; its
    irradiance on a plane that faces it, in red (0.93 of that in green, 0.82 in blue), is `over_sky` times the luminance of
    all else on level ground. Returns the luminance of white, level ground."""
    picture = np.array(mi.Bitmap(str(source)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))
    rows, columns, _ = picture.shape
    polar = (np.arange(rows) + 0.5) / rows * math.pi
    round_ = ((np.arange(columns) + 0.5) / columns - 0.5) * 2 * math.pi
    flat = np.sin(polar)[:, None]
    directions = np.stack([flat * np.sin(round_), np.cos(polar)[:, None] + 0 * round_, -flat * np.cos(round_)], -1)
    solid_angle = flat * (2 * math.pi / columns) * (math.pi / rows) + 0 * round_
    level = solid_angle * np.maximum(directions[..., 1], 0)
    if sun:
        azimuth, elevation, width = (math.radians(sun[key]) for key in ("azimuth", "elevation", "width"))
        towards = [math.cos(elevation) * math.sin(azimuth), math.sin(elevation), -math.cos(elevation) * math.cos(azimuth)]
        disc = directions @ np.array(towards) > math.cos(width / 2)
        if not disc.any():
            raise ValueError(f"the sun is narrower than a pixel of {source}")
        irradiance = sun["over_sky"] * (picture @ LUMINANCE * level).sum()
        picture[disc] += np.array([1.0, 0.93, 0.82]) * irradiance / solid_angle[disc].sum()
    mi.Bitmap(picture.astype("f4")).write(str(path))
    # The other first line that the format has is not read everywhere.
    data = path.read_bytes()
    path.write_bytes(data.replace(b"#?RGBE", b"#?RADIANCE", 1))
    written = np.array(mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))
    return float((written @ LUMINANCE * level).sum() / math.pi)
