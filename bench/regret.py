#!/usr/bin/env python3
"""Tables of what each rule for the cell size loses, from the files that bench_regret wrote.

usage: regret.py PAGE.md RESULTS.csv...   Puts them between the lines of the page that say where they go; "-" prints.
"""
import csv
import math
import statistics
import sys

RULES = {"model": "model", "grid": "grid", "mean_edge": "mean edge", "paper": "paper", "median_box": "median box"}
ENGINES = ("reference", "fast")


def quantile(values, part):
    """The smallest value that so large a part of all is not above."""
    return sorted(values)[max(math.ceil(part * len(values)), 1) - 1]


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


def main():
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    rows = {}
    for path in sys.argv[2:]:
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                rows[row["engine"], row["scene"], row["tets"]] = row  # a later file's row counts
    ordered = sorted(rows.values(), key=lambda r: (int(r["tets"]), r["scene"], r["engine"] != "reference"))
    text = summary(ordered) + "\n" + by_size(ordered)
    page = sys.argv[1]
    if page == "-":
        print(text)
        print(details(ordered))
        return
    begin, end = "<!-- bench/regret -->\n", "<!-- /bench/regret -->"
    with open(page, encoding="utf-8") as file:
        old = file.read()
    head, rest = old.split(begin)
    tail = rest.split(end)[1]
    text += f"\nScene by scene: {len(ordered)} rows in [regret.md](regret.md).\n"
    with open(page, "w", encoding="utf-8") as file:
        file.write(head + begin + text + end + tail)
    with open(page.rsplit("/", 1)[0] + "/regret.md", "w", encoding="utf-8") as file:
        file.write("# What each rule for the cell size loses, scene by scene\n\n"
                   "Regrets and sizes (in mean edges) as [cell-size.md](cell-size.md) says, written by `bench/regret.py`.\n"
                   "Negative: better than the best uniform size of the sweep, by noise or by several cell sizes.\n\n"
                   + details(ordered))


if __name__ == "__main__":
    main()
