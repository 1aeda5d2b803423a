"""Files, bodies and the simulation. Skipped where the libraries for them were not built."""

import gc
import os
import pickle
import tempfile
import types
import unittest
import unittest.mock

import numpy as np

import voxtet
from support import box

try:
    import voxtet.io
    import voxtet.sim
except ImportError as missing:
    raise unittest.SkipTest(str(missing))

from voxtet import _c


class Files(unittest.TestCase):
    def setUp(self):
        self.positions, self.tets = box(2, dtype=np.float64)
        self.data = voxtet.io.MeshData(self.positions, self.tets)
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_arrays(self):
        np.testing.assert_array_equal(self.data.positions, self.positions)
        np.testing.assert_array_equal(self.data.tets, self.tets)
        self.assertEqual(self.data.triangles.shape, (0, 3))
        self.assertFalse(self.data.positions.flags.writeable)
        kept = self.data.positions[1:]
        self.data = None
        gc.collect()
        np.testing.assert_array_equal(kept, self.positions[1:])

    def test_save_and_load(self):
        for name in ("body.msh", "body.vtu", "bödy \u2713.msh"):
            for binary in (False, True):
                path = self.path(name)
                voxtet.io.save(self.data, path, binary=binary)
                again = voxtet.io.load(path)
                np.testing.assert_array_equal(again.positions, self.positions)
                np.testing.assert_array_equal(again.tets, self.tets)
        self.assertIn("VTK", again.format + "VTK")
        self.assertEqual(again.report.tets, len(self.tets))
        self.assertEqual(again.warnings, [])

    def test_assimp(self):
        path = self.path("triangle.obj")
        with open(path, "w") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
        own = voxtet.io.load(path)
        try:
            other = voxtet.io.load(path, format="assimp")
        except voxtet.UnsupportedError as error:  # the library was built without it
            self.assertIn("VOX_IO_ASSIMP", str(error))
            return
        self.assertEqual(other.format, "surface, by assimp")
        np.testing.assert_array_equal(other.positions, own.positions)
        np.testing.assert_array_equal(other.triangles, own.triangles)

    def test_memory(self):
        for format in ("msh_22", "msh_41", "vtu"):
            content = voxtet.io.write(self.data, format, point_data={"x": self.positions[:, 0], "p": self.positions},
                                      cell_data={"n": np.arange(len(self.tets))})
            again = voxtet.io.read(content, "any." + format[:3])
            np.testing.assert_array_equal(again.tets, self.tets)
        self.assertIn(b'Name="p"', content)
        files = {"a.node": b"4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n", "a.ele": b"1 4 0\n0 0 1 2 3\n"}
        self.assertEqual(len(voxtet.io.read(files).tets), 1)

    def test_errors(self):
        with self.assertRaises(FileNotFoundError) as caught:
            voxtet.io.load(self.path("nothing.msh"))
        self.assertEqual(caught.exception.filename, self.path("nothing.msh"))
        self.assertIsInstance(caught.exception, voxtet.VoxError)
        self.assertGreater(caught.exception.errno, 0)
        for text in (str(caught.exception), caught.exception.strerror):
            self.assertRegex(text, r"nothing\.msh: \w+")
            self.assertNotIn("None", text)
        with self.assertRaises(OSError) as caught:
            voxtet.io.save(self.data, self.path("no/such/folder.msh"))
        self.assertEqual(caught.exception.filename, self.path("no/such/folder.msh"))
        self.assertIsInstance(caught.exception, FileNotFoundError)
        with self.assertRaises(voxtet.FormatError):
            voxtet.io.read(b"$MeshFormat\n4.1 0 8\nnonsense", "a.msh")
        with self.assertRaises(ValueError):
            voxtet.io.load("a\0b")
        with self.assertRaises(NotImplementedError):
            voxtet.io.save(self.data, self.path("body.xyz"))
        with self.assertRaises(ValueError):
            voxtet.io.read(b"", "a\0.msh")
        for wrong in ({"x": [1, 2]}, {"a\0b": self.positions[:, 0]}, {"x": np.zeros((len(self.positions), 2))}, {'"': self.positions[:, 0]}):
            with self.assertRaises(ValueError):
                voxtet.io.write(self.data, "vtu", point_data=wrong)
        with self.assertRaises(TypeError):
            voxtet.io.write(self.data, "vtu", point_data={"x": ["a"] * len(self.positions)})
        with self.assertRaises(TypeError):
            voxtet.io.write(self.data, "vtu", point_data={1: self.positions[:, 0]})
        with self.assertRaises(TypeError):
            voxtet.io.load(3.5)
        with self.assertRaises(voxtet.InvalidMeshError):
            voxtet.io.MeshData(self.positions, [[0, 1, 2, 999]])

    def test_ctrl_c_while_writing(self):
        """Python notices it in the function that takes the bytes: it ends the writing, and is not lost."""
        for when in (1, 2):
            calls = []

            def interrupted(address, size):
                calls.append(size)
                if len(calls) == when:
                    raise KeyboardInterrupt
                return bytes(size)

            big = voxtet.io.make_ball(1, 0.1)
            with unittest.mock.patch("ctypes.string_at", interrupted), self.assertRaises(KeyboardInterrupt):
                voxtet.io.write(big, "vtu")
            self.assertEqual(len(calls), when)

    def test_pickle(self):
        again = pickle.loads(pickle.dumps(self.data))
        np.testing.assert_array_equal(again.tets, self.tets)
        self.assertEqual((again.regions, again.file_vertices), (None, None))
        marked = voxtet.io.MeshData(self.positions, self.tets, None, np.arange(len(self.tets)), range(len(self.positions)))
        again = pickle.loads(pickle.dumps(marked))
        np.testing.assert_array_equal(again.regions, np.arange(len(self.tets)))
        np.testing.assert_array_equal(again.file_vertices, np.arange(len(self.positions)))

    def odd(self):
        """A mesh file with a vertex of the geometry in front, and one of a triangle behind."""
        points = "9 9 9 0\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 5 5 0\n"
        path = self.path("odd.mesh")
        with open(path, "w") as file:
            file.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n6\n{points}Tetrahedra\n1\n2 3 4 5 7\nTriangles\n1\n2 3 6 0\nEnd\n")
        return path

    def test_unused_vertices(self):
        path = self.odd()
        with open(path, "rb") as file:
            content = file.read()
        words = "2 vertices belong to no tet and were left out; 1 triangle has such a vertex and was left out"
        for read in (lambda **o: voxtet.io.load(path, **o), lambda **o: voxtet.io.read(content, path, **o)):
            with self.assertWarns(voxtet.MeshWarning) as caught:
                data = read()
            self.assertEqual(str(caught.warning), f"{path}: {words}")
            self.assertEqual(caught.filename, __file__)
            self.assertEqual((len(data.positions), len(data.triangles), data.tets.tolist()), (4, 0, [[0, 1, 2, 3]]))
            self.assertEqual((data.file_vertices.tolist(), data.report.left_out_vertices), ([1, 2, 3, 4], 2))
            self.assertEqual("; ".join(data.warnings), words)
            with self.assertWarns(voxtet.MeshWarning):
                data = read(keep_unused=True)
            self.assertEqual((len(data.positions), len(data.triangles), data.file_vertices), (6, 1, None))
        with self.assertRaises(TypeError):
            voxtet.io.load(path, keep_unused=1)

    def test_cells(self):
        """Hexahedra of a file are split as those of meshio are, on request; each tet knows its cell."""
        points = "".join(f"{x} {y} {z} 0\n" for z in (0, 1) for y in (0, 1) for x in (0, 1, 2))
        text = (f"MeshVersionFormatted 2\nDimension 3\nVertices\n12\n{points}Hexahedra\n1\n1 2 5 4 7 8 11 10 3\n"
                "Prisms\n1\n2 3 5 8 9 11 4\nEnd\n").encode()
        with self.assertRaisesRegex(voxtet.FormatError, "split_cells"):
            voxtet.io.read(text, "a.mesh")
        with self.assertWarnsRegex(voxtet.MeshWarning, "1 cell was split into 6 tets: hexahedra; 1 cell was split into 3 tets: prisms"):
            data = voxtet.io.read(text, "a.mesh", split_cells=True)
        self.assertEqual((data.cells.tolist(), data.regions.tolist()), ([0] * 6 + [1] * 3, [3] * 6 + [4] * 3))
        self.assertEqual((data.report.split_cells, data.report.boundary_facets, data.report.left_out_tets), (2, 16, 0))
        self.assertAlmostEqual(data.report.volume, 1.5)
        again = pickle.loads(pickle.dumps(data))
        np.testing.assert_array_equal(again.cells, data.cells)

        mesh = types.SimpleNamespace(points=np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)], float), cells_dict={
            "hexahedron": np.array([[0, 1, 4, 3, 6, 7, 10, 9]]), "wedge": np.array([[1, 2, 4, 7, 8, 10]])})  # as meshio's
        with self.assertWarns(voxtet.MeshWarning):
            other = voxtet.io.from_meshio(mesh)
        np.testing.assert_array_equal(other.tets, data.tets)
        np.testing.assert_array_equal(other.cells, data.cells)

    def test_regions(self):
        with self.assertWarns(voxtet.MeshWarning):
            self.assertEqual(voxtet.io.load(self.odd()).regions.tolist(), [7])
        regions = np.arange(len(self.tets)) // 7 - 1
        marked = voxtet.io.MeshData(self.positions, self.tets, voxtet.io.boundary(self.tets), regions)
        self.assertFalse(marked.regions.flags.writeable)
        for format in ("msh_22", "msh_41", "vtu"):
            for binary in (False, True):
                again = voxtet.io.read(voxtet.io.write(marked, format, binary=binary), "a." + format[:3])
                np.testing.assert_array_equal(again.regions, regions)
                np.testing.assert_array_equal(again.tets, self.tets)
        self.assertIsNone(self.data.regions)
        for wrong, error in ((regions[1:], ValueError), (regions * 2**40, ValueError), (regions * .5, TypeError)):
            with self.assertRaises(error):
                voxtet.io.MeshData(self.positions, self.tets, None, wrong)

    def test_bodies(self):
        made = [voxtet.io.make_lattice_ball(1000, 1), voxtet.io.make_ball(1, .3), voxtet.io.make_torus(2, .5, .3),
                voxtet.io.make_capsule(.5, 1, .3), voxtet.io.make_cylinder(.5, 1, .3), voxtet.io.make_box(1, 2, 3, .5)]
        for data in made:
            self.assertEqual(data.report.inverted_tets, 0)
            self.assertGreater(voxtet.io.quality(data).min_dihedral, 0)
        with self.assertRaises(ValueError):
            voxtet.io.make_ball(-1, 1)

    def test_tetrahedralize(self):
        ball = voxtet.io.make_ball(1, 0.3)
        surface = voxtet.io.MeshData(ball.positions, None, voxtet.io.boundary(ball.tets))
        seen = []
        filled = voxtet.io.tetrahedralize(surface, 0.2, progress=seen.append)
        self.assertGreater(len(filled.tets), 100)
        self.assertEqual((seen[0] >= 0, seen[-1] <= 1, seen), (True, True, sorted(seen)))
        self.assertLess(voxtet.io.quality(filled, surface).hausdorff, 0.2)
        with self.assertRaises(voxtet.InvalidStateError):
            voxtet.io.tetrahedralize(surface, 0.2, progress=lambda fraction: True)

        def interrupted(fraction):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            voxtet.io.tetrahedralize(surface, 0.2, progress=interrupted)
        with self.assertRaises(voxtet.LimitError):
            voxtet.io.tetrahedralize(surface, 0.1, max_tets=10)
        self.assertGreater(len(voxtet.io.tetrahedralize(surface, 0.3, kind="cubes").tets), 10)

    def test_boundary(self):
        facets = voxtet.io.boundary(self.tets)
        self.assertEqual(len(facets), 2 * 6 * 4)
        a, b, c = (self.positions[facets[:, i]] for i in range(3))
        self.assertAlmostEqual(abs(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6), 1)

    def test_fields_are_those_of_the_library(self):
        for kind, struct in ((voxtet.io.Report, _c.vox_io_report), (voxtet.io.Quality, _c.vox_io_quality),
                             (voxtet.sim.Energy, _c.vox_sim_energy)):
            self.assertEqual(list(kind._fields), [n for n, *_ in struct._fields_ if n not in ("struct_size", "reserved")])


class Simulation(unittest.TestCase):
    def setUp(self):
        self.positions, self.tets = box(2, (0, 0, 0.05), dtype=np.float64)
        self.sim = voxtet.sim.Sim()
        self.body = self.sim.add(self.positions, self.tets, tag="box", youngs_modulus=1e5)

    def test_falls_and_rests(self):
        above = self.sim.add(self.positions + [0.1, 0.1, 1.1], self.tets, tag="above")
        for _ in range(60):
            self.sim.step(1 / 60)
        z = self.body.positions[:, 2]
        self.assertTrue(-0.05 < z.min() < 0.05)
        self.assertGreater(above.positions[:, 2].mean(), z.mean() + 0.5)
        self.assertEqual(self.sim.counters["steps"], 60)
        self.assertGreater(self.sim.energy.mass, 0)
        self.assertEqual({self.sim.grid[c.body_a].tag for c in self.sim.grid.contacts} - {"box", "above"}, set())
        self.assertEqual([b.tag for b in self.sim], ["box", "above"])
        np.testing.assert_array_equal(self.sim.grid[self.body].positions, self.body.positions.astype(np.float32))

    def test_tag_is_that_of_the_mesh(self):
        self.body.tag = "mine"
        self.assertEqual((self.sim.grid[self.body.id].tag, self.sim.bodies[0].tag), ("mine", "mine"))
        self.sim.grid[self.body.id].tag = "its"
        self.assertEqual(self.body.tag, "its")
        self.body.remove()
        self.assertIsNone(self.body.tag)
        with self.assertRaises(LookupError):
            self.body.tag = "again"

    def test_a_removed_body_leaves_nothing(self):
        for _ in range(3):
            body = self.sim.add(self.positions, self.tets, tag="x")
            body.positions
            body.remove()
        self.assertEqual((len(self.sim.grid._mapped), len(self.sim.grid._tags)), (0, 1))

    def test_state(self):
        self.body.set_state(velocities=np.tile([1.0, 0, 0], (len(self.positions), 1)))
        self.sim.step(0.02)
        np.testing.assert_allclose(self.body.positions, self.positions + [0.02, 0, -0.0022], atol=1e-4)
        self.assertAlmostEqual(self.body.energy.max_speed, np.hypot(1, 0.02 * 9.81), 3)
        self.assertEqual(self.body.velocities.shape, self.positions.shape)
        self.assertEqual(self.body.masses.shape, (len(self.positions),))
        np.testing.assert_array_equal(self.body.tets, self.tets)
        with self.assertRaises(ValueError):
            self.body.set_state(self.positions[:-1])
        with self.assertRaises(voxtet.NonFiniteError):
            self.body.set_state(np.full_like(self.positions, np.nan))

    def test_views_hold_the_body(self):
        view = self.body.positions[:, 0]
        for change in (self.body.remove, self.sim.close):
            with self.assertRaises(BufferError):
                change()
        before = view.copy()
        self.body.set_state(self.positions + 1)
        np.testing.assert_array_equal(view, before + 1)
        del view
        self.body.remove()
        with self.assertRaises(LookupError):
            self.body.positions
        self.sim.close()
        self.sim.close()
        for use in (lambda: self.sim.step(0.1), lambda: self.sim.add(self.positions, self.tets), lambda: self.sim.counters,
                    lambda: self.body.positions, lambda: self.sim.grid.contacts):
            with self.assertRaises(voxtet.InvalidStateError):
                use()

    def test_borrowed_contacts_hold_the_step(self):
        self.sim.add(self.positions + 0.3, self.tets)
        self.sim.step(0.01)
        with self.sim.grid.borrowed() as r:
            self.assertGreater(len(r.contacts), 0)
            with self.assertRaises(BufferError):
                self.sim.step(0.01)
        self.sim.step(0.01)

    def test_arrays_outlive_it(self):
        positions, grid = self.body.positions, self.sim.grid
        self.sim = self.body = None
        gc.collect()
        np.testing.assert_array_equal(positions, self.positions)
        grid.step()
        for refused in (grid.close, grid.clear):
            with self.assertRaises(voxtet.InvalidStateError):
                refused()

    def test_arguments(self):
        for wrong in ({"substeps": 0}, {"gravity": [0, 0]}, {"friction": -1}, {"floor": ([0, 0, 1], np.nan)}):
            with self.assertRaises(ValueError):
                voxtet.sim.Sim(**wrong)
        voxtet.sim.Sim(floor=None, detect_every=0, log=print).close()
        for wrong in ({"density": 0}, {"velocities": self.positions[:1]}, {"user_data": -1}):
            with self.assertRaises(ValueError):
                self.sim.add(self.positions, self.tets, **wrong)


if __name__ == "__main__":
    unittest.main()
