#!/usr/bin/env python3
"""Tables of what each rule for the cell size loses, from the files that bench_regret wrote.

usage: regret.py PAGE.md RESULTS.csv...   Puts them between the lines of the page that say where they go; "-" prints.
       regret.py PICTURE.svg CURVES.csv   Draws sweeps and what the models predicted; CURVES.csv is of bench_regret --curves.
"""
import csv
import os
import statistics
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from chart import Axis, Chart, Panel  # noqa: E402
from page import put, quantile  # noqa: E402

RULES = {"model": "model", "grid": "grid", "mean_edge": "mean edge", "paper": "paper", "median_box": "median box"}
ENGINES = ("reference", "fast")


def per_cent(value, digits=1):
    return f"{100 * value:.{digits}f} %"


def summary(rows):
    lines = ["| engine | rule | median | 95th percentile | worst |", "|---|---|---|---|---|"]
    for engine in ENGINES:
        own = [r for r in rows if r["engine"] == engine]
        if not own:
            continue
        for rule, name in [*((r + "_regret", n) for r, n in RULES.items()), ("noise", "noise")]:
            values = [float(r[rule]) for r in own]
            lines.append(f"| {engine} | {name} | {per_cent(statistics.median(values))} | "
                         f"{per_cent(quantile(values, 0.95))} | {per_cent(max(values))} |")
    return "\n".join(lines) + "\n"


def by_size(rows):
    """Of the library's own choices, for scenes of about each size."""
    lines = ["| engine | tets | scenes | model: median, 95th, worst | grid: median, 95th, worst | noise, median | a suggestion, in steps: median, worst |",
             "|---|---|---|---|---|---|---|"]
    edges = [0, 20000, 100000, 500000, 10 ** 9]
    for engine in ENGINES:
        for low, high in zip(edges, edges[1:]):
            own = [r for r in rows if r["engine"] == engine and low <= int(r["tets"]) < high]
            if not own:
                continue
            cells = []
            for rule in ("model", "grid"):
                values = [float(r[rule + "_regret"]) for r in own]
                cells.append(f"{per_cent(statistics.median(values))}, {per_cent(quantile(values, 0.95))}, "
                             f"{per_cent(max(values))}")
            tets = sorted(int(r["tets"]) for r in own)
            steps = [float(r["suggest_steps"]) for r in own]
            noise = statistics.median(float(r["noise"]) for r in own)
            lines.append(f"| {engine} | {tets[0]:,} to {tets[-1]:,} | {len(own)} | {cells[0]} | {cells[1]} | {per_cent(noise)} | "
                         f"{statistics.median(steps):.2f}, {max(steps):.2f} |")
    return "\n".join(lines) + "\n"


def details(rows):
    lines = ["| engine | scene | tets | best, ms | best size | model's size | " + " | ".join(RULES.values()) +
             " | noise | suggestion, steps |", "|---" * (8 + len(RULES)) + "|"]
    for r in rows:
        losses = " | ".join(f"{100 * float(r[rule + '_regret']):+.1f} %" for rule in RULES)
        lines.append(f"| {r['engine']} | {r['scene']} | {r['tets']} | {float(r['best_ms']):.3f} | {float(r['best_size']):.2f} | "
                     f"{float(r['model_size']):.2f} | {losses} | {per_cent(float(r['noise']))} | {float(r['suggest_steps']):.2f} |")
    return "\n".join(lines) + "\n"


# How a picture names scenes.
NAMES = {"overlap-1": "two bodies, touching", "self": "a body and itself", "overlap-50": "two bodies, half inside",
         "graded-100": "two graded bodies"}


def draw(path, curves):
    """Times of the reference engine over those of the best size, and its model as lines, fitted to them in height."""
    lines = {}
    with open(curves, newline="", encoding="utf-8") as file:
        for engine, scene, _, size, ms, model in csv.reader(file):
            if engine == "reference":
                lines.setdefault(scene, []).append((float(size), float(ms), float(model)))
    chart = Chart(760, 420, "Measured times, and the model of the reference engine")
    panel = Panel(chart, 44, 16, 700, 290, Axis(0.22, 8, [0.25, 0.5, 1, 2, 4, 8], log=True, name="cell size, mean edges"),
                  Axis(0, 4, [0, 1, 2, 3, 4], name="time of a step, best = 1"))
    colours = ("blue", "orange", "green", "violet")
    for i, (colour, (scene, points)) in enumerate(zip(colours, lines.items())):
        sizes, times, models = zip(*(p for p in sorted(points) if p[2] > 0))
        best = statistics.median(sorted(times)[:3])
        height = statistics.median(m / t for t, m in zip(times, models) if t < 2 * best)
        curve = [m / height / best for m in models]
        zone = [s for s, c in zip(sizes, curve) if c <= 1.05 * min(curve)]
        panel.dots([(s, t / best) for s, t in zip(sizes, times)], colour, size=2.5)
        panel.line(list(zip(sizes, curve)), colour)
        panel.bar(zone[0], zone[-1], 0.15 * (i + 1), colour)
    keys = [(NAMES.get(scene, scene), chart.line_key(colour)) for colour, scene in zip(colours, lines)]
    keys += [("model", chart.line_key("dark")), ("measured", chart.mark_key("dark", size=2.5)), ("zone of 5 %", chart.line_key("dark", 4))]
    chart.legend(60, 366, keys, 4, 170)
    chart.write(path)


def main():
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    if not sys.argv[1].endswith(".md") and sys.argv[1] != "-":
        draw(sys.argv[1], sys.argv[2])
        return
    rows = {}
    for path in sys.argv[2:]:
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                rows[row["engine"], row["scene"], row["tets"]] = row  # a later file's row counts
    ordered = sorted(rows.values(), key=lambda r: (int(r["tets"]), r["scene"], r["engine"] != "reference"))
    text = summary(ordered) + "\n" + by_size(ordered)
    page = sys.argv[1]
    if page == "-":
        print(text, details(ordered), sep="\n")
        return
    text += f"\nScene by scene: {len(ordered)} rows in [regret.md](regret.md).\n"
    put(page, "regret", "\n" + text)
    with open(page.rsplit("/", 1)[0] + "/regret.md", "w", encoding="utf-8") as file:
        file.write("# What each rule for the cell size loses, scene by scene\n\n"
                   "Regrets, and sizes in mean edges, written by `bench/cell_size/regret.py`; [cell-size.md](cell-size.md#what-each-rule-loses) explains both.\n"
                   "A negative regret is better than the best uniform size of the sweep, by noise or by several cell sizes.\n\n"
                   + details(ordered))


if __name__ == "__main__":
    main()
