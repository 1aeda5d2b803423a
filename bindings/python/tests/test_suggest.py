"""Cell sizes, and the method for any algorithm."""

import math
import unittest

import numpy as np

import voxtet
from support import GridCase
from voxtet import _c


class Suggestions(GridCase):
    def test_suggestion(self):
        for model in ("paper", "reference", "fast", voxtet.CostModel.FAST):
            s = voxtet.suggest_cell_size([(self.first, self.tets), (self.second, self.tets)], model=model)
            self.assertLess(0, s.zone[0])
            self.assertTrue(s.zone[0] <= s.cell_size <= s.zone[1])
            self.assertEqual(len(s.curve), 64)
            self.assertTrue((np.diff(s.curve.cell_size) > 0).all())
            self.assertAlmostEqual(s.terms.cost.sum() / s.cost, 1, 6)
            self.assertTrue(all(s.terms.name))
            self.assertIn("mean edge (Teschner et al. 2003)", s.rules.name)
            self.assertTrue((s.rules.cost > 0).all())
            self.assertEqual((len(s.timings), s.warnings, s.note), (0, voxtet.CellSizeWarnings(0), ""))
            self.assertIn("cell size", repr(s))

    def test_unit(self):
        both = [(self.first, self.tets), (self.second, self.tets)]
        for model in ("reference", "fast"):  # nanoseconds would be above 1
            self.assertTrue(0 < voxtet.suggest_cell_size(both, model=model).cost < 1)
        self.assertGreater(voxtet.suggest_cell_size(both).cost, 1)  # visits

    def test_geometry(self):
        both = voxtet.measure_geometry([(self.first, self.tets), (self.second, self.tets)])
        one = voxtet.measure_geometry(self.first, self.tets)
        self.assertEqual((both.tets, both.vertices), (2 * len(self.tets), 2 * len(self.first)))
        self.assertEqual(one.bounds_min, tuple(self.first.min(axis=0)))
        self.assertEqual(one.bounds_max, tuple(self.first.max(axis=0)))
        rules = voxtet.suggest_cell_size(self.first, self.tets).rules
        self.assertAlmostEqual(one.mean_edge, rules.cell_size[0])
        self.assertEqual(list(one._fields), [name for name, *_ in _c.vox_geometry._fields_][2:])
        with self.assertRaises(ValueError):
            voxtet.measure_geometry(self.first, self.tets + 10**6)

    def test_arguments(self):
        both = voxtet.suggest_cell_size([(self.first, self.tets), (self.second, self.tets)], zone_loss=0.1)
        narrow = voxtet.suggest_cell_size(self.first, self.tets, zone_loss=0.01)
        self.assertLess(narrow.zone[1] - narrow.zone[0], both.zone[1] - both.zone[0])
        voxtet.suggest_cell_size(self.first, self.tets, dense=True, model="reference", byte_budget=10**9,
                                 self_collision=True)
        with self.assertRaises(TypeError):
            voxtet.suggest_cell_size(self.first, self.tets, zone=0.1)
        with self.assertRaises(TypeError):
            voxtet.suggest_cell_size([self.first])
        for wrong in ({"model": "quick"}, {"p_nc": 2}, {"zone_loss": -1}, {"world_edge": math.nan}):
            with self.assertRaises(ValueError):
                voxtet.suggest_cell_size(self.first, self.tets, **wrong)
        with self.assertRaises(ValueError):
            voxtet.suggest_cell_size(self.first, self.tets[:0])

    def test_of_a_grid(self):
        self.grid.step()
        self.assertEqual(self.grid.suggest_cell_size().cost, self.grid.suggest_cell_size("fast").cost)
        narrow, wide = (self.grid.suggest_cell_size("paper", zone_loss=loss) for loss in (0.02, 0.2))
        self.assertEqual(narrow.cell_size, wide.cell_size)
        self.assertLess(narrow.zone[1] / narrow.zone[0], wide.zone[1] / wide.zone[0])
        with self.assertRaises(ValueError):
            self.grid.suggest_cell_size(zone_loss=0.2)

    def test_weights(self):
        weights = voxtet.calibrate()
        self.assertEqual((weights.shape, weights.dtype), ((24,), np.float64))
        self.assertTrue((weights[:16] > 0).all())
        both = [(self.first, self.tets), (self.second, self.tets)]
        for model in ("reference", "fast"):
            once, twice, shipped, zero = (voxtet.suggest_cell_size(both, model=model, weights=w)
                                          for w in (weights, 2 * weights, None, [0] * 24))
            self.assertEqual(twice.cell_size, once.cell_size)
            self.assertEqual(twice.cost, 2 * once.cost)
            self.assertEqual(zero.cost, shipped.cost)
        with voxtet.Grid(reference=voxtet.Reference(weights=weights)) as grid:
            for positions, tets in both:
                grid.add(positions, tets)
            grid.step()
            ratio = grid.suggest_cell_size("reference", weights=2 * weights).cost / grid.suggest_cell_size().cost
            self.assertEqual(ratio, 2)  # without weights, those of its engine
        for wrong in (weights[:-1], -weights, np.full(24, math.inf), 3):
            with self.assertRaises(ValueError):
                voxtet.suggest_cell_size(both, model="fast", weights=wrong)
            with self.assertRaises(ValueError):
                voxtet.Grid(reference=voxtet.Reference(weights=wrong))


class Minimise(unittest.TestCase):
    def test_function(self):
        m = voxtet.minimise(lambda d: (1 / d + 1) ** 3 * d**2, 0.01, 100, zone_loss=0.1)
        self.assertAlmostEqual(m.cell_size, 0.5, 2)
        self.assertTrue(m.zone[0] < m.cell_size < m.zone[1])
        self.assertAlmostEqual(m.cost, 6.75, 2)
        self.assertEqual(len(m.curve), 64)
        self.assertEqual((len(m.terms), len(m.rules)), (0, 0))

    def test_exceptions_pass(self):
        for kind in (KeyError, KeyboardInterrupt, SystemExit):
            calls = []

            def cost(size):
                calls.append(size)
                raise kind("mine")

            with self.assertRaises(kind):
                voxtet.minimise(cost, 1, 2)
            self.assertEqual(len(calls), 1)
        with self.assertRaises(TypeError):
            voxtet.minimise(lambda size: "text" + 1, 1, 2)

    def test_wrong(self):
        for low, high in ((0, 1), (2, 1), (1, math.inf), (math.nan, 1)):
            with self.assertRaises(ValueError):
                voxtet.minimise(lambda size: size, low, high)
        with self.assertRaises(ValueError):
            voxtet.minimise(lambda size: math.nan, 1, 2)


if __name__ == "__main__":
    unittest.main()
