"""A cut along facets: the tetrahedra of one side get copies of the vertices there."""

import numpy as np

import canvas
from canvas import B, BOLD, MARK, Drawing, View


def cut():
    """A bar, cut across its middle: tetrahedra and positions before and after, the vertices there and their copies."""
    import voxtet
    import voxtet.io
    bar = voxtet.io.make_box(4, 1, 1, 1)
    points = bar.positions - bar.positions.mean(axis=0)
    with voxtet.Grid() as grid:
        mesh = grid.add(points, bar.tets, copy=True)
        right = np.flatnonzero(points[bar.tets].mean(axis=1)[:, 0] > 0)
        shared = np.flatnonzero(abs(points[:, 0]) < 1e-9).astype(np.uint32)
        first = mesh.append_vertices(copies_of=shared)
        new = np.arange(mesh.info.vertex_count, dtype=np.uint32)
        new[shared] = first + np.arange(len(shared))
        mesh.replace_tets(right, new[bar.tets[right]])
        after, tets = np.array(mesh.positions), np.array(mesh.tets)
        grid.step()
    return points, bar.tets, after, tets, shared, new[shared]


def drawn():
    import voxtet.io
    points, tets, after, cut_tets, shared, copies = cut()
    assert len(after) == len(points) + len(shared)
    apart = after.copy()
    on_right = np.unique(cut_tets[after[cut_tets].mean(axis=1)[:, 0] > 0])
    apart[:, 0] -= .32
    apart[on_right, 0] += .64
    drawing = Drawing(450, "A cut: both sides share the vertices there; then one side gets copies of them, and a gap can open")
    for y, p, t in ((105, points, tets), (290, apart, cut_tets)):
        view = View(-24, 24, 96, (0, 0, 0), (350, y))
        drawing.solids(view, canvas.faces_of(p, voxtet.io.boundary(t), B, .42, B))
        seen = p[shared][(p[shared] @ view.eye).argsort()[1:]]  # all but the one behind
        if p is points:
            drawing.line(view.at(sorted(seen, key=lambda q: (-q[2], -q[1]))), MARK, BOLD)
        drawing.dots(view.at(seen), "ink", 6.5)
    drawing.dots(view.at(apart[copies]), MARK, 6.5)
    drawing.dots([(150, 422)], "ink", 6.5)
    drawing.label(168, 429, "vertices at the cut", anchor="start")
    drawing.dots([(424, 422)], MARK, 6.5)
    drawing.label(442, 429, "their copies", anchor="start")
    return drawing
