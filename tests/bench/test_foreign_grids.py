"""The plain grids of bench/foreign find the same pairs, the library counts what they do, and what is reported of them has
all of its parts. Times play no part.

usage: test_foreign_grids.py PLAIN_GRIDS LIBVOX"""

import array
import ctypes
import json
import os
import random
import sys
import tempfile
import unittest

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "bench", "foreign"))
import evaluate  # noqa: E402
import library  # noqa: E402
import losses  # noqa: E402

POINT, BOX_TYPE = 0, 4  # vox_primitive_type
STORED_BOX, STORED_CENTRE = 1, 2  # vox_cells_stored
BOX, AROUND, PAIRS = 1, 2, 3  # vox_cells_queried
SORTED, HASHED, IPC_PAIRS, PBAT = 1, 2, 5, 7  # vox_known_grid
SIZES = [0.6 * 2 ** (k / 2) for k in range(-1, 5)]  # mean sides of boxes
POSITIONS = 24  # of the lattice, whose mean is taken
PLAIN, VOX = None, None


def boxes(count, seed, part=1.0):
    """In a part of a cube of edge 12, sides about 1."""
    rng = random.Random(seed)
    found = array.array("d")
    for _ in range(count):
        low = [rng.uniform(0, 12 * part), rng.uniform(0, 12), rng.uniform(0, 12)]
        found.extend(low + [x + rng.uniform(0.5, 1.5) for x in low])
    return found


def points_of(all_boxes):
    found = array.array("d")
    for i in range(0, len(all_boxes), 6):
        found.extend(all_boxes[i:i + 3] * 2)
    return found


def pointer(values):
    return ctypes.cast(values.buffer_info()[0], ctypes.POINTER(ctypes.c_double)), ctypes.c_size_t(len(values) // 6)


def run(name, stored, querying, size, cells_stored, cells_queried=BOX):
    function = getattr(PLAIN, name)
    function.restype = ctypes.c_uint64
    return function(*pointer(stored), *pointer(querying), ctypes.c_double(size), cells_stored, cells_queried)


def counted(stored, querying, size, cells_stored, cells_queried):
    counts = (ctypes.c_double * len(losses.COUNTS))()
    PLAIN.plain_count(*pointer(stored), *pointer(querying), ctypes.c_double(size), cells_stored, cells_queried, POSITIONS, counts)
    return dict(zip(losses.COUNTS, counts))


def brute_force(stored, querying):
    found = 0
    for i in range(0, len(querying), 6):
        a = querying[i:i + 6]
        for j in range(0, len(stored), 6):
            found += all(stored[j + k] <= a[k + 3] and a[k] <= stored[j + k + 3] for k in range(3))
    return found


def saved(role, values):
    return {f"{role}_type": BOX_TYPE, f"{role}_positions": list(values)}


# Name, vox_known_grid, cells_stored, cells_queried, dense, stored, querying (None: those stored).
def kinds():
    one, other = boxes(4000, 1), boxes(4000, 2, 0.6)
    return [("sorted, boxes", SORTED, STORED_BOX, BOX, True, one, None), ("sorted, points", SORTED, STORED_CENTRE, BOX, True, points_of(one), other),
            ("hashed, boxes", HASHED, STORED_BOX, BOX, False, one, other), ("hashed, points", HASHED, STORED_CENTRE, BOX, False, points_of(one), one),
            ("around", PBAT, STORED_CENTRE, AROUND, False, one, points_of(other)), ("pairs", IPC_PAIRS, STORED_BOX, PAIRS, False, one, None)]


def record(kind):
    """As measure.py writes, of times that follow from the counts."""
    name, known, cells_stored, cells_queried, dense, stored, querying = kind
    sizes = [s for s in SIZES if cells_queried != AROUND or s > 0.76]
    counts = [counted(stored, querying or stored, s, cells_stored, cells_queried) for s in sizes]
    rng = random.Random(3)
    seconds = [[1e-9 * (10 * w["stored"] + 5 * w["visits"] + 2 * w["reads"]) * rng.uniform(1, 1.02) for w in counts] for _ in range(4)]
    return {"grid": name, "known": known, "scene": "boxes", "cells_stored": cells_stored, "cells_queried": cells_queried,
            "dense": dense, "mean_edge": 1, "unit": 1, "min_cell_size": 0.75 if cells_queried == AROUND else 0,
            "rules": {"mean_edge": 1, "mean_box_side": 1.25}, "sweep": list(range(len(sizes))), "sizes": sizes, "seconds": seconds, "counts": counts,
            "primitives": {**saved("stored", stored), **(saved("querying", querying) if querying else {})}}


class ForeignGrids(unittest.TestCase):
    def test_plain_grids_find_the_same_pairs(self):
        stored, querying = boxes(600, 4), boxes(500, 5)
        for cells_stored, inside in ((STORED_BOX, stored), (STORED_CENTRE, points_of(stored))):
            expected = brute_force(inside, querying)
            self.assertGreater(expected, 100)
            for size in SIZES:
                for grid in ("plain_run_sorted", "plain_run_hashed"):
                    self.assertEqual(run(grid, inside, querying, size, cells_stored), expected, (grid, cells_stored, size))

    def test_counts_agree(self):
        for kind in kinds():
            name, _, cells_stored, cells_queried, dense, stored, querying = kind
            of = record(kind)
            told = evaluate.described(VOX, losses.Curve(of), None)
            for size, counts in zip(of["sizes"], of["counts"]):
                found = told.count(size)
                for count in ("stored", "visits", "reads", "occupied"):
                    # A twentieth, and what chance does to a mean over few positions of the lattice.
                    self.assertAlmostEqual(found[count], counts[count], delta=0.05 * counts[count], msg=f"{name}: {count} at {size:.2f}")

    def test_the_report_has_all_parts(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "curves.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump({"cpu": "a processor", "date": "2026-01-01", "versions": {}, "curves": [record(kind) for kind in kinds()]}, file)
            of, curves = losses.load(path)
            rows = evaluate.evaluate(VOX, curves, None, 2)
            page = os.path.join(folder, "page.md")
            with open(page, "w", encoding="utf-8") as file:
                file.write("before\n<!-- bench/foreign -->\nold\n<!-- /bench/foreign -->\nafter\n")
            evaluate.put(page, "foreign", "\n" + evaluate.report_text(of, rows))
            with open(page, encoding="utf-8") as file:
                text = file.read()
        self.assertTrue(text.startswith("before\n<!-- bench/foreign -->\n") and text.endswith("<!-- /bench/foreign -->\nafter\n"))
        self.assertNotIn("old", text)
        for kind in kinds():
            self.assertEqual(text.count(f"| {kind[0]} |"), 2)  # of losses, and of counts
        for title in (evaluate.FIXED["mean_edge"], *evaluate.OURS.values()):
            self.assertIn(f"| {title} |", text)
        for row in rows:
            self.assertEqual({way: len(found) for way, found in row["losses"].items() if way in evaluate.OURS},
                             {"bare": 1, "unknown": 1, "shipped": 1, "fitted": 2, "tuned": 2})
            self.assertTrue(all(3 <= runs <= 7 for runs in row["runs"]), row["runs"])
            # Times that follow from the counts are what the fit is for.
            self.assertLess(max(row["losses"]["fitted"]), 0.05, row["grid"])

    def test_a_fit_times_a_best_size_beyond_those_timed(self):
        curve = losses.Curve(record(kinds()[0]))
        told = evaluate.described(VOX, curve, None)
        best = curve.best_size()
        for first, beyond in ((0.5 * best, False), (2 * best, True)):
            timed = []

            def seconds(size):
                timed.append(size)
                return curve.smooth[0](size)
            found = evaluate.fitted(told, seconds, [first, 2 * first, 4 * first], 0)
            self.assertEqual(len(timed), 4 if beyond else 3, timed)
            self.assertTrue(not beyond or timed[3] < first, timed)
            self.assertLess(curve.loss(found), 0.05)

    def test_a_fit_times_a_size_beyond_an_end_that_the_best_one_is_close_to(self):
        class Told:  # says these sizes, one after the other
            def __init__(self, *sizes):
                self.sizes = list(sizes)

            def fit(self, timings):
                self.timings = [size for size, _ in timings]
                return self

            @property
            def cell_size(self):
                return self.sizes.pop(0)

        for first, least, more in ((1.1, 0, 2 ** -0.5), (1.1, 0.9, 0.9), (0.5, 0, 0.5), (3.5, 0, 4 * 2 ** 0.5), (9, 0, 9)):
            told = Told(first, 1.5)
            self.assertEqual(evaluate.fitted(told, lambda size: size, [1, 2, 4], least), 1.5)
            self.assertEqual(told.timings[:3], [1, 2, 4])
            self.assertAlmostEqual(told.timings[3], more, 12)
        for first, least in ((1.3, 0), (3, 0), (1.1, 1)):
            self.assertEqual(evaluate.fitted(Told(first), lambda size: size, [1, 2, 4], least), first)


if __name__ == "__main__":
    PLAIN, VOX = ctypes.CDLL(sys.argv[1]), library.Vox(sys.argv[2])
    unittest.main(argv=sys.argv[:1])
