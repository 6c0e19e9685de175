"""Particles from files: classic .bgeo (gzip or not), legacy binary .vtk, .vtu, .npy and .npz; or a calm pool of them."""
import gzip
import struct

import numpy as np


def read(path, scale=1.0, up="y"):
    """Finite positions, (N, 3), double precision, y up, in metres: a file's unit of length has `scale` of them."""
    path = str(path)
    if path.endswith(".npy"):
        points = np.load(path)
    elif path.endswith(".npz"):
        points = np.load(path)["position"]
    elif path.endswith(".vtu"):
        import meshio

        points = meshio.read(path).points
    else:
        with open(path, "rb") as file:
            data = file.read()
        if data[:2] == b"\x1f\x8b":
            data = gzip.decompress(data)
        points = _vtk(data) if path.endswith(".vtk") else _bgeo(data, path)
    points = scale * np.asarray(points, "f8")[:, :3]
    if up == "z":
        points = points[:, [0, 2, 1]] * [1.0, 1.0, -1.0]  # as the tool turns them: right-handed
    return points[np.isfinite(points).all(axis=1)]


def _vtk(data):
    begin = data.index(b"POINTS")
    end = data.index(b"\n", begin) + 1
    _, count, kind = data[begin:end].split()
    kind = {b"float": ">f4", b"double": ">f8"}[kind]
    return np.frombuffer(data, kind, 3 * int(count), end).reshape(-1, 3)


def _bgeo(data, path):
    if data[:5] != b"BgeoV":
        raise ValueError(f"{path}: expected a classic .bgeo")
    _, count, _, _, _, attributes, _, _, _ = struct.unpack_from(">9i", data, 5)
    at, width = 41, 4  # a position has four numbers
    for _ in range(attributes):
        (length,) = struct.unpack_from(">H", data, at)
        size, kind = struct.unpack_from(">Hi", data, at + 2 + length)
        at, width = at + 8 + length, width + size
        if kind == 4:  # an index into strings
            (strings,) = struct.unpack_from(">i", data, at)
            at += 4
            for _ in range(strings):
                (length,) = struct.unpack_from(">H", data, at)
                at += 2 + length
        else:
            at += 4 * size  # its default
    return np.frombuffer(data, ">f4", count * width, at).reshape(count, width)


def pool(radius, box, level, waves):
    """A lattice that fills a box up to a level, its surface raised by waves of so many metres, a little out of order."""
    spacing = 2 * radius
    low, high = np.array(box[0::2], "f8"), np.array([box[1], level, box[5]])
    axes = [np.arange(a + radius, b - 0.5 * radius, spacing) for a, b in zip(low, high)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    x, z = points[:, 0], points[:, 2]
    rise = np.sin(5 * x + 2 * z) + 0.7 * np.sin(8 * z - 3 * x + 1) + 0.4 * np.sin(13 * x + 9 * z)
    points[:, 1] += 0.5 * waves * rise * (points[:, 1] - low[1]) / (level - low[1])
    return points + np.random.default_rng(1).normal(0, 0.04 * radius, points.shape)
