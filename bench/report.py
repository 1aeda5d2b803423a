#!/usr/bin/env python3
"""Writes docs/performance.md from the benchmark's results, and what is aimed at beside them into bench/README.md.

usage: report.py RESULTS.csv [CHART] > performance.md
       report.py RESULTS.csv --aims PAGE.md      between the lines of the page that say where they go
"""

import contextlib
import io
import math
import re
import sys

from figures import F1, F2, REFERENCE, SUBJECT, read

# Scene; at least so many times as fast as the reference engine at its best cell size and as the best peer; at most
# so many times a floor. The figures of scenes made to size are for a million tetrahedra.
GOALS = [
    ("overlap-1", 150, 15, (F1, 5)),
    ("contact-1", 60, 12, (F2, 1.2)),
    ("self", 60, 50, (F2, 2)),
    ("coil", 18, 20, (F2, 7)),
    ("bodies-5k", 18, 7, (F2, 4)),
    ("bodies-1k", 12, 6, None),
    ("overlap-50", 20, 8, (F2, 7)),
] + [(f"{body}-{kind}", *goal, None)
     for body in ("bunny", "cow", "armadillo")
     for kind, goal in (("light", (25, 8)), ("deep", (25, 8)), ("self", (18, 15)))]
SIZED = {goal[0] for goal in GOALS[:7]}
GOAL_TETS = (0.85e6, 1.25e6)  # what counts as a million
GOAL_BYTES_PER_TET = 40
GOAL_INSERTED_PER_SECOND = 2e6


def number(value, digits=3):
    """Rounded to so many significant digits, without an exponent."""
    if value is None:
        return "-"
    if value == 0:
        return "0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"


def table(header, rows):
    print("| " + " | ".join(header) + " |")
    print("|" + "|".join("---" if i == 0 else "---:" for i in range(len(header))) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def judged(value, limit, at_least):
    """A figure, its limit, and whether it is met."""
    if value is None:
        return f"- (goal {'≥' if at_least else '≤'} {limit}): not measured"
    met = value >= limit if at_least else value <= limit
    return f"{number(value)} ({'≥' if at_least else '≤'} {limit}): {'met' if met else '**missed**'}"


def goal_scene(scenes, name):
    """The run that the goals of this scene are judged by, or None."""
    for scene in scenes:
        if scene.name == name and (name not in SIZED or GOAL_TETS[0] <= scene.tets <= GOAL_TETS[1]):
            return scene
    return None


def aims(scenes):
    """Each figure beside what is aimed at."""
    rows = []
    for name, reference, peer, floor in GOALS:
        scene = goal_scene(scenes, name)
        if scene is None:
            continue
        on_floor = "-"
        if floor:
            ratio = scene.times_faster(floor[0])
            on_floor = judged(1 / ratio if ratio else None, floor[1], False) + f" ({floor[0].split()[0]})"
        rows.append([scene.label(), str(scene.tets), judged(scene.times_faster(REFERENCE), reference, True),
                     judged(scene.times_faster(scene.best_peer()), peer, True), on_floor])
    if not rows:
        print("The aims are for a million tetrahedra; this run has no such scene.\n")
        return
    table(["scene", "tets", "× as fast as the reference engine", "× as fast as the best peer", "× a floor"], rows)
    most, per_tet, largest, rate = memory_and_insertion(scenes)
    print(f"* Memory, bytes a tetrahedron beyond the caller's arrays, the worst scene ({most.name}, {most.tets} tets): "
          f"{judged(per_tet, GOAL_BYTES_PER_TET, False)}.")
    print(f"* Insertion, million tetrahedra a second ({largest.name}, {largest.tets} tets): "
          f"{judged(rate / 1e6, GOAL_INSERTED_PER_SECOND / 1e6, True)}.")


def in_short(scenes):
    """How many times as fast as the paper's algorithm and as the best of the others, scene by scene."""
    rows = []
    for scene in scenes:
        best, floor = scene.best_peer(), scene.times_faster(F2)
        rows.append([scene.label(), str(scene.tets), number(scene.ms(SUBJECT)), number(scene.times_faster(REFERENCE)),
                     number(scene.times_faster(best)) + (f" ({best})" if best else ""),
                     number(1 / floor if floor else None)])
    table(["scene", "tets", "ms a step", "× as fast as the paper's algorithm", "× as fast as the best other library",
           "× the time of making all boxes (F2)"], rows)


def memory_and_insertion(scenes):
    """The scene that takes most memory, its bytes a tetrahedron; the largest scene, tetrahedra inserted a second."""
    scenes = [scene for scene in scenes if SUBJECT in scene.rows]
    largest = max(scenes, key=lambda s: s.tets)
    most = max(scenes, key=lambda s: int(s.rows[SUBJECT]["bytes"]) / s.tets)
    per_tet = int(most.rows[SUBJECT]["bytes"]) / most.tets
    return most, per_tet, largest, largest.tets / (float(largest.rows[SUBJECT]["setup_ns"]) / 1e9)


def growth(scenes):
    """Time over size in logarithms: the slope of the least-squares line."""
    by_name = {}
    for scene in scenes:
        if not scene.is_comparison() and SUBJECT in scene.rows:
            by_name.setdefault(scene.name, []).append(scene)
    for name, runs in by_name.items():
        if len(runs) < 3:
            continue
        x = [math.log(run.tets) for run in runs]
        y = [math.log(run.ms(SUBJECT)) for run in runs]
        mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
        slope = (sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y))
                 / sum((a - mean_x) ** 2 for a in x))
        print(f"* Growth, {name}: time grows with the {slope:.2f}th power of the size from {runs[0].tets} to "
              f"{runs[-1].tets} tetrahedra; nanoseconds a tetrahedron: "
              + ", ".join(f"{number(run.ns_per_tet(SUBJECT))}" for run in runs) + ".")


def all_times(scenes):
    entrants = []
    for scene in scenes:
        entrants += [name for name in scene.rows if name not in entrants]
    rows = []
    for scene in scenes:
        row = [scene.name, str(scene.tets), str(scene.bodies), str(scene.contacts)]
        rows.append(row + [number(scene.ms(entrant)) for entrant in entrants])
    table(["scene", "tets", "bodies", "contacts"] + entrants, rows)


def bytes_per_tet(scenes):
    entrants = [name for name, row in scenes[0].rows.items() if row["kind"] != "floor"]
    rows = [[scene.name, str(scene.tets)] + [
        number(int(scene.rows[name]["bytes"]) / scene.tets, 2) if name in scene.rows else "-" for name in entrants
    ] for scene in scenes]
    table(["scene", "tets"] + entrants, rows)


def put(page, text):
    begin, end = "<!-- bench/aims -->\n", "<!-- /bench/aims -->"
    with open(page, encoding="utf-8") as file:
        head, rest = file.read().split(begin)
    with open(page, "w", encoding="utf-8") as file:
        file.write(head + begin + text + end + rest.split(end)[1])


def main():
    if len(sys.argv) not in (2, 3, 4) or (len(sys.argv) == 4 and sys.argv[2] != "--aims"):
        raise SystemExit(__doc__)
    rows, scenes = read(sys.argv[1])
    comparisons = [scene for scene in scenes if scene.is_comparison() and SUBJECT in scene.rows]
    if len(sys.argv) == 4:
        with contextlib.redirect_stdout(io.StringIO()) as text:
            aims(comparisons)
        put(sys.argv[3], text.getvalue())
        return
    run = rows[0]
    command = re.sub(r"(--meshes)[ =]\S+", r"\1 FOLDER", run["command"])
    print("# Performance\n")
    print("Written by `bench/report.py` from the benchmark's results; [bench/README.md](../bench/README.md) says what is "
          "timed and how, what was tried, and what is aimed at.\n")
    print(f"    {command}\n")
    print(f"* Machine: {run['cpu']}, one thread\n* Build: {run['build']}\n* Date: {run['date']}\n"
          f"* Contacts: {'the same from all' if all(r['agrees'] == '1' for r in rows) else '**NOT** the same from all'}\n")
    if len(sys.argv) == 3:
        print(f"![Nanoseconds a tetrahedron, by scene]({sys.argv[2]})\n")
    if comparisons:
        print("## In short\n")
        in_short(comparisons)
        most, per_tet, largest, rate = memory_and_insertion(comparisons)
        print(f"* Memory: at most {number(per_tet)} bytes a tetrahedron beyond the caller's arrays ({most.name}, "
              f"{most.tets} tets).")
        print(f"* Insertion: {number(rate / 1e6)} million tetrahedra a second ({largest.name}, {largest.tets} tets).")
    growth(scenes)
    if comparisons:
        print("\n## Milliseconds a step, medians\n")
        all_times(comparisons)
        print("## Bytes a tetrahedron, beyond the caller's arrays\n")
        bytes_per_tet(comparisons)


if __name__ == "__main__":
    main()
