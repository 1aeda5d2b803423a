"""Meshes to and from other packages, and pictures. Each test is skipped where its package is not installed."""

import importlib.util
import os
import unittest
import warnings

import numpy as np

import voxtet
from support import GridCase, box

try:
    import voxtet.io
except ImportError as missing:
    raise unittest.SkipTest(str(missing))


def wants(name):
    """Skips a test where a package is missing; VOXTET_REQUIRE_PACKAGES fails instead."""
    if os.environ.get("VOXTET_REQUIRE_PACKAGES"):
        importlib.import_module(name)
    return unittest.skipUnless(importlib.util.find_spec(name), f"{name} is not installed")


class Packages(unittest.TestCase):
    def setUp(self):
        self.positions, self.tets = box(2, dtype=np.float64)
        self.data = voxtet.io.MeshData(self.positions, self.tets)

    def same(self, data):
        np.testing.assert_array_equal(data.positions, self.positions)
        np.testing.assert_array_equal(data.tets, self.tets)

    @wants("meshio")
    def test_meshio(self):
        import meshio
        mesh = voxtet.io.to_meshio(self.data)
        self.same(voxtet.io.from_meshio(mesh))
        with voxtet.Grid() as grid:  # as in the README: what meshio reads is accepted as it is
            grid.add(mesh.points, mesh.cells_dict["tetra"])
            grid.step()
        mixed = meshio.Mesh(self.positions, [("triangle", [[0, 1, 2]]), ("tetra", self.tets)])
        self.same(voxtet.io.from_meshio(mixed))
        self.assertEqual(len(voxtet.io.from_meshio(mixed).triangles), 1)
        self.assertGreaterEqual(voxtet.locate(self.positions, mixed).tet.min(), 0)

    @wants("pyvista")
    def test_pyvista(self):
        import pyvista
        grid = voxtet.io.to_pyvista(self.data)
        self.same(voxtet.io.from_pyvista(grid))
        self.assertGreaterEqual(voxtet.locate(self.positions, grid).tet.min(), 0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # pyvista's, about a future default
            surface = voxtet.io.from_pyvista(grid.extract_surface())
        self.assertEqual(len(surface.triangles), len(voxtet.io.boundary(self.tets)))
        self.assertGreater(len(voxtet.io.tetrahedralize(voxtet.io.to_pyvista(surface), 0.3).tets), 0)
        cells = {pyvista.CellType.TRIANGLE: np.array([[0, 1, 2]]), pyvista.CellType.TETRA: self.tets.astype(int)}
        mixed = pyvista.UnstructuredGrid(cells, self.positions)
        located = voxtet.locate([[0.3, 0.4, 0.5], [5, 5, 5]], mixed)
        self.assertEqual(mixed.celltypes[located.tet[0]], pyvista.CellType.TETRA)
        self.assertTrue(mixed.get_cell(located.tet[0]).bounds.x_min <= 0.3 <= mixed.get_cell(located.tet[0]).bounds.x_max)
        self.assertEqual(located.tet[1], -1)
        locator = voxtet.Locator(mixed)
        closest = locator.find_closest([[0.3, 0.4, 0.5], [90, 90, 90]], max_distance=9)
        self.assertEqual(closest.body.tolist(), [1, 0])
        for tets in (closest.tet[:1], locator.find_ray_hits([0.3, 0.4, -5], [0.3, 0.41, 5]).tet):
            self.assertTrue((mixed.celltypes[tets] == pyvista.CellType.TETRA).all())

    @wants("trimesh")
    def test_trimesh(self):
        mesh = voxtet.io.to_trimesh(self.data)
        self.assertTrue(mesh.is_watertight)
        self.assertAlmostEqual(mesh.volume, 1)
        surface = voxtet.io.from_trimesh(mesh)
        filled = voxtet.io.tetrahedralize(mesh, 0.25)
        self.assertAlmostEqual(filled.report.volume, 1, 1)
        self.assertEqual(len(surface.triangles), len(mesh.faces))

    def test_unknown(self):
        for call in (voxtet.io.from_meshio, voxtet.io.tetrahedralize, voxtet.io.quality):
            with self.assertRaises(TypeError):
                call(object())


class Pictures(GridCase):
    options = {"constraints": True}

    @wants("matplotlib")
    def test_curves(self):
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        for drawn in (voxtet.suggest_cell_size(self.first, self.tets), voxtet.minimise(lambda d: d + 1 / d, 0.1, 10)):
            axes = drawn.plot()
            self.assertIs(drawn.plot(axes), axes)
            self.assertGreater(len(axes.lines), 1)
            self.assertIn("cost" if len(drawn.rules) == 0 else "cell visits", axes.get_ylabel())
            pyplot.close("all")
            self.assertEqual(drawn._repr_png_()[:4], b"\x89PNG")

    @wants("pyvista")
    def test_grid(self):
        self.grid.add(self.first + np.float32(2))  # points alone
        self.grid.add(self.second, self.tets).transform = [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0]]
        self.grid.step()
        plotter = self.grid.plot(off_screen=True, window_size=(300, 300))
        picture = plotter.screenshot(None, return_img=True)
        self.assertGreater(len(np.unique(picture.reshape(-1, 3), axis=0)), 20)
        plotter.close()
        with voxtet.Grid() as empty:
            empty.plot(off_screen=True).close()


if __name__ == "__main__":
    unittest.main()
