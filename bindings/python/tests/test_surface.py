"""Pairs of surface features, against loops in numpy."""

import doctest
import unittest

import numpy as np

import voxtet
from voxtet import surface as module
from voxtet.surface import Surface


def cloud(seed, count=60):
    random = np.random.default_rng(seed)
    start = random.random((count, 3))
    faces = random.integers(0, count, (count, 3))
    return start, start + random.random((count, 3)) / 10 - 0.05, faces


def boxes(start, end, corners, radius):
    low = np.nextafter(np.minimum(start, end) - radius, -np.inf)[corners].min(axis=1)
    high = np.nextafter(np.maximum(start, end) + radius, np.inf)[corners].max(axis=1)
    return low, high


def by_definition(start, end, a, b, radius, same):
    (low_a, high_a), (low_b, high_b) = boxes(start, end, a, radius), boxes(start, end, b, radius)
    found = []
    for i in range(len(a)):
        near = ((low_a[i] <= high_b) & (low_b <= high_a[i])).all(axis=1)
        near &= ~(a[i][:, None, None] == b.T[None]).any(axis=(0, 1))
        if same:
            near[:i + 1] = False
        found.append(np.flatnonzero(near).tolist())
    return found


class Pairs(unittest.TestCase):
    def test_pairs_are_those_whose_boxes_overlap(self):
        for seed in range(5):
            start, end, faces = cloud(seed)
            surface = Surface(faces, vertex_count=len(start), workers=2)
            features = {"vertex": np.arange(len(start))[:, None], "edge": surface.edges, "face": surface.faces}
            for order in ("C", "F"):
                surface.move(np.array(start, order=order), np.array(end, order=order), radius=0.01)
                for a, corners_a in features.items():
                    for b, corners_b in features.items():
                        expected = by_definition(start, end, corners_a, corners_b, 0.01, a == b)
                        found = surface.pairs(a, b)
                        self.assertEqual([found.partners[i:j].tolist() for i, j in zip(found.offsets, found.offsets[1:])],
                                         expected)
                        self.assertEqual(found.array().tolist(), [[i, j] for i, js in enumerate(expected) for j in js])

    def test_floats_and_doubles_together(self):
        start, end, faces = cloud(1)
        surface = Surface(faces, vertex_count=len(start))
        start = start.astype(np.float32)
        surface.move(start, end)
        mixed = surface.pairs("face", "vertex").partners
        surface.move(start.astype(float), end)
        self.assertEqual(mixed.tolist(), surface.pairs("face", "vertex").partners.tolist())

    def test_pieces(self):
        start, end, faces = cloud(2, 3000)
        whole = Surface(faces)
        whole.move(start, end, radius=0.05)
        expected = whole.pairs("vertex", "vertex")
        tight = Surface(faces, byte_budget=whole.counters["peak_bytes"] * 3 // 4)
        tight.move(start, end, radius=0.05)
        self.assertGreater(len(list(tight.pieces("vertex", "vertex"))), 1)
        for one, other in zip(expected, tight.pairs("vertex", "vertex")):
            self.assertEqual(one.tolist(), other.tolist())

    def test_culling(self):
        start, end, faces = cloud(3)
        surface = Surface(faces, vertex_count=len(start))
        surface.move(start, end, cull=True)
        kept = {tuple(pair) for pair in surface.pairs("edge", "edge").array().tolist()}
        counters = surface.counters
        surface.move(start, end)
        pairs = {tuple(pair) for pair in surface.pairs("edge", "edge").array().tolist()}
        self.assertLess(kept, pairs)
        self.assertEqual((counters["overlaps"], counters["culled"]), (len(pairs), len(pairs) - len(kept)))

    def test_patches(self):
        start, _, faces = cloud(4)
        surface = Surface(faces, vertex_count=len(start), patches=np.zeros(len(start), int), patch_masks=[0])
        surface.move(start)
        self.assertEqual(len(surface.pairs("face", "face").partners), 0)

    def test_suggested_cell_size(self):
        start, end, faces = cloud(4)
        surface = Surface(faces, vertex_count=len(start))
        with self.assertRaises(voxtet.InvalidStateError):
            surface.suggest_cell_size("face", "vertex")
        surface.move(start, end)
        s = surface.suggest_cell_size("face", "vertex")
        self.assertTrue(0 < s.zone[0] <= s.cell_size <= s.zone[1])
        self.assertAlmostEqual(s.terms.cost.sum() / s.cost, 1, 6)
        again = Surface(faces, vertex_count=len(start), cell_size=s.cell_size)
        again.move(start, end)
        self.assertEqual(again.pairs("face", "vertex").array().tolist(), surface.pairs("face", "vertex").array().tolist())
        with self.assertRaises(ValueError):
            surface.suggest_cell_size("tet", "vertex")


class Lists(unittest.TestCase):
    def test_a_triangle_falls_through_another(self):
        start = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.1, 0.1, 1], [0.2, 0.1, 1], [0.1, 0.2, 2]])
        surface = Surface([[0, 1, 2], [3, 4, 5]])
        self.assertEqual(surface.faces.tolist(), [[0, 1, 2], [3, 4, 5]])
        surface.move(start, start - 1.5 * (np.arange(6) > 2)[:, None] * [0, 0, 1])
        crossings = surface.crossings()
        self.assertEqual(crossings["face"].tolist(), [0, 0])
        self.assertEqual(surface.edges[crossings["edge"]].tolist(), [[3, 5], [4, 5]])
        np.testing.assert_allclose(crossings["position"][0], [0.1, 0.15, 0])
        near = surface.proximities("face", "vertex", 0.5)
        self.assertEqual(near[["a", "b"]].tolist(), [(0, 3), (0, 4), (0, 5), (1, 0)])
        np.testing.assert_allclose(near["distance"][:3], 0.5)
        np.testing.assert_allclose(surface.clearances(1)[[3, 5]], 0.05) # half of the way from the edge at x = 0
        impacts = surface.impacts("face", "vertex", slack=1e-6)
        self.assertEqual(impacts[["a", "b"]].tolist(), [(0, 3), (0, 4)])
        np.testing.assert_allclose(impacts["time"], 2 / 3, rtol=1e-5)
        step = surface.safe_step(slack=1e-6)
        self.assertEqual((step.kind_a.name, step.kind_b.name, step.a, step.step), ("FACE", "VERTEX", 0, impacts["time"].min()))
        self.assertLess(surface.safe_step(0.1).step, step.step)


class Refused(unittest.TestCase):
    def test_arguments(self):
        start, _, faces = cloud(5)
        surface = Surface(faces, vertex_count=len(start))
        with self.assertRaisesRegex(voxtet.InvalidStateError, "no positions"):
            surface.pairs("edge", "edge")
        with self.assertRaisesRegex(voxtet.InvalidArgumentError, "59"):
            surface.move(start[:-1])
        with self.assertRaisesRegex(voxtet.NonFiniteError, "vertex 7"):
            surface.move(np.where(np.arange(60)[:, None] == 7, np.nan, start))
        with self.assertRaisesRegex(voxtet.InvalidArgumentError, "'tet'"):
            surface.pairs("tet", "edge")
        with self.assertRaisesRegex(voxtet.InvalidMeshError, "vertex 9 of 4"):
            Surface([[0, 1, 9]], vertex_count=4)
        with self.assertRaisesRegex(voxtet.InvalidArgumentError, "patches"):
            Surface(faces, patch_masks=[1])


def load_tests(loader, tests, _pattern):
    tests.addTests(doctest.DocTestSuite(module))
    return tests


if __name__ == "__main__":
    unittest.main()
