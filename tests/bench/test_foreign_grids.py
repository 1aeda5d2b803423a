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
BOXES, CENTRES = 0, 1
BOX, AROUND, PAIRS = 0, 1, 2
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


def run(name, held, asking, size, content, look=BOX):
    function = getattr(PLAIN, name)
    function.restype = ctypes.c_uint64
    return function(*pointer(held), *pointer(asking), ctypes.c_double(size), content, look)


def counted(held, asking, size, content, look):
    work = (ctypes.c_double * len(losses.WORK))()
    PLAIN.plain_count(*pointer(held), *pointer(asking), ctypes.c_double(size), content, look, POSITIONS, work)
    return dict(zip(losses.WORK, work))


def brute_force(held, asking):
    found = 0
    for i in range(0, len(asking), 6):
        a = asking[i:i + 6]
        for j in range(0, len(held), 6):
            found += all(held[j + k] <= a[k + 3] and a[k] <= held[j + k + 3] for k in range(3))
    return found


def saved(role, values):
    return {f"{role}_type": BOX_TYPE, f"{role}_positions": list(values)}


# Name, vox_known_grid, content, look, dense, held, asking (None: those held).
def kinds():
    one, other = boxes(4000, 1), boxes(4000, 2, 0.6)
    return [("sorted, boxes", SORTED, BOXES, BOX, True, one, None), ("sorted, points", SORTED, CENTRES, BOX, True, points_of(one), other),
            ("hashed, boxes", HASHED, BOXES, BOX, False, one, other), ("hashed, points", HASHED, CENTRES, BOX, False, points_of(one), one),
            ("around", PBAT, CENTRES, AROUND, False, one, points_of(other)), ("pairs", IPC_PAIRS, BOXES, PAIRS, False, one, None)]


def record(kind):
    """As measure.py writes, of times that follow from the counts."""
    name, known, content, look, dense, held, asking = kind
    sizes = [s for s in SIZES if look != AROUND or s > 0.76]
    work = [counted(held, asking or held, s, content, look) for s in sizes]
    rng = random.Random(3)
    seconds = [[1e-9 * (10 * w["entries"] + 5 * w["visits"] + 2 * w["reads"]) * rng.uniform(1, 1.02) for w in work] for _ in range(4)]
    return {"grid": name, "known": known, "scene": "boxes", "content": content, "look": look, "dense": dense, "mean_edge": 1, "unit": 1,
            "least": 0.75 if look == AROUND else 0, "rules": {"mean_edge": 1, "mean_box_side": 1.25}, "sweep": list(range(len(sizes))),
            "sizes": sizes, "seconds": seconds, "work": work,
            "primitives": {**saved("held", held), **(saved("asking", asking) if asking else {})}}


class ForeignGrids(unittest.TestCase):
    def test_plain_grids_find_the_same_pairs(self):
        held, asking = boxes(600, 4), boxes(500, 5)
        for content, inside in ((BOXES, held), (CENTRES, points_of(held))):
            expected = brute_force(inside, asking)
            self.assertGreater(expected, 100)
            for size in SIZES:
                for grid in ("plain_run_sorted", "plain_run_hashed"):
                    self.assertEqual(run(grid, inside, asking, size, content), expected, (grid, content, size))

    def test_counts_agree(self):
        for kind in kinds():
            name, _, content, look, dense, held, asking = kind
            of = record(kind)
            told = evaluate.described(VOX, losses.Curve(of), None)
            for size, work in zip(of["sizes"], of["work"]):
                found = told.count(size)
                for count in ("entries", "visits", "reads", "occupied"):
                    # A twentieth, and what chance does to a mean over few positions of the lattice.
                    self.assertAlmostEqual(found[count], work[count], delta=0.05 * work[count], msg=f"{name}: {count} at {size:.2f}")

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
