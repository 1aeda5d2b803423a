"""Which tetrahedra a vertex of a body never collides with: rings follow edges of the mesh, a rest distance is a length."""

import numpy as np

from canvas import B, BOLD, MARK, THIN, Drawing, circle, edges_of, path_of, steps_of

RINGS, DISTANCE = 1, .21
WIDE, HIGH = 15, 9  # vertices of a sheet that is fine at the left and coarse at the right
SHOWN = 4, 10  # columns of the vertices in the middle row whose filters are shown


def sheet():
    """Points of a flat mesh, its triangles, and the vertices to show."""
    x = np.cumsum(1.15 ** np.arange(WIDE))
    x = 2 * (x - x[0]) / (x[-1] - x[0]) - 1
    points = [(x[i], (1 - 2 * j / (HIGH - 1)) * (.68 + .2 * x[i])) for j in range(HIGH) for i in range(WIDE)]
    triangles = []
    for j in range(HIGH - 1):
        for i in range(WIDE - 1):
            a, b, c, d = (WIDE * (j + dj) + i + di for dj, di in ((0, 0), (0, 1), (1, 0), (1, 1)))
            triangles += [(a, b, c), (b, d, c)] if (i + j) % 2 else [(a, b, d), (a, d, c)]
    return np.array(points), triangles, [WIDE * (HIGH // 2) + column for column in SHOWN]


def ruled_out(points, triangles, vertex, **filters):
    """Triangles, with a corner below each, in which a step finds no self-contact of the vertex when it is moved there."""
    import voxtet
    rest = np.array([(*p, 0) for p in points] + [(*points[list(t)].mean(axis=0), -.1) for t in triangles])
    tets = [(*t, len(points) + i) for i, t in enumerate(triangles)]
    positions, found = rest.copy(), []
    with voxtet.Grid() as grid:
        grid.add(positions, tets, rest_positions=rest, filter=voxtet.Filter(self_collision=True, **filters))
        for i, tet in enumerate(tets):
            positions[:] = rest
            positions[vertex] = rest[list(tet)].mean(axis=0)
            grid.step()
            found += [i] if not any(c.vertex == vertex and c.tet == i for c in grid.contacts) else []
    return found


def drawn():
    points, triangles, vertices = sheet()
    drawing = Drawing(345, "Two filters of self-collision: rings rule out tetrahedra by edges, a rest distance by length")
    for x, words, name, filters in ((178, "rings: edges count", "self_rings", {"self_rings": RINGS}),
                                    (522, "rest distance: length counts", "self_rest_distance",
                                     {"self_rest_distance": DISTANCE})):
        at = points * 152 + (x, 142)
        for vertex in vertices:
            out = ruled_out(points, triangles, vertex, **filters)
            drawing.fill("".join(steps_of(at[list(triangles[i])]) for i in out), MARK, .24, .36)
        drawing.stroke("".join(path_of(at[list(edge)]) for edge in edges_of(triangles)), B, THIN)
        for vertex in vertices:
            if "self_rings" in filters:
                near = sorted({b for t in triangles if vertex in t for b in t if b != vertex})
                drawing.stroke("".join(path_of(at[[vertex, b]]) for b in near), MARK, BOLD)
                drawing.dots(at[near], MARK, 3)
            else:
                (cx, cy), r = at[vertex], DISTANCE * 152
                drawing.stroke(circle(cx, cy, r), MARK, BOLD)
        drawing.dots(at[vertices], "ink", 6)
        drawing.label(x, 308, words)
        drawing.label(x, 334, name, "axis", size=18)
    return drawing
