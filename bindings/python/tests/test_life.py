"""Use after close, threads, forks, memory over many grids, and results of the library as exceptions."""

import gc
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

import numpy as np

import voxtet
from support import GridCase, box, two_boxes
from voxtet import _c, _library, errors


class Close(GridCase):
    def test_every_use_after_close_raises(self):
        self.grid.step()
        grid, mesh, locator = self.grid, self.a, self.grid.locator()
        with grid.borrowed() as r:
            pass
        grid.close()
        grid.close()  # twice does nothing
        self.assertTrue(grid.closed)
        calls = [grid.step, lambda: grid.contacts, grid.find_constraints, lambda: grid.add(self.first, self.tets),
                 lambda: grid.remove(mesh), lambda: len(grid), lambda: grid.meshes, lambda: grid.hash, grid.snapshot,
                 grid.locator, lambda: locator.update(grid), lambda: grid.counters, lambda: grid.info,
                 lambda: voxtet.step_all([grid]), grid.borrowed().__enter__, grid.__enter__, lambda: grid[mesh.id],
                 lambda: mesh.positions, lambda: setattr(mesh, "positions", self.first), lambda: mesh.info,
                 lambda: mesh.filter, mesh.remove, lambda: mesh in grid, grid.clear, lambda: grid.pairs,
                 lambda: setattr(mesh, "tag", 1)]
        for call in calls:
            with self.assertRaises(voxtet.InvalidStateError) as caught:
                call()
            self.assertEqual(str(caught.exception), "the grid is closed")
        with self.assertRaises(voxtet.InvalidStateError):
            r.contacts
        self.assertFalse(mesh.valid)
        self.assertIn("closed", repr(grid))
        repr(mesh)

    def test_a_failed_grid_is_dropped(self):
        for options in ({"cell_size": -1}, {"workers": 1000}, {"reference": voxtet.Reference(hash_table_size=2**40)}, {"byte_budget": 1}):
            with self.assertRaises(voxtet.VoxError):
                voxtet.Grid(**options)
        gc.collect()

    def test_locator(self):
        with self.grid.locator() as locator:
            self.grid.close()
            self.assertGreater(len(locator.find_point_hits(self.first)), 0)
        point = [0, 0, 0]
        for call in (lambda: locator.find_point_hits(point), lambda: locator.find_closest(point), lambda: locator.locate(point),
                     lambda: locator.find_box_hits(point, point), lambda: locator.find_ray_hits(point, point),
                     lambda: locator.test_rays(point, point), lambda: locator.epoch, lambda: locator.user_data(1)):
            with self.assertRaisesRegex(voxtet.InvalidStateError, "the locator is closed"):
                call()
        locator.close()

    def test_a_locator_that_is_closed_within_a_question(self):
        """... after the library said that there are more hits than expected, and before it is asked for them."""
        locator = self.grid.locator()
        find = _library.vox.vox_locator_find_box_hits

        def closes(*arguments):
            find(*arguments)
            locator.close()

        with unittest.mock.patch.object(_library.vox, "vox_locator_find_box_hits", closes):
            hits = locator.find_box_hits([0, 0, 0], [2, 2, 2])
        self.assertEqual(len(hits), 2 * len(self.tets))


class Errors(unittest.TestCase):
    def test_a_class_for_each_code(self):
        for code in _c.Result:
            if code != _c.Result.OK:
                error = errors.error_of(code, "text")
                self.assertEqual(error.code, code)
                self.assertEqual(str(error), "text")
                self.assertIsInstance(error, voxtet.VoxError)
        self.assertIs(type(errors.error_of(-99, "text")), voxtet.InternalError)  # of a later library
        builtin = {"InvalidArgument": ValueError, "InvalidMesh": ValueError, "Format": ValueError, "InvalidState": RuntimeError,
                   "InvalidHandle": LookupError, "NonFinite": ArithmeticError, "Limit": OverflowError, "Budget": MemoryError,
                   "OutOfMemory": MemoryError, "Unsupported": NotImplementedError, "File": OSError}
        for name, kind in builtin.items():
            self.assertTrue(issubclass(getattr(voxtet, name + "Error"), kind))

    def test_text_is_that_of_the_thread(self):
        texts = {}

        def fail(i):
            for _ in range(200):
                try:
                    with voxtet.Grid() as grid:
                        grid.add(np.zeros((i + 4, 3), np.float32), [[0, 1, 2, 1000 + i]])
                except voxtet.InvalidMeshError as error:
                    texts.setdefault(i, set()).add(str(error))

        threads = [threading.Thread(target=fail, args=(i,)) for i in range(8)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        for i in range(8):
            self.assertEqual(len(texts[i]), 1)
            self.assertIn(f"{1000 + i} of {i + 4}", *texts[i])


class Threads(GridCase):
    def test_one_grid_from_eight_threads(self):
        self.grid.step()
        expected, hashes, failed = self.grid.hash, [], []

        def work():
            try:
                for _ in range(40):
                    self.grid.step()
                    hashes.append(self.grid.hash)
                    assert len(self.grid.contacts) == len(self.grid.find_constraints())
            except (voxtet.InvalidStateError, AssertionError):
                pass  # another thread stepped between
            except BaseException as error:
                failed.append(error)

        threads = [threading.Thread(target=work) for _ in range(8)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        self.assertEqual(failed, [])
        self.assertEqual(set(hashes), {expected})

    def test_changes_and_reads_at_once(self):
        stop, failed = threading.Event(), []

        def repeat(work):
            while not stop.is_set():
                try:
                    work()
                except (voxtet.VoxError, BufferError):
                    pass
                except BaseException as error:
                    failed.append(error)
                    return

        def insert():
            mesh = self.grid.add(self.first + np.float32(0.2), self.tets, copy=True, tag=1)
            mesh.positions[:] += 0.1
            mesh.remove()

        def add():
            if len(self.grid) < 20:  # as `clear` may have to wait for its turn
                self.grid.add(self.first, self.tets)

        def borrow():
            with self.grid.borrowed() as r:
                r.contacts.tet.sum()

        locator = self.grid.locator()

        def ask():
            locator.update(self.grid)
            locator.find_point_hits(self.first)

        jobs = [self.grid.step, insert, borrow, ask, ask, self.grid.find_constraints, self.grid.clear,
                lambda: [m.tag for m in self.grid], add, self.grid.snapshot]
        threads = [threading.Thread(target=repeat, args=(job,)) for job in jobs]
        [t.start() for t in threads]
        time.sleep(1.5)
        stop.set()
        [t.join() for t in threads]
        self.assertEqual(failed, [])

    def test_closing_while_others_work(self):
        for _ in range(20):
            first, second, tets = two_boxes(3)
            grid = voxtet.Grid()
            grid.add(first, tets)
            grid.add(second, tets)
            locator, failed = grid.locator(), []

            def work():
                try:
                    while True:
                        grid.step()
                        grid.contacts
                        locator.find_point_hits(first)
                except voxtet.InvalidStateError:  # never that of a null pointer
                    pass
                except BaseException as error:
                    failed.append(error)

            threads = [threading.Thread(target=work) for _ in range(4)]
            [t.start() for t in threads]
            time.sleep(0.01)
            grid.close()
            locator.close()
            [t.join() for t in threads]
            self.assertEqual(failed, [])

    def test_closed_while_a_thread_waits(self):
        """It gets the lock of a grid that is no more."""
        waiting, texts = threading.Semaphore(0), []

        def work(call):
            waiting.release()
            try:
                call()
            except voxtet.InvalidStateError as error:
                texts.append(str(error))

        calls = (self.grid.step, lambda: self.grid.contacts, lambda: self.a.positions, lambda: voxtet.step_all([self.grid]),
                 self.grid.locator)
        threads = [threading.Thread(target=work, args=(call,)) for call in calls]
        lock = self.grid._lock
        with lock:
            [t.start() for t in threads]
            [waiting.acquire() for _ in threads]
            time.sleep(0.1)
            self.grid._forget()
        [t.join() for t in threads]
        self.assertEqual(texts, ["the grid is closed"] * len(calls))

    def test_replaced_while_others_read(self):
        """A grid that nobody holds any more goes, on whichever thread, but not before arrays over its memory."""
        first, second, tets = two_boxes(3)

        def made():
            grid = voxtet.Grid()
            grid.add(first, tets)
            grid.add(second, tets)
            grid.step()
            return grid

        grids, expected, failed, end = [made()], made().contacts, [], time.monotonic() + 1

        def work():
            try:
                while time.monotonic() < end:
                    results = grids[0].borrowed()
                    results.__enter__()
                    contacts, results = results.contacts, None
                    grids[0] = made()
                    assert contacts.tobytes() == expected.tobytes()
            except BaseException as error:
                failed.append(error)

        threads = [threading.Thread(target=work) for _ in range(4)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        self.assertEqual(failed, [])

    def test_a_step_lets_other_threads_run(self):
        positions, tets = box(24, dtype=np.float64)
        with voxtet.Grid(reference=voxtet.Reference()) as grid:
            grid.add(positions, tets)
            grid.add(positions + 0.013, tets)
            counted, stop = [0], threading.Event()

            def count():
                while not stop.is_set():
                    counted[0] += 1

            thread = threading.Thread(target=count)
            thread.start()
            while counted[0] == 0:
                time.sleep(0.001)
            before = counted[0]
            grid.step()
            during = counted[0] - before
            stop.set()
            thread.join()
        self.assertGreater(during, 0)

    def test_many_in_two_orders(self):
        first, second, tets = two_boxes(2)
        grids = [voxtet.Grid() for _ in range(10)]
        for grid in grids:
            grid.add(first, tets)
            grid.add(second, tets)

        def work(order):
            for _ in range(50):
                voxtet.step_all(order, 1)

        threads = [threading.Thread(target=work, args=(order,), daemon=True) for order in (grids, grids[::-1])]
        [t.start() for t in threads]
        [t.join(60) for t in threads]
        self.assertFalse(any(t.is_alive() for t in threads))


class Processes(GridCase):
    @unittest.skipUnless(hasattr(os, "fork"), "no fork here")
    def test_fork(self):
        """A serial grid survives it. Grids with workers: docs say spawn."""
        self.grid.step()
        expected = self.grid.hash
        process = os.fork()
        if process == 0:
            try:
                self.grid.step()
                os._exit(0 if self.grid.hash == expected else 1)
            except BaseException:
                os._exit(2)
        self.assertEqual(os.waitpid(process, 0)[1], 0)

    def test_spawn(self):
        import multiprocessing
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            self.grid.step()
            self.assertEqual(pool.apply(_hash_of, (self.grid,)), self.grid.hash)

    def test_end_of_the_interpreter(self):
        """With grids, locators and borrowed arrays alive, also in a cycle and in globals."""
        code = """
import sys; sys.path.insert(0, sys.argv[1])
import numpy as np, voxtet
from support import two_boxes
a, b, tets = two_boxes()
grid = voxtet.Grid(log=print); grid.add(a, tets); grid.add(b, tets, copy=True); grid.step()
locator = grid.locator(); r = grid.borrowed(); r.__enter__(); array = r.contacts
mapped = grid.meshes[1].positions
cycle = [grid, array]; cycle.append(cycle)
voxtet.keep = (grid, locator, array)
"""
        run = subprocess.run([sys.executable, "-c", code, os.path.dirname(os.path.abspath(__file__))], capture_output=True,
                             text=True, timeout=120)
        self.assertEqual((run.returncode, run.stderr), (0, ""))


def _hash_of(grid):
    grid.step()
    return grid.hash


class Memory(unittest.TestCase):
    @staticmethod
    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    @unittest.skipUnless(os.path.exists("/proc/self/statm"), "no /proc here")
    def test_flat(self):
        """10 000 grids: made, filled, stepped, read in every way, closed or dropped."""
        first, second, tets = two_boxes(2)

        def life(i):
            grid = voxtet.Grid(log=lambda level, text: None)
            a = grid.add(first, tets, tag=i)
            b = grid.add(second, tets, copy=True)
            grid.step()
            grid.contacts, grid.pairs, grid.find_constraints()
            with grid.borrowed() as r:
                r.contacts
            b.positions[:] += 0
            a.positions = first
            if i % 10 == 0:
                grid.locator().find_point_hits(first)
                voxtet.Grid.from_snapshot(grid.snapshot())
                try:
                    grid.add(first, [[0, 0, 0, 999]])
                except voxtet.VoxError:
                    pass
            if i % 2:
                grid.close()

        for i in range(1000):
            life(i)
        gc.collect()
        before = self.resident()
        for i in range(10000):
            life(i)
        gc.collect()
        self.assertLess(self.resident() - before, 2 << 20)

    @unittest.skipUnless(os.path.exists("/proc/self/statm"), "no /proc here")
    def test_flat_in_one_grid(self):
        first, second, tets = two_boxes(2)
        with voxtet.Grid() as grid:
            grid.add(first, tets)
            own = grid.add(second, tets, copy=True)

            def frame():
                grid.step()
                with grid.borrowed() as r:
                    for _ in range(5):
                        r.contacts, r.pairs
                for _ in range(5):
                    own.positions[:] += 0
                grid.find_constraints()
                grid.add(first, tets).remove()

            for _ in range(500):
                frame()
            gc.collect()
            before = self.resident()
            for _ in range(3000):
                frame()
            gc.collect()
            self.assertLess(self.resident() - before, 1 << 20)


class Library(unittest.TestCase):
    def test_another_abi_is_refused(self):
        """With both numbers in the text."""
        code = f"""
import ctypes, importlib.util, os, sys, types
package = types.ModuleType("voxtet")
package.__path__ = [os.path.dirname(importlib.util.find_spec("voxtet").origin)]
sys.modules["voxtet"] = package
import voxtet._c
voxtet._c.VOX_ABI_VERSION = 77
load = ctypes.CDLL
ctypes.CDLL = lambda path, **options: load({_library.find("vox")!r}, **options)
try:
    import voxtet._library
except ImportError as error:
    print(error)
"""
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
        self.assertIn(f"version {_c.VOX_ABI_VERSION} of the binary interface", run.stdout, run.stderr)
        self.assertIn("version 77", run.stdout)

    def test_a_missing_library(self):
        code = ("import voxtet._c as c\n")
        environment = {**os.environ, "VOXTET_LIBRARY_DIR": os.devnull, "LD_LIBRARY_PATH": ""}
        source = os.path.dirname(os.path.dirname(os.path.abspath(voxtet.__file__)))
        if os.path.exists(os.path.join(source, "voxtet", "lib")):
            self.skipTest("the installed package has its libraries inside")
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, env=environment)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("VOXTET_LIBRARY_DIR", run.stderr)

    def test_a_build_folder_with_the_core_alone(self):
        """The core works; whoever uses what is not built reads what to build."""
        found = _library.find("vox")
        if not os.path.isabs(found) or os.path.dirname(found) == os.path.join(os.path.dirname(_library.__file__), "lib"):
            self.skipTest("the library is not one of a build folder")
        code = "import voxtet\nvoxtet.Grid().close()\nprint('core')\nvoxtet.io"
        with tempfile.TemporaryDirectory() as build:
            os.makedirs(os.path.join(build, "src", "io"))
            os.symlink(found, os.path.join(build, "src", os.path.basename(found)))
            environment = {**os.environ, "VOXTET_LIBRARY_DIR": build, "LD_LIBRARY_PATH": ""}
            run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, env=environment)
        self.assertEqual(run.stdout, "core\n", run.stderr)
        self.assertIn(f"VOXTET_LIBRARY_DIR is {build}, where it is not built: cmake --build BUILD_FOLDER --target vox_io", run.stderr)


if __name__ == "__main__":
    unittest.main()
