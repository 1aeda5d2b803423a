"""The paper's experiment, and fits of measured times. Skipped where vox_sim was not built."""

import unittest

import numpy as np

import voxtet
from support import box

try:
    from voxtet.experiment import Experiment, Fit, fit
except ImportError as missing:
    raise unittest.SkipTest(str(missing))
from voxtet import _c
from voxtet.experiment import Facts


class Experiments(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.body = box(4, dtype=np.float64)
        cls.experiment = Experiment(cls.body, frames=3, contact_share=0.03)
        cls.addClassCleanup(cls.experiment.close)

    def test_facts(self):
        facts = self.experiment.facts
        self.assertEqual((facts.frames, facts.tets, facts.vertices), (3, 2 * len(self.body[1]), 2 * len(self.body[0])))
        self.assertEqual(len(facts.shares), 3)
        self.assertAlmostEqual(np.mean(facts.shares), facts.mean_share)
        self.assertTrue(0.015 < facts.mean_share < 0.06, facts.mean_share)
        self.assertGreater(facts.contacts, 0)
        self.assertLess(facts.bounds_min[0], facts.bounds_max[0])
        self.assertEqual(list(Facts._fields), [n for n, *_ in _c.vox_experiment_facts._fields_ if n != "struct_size"])

    def test_bodies(self):
        """A second body, meshes, and their material; the same motion from each way to say it."""
        hash = self.experiment.facts.hash

        class Mesh:
            positions, tets = self.body

        for a, b, options in ((Mesh, Mesh, {}), (self.body, list(self.body), {"density": 1000, "damping": 0.01}),
                              (self.body, None, {"reference": None, "workers": 2})):
            with Experiment(a, b, frames=3, contact_share=0.03, **options) as same:
                self.assertEqual(same.facts.hash, hash)
        with Experiment(self.body, frames=3, contact_share=0.03, youngs_modulus=1e4) as softer:
            self.assertNotEqual(softer.facts.hash, hash)

    def test_measure(self):
        best = self.experiment.suggest().cell_size
        for size in (best, 2 * best):
            sample = self.experiment.measure(size)
            self.assertEqual(sample.cell_size, size)
            self.assertEqual(sample.contacts, self.experiment.facts.contacts)
            self.assertAlmostEqual(sample.frame_ns.mean() / sample.mean_ns, 1, 3)
            self.assertGreater(sample.visited_cells, 0)
        self.assertEqual(self.experiment.suggest("fast").model, voxtet.CostModel.FAST)

    def test_sweep(self):
        sizes = self.experiment.suggest().cell_size * np.geomspace(0.25, 4, 8)
        times = self.experiment.sweep(sizes, rounds=3)
        self.assertEqual(times.shape, (8,))
        self.assertTrue((times > 0).all())
        found = fit(sizes, times)
        self.assertTrue(sizes[0] * 0.999 <= found.cell_size <= sizes[-1] * 1.001)
        self.assertEqual(len(self.experiment.sweep(sizes[:1].tolist(), 1)), 1)

    def test_mistakes(self):
        with Experiment(self.body, frames=1, contact_share=0.03) as closed:
            pass
        closed.close()
        for use in (lambda: closed.measure(1), lambda: closed.sweep([1]), closed.suggest):
            with self.assertRaisesRegex(voxtet.InvalidStateError, "the experiment is closed"):
                use()
        for wrong in ({"contact_share": 2}, {"contact_share": 0.9}, {"axis": (0, 0, 0)}, {"frames": 0}, {"time_step": -1},
                      {"density": np.nan}, {"frames": 0}):
            with self.assertRaises(voxtet.VoxError):
                Experiment(self.body, **wrong)
        for wrong in ({"stiffness": 1}, {"turn": 1}, {"frames": 1.5}, {"fixed": True}, {"b": 3}):
            with self.assertRaises(TypeError):
                Experiment(self.body, **wrong)
        for wrong in (0, -1, np.inf):
            with self.assertRaises(ValueError):
                self.experiment.measure(wrong)
        for wrong in ([], [[1.0]], ["1"]):
            with self.assertRaises((TypeError, ValueError)):
                self.experiment.sweep(wrong)
        with self.assertRaises(ValueError):
            self.experiment.sweep([1], rounds=0)


class Fits(unittest.TestCase):
    def test_fit(self):
        sizes = np.geomspace(0.5, 8, 12)
        found = fit(sizes, np.exp(np.log(sizes / 2) ** 2))  # exactly of degree 2
        self.assertEqual(found.degree, 2)
        self.assertEqual(len(found.coefficients), 3)
        self.assertAlmostEqual(found.cell_size, 2, 6)
        self.assertAlmostEqual(found.time, 1, 6)
        self.assertAlmostEqual(found.r_squared, 1)
        self.assertTrue(found.bracketed)
        self.assertEqual(found.range, (sizes[0], sizes[-1]))
        self.assertAlmostEqual(found.time_at(2 * np.e), np.e, 5)
        np.testing.assert_allclose(found.zone(np.e ** 0.25), (2 / np.e ** 0.5, 2 * np.e ** 0.5), rtol=1e-5)
        self.assertIn("cell size 2", repr(found))
        self.assertIsInstance(found, Fit)
        self.assertFalse(fit(sizes, sizes).bracketed)

    def test_mistakes(self):
        sizes = [1, 2, 3, 4, 5]
        for times in ([1, 2, 3, 4], [1, 2, 3, 4, -1], [1, 2, np.nan, 4, 5]):
            with self.assertRaises(ValueError):
                fit(sizes, times)
        with self.assertRaises(ValueError):
            fit([1, 1, 2, 3, 4], sizes)
        found = fit(sizes, sizes)
        for wrong in (lambda: found.time_at(9), lambda: found.zone(0.5)):
            with self.assertRaises(ValueError):
                wrong()
        with self.assertRaises(TypeError):
            found.time_at("2")


if __name__ == "__main__":
    unittest.main()
