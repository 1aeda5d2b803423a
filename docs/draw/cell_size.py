"""Small cells: many visits. Large cells: many vertices to look at. Between them the cost is least."""

import numpy as np

from canvas import B, BOLD, LINE, MARK, THIN, Axis, Drawing, Panel, edges_of, number, path_of, steps_of

SIDE, EDGE = 186, 33  # of a square with a piece of a mesh, and of its triangles, in pixels
SHARES = (.22, 1, 1 / .22)  # of the best cell size


def mesh():
    """Points of a sheet of triangles that covers more than the square, its triangles, and one in the middle."""
    rows, columns, noise = 9, 8, np.random.RandomState(4)
    points = np.array([((i + .5 * (j % 2)) * EDGE, j * EDGE * .87) for j in range(rows) for i in range(columns)]) + (-24, -20)
    points += noise.uniform(-.16, .16, points.shape) * EDGE
    triangles = []
    for j in range(rows - 1):
        for i in range(columns - 1):
            a, c = j * columns + i, (j + 1) * columns + i
            triangles += [(a, a + 1, c), (a + 1, c + 1, c)] if j % 2 == 0 else [(a, a + 1, c + 1), (a, c + 1, c)]
    return points, triangles, triangles[2 * (4 * (columns - 1) + 3)]


def best():
    """Of a ball: the best cell size in mean edges, and what a step costs at sizes around it, both over the best."""
    import voxtet.io
    ball = voxtet.io.make_ball(1, .12)
    found = voxtet.suggest_cell_size(ball.positions, ball.tets)
    size = found.cell_size / voxtet.measure_geometry(ball.positions, ball.tets).mean_edge
    return size, [(p.cell_size / found.cell_size, p.cost / found.cost) for p in found.curve]


def drawn():
    size, curve = best()
    points, triangles, middle = mesh()
    drawing = Drawing(455, "The cost of a step over the cell size, and a triangle with the cells that it visits")
    panel = Panel(drawing, 50, 20, 600, 130, Axis(1 / 7.2, 7.2, {}, log=True), Axis(0, 6, {}))
    panel.line(curve, B, BOLD)
    drawing.text(34, 85, "cost", "middle", turned=True)
    drawing.label(644, 140, "cell size", anchor="end")
    for share, words in zip(SHARES, ("small: many visits", "best", "large: many vertices")):
        x, y = panel.at(share, np.interp(share, *zip(*curve)))
        drawing.line([(x, 150), (x, 196)], "axis", THIN, "3 5")
        drawing.dots([(x, y)], MARK, 7)
        cell = share * size * EDGE
        corners = points[list(middle)]
        low = np.floor(corners.min(axis=0) / cell)
        high = np.floor(corners.max(axis=0) / cell) + 1
        inside = [p for p in points if all(low * cell <= p) and all(p < high * cell)]
        drawing.add(f'<svg x="{number(x - SIDE / 2)}" y="196" width="{SIDE}" height="{SIDE}">')
        (left, top), (right, bottom) = low * cell, high * cell
        drawing.fill(path_of([(left, top), (right, top), (right, bottom), (left, bottom)]) + "z", MARK, .22, .36)
        drawing.stroke("".join(f"M{number(v)} 0v{SIDE}M0 {number(v)}h{SIDE}" for v in np.arange(0, SIDE + .1, cell)), "axis", .7)
        drawing.stroke("".join(path_of(points[[a, b]]) for a, b in edges_of(triangles)), B, THIN)
        drawing.fill(steps_of(corners), B, .6, .6, B, LINE)
        drawing.dots(inside, MARK, 3.5)
        drawing.add("</svg>")
        drawing.label(x, 412, words)
        cells = int((high - low).prod())
        drawing.label(x, 438, f"{cells} cell{'s' * (cells > 1)}, {len(inside)} vertices", "axis", size=18)
    return drawing
