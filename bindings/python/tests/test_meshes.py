"""Meshes that a grid takes as they are, what is written of a grid, rows for solvers, and how results show themselves."""

import contextlib
import io
import os
import pickle
import runpy
import tempfile
import unittest
import warnings
import xml.etree.ElementTree

import numpy as np

import voxtet
from support import GridCase, box

try:
    import voxtet.io
except ImportError as missing:
    raise unittest.SkipTest(str(missing))


class Added(unittest.TestCase):
    def setUp(self):
        self.positions, self.tets = box(2, dtype=np.float64)
        self.grid = voxtet.Grid()
        self.addCleanup(self.grid.close)

    def test_mesh_data(self):
        data = voxtet.io.MeshData(self.positions, self.tets)
        a = self.grid.add(data, tag="a")
        b = self.grid.add(data)
        np.testing.assert_array_equal(a.positions, self.positions)
        self.assertEqual(a.info.tet_count, len(self.tets))
        self.grid.step()
        at_rest = len(self.grid.contacts)
        self.assertGreater(at_rest, 0)
        b.positions[:] += 5  # its own copy
        self.grid.step()
        self.assertEqual(len(self.grid.contacts), 0)
        np.testing.assert_array_equal(data.positions, self.positions)

    def test_mesh_of_a_grid(self):
        a = self.grid.add(self.positions, self.tets)
        a.transform = [[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0]]
        with voxtet.Grid() as other:
            b = other.add(a)
            np.testing.assert_array_equal(b.positions, self.positions + [3, 0, 0])
            self.assertEqual(b.info.tet_count, len(self.tets))

    def test_surfaces(self):
        surface = voxtet.io.MeshData(self.positions, None, voxtet.io.boundary(self.tets))
        self.assertEqual(self.grid.add(surface).info.tet_count, 0)
        filled = self.grid.add(surface, fill=0.3)
        self.assertEqual(filled.info.tet_count, len(voxtet.io.tetrahedralize(surface, 0.3).tets))
        self.assertGreater(self.grid.add(surface, fill=0).info.tet_count, filled.info.tet_count)
        for wrong in (lambda: self.grid.add(self.positions, self.tets, fill=1), lambda: self.grid.add(self.positions, fill=1)):
            with self.assertRaises(ValueError):
                wrong()
        with self.assertRaises(TypeError):
            self.grid.add(object())


class Errors(unittest.TestCase):
    def test_tag(self):
        with voxtet.Grid() as grid:
            positions, tets = box(2)
            grid.add(positions, tets, tag="liver")
            positions[3, 1] = np.nan
            with self.assertRaisesRegex(voxtet.NonFiniteError, "vertex 3.*'liver'"):
                grid.step()
            positions[3, 1] = 0
            grid.step()

    def test_unknown_arguments(self):
        with self.assertRaisesRegex(TypeError, "'threads'.*`workers`"):
            voxtet.Grid(threads=4)
        with self.assertRaisesRegex(TypeError, "'nothing'$"):
            voxtet.Grid(nothing=4)


class Written(GridCase):
    options = {"constraints": True}

    def setUp(self):
        super().setUp()
        self.grid.step()
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def arrays(self, content):
        piece = xml.etree.ElementTree.fromstring(content).find("UnstructuredGrid/Piece")
        return {array.get("Name"): np.array(array.text.split(), float) for array in piece.iter("DataArray")}

    def test_grid(self):
        found = self.arrays(voxtet.io.write(self.grid, "vtu", point_data={"x": np.arange(2.0 * len(self.first))}))
        np.testing.assert_array_equal(found["Points"].reshape(-1, 3), np.concatenate([self.first, self.second]))
        self.assertEqual(set(found["body"]), {self.a.id, self.b.id})
        self.assertEqual(found["contacts"].sum(), len(self.grid.contacts))
        c = self.grid.constraints
        self.assertAlmostEqual(found["depth"].max(), -c.gap.min())
        deepest = c[c.gap.argmin()]
        at = deepest.vertices[0] + (len(self.first) if deepest.body_a == self.b.id else 0)
        self.assertAlmostEqual(found["depth"][at], -deepest.gap)
        self.assertEqual(len(found["x"]), 2 * len(self.first))
        self.a.enabled = False
        self.assertEqual(len(self.arrays(voxtet.io.write(self.grid, "vtu"))["contacts"]), len(self.second))
        path = os.path.join(self.folder.name, "run.vtu")
        voxtet.io.save(self.grid, path)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", voxtet.MeshWarning)
            self.assertEqual(len(voxtet.io.load(path).tets), len(self.tets))
        with voxtet.Grid() as empty:
            voxtet.io.write(empty, "vtu")

    def test_series(self):
        path = os.path.join(self.folder.name, "run & <go>.pvd")
        series = voxtet.io.Series(path)
        files = [series.add(self.grid, 0.5, binary=True), series.add(self.grid)]
        listed = [(float(d.get("timestep")), d.get("file")) for d in xml.etree.ElementTree.parse(path).iter("DataSet")]
        self.assertEqual(listed, [(0.5, "run & <go>_0000.vtu"), (1.0, "run & <go>_0001.vtu")])
        for file in files:
            self.assertTrue(os.path.exists(file))
        with self.assertRaises(ValueError):
            voxtet.io.Series("run.vtu")


class Example(unittest.TestCase):
    def test_comes_to_rest(self):
        path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "comes_to_rest.py")
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            runpy.run_path(path)
        lines = printed.getvalue().splitlines()
        self.assertEqual(len(lines), 4)
        self.assertRegex(lines[-1], r"^3 s: height 0\.25, speed 0\.0[01], deepest 0\.000[1-9]$")


class Rows(GridCase):
    options = {"constraints": True, "edges": True}

    def test_gaps(self):
        self.grid.step()
        c = self.grid.constraints
        n = len(self.first)
        rows = c.rows({self.a: n, self.b.id: 0}, 6 * n)
        self.assertEqual((rows.shape, rows.indptr[0], rows.indptr[-1]), ((len(c), 6 * n), 0, len(rows.data)))
        x = np.concatenate([self.second, self.first]).astype(float).ravel()
        products = rows.data * x[rows.indices]
        gaps = c.offset + np.add.reduceat(products, rows.indptr[:-1])
        np.testing.assert_allclose(gaps, c.gap, atol=1e-12)
        self.assertEqual(c.rows({self.a: n, self.b: 0}).shape[1], rows.indices.max() + 1)
        self.assertEqual(c[:0].rows({}).shape, (0, 0))
        with self.assertRaises(LookupError):
            c.rows({self.a: 0})
        with self.assertRaises(ValueError):
            c.rows({self.a: n, self.b: 0}, 6)
        try:
            from scipy.sparse import csr_array
        except ImportError:
            return
        np.testing.assert_allclose(csr_array(rows[:3], shape=rows.shape) @ x + c.offset, c.gap, atol=1e-12)

    def test_shown(self):
        self.grid.step()
        found, c, pairs = self.grid.contacts, self.grid.constraints, self.grid.pairs
        self.assertEqual(repr(found), f"<voxtet.Contacts: {len(found)}, each with body_a, vertex, body_b, tet>")
        table = found._repr_html_()
        self.assertIn(f"<caption>{len(found)} Contacts</caption>", table)
        self.assertEqual(table.count("<tr>"), min(len(found), 10) + 1)
        self.assertIn("<td>INSIDE</td>", c._repr_html_())
        self.assertIn("<td>BEGAN</td>", pairs._repr_html_())
        self.a.tag = "<a>"
        self.assertIn("<td>&#x27;&lt;a&gt;&#x27;</td>", self.grid._repr_html_())
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(found)), found)
        with voxtet.Grid() as empty:
            self.assertIn("0 meshes", empty._repr_html_())
        self.assertIn("closed", empty._repr_html_())


if __name__ == "__main__":
    unittest.main()
