#!/usr/bin/env python3
"""Draws the benchmark's results: nanoseconds a tetrahedron for every scene and entrant, and how vox grows: with
constraints, and contacts alone.

usage: plot.py RESULTS.csv CHART.svg
"""

import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

from figures import AVX2, CONTACTS, F1, F2, REFERENCE, SUBJECT, read

SUBJECT_COLOUR = "#c2185b"
REFERENCE_COLOUR = "#333333"
STEPS = {SUBJECT: "with constraints", CONTACTS: "contacts alone"}
LABELS = {SUBJECT: "vox, with constraints", CONTACTS: "vox, contacts alone", REFERENCE: "paper's algorithm, contacts alone"}
PEER_COLOURS = ["#1f77b4", "#6baed6", "#ff7f0e", "#2ca02c", "#9467bd", "#8c564b", "#bcbd22", "#17becf"]
PEER_MARKERS = "s<D^vPX>"


def style(entrant, peers):
    if entrant == SUBJECT:
        return {"color": SUBJECT_COLOUR, "marker": "o", "s": 80, "zorder": 4}
    if entrant == CONTACTS:
        return {"color": SUBJECT_COLOUR, "facecolors": "white", "marker": "o", "s": 50, "zorder": 4}
    if entrant == REFERENCE:
        return {"color": REFERENCE_COLOUR, "marker": "o", "s": 45, "zorder": 3}
    if entrant in (F1, F2):
        return {"color": "#bbbbbb" if entrant == F1 else "#666666", "marker": "|", "s": 120, "zorder": 2}
    i = peers.index(entrant)
    return {"color": PEER_COLOURS[i % len(PEER_COLOURS)], "marker": PEER_MARKERS[i % len(PEER_MARKERS)], "s": 28,
            "zorder": 2, "alpha": 0.85}


def scenes_height(scenes):
    """Inches."""
    return 0.5 + 0.4 * len(scenes)


def draw_scenes(axes, scenes):
    entrants, peers = [], []
    for scene in scenes:
        for name, row in scene.rows.items():
            if name not in entrants and name != AVX2:  # it would hide the subject
                entrants.append(name)
                if row["kind"] == "peer":
                    peers.append(name)
    for entrant in entrants:
        points = [(scene.ns_per_tet(entrant), y) for y, scene in enumerate(scenes) if entrant in scene.rows]
        label = LABELS.get(entrant, entrant)
        axes.scatter(*zip(*points), label=label, **style(entrant, peers))
    axes.set_xscale("log")
    axes.set_yticks(range(len(scenes)))
    axes.set_yticklabels([f"{scene.label()}\n{scene.tets:,} tets, {scene.contacts:,} contacts" for scene in scenes],
                         fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel("nanoseconds a tetrahedron and step, one thread (left is faster)")
    axes.grid(axis="x", which="major", color="#dddddd")
    axes.grid(axis="y", color="#eeeeee")
    axes.set_axisbelow(True)
    axes.legend(loc="upper center", bbox_to_anchor=(0.4, -0.5 / scenes_height(scenes)), ncol=4, fontsize=8,
                frameon=False)


def draw_growth(axes, runs):
    by_name = {}
    for run in runs:
        by_name.setdefault(run.name, (run.title, []))[1].append(run)
    for i, (title, of_scene) in enumerate(by_name.values()):
        for entrant, line, fill in ((SUBJECT, "o-", f"C{i}"), (CONTACTS, "o:", "white")):
            measured = [run for run in of_scene if entrant in run.rows]
            if measured:
                axes.plot([run.tets for run in measured], [run.ms(entrant) for run in measured], line, color=f"C{i}",
                          markerfacecolor=fill, label=f"{title}, {STEPS[entrant]}")
    longest = max((of_scene for _, of_scene in by_name.values()), key=len)
    axes.plot([run.tets for run in longest], [run.ms(F2) for run in longest], "--", color="#999999", label=F2)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("tetrahedra")
    axes.set_ylabel("milliseconds a step: vox")
    axes.grid(color="#dddddd")
    axes.legend(fontsize=8, frameon=False)


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    rows, scenes = read(sys.argv[1])
    compared = [scene for scene in scenes if scene.is_comparison()]
    runs = [scene for scene in scenes if not scene.is_comparison() and F2 in scene.rows
            and (SUBJECT in scene.rows or CONTACTS in scene.rows)]
    # One panel for each part that has something to show.
    parts = [(draw_scenes, compared, scenes_height(compared)), (draw_growth, runs, 3.6)]
    parts = [part for part in parts if part[1]]
    if not parts:
        raise SystemExit(f"{sys.argv[1]} has nothing to draw")
    heights = [height for _, _, height in parts]
    # svg.hashsalt: the same results give the same file.
    plt.rcParams.update({"font.family": "DejaVu Sans", "svg.hashsalt": "vox"})
    between = 1.6 if len(parts) > 1 else 0  # inches, for axis and legend
    figure, axes = plt.subplots(len(parts), 1, figsize=(9, sum(heights) + between), squeeze=False, gridspec_kw={
        "height_ratios": heights, "hspace": between / (sum(heights) / len(parts)),
        "top": 1, "bottom": 0})  # the margins are added when it is saved
    for (draw, data, _), panel in zip(parts, axes[:, 0]):
        draw(panel, data)
    axes[0, 0].set_title(f"{rows[0]['cpu']}, {rows[0]['date']}", fontsize=9, loc="right")
    figure.savefig(sys.argv[2], bbox_inches="tight", metadata={"Date": None})


if __name__ == "__main__":
    main()
