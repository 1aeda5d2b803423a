"""Bodies and surfaces that overlap are moved apart."""

import unittest

import numpy as np

import voxtet
import voxtet.io
from voxtet import sim
from voxtet.surface import Surface

GAP = 1e-3


def ball(radius=1.0, cell=0.25, at=(0, 0, 0)):
    mesh = voxtet.io.make_ball(radius, cell)
    return mesh.positions + np.asarray(at, float), mesh.tets


def outside_of(tets):
    facets = np.vstack([tets[:, k] for k in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    _, first, count = np.unique(np.sort(facets, axis=1), axis=0, return_index=True, return_counts=True)
    return facets[first[count == 1]]


def sheet(count):
    x, y = np.meshgrid(np.linspace(0, 1, count), np.linspace(0, 1, count), indexing="ij")
    at = np.arange(count * count).reshape(count, count)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    return np.c_[x.ravel(), y.ravel(), 0 * x.ravel()], np.r_[np.c_[a, b, c], np.c_[a, c, d]]


def folded(count):
    """A sheet whose half comes back over the other half, and through it at its end."""
    p, faces = sheet(count)
    radius = 0.05
    flat = (1 - np.pi * radius) / 2
    s, turn = p[:, 0], (p[:, 0] - flat) / radius
    back = np.clip((s - flat - np.pi * radius) / flat, 0, 1)
    x = np.where(turn < 0, s, np.where(turn < np.pi, flat + radius * np.sin(turn), flat * (1 - back)))
    z = np.where(turn < 0, 0, np.where(turn < np.pi, radius * (1 - np.cos(turn)), 2 * radius)) - 0.13 * back ** 2
    return np.c_[x, p[:, 1], z], faces


class Resolve(unittest.TestCase):
    def check_free(self, bodies, done, gap=GAP):
        """By surfaces that share no code with the repair but the search for pairs."""
        self.assertTrue(done.resolved, done)
        self.assertEqual(len(done.left), 0)
        faces, first = [], 0
        for (_, cells), positions in zip(bodies, done.positions):
            faces.append(first + (outside_of(cells) if cells.shape[1] == 4 else cells))
            first += len(positions)
        surface = Surface(np.vstack(faces), vertex_count=first)
        surface.move(np.vstack(done.positions))
        self.assertEqual(len(surface.crossings()), 0)
        for a, b in (("face", "vertex"), ("edge", "edge")):
            self.assertEqual(len(surface.proximities(a, b, gap * (1 - 1e-9))), 0)

    def test_two_balls(self):
        for cells in (lambda tets: tets, outside_of):
            bodies = [(p, cells(t)) for p, t in (ball(), ball(at=(1.7, 0.2, 0.1)))]
            done = sim.resolve(bodies, gap=GAP)
            self.check_free(bodies, done)
            self.assertGreater(done.first_crossings, 0)
            self.assertLess(done.largest_move, 2 * done.first_depth)
            for before, after in done.volumes:
                self.assertAlmostEqual(after / before, 1, delta=0.01)
            self.assertEqual(done.inverted_tets, [0, 0])

    def test_nested(self):
        bodies = [ball(), ball(0.2, 0.1, (0.3, 0.1, 0))]
        done = sim.resolve(bodies, gap=GAP)
        self.assertEqual(done.first_crossings, 0)
        self.assertGreater(done.first_depth, 0)
        self.check_free(bodies, done)
        self.assertGreater(np.linalg.norm(done.positions[1].mean(0) - done.positions[0].mean(0)), 1)

    def test_fixed(self):
        bodies = [ball(), ball(at=(1.7, 0.2, 0.1))]
        done = sim.resolve(bodies, gap=GAP, fixed=[1])
        self.check_free(bodies, done)
        self.assertTrue((done.positions[1] == bodies[1][0]).all())
        both = sim.resolve(bodies, gap=GAP, fixed=[0, 1])
        self.assertFalse(both.resolved)
        self.assertEqual((both.crossings, both.largest_move), (both.first_crossings, 0))

    def test_cloth(self):
        bodies = [folded(30)]
        self.check_free(bodies, voxtet.resolve(bodies, gap=GAP))
        cloth, faces = sheet(30)
        bodies = [ball(), (3 * cloth - [1.5, 1.5, -0.9], faces)]
        done = sim.resolve(bodies, gap=GAP, fixed=[0])
        self.check_free(bodies, done)

    def test_a_limit_that_is_too_small(self):
        bodies = [ball(), ball(at=(1.7, 0.2, 0.1))]
        done = sim.resolve(bodies, gap=GAP, max_move=0.01, places=5)
        self.assertFalse(done.resolved)
        self.assertLessEqual(done.largest_move, 0.01 * (1 + 1e-12))
        self.assertGreater(done.crossings, 5)
        self.assertEqual(len(done.left), 5)
        for place in done.left:
            self.assertEqual((place["distance"], {place["body_a"], place["body_b"]}), (0, {0, 1}))
            self.assertLess(np.linalg.norm(place["position"]), 1.1)

    def test_nothing_to_do(self):
        bodies = [ball(), ball(at=(3, 0, 0))]
        done = sim.resolve(bodies, gap=GAP)
        self.assertEqual((done.resolved, done.iterations, done.largest_move), (True, 0, 0))

    def test_the_same_bits(self):
        bodies = [ball(), ball(at=(1.5, 0.2, 0.1)), folded(20)]
        first = sim.resolve(bodies, gap=GAP)
        for workers in (2, 5):
            again = sim.resolve(bodies, gap=GAP, workers=workers)
            self.assertEqual([p.tobytes() for p in first.positions], [p.tobytes() for p in again.positions])

    def test_bad_input(self):
        p, tets = ball()
        for bodies, options, words in (
                ([], {}, "no bodies"), ([(p, tets)], {"gap": -1}, "gap is -1"), ([(p, tets)], {"max_move": np.inf}, "max_move is inf"),
                ([(p, tets + 1)], {}, f"names vertex {len(p)} of {len(p)}"), ([(p, tets[:, :2])], {}, "cells have the shape"),
                ([(p, tets)], {"fixed": [1]}, "fixed names body 1 of 1"), ([(p, outside_of(tets) * 0)], {}, "no area"),
                ([(np.where(p == p[0], np.nan, p), tets)], {}, "coordinate x of vertex 0 is nan")):
            with self.assertRaises(voxtet.VoxError, msg=words) as raised:
                sim.resolve(bodies, **options)
            self.assertIn(words, str(raised.exception))


if __name__ == "__main__":
    unittest.main()
