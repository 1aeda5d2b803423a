"""Cell sizes of grids that are not the library's: what they store, timings, runs."""

import math
import mmap
import signal
import threading
import time
import unittest
import warnings
from types import SimpleNamespace

import numpy as np

import voxtet
from support import box
from voxtet import CellSizeWarnings, ForeignGrid, ForeignWeights, Primitives, _c, tune

CLOUD = np.random.default_rng(7).random((500, 3))


def cells_in_common(low_a, high_a, low_b, high_b, size):
    """How many, on average over all positions of the cells, of two boxes: 1 - gap / size along each axis, or 0."""
    gaps = np.maximum(low_a, low_b) - np.minimum(high_a, high_b)
    return np.maximum(1 - gaps / size, 0).prod(axis=-1)


class Stored(unittest.TestCase):
    """What a grid stores, in all its forms."""

    def same(self, one, other):
        one, other = ForeignGrid(one).suggest(), ForeignGrid(other).suggest()
        self.assertEqual(one.cell_size, other.cell_size)
        self.assertEqual(one.terms.tolist(), other.terms.tolist())

    def test_counts_are_those_of_all_pairs(self):
        low = np.random.default_rng(3).random((60, 3))
        high = low + np.random.default_rng(4).random((60, 3)) / 4
        for size in (0.05, 0.2, 1.0):
            for radius in (0.0, 0.1):
                counts = ForeignGrid(Primitives.boxes(low, high), radius=radius).count(size)
                stored = ((high - low) / size + 1).prod(axis=1)
                pairs = cells_in_common(low[:, None] - radius, high[:, None] + radius, low, high, size)
                np.fill_diagonal(pairs, stored)  # each finds itself in its own cells
                np.testing.assert_allclose(counts.stored, stored.sum(), rtol=1e-6)
                np.testing.assert_allclose(counts.visits, ((high - low + 2 * radius) / size + 1).prod(axis=1).sum(), rtol=1e-6)
                np.testing.assert_allclose(counts.reads, pairs.sum(), rtol=0.05)

    def test_elements(self):
        p, tets = box(4)
        triangles, edges = tets[:, :3], tets[:, :2]
        for indices in (tets, triangles, edges):
            corners = p[indices]
            as_boxes = Primitives.boxes(corners.min(axis=1), corners.max(axis=1))
            found = ForeignGrid((p, indices)).count(0.1)
            np.testing.assert_allclose(found, ForeignGrid(as_boxes).count(0.1), rtol=1e-5)
            self.same((p, indices), (p.astype(np.float64), indices.astype(np.int64)))
            self.same((p, indices), Primitives(p, indices.tolist()))
            self.same((p, indices), Primitives(np.asfortranarray(p), indices))
        mean_edge = ForeignGrid((p, edges)).suggest().rules.cell_size[0]
        self.assertAlmostEqual(mean_edge, np.linalg.norm(np.diff(p[edges], axis=1), axis=2).mean(), 1)

    def test_strides_are_borrowed(self):
        wide = np.zeros((len(CLOUD), 7))
        wide[:, 2:5] = CLOUD
        stored = Primitives(wide[:, 2:5])
        self.assertEqual(stored._struct.positions.data, wide[:, 2:5].ctypes.data)
        self.same(Primitives(CLOUD, radius=0.05), Primitives(wide[:, 2:5], radius=0.05))
        for odd in (CLOUD[::-1], CLOUD[::-1].tolist(), np.broadcast_to(CLOUD[::-1], (500, 3))):  # copied
            self.same(Primitives(CLOUD[::-1].copy(), radius=0.05), Primitives(odd, radius=0.05))
        p, tets = box(3)
        six = np.zeros((len(tets), 6), np.uint32)
        six[:, 1:5] = tets
        stored = Primitives(p, six[:, 1:5])
        self.assertEqual((stored._struct.indices, stored._struct.index_byte_stride), (six[:, 1:].ctypes.data, 24))
        self.same(stored, (p, tets))
        radii = np.linspace(0.01, 0.1, 2 * len(CLOUD))[::2]
        stored = Primitives(CLOUD, radii=radii)
        self.assertEqual(stored._struct.radii, radii.ctypes.data)
        for odd in (radii.copy(), radii.tolist(), radii[::-1].copy()[::-1]):
            self.same(stored, Primitives(CLOUD, radii=odd))
        quarters = Primitives(CLOUD, radii=radii.astype(np.float32) / 4)
        self.assertNotEqual(ForeignGrid(stored).suggest().cell_size, ForeignGrid(quarters).suggest().cell_size)

    def test_arrays_are_read_in_each_call(self):
        points = CLOUD.copy()
        grid = ForeignGrid(points, radius=0.1)
        before = grid.suggest().cell_size
        points *= 2
        grid_of_twice = ForeignGrid(points, radius=0.1).suggest()
        self.assertEqual(grid.suggest().cell_size, grid_of_twice.cell_size)
        self.assertNotEqual(before, grid_of_twice.cell_size)

    def test_memory_that_would_be_freed(self):
        edges, radii = np.array([[0, 1], [1, 2], [2, 3]], np.uint32), np.array([0.1, 0.2, 0.3])
        for name, values in (("indices", edges), ("radii", radii), ("positions", CLOUD[:4].copy())):
            mapped = mmap.mmap(-1, values.nbytes)
            arrays = {"positions": CLOUD[:4], "indices": edges, "radii": radii}
            arrays[name] = np.ndarray(values.shape, values.dtype, mapped)
            arrays[name][:] = values
            stored = Primitives(**arrays)
            del arrays
            with self.assertRaises(BufferError, msg=name):
                mapped.close()
            self.same(stored, Primitives(CLOUD[:4], edges, radii=radii))
            del stored
            mapped.close()

    def test_what_a_grid_points_to_stays(self):
        grid = ForeignGrid(CLOUD, CLOUD[:9])
        for name in ("stored", "querying"):
            with self.assertRaises(AttributeError):
                setattr(grid, name, None)
        self.assertEqual((len(grid.stored), len(grid.querying)), (500, 9))

    def test_boxes(self):
        both = np.empty((len(CLOUD), 6))
        both[:, :3], both[:, 3:] = CLOUD, CLOUD + 0.05
        stored = Primitives.boxes(both[:, :3], both[:, 3:])
        self.assertEqual(stored._struct.positions.data, both.ctypes.data)
        for low, high in ((CLOUD, CLOUD + 0.05), (CLOUD + 0.05, CLOUD), (both[:, 3:], both[:, :3]), (CLOUD.tolist(), CLOUD + 0.05)):
            self.same(stored, Primitives.boxes(low, high))
        cubes = both.reshape(-1, 2, 3).astype(np.float32)
        stored = Primitives.boxes(cubes[:, 0], cubes[:, 1])
        self.assertEqual(stored._struct.positions.data, cubes.ctypes.data)
        self.assertEqual(len(Primitives.boxes([[0, 0, 0]], [[1, 1, 1]])), 1)
        np.testing.assert_allclose(ForeignGrid(Primitives.boxes([[0, 0, 0]], [[1, 1, 1]], radius=0.5)).count(0.5).stored, 125)
        with self.assertRaises(ValueError):
            Primitives.boxes(CLOUD, CLOUD[:5])

    def test_meshes(self):
        p, tets = box(3, dtype=np.float64)
        with voxtet.Grid() as grid:
            mesh = grid.add(p, tets)
            grid.step()
            self.same(mesh, (p, tets))
        surface = tets[:, :3]
        kinds = {"meshio": SimpleNamespace(points=p, cells_dict={"triangle": surface, "tetra": tets}),
                 "a data set": SimpleNamespace(points=p, cells_dict={10: tets, 5: surface}, celltypes=[10])}
        for name, kind in kinds.items():
            with self.subTest(name):
                self.same(kind, (p, tets))
        self.same(SimpleNamespace(points=p, cells_dict={"triangle": surface}), (p, surface))
        self.same(SimpleNamespace(vertices=p, faces=surface), (p, surface))
        for cloud in (SimpleNamespace(points=p, cells_dict={}), SimpleNamespace(vertices=p)):
            self.assertEqual(repr(Primitives(cloud)), f"<voxtet.Primitives: {len(p)} points>")
        with self.assertRaises(TypeError):
            ForeignGrid(object())

    def test_files(self):
        try:
            import voxtet.io
        except ImportError as missing:
            self.skipTest(str(missing))
        ball = voxtet.io.make_ball(1.0, 0.3)
        self.assertEqual(len(Primitives(ball)), len(ball.tets))
        triangles = voxtet.io.boundary(ball.tets)
        surface = voxtet.io.MeshData(ball.positions, triangles=triangles)
        self.assertEqual(repr(Primitives(surface)), f"<voxtet.Primitives: {len(triangles)} triangles>")
        self.assertEqual(len(Primitives(voxtet.io.MeshData(ball.positions))), len(ball.positions))

    def test_wrong(self):
        p, tets = box(2)
        nan = p.copy()
        nan[3, 1] = math.nan
        for error, stored in ((ValueError, p[:0]), (ValueError, p[:, :2]), (TypeError, p.astype(complex)), (TypeError, "text"),
                            (TypeError, None), (voxtet.NonFiniteError, nan), (voxtet.LimitError, p.astype(float) * 1e300)):
            with self.subTest(stored=stored), self.assertRaises(error):
                ForeignGrid(stored).suggest()
        for indices in (tets[0], tets[:, :1], tets.astype(float), tets.astype(np.int64) - 5, tets.astype(np.int64) + 2**32, "text"):
            with self.subTest(indices=indices), self.assertRaises((ValueError, TypeError)):
                Primitives(p, indices)
        with self.assertRaises(voxtet.InvalidMeshError) as caught:
            ForeignGrid((p, tets + 100)).suggest()
        self.assertRegex(str(caught.exception), r"vertex \d+ of 27")
        for radii in ([1, 2], np.full(27, "a"), np.zeros((27, 1))):
            with self.subTest(radii=radii), self.assertRaises((ValueError, TypeError)):
                Primitives(p, radii=radii)
        for radii in (np.full(27, -1.0), np.full(27, math.inf)):
            with self.subTest(radii=radii), self.assertRaises(ValueError):
                ForeignGrid(Primitives(p, radii=radii)).suggest()
        for radius in (-1, math.nan, math.inf):
            with self.assertRaises(ValueError):
                ForeignGrid(Primitives(p, radius=radius)).suggest()


class Suggestions(unittest.TestCase):
    def test_result(self):
        grid = ForeignGrid(CLOUD, known="point_voxels", radius=0.1, zone_loss=0.1)
        s = grid.suggest()
        self.assertTrue(0 < s.zone[0] <= s.cell_size <= s.zone[1])
        self.assertEqual(s.warnings, CellSizeWarnings(0))
        self.assertEqual(s.note, "")
        self.assertTrue(0 < s.cost < 1)  # seconds
        self.assertEqual(len(s.curve), 64)
        self.assertTrue((np.diff(s.curve.cell_size) > 0).all())
        self.assertAlmostEqual(s.terms.cost.sum() / s.cost, 1, 6)
        counts = grid.count(s.cell_size)
        self.assertEqual(counts.stored, len(CLOUD))  # in one cell each
        self.assertTrue(np.isclose(s.terms.count, counts.visits, rtol=1e-3).any())
        radius = s.rules[s.rules.name == "mean radius"][0]
        self.assertAlmostEqual(radius.cell_size, 0.1)
        self.assertGreater(radius.cost, s.cost * 0.999)
        self.assertEqual((s.fit_error, s.expected_loss, len(s.timings)), (0, 0, 0))
        self.assertIn("cell size", repr(s))
        narrow = ForeignGrid(CLOUD, known="point_voxels", radius=0.1, zone_loss=0.01).suggest()
        self.assertLess(narrow.zone[1] / narrow.zone[0], s.zone[1] / s.zone[0])

    def test_description(self):
        known = ForeignGrid(CLOUD, known="pbat").suggest()
        again = ForeignGrid(CLOUD, weights=known.weights, cells_stored="centre", cells_queried="27",
                            cells_kept=voxtet.CellsKept.OCCUPIED).suggest()
        self.assertGreater(sum(known.weights), 0)
        self.assertEqual((again.cell_size, again.cost), (known.cell_size, known.cost))
        stored = Primitives(CLOUD, radius=0.05)
        around = ForeignGrid(stored, cells_stored="centre", cells_queried="27", radius=0.02).suggest()
        self.assertAlmostEqual(around.min_cell_size, 0.12)
        self.assertGreaterEqual(around.cell_size, around.min_cell_size)
        larger = ForeignGrid(stored, cells_stored="centre", cells_queried="27", min_cell_size=0.5).suggest()
        self.assertGreaterEqual(larger.zone[0], 0.5)
        pairs = ForeignGrid(stored, stored, cells_queried="pairs").count(0.2)
        self.assertAlmostEqual(pairs.stored, 2 * ForeignGrid(stored).count(0.2).stored)
        sparse, dense = (ForeignGrid(stored, weights={"store": 1, "cell": 5}, cells_kept=kept).suggest()
                         for kept in ("occupied", "dense"))
        self.assertEqual(sparse.weights.cell, 0)
        self.assertEqual(dense.weights, ForeignWeights(store=1, cell=5))
        self.assertEqual(len(dense.terms), len(sparse.terms) + 1)
        queried = ForeignGrid(stored, CLOUD[:10], weights=ForeignWeights(visit=1, read=1))
        self.assertAlmostEqual(queried.count(0.2).visits, 10)
        self.assertEqual(repr(ForeignGrid(CLOUD, CLOUD[:9])),
                         "<voxtet.ForeignGrid of <voxtet.Primitives: 500 points>, queried by <voxtet.Primitives: 9 points>>")

    def test_warnings(self):
        s = ForeignGrid(Primitives(CLOUD, radius=0.1)).suggest()
        self.assertEqual(s.warnings, CellSizeWarnings.GUESSED_WEIGHTS)
        unsized = ForeignGrid(CLOUD, known="hashed").suggest()
        self.assertIn(CellSizeWarnings.FROM_SPACING, unsized.warnings)
        self.assertIn("size", unsized.note)
        self.assertIn(unsized.note, repr(unsized))
        self.assertIn(CellSizeWarnings.ONE_PLACE, ForeignGrid(np.zeros((5, 3)), known="hashed").suggest().warnings)
        least = ForeignGrid(Primitives(CLOUD, radius=0.05), known="hashed", min_cell_size=0.7).suggest()
        self.assertIn(CellSizeWarnings.AT_MINIMUM, least.warnings)

    def test_wrong(self):
        for wrong in ({"known": "nobody"}, {"cells_stored": "boxen"}, {"cells_queried": "up"}, {"cells_kept": "all"},
                      {"cells_queried": "27"}, {"radius": -1}, {"zone_loss": -1}, {"radius": math.inf}, {"min_cell_size": math.nan},
                      {"weights": {"read": -1}}, {"weights": {"reads": 1}}, {"weights": ForeignWeights(read=math.nan)},
                      {"querying": CLOUD[:0]}):
            with self.subTest(wrong), self.assertRaises(ValueError):
                ForeignGrid(CLOUD, **wrong).suggest()
        for wrong in ({"known": 3.5}, {"cells_stored": 1}, {"cells_kept": True}, {"radius": "1"}, {"weights": 3},
                      {"weights": {"read": "1"}}, {"colour": 1}, {"querying": 5}):
            with self.subTest(wrong), self.assertRaises(TypeError):
                ForeignGrid(CLOUD, **wrong)
        for size in (0, -1, math.nan, math.inf):
            with self.assertRaises(ValueError):
                ForeignGrid(CLOUD).count(size)

    def test_names_are_the_librarys(self):
        for kind, struct in ((voxtet.ForeignCounts, _c.vox_foreign_counts), (ForeignWeights, _c.vox_foreign_weights)):
            self.assertEqual(list(kind._fields), [name for name, *_ in struct._fields_])

    def test_threads(self):
        grid, found = ForeignGrid(Primitives(CLOUD, radius=0.1)), []
        threads = [threading.Thread(target=lambda: found.append(grid.suggest().cell_size)) for _ in range(4)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        self.assertEqual(found, 4 * [grid.suggest().cell_size])

    def test_pictures(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("there is no matplotlib")
        matplotlib.use("Agg")
        for result in (ForeignGrid(CLOUD, radius=0.1).suggest(), tune(lambda size: size + 1 / size if size > 0.2 else math.inf, 1),
                       ForeignGrid(Primitives(CLOUD, radius=0.1)).fit([(0.1, 2), (0.2, 1), (0.4, 2)])):
            axes = result.plot()
            self.assertEqual(axes.get_xlabel(), "cell size")
            self.assertIn("of a run", axes.get_ylabel())
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of what matplotlib is made of, about each other
                self.assertTrue(result._repr_png_().startswith(b"\x89PNG"))


class Fits(unittest.TestCase):
    def setUp(self):
        self.grid = ForeignGrid(CLOUD, cells_stored="centre", radius=0.1)

    def seconds(self, size, weights):
        c = self.grid.count(size)
        return 1e-9 * sum(weight * count for weight, count in zip(weights, (1, c.stored, c.visits, c.visits - c.empty, c.reads,
                                                                            c.occupied, 0)))

    def test_weights_and_size(self):
        weights = ForeignWeights(visit=10, read=2)
        timings = [(size, self.seconds(size, weights)) for size in (0.03, 0.06, 0.12, 0.24, 0.48)]
        fit = self.grid.fit(timings)
        self.assertLess(fit.fit_error, 0.05)
        self.assertEqual(len(fit.curve), 64)
        best = ForeignGrid(CLOUD, cells_stored="centre", radius=0.1, weights=weights).suggest()
        self.assertAlmostEqual(fit.cell_size / best.cell_size, 1, 0)
        self.assertLess(self.seconds(fit.cell_size, weights), 1.05 * self.seconds(best.cell_size, weights))
        self.assertAlmostEqual(fit.cost / self.seconds(fit.cell_size, weights), 1, 1)
        self.assertEqual(fit.warnings, CellSizeWarnings(0))
        # The weights hold for other scenes.
        again = ForeignGrid(CLOUD, cells_stored="centre", radius=0.1, weights=fit.weights).suggest()
        self.assertAlmostEqual(again.cell_size / fit.cell_size, 1, 1)

    def test_timings_that_contradict_each_other(self):
        fit = self.grid.fit([(0.05, 1), (0.05, 3), (0.1, 1), (0.2, 1), (0.2, 2)])
        self.assertIn(CellSizeWarnings.TIMINGS_DISAGREE, fit.warnings)
        self.assertIn(fit.note, repr(fit))
        fit = self.grid.fit([(0.05, 1), (0.1, 9), (0.2, 1)])
        self.assertIn(CellSizeWarnings.MODEL_DISAGREES, fit.warnings)
        self.assertTrue(all(weight >= 0 for weight in fit.weights))

    def test_wrong(self):
        good = [(0.05, 1.0), (0.1, 1.0), (0.2, 1.0)]
        for wrong in ([], good[:2], good[:2] + good[:1], [*good[:2], (0.2, 0)], [*good[:2], (0.2, -1)], [*good[:2], (0.2, math.nan)],
                      [*good[:2], (0.2, math.inf)], [*good[:2], (0, 1)], [*good[:2], (-1, 1)], [*good[:2], (math.nan, 1)], [(1, 2, 3)]):
            with self.subTest(wrong), self.assertRaises(ValueError):
                self.grid.fit(wrong)
        for wrong in (5, [5], [("1", 2)], [*good, (0.4, "1")], [*good, (0.4, None)]):
            with self.subTest(wrong), self.assertRaises(TypeError):
                self.grid.fit(wrong)
        with self.assertRaises(ValueError):  # a size below what is legal
            ForeignGrid(Primitives(CLOUD, radius=0.08), known="pbat").fit(good)


class Tunings(unittest.TestCase):
    def test_least_time(self):
        calls = []

        def seconds(size):
            calls.append(size)
            return 1e-3 * (size / 0.3 + 0.3 / size)

        t = tune(seconds, first=0.7)
        self.assertLess(seconds(t.cell_size), 1.02 * 2e-3)
        calls.pop()
        self.assertEqual([run.cell_size for run in t.timings], calls)
        self.assertLessEqual(len(calls), 7)
        self.assertTrue(t.zone[0] <= t.cell_size <= t.zone[1])
        self.assertLess(t.expected_loss, 0.1)
        self.assertEqual(t.weights, ForeignWeights())
        self.assertAlmostEqual(t.cost / 2e-3, 1, 1)
        self.assertLess(t.fit_error, 0.1)
        self.assertEqual(t.timings.tolist(), tune(seconds, first=0.7).timings.tolist())
        within = tune(seconds, first=1, low=0.8, high=2)
        self.assertTrue(all(0.8 <= run.cell_size <= 2.0001 for run in within.timings))
        self.assertEqual(len(tune(seconds, first=0.7, max_runs=3).timings), 3)

    def test_described(self):
        grid, narrow = (ForeignGrid(CLOUD, cells_stored="centre", radius=0.1, zone_loss=loss) for loss in (0.2, 0.01))

        def seconds(size):
            counts = grid.count(size)
            return 1e-9 * (10 * counts.visits + 2 * counts.reads)

        t = grid.tune(seconds)
        best = ForeignGrid(CLOUD, cells_stored="centre", radius=0.1, weights={"visit": 10, "read": 2}).suggest()
        self.assertLess(seconds(t.cell_size), 1.03 * seconds(best.cell_size))
        self.assertGreater(sum(t.weights), 0)
        narrow = narrow.tune(seconds)
        self.assertLess(narrow.zone[1] / narrow.zone[0], t.zone[1] / t.zone[0])

    def test_timed_here(self):
        t = tune(lambda size: time.sleep(2e-3 * (size + 1 / size)), first=1, max_runs=4)
        self.assertTrue(all(run.seconds > 3.9e-3 for run in t.timings))

    def test_sizes_that_cannot_run(self):
        t = tune(lambda size: size if size > 0.5 else math.inf, first=1)
        self.assertGreater(t.cell_size, 0.5)
        self.assertTrue(any(run.seconds == math.inf for run in t.timings))
        self.assertIn(CellSizeWarnings.STOPPED, t.warnings)
        with self.assertRaises(voxtet.InvalidStateError):
            tune(lambda size: math.inf, first=1)

    def test_stopped(self):
        for answer in (math.nan, -1):
            times = iter([2.0, 1.0, answer, 5.0])
            t = tune(lambda size: next(times), first=1)
            self.assertIn(CellSizeWarnings.STOPPED, t.warnings)
            self.assertEqual([run.seconds for run in t.timings[:2]], [2.0, 1.0])
            self.assertEqual(next(times), 5.0)
        with self.assertRaises(voxtet.InvalidStateError):
            tune(lambda size: math.nan, first=1)

    def test_exceptions_come_out(self):
        for kind in (KeyError, voxtet.NonFiniteError, KeyboardInterrupt, SystemExit, StopIteration):
            for good in (0, 4):
                calls = []

                def run(size):
                    calls.append(size)
                    if len(calls) > good:
                        raise kind("mine")
                    return size + 1 / size + 0.1 * len(calls)

                with self.assertRaises(kind):
                    tune(run, first=1, max_runs=32, wanted_loss=0)
                self.assertEqual(len(calls), good + 1)
        for answer in ("1", [1], True, 1j):
            with self.assertRaises(TypeError):
                tune(lambda size: answer, first=1)
        with self.assertRaises(ValueError):
            tune(lambda size: 0.0, first=1)

    def test_interrupt(self):
        calls = []

        def run(size):
            calls.append(size)
            signal.raise_signal(signal.SIGINT)
            time.sleep(0)
            return 1.0

        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            with self.assertRaises(KeyboardInterrupt):
                tune(run, first=1)
        finally:
            signal.signal(signal.SIGINT, before)
        self.assertEqual(len(calls), 1)

    def test_calls_within_a_run(self):
        """A run may use the library, fail in it, and tune something else."""
        def run(size):
            with self.assertRaises(ValueError):
                ForeignGrid(CLOUD, radius=-1).suggest()
            return tune(lambda other: other + size + 1 / other, first=1).cost + 1 / size

        self.assertGreater(tune(run, first=1).cell_size, 0)

    def test_wrong(self):
        for wrong in ({"first": 0}, {"first": -1}, {"first": math.nan}, {"first": 1, "max_runs": 2}, {"first": 1, "max_runs": 33},
                      {"first": 1, "low": 2, "high": 1}, {"first": 1, "low": 2, "high": 3}, {"first": 1, "low": 0.5},
                      {"first": 1, "wanted_loss": -1}):
            with self.subTest(wrong), self.assertRaises(ValueError):
                tune(lambda size: self.fail("it was called"), **wrong)
        with self.assertRaises(ValueError):
            ForeignGrid(CLOUD[:0]).tune(lambda size: self.fail("it was called"))
        for wrong in ({}, {"first": "1"}, {"first": 1, "max_runs": 3.5}, {"first": 1, "zone_loss": 0.1}):
            with self.subTest(wrong), self.assertRaises(TypeError):
                tune(lambda size: 1.0, **wrong)
        with self.assertRaises(TypeError):
            tune(5, first=1)


if __name__ == "__main__":
    unittest.main()
