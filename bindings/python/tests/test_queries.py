"""Queries of a grid and of views, and where points are."""

import threading
import unittest

import numpy as np

import voxtet
from support import GridCase, box


class Queries(GridCase):
    def setUp(self):
        super().setUp()
        self.grid.step()
        self.grid.prepare_queries()
        self.view = self.grid.query_view()

    def test_points(self):
        points = np.random.default_rng(1).random((500, 3)) * 1.8
        for asked in (self.grid, self.view):
            hits = asked.query_points(points)
            positions = {self.a.id: self.first, self.b.id: self.second}
            for hit in hits:
                corners = positions[hit.mesh][self.tets[hit.tet]]
                np.testing.assert_allclose(hit.barycentric @ corners, points[hit.point], atol=1e-6)
            inside = ((points >= 0) & (points <= 1)).all(axis=1)
            np.testing.assert_array_equal(np.unique(hits.point[hits.mesh == self.a.id]), np.flatnonzero(inside))
            one = asked.query_points(points[3])
            np.testing.assert_array_equal(one.tet, hits.tet[hits.point == 3])
            np.testing.assert_array_equal(asked.query_points(np.asfortranarray(points)), hits)
            np.testing.assert_array_equal(asked.query_points(points[::-1][::-1]), hits)
            self.assertEqual(len(asked.query_points([[0, 0, 0], [9, 9, 9]])), 1)
            self.assertEqual(len(asked.query_points(points, mask=2)), 0)
            self.assertEqual(len(asked.query_points(np.zeros((0, 3)))), 0)

    def test_box(self):
        for asked in (self.grid, self.view):
            self.assertEqual(len(asked.query_box([-np.inf] * 3, [np.inf] * 3)), 2 * len(self.tets))
            self.assertEqual(len(asked.query_box([5, 5, 5], [6, 6, 6])), 0)
            with self.assertRaises(ValueError):
                asked.query_box([1, 1, 1], [0, 0, 0])

    def test_closest(self):
        for asked in (self.grid, self.view):
            hit, = asked.query_closest([-1, 0.5, 0.5])
            self.assertEqual((hit.mesh, hit.distance, hit.inside), (self.a.id, 1, 0))
            np.testing.assert_allclose(hit.position, [0, 0.5, 0.5])
            np.testing.assert_allclose(hit.normal, [-1, 0, 0], atol=1e-6)
            self.assertEqual(asked.query_closest([[-1, 0.5, 0.5]], max_distance=0.5)[0].mesh, 0)
            self.assertEqual(asked.query_closest([[-1, 0.5, 0.5]], excluded=self.a)[0].mesh, self.b.id)
            self.assertLess(asked.query_closest([[0.3, 0.3, 0.3]])[0].distance, 0)
            with self.assertRaises(ValueError):
                asked.query_closest([[0, 0, 0]], max_distance=-1)

    def test_rays(self):
        for asked in (self.grid, self.view):
            hit = asked.query_ray([-1, 0.3, 0.3], [3, 0.3, 0.3])
            self.assertEqual((hit.mesh, hit.surface_mesh, hit.surface_side), (self.a.id, self.a.id, voxtet.Side.ENTERS))
            self.assertEqual(hit.surface_t, 0.25)
            self.assertEqual(asked.query_ray([5, 5, 5], [6, 6, 6]).mesh, 0)
            hits = asked.query_ray_hits([-1, 0.7, 0.7], [3, 0.71, 0.72])
            self.assertEqual(len(hits), 4)
            self.assertTrue((np.diff(hits.t) >= 0).all())
            self.assertEqual(len(asked.query_ray_hits([-1, 0.7, 0.7], [3, 0.71, 0.72], excluded=self.a)), 2)
            self.assertIs(asked.query_ray_any([-1, 0.3, 0.3], [3, 0.3, 0.3]), True)
            self.assertIs(asked.query_ray_any([5, 5, 5], [6, 6, 6]), False)

    def test_view_stays(self):
        before = self.view.query_points(self.first)
        self.first += 50
        self.grid.step()
        np.testing.assert_array_equal(self.view.query_points(self.first - 50), before)
        self.assertEqual((self.view.epoch, self.view.user_data(self.a)), (1, 7))
        with self.assertRaises(LookupError):
            self.view.user_data(99)

    def test_views_are_asked_by_many_threads(self):
        expected, found = self.view.query_points(self.first), []

        def ask():
            for _ in range(50):
                found.append((self.view.query_points(self.first) == expected).all())

        threads = [threading.Thread(target=ask) for _ in range(4)]
        [t.start() for t in threads]
        for _ in range(50):
            self.grid.step()
        [t.join() for t in threads]
        self.assertEqual((len(found), all(found)), (200, True))

    def test_not_prepared(self):
        with voxtet.Grid() as grid, self.assertRaises(voxtet.InvalidStateError):
            grid.query_points([[0, 0, 0]])

    def test_wrong_points(self):
        for wrong in ([[0, 0]], np.zeros((2, 2, 3)), [0, 0]):
            with self.assertRaises(ValueError):
                self.grid.query_points(wrong)
        for wrong in ("abc", None, [[None] * 3], np.zeros((2, 3), complex)):
            with self.assertRaises(TypeError):
                self.grid.query_points(wrong)
        with self.assertRaises(voxtet.NonFiniteError):
            self.grid.query_points([[np.nan, 0, 0]])
        with self.assertRaises(ValueError):
            self.grid.query_points([[0, 0, 0]], mask=-1)


class Locate(unittest.TestCase):
    def setUp(self):
        self.positions, self.tets = box(6, dtype=np.float64)

    def check(self, located, points):
        for i, point in enumerate(points):
            tet = located.tet[i]
            outside = not ((point >= 0) & (point <= 1)).all()
            self.assertEqual(tet == -1, outside, point)
            if not outside:
                np.testing.assert_allclose(located.barycentric[i] @ self.positions[self.tets[tet]], point, atol=1e-6)

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

    def test_grid_and_view(self):
        points = np.random.default_rng(3).random((50, 3))
        with voxtet.Grid() as grid:
            mesh = grid.add(self.positions, self.tets)
            with grid.query_view() as view:
                for located in (voxtet.locate(points, grid), voxtet.locate(points, view)):
                    self.check(located, points)
                    self.assertEqual(set(located.mesh), {mesh.id})
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
                np.testing.assert_array_equal(mine.barycentric, grids.barycentric)

    def test_unknown(self):
        with self.assertRaises(TypeError):
            voxtet.locate([[0, 0, 0]], "mesh")


if __name__ == "__main__":
    unittest.main()
