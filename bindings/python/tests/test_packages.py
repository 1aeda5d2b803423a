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

    @wants("trimesh")
    def test_trimesh_scene(self):
        import trimesh
        ball = voxtet.io.to_trimesh(self.data)
        scene = trimesh.Scene()
        scene.add_geometry(ball)
        scene.add_geometry(ball, transform=trimesh.transformations.translation_matrix([3, 0, 0]))
        surface = voxtet.io.from_trimesh(scene)
        self.assertEqual(len(surface.triangles), 2 * len(ball.faces))
        self.assertAlmostEqual(surface.report.volume, 2)
        self.assertAlmostEqual(float(surface.positions[:, 0].max()), 4)
        self.assertEqual(len(voxtet.Primitives(scene)), 2 * len(ball.faces))
        for empty in (trimesh.Scene(), trimesh.Trimesh()):
            for call in (voxtet.io.from_trimesh, voxtet.io.tetrahedralize, voxtet.Primitives):
                with self.assertRaises(ValueError):
                    call(empty)

    def second_order(self):
        """The mesh with a vertex on each edge, ten a tet, which lie behind the corners; and a vertex of no cell before them."""
        edges, number = np.unique(np.sort(self.tets[:, [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]]], axis=2).reshape(-1, 2),
                                  axis=0, return_inverse=True)
        middles = self.positions[edges].mean(axis=1)
        tens = np.hstack([self.tets, len(self.positions) + number.reshape(-1, 6)]).astype(np.int64)
        return np.concatenate([[[9, 9, 9]], self.positions, middles]), tens + 1

    def check_corners(self, load, mesh):
        """Corners are taken, and it is said."""
        with self.assertWarns(voxtet.MeshWarning) as caught:
            data = load(mesh)
        self.same(data)
        np.testing.assert_array_equal(data.file_vertices, np.arange(len(self.positions)) + 1)
        self.assertIn(f"{len(self.tets)} tets have more than four nodes; only their corners were used", str(caught.warning))
        self.assertRegex(str(caught.warning), r"\d+ vertices belong to no tet and were left out")
        self.assertEqual(caught.filename, __file__)
        with self.assertWarns(voxtet.MeshWarning):
            self.assertGreater(len(load(mesh, keep_unused=True).positions), len(self.positions))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", voxtet.MeshWarning)  # there is none of tets that have ten nodes
            located = voxtet.locate(self.positions, mesh)
        np.testing.assert_array_equal(located.tet, voxtet.locate(self.positions, self.positions, self.tets).tet)
        with self.assertWarns(voxtet.MeshWarning), voxtet.Grid() as grid:
            grid.add(mesh, self_collision=True)
            grid.step()
            self.assertEqual(len(grid.contacts), 0)

    @wants("meshio")
    def test_meshio_of_higher_order(self):
        import meshio
        points, tens = self.second_order()
        for kind, cells in (("tetra10", tens), ("tetra20", np.hstack([tens, tens])), ("VTK_LAGRANGE_TETRAHEDRON", tens)):
            with self.subTest(kind):
                self.check_corners(voxtet.io.from_meshio, meshio.Mesh(points, [(kind, cells)]))
        prisms = [("polyhedron12", [list(range(12))])]
        for call in (voxtet.io.from_meshio, lambda m: voxtet.locate(points, m), voxtet.Primitives, voxtet.io.quality):
            with self.assertRaisesRegex(ValueError, "1 polyhedron12"):
                call(meshio.Mesh(points, prisms))
        with self.assertWarnsRegex(voxtet.MeshWarning, "1 volume element of another kind was left out: polyhedron12"):
            voxtet.io.from_meshio(meshio.Mesh(self.positions, [("tetra", self.tets), *prisms]))
        surface = voxtet.io.from_meshio(meshio.Mesh(points, [("triangle6", tens[:, [0, 1, 2, 4, 5, 6]])]))
        np.testing.assert_array_equal(surface.triangles, tens[:, :3])

    @wants("meshio")
    def test_meshio_regions(self):
        import meshio
        regions = np.arange(len(self.tets)) // 3
        blocks = [("triangle", [[0, 1, 2]]), ("tetra", self.tets[:5]), ("tetra", self.tets[5:])]
        parts = [[9], regions[:5], regions[5:]]
        for name in ("gmsh:physical", "medit:ref", "anything"):
            data = {"stress": [np.ones(1), np.ones(5), np.ones(len(regions) - 5)], name: parts}
            read = voxtet.io.from_meshio(meshio.Mesh(self.positions, blocks, cell_data=data))
            np.testing.assert_array_equal(read.regions, regions)
        again = voxtet.io.from_meshio(voxtet.io.to_meshio(read))
        np.testing.assert_array_equal(again.regions, regions)

    @wants("pyvista")
    def test_pyvista_of_higher_order(self):
        import pyvista
        points, tens = self.second_order()

        def grid(kind, cells):
            padded = np.insert(cells, 0, cells.shape[1], axis=1)
            return pyvista.UnstructuredGrid(padded.ravel(), np.full(len(cells), kind, np.uint8), points)

        for kind in (24, 71, 78):
            with self.subTest(kind):
                self.check_corners(voxtet.io.from_pyvista, grid(kind, tens))
        prisms = grid(16, np.arange(12)[None])
        for call in (voxtet.io.from_pyvista, lambda m: voxtet.locate(points, m), voxtet.Primitives, voxtet.io.tetrahedralize):
            with self.assertRaisesRegex(ValueError, "1 hexagonal prism"):
                call(prisms)
        with self.assertRaisesRegex(ValueError, "no triangles, but 3 points"):
            voxtet.io.from_pyvista(pyvista.PolyData(points[:3]))
        surface = voxtet.io.from_pyvista(grid(22, tens[:, [0, 1, 2, 4, 5, 6]]))
        np.testing.assert_array_equal(surface.triangles, tens[:, :3])
        with self.assertRaisesRegex(ValueError, "triangles"):
            voxtet.locate(points, surface)

    @wants("pyvista")
    def test_pyvista_regions(self):
        marked = voxtet.io.MeshData(self.positions, self.tets, None, np.arange(len(self.tets)))
        np.testing.assert_array_equal(voxtet.io.from_pyvista(voxtet.io.to_pyvista(marked)).regions, marked.regions)

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
