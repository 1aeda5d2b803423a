#!/usr/bin/env python3
"""The picture of a long run of a grid that chooses its cell size.

usage: adaptive.py RUN.csv PICTURE.svg [PAGE.md]   RUN.csv is what bench_adaptive wrote. Prints a table of the phases, and puts
it between the lines of the page that say where it goes.

The best fixed size is that of each window of steps, found in one half of them (every other step) and measured in the other
half, and the other way round.
"""
import csv
import os
import statistics
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from chart import Axis, Chart, Panel, round_ticks  # noqa: E402
from page import put  # noqa: E402

WINDOW = 10
COLOURS = {"chosen": "blue", "best": "orange"}
TITLES = {"contact": "light contact", "inflated": "inflated tenfold", "sinking": "sinking in", "cut": "cut in half",
          "added": "fine ball added", "removed": "removed"}


def median_ratio(pairs):
    return statistics.median(a / b for a, b in pairs)


def windows(rows, sizes):
    """(first row, rows, regret, best time, best size) of each window of one phase."""
    found = []
    start = 0
    while start < len(rows):
        end = start
        while end < len(rows) and end - start < WINDOW and rows[end]["phase"] == rows[start]["phase"]:
            end += 1
        part = rows[start:end]
        regrets, best_times, best_sizes = [], [], []
        for half in (0, 1):
            chosen_by, measured_by = part[half::2], part[1 - half::2]
            best = min(sizes, key=lambda s: median_ratio((float(r[s]), float(r["chosen_ms"])) for r in chosen_by))
            regrets.append(median_ratio((float(r["chosen_ms"]), float(r[best])) for r in measured_by) - 1)
            best_times += [float(r[best]) for r in measured_by]
            best_sizes.append(float(best))
        found.append((part[0], part, statistics.mean(regrets), statistics.median(best_times), statistics.mean(best_sizes)))
        start = end
    return found


def phases(rows):
    spans = []
    for row in rows:
        if not spans or spans[-1][0] != row["phase"]:
            spans.append([row["phase"], int(row["step"]), 0])
        spans[-1][2] = int(row["step"]) + 1
    return spans


def table(runs):
    lines = ["| engine | phase | tets | best fixed size, ms | regret: median | worst of the windows | changes | choosing, of the time |",
             "|---|---|---|---|---|---|---|---|"]
    for engine, rows, found in runs:
        for name, first, last in phases(rows):
            own = [w for w in found if w[0]["phase"] == name]
            part = [r for r in rows if r["phase"] == name]
            changes = int(part[-1]["changes"]) - int(rows[max(first - 1, 0)]["changes"])
            spent = sum(float(r["other_ms"]) - float(r["fixed_other_ms"]) for r in part)
            whole = sum(float(r["chosen_ms"]) for r in part)
            lines.append(f"| {engine} | {TITLES[name]} | {part[0]['tets']} | {statistics.median(w[3] for w in own):.3f} | "
                         f"{100 * statistics.median(w[2] for w in own):+.1f} % | {100 * max(w[2] for w in own):+.1f} % | "
                         f"{changes} | {max(100 * spent / whole, 0):.2f} % |")
        spent = sum(float(r["other_ms"]) - float(r["fixed_other_ms"]) for r in rows[1:])
        whole = sum(float(r["chosen_ms"]) for r in rows[1:])
        lines.append(f"| {engine} | all but the first step | | | {100 * statistics.median(w[2] for w in found):+.1f} % | "
                     f"{100 * max(w[2] for w in found):+.1f} % | {rows[-1]['changes']} | {max(100 * spent / whole, 0):.2f} % |")
    return "\n".join(lines) + "\n"


def steps_of(middles, values):
    """A line that is level from halfway to the last window to halfway to the next."""
    edges = [middles[0], *((a + b) / 2 for a, b in zip(middles, middles[1:])), middles[-1]]
    return [(x, value) for left, right, value in zip(edges, edges[1:], values) for x in (left, right)]


def draw(runs, path):
    """A column for each engine: times, cell sizes and regrets, step by step."""
    chart = Chart(760, 660, "A long run of a grid that chooses its cell size")
    for column, (engine, rows, found) in enumerate(runs):
        steps = [int(r["step"]) for r in rows]
        middle = [int(w[0]["step"]) + len(w[1]) / 2 for w in found]
        sizes = [float(r["cell_size"]) * float(r["inflation"]) for r in rows]
        best_sizes = [w[4] * float(w[1][len(w[1]) // 2]["inflation"]) for w in found]
        slowest = 1.25 * max(w[3] for w in found)

        def panel(top, height, y, name=""):
            x = Axis(0, steps[-1] + 6, round_ticks(0, steps[-1], 8) if name else [], name=name)
            return Panel(chart, 48 + 376 * column, top, 326, height, x, y, f"{engine} engine" if top < 30 else "")

        time = panel(26, 170, Axis(0, slowest, round_ticks(0, slowest), name="ms a step"))
        size = panel(216, 170, Axis(1, 40, [1, 2, 5, 10, 20, 40], log=True, name="cell size, mean edges at first"))
        regret = panel(406, 140, Axis(-100, 30, {-50: "-50", 0: "0", 10: "10"}, name="over the best, %"), "step")
        for name, first, last in phases(rows):
            for part in (time, size, regret):
                part.upright(first, "grid", 1)
            for i, word in enumerate(reversed(TITLES[name].split())):
                chart.text(regret.at((first + last) / 2, 0)[0], 540 - 11 * i, word, "middle", 9)
        time.line([(s, float(r["chosen_ms"])) for s, r in zip(steps, rows)], COLOURS["chosen"], 1)
        time.line(steps_of(middle, [w[3] for w in found]), COLOURS["best"])
        size.line(list(zip(steps, sizes)), COLOURS["chosen"])
        size.dots(zip(middle, best_sizes), COLOURS["best"], size=2.5)
        regret.level(0, "axis", 1)
        regret.level(10, "vox", 1, "5 4")
        regret.line(steps_of(middle, [100 * w[2] for w in found]), COLOURS["chosen"])
    chart.legend(60, 612, [("a grid that chooses its size", chart.line_key(COLOURS["chosen"])),
                           ("best of 20 fixed sizes, each window", chart.line_key(COLOURS["best"])),
                           ("the best size", chart.mark_key(COLOURS["best"], size=2.5)), ("10 % over the best", chart.line_key("vox", 1, "5 4"))], 2, 350)
    chart.write(path)


def main():
    if len(sys.argv) not in (3, 4):
        raise SystemExit(__doc__)
    with open(sys.argv[1], newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        all_rows = list(reader)
    sizes = reader.fieldnames[reader.fieldnames.index("chosen_ms") + 1:]
    runs = []
    for engine in dict.fromkeys(r["engine"] for r in all_rows):
        rows = [r for r in all_rows if r["engine"] == engine]
        runs.append((engine, rows, windows(rows, sizes)))
    text = table(runs)
    print(text, end="")
    draw(runs, sys.argv[2])
    if len(sys.argv) == 4:
        put(sys.argv[3], "adaptive", "\n" + text)


if __name__ == "__main__":
    main()
