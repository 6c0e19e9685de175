"""python3 -m unittest discover research/compare: needs NumPy alone."""
import pathlib
import struct
import tempfile
import types
import unittest

import numpy as np

import compare
import flicker
import particles
import scene


class Particles(unittest.TestCase):
    def test_units_and_up(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.npz"
            np.savez(path, position=np.array([[1.0, 2.0, 3.0], [np.nan, 0.0, 0.0]]))
            np.testing.assert_allclose(particles.read(path), [[1, 2, 3]])
            np.testing.assert_allclose(particles.read(path, scale=0.1, up="z"), [[0.1, 0.3, -0.2]])

    def test_bgeo(self):
        # Two points of one float attribute.
        head = b"BgeoV" + struct.pack(">9i", 5, 2, 0, 0, 0, 1, 0, 0, 0)
        kind = struct.pack(">H", 4) + b"mass" + struct.pack(">Hi", 1, 0) + struct.pack(">f", 0.0)
        rows = struct.pack(">10f", 1, 2, 3, 1, 9, 4, 5, 6, 1, 9)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.bgeo"
            path.write_bytes(head + kind + rows)
            np.testing.assert_allclose(particles.read(path), [[1, 2, 3], [4, 5, 6]])


class Scene(unittest.TestCase):
    def test_walls_stand_by_the_water_or_by_the_box(self):
        # Water fills the box but for its right half.
        points = particles.pool(0.02, [-1.0, 0.0, 0.0, 1.0, -0.5, 0.5], level=0.3, waves=0.0)
        meshes = scene.basin(points, 0.02, [-1.0, 1.0, 0.0, 1.0, -0.5, 0.5], eye=[2, 2, 2])
        left, right = (mesh.positions[:, 0] for mesh in meshes[1:3])
        self.assertLess(abs(left.max() + 1.0), 0.02)
        self.assertAlmostEqual(right.min(), 1.0, places=6)

    def test_box(self):
        box = scene.solid("box", low=[0, 0, 0], high=[1, 2, 3])
        np.testing.assert_allclose([box.positions.min(0), box.positions.max(0)], [[0, 0, 0], [1, 2, 3]])


class Kept(unittest.TestCase):
    def test_signature_tells_what_changed(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scene"
            file.write_bytes(b"a")
            points = np.zeros((2, 3))
            first = compare.signature([file], points, [96])
            self.assertEqual(first, compare.signature([file], points, [96]))
            self.assertNotEqual(first, compare.signature([file], points, [64]))
            self.assertNotEqual(first, compare.signature([file], points + 1, [96]))
            file.write_bytes(b"b")
            self.assertNotEqual(first, compare.signature([file], points, [96]))


class Page(unittest.TestCase):
    def test_rows(self):
        one = {"flip": 0.25, "mean": [0.2, 0.1], "deviation": [0.4, 0.5], "dry": {"flip": 0.1}, "pixels": 100, "lost": 5, "extra": 1, "made": "with X"}
        options = types.SimpleNamespace(variant=[["water", "--spray none"], ["default", ""]], made="with X")
        frames = {"pool": {"of": "made here", "first": {"flip": 0.5, "light": 2.0}}, "late_dam": {"of": "X"}}
        whole, compare.versions = compare.versions, lambda: {"mitsuba": "3"}
        try:
            text = compare.page({"pool": {"water": one, "default": one}}, frames, options)
            mixed = compare.page({"pool": {"water": one | {"made": "with Y"}, "default": one}}, frames, options)
        finally:
            compare.versions = whole
        self.assertNotIn("with Y", text)
        self.assertIn("*pool*, variant *water*, was drawn with Y.", mixed)
        self.assertIn("| pool | made here | 0.250 | 0.250 | 0.200 | 0.100 | 0.100 | 0.400 | 0.500 | 0.500 | 0.500 |", text)
        self.assertIn("| pool | 0.50 | 0.50 | 1.25 | 1.25 | 2.00 | 0.050, 0.010 | 0.100 |", text)
        self.assertNotIn("late_dam", text)


def sequence(picture, count=9):
    """Frames of a picture of (row, column, frame), all of it still water in the left half."""
    rows, columns = 40, 80
    y, x = np.mgrid[:rows, :columns].astype("f4")
    wet = x < 40
    frames = []
    for k in range(count):
        image = np.asarray(picture(y, x, k), "f4") + np.zeros_like(x)
        frames.append(types.SimpleNamespace(wet=wet, motion=np.zeros_like(x), vectors=np.zeros((rows, columns, 2)), pictures={n: image for n in ("default", "water", "particles", "surface")}))
    return frames


class Flicker(unittest.TestCase):
    def test_grown(self):
        mask = np.zeros((9, 9), bool)
        mask[4, 4] = mask[0, 8] = True
        wide = flicker.grown(mask, 2)
        self.assertTrue(wide[2:7, 2:7].all() and wide[0:3, 6:9].all())
        self.assertEqual(wide.sum(), 25 + 9 - 1)

    def test_shaded(self):
        # A plane across the view is brightest; one that leans by 45 degrees has its cosine in the middle.
        flat = flicker.shaded(np.full((32, 32), 2.0), 36.0)
        self.assertAlmostEqual(flat[16, 16], 255, delta=1)
        scale = 2 * np.tan(np.radians(18)) / 32
        slope = (np.arange(32) - 15.5) * scale
        leaning = flicker.shaded(np.tile(2.0 / (1 - slope), (32, 1)), 36.0)
        self.assertAlmostEqual(leaning[16, 16], 255 * np.sqrt(0.5), delta=6)

    def test_followed(self):
        picture = np.random.default_rng(4).random((20, 30))
        vectors = np.zeros((20, 30, 2)) + [3.0, -2.0]
        moved = flicker.followed(picture, vectors)
        np.testing.assert_allclose(moved[:-2, 3:], picture[2:, :-3])
        half = flicker.followed(picture, np.zeros((20, 30, 2)) + [0.5, 0.0])
        np.testing.assert_allclose(half[:, 1:], (picture[:, 1:] + picture[:, :-1]) / 2)

    def test_what_moves_steadily_does_not_flicker(self):
        numbers, _ = flicker.measure(sequence(lambda y, x, k: 100 + 2 * k))
        self.assertEqual(numbers["still water"]["change"]["default"], 0)
        self.assertEqual(numbers["still water"]["step"], 2)

    def test_a_pop_is_found(self):
        def picture(y, x, k):
            return 100 + 0.2 * (k % 2) * (y % 3) + 12 * (k == 5)

        frames = sequence(picture)
        for k, frame in enumerate(frames):
            frame.pictures["surface"] = 0 * frame.pictures["surface"] + 100 + 0.2 * (k % 2)
        numbers, worst = flicker.measure(frames)
        for kind in ("still water", "background"):
            self.assertEqual(numbers[kind]["pop frame"], 5)
            self.assertGreater(numbers[kind]["pop"], 5)
            self.assertEqual(worst[kind][1], 5)

    def test_kinds_of_pixels_do_not_meet(self):
        frames = sequence(lambda y, x, k: 0)
        frames[4].motion = np.where((frames[4].wet.cumsum(1) < 10), 1.0, 0.0)
        of_kind = flicker.kinds(*frames[3:6])
        total = sum(mask.astype(int) for mask in of_kind.values())
        self.assertEqual(total.max(), 1)
        self.assertGreater(of_kind["moving water"].sum(), 0)
        # The frame before the three does not count.
        self.assertEqual(flicker.kinds(*frames[4:7])["moving water"].sum(), 0)


if __name__ == "__main__":
    unittest.main()
