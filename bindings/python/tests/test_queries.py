"""Questions to a locator, and where points are."""

import threading
import unittest

import numpy as np

import voxtet
from support import GridCase, box


class Questions(GridCase):
    def setUp(self):
        super().setUp()
        self.grid.step()
        self.locator = self.grid.locator()

    def test_points(self):
        ask = self.locator.find_point_hits
        points = np.random.default_rng(1).random((500, 3)) * 1.8
        hits = ask(points)
        positions = {self.a.id: self.first, self.b.id: self.second}
        for hit in hits:
            np.testing.assert_allclose(hit.weights @ positions[hit.body][self.tets[hit.tet]], points[hit.point], atol=1e-12)
        inside = ((points >= 0) & (points <= 1)).all(axis=1)
        np.testing.assert_array_equal(np.unique(hits.point[hits.body == self.a.id]), np.flatnonzero(inside))
        np.testing.assert_array_equal(ask(points[3]).tet, hits.tet[hits.point == 3])
        np.testing.assert_array_equal(ask(np.asfortranarray(points)), hits)
        np.testing.assert_array_equal(ask(points[::-1][::-1]), hits)
        self.assertEqual(len(ask([[0, 0, 0], [9, 9, 9]])), 1)
        self.assertEqual(len(ask(points, mask=2)), 0)
        self.assertEqual(set(ask(points, excluded=self.a).body), {self.b.id})
        self.assertEqual(len(ask(np.zeros((0, 3)))), 0)

    def test_boxes(self):
        ask = self.locator.find_box_hits
        hits = ask([[5, 5, 5], [-np.inf] * 3], [[6, 6, 6], [np.inf] * 3])
        self.assertEqual(len(hits), 2 * len(self.tets))
        self.assertEqual(set(hits.box), {1})
        self.assertEqual(len(ask([0, 0, 0], [2, 2, 2], excluded=self.a)), len(self.tets))
        with self.assertRaises(ValueError):
            ask([1, 1, 1], [0, 0, 0])
        with self.assertRaises(ValueError):
            ask([[1, 1, 1]] * 2, [2, 2, 2])

    def test_closest(self):
        ask = self.locator.find_closest
        hit, = ask([-1, 0.5, 0.5])
        self.assertEqual((hit.body, hit.distance, hit.inside), (self.a.id, 1, 0))
        np.testing.assert_allclose(hit.position, [0, 0.5, 0.5])
        np.testing.assert_allclose(hit.weights @ self.first[hit.face], hit.position, atol=1e-12)
        np.testing.assert_allclose(hit.normal, [-1, 0, 0], atol=1e-6)
        self.assertEqual(ask([[-1, 0.5, 0.5]], max_distance=0.5)[0].body, 0)
        self.assertEqual(ask([[-1, 0.5, 0.5]], excluded=self.a)[0].body, self.b.id)
        self.assertLess(ask([[0.3, 0.3, 0.3]])[0].distance, 0)
        with self.assertRaises(ValueError):
            ask([[0, 0, 0]], max_distance=-1)

    def test_rays(self):
        start, end = [[-1, 0.7, 0.7], [5, 5, 5], [-1, 0.3, 0.3]], [[3, 0.71, 0.72], [6, 6, 6], [3, 0.3, 0.3]]
        ask = self.locator.find_ray_hits
        hits = ask(start, end)
        of_first = hits[hits.ray == 0]
        self.assertEqual(len(of_first), 4)
        self.assertTrue((np.diff(of_first.t) >= 0).all())
        self.assertEqual(len(ask(start[0], end[0], excluded=self.a)), 2)
        firsts = ask(start, end, first=True)
        self.assertEqual(firsts.ray.tolist(), [0, 2])
        hit = firsts[1]
        self.assertEqual((hit.body, hit.side, hit.t), (self.a.id, voxtet.Side.ENTERS, 0.25))
        np.testing.assert_allclose(hit.weights @ self.first[hit.face], [0, 0.3, 0.3], atol=1e-6)
        self.assertEqual(self.locator.test_rays(start, end).tolist(), [True, False, True])
        self.assertEqual(self.locator.test_rays(start[0], end[0], mask=2).tolist(), [False])

    def test_it_stays_until_it_is_updated(self):
        before = self.locator.find_point_hits(self.first)
        self.first += 50
        self.grid.step()
        np.testing.assert_array_equal(self.locator.find_point_hits(self.first - 50), before)
        self.assertEqual((self.locator.epoch, self.locator.user_data(self.a)), (1, 7))
        with self.assertRaises(LookupError):
            self.locator.user_data(99)
        self.locator.update(self.grid)
        self.assertEqual(self.locator.epoch, 2)
        self.assertEqual(set(self.locator.find_point_hits(self.first).body), {self.a.id})

    def test_many_threads_ask(self):
        expected, found = self.locator.find_point_hits(self.first), []

        def ask():
            for _ in range(50):
                found.append((self.locator.find_point_hits(self.first) == expected).all())

        threads = [threading.Thread(target=ask) for _ in range(4)]
        [t.start() for t in threads]
        for _ in range(50):
            self.grid.step()
            self.locator.update(self.grid)
        [t.join() for t in threads]
        self.assertEqual((len(found), all(found)), (200, True))

    def test_wrong_arguments(self):
        ask = self.locator.find_point_hits
        for wrong in ([[0, 0]], np.zeros((2, 2, 3)), [0, 0]):
            with self.assertRaises(ValueError):
                ask(wrong)
        for wrong in ("abc", None, [[None] * 3], np.zeros((2, 3), complex)):
            with self.assertRaises(TypeError):
                ask(wrong)
        with self.assertRaises(voxtet.NonFiniteError):
            ask([[np.nan, 0, 0]])
        with self.assertRaises(ValueError):
            ask([[0, 0, 0]], mask=-1)
        with self.assertRaises(TypeError):
            self.locator.update(self.a)


class Locate(unittest.TestCase):
    def setUp(self):
        self.positions, self.tets = box(6, dtype=np.float64)

    def check(self, located, points):
        for i, point in enumerate(points):
            tet = located.tet[i]
            outside = not ((point >= 0) & (point <= 1)).all()
            self.assertEqual(tet == -1, outside, point)
            if not outside:
                np.testing.assert_allclose(located.weights[i] @ self.positions[self.tets[tet]], point, atol=1e-12)

    def test_interior_and_outside(self):
        points = np.random.default_rng(2).random((300, 3)) * 1.2 - 0.1
        for located in (voxtet.locate(points, self.positions, self.tets), voxtet.Locator(self.positions, self.tets).locate(points)):
            self.check(located, points)

    def test_facets_edges_and_corners(self):
        """Each is in the lowest tetrahedron that it belongs to."""
        located = voxtet.locate(self.positions, self.positions, self.tets)
        for vertex, tet in enumerate(located.tet):
            self.assertEqual(tet, np.flatnonzero((self.tets == vertex).any(axis=1))[0])
        # Corners are multiples of 1/8, so that a point of weights 1/4, 1/4, 1/2 is exactly on its facet.
        positions, tets = box(4, dtype=np.float64)
        facets = np.sort(tets[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]], axis=-1)
        weights = np.array([0.25, 0.25, 0.5])
        points = np.einsum("tfcx,c->tfx", positions[facets], weights).reshape(-1, 3)
        owner = {}
        for tet, four in enumerate(facets):
            for facet in four:
                owner.setdefault(tuple(facet), tet)
        located = voxtet.locate(points, positions, tets)
        np.testing.assert_array_equal(located.tet, [owner[tuple(f)] for f in facets.reshape(-1, 3)])

    def test_grid_and_locator(self):
        points = np.random.default_rng(3).random((50, 3))
        with voxtet.Grid() as grid:
            mesh = grid.add(self.positions, self.tets)
            for located in (voxtet.locate(points, grid), voxtet.locate(points, grid.locator())):
                self.check(located, points)
                self.assertEqual(set(located.body), {mesh.id})
            self.check(voxtet.locate(points, mesh), points)
        self.check(voxtet.locate(points[0], self.positions, self.tets), points[:1])

    def test_a_mesh_of_a_grid_is_taken_as_it_collides(self):
        with voxtet.Grid() as grid:
            mesh = grid.add(self.positions.astype(np.float32), self.tets)
            mesh.transform = np.array([[.3, -.9, .1, 7], [.7, .2, -.3, .1], [.1, .4, 1.1, -3]])
            mesh.remove_tets([0, 3])
            mesh.set_tets_enabled([5], False)
            corners, _, there = mesh._as_it_collides()
            mesh.append_tets([self.tets[0]])  # the index of the removed one is not reused
            points = np.einsum("tcx,c->tx", corners[self.tets], [.2, .3, .4, .1])
            found = voxtet.locate(points, mesh)
            expected = np.where(there, np.arange(len(self.tets)), -1)
            expected[0] = len(self.tets)
            np.testing.assert_array_equal(found.tet, expected)
            on_facets = corners[self.tets].mean(axis=1) / 2 + corners[self.tets[:, 0]] / 2
            for those in (points, on_facets, corners):
                mine, grids = voxtet.locate(those, mesh), voxtet.locate(those, grid)
                np.testing.assert_array_equal(mine.tet, grids.tet)
                np.testing.assert_array_equal(mine.weights, grids.weights)

    def test_unknown(self):
        with self.assertRaises(TypeError):
            voxtet.locate([[0, 0, 0]], "mesh")


if __name__ == "__main__":
    unittest.main()
