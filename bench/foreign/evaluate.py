#!/usr/bin/env python3
"""What each way of choosing a cell size loses on grids that are not ours, from the curves that measure.py wrote.

usage: evaluate.py CURVES.json LIBVOX [--primitives FOLDER] [--page PAGE.md] [--picture PICTURE.svg] [--report REPORT.json]
                   [--draws 8] [--scenes]

LIBVOX is the shared library of vox. PAGE.md gets the tables between its marks; without it they are printed. --scenes
prints every curve."""

import argparse
import array
import json
import os
import random
import statistics
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.dirname(HERE)]
import library  # noqa: E402
import losses  # noqa: E402
from chart import Axis, Chart, Panel  # noqa: E402
from page import put, quantile  # noqa: E402

NONE = 0  # vox_known_grid
CLOSE, FURTHER = 1.2, 2 ** 0.5  # to an end of the sizes timed, and beyond it
FIXED = {"default": "its own default", "mean_edge": "mean edge", "mean_edge_multiple": "two mean edges",
         "mean_box_side": "mean box side", "median_box_side": "median box side", "spacing": "spacing", "radius": "radius"}
OURS = {"bare": "not even described", "unknown": "default call: times unknown", "shipped": "shipped weights",
        "fitted": "fitted to three timings", "tuned": "tuned by a callback"}
# Of the ways that are drawn: colour, and what the picture calls them.
DRAWN = {"default": ("grey", "the grid's own default"), "mean_edge": ("orange", "mean edge"), "unknown": ("blue", "described to vox"),
         "tuned": ("vox", "tuned by vox")}
# Of the ways: median and worst that are wanted.
AIMS = {"tuned": (0.02, 0.08), "fitted": (0.02, 0.10), "shipped": (0.05, 0.20), "unknown": (None, 0.40)}
COUNTED = ("stored", "visits", "reads", "occupied", "cells")
AGREE = 0.05


def primitives(curve, folder):
    """What is stored and what queries: from the curve itself, or from the file that it names."""
    saved = curve.record["primitives"]
    if isinstance(saved, str):
        import numpy
        saved = dict(numpy.load(os.path.join(folder, saved + ".npz")))
    else:
        saved = {name: array.array("I" if "indices" in name else "d", v) if isinstance(v, list) else v for name, v in saved.items()}

    def of(role):
        if role + "_positions" not in saved:
            return None
        positions, indices = saved[role + "_positions"], saved.get(role + "_indices")
        values = {"type": int(saved[role + "_type"]), "positions": positions, "indices": indices, "radii": saved.get(role + "_radii")}
        values["vertex_count"] = positions.size // 3 if hasattr(positions, "size") else len(positions) // 3
        vertices = (1, 2, 3, 4, 2)[values["type"]]
        numbers = values["vertex_count"] if indices is None else indices.size if hasattr(indices, "size") else len(indices)
        values["count"] = numbers // vertices
        return values
    return of("stored"), of("querying")


def described(vox, curve, folder):
    record = curve.record
    return library.Described(vox, *primitives(curve, folder), record["cells_stored"], record["cells_queried"],
                             library.DENSE if record["dense"] else library.OCCUPIED)


def fitted(told, timed, sizes, least):
    """The size of a fit as docs/your-own-grid.md advises: where the best one is close to an end of those timed or beyond it, a
    size further out is timed, too."""
    timings = [(size, timed(size)) for size in sizes]
    found = told.fit(timings).cell_size
    if found > max(sizes) / CLOSE:
        more = max(found, max(sizes) * FURTHER)
    elif found < min(sizes) * CLOSE and min(sizes) > least * 1.001:
        more = max(min(found, min(sizes) / FURTHER), least)
    else:
        return found
    return told.fit(timings + [(more, timed(more))]).cell_size


def choices(vox, curve, folder, draws):
    """Of each way, the sizes it chose (those with noise in what they see: one of each draw), and the runs of each tuning."""
    record = curve.record
    bare, told = library.Described(vox, *primitives(curve, folder)), described(vox, curve, folder)
    found = {name: [size] for name, size in record["rules"].items()}
    found["bare"] = [bare.suggest().cell_size]
    found["unknown"] = [told.weigh(NONE).suggest().cell_size]
    found["shipped"] = [told.weigh(curve.known).suggest().cell_size]
    told.weigh(NONE)
    rng = random.Random(curve.grid + curve.scene)
    found["fitted"] = [fitted(told, lambda size: curve.draw(size, rng, 3), curve.timing_sizes(), curve.min_cell_size) for _ in range(draws)]
    rng = random.Random(curve.scene + curve.grid)
    tuned = [told.tune(lambda size: curve.draw(size, rng)) for _ in range(draws)]
    found["tuned"] = [t.cell_size for t in tuned]
    return found, [t.timing_count for t in tuned], told


def count_errors(curve, told):
    """Of each count, predicted over counted - 1 at sizes of the sweep."""
    errors = {name: [] for name in COUNTED}
    for i in curve.record["sweep"][::3]:
        predicted, counted = told.count(curve.sizes[i]), curve.record["counts"][i]
        for name in COUNTED:
            if counted[name] > 0 and (name != "cells" or curve.record["dense"]):
                errors[name].append(predicted[name] / counted[name] - 1)
    return errors


def evaluate(vox, curves, folder, draws):
    rows = []
    for curve in curves:
        chosen, runs, told = choices(vox, curve, folder, draws)
        rows.append({"grid": curve.grid, "scene": curve.scene, "known": curve.known, "best": curve.best_size() / curve.unit,
                     "sizes": {way: [s / curve.unit for s in sizes] for way, sizes in chosen.items()},
                     "losses": {way: [curve.loss(s) for s in sizes] for way, sizes in chosen.items()},
                     "runs": runs, "noise": curve.noise(), "counts": count_errors(curve, told)})
    return rows


def of_way(rows, way):
    return [loss for row in rows for loss in row["losses"].get(way, [])]


def per_cent(value):
    return f"{100 * value:.0f}" if abs(value) >= 0.0995 else f"{100 * value:.1f}"


def median_and_worst(found):
    return f"{per_cent(statistics.median(found))}, {per_cent(max(found))}" if found else "-"


def grids_of(rows):
    return list(dict.fromkeys(row["grid"] for row in rows))


def table_of_grids(rows):
    ways = ["default", "mean_edge", "median_box_side", "unknown", "shipped", "fitted", "tuned"]
    titles = {**FIXED, **OURS}
    lines = ["| grid | scenes | " + " | ".join(titles[way] for way in ways) + " | runs |", "|---" * (len(ways) + 3) + "|"]
    for grid in grids_of(rows):
        own = [row for row in rows if row["grid"] == grid]
        runs = [r for row in own for r in row["runs"]]
        lines.append(f"| {grid} | {len(own)} | " + " | ".join(median_and_worst(of_way(own, way)) for way in ways) +
                     f" | {f'{statistics.mean(runs):.1f}, {max(runs)}' if runs else '-'} |")
    return "\n".join(lines) + "\n"


def table_of_ways(rows):
    lines = ["| all grids together | median | mean | 95th percentile | worst | aims: median, worst |", "|---|---|---|---|---|---|"]
    for way, title in {**FIXED, **OURS}.items():
        found = of_way(rows, way)
        if not found:
            continue
        aims = AIMS.get(way)
        text = ""
        if aims:
            # The aims hold for every grid.
            medians = [statistics.median(of_way([r for r in rows if r["grid"] == grid], way)) for grid in grids_of(rows)]
            met = (aims[0] is None or max(medians) <= aims[0]) and max(found) <= aims[1]
            first = "" if aims[0] is None else f"{100 * aims[0]:.0f} % in every grid, "
            text = f"{first}{100 * aims[1]:.0f} %: {'met' if met else '**missed**'}"
        lines.append(f"| {title} | {per_cent(statistics.median(found))} | {per_cent(statistics.mean(found))} | "
                     f"{per_cent(quantile(found, 0.95))} | {per_cent(max(found))} | {text} |")
    return "\n".join(lines) + "\n"


def table_of_counts(rows):
    lines = ["| grid | " + " | ".join(COUNTED) + " |", "|---" * (len(COUNTED) + 1) + "|"]
    for grid in grids_of(rows):
        own = [row for row in rows if row["grid"] == grid]
        cells = []
        for name in COUNTED:
            errors = [abs(e) for row in own for e in row["counts"][name]]
            cells.append(f"{per_cent(statistics.median(errors))}, {per_cent(max(errors))}" if errors else "-")
        lines.append(f"| {grid} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def notes(record, rows):
    beside, worst = max(((1 + row["losses"]["unknown"][0]) / (1 + row["losses"]["mean_edge"][0]) - 1, f"{row['grid']}, {row['scene']}")
                        for row in rows if "mean_edge" in row["losses"])
    noise = statistics.median(row["noise"] for row in rows)
    versions = ", ".join(f"{name} {version}" for name, version in sorted(record.get("versions", {}).items()))
    return (f"{record['cpu']}, {record['date']}; {versions or 'plain grids alone'}. A run takes {per_cent(noise)} % longer in the "
            f"median than the fastest one at its size. Compared with the mean edge the default call loses {per_cent(beside)} % at most ({worst}).\n")


def report_text(record, rows):
    return ("Loss in per cent, compared with the best size of the sweep: median, worst.\n\n" + table_of_grids(rows) + "\n" + table_of_ways(rows) +
            "\nPredicted counts, difference from counted ones in per cent: median, worst.\n\n" + table_of_counts(rows) + "\n" +
            notes(record, rows))


def print_scenes(rows):
    for row in rows:
        chosen = "  ".join(f"{way} {statistics.median(row['sizes'][way]):.2f} {per_cent(statistics.median(found))}%"
                           + (f"..{per_cent(max(found))}%" if len(found) > 1 else "") for way, found in row["losses"].items())
        print(f"{row['grid']:24} {row['scene']:14} best {row['best']:.2f}  {chosen}")
        print(f"{'':40}" + "  ".join(f"{name} {per_cent(min(e))}..{per_cent(max(e))}%" for name, e in row["counts"].items() if e))


def spans_of(rows):
    """Of each grid and way that is drawn, the median and the worst loss."""
    found = {grid: {way: of_way([r for r in rows if r["grid"] == grid], way) for way in DRAWN} for grid in grids_of(rows)}
    return {grid: {way: (statistics.median(f), max(f)) for way, f in ways.items() if f} for grid, ways in found.items()}


def draw(path, spans):
    """A row for each grid, with a bar from the median to the worst time of each way of choosing."""
    chart = Chart(760, 42 * len(spans) + 100, "What a cell size costs in grids that are not ours")
    times = Axis(0.99, 7, [1, 1.1, 1.25, 1.5, 2, 3, 5, 7], log=True, name="time of a run, best = 1, from the median scene to the worst")
    panel = Panel(chart, 190, 12, 550, 42 * len(spans), times,
                  Axis(len(spans) - 0.5, -0.5, dict(enumerate(spans))), grid=True)
    for y, ways in enumerate(spans.values()):
        for i, (way, (colour, _)) in enumerate(DRAWN.items()):
            if way in ways:
                middle, worst = (1 + max(loss, 0) for loss in ways[way])
                panel.bar(middle, worst, y + 0.17 * (i - 1.5), colour, 3)
                panel.dots([(middle, y + 0.17 * (i - 1.5))], colour, size=3)
    chart.legend(20, 42 * len(spans) + 66, [(words, chart.line_key(colour, 3)) for colour, words in DRAWN.values()], 4, 185)
    chart.write(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("curves")
    parser.add_argument("libvox")
    for name in ("--primitives", "--page", "--picture", "--report"):
        parser.add_argument(name)
    parser.add_argument("--draws", type=int, default=8, help="of noise, for each fit and each tuning")
    parser.add_argument("--scenes", action="store_true")
    options = parser.parse_args()
    record, curves = losses.load(options.curves)
    rows = evaluate(library.Vox(os.path.abspath(options.libvox)), curves, options.primitives, options.draws)
    text = report_text(record, rows)
    if options.scenes:
        print_scenes(rows)
    if options.report:
        with open(options.report, "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=1)
    if options.picture:
        draw(options.picture, spans_of(rows))
    if options.page:
        put(options.page, "foreign", "\n" + text)
    else:
        print(text, end="")


if __name__ == "__main__":
    main()
