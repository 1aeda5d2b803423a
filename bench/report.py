#!/usr/bin/env python3
"""Writes docs/evidence/performance.md from the benchmark's results, what is aimed at beside them into bench/README.md, and the
headlines of README.md.

usage: report.py RESULTS.csv [CHART] > performance.md
       report.py RESULTS.csv --aims PAGE.md        between the lines of the page that say where they go
       report.py RESULTS.csv --headlines PAGE.md   likewise
"""

import contextlib
import io
import math
import os
import re
import sys
from collections import namedtuple

from figures import AVX2, CONTACTS, F1, F2, REFERENCE, SUBJECT, read
from page import put

# What is aimed at in a scene; None: nothing. A step with constraints takes at most `over` times as long as contacts alone, and is
# at least `peer` times as fast as the best peer, which finds contacts alone. Contacts alone are found at least so many
# times as fast as by the reference engine at its best cell size and by the best peer, and take at most so many times a
# floor. The figures of scenes made to size are for a million tetrahedra.
Goal = namedtuple("Goal", "scene over peer reference contacts_peer floor")
SIZED_GOALS = [
    Goal("overlap-1", 1.3, 12, 150, 15, (F1, 7)),
    Goal("contact-1", 1.5, 12, 60, 12, (F2, 1.2)),
    Goal("self", 1.1, 50, 60, 50, (F2, 2)),
    Goal("self-lively", 1.1, 80, 60, 80, None),
    Goal("coil", 1.3, 35, 18, 20, (F2, 7)),
    Goal("bodies-5k", 1.4, 8, 18, 7, (F2, 4)),
    Goal("bodies-1k", 1.4, 6, 12, 6, None),
    Goal("overlap-50", 1.5, 12, 20, 8, (F2, 7)),
    Goal("tangled", 5, None, None, None, None),
    Goal("coincident", 5, None, None, None, None),
    Goal("swallowed", 10, None, None, None, None),
]
GOALS = SIZED_GOALS + [Goal("pile", 2, None, None, None, None)] + [
    Goal(f"{body}-{kind}", *goal, None)
    for body in ("bunny", "cow", "armadillo")
    for kind, goal in (("light", (1.5, 8, 25, 8)), ("deep", (1.5, 8, 25, 8)), ("self", (1.1, 15, 18, 15)))]
SIZED = {goal.scene for goal in SIZED_GOALS}
GOAL_TETS = (0.85e6, 1.25e6)  # what counts as a million
GOAL_BYTES_PER_TET = 40
GOAL_INSERTED_PER_SECOND = 8e6
GOAL_AVX2 = 1.3  # times as long as with AVX-512
HEADLINE = "contact-1"  # the scene of the README's figures
HARD = ("tangled", "coincident", "swallowed")  # nearly every vertex in contact: their memory is that of contacts


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
    if limit is None:
        return "-"
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


def inverse(value):
    return 1 / value if value else None


def over_contacts(scene):
    """How many times as long as contacts alone a step with constraints takes, or None."""
    return inverse(scene.times_faster(SUBJECT, CONTACTS))


def over_avx512(scene):
    """How many times as long a step with constraints takes with AVX2, or None."""
    return scene.times_faster(SUBJECT, AVX2)


def aims(scenes):
    """Each figure beside what is aimed at: first the step with constraints, then contacts alone."""
    full, alone = [], []
    for goal in GOALS:
        scene = goal_scene(scenes, goal.scene)
        if scene is None:
            continue
        start, best = [scene.label(), str(scene.tets)], scene.best_peer()
        full.append(start + [judged(over_contacts(scene), goal.over, False),
                             judged(scene.times_faster(SUBJECT, best), goal.peer, True)])
        if goal.reference is None:
            continue
        on_floor = "-"
        if goal.floor:
            floor, limit = goal.floor
            on_floor = judged(inverse(scene.times_faster(CONTACTS, floor)), limit, False) + f" ({floor.split()[0]})"
        alone.append(start + [judged(scene.times_faster(CONTACTS, REFERENCE), goal.reference, True),
                              judged(scene.times_faster(CONTACTS, best), goal.contacts_peer, True), on_floor])
    if not full:
        print("The aims are for a million tetrahedra; this run has no such scene.\n")
        return
    print("A step with constraints (`VOX_GRID_CONSTRAINTS`):\n")
    table(["scene", "tets", "× contacts alone", "× as fast as the best peer, which finds contacts alone"], full)
    print("Contacts alone, the default:\n")
    table(["scene", "tets", "× as fast as the reference engine", "× as fast as the best peer", "× a floor"], alone)
    most, per_tet = most_bytes(scenes, SUBJECT)
    if most:
        print(f"* Memory of a grid with constraints, bytes a tetrahedron beyond the caller's arrays, the worst scene but for the hard "
              f"ones ({most.name}, {most.tets} tets): {judged(per_tet, GOAL_BYTES_PER_TET, False)}.")
    slowest = max((scene for scene in scenes if AVX2 in scene.rows and SUBJECT in scene.rows), key=over_avx512,
                  default=None)
    if slowest:
        print(f"* A step with constraints with AVX2 beside AVX-512, the worst scene ({slowest.name}, {slowest.tets} tets): "
              f"{judged(over_avx512(slowest), GOAL_AVX2, False)}.")
    largest, rate = insertion(scenes, SUBJECT)
    if largest:
        print(f"* Insertion into a grid with constraints, million tetrahedra a second ({largest.name}, {largest.tets} tets): "
              f"{judged(rate / 1e6, GOAL_INSERTED_PER_SECOND / 1e6, True)}.")


def in_short(scenes):
    """The step with constraints beside contacts alone and the best of the others, then contacts alone beside the others."""
    rows = []
    for scene in scenes:
        best = scene.best_peer()
        rows.append([scene.label(), str(scene.tets), number(scene.ms(SUBJECT)), number(scene.ms(CONTACTS)),
                     number(over_contacts(scene)), number(over_avx512(scene)),
                     number(scene.times_faster(SUBJECT, best)), number(scene.times_faster(CONTACTS, best)), best or "-",
                     number(scene.times_faster(CONTACTS, REFERENCE)),
                     number(inverse(scene.times_faster(CONTACTS, F2)))])
    table(["scene", "tets", "with constraints, ms", "contacts alone, ms", "constraints / contacts alone",
           "constraints with AVX2 / with AVX-512", "constraints: × as fast as the best other library", "contacts alone: × as fast as it", "which",
           "contacts alone: × as fast as the paper's algorithm",
           "contacts alone: × the time of making all boxes (F2)"], rows)
    print("A step with constraints finds depths, normals and stencils, too. A default step, the other libraries and the paper's "
          "algorithm find contacts alone.\n")


def most_bytes(scenes, entrant):
    """The scene where the entrant takes most memory, of those that are not hard, and its bytes a tetrahedron."""
    scenes = [scene for scene in scenes if entrant in scene.rows and scene.name not in HARD]
    most = max(scenes, key=lambda s: s.bytes_per_tet(entrant), default=None)
    return most, most and most.bytes_per_tet(entrant)


def insertion(scenes, entrant):
    """The largest scene, tetrahedra that the entrant inserted a second."""
    largest = max((scene for scene in scenes if entrant in scene.rows), key=lambda s: s.tets, default=None)
    return largest, largest and largest.tets / (float(largest.rows[entrant]["setup_ns"]) / 1e9)


def memory_and_insertion(scenes):
    for entrant, grid in ((SUBJECT, "a grid with constraints"), (CONTACTS, "a default grid")):
        most, per_tet = most_bytes(scenes, entrant)
        if not most:
            continue
        largest, rate = insertion(scenes, entrant)
        print(f"* Memory of {grid}: at most {number(per_tet)} bytes a tetrahedron beyond the caller's arrays "
              f"({most.name}, {most.tets} tets; without the hard scenes). Insertion: {number(rate / 1e6)} million tetrahedra a second "
              f"({largest.name}, {largest.tets} tets).")


def growth(scenes):
    """Time over size in logarithms: the slope of the least-squares line."""
    for entrant, step in ((SUBJECT, "with constraints"), (CONTACTS, "contacts alone")):
        by_name = {}
        for scene in scenes:
            if not scene.is_comparison() and entrant in scene.rows:
                by_name.setdefault(scene.name, []).append(scene)
        for name, runs in by_name.items():
            if len(runs) < 3:
                continue
            x = [math.log(run.tets) for run in runs]
            y = [math.log(run.ms(entrant)) for run in runs]
            mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
            slope = (sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y))
                     / sum((a - mean_x) ** 2 for a in x))
            print(f"* Growth, {name}, {step}: time grows with the {slope:.2f}th power of the size from {runs[0].tets} to "
                  f"{runs[-1].tets} tetrahedra; nanoseconds a tetrahedron: "
                  + ", ".join(f"{number(run.ns_per_tet(entrant))}" for run in runs) + ".")


def all_times(scenes):
    entrants = []
    for scene in scenes:
        entrants += [name for name in scene.rows if name not in entrants]
    rows = []
    for scene in scenes:
        row = [scene.name, str(scene.tets), str(scene.bodies), str(scene.contacts)]
        rows.append(row + [number(scene.ms(entrant)) for entrant in entrants])
    table(["scene", "tets", "bodies", "contacts"] + entrants, rows)


def all_bytes(scenes):
    entrants = [name for name, row in scenes[0].rows.items() if row["kind"] != "floor"]
    rows = [[scene.name, str(scene.tets)] + [number(scene.bytes_per_tet(name), 2) for name in entrants]
            for scene in scenes]
    table(["scene", "tets"] + entrants, rows)


def headlines(scenes):
    """The README's sentence, by the name of the place where it goes."""
    scene = next((s for s in scenes if s.name == HEADLINE and SUBJECT in s.rows and CONTACTS in s.rows), None)
    if scene is None:
        raise SystemExit(f"the headlines need {SUBJECT} and {CONTACTS} in the scene {HEADLINE}")
    text = (f"A step over two bodies in contact, {scene.tets:,} tetrahedra in all, takes\n  {number(scene.ms(CONTACTS), 2)} ms on one "
            f"thread; with constraints, depths included, {number(scene.ms(SUBJECT), 2)} ms.")
    best = scene.best_peer()
    if best:
        text += (f" The fastest other library, {best.split()[0]}, takes\n  {number(scene.times_faster(CONTACTS, best), 2)} times as long to find "
                 f"the same contacts.")
    return {"fast": text}


def main():
    if len(sys.argv) not in (2, 3, 4) or (len(sys.argv) == 4 and sys.argv[2] not in ("--aims", "--headlines")):
        raise SystemExit(__doc__)
    rows, scenes = read(sys.argv[1])
    comparisons = [scene for scene in scenes if scene.is_comparison() and (SUBJECT in scene.rows or CONTACTS in scene.rows)]
    if len(sys.argv) == 4:
        page = sys.argv[3]
        if sys.argv[2] == "--headlines":
            for name, text in headlines(comparisons).items():
                put(page, name, text)
            return
        with contextlib.redirect_stdout(io.StringIO()) as text:
            aims(comparisons)
        put(page, "aims", "\n" + text.getvalue())
        return
    run = rows[0]
    command = re.sub(r"(--meshes)[ =]\S+", r"\1 FOLDER", run["command"])
    print("# Performance\n")
    print(f"Written by `bench/report.py` from [the benchmark's results]({os.path.basename(sys.argv[1])}); "
          f"[bench/README.md](../../bench/README.md) says what is timed and how, what was tried, and what is aimed at. `{SUBJECT}` is a grid with constraints with all that its step "
          f"does, `{CONTACTS}` the default grid.\n")
    print(f"    {command}\n")
    print(f"* Machine: {run['cpu']}, one thread\n* Build: {run['build']}\n* Date: {run['date']}\n"
          f"* Contacts: {'the same from all' if all(r['agrees'] == '1' for r in rows) else '**NOT** the same from all'}\n")
    if len(sys.argv) == 3:
        print(f"![In five scenes: the default step of vox, the fastest other library, the paper's algorithm]({sys.argv[2].replace('.svg', '-short.svg')})\n")
        print(f"All scenes:\n\n![Nanoseconds per tetrahedron, by scene]({sys.argv[2]})\n")
    if comparisons:
        print("## In short\n")
        in_short(comparisons)
        memory_and_insertion(comparisons)
    growth(scenes)
    if comparisons:
        print("\n## Milliseconds a step, medians\n")
        all_times(comparisons)
        print("## Bytes a tetrahedron, beyond the caller's arrays\n")
        all_bytes(comparisons)


if __name__ == "__main__":
    main()
