"""Rigid shapes: each kind, what its constraints say, where it is and was."""

import copy
import gc
import unittest

import numpy as np

import voxtet
from support import box

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
SIDES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


def ball(points):
    lengths = np.linalg.norm(points, axis=1)
    return lengths - 1, points


def moved(x=0.0, y=0.0, z=0.0, scale=1.0):
    return np.column_stack([scale * np.eye(3), [x, y, z]])


class Kinds(unittest.TestCase):
    def test_each(self):
        for shape, point, gap, normal in [
                (voxtet.HalfSpace(), (3, 4, -.25), -.25, (0, 0, 1)),
                (voxtet.Sphere(1), (.5, 0, 0), -.5, (1, 0, 0)),
                (voxtet.Capsule(.5, 1), (.25, 0, 1), -.25, (1, 0, 0)),
                (voxtet.Cylinder(.5, 1), (0, .25, .5), -.25, (0, 1, 0)),
                (voxtet.Box((1, .5, 2)), (0, -.25, 0), -.25, (0, -1, 0)),
                (voxtet.Heightfield([[-.5, -.5, -.5], [-.5, -.5, -.5]], (1, 2)), (1, 1, -.75), -.25, (0, 0, 1)),
                (voxtet.Heightfield(np.full((4, 3), -1)), (1.5, 1.5, -1.25), -.25, (0, 0, 1)),
                (voxtet.Solid(CORNERS, SIDES), (.25, .25, .125), -.125, (0, 0, -1)),
                (voxtet.Solid(CORNERS.tolist(), np.array(SIDES, np.int16)), (.25, .25, .125), -.125, (0, 0, -1)),
                (voxtet.Sheet(CORNERS, SIDES, .25), (.25, .25, -.125), -.125, (0, 0, -1)),
                (voxtet.Polyline([[0, 0, 0], [1, 0, 0], [1, 5, 0]], .25), (.5, 0, -.125), -.125, (0, 0, -1)),
                (voxtet.Field(ball, (1, 1, 1)), (0, .75, 0), -.25, (0, 1, 0))]:
            with self.subTest(shape=shape), voxtet.Grid(constraints=True) as grid:
                body = grid.add_shape(shape, tag="shape", user_data=2**63, transform=moved(x=10))
                points = grid.add(np.array([point, (2, 3, 4)]) + (10, 0, 0))
                grid.step()
                found, = grid.constraints
                self.assertEqual((found.body_a, found.body_b, found.count, found.vertices[0], found.user_data_b),
                                 (points.id, body.id, 1, 0, 2**63))
                self.assertAlmostEqual(found.gap, gap, 12)
                np.testing.assert_allclose(found.normal, normal, atol=1e-12)
                self.assertEqual((grid[found.body_b].tag, grid[found.body_b]), ("shape", body))
                self.assertIsInstance(grid[body.id], voxtet.Shape)
                names = {"Polyline": "SHEET", "HalfSpace": "HALF_SPACE"}
                self.assertEqual(body.kind.name, names.get(type(shape).__name__, type(shape).__name__.upper()))

    def test_what_is_refused(self):
        grid = voxtet.Grid()
        for error, words, shape in [
                (voxtet.InvalidArgumentError, "radius is -1", voxtet.Sphere(-1)), (TypeError, "radius", voxtet.Sphere("1")),
                (voxtet.InvalidArgumentError, "half_size", voxtet.Box(1)), (TypeError, "half_length", voxtet.Capsule(1, None)),
                (voxtet.InvalidArgumentError, r"heights has the shape \(3,\)", voxtet.Heightfield([1, 2, 3])),
                (TypeError, "heights", voxtet.Heightfield([["a"]])),
                (voxtet.InvalidArgumentError, "1 columns", voxtet.Heightfield([[1], [2]])),
                (voxtet.InvalidArgumentError, "spacing", voxtet.Heightfield(np.zeros((2, 2)), (1, 2, 3))),
                (voxtet.InvalidMeshError, "", voxtet.Solid(CORNERS, SIDES[:3])),
                (voxtet.InvalidMeshError, "vertex 9 of 4", voxtet.Sheet(CORNERS, [[0, 1, 9]])),
                (voxtet.InvalidArgumentError, "triangles has the shape", voxtet.Sheet(CORNERS, [[0, 1]])),
                (voxtet.InvalidArgumentError, "triangle_count is 0", voxtet.Polyline([[0, 0, 0]])),
                (TypeError, "function", voxtet.Field(None, (1, 1, 1))), (TypeError, "shape is of type int", 1),
                (TypeError, "shape is of type type", voxtet.Sphere)]:
            with self.subTest(shape=shape), self.assertRaisesRegex(error, words):
                grid.add_shape(shape)
        for name in ("transform", "previous_transform"):
            with self.subTest(name=name), self.assertRaises(voxtet.InvalidArgumentError):
                grid.add_shape(voxtet.Sphere(1), **{name: np.diag([1, 2, 3, 1])})
        self.assertEqual((grid.shapes, len(grid._fields)), ([], 0))


class Bodies(unittest.TestCase):
    def setUp(self):
        self.positions, self.tets = box()
        self.grid = voxtet.Grid(constraints=True)
        self.box = self.grid.add(self.positions, self.tets)
        self.floor = self.grid.add_shape(voxtet.HalfSpace(), transform=moved(z=.1), filter=voxtet.Filter(category=4))

    def test_lists(self):
        self.assertEqual((self.grid.meshes, self.grid.shapes, list(self.grid), len(self.grid)),
                         ([self.box], [self.floor], [self.box], 1))
        self.assertIn(self.floor, self.grid)
        self.assertIn("1 meshes and 1 shapes", repr(self.grid))
        self.assertIn("voxtet.Shape", repr(self.floor))
        self.assertIn("1 meshes", self.grid._repr_html_())
        self.floor.tag = "floor"
        self.assertIn("tag='floor'", repr(self.floor))
        np.testing.assert_array_equal(self.floor.transform, moved(z=.1))
        self.assertEqual(self.floor.filter.category, 4)
        self.grid.clear()
        self.assertEqual(self.grid.shapes, [])

    def test_filters_and_removal(self):
        def count():
            self.grid.step()
            return len(self.grid.constraints)

        self.assertEqual(count(), 25)
        self.floor.filter = voxtet.Filter(category=4, mask=2)
        self.assertEqual(count(), 0)
        self.floor.filter = voxtet.Filter()
        self.floor.enabled = False
        self.assertEqual((count(), self.floor.enabled), (0, False))
        self.floor.enabled = True
        self.assertEqual(count(), 25)
        self.grid.set_pair_enabled(self.floor, self.box, False)
        self.assertEqual(count(), 0)
        self.grid.set_pair_enabled(self.floor, self.box, True)
        self.floor.transform = moved(z=-1)
        self.assertEqual(count(), 0)
        self.floor.transform = None
        self.assertEqual(count(), 25)
        self.assertEqual(len(self.grid.find_constraints(body_a=self.floor)), 25)
        self.floor.remove()
        self.assertEqual((count(), self.floor.valid), (0, False))
        with self.assertRaises(voxtet.InvalidHandleError):
            self.floor.kind

    def test_other_users_of_the_grid(self):
        self.grid.step()
        self.assertGreater(self.grid.suggest_cell_size().cell_size, 0)
        self.assertEqual(len(self.grid.locator().find_closest([[2, 0, 0]])), 1)
        import voxtet.io
        self.assertIn(b"VTKFile", voxtet.io.write(self.grid, "vtu")[:100])

    def test_gaps_and_jacobian(self):
        other, second = self.positions + (.5, .3, .9), self.grid.add(self.positions.astype(float) + (.5, .3, .9), self.tets, copy=True)
        self.grid.set_flags(edges=True)
        self.grid.add_shape(voxtet.Box((.3, .3, .3)), transform=moved(1, 1, 1))
        self.grid.step()
        c = self.grid.constraints
        self.assertEqual(set(c.count_a[c.body_b == self.floor.id]), {1})
        x = np.concatenate([self.positions, other])
        rows = c.rows({self.box: 0, second: len(self.positions)})
        gaps = np.add.reduceat(rows.data * x.ravel()[rows.indices], rows.indptr[:-1]) + c.offset
        np.testing.assert_allclose(gaps, c.gap, atol=1e-6)
        on_floor = np.flatnonzero(c.body_b == self.floor.id)
        np.testing.assert_array_equal(np.diff(rows.indptr)[on_floor], 3)
        with self.assertRaisesRegex(voxtet.InvalidHandleError, f"no body {second.id}"):
            c.rows({self.box: 0, self.floor: 99})

    def test_copies(self):
        with copy.deepcopy(self.grid) as other:
            self.assertEqual([(shape.id, shape.kind) for shape in other.shapes], [(self.floor.id, voxtet.ShapeKind.HALF_SPACE)])
            np.testing.assert_array_equal(other.shapes[0].transform, moved(z=.1))
            for grid in (self.grid, other):
                grid.step()
            self.assertEqual(other.constraints.tobytes(), self.grid.constraints.tobytes())

    def test_borrowed_arrays(self):
        self.grid.step()
        with self.grid.borrowed() as results:
            np.testing.assert_array_equal(results.constraints.count, 1)
            with self.assertRaises(BufferError):
                kept = results.constraints
                self.grid.step()
            del kept


class Adapters(unittest.TestCase):
    def test_floor_of_newton(self):
        """With what voxtet.newton asks of a model and a state."""
        from types import SimpleNamespace
        import voxtet.newton

        positions, tets = box()
        array = SimpleNamespace(numpy=lambda: positions, device=SimpleNamespace(is_cuda=False))
        model = SimpleNamespace(tet_count=len(tets), particle_count=len(positions), tet_indices=SimpleNamespace(numpy=tets.ravel))
        particles = voxtet.newton.Particles(model)
        floor = particles.grid.add_shape(voxtet.HalfSpace(), transform=moved(z=.1))
        found = particles.step(SimpleNamespace(particle_q=array)).find_constraints()
        self.assertEqual((set(found.body_b), set(found.count)), ({floor.id}, {1}))
        np.testing.assert_allclose(found.gap, positions[found.vertices[:, 0], 2] - .1)
        rows = found.rows({particles.mesh: 0}, positions.size)
        force = np.bincount(rows.indices, rows.data * np.repeat(-found.gap, 3), positions.size).reshape(-1, 3)
        np.testing.assert_allclose(force, np.maximum(.1 - positions[:, 2:], 0) * [0, 0, 1], atol=1e-12)


class Motion(unittest.TestCase):
    def test_impacts(self):
        grid = voxtet.Grid(constraints=True)
        grid.add(np.array([[0, 0, 3.0]]))
        shape = grid.add_shape(voxtet.Sphere(.25), transform=moved(z=6), previous_transform=moved())
        grid.step()
        found, = grid.constraints
        self.assertEqual((found.kind, found.count), (voxtet.ConstraintKind.IMPACT, 1))
        self.assertAlmostEqual(found.time, 2.75 / 6, 9)
        shape.set_previous_transform(None)
        grid.step()
        self.assertEqual(len(grid.constraints), 0)
        shape.set_previous_transform(np.eye(4))
        grid.step()
        self.assertEqual(len(grid.constraints), 1)


class Fields(unittest.TestCase):
    def grid_of(self, function, **options):
        grid = voxtet.Grid(constraints=True, **options)
        grid.add(np.random.default_rng(0).uniform(-1, 1, (500, 3)), copy=True)
        return grid, grid.add_shape(voxtet.Field(function, (1, 1, 1)))

    def test_equals_the_sphere(self):
        grid, field = self.grid_of(ball, workers=4)
        gc.collect()  # the function lives as long as the shape
        grid.step()
        of_field = grid.constraints
        field.remove()
        grid.add_shape(voxtet.Sphere(1))
        grid.step()
        np.testing.assert_allclose(of_field.gap, grid.constraints.gap, atol=1e-12)
        self.assertGreater(len(of_field), 200)
        self.assertEqual(grid._fields, {})

    def test_what_it_raises(self):
        def broken(points):
            raise KeyError("here")

        for function, error in [(broken, KeyError), (lambda points: None, TypeError), (lambda points: (points, points), ValueError),
                                (lambda points: (np.full(len(points), np.nan), points), voxtet.NonFiniteError)]:
            for workers in (1, 3):
                grid, field = self.grid_of(function, workers=workers)
                for step in (grid.step, grid.step, lambda: voxtet.step_all([grid])):
                    with self.subTest(error=error, workers=workers), self.assertRaises(error):
                        step()
                field.remove()
                grid.step()

    def test_arrays_are_its_own(self):
        seen = []
        grid, _ = self.grid_of(lambda points: (seen.append(points), ball(points))[1])
        grid.step()
        self.assertTrue(all(len(points) <= 8 and points.flags.owndata for points in seen))
        with self.assertRaisesRegex(voxtet.VoxError, "function cannot be saved"):
            copy.deepcopy(grid)


if __name__ == "__main__":
    unittest.main()
