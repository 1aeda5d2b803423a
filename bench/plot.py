#!/usr/bin/env python3
"""Draws the benchmark's results: nanoseconds a tetrahedron for every scene and entrant, and how vox grows: with
constraints, and contacts alone. SHORT is a picture of five scenes for readers who want no more.

usage: plot.py RESULTS.csv CHART.svg [SHORT.svg]
"""

import math
import sys

from chart import Axis, Chart, Panel, decades
from figures import AVX2, CONTACTS, F1, F2, REFERENCE, SUBJECT, read

STEPS = {SUBJECT: "with constraints", CONTACTS: "contacts alone"}
LABELS = {SUBJECT: "vox, with constraints", CONTACTS: "vox, contacts alone", REFERENCE: "paper's algorithm, contacts alone"}
STYLES = {SUBJECT: ("vox", "circle", 5.5), CONTACTS: ("vox", "circle", 4, True), REFERENCE: ("dark", "circle", 4), F1: ("grey", "tick", 3),
          F2: ("dark", "tick", 3)}
PEERS = [("blue", "square"), ("sky", "left"), ("orange", "diamond"), ("green", "up"), ("violet", "down"), ("brown", "right"),
         ("olive", "square"), ("teal", "diamond")]
LINES = ("blue", "orange", "green", "violet")
LEFT, RIGHT, ROW = 345, 740, 30
SHORT = {"contact-1": "two bodies touch", "self": "a body and itself", "bodies-1k": "1000 bodies", "bunny-deep": "bunny in bunny",
         "coincident": "all in one place"}


def scenes_height(scenes):
    return ROW * len(scenes) + 140


def limits(values):
    return 10 ** (math.floor(4 * math.log10(min(values))) / 4), 10 ** (math.ceil(4 * math.log10(max(values))) / 4)


def draw_scenes(chart, scenes, top, rows):
    entrants = list(dict.fromkeys(name for scene in scenes for name in scene.rows if name != AVX2))  # it would hide the subject
    peers = [name for name in entrants if name not in STYLES]
    styles = {**STYLES, **{name: (*PEERS[i % len(PEERS)], 3) for i, name in enumerate(peers)}}
    low, high = limits([scene.ns_per_tet(name) for scene in scenes for name in entrants if name in scene.rows])
    panel = Panel(chart, LEFT, top + 20, RIGHT - LEFT, ROW * len(scenes),
                  Axis(low, high, decades(low, high), log=True, name="nanoseconds a tetrahedron and step, one thread (left is faster)"),
                  Axis(len(scenes) - 0.5, -0.5, dict.fromkeys(range(len(scenes)), "")), grid=True)
    chart.text(RIGHT, top + 13, f"{rows[0]['cpu']}, {rows[0]['date']}", "end")
    for y, scene in enumerate(scenes):
        at = panel.at(low, y)[1]
        panel.labels("end", [(LEFT - 8, at - 2, scene.label()), (LEFT - 8, at + 11, f"{scene.tets:,} tets, {scene.contacts:,} contacts")])
    # vox over all others
    for name in sorted(entrants, key=lambda name: (styles[name][0] == "vox", name == REFERENCE)):
        panel.dots([(scene.ns_per_tet(name), y) for y, scene in enumerate(scenes) if name in scene.rows], *styles[name])
    chart.legend(40, top + scenes_height(scenes) - 60, [(LABELS.get(name, name), chart.mark_key(*styles[name])) for name in entrants], 3, 240)


def draw_growth(chart, runs, top, _):
    by_title = {}
    for run in runs:
        by_title.setdefault(run.title, []).append(run)
    longest = max(by_title.values(), key=len)
    times = [run.ms(name) for run in runs for name in (*STEPS, F2) if name in run.rows]
    low, high = min(run.tets for run in runs) * 0.9, max(run.tets for run in runs) * 1.1
    panel = Panel(chart, LEFT, top + 70, RIGHT - LEFT, 240, Axis(low, high, decades(low, high), log=True, name="tetrahedra"),
                  Axis(*limits(times), decades(*limits(times)), log=True, name="milliseconds a step: vox"), grid=True)
    keys = []
    for colour, (title, of_scene) in zip(LINES, by_title.items()):
        for entrant, dash in ((SUBJECT, ""), (CONTACTS, "2 3")):
            points = [(run.tets, run.ms(entrant)) for run in of_scene if entrant in run.rows]
            if points:
                panel.line(points, colour, dash=dash)
                panel.dots(points, colour, "circle", 3.5, hollow=bool(dash))
                keys.append((f"{title}, {STEPS[entrant]}", chart.line_key(colour, dash=dash)))
    panel.line([(run.tets, run.ms(F2)) for run in longest], "grey", dash="6 4")
    chart.legend(40, top + 10, [*keys, (F2, chart.line_key("grey", dash="6 4"))], 2, 360)


def draw_short(scenes, path):
    """Of each scene, the default step, the fastest peer and the paper's algorithm; each bar as a share of the longest."""
    scenes = [scene for name in SHORT for scene in scenes if scene.name == name and scene.is_comparison()]
    chart = Chart(700, 84 * len(scenes) + 14, "Time of a step that finds the same contacts, in five scenes")
    chart.FONT = 18
    left, right, thick = 190, 440, 21
    for i, scene in enumerate(scenes):
        top = 12 + 84 * i
        entrants = [(CONTACTS, "vox", "vox"), (scene.best_peer(), "blue", scene.best_peer()),
                    (REFERENCE, "grey", "paper's algorithm")]
        longest = max(scene.ms(name) for name, _, _ in entrants)
        chart.text(2, top + 16, SHORT[scene.name])
        chart.text(2, top + 40, f"{scene.tets:,} tets")
        for j, (name, colour, words) in enumerate(entrants):
            y, width = top + j * (thick + 3), (right - left) * scene.ms(name) / longest
            chart.add(f'<rect class="f {colour}" x="{left}" y="{y}" width="{max(width, 2):.1f}" height="{thick}"/>')
            times = scene.times_faster(CONTACTS, name)
            words += "" if j == 0 else f" × {times:.0f}" if times >= 10 else f" × {times:.1f}"
            chart.text(left + width + 6, y + 16, words)
    chart.write(path)


def main():
    if len(sys.argv) not in (3, 4):
        raise SystemExit(__doc__)
    rows, scenes = read(sys.argv[1])
    if len(sys.argv) == 4:
        draw_short(scenes, sys.argv[3])
    compared = [scene for scene in scenes if scene.is_comparison()]
    runs = [scene for scene in scenes if not scene.is_comparison() and F2 in scene.rows
            and (SUBJECT in scene.rows or CONTACTS in scene.rows)]
    # One part for each that has something to show.
    parts = [(draw_scenes, compared, scenes_height(compared)), (draw_growth, runs, 360)]
    parts = [part for part in parts if part[1]]
    if not parts:
        raise SystemExit(f"{sys.argv[1]} has nothing to draw")
    chart = Chart(760, sum(height for _, _, height in parts), "What a step takes, scene by scene")
    top = 0
    for draw, data, height in parts:
        draw(chart, data, top, rows)
        top += height
    chart.write(sys.argv[2])


if __name__ == "__main__":
    main()
