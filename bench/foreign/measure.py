#!/usr/bin/env python3
"""Times grids that are not ours at a sweep of cell sizes.

usage: measure.py PLAIN_GRIDS CURVES.json [--seconds 300] [--scale 1] [--grids sorted,warp] [--primitives FOLDER]
                  [--meshes FOLDER]

PLAIN_GRIDS is the library made of plain_grids.cpp. Each grid on each scene is run at 14 sizes from 0.42 to 4 mean edges
(or radii, where balls ask), further ones where the ends are not clearly worse than the best, and those that rules choose, in random
order within each of several rounds. Times are of the thread, so that other programs on the machine disturb little. The file is
written after each grid. --primitives also writes what is stored and what queries, for evaluate.py."""

import argparse
import json
import os
import platform
import random
import statistics
import time

import numpy as np

import cases
import scenes

SWEEP = [0.6 * 2 ** (k / 4) for k in range(-2, 12)]  # mean edges
MOST_ROUNDS = 24
FEWEST_ROUNDS = 4


def rules(case):
    """Cell sizes that fixed rules choose, as the library's result has them, and the grid's own default."""
    stored, queries = case.stored.boxes(), case.queries().boxes()
    sides = (stored[:, 3:] - stored[:, :3]).max(1)
    extent = stored[:, 3:].max(0) - stored[:, :3].min(0)
    found = {"mean_box_side": float(sides.mean()), "median_box_side": float(np.median(sides)),
             "spacing": float((extent.prod() / len(stored)) ** (1 / 3))}
    if case.unit is None:  # there are edges
        found.update(mean_edge=case.mean_edge, mean_edge_multiple=2 * case.mean_edge)
    if case.querying is not None and case.querying.radii is not None:
        found["radius"] = float(case.querying.radii.mean())
    if case.default:
        found["default"] = case.default
    return {name: size for name, size in found.items() if size > 0}


def counted(library, case, size):
    """The mean over as many positions of the lattice as take little time: counts in few cells vary much."""
    once = cases.count(library, case, size, 1)
    positions = min(max(round(5e6 / (once["stored"] + once["visits"] + once["cells"])), 2), 64)
    return cases.count(library, case, size, positions)


def timed(run, size):
    began = time.thread_time_ns()
    run(size)
    return (time.thread_time_ns() - began) * 1e-9


def extended(case, sweep, least):
    """With further sizes, at most two octaves of them, until both ends take clearly longer than the best size."""
    times = {size: min(timed(case.run, size) for _ in range(2)) for size in sweep}
    for end, step in ((0, 2 ** -0.25), (-1, 2 ** 0.25)):
        for _ in range(8):
            size = sorted(times)[end] * step
            if times[sorted(times)[end]] > 1.1 * min(times.values()) or size < least:
                break
            times[size] = min(timed(case.run, size) for _ in range(2))
    return sorted(times)


def measure(case, seconds, rng, library):
    least = case.min_cell_size()
    unit = case.unit or case.mean_edge
    sweep = [x * unit for x in SWEEP]
    if least > sweep[0]:  # as many sizes from the least legal one on
        sweep = [least * 2.5 ** (k / 13) for k in range(14)]
    chosen = {name: max(size, least) for name, size in rules(case).items()}
    # Far outside of the sweep a run may take for ever.
    sweep = extended(case, sweep, least)
    sizes = list(sweep)
    for size in chosen.values():
        if 0.5 * sweep[0] <= size <= 2 * sweep[-1] and min(abs(size / s - 1) for s in sizes) > 0.005:
            sizes.append(size)
    sizes.sort()
    rounds, spent = [], 0.0
    while len(rounds) < MOST_ROUNDS and (len(rounds) < FEWEST_ROUNDS or spent * (1 + 1 / len(rounds)) < seconds):
        times = {}
        for i in rng.sample(range(len(sizes)), len(sizes)):
            times[i] = timed(case.run, sizes[i])
        rounds.append([times[i] for i in range(len(sizes))])
        spent += sum(rounds[-1])
    return {
        "grid": case.grid, "known": case.known, "scene": case.scene, "cells_stored": case.cells_stored, "cells_queried": case.cells_queried,
        "dense": case.dense, "stored": len(case.stored.boxes()), "querying": len(case.queries().boxes()),
        "mean_edge": case.mean_edge, "unit": unit, "min_cell_size": least, "rules": chosen, "sweep": [sizes.index(s) for s in sweep],
        "sizes": sizes, "seconds": rounds,  # [round][size]
        "counts": [counted(library, case, s) for s in sizes]}


def save_primitives(folder, name, case):
    arrays = {}
    for role, p in (("stored", case.stored), ("querying", case.querying)):
        if p is not None:
            arrays.update({f"{role}_{k}": v for k, v in vars(p).items() if v is not None})
    np.savez(os.path.join(folder, name + ".npz"), **arrays)


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def versions(grids):
    import importlib.metadata
    found = {}
    for name in {"warp": "warp-lang", "ipc": "ipctk", "ipc_pairs": "ipctk", "vtk": "vtk", "pbat": "pbatoolkit",
                 "numpy": "numpy"}.items():
        if name[0] in grids:
            found[name[1]] = importlib.metadata.version(name[1])
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plain_grids")
    parser.add_argument("curves")
    parser.add_argument("--seconds", type=float, default=300, help="of all runs together")
    parser.add_argument("--scale", type=float, default=1, help="of the number of primitives")
    parser.add_argument("--meshes", help="a folder with .msh files: these instead of the generated scenes")
    parser.add_argument("--grids", default=",".join(cases.GRIDS))
    parser.add_argument("--primitives")
    options = parser.parse_args()
    library = cases.plain(os.path.abspath(options.plain_grids))
    grids = options.grids.split(",")
    source = scenes.Real(options.meshes) if options.meshes else scenes.Generated(options.scale)
    if options.primitives:
        os.makedirs(options.primitives, exist_ok=True)
    result = {"cpu": processor(), "date": time.strftime("%Y-%m-%d"), "versions": versions(grids), "curves": []}
    rng = random.Random(1)
    for name in grids:
        began = time.perf_counter()
        found = list(cases.GRIDS[name](library, source))
        for case in found:
            curve = measure(case, options.seconds / len(grids) / len(found), rng, library)
            if options.primitives:
                curve["primitives"] = f"{name}-{len(result['curves'])}"
                save_primitives(options.primitives, curve["primitives"], case)
            result["curves"].append(curve)
            least = [min(times) for times in zip(*curve["seconds"])]
            best = min(range(len(least)), key=least.__getitem__)
            print(f"{case.grid:26} {case.scene:14} {len(curve['seconds']):3} rounds, best {1e3 * least[best]:8.2f} ms at "
                  f"{curve['sizes'][best] / case.mean_edge:.2f} mean edges, median over least "
                  f"{statistics.median(statistics.median(t) / min(t) for t in zip(*curve['seconds'])):.3f}", flush=True)
        print(f"{name}: {time.perf_counter() - began:.0f} s", flush=True)
        with open(options.curves + ".part", "w", encoding="utf-8") as file:
            json.dump(result, file)
        os.replace(options.curves + ".part", options.curves)


if __name__ == "__main__":
    main()
