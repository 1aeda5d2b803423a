"""Fields from mesh to mesh, forces back, and a skin that follows a cage."""

import contextlib
import io
import os
import runpy
import unittest

import numpy as np

import voxtet
from support import box
from test_locate import Mesh, slabs

try:
    import skfem
except ImportError:
    skfem = None
try:
    import meshio
except ImportError:
    meshio = None
try:
    import pyvista
except ImportError:
    pyvista = None


SLOPES = np.array([0.3, -1.7, 2.9])


def linear(points):
    return (points * SLOPES).sum(axis=1) + 0.4


class Transfers(unittest.TestCase):
    def setUp(self):
        self.positions, self.tets = box(5, dtype=np.float64)
        self.points = np.random.default_rng(4).random((3000, 3))

    def test_a_linear_field(self):
        """To 4 units in the last place of the largest term that it is added up from."""
        for scale in (1, 1e-3, 7e5):
            positions, points = self.positions * scale - scale / 3, self.points * scale - scale / 3
            transfer = voxtet.Transfer(positions, points, tets=self.tets)
            values = linear(positions)
            largest = np.abs(positions[self.tets[transfer.located.tet]] * SLOPES).max(axis=(1, 2)).clip(0.4)
            exact = linear(points.astype(np.longdouble))
            self.assertLessEqual((np.abs(transfer @ values - exact) / np.spacing(largest)).max(), 4)

    def test_shapes(self):
        transfer = voxtet.Transfer(self.positions, self.points, tets=self.tets)
        n = len(self.positions)
        values = np.random.default_rng(5).random((n, 2, 3))
        found = transfer @ values
        self.assertEqual((found.shape, transfer.shape), ((3000, 2, 3), (3000, n)))
        np.testing.assert_array_equal(found[:, 1, 2], transfer @ values[:, 1, 2])
        np.testing.assert_allclose(transfer @ (values + 2j * values), found * (1 + 2j))
        np.testing.assert_allclose(found[:, 0, 0], (values[transfer.nodes, 0, 0] * transfer.weights).sum(axis=0))
        for wrong in (values[1:], 3.0):
            with self.assertRaises(ValueError):
                transfer @ wrong
        with self.assertRaises(TypeError):
            transfer @ ["a"] * n
        self.assertEqual((voxtet.Transfer(self.positions, np.zeros((0, 3)), tets=self.tets) @ values).shape, (0, 2, 3))

    def test_forces(self):
        """Their sum stays, to 1e-14, and the transposed is the transposed."""
        transfer = voxtet.Transfer(self.positions, 1.4 * self.points - 0.2, tets=self.tets)
        random = np.random.default_rng(6)
        forces, values = random.normal(size=(3000, 3)), random.normal(size=(len(self.positions), 3))
        there = transfer.T @ forces
        self.assertLess(np.abs(there.sum(axis=0) - forces.sum(axis=0)).max(), 1e-14 * np.abs(forces).sum())
        self.assertAlmostEqual((there * values).sum(), (forces * (transfer @ values)).sum(), places=9)
        np.testing.assert_array_equal(transfer.T.T @ values, transfer @ values)
        try:
            matrix = transfer.matrix
        except ImportError:
            return
        np.testing.assert_allclose(matrix @ values, transfer @ values, atol=1e-14)
        np.testing.assert_allclose(matrix.T @ forces, there, atol=1e-13)

    def test_outside(self):
        points = 1.4 * self.points - 0.2
        out = ((points < 0) | (points > 1)).any(axis=1)
        make = lambda outside: voxtet.Transfer(self.positions, points, outside, tets=self.tets)
        values = linear(self.positions)
        np.testing.assert_array_equal(make("nearest").outside, out)
        np.testing.assert_allclose(make("nearest") @ values, linear(points.clip(0, 1)), atol=1e-14)
        np.testing.assert_allclose(make("extrapolate") @ values, linear(points), atol=1e-13)
        absent = make("nan")
        np.testing.assert_array_equal(np.isnan(absent @ values), out)
        self.assertAlmostEqual((absent.T @ np.ones(len(points))).sum(), (~out).sum())
        with self.assertRaisesRegex(ValueError, f"{out.sum()} of 3000 points are outside of the mesh, the first of them point {out.argmax()},"):
            make("raise")
        with self.assertRaisesRegex(ValueError, "'none'"):
            make("none")

    def test_sources(self):
        values = linear(self.positions)
        locator = voxtet.Locator(self.positions, self.tets)
        np.testing.assert_array_equal(voxtet.Transfer(locator, self.points) @ values, linear_at := voxtet.Transfer(
            self.positions, self.points, tets=self.tets) @ values)
        with voxtet.Grid() as grid:
            mesh = grid.add(self.positions, self.tets)
            np.testing.assert_array_equal(voxtet.Transfer(mesh, self.points) @ values, linear_at)
            mesh.remove_tets([0, 7])
            found = voxtet.Transfer(mesh, self.points, "nan") @ values
            some = np.isfinite(found)
            self.assertLess(0, (~some).sum())
            np.testing.assert_allclose(found[some], linear_at[some], atol=1e-14)
            with self.assertRaisesRegex(TypeError, "grid"):
                voxtet.Transfer(grid, self.points)

    def test_cells(self):
        mesh = slabs()
        transfer = voxtet.Transfer(mesh, self.points, "raise")
        np.testing.assert_allclose(transfer @ linear(mesh.points), linear(self.points), atol=4e-15)
        sums = transfer.T @ np.ones(3000)
        self.assertAlmostEqual(sums.sum(), 3000, places=10)


class Examples(unittest.TestCase):
    def printed(self, name):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            runpy.run_path(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", name))
        return printed.getvalue()

    def setUp(self):
        try:
            import voxtet.io
        except ImportError as missing:
            self.skipTest(str(missing))

    def test_coarse_to_fine(self):
        lines = self.printed("coarse_to_fine.py").splitlines()
        self.assertEqual([line.endswith("exact") for line in lines[1:5]], [True] * 4)
        errors = [float(line.split()[3]) for line in lines[1:5]]
        self.assertTrue(all(a > 3 * b for a, b in zip(errors, errors[1:])))
        self.assertTrue(lines[5].endswith("True"))

    def test_dose(self):
        lines = self.printed("dose.py").splitlines()
        self.assertRegex(lines[0], r"^7\d{4} of 100000 rays pass")
        self.assertTrue(lines[1].endswith("True"))

    def test_skin(self):
        lines = self.printed("skin.py").splitlines()
        self.assertEqual(len(lines), 3)
        self.assertRegex(lines[1], "True$")


class Skins(unittest.TestCase):
    def test_follows_an_affine_cage_and_does_not_sink(self):
        positions, tets = box(3, dtype=np.float64)
        skin = np.random.default_rng(7).random((500, 3)) * 1.2 - 0.1  # parts lie outside of the cage
        bound = voxtet.embed(skin, positions, tets)
        self.assertLess(0, bound.outside.sum())
        np.testing.assert_allclose(bound.move(positions), skin, atol=1e-15)
        linear_map = np.array([[0.3, -0.9, 0.1], [0.7, 0.2, -0.3], [0.1, 0.4, 1.1]])
        out = np.empty((500, 3), np.float32)
        self.assertIs(bound.move(positions @ linear_map + 2, out), out)
        np.testing.assert_allclose(out, skin @ linear_map + 2, atol=1e-6)
        with self.assertRaises(ValueError):
            bound.move(positions[1:])
        with voxtet.Grid() as grid:  # takes the result as it is
            grid.add(bound.move(positions), [[0, 1, 2, 3]])


@unittest.skipUnless(skfem, "there is no scikit-fem")
class ScikitFem(unittest.TestCase):
    def test_as_its_own(self):
        from voxtet.skfem import element_finder
        points = np.random.default_rng(8).random((3, 300))
        for mesh in (skfem.MeshTet().refined(2), skfem.MeshHex().refined(2), skfem.MeshWedge1()):
            np.testing.assert_array_equal(element_finder(mesh)(*points), mesh.element_finder()(*points))
            self.assertEqual(len(element_finder(mesh)(*mesh.p)), mesh.p.shape[1])
            with self.assertRaisesRegex(ValueError, "outside of the mesh: point 1, .* and 1 more"):
                element_finder(mesh)([0, 2, 3], [0, 0, 0], [0, 0, 0])
            just = np.nextafter(1, 2)
            self.assertEqual(element_finder(mesh)([just], [0.3], [0.3]), element_finder(mesh)([1.0], [0.3], [0.3]))
        mesh = skfem.MeshTet2.from_mesh(skfem.MeshTet().refined(1))
        np.testing.assert_array_equal(element_finder(mesh)(*points), skfem.MeshTet().refined(1).element_finder()(*points))
        with self.assertRaisesRegex(ValueError, "MeshTri1"):
            element_finder(skfem.MeshTri())


class Samples(unittest.TestCase):
    def check(self, source, target, made):
        for name in ("linear", "number"):
            self.assertNotIn(name, target.point_data)
        np.testing.assert_allclose(made.point_data["linear"], linear(np.asarray(target.points)), atol=1e-14)
        found = voxtet.locate(np.asarray(target.points), source, outside="nearest")
        np.testing.assert_array_equal(made.point_data["number"], 3 * found.cell)
        self.assertEqual(len(made.point_data["own"]), len(target.points))

    @unittest.skipUnless(meshio, "there is no meshio")
    def test_meshio(self):
        mesh = slabs()
        blocks = list(mesh.cells_dict.items())
        count = np.cumsum([0, *(len(nodes) for _, nodes in blocks)])
        source = meshio.Mesh(mesh.points, blocks, {"linear": linear(mesh.points)},
                             {"number": [3 * np.arange(a, b) for a, b in zip(count, count[1:])]})
        positions, tets = box(2, dtype=np.float64)
        target = meshio.Mesh(positions, [("tetra", tets)], {"own": np.zeros(len(positions))})
        self.check(source, target, voxtet.sample(source, target))

    @unittest.skipUnless(pyvista, "there is no pyvista")
    def test_pyvista(self):
        mesh = slabs()
        source = pyvista.UnstructuredGrid({12: mesh.cells_dict["hexahedron"], 13: mesh.cells_dict["wedge"],
                                           14: mesh.cells_dict["pyramid"]}, mesh.points)
        source.point_data["linear"] = linear(mesh.points)
        source.cell_data["number"] = 3 * np.arange(source.n_cells)
        positions, tets = box(2, dtype=np.float64)
        target = pyvista.UnstructuredGrid({10: tets.astype(np.int64)}, positions)
        target.point_data["own"] = np.zeros(len(positions))
        self.check(source, target, voxtet.sample(source, target))
        far = target.copy()
        far.points += 0.5
        made = voxtet.sample(source, far, "nan")
        np.testing.assert_array_equal(np.isnan(made.point_data["linear"]), (np.asarray(far.points) > 1).any(axis=1))
        np.testing.assert_array_equal(np.isnan(made.point_data["number"]), (np.asarray(far.points) > 1).any(axis=1))


if __name__ == "__main__":
    unittest.main()
