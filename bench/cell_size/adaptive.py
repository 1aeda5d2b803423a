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

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "vox"
import matplotlib.pyplot as plt  # noqa: E402

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from page import put  # noqa: E402

WINDOW = 10
COLOURS = {"chosen": "#1f5fa8", "best": "#b0762b"}
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


def draw(runs, path):
    figure, axes = plt.subplots(3, len(runs), figsize=(5.6 * len(runs), 7.4), sharex=True, squeeze=False,
                                gridspec_kw={"height_ratios": [3, 3, 2]})
    for column, (engine, rows, found) in enumerate(runs):
        time, size, regret = (axes[i][column] for i in range(3))
        steps = [int(r["step"]) for r in rows]
        middle = [int(w[0]["step"]) + len(w[1]) / 2 for w in found]
        time.plot(steps, [float(r["chosen_ms"]) for r in rows], color=COLOURS["chosen"], lw=1, alpha=0.5,
                  label="a grid with cell_size 0")
        time.step(middle, [w[3] for w in found], where="mid", color=COLOURS["best"], lw=1.6,
                  label="best of 20 fixed sizes, each window")
        time.set_ylim(0, 1.25 * max(w[3] for w in found))
        time.set_title(f"{engine} engine")
        size.plot(steps, [float(r["cell_size"]) * float(r["inflation"]) for r in rows], color=COLOURS["chosen"], lw=1.4)
        size.plot(middle, [w[4] * float(w[1][len(w[1]) // 2]["inflation"]) for w in found], ".", color=COLOURS["best"])
        size.set_yscale("log")
        regret.axhline(0, color="#888", lw=0.8)
        regret.axhline(10, color="#c33", lw=0.8, ls="--")
        regret.step(middle, [100 * w[2] for w in found], where="mid", color=COLOURS["chosen"], lw=1.6)
        regret.set_ylim(-105, 30)
        regret.set_xlabel("step")
        for name, first, last in phases(rows):
            for axis in (time, size, regret):
                axis.axvline(first, color="#ccc", lw=0.8, zorder=0)
            regret.text((first + last) / 2, -102, TITLES[name].replace(" ", "\n"), ha="center", va="bottom", fontsize=7)
    axes[0][0].set_ylabel("ms a step")
    axes[0][0].legend(fontsize=8, loc="upper left")
    axes[1][0].set_ylabel("cell size, first edges")
    axes[2][0].set_ylabel("regret, %")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


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
