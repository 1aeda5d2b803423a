"""Cell sizes of grids that are not the library's: what they hold, timings, runs."""

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
from voxtet import ForeignGrid, ForeignWarnings, GridWeights, Primitives, _c, count_for, cost_fit, suggest_for, tune

CLOUD = np.random.default_rng(7).random((500, 3))


def cells_in_common(low_a, high_a, low_b, high_b, size):
    """How many, on average over all positions of the cells, of two boxes: 1 - gap / size along each axis, or 0."""
    gaps = np.maximum(low_a, low_b) - np.minimum(high_a, high_b)
    return np.maximum(1 - gaps / size, 0).prod(axis=-1)


class Held(unittest.TestCase):
    """What a grid holds, in all its forms."""

    def same(self, one, other):
        one, other = suggest_for(one), suggest_for(other)
        self.assertEqual(one.cell_size, other.cell_size)
        self.assertEqual(one.work, other.work)

    def test_counts_are_those_of_all_pairs(self):
        low = np.random.default_rng(3).random((60, 3))
        high = low + np.random.default_rng(4).random((60, 3)) / 4
        for size in (0.05, 0.2, 1.0):
            for radius in (0.0, 0.1):
                work = count_for(size, Primitives.boxes(low, high), radius=radius)
                entries = ((high - low) / size + 1).prod(axis=1)
                pairs = cells_in_common(low[:, None] - radius, high[:, None] + radius, low, high, size)
                np.fill_diagonal(pairs, entries)  # each finds itself in its own cells
                np.testing.assert_allclose(work.entries, entries.sum(), rtol=1e-6)
                np.testing.assert_allclose(work.visits, ((high - low + 2 * radius) / size + 1).prod(axis=1).sum(), rtol=1e-6)
                np.testing.assert_allclose(work.reads, pairs.sum(), rtol=0.05)

    def test_elements(self):
        p, tets = box(4)
        triangles, edges = tets[:, :3], tets[:, :2]
        for indices in (tets, triangles, edges):
            corners = p[indices]
            as_boxes = Primitives.boxes(corners.min(axis=1), corners.max(axis=1))
            found = count_for(0.1, (p, indices))
            np.testing.assert_allclose(found, count_for(0.1, as_boxes), rtol=1e-5)
            self.same((p, indices), (p.astype(np.float64), indices.astype(np.int64)))
            self.same((p, indices), Primitives(p, indices.tolist()))
            self.same((p, indices), Primitives(np.asfortranarray(p), indices))
        self.assertAlmostEqual(suggest_for((p, edges)).rules.mean_edge, np.linalg.norm(np.diff(p[edges], axis=1), axis=2).mean(), 1)

    def test_strides_are_borrowed(self):
        wide = np.zeros((len(CLOUD), 7))
        wide[:, 2:5] = CLOUD
        held = Primitives(wide[:, 2:5])
        self.assertEqual(held._struct.positions.data, wide[:, 2:5].ctypes.data)
        self.same(Primitives(CLOUD, radius=0.05), Primitives(wide[:, 2:5], radius=0.05))
        for odd in (CLOUD[::-1], CLOUD[::-1].tolist(), np.broadcast_to(CLOUD[::-1], (500, 3))):  # copied
            self.same(Primitives(CLOUD[::-1].copy(), radius=0.05), Primitives(odd, radius=0.05))
        p, tets = box(3)
        six = np.zeros((len(tets), 6), np.uint32)
        six[:, 1:5] = tets
        held = Primitives(p, six[:, 1:5])
        self.assertEqual((held._struct.indices, held._struct.index_byte_stride), (six[:, 1:].ctypes.data, 24))
        self.same(held, (p, tets))
        radii = np.linspace(0.01, 0.1, 2 * len(CLOUD))[::2]
        held = Primitives(CLOUD, radii=radii)
        self.assertEqual(held._struct.radii, radii.ctypes.data)
        for odd in (radii.copy(), radii.tolist(), radii[::-1].copy()[::-1]):
            self.same(held, Primitives(CLOUD, radii=odd))
        self.assertNotEqual(suggest_for(held).cell_size, suggest_for(Primitives(CLOUD, radii=radii.astype(np.float32) / 4)).cell_size)

    def test_arrays_are_read_in_each_call(self):
        points = CLOUD.copy()
        grid = ForeignGrid(points, radius=0.1)
        before = suggest_for(grid).cell_size
        points *= 2
        grid_of_twice = suggest_for(ForeignGrid(points, radius=0.1))
        self.assertEqual(suggest_for(grid).cell_size, grid_of_twice.cell_size)
        self.assertNotEqual(before, grid_of_twice.cell_size)

    def test_memory_that_would_be_freed(self):
        edges, radii = np.array([[0, 1], [1, 2], [2, 3]], np.uint32), np.array([0.1, 0.2, 0.3])
        for name, values in (("indices", edges), ("radii", radii), ("positions", CLOUD[:4].copy())):
            mapped = mmap.mmap(-1, values.nbytes)
            arrays = {"positions": CLOUD[:4], "indices": edges, "radii": radii}
            arrays[name] = np.ndarray(values.shape, values.dtype, mapped)
            arrays[name][:] = values
            held = Primitives(**arrays)
            del arrays
            with self.assertRaises(BufferError, msg=name):
                mapped.close()
            self.same(held, Primitives(CLOUD[:4], edges, radii=radii))
            del held
            mapped.close()

    def test_what_a_grid_points_to_stays(self):
        grid = ForeignGrid(CLOUD, CLOUD[:9])
        for name in ("held", "asking"):
            with self.assertRaises(AttributeError):
                setattr(grid, name, None)
        self.assertEqual((len(grid.held), len(grid.asking)), (500, 9))

    def test_boxes(self):
        both = np.empty((len(CLOUD), 6))
        both[:, :3], both[:, 3:] = CLOUD, CLOUD + 0.05
        held = Primitives.boxes(both[:, :3], both[:, 3:])
        self.assertEqual(held._struct.positions.data, both.ctypes.data)
        for low, high in ((CLOUD, CLOUD + 0.05), (CLOUD + 0.05, CLOUD), (both[:, 3:], both[:, :3]), (CLOUD.tolist(), CLOUD + 0.05)):
            self.same(held, Primitives.boxes(low, high))
        cubes = both.reshape(-1, 2, 3).astype(np.float32)
        held = Primitives.boxes(cubes[:, 0], cubes[:, 1])
        self.assertEqual(held._struct.positions.data, cubes.ctypes.data)
        self.assertEqual(len(Primitives.boxes([[0, 0, 0]], [[1, 1, 1]])), 1)
        np.testing.assert_allclose(count_for(0.5, Primitives.boxes([[0, 0, 0]], [[1, 1, 1]], radius=0.5)).entries, 125)
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
            suggest_for(object())

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
        for error, held in ((ValueError, p[:0]), (ValueError, p[:, :2]), (TypeError, p.astype(complex)), (TypeError, "text"),
                            (TypeError, None), (voxtet.NonFiniteError, nan), (voxtet.LimitError, p.astype(float) * 1e300)):
            with self.subTest(held=held), self.assertRaises(error):
                suggest_for(held)
        for indices in (tets[0], tets[:, :1], tets.astype(float), tets.astype(np.int64) - 5, tets.astype(np.int64) + 2**32, "text"):
            with self.subTest(indices=indices), self.assertRaises((ValueError, TypeError)):
                Primitives(p, indices)
        with self.assertRaises(voxtet.InvalidMeshError) as caught:
            suggest_for((p, tets + 100))
        self.assertRegex(str(caught.exception), r"vertex \d+ of 27")
        for radii in ([1, 2], np.full(27, "a"), np.zeros((27, 1))):
            with self.subTest(radii=radii), self.assertRaises((ValueError, TypeError)):
                Primitives(p, radii=radii)
        for radii in (np.full(27, -1.0), np.full(27, math.inf)):
            with self.subTest(radii=radii), self.assertRaises(ValueError):
                suggest_for(Primitives(p, radii=radii))
        for radius in (-1, math.nan, math.inf):
            with self.assertRaises(ValueError):
                suggest_for(Primitives(p, radius=radius))


class Suggestions(unittest.TestCase):
    def test_answer(self):
        s = suggest_for(CLOUD, known="point_voxels", radius=0.1, zone_loss=0.1)
        self.assertTrue(0 < s.zone[0] <= s.cell_size <= s.zone[1])
        self.assertEqual(s.warnings, ForeignWarnings(0))
        self.assertEqual(s.note, "")
        self.assertEqual(s.work.entries, len(CLOUD))
        self.assertEqual(len(s.curve), 64)
        self.assertTrue((np.diff(s.curve.cell_size) > 0).all())
        self.assertAlmostEqual(s.terms.cost.sum() / s.predicted_cost, 1, 6)
        self.assertAlmostEqual(s.terms.share.sum(), 1, 6)
        self.assertAlmostEqual(s.rules.radius, 0.1)
        self.assertGreater(s.rule_costs.radius, s.predicted_cost * 0.999)
        self.assertEqual(s.rule, voxtet.ForeignRule.NONE)
        self.assertIn("cell size", repr(s))
        narrow = suggest_for(CLOUD, known="point_voxels", radius=0.1, zone_loss=0.01)
        self.assertLess(narrow.zone[1] / narrow.zone[0], s.zone[1] / s.zone[0])

    def test_description(self):
        grid = ForeignGrid(CLOUD, known="pbat")
        self.assertEqual(suggest_for(grid).weights, grid.weights)
        self.assertEqual(grid._struct.look, voxtet.CellLook.AROUND)
        held = Primitives(CLOUD, radius=0.05)
        around = suggest_for(held, content="centres", look="around", radius=0.02)
        self.assertAlmostEqual(around.least_cell_size, 0.12)
        self.assertGreaterEqual(around.cell_size, around.least_cell_size)
        larger = suggest_for(held, content="centres", look="around", least_cell_size=0.5)
        self.assertGreaterEqual(larger.zone[0], 0.5)
        pairs = count_for(0.2, held, held, look="pairs")
        self.assertAlmostEqual(pairs.entries, 2 * count_for(0.2, held).entries)
        sparse, dense = (suggest_for(held, weights={"entries": 1, "cells": 5}, dense=dense) for dense in (False, True))
        self.assertEqual(sparse.weights.cells, 0)
        self.assertEqual(dense.weights, GridWeights(entries=1, cells=5))
        self.assertIn("clear a cell", dense.terms.name)
        asked = suggest_for(held, CLOUD[:10], weights=GridWeights(visits=1, reads=1))
        self.assertAlmostEqual(asked.work.visits, 10)
        self.assertEqual(repr(ForeignGrid(CLOUD, CLOUD[:9])),
                         "<voxtet.ForeignGrid of <voxtet.Primitives: 500 points>, asked by <voxtet.Primitives: 9 points>>")

    def test_warnings(self):
        self.assertEqual(suggest_for(Primitives(CLOUD, radius=0.1)).warnings, ForeignWarnings.WEIGHTS_UNKNOWN)
        unsized = suggest_for(CLOUD, known="hashed")
        self.assertIn(ForeignWarnings.NO_SIZE, unsized.warnings)
        self.assertIn("size", unsized.note)
        self.assertIn(unsized.note, repr(unsized))
        self.assertIn(ForeignWarnings.ONE_PLACE, suggest_for(np.zeros((5, 3)), known="hashed").warnings)
        least = suggest_for(Primitives(CLOUD, radius=0.05), known="hashed", least_cell_size=0.7)
        self.assertIn(ForeignWarnings.AT_LEAST_SIZE, least.warnings)

    def test_wrong(self):
        for wrong in ({"known": "nobody"}, {"content": "boxen"}, {"look": "up"}, {"look": "around"}, {"radius": -1}, {"zone_loss": -1},
                      {"radius": math.inf}, {"least_cell_size": math.nan}, {"weights": {"reads": -1}}, {"weights": {"read": 1}},
                      {"weights": GridWeights(reads=math.nan)}, {"asking": CLOUD[:0]}):
            with self.subTest(wrong), self.assertRaises(ValueError):
                suggest_for(CLOUD, **wrong)
        for wrong in ({"known": 3.5}, {"content": 1}, {"dense": 1}, {"radius": "1"}, {"weights": 3}, {"weights": {"reads": "1"}},
                      {"colour": 1}, {"asking": 5}):
            with self.subTest(wrong), self.assertRaises(TypeError):
                suggest_for(CLOUD, **wrong)
        with self.assertRaises(ValueError):
            suggest_for(ForeignGrid(CLOUD), radius=1)
        for size in (0, -1, math.nan, math.inf):
            with self.assertRaises(ValueError):
                count_for(size, CLOUD)

    def test_names_are_the_librarys(self):
        for kind, struct in ((voxtet.GridWork, _c.vox_grid_work), (GridWeights, _c.vox_grid_weights),
                             (voxtet.ForeignRules, _c.vox_foreign_rules), (voxtet.Timing, _c.vox_grid_timing)):
            self.assertEqual(list(kind._fields), [name for name, *_ in struct._fields_])

    def test_threads(self):
        grid, found = ForeignGrid(Primitives(CLOUD, radius=0.1)), []
        threads = [threading.Thread(target=lambda: found.append(suggest_for(grid).cell_size)) for _ in range(4)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        self.assertEqual(found, 4 * [suggest_for(grid).cell_size])

    def test_pictures(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("there is no matplotlib")
        matplotlib.use("Agg")
        for answer in (suggest_for(CLOUD, radius=0.1), tune(lambda size: size + 1 / size if size > 0.2 else math.inf, first=1),
                       cost_fit([(0.1, 2), (0.2, 1), (0.4, 2)], Primitives(CLOUD, radius=0.1))):
            axes = answer.plot()
            self.assertEqual(axes.get_xlabel(), "cell size")
            self.assertIn("of a run", axes.get_ylabel())
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of what matplotlib is made of, about each other
                self.assertTrue(answer._repr_png_().startswith(b"\x89PNG"))


class Fits(unittest.TestCase):
    def setUp(self):
        self.grid = ForeignGrid(CLOUD, content="centres", radius=0.1)

    def seconds(self, size, weights):
        work = count_for(size, self.grid)
        return 1e-9 * sum(weight * count for weight, count in zip(weights, (1, work.entries, work.visits, work.visits - work.empty,
                                                                            work.reads, work.occupied, 0)))

    def test_weights_and_size(self):
        weights = GridWeights(visits=10, reads=2)
        timings = [(size, self.seconds(size, weights)) for size in (0.03, 0.06, 0.12, 0.24, 0.48)]
        fit = cost_fit(timings, self.grid)
        self.assertLess(fit.residual, 0.05)
        self.assertEqual(fit.timings, tuple(timings))
        self.assertEqual(len(fit.curve), 64)
        best = suggest_for(CLOUD, content="centres", radius=0.1, weights=weights)
        self.assertAlmostEqual(fit.cell_size / best.cell_size, 1, 0)
        self.assertLess(self.seconds(fit.cell_size, weights), 1.05 * self.seconds(best.cell_size, weights))
        self.assertAlmostEqual(fit.predicted_seconds / self.seconds(fit.cell_size, weights), 1, 1)
        self.assertLess(fit.warnings, ForeignWarnings.MODEL_DISAGREES)
        again = suggest_for(CLOUD, content="centres", radius=0.1, weights=fit.weights)  # for other scenes
        self.assertAlmostEqual(again.cell_size / fit.cell_size, 1, 1)

    def test_timings_that_contradict_each_other(self):
        fit = cost_fit([(0.05, 1), (0.05, 3), (0.1, 1), (0.2, 1), (0.2, 2)], self.grid)
        self.assertIn(ForeignWarnings.TIMINGS_DISAGREE, fit.warnings)
        self.assertIn(fit.note, repr(fit))
        fit = cost_fit([(0.05, 1), (0.1, 9), (0.2, 1)], self.grid)
        self.assertIn(ForeignWarnings.MODEL_DISAGREES, fit.warnings)
        self.assertTrue(all(weight >= 0 for weight in fit.weights))

    def test_wrong(self):
        good = [(0.05, 1.0), (0.1, 1.0), (0.2, 1.0)]
        for wrong in ([], good[:2], good[:2] + good[:1], [*good[:2], (0.2, 0)], [*good[:2], (0.2, -1)], [*good[:2], (0.2, math.nan)],
                      [*good[:2], (0.2, math.inf)], [*good[:2], (0, 1)], [*good[:2], (-1, 1)], [*good[:2], (math.nan, 1)], [(1, 2, 3)]):
            with self.subTest(wrong), self.assertRaises(ValueError):
                cost_fit(wrong, self.grid)
        for wrong in (5, [5], [("1", 2)], [*good, (0.4, "1")], [*good, (0.4, None)]):
            with self.subTest(wrong), self.assertRaises(TypeError):
                cost_fit(wrong, self.grid)
        with self.assertRaises(ValueError):  # a size below what is legal
            cost_fit(good, Primitives(CLOUD, radius=0.08), known="pbat")


class Tunings(unittest.TestCase):
    def test_least_time(self):
        calls = []

        def seconds(size):
            calls.append(size)
            return 1e-3 * (size / 0.3 + 0.3 / size)

        t = tune(seconds, first=0.7)
        self.assertLess(seconds(t.cell_size), 1.02 * 2e-3)
        calls.pop()
        self.assertEqual([run.cell_size for run in t.runs], calls)
        self.assertLessEqual(len(calls), 7)
        self.assertTrue(t.zone[0] <= t.cell_size <= t.zone[1])
        self.assertLess(t.expected_loss, 0.1)
        self.assertEqual(t.weights, GridWeights())
        self.assertAlmostEqual(t.seconds / 2e-3, 1, 1)
        self.assertEqual(t.runs, tune(seconds, first=0.7).runs)
        within = tune(seconds, first=1, low=0.8, high=2)
        self.assertTrue(all(0.8 <= run.cell_size <= 2.0001 for run in within.runs))
        self.assertEqual(len(tune(seconds, first=0.7, most_runs=3).runs), 3)

    def test_described(self):
        grid = ForeignGrid(CLOUD, content="centres", radius=0.1, zone_loss=0.2)

        def seconds(size):
            work = count_for(size, grid)
            return 1e-9 * (10 * work.visits + 2 * work.reads)

        t = tune(seconds, grid)
        best = suggest_for(CLOUD, content="centres", radius=0.1, weights={"visits": 10, "reads": 2})
        self.assertLess(seconds(t.cell_size), 1.03 * seconds(best.cell_size))
        self.assertGreater(sum(t.weights), 0)
        narrow = tune(seconds, grid, zone_loss=0.01)
        self.assertLess(narrow.zone[1] / narrow.zone[0], t.zone[1] / t.zone[0])

    def test_timed_here(self):
        t = tune(lambda size: time.sleep(2e-3 * (size + 1 / size)), first=1, most_runs=4)
        self.assertTrue(all(run.seconds > 3.9e-3 for run in t.runs))

    def test_sizes_that_cannot_run(self):
        t = tune(lambda size: size if size > 0.5 else math.inf, first=1)
        self.assertGreater(t.cell_size, 0.5)
        self.assertTrue(any(run.seconds == math.inf for run in t.runs))
        self.assertIn(ForeignWarnings.STOPPED, t.warnings)
        with self.assertRaises(voxtet.InvalidStateError):
            tune(lambda size: math.inf, first=1)

    def test_stopped(self):
        for answer in (math.nan, -1):
            times = iter([2.0, 1.0, answer, 5.0])
            t = tune(lambda size: next(times), first=1)
            self.assertIn(ForeignWarnings.STOPPED, t.warnings)
            self.assertEqual([run.seconds for run in t.runs[:2]], [2.0, 1.0])
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
                    tune(run, first=1, most_runs=32, wanted_loss=0)
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
                suggest_for(CLOUD, radius=-1)
            return tune(lambda other: other + size + 1 / other, first=1).seconds + 1 / size

        self.assertGreater(tune(run, first=1).cell_size, 0)

    def test_wrong(self):
        for wrong in ({}, {"first": -1}, {"first": math.nan}, {"first": 1, "most_runs": 2}, {"first": 1, "most_runs": 33},
                      {"first": 1, "low": 2, "high": 1}, {"first": 1, "low": 2, "high": 3}, {"first": 1, "low": 0.5},
                      {"first": 1, "wanted_loss": -1}, {"first": 1, "zone_loss": math.nan}, {"first": 1, "asking": CLOUD},
                      {"first": 1, "radius": 1}, {"held": CLOUD[:0]}):
            with self.subTest(wrong), self.assertRaises(ValueError):
                tune(lambda size: self.fail("it was called"), **wrong)
        for wrong in ({"first": "1"}, {"first": 1, "most_runs": 3.5}):
            with self.subTest(wrong), self.assertRaises(TypeError):
                tune(lambda size: 1.0, **wrong)
        with self.assertRaises(TypeError):
            tune(5, first=1)


if __name__ == "__main__":
    unittest.main()
