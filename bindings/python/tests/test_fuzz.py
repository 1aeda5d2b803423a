"""Garbage in every argument, for a bounded time (VOXTET_FUZZ_SECONDS, 5 by default): nothing but an exception of Python's
kind comes back, and the grid goes on. VOXTET_FUZZ_SEED repeats a run; a crash names it, as it is printed before."""

import faulthandler
import math
import os
import random
import sys
import threading
import time
import unittest
import warnings

import numpy as np

import voxtet
from support import box, two_boxes

ALLOWED = (voxtet.VoxError, TypeError, ValueError, BufferError, OverflowError, LookupError, AttributeError)
SECONDS = float(os.environ.get("VOXTET_FUZZ_SECONDS", "5"))


def arrays(random_):
    """Arrays of every wrong and right dtype, shape and stride."""
    kind = random_.choice(["f4", "f8", ">f4", ">f8", "f2", "i1", "u4", "i8", "u8", "c8", "?", "O", "S3", "M8[s]", "f4,f4,f4"])
    shape = random_.choice([(), (0,), (3,), (4,), (0, 3), (0, 4), (1, 3), (5, 3), (27, 3), (27, 4), (40, 4), (3, 27), (27, 3, 1)])
    array = np.zeros(shape, kind)
    if array.dtype.kind in "fiu" and array.size:
        low, high = random_.choice([(0, 2), (0, 30), (-5, 5), (0, 2**31)])
        array = np.random.default_rng(random_.getrandbits(32)).uniform(low, high, shape).astype(
            np.int64 if array.dtype.kind in "iu" else np.float64).astype(kind, casting="unsafe")
        if array.dtype.kind == "f" and random_.random() < 0.1:
            array.flat[random_.randrange(array.size)] = random_.choice([math.nan, math.inf, -math.inf, 3e38, 1e-45])
    for _ in range(random_.randrange(3)):
        array = random_.choice([lambda a: a[::-1], lambda a: a.T, lambda a: np.asfortranarray(a), lambda a: a[..., ::-1],
                                lambda a: a[::2], lambda a: a[..., None][..., 0], lambda a: np.ascontiguousarray(a),
                                lambda a: np.broadcast_to(a, (2, *a.shape))[0], lambda a: np.ma.masked_array(a),
                                lambda a: np.frombuffer(b"\0" + a.tobytes(), np.uint8)[1:].view(a.dtype)
                                if a.dtype.kind in "fiu" and a.size else a,
                                lambda a: np.lib.stride_tricks.as_strided(a, a.shape, tuple(0 for _ in a.strides))])(array)
    if random_.random() < 0.2:
        array = array.view()
        array.flags.writeable = False
    return array


def value(random_):
    """Anything at all."""
    return random_.choice([
        lambda: arrays(random_), lambda: arrays(random_), lambda: arrays(random_),
        lambda: random_.choice([0, 1, 2, 3, 7, -1, 2**31, 2**32, 2**32 + 1, 2**63, 2**64, -2**63, 10**30]),
        lambda: random_.choice([0.0, -0.0, 0.5, 1e-300, 1e300, math.nan, math.inf, -math.inf, 1.5]),
        lambda: random_.choice([None, True, False, "", "fast", "auto", "x\0y", b"bytes", object(), [], {}, (), [[]], [1, 2, 3],
                                [0, 1], [[0, 1, 2, 3]], [["a"]], np.float32(1), np.uint64(2**64 - 1), voxtet.Filter(),
                                voxtet.Filter(group=3, self_collision=True, self_rings=2), lambda *a: None, len, ...,
                                np.eye(4), np.eye(3, 4), slice(1), 1j]),
    ])()


GRID = ["add", "remove", "step", "clear", "reserve", "set_flags", "set_pair_enabled", "find_constraints", "locator",
        "suggest_cell_size", "snapshot", "__getitem__", "__contains__", "close"]
LOCATOR = ["update", "find_point_hits", "find_closest", "find_box_hits", "find_ray_hits", "test_rays", "locate", "user_data"]
MESH = ["append_tets", "append_vertices", "remove_tets", "remove_vertices", "replace_tets", "set_tets_enabled", "set_topology",
        "mark_moved", "remove"]
READ = ["contacts", "interiors", "pairs", "pair_contacts", "constraints", "pair_offsets", "meshes", "counters", "info", "failures",
        "epoch", "hash", "flags"]
SET_GRID = ["cell_size", "workers", "margin"]
SET_MESH = ["positions", "previous_positions", "transform", "filter", "enabled", "tag"]
NAMES = {"add": ["copy", "user_data", "vertex_count", "filter", "self_collision", "rest_positions", "borrow_tets", "tag"],
         "append_vertices": ["copies_of", "rest_positions"], "set_topology": ["vertex_count", "copy", "rest_positions",
                                                                              "borrow_tets"],
         "set_flags": ["constraints", "edges", "skip_bad_bodies"], "find_point_hits": ["mask", "excluded"],
         "find_closest": ["max_distance", "mask", "excluded"], "find_ray_hits": ["first", "mask"],
         "find_constraints": ["method", "body_a", "body_b", "mask", "closest_budget"]}
FREE = [lambda v: voxtet.Grid(v()), lambda v: voxtet.Grid(workers=v()), lambda v: voxtet.Grid(reference=v()),
        lambda v: voxtet.Grid(world=v()), lambda v: voxtet.Grid(log=v()), lambda v: voxtet.Grid(byte_budget=v()),
        lambda v: voxtet.Grid.from_snapshot(v()), lambda v: voxtet.suggest_cell_size(v(), v(), model=v()),
        lambda v: voxtet.suggest_cell_size(v()), lambda v: voxtet.suggest_cell_size(*box(2), weights=v()),
        lambda v: voxtet.Grid(reference=voxtet.Reference(weights=v())), lambda v: voxtet.minimise(v(), v(), v()),
        lambda v: voxtet.locate(v(), v(), v()), lambda v: voxtet.step_all(v()),
        lambda v: voxtet.measure_geometry(v(), v()), lambda v: voxtet.Primitives.boxes(v(), v(), radii=v()),
        lambda v: voxtet.ForeignGrid(v()).suggest(), lambda v: voxtet.ForeignGrid(v(), v(), radius=v()).suggest(),
        lambda v: voxtet.ForeignGrid((v(), v()), known=v()).suggest(), lambda v: voxtet.ForeignGrid(v()).count(v()),
        lambda v: voxtet.ForeignGrid(voxtet.Primitives(v(), v(), radii=v(), radius=v()), cells_stored=v(), cells_queried=v(),
                                     cells_kept=v()).suggest(),
        lambda v: voxtet.ForeignGrid(v(), weights=v(), min_cell_size=v(), zone_loss=v()).suggest(),
        lambda v: voxtet.ForeignGrid(v()).fit(v()), lambda v: voxtet.ForeignGrid(v()).fit([(v(), v()) for _ in range(3)]),
        lambda v: voxtet.ForeignGrid(v()).tune(v(), first=v()), lambda v: voxtet.tune(lambda size: v(), v() or 1, max_runs=v()),
        lambda v: voxtet.tune(lambda size: v(), 1)]


class Fuzz(unittest.TestCase):
    def setUp(self):
        faulthandler.enable()
        warnings.simplefilter("ignore")  # numpy's, about garbage
        self.seed = int(os.environ.get("VOXTET_FUZZ_SEED", random.SystemRandom().getrandbits(32)))
        print(f"VOXTET_FUZZ_SEED={self.seed}", file=sys.stderr, flush=True)

    def life(self, random_, steps):
        """One grid: good calls among garbage, on it, its meshes, and memory borrowed from it."""
        positions, tets = box(2)
        grid = voxtet.Grid(constraints=random_.random() < 0.5, edges=random_.random() < 0.5, byte_budget=1 << 26)
        meshes, held, locator = [], [], voxtet.Locator(positions, tets)

        def sane():
            p = positions + np.float32(random_.random())
            return random_.choice([
                lambda: meshes.append(grid.add(p, tets, copy=random_.random() < 0.5)), grid.step,
                lambda: setattr(meshes[0], "previous_positions", p), lambda: [grid.find_constraints(m) for m in ("closest", "none")],
                lambda: held.append(meshes[-1].positions), held.clear, lambda: held.append(grid.locator()),
                lambda: held.append(grid.borrowed().__enter__()),
                lambda: [held.append(h.contacts) for h in held if isinstance(h, voxtet.Borrowed)],
                lambda: [held.append(h.constraints) for h in held if isinstance(h, voxtet.Borrowed)],
                lambda: [np.sum(h["tet"]) for h in held if isinstance(h, voxtet.Contacts) and h.dtype.names],
                lambda: [h.__setitem__(0, 1) for h in held if isinstance(h, np.ndarray)],
                lambda: [h.find_point_hits(p) for h in held if isinstance(h, voxtet.Locator)],
                lambda: voxtet.Grid.from_snapshot(grid.snapshot()).step()])()

        def one():
            arguments = lambda name: (  # noqa: E731
                [random_.choice(meshes) if meshes and random_.random() < 0.3 else value(random_)
                 for _ in range(random_.randrange(4))],
                {key: value(random_) for key in NAMES.get(name, ()) if random_.random() < 0.2})
            case = random_.randrange(10)
            if case < 3:
                sane()
            elif case == 3:
                name = random_.choice(GRID)
                if name == "close" and random_.random() < 0.9:
                    return
                a, k = arguments(name)
                getattr(grid, name)(*a, **k)
            elif case == 4 and meshes:
                name = random_.choice(MESH)
                a, k = arguments(name)
                getattr(random_.choice(meshes), name)(*a, **k)
            elif case == 5:
                getattr(grid, random_.choice(READ))
            elif case == 6:
                setattr(grid, random_.choice(SET_GRID), value(random_))
            elif case == 7 and meshes:
                setattr(random_.choice(meshes), random_.choice(SET_MESH), value(random_))
            elif case == 8:
                name = random_.choice(LOCATOR)
                a, k = arguments(name)
                getattr(locator, name)(*a, **k)
            else:
                random_.choice(FREE)(lambda: value(random_))

        for _ in range(steps):
            try:
                one()
            except ALLOWED:
                pass
            except MemoryError as error:
                self.assertIsInstance(error, (voxtet.BudgetError, voxtet.OutOfMemoryError))
        held.clear()
        grid.close()

    def test_garbage(self):
        end, number = time.monotonic() + SECONDS, 0
        with self.subTest(seed=self.seed):
            while time.monotonic() < end:
                self.life(random.Random(self.seed + number), 150)
                number += 1

    def test_two_threads(self):
        """Two threads with garbage for the same grids."""
        end, failed = time.monotonic() + SECONDS / 2, []
        first, second, tets = two_boxes(2)
        grid = voxtet.Grid()
        meshes = [grid.add(first, tets), grid.add(second, tets, copy=True)]

        def work(seed):
            random_ = random.Random(seed)
            while time.monotonic() < end:
                try:
                    random_.choice([
                        grid.step, lambda: grid.contacts, lambda: setattr(meshes[0], "positions", value(random_)),
                        lambda: meshes[1].positions.__imul__(1.0), lambda: getattr(grid, random_.choice(READ)),
                        lambda: setattr(meshes[0], "positions", first + 0), lambda: grid.add(value(random_), value(random_)),
                        lambda: meshes[random_.randrange(2)].append_vertices(copies_of=[0]),
                        lambda: meshes[1].set_topology(second, tets, copy=random_.random() < 0.5),
                        lambda: grid.locator().find_point_hits(value(random_))])()
                except ALLOWED:
                    pass
                except BaseException as error:
                    failed.append(error)
                    return

        threads = [threading.Thread(target=work, args=(self.seed + i,)) for i in range(2)]
        [t.start() for t in threads]
        [t.join() for t in threads]
        self.assertEqual((failed, self.seed), ([], self.seed))
        grid.close()


if __name__ == "__main__":
    unittest.main()
