"""Measured curves of grids, and what a cell size loses on them. Nothing but Python is needed."""

from __future__ import annotations

import bisect
import json
import math
import statistics

COUNTS = ("stored", "visits", "empty", "reads", "occupied", "cells")  # the fields of vox_foreign_counts
WEIGHTS = ("run", "store", "visit", "found", "read", "occupied", "cell")  # of vox_foreign_weights

KNOWN = ("NONE", "SORTED", "HASHED", "WARP", "IPC", "IPC_PAIRS", "VTK", "PBAT", "POINT_VOXELS", "NUMPY")  # vox_known_grid, in its order


class Through:
    """A smooth function through points without overshooting (Fritsch and Carlson 1980, with the slopes of Fritsch and
    Butland 1984), in logarithms of both; straight beyond the ends, where it does not fall outwards if `rising`."""

    def __init__(self, sizes, values, rising=False):
        self.x = [math.log(s) for s in sizes]
        self.y = [math.log(v) for v in values]
        n = len(self.x)
        steps = [self.x[i + 1] - self.x[i] for i in range(n - 1)]
        rises = [(self.y[i + 1] - self.y[i]) / steps[i] for i in range(n - 1)]
        self.slopes = [rises[0]]
        for i in range(1, n - 1):
            a, b = rises[i - 1], rises[i]
            w, v = 2 * steps[i] + steps[i - 1], steps[i] + 2 * steps[i - 1]
            self.slopes.append((w + v) / (w / a + v / b) if a * b > 0 else 0.0)
        self.slopes.append(rises[-1])
        self.beyond = (min(rises[0], 0.0), max(rises[-1], 0.0)) if rising else (rises[0], rises[-1])

    def __call__(self, size):
        x = math.log(size)
        if x <= self.x[0] or x >= self.x[-1]:
            end = 0 if x <= self.x[0] else -1
            return math.exp(self.y[end] + self.beyond[end] * (x - self.x[end]))
        i = bisect.bisect_right(self.x, x) - 1
        step = self.x[i + 1] - self.x[i]
        t = (x - self.x[i]) / step
        return math.exp((1 + 2 * t) * (1 - t) ** 2 * self.y[i] + t * t * (3 - 2 * t) * self.y[i + 1] +
                        step * t * (1 - t) * ((1 - t) * self.slopes[i] - t * self.slopes[i + 1]))


class Curve:
    """One grid on one scene."""

    def __init__(self, record):
        self.record = record
        self.grid, self.scene, self.known = record["grid"], record["scene"], record["known"]
        self.sizes, self.unit, self.min_cell_size = record["sizes"], record["unit"], record["min_cell_size"]
        self.rounds = record["seconds"]
        self.halves = [[min(times) for times in zip(*self.rounds[h::2])] for h in (0, 1)]
        # Nobody has run it beyond the sweep: there it is as slow as at the end, or slower.
        self.smooth = [Through(self.sizes, half, rising=True) for half in self.halves]
        self.smooth_counts = [Through(self.sizes, [max(c[name], 1e-9) for c in record["counts"]]) for name in COUNTS]

    def legal(self, size):
        return max(size, self.min_cell_size)

    def loss(self, size):
        """How much longer a run takes than at the best size of the sweep. One half of the rounds says which that is, the
        other measures both, and the other way round; the mean."""
        losses = []
        for chosen_by, measured_by in ((0, 1), (1, 0)):
            best = min(self.record["sweep"], key=self.halves[chosen_by].__getitem__)
            losses.append(self.smooth[measured_by](self.legal(size)) / self.halves[measured_by][best] - 1)
        return statistics.mean(losses)

    def best_size(self):
        whole = [min(a, b) for a, b in zip(*self.halves)]
        return self.sizes[min(self.record["sweep"], key=whole.__getitem__)]

    def noise(self):
        """The median over sizes of how far a round is from the least."""
        return statistics.median(statistics.median(times) / min(times) for times in zip(*self.rounds)) - 1

    def draw(self, size, rng, runs=None):
        """A timing at that size, as noisy as those that were measured: the curve, times what a round was above the least of
        all at the nearest size. The least of so many runs; without a number, as one would do by hand, of three where a run
        takes less than 10 ms."""
        nearest = min(range(len(self.sizes)), key=lambda i: abs(math.log(self.sizes[i] / size)))
        times = [r[nearest] for r in self.rounds]
        least = min(self.smooth[0](size), self.smooth[1](size))
        runs = runs or (3 if least < 1e-2 else 1)
        return least * min(rng.choice(times) for _ in range(runs)) / min(times)

    def timing_sizes(self):
        """The three that vox_foreign_grid_fit is given: 0.6, 1.2 and 2.4 units, or as far apart from the smallest legal size."""
        first = max(0.6 * self.unit, self.min_cell_size)
        return [first, 2 * first, 4 * first] if first == 0.6 * self.unit else [first, 1.5 * first, 2.25 * first]

    def counts(self, size):
        """What each weight is multiplied with, counted at the measured sizes."""
        c = dict(zip(COUNTS, (f(size) for f in self.smooth_counts)))
        return [1, c["stored"], c["visits"], max(c["visits"] - c["empty"], 0), c["reads"], c["occupied"],
                c["cells"] if self.record["dense"] else 0]


def load(path):
    with open(path, encoding="utf-8") as file:
        record = json.load(file)
    return record, [Curve(c) for c in record["curves"]]
