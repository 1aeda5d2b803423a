"""Memory that the library lends: it is never read after its end, because what would end it raises BufferError."""

import gc
import unittest
import weakref

import numpy as np

import voxtet
from support import GridCase, two_boxes


class Borrowed(GridCase):
    options = {"constraints": True}

    def setUp(self):
        super().setUp()
        self.grid.step()

    def test_equal_to_copies(self):
        with self.grid.borrowed() as r:
            for name in ("contacts", "interiors", "constraints", "pair_offsets", "pairs", "pair_contacts"):
                with self.subTest(name):
                    mine, theirs = getattr(self.grid, name), getattr(r, name)
                    np.testing.assert_array_equal(mine, theirs)
                    self.assertEqual((type(mine), mine.dtype), (type(theirs), theirs.dtype))
                    self.assertFalse(theirs.flags.writeable)
                    self.assertFalse(theirs.flags.owndata)
                    self.assertTrue(mine.flags.writeable)
            with self.assertRaises(ValueError):
                r.contacts["tet"] = 0
            with self.assertRaises(ValueError):
                r.contacts.flags.writeable = True
            del mine, theirs

    def changes(self):
        return {"step": self.grid.step, "close": self.grid.close, "clear": self.grid.clear,
                "reserve": lambda: self.grid.reserve(4, 4), "step_all": lambda: voxtet.step_all([self.grid]),
                "flags": lambda: self.grid.set_flags(edges=True), "margin": lambda: setattr(self.grid, "margin", 0.1)}

    def refused(self, changes=None):
        for name, change in (changes or self.changes()).items():
            with self.subTest(name), self.assertRaises(BufferError):
                change()
        self.assertFalse(self.grid.closed)

    def test_open_borrow(self):
        with self.grid.borrowed():
            self.refused()
        self.grid.step()

    def test_slices_and_fields_hold_it(self):
        expected = self.grid.constraints.weights[3].copy()
        with self.grid.borrowed() as r:
            kept = r.constraints["weights"][3][::-1]
        gc.collect()
        self.refused()
        np.testing.assert_array_equal(kept[::-1], expected)
        del kept
        self.grid.step()

    def test_other_ways_to_hold_it(self):
        with self.grid.borrowed() as r:
            of_dlpack = np.lib.NumpyVersion(np.__version__) >= "2.1.0"  # before, not of arrays that are read-only
            for way in (lambda a: memoryview(a.view(np.uint8)), lambda a: np.asarray(a), lambda a: a.T,
                        lambda a: a.view(np.uint8).reshape(-1, 4), lambda a: iter(a), lambda a: a[0],
                        lambda a: np.from_dlpack(a.tet) if of_dlpack else a.tet, lambda a: a.base):
                held = way(r.contacts)
        self.refused({"step": self.grid.step})
        del held
        with self.grid.borrowed() as r:
            item = r.contacts[0]  # numpy's single elements look into the array
        self.refused({"step": self.grid.step})
        del item
        self.grid.step()

    def test_after_the_end(self):
        with self.grid.borrowed() as r:
            pass
        with self.assertRaises(voxtet.InvalidStateError):
            r.contacts
        with self.assertRaises(voxtet.InvalidStateError):
            self.grid.borrowed().contacts

    def test_array_outlives_the_grid(self):
        expected = self.grid.contacts
        with self.grid.borrowed() as r:
            kept = r.contacts
        del r
        watched = weakref.ref(self.grid)
        grid, self.grid = self.grid, voxtet.Grid()  # for the clean-up
        self.a = self.b = None
        del grid
        self._cleanups.clear()
        gc.collect()
        self.assertIsNone(watched())
        np.testing.assert_array_equal(kept, expected)

    def test_constraints(self):
        with self.grid.borrowed() as r:
            found = r.find_constraints("closest")  # no constraint is borrowed yet
            self.assertFalse(found.flags.owndata)
            offsets = r.pair_offsets
            for held in (found, offsets):
                with self.assertRaises(BufferError):
                    self.grid.find_constraints()
            del held, found
            with self.assertRaises(BufferError):
                r.find_constraints()
            del offsets
            found = r.find_constraints()
        with self.assertRaises(BufferError):
            self.grid.step()
        del found
        self.grid.step()

    def test_another_thread_leaves_the_with(self):
        """... while this one waits for the grid: what it gets is guarded, or it raises."""
        for name in ("contacts", "pair_contacts", "constraints", "pair_offsets"):
            with self.subTest(name):
                borrowed, lock = self.grid.borrowed(), self.grid._lock
                results = borrowed.__enter__()

                class LeavesMeanwhile:
                    def __enter__(self):
                        borrowed.__exit__()

                    def __exit__(self, *_):
                        pass

                self.grid._lock = LeavesMeanwhile()
                try:
                    kept = getattr(results, name)
                except voxtet.InvalidStateError:
                    continue
                finally:
                    self.grid._lock = lock
                self.refused({name: self.grid.step})
                del kept

    def test_nothing_to_borrow(self):
        self.first += 100
        self.grid.step()
        with self.grid.borrowed() as r:
            none = r.contacts
        self.grid.step()
        self.assertEqual(len(none), 0)

    def test_exception_inside_is_not_hidden(self):
        with self.assertRaisesRegex(KeyError, "mine"):
            with voxtet.Grid() as grid:
                first, second, tets = two_boxes()
                grid.add(first, tets)
                grid.add(second, tets)
                grid.step()
                with grid.borrowed() as r:
                    kept = r.contacts
                    raise KeyError("mine")
        del kept
        with self.assertRaises(BufferError):
            with self.grid:
                with self.grid.borrowed() as r:
                    kept = r.contacts


class OwnPositions(GridCase):
    """Positions of the library's are written to by the caller, so they have the same guard."""

    def setUp(self):
        super().setUp()
        self.own = self.grid.add(self.first + np.float32(0.3), self.tets, copy=True)

    def test_moves_the_mesh(self):
        self.grid.step()
        before = self.grid.hash
        positions = self.own.positions
        self.assertTrue(positions.flags.writeable)
        positions += 0.1
        self.grid.step()
        self.assertNotEqual(self.grid.hash, before)
        self.own.positions -= np.float32(0.1)  # reads, subtracts in place, sets the same array
        np.testing.assert_allclose(positions, self.first + np.float32(0.3), atol=1e-6)
        self.assertTrue(self.own.info.owns_positions)

    def test_what_would_end_it(self):
        column = self.own.positions[:, 1]

        def bind():
            self.own.positions = self.first

        for change in (self.own.remove, bind, self.grid.clear, self.grid.close,
                       lambda: self.own.set_topology(self.first, self.tets)):
            with self.assertRaises(BufferError):
                change()
        self.grid.step()
        self.own.set_topology(None, self.tets)  # keeps the positions
        column += 1
        del column
        bind()
        self.assertIs(self.own.positions, self.first)
        self.own.remove()

    def test_one_mesh_borrows_those_of_another(self):
        self.a.positions = self.own.positions
        with self.assertRaises(BufferError):
            self.own.remove()
        self.a.positions = self.first
        self.own.remove()

    def test_kept_by_the_array_alone(self):
        positions = self.own.positions
        grid, self.grid = self.grid, voxtet.Grid()
        self.own = self.a = self.b = None
        self._cleanups.clear()
        del grid
        gc.collect()
        positions += 1


if __name__ == "__main__":
    unittest.main()
