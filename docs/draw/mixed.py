"""A coarse body and a fine one meet: what a step of the paper's algorithm costs with the cell size of each rule."""

import os
import re

import numpy as np

from canvas import A, B, LINE, MARK, ROOT, THIN, Drawing, circle, edges_of, path_of

SCENE = "reference", "unlike-100", "39768"  # of docs/evidence/regret.md
RULES = (("vox, cell_size = 0", "grid"), ("vox, suggested size", "model"), ("best size of a sweep", None),
         ("median box", "median box"), ("mean edge", "mean edge"))
LEFT, RIGHT, TOP, STEP = 430, 640, 56, 46  # of the bars, in pixels


def times_the_best():
    """What each rule's size costs in that scene, over the best of all sizes tried."""
    with open(os.path.join(ROOT, "docs", "evidence", "regret.md"), encoding="utf-8") as file:
        rows = [[cell.strip() for cell in line.strip("|\n").split("|")] for line in file if line.startswith("|")]
    names = rows[0]
    row = dict(zip(names, next(row for row in rows if tuple(row[:3]) == SCENE)))
    return [1 + float(re.match(r"[+-][\d.]+", row[rule])[0]) / 100 if rule else 1 for _, rule in RULES]


def disc(edge, seed):
    """Points and triangles of a disc of radius 1."""
    count, noise = int(2 / edge) + 3, np.random.RandomState(seed)
    at = {(i, j): np.array([(i + .5 * (j % 2)) * edge, j * edge * .87]) for i in range(-count, count) for j in range(-count, count)}
    inside = sorted(key for key, p in at.items() if np.hypot(*p) < 1 + edge / 3)
    points = np.array([at[key] + noise.uniform(-.12, .12, 2) * edge for key in inside])
    rim = np.hypot(*points.T)
    points[rim > 1 - edge / 2] /= rim[rim > 1 - edge / 2, None]
    number = {key: i for i, key in enumerate(inside)}
    triangles = []
    for i, j in inside:
        s = j % 2
        for triangle in (((i, j), (i + 1, j), (i + s, j + 1)), ((i, j), (i + s, j + 1), (i + s - 1, j + 1))):
            if all(key in number for key in triangle):
                triangles.append(tuple(number[key] for key in triangle))
    return points, triangles


def drawn():
    drawing = Drawing(300, "Two bodies whose edges are 100 to 1, and what a step costs with the cell size of each rule")
    coarse, fine = disc(.42, 2), disc(.17, 3)
    spot, lens, big = np.array([152, 178]), np.array([136, 70]), 62

    def body(mesh, scale, centre, colour):
        points, triangles = mesh
        at = points * scale + centre
        for triangle in triangles:
            drawing.fill(path_of(at[list(triangle)]) + "z", colour, .34)
        drawing.stroke("".join(path_of(at[[a, b]]) for a, b in edges_of(triangles)), colour, THIN)

    body(coarse, 72, (80, 190), B)
    # The fine body in its place is a dot: its picture is under a lens.
    drawing.dots([spot], A, 3)
    along = (lens - spot) / np.hypot(*(lens - spot))
    drawing.line([spot + 7 * along, lens - big * along], "axis", THIN)
    drawing.fill(circle(*lens, big), "paper", 1, edge="axis")
    body(fine, 46, lens, A)
    drawing.label(8, 288, "two bodies, edges 100 : 1", anchor="start", size=18)
    drawing.label(692, 24, "time of a step, as a multiple of the best single size", anchor="end", size=18)
    most = max(times_the_best())
    for i, ((words, rule), times) in enumerate(zip(RULES, times_the_best())):
        y = TOP + i * STEP
        ours = words.startswith("vox")
        end = LEFT + 8 + (RIGHT - LEFT - 8) * times / most
        drawing.fill(path_of([(LEFT + 8, y), (end, y), (end, y + 28), (LEFT + 8, y + 28)]) + "z", MARK if ours else "grey", .85)
        drawing.label(LEFT, y + 21, words, anchor="end", size=18, bold=ours)
        drawing.label(end + 7, y + 21, f"{times:.3g}", MARK if ours else "ink", "start", 18, ours)
    drawing.line([(LEFT + 8, TOP - 6), (LEFT + 8, TOP + len(RULES) * STEP - 10)], "axis", LINE)
    return drawing
