#!/usr/bin/env python3
"""Fits the weights that are shipped for each grid to the curves, and prints them for src/cell_size/foreign/known_grids.cpp.

usage: fit_known.py CURVES.json [--only 1,3] [--tries 400]

Weights of a grid are those with the least loss over its scenes, found from the non-negative least squares fit to all of
its times. What a scene loses with weights fitted without it is printed too. Weights for NONE are those with which the worst loss
of all grids is least."""

import argparse
import math
import random
import statistics
import sys

import losses

STEPS = 96  # sizes among which the least cost is looked for


class Table:
    """Counts and losses of a curve at many sizes."""

    def __init__(self, curve):
        self.curve = curve
        low, high = curve.sizes[0], curve.sizes[-1]
        self.sizes = [low * (high / low) ** (k / (STEPS - 1)) for k in range(STEPS)]
        self.counts = [curve.counts(s) for s in self.sizes]
        # Of sizes about that one: weights shall not depend on a size that happens to be good.
        self.losses = [statistics.mean(curve.loss(s * f) for f in (0.9, 1, 1.1)) for s in self.sizes]
        # Rows of the least squares fit: times of the sweep.
        self.rows = [(curve.counts(curve.sizes[i]), min(r[i] for r in curve.rounds) * 1e9) for i in curve.record["sweep"]]

    def chosen(self, weights):
        costs = [sum(w * c for w, c in zip(weights, counts)) for counts in self.counts]
        return min(range(STEPS), key=costs.__getitem__)

    def loss(self, weights):
        return self.losses[self.chosen(weights)]


def least_squares(tables):
    """Weights >= 0 for which the sum of (fitted / measured - 1)^2 is least, by coordinate descent. Every scene has its own
    fixed part."""
    rows = []
    for k, table in enumerate(tables):
        for counts, ns in table.rows:
            row = [0.0] * len(tables)
            row[k] = 1 / ns
            rows.append(row + [c / ns for c in counts[1:]])
    columns = list(zip(*rows))
    squares = [sum(v * v for v in column) for column in columns]
    x = [0.0] * len(columns)
    rest = [-1.0] * len(rows)
    for _ in range(400):
        for j, column in enumerate(columns):
            if squares[j] == 0:
                continue
            step = max(-sum(v * r for v, r in zip(column, rest)) / squares[j], -x[j])
            if step != 0:
                x[j] += step
                rest = [r + step * v for r, v in zip(rest, column)]
    return [0.0] + x[len(tables):]


def aim(tables, weights):
    found = [max(t.loss(weights), -0.01) for t in tables]
    return statistics.mean(found) + 0.3 * max(found)


def search(tables, start, objective, rng, tries):
    """Random steps of single weights; only their proportions matter."""
    best, value = list(start), objective(tables, start)
    total = sum(w * c for w, c in zip(start, [statistics.mean(c[j] for t in tables for c in t.counts) for j in range(7)]))
    scale = [total / max(statistics.mean(c[j] for t in tables for c in t.counts), 1e-9) for j in range(7)]
    for i in range(tries):
        spread = 2.0 if i % 3 == 0 else 0.5
        trial = list(best)
        j = rng.randrange(1, 7)
        if scale[j] > 1e6 * total:
            continue
        if trial[j] == 0:
            trial[j] = scale[j] * math.exp(rng.uniform(-7, 0))
        else:
            trial[j] *= math.exp(rng.gauss(0, spread))
            if rng.random() < 0.1:
                trial[j] = 0.0
        found = objective(tables, trial)
        if found < value - 1e-6:
            best, value = trial, found
    return best, value


def fitted(tables, rng, tries=400):
    return search(tables, least_squares(tables), aim, rng, tries)[0]


def in_per_cent(found):
    return f"median {100 * statistics.median(found):5.1f} %, worst {100 * max(found):5.1f} %"


def in_nanoseconds(tables, weights):
    """The search leaves their proportions. Scaled so that predicted times are as long as measured ones in the median; what
    is less than a thousandth of the cost everywhere is 0."""
    ratios, shares = [], [0.0] * len(weights)
    for table in tables:
        for counts, ns in table.rows:
            cost = sum(w * c for w, c in zip(weights, counts))
            ratios.append(ns / cost)
            shares = [max(share, w * c / cost) for share, w, c in zip(shares, weights, counts)]
    unit = statistics.median(ratios)
    return [w * unit if share > 1e-3 else 0.0 for w, share in zip(weights, shares)]


def line(name, tables, weights):
    return f"    /* {name} */ {{" + ", ".join(f"{float(f'{w:.2g}'):g}" for w in in_nanoseconds(tables, weights)) + "},"


def worst_of_all(tables, weights):
    """Also counts how much worse than the mean edge it is."""
    found = [t.loss(weights) for t in tables]
    beside = [(1 + f) / (1 + t.edge_loss) - 1 for t, f in zip(tables, found) if t.edge_loss is not None]
    return max(found) + 2 * max(max(beside, default=0) - 0.05, 0) + 0.5 * statistics.mean(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("curves")
    parser.add_argument("--only", help="numbers of vox_known_grid; 0: weights for NONE alone")
    parser.add_argument("--tries", type=int, default=400)
    options = parser.parse_args()
    _, curves = losses.load(options.curves)
    tables = {}
    for curve in curves:
        tables.setdefault(curve.known, []).append(Table(curve))
    rng = random.Random(1)
    wanted = [] if options.only == "0" else [int(k) for k in options.only.split(",")] if options.only else sorted(tables)
    lines = {}
    for known in wanted:
        own = tables[known]
        start = least_squares(own)
        found = fitted(own, rng, options.tries)
        without = []
        for scene in sorted({t.curve.scene for t in own}):
            rest = [t for t in own if t.curve.scene != scene]
            weights = fitted(rest, rng, options.tries // 4)
            without += [t.loss(weights) for t in own if t.curve.scene == scene]
        print(f"{losses.KNOWN[known]}: least squares {in_per_cent([t.loss(start) for t in own])}; least loss "
              f"{in_per_cent([t.loss(found) for t in own])}; without the scene {in_per_cent(without)}; "
              f"best of the sweep by noise {in_per_cent([min(t.losses) for t in own])}", file=sys.stderr, flush=True)
        lines[known] = line(losses.KNOWN[known], own, found)
    for known in sorted(lines):
        print(lines[known])
    if options.only and options.only != "0":
        return
    # Where nothing is known of the times, what is described decides: which cells store, are queried and exist.
    every = [t for own in tables.values() for t in own]
    kinds = {}
    for t in every:
        edge = t.curve.record["rules"].get("mean_edge")
        t.edge_loss = edge and t.curve.loss(edge)
        kinds.setdefault((t.curve.record["cells_stored"], t.curve.record["cells_queried"], t.curve.record["dense"]), []).append(t)
    for kind, own in [("all", every), *sorted(kinds.items())]:
        starts = [least_squares(own)] + [fitted([t for t in own if t.curve.grid == grid], rng, 50)
                                         for grid in dict.fromkeys(t.curve.grid for t in own)]
        found, _ = min((search(own, start, worst_of_all, rng, options.tries) for start in starts), key=lambda pair: pair[1])
        title = kind if kind == "all" else ", ".join((("box", "centre")[kind[0] - 1], ("box", "27", "pairs")[kind[1] - 1],
                                                      "dense" if kind[2] else "occupied"))
        print(line("NONE: " + title, own, found), flush=True)
        print(f"{title}: {in_per_cent([t.loss(found) for t in own])}", file=sys.stderr)
        for grid in dict.fromkeys(t.curve.grid for t in own):
            some = [t for t in own if t.curve.grid == grid]
            beside = [(1 + t.loss(found)) / (1 + t.edge_loss) - 1 for t in some if t.edge_loss is not None]
            print(f"  {grid}: {in_per_cent([t.loss(found) for t in some])}"
                  + (f"; beside the mean edge {100 * max(beside):.1f} % at worst" if beside else ""), file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
