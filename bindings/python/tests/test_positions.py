"""Positions and tetrahedra as arrays: what is borrowed, what keeps it alive, and what is refused."""

import gc
import mmap
import tempfile
import unittest
import unittest.mock
import weakref

import numpy as np

import voxtet
from support import TET, GridCase, box, two_boxes
from voxtet import _library


class Borrowing(GridCase):
    def setUp(self):
        super().setUp()
        self.grid.step()
        self.expected = self.grid.hash

    def check(self, positions, tets=None):
        """The same contacts, from this very memory."""
        self.a.positions = positions
        self.grid.step()
        self.assertEqual(self.grid.hash, self.expected)
        positions[:] += 100
        self.grid.step()
        self.assertEqual(len(self.grid.contacts), 0)
        positions[:] -= 100

    def test_layouts(self):
        first = self.first
        wide = np.zeros((len(first), 7), np.float32)
        wide[:, 2:5] = first
        record = np.zeros(len(first), [("mass", "f4"), ("at", "f4", 3), ("id", "i8")])
        record["at"] = first
        skipping = np.zeros((2 * len(first), 3), np.float32)
        skipping[::2] = first
        columns = np.asfortranarray(first)
        spaced = np.zeros((3, 2 * len(first)), np.float32)
        spaced[:, ::2] = first.T
        for positions in (first.copy(), wide[:, 2:5], record["at"], skipping[::2], columns, spaced[:, ::2].T,
                          first.astype(np.float64), np.asfortranarray(first.astype(np.float64))):
            with self.subTest(strides=positions.strides, dtype=positions.dtype):
                self.check(np.array(positions) if not positions.flags.writeable else positions)
                self.assertIs(self.a.positions, positions)

    def test_layouts_that_the_library_cannot_follow(self):
        n = len(self.first)
        cube = np.zeros((n, 3, 2), np.float32)
        big = np.zeros((n, 4), np.float32)
        for positions in (self.first[::-1], self.first[:, ::-1], cube[:, :, 0], np.broadcast_to(self.first[:1], (n, 3)),
                          np.broadcast_to(self.first[:, :1], (n, 3)),
                          np.lib.stride_tricks.as_strided(big, (n, 3), (4, 4))):
            with self.subTest(strides=positions.strides), self.assertRaises(voxtet.InvalidArgumentError) as caught:
                self.a.positions = positions
            self.assertIn(str(positions.strides), str(caught.exception))
            self.assertIn("ascontiguousarray", str(caught.exception))
        self.assertIs(self.a.positions, self.first)
        self.check(self.first)

    def test_unaligned(self):
        raw = np.zeros(len(self.first) * 12 + 1, np.uint8)[1:]
        with self.assertRaisesRegex(ValueError, "aligned"):
            self.a.positions = raw.view(np.float32).reshape(-1, 3)

    def test_dtypes(self):
        for kind in (np.int32, np.float16, np.longdouble, np.complex64, object, ">f4", ">f8", bool, "U1"):
            with self.subTest(kind), self.assertRaisesRegex(TypeError, "dtype"):
                self.a.positions = np.zeros(self.first.shape, kind)
        for wrong in (self.first.tolist(), None, 1.0, "text", memoryview(self.first)):
            with self.subTest(type(wrong)), self.assertRaises(TypeError):
                self.a.positions = wrong
        with self.assertRaises(TypeError):
            self.a.positions = np.ma.masked_array(self.first, self.first > 0.5)

    def test_shapes(self):
        for wrong in (self.first[:-1], self.first.ravel(), self.first[:, :2], self.first[None], np.float32(1),
                      np.zeros((0, 3), np.float32)):
            with self.subTest(np.shape(wrong)), self.assertRaises((ValueError, TypeError)):
                self.a.positions = wrong
        with self.assertRaises(TypeError):  # no sequence of floats where memory is borrowed
            self.grid.add(self.first.tolist(), self.tets)

    def test_read_only(self):
        self.first.flags.writeable = False
        self.a.positions = self.first
        self.grid.step()
        self.assertEqual(self.grid.hash, self.expected)
        frozen = np.frombuffer(self.first.tobytes(), np.float32).reshape(-1, 3)
        self.a.positions = frozen
        self.grid.step()
        self.assertEqual(self.grid.hash, self.expected)

    def test_few_vertices(self):
        for count in (0, 1):
            for order in "CF":
                positions = np.zeros((count, 3), np.float64, order)
                mesh = self.grid.add(positions)
                self.assertEqual(mesh.info.vertex_count, count)
        one = np.zeros((9, 3), np.float32)[::3].T[:, :1].T  # strides of a view
        self.grid.add(one)
        self.grid.step()


class KeptAlive(GridCase):
    def test_dropped_by_the_caller(self):
        self.grid.step()
        expected = self.grid.hash
        watched = weakref.ref(self.first)
        del self.first
        gc.collect()
        junk = [np.full(3000, np.nan, np.float32) for _ in range(100)]
        self.grid.step()
        self.assertEqual(self.grid.hash, expected)
        self.assertIsNotNone(watched())
        del junk

    def test_let_go(self):
        watched = weakref.ref(self.first)
        self.a.positions = self.first.copy()
        self.first = None
        self.assertIsNone(watched())
        watched = weakref.ref(self.a.positions)
        self.a.remove()
        self.assertIsNone(watched())
        watched, self.second = weakref.ref(self.second), None
        self.grid.clear()
        self.assertIsNone(watched())

    def test_a_refused_mesh_keeps_nothing(self):
        positions = self.first.copy()
        watched = weakref.ref(positions)
        with self.assertRaises(voxtet.InvalidMeshError):
            self.grid.add(positions, [[0, 1, 2, 9999]])
        del positions
        self.assertIsNone(watched())

    def test_ctrl_c_as_the_library_returns(self):
        """The library borrows the array already, and Python raises before the next line."""
        longer = np.vstack([self.second, self.second])
        for name, call in (("vox_mesh_insert", lambda p: self.grid.add(p, self.tets)),
                           ("vox_mesh_bind_positions", lambda p: setattr(self.a, "positions", p)),
                           ("vox_mesh_bind_previous_positions", lambda p: setattr(self.a, "previous_positions", p)),
                           ("vox_mesh_set_topology", lambda p: self.a.set_topology(p, self.tets)),
                           ("vox_mesh_append_vertices", lambda p: self.b.append_vertices(p))):
            function = getattr(_library.vox, name)

            def interrupted(*arguments):
                function(*arguments)
                raise KeyboardInterrupt

            positions = (longer if "append" in name else self.first).copy()
            watched = weakref.ref(positions)
            with self.subTest(name):
                with unittest.mock.patch.object(_library.vox, name, interrupted), self.assertRaises(KeyboardInterrupt):
                    call(positions)
                del positions
                gc.collect()
                self.assertIsNotNone(watched())
        self.grid.step()
        self.grid.clear()
        gc.collect()
        self.assertIsNone(watched())

    def test_memory_that_would_be_freed(self):
        with self.assertRaises(ValueError):
            self.first.resize((1000, 3))
        data = bytearray(self.first.tobytes())
        self.a.positions = np.frombuffer(data, np.float32).reshape(-1, 3)
        with self.assertRaises(BufferError):
            data.clear()
        with tempfile.TemporaryFile() as file:
            file.write(self.first.tobytes())
            file.flush()
            mapped = mmap.mmap(file.fileno(), 0)
            self.a.positions = np.frombuffer(mapped, np.float32).reshape(-1, 3)
            with self.assertRaises(BufferError):
                mapped.close()
            self.grid.step()
            self.a.positions = self.first
            mapped.close()

    def test_tetrahedra_that_would_be_freed(self):
        mapped = mmap.mmap(-1, self.tets.nbytes)
        tets = np.ndarray(self.tets.shape, np.uint32, mapped)
        tets[:] = self.tets
        mesh = self.grid.add(self.first, tets, borrow_tets=True)
        del tets
        with self.assertRaises(BufferError):
            mapped.close()
        self.grid.step()
        mesh.remove()
        mapped.close()

    def test_shared_memory(self):
        from multiprocessing import shared_memory
        memory = shared_memory.SharedMemory(create=True, size=self.first.nbytes)
        try:
            shared = np.ndarray(self.first.shape, np.float32, memory.buf)
            shared[:] = self.first
            self.a.positions = shared
            del shared
            with self.assertRaises(BufferError):
                memory.close()
            self.grid.step()
            self.a.positions = self.first
        finally:
            memory.close()
            memory.unlink()

    def test_no_cycle(self):
        """A grid that is dropped goes at once, with its gigabytes, also while meshes are named elsewhere."""
        gc.disable()
        try:
            grid = voxtet.Grid(log=lambda level, text: None)
            positions = self.first.copy()
            mesh = grid.add(positions, self.tets, tag="x")
            own = grid.add(self.second, self.tets, copy=True)
            own.positions[:] += 1
            grid.step()
            with grid.borrowed() as r:
                r.contacts
            watched, kept = weakref.ref(grid), weakref.ref(positions)
            del grid, positions, mesh, own, r
            self.assertIsNone(watched())
            self.assertIsNone(kept())
        finally:
            gc.enable()


class Dlpack(GridCase):
    class Tensor:
        """As torch and jax have them."""

        def __init__(self, array, device=(1, 0)):
            self.array, self.device = array, device

        def __dlpack__(self, **options):
            return self.array.__dlpack__()

        def __dlpack_device__(self):
            return self.device

    def test_zero_copy(self):
        self.a.positions = self.Tensor(self.first)
        self.assertTrue(np.shares_memory(self.a.positions, self.first))
        self.grid.step()
        self.assertGreater(len(self.grid.contacts), 0)
        self.grid.add(self.Tensor(self.first), self.Tensor(self.tets.astype(np.int64)), copy=True)

    def test_other_devices(self):
        with self.assertRaisesRegex(TypeError, "CUDA:1"):
            self.a.positions = self.Tensor(self.first, (2, 1))

    def test_results(self):
        self.grid.step()
        fields = np.from_dlpack(self.grid.find_constraints().weights)
        self.assertEqual(fields.shape[1], 5)


class Tets(GridCase):
    def test_any_integers(self):
        for kind in (np.int8, np.int16, np.uint16, np.int64, np.uint64, ">i4"):
            tets = self.tets.astype(kind)
            if (tets == self.tets).all():
                np.testing.assert_array_equal(self.grid.add(self.first, tets).tets, self.tets)
        np.testing.assert_array_equal(self.grid.add(self.first, self.tets.tolist()).tets, self.tets)
        np.testing.assert_array_equal(self.grid.add(self.first, np.asfortranarray(self.tets)).tets, self.tets)
        self.assertEqual(self.grid.add(self.first, []).info.tet_count, 0)

    def test_numbers_that_would_wrap(self):
        for number in (2**32 + 1, -1, 2**63 - 1):
            tets = self.tets.astype(np.int64)
            tets[3, 2] = number
            with self.subTest(number), self.assertRaises(voxtet.InvalidArgumentError) as caught:
                self.grid.add(self.first, tets)
            self.assertIn(str(number), str(caught.exception))
            self.assertIn("[3, 2]", str(caught.exception))
        with self.assertRaises(voxtet.InvalidArgumentError):
            self.a.remove_tets(np.array([2**32]))

    def test_wrong(self):
        for wrong in (self.tets.astype(float), self.tets > 3, self.tets.astype(object), "tets", 3.5, [[0.5] * 4]):
            with self.subTest(wrong), self.assertRaises(TypeError):
                self.grid.add(self.first, wrong)
        for wrong in (self.tets[:, :3], self.tets.ravel(), self.tets[None], 3):
            with self.subTest(wrong), self.assertRaises(ValueError):
                self.grid.add(self.first, wrong)
        with self.assertRaises(voxtet.InvalidMeshError) as caught:
            self.grid.add(self.first, [[0, 1, 2, 12345]])
        self.assertIn("12345", str(caught.exception))


class Copies(GridCase):
    def test_copied(self):
        for positions in (self.first, self.first[::-1][::-1], self.first.tolist(), self.first.astype(">f4").astype("f4")):
            mesh = self.grid.add(positions, self.tets, copy=True)
            np.testing.assert_array_equal(mesh.positions, self.first)
            self.assertFalse(np.shares_memory(mesh.positions, self.first))
        for wrong in ([[0, 0, 0]], np.zeros((4, 3), np.int32)):
            with self.assertRaises(TypeError):
                self.grid.add(wrong, TET, copy=True)

    def test_positions_later(self):
        mesh = self.grid.add(None, self.tets, vertex_count=len(self.first))
        self.assertIsNone(mesh.positions)
        with self.assertRaises(voxtet.InvalidStateError):
            self.grid.step()
        mesh.positions = self.first + np.float32(5)
        self.grid.step()
        with self.assertRaises(ValueError):
            self.grid.add(self.first, self.tets, vertex_count=3)

    def test_doubles(self):
        a, b, tets = two_boxes(dtype=np.float64)
        with voxtet.Grid() as grid:
            first = grid.add(a, tets, rest_positions=a)
            second = grid.add(b, tets, copy=True)
            grid.step()
            self.assertEqual(second.positions.dtype, np.float64)
            self.assertEqual(set(grid.contacts.body_a), {first.id, second.id})
            grid.add(a, tets, rest_positions=a.astype(np.float32))
            with self.assertRaises(ValueError):
                grid.add(a, tets, rest_positions=a[:-1])


if __name__ == "__main__":
    unittest.main()
