"""What a contact is: a vertex in a tetrahedron. On a facet that two of them share it is one contact, in the lowest."""

import numpy as np

from canvas import A, B, LINE, MARK, Drawing, View, faces_of, positive, triangles_of

ONE = np.array([[-.75, -.35, 0], [.75, -.5, 0], [.1, .85, 0], [0, 0, 1.25]])
TWO = np.array([[-1.05, .1, 0], [1.05, -.1, .02], [0, -.8, -.1], [0, .75, .02], [0, 0, 1.1]])


def spike_at(view, tip):
    """A tetrahedron of the other body, its tip first, that comes from above, the left and the viewer's side."""
    right, up = view.axes[0], -view.axes[1]
    base = tip - .85 * right + .6 * up + .45 * view.eye
    return np.array([tip, base - .26 * right - .16 * up, base + .1 * right + .28 * up,
                     base + .12 * right - .04 * up + .3 * view.eye])


def contacts(corners, tets, spike):
    """Tetrahedra in which a step finds the tip of the spike."""
    import voxtet
    with voxtet.Grid() as grid:
        body, other = grid.add(corners, tets), grid.add(spike, [[0, 1, 2, 3]])
        grid.step()
        return [int(c.tet) for c in grid.contacts if c.body_a == other.id and c.body_b == body.id and c.vertex == 0]


def crossings(view, corners, facets, spike):
    """Where the three edges from the tip leave the body: all through one facet that faces the viewer."""
    for a, b, c in facets:
        sides = np.column_stack([corners[b] - corners[a], corners[c] - corners[a]])
        at = [np.linalg.solve(np.column_stack([sides, spike[0] - end]), spike[0] - corners[a]) for end in spike[1:]]
        if view.towards(np.cross(*sides.T)) > 0 and all(0 < u and 0 < v and u + v < 1 and 0 < w < 1 for u, v, w in at):
            return np.array([corners[a] + sides @ (u, v) for u, v, _ in at])
    raise ValueError("the spike does not enter through one facet in front")


def scene(drawing, view, corners, tets, tip):
    """Gives the tetrahedra that have the tip."""
    tets = [positive(corners, tet) for tet in tets]
    facets = [facet for tet in tets for facet in triangles_of(tet)]
    outer = [facet for facet in facets if sum(set(facet) == set(other) for other in facets) == 1]
    spike = spike_at(view, np.asarray(tip, float))
    found, through = contacts(corners, tets, spike), crossings(view, corners, outer, spike)
    inner = np.array([spike[0], *through])

    def inside():
        for tet in found if len(tets) > 1 else []:
            shown = [t for t in triangles_of(tets[tet]) if view.towards(np.cross(*(corners[list(t[1:])] - corners[t[0]]))) > 0]
            drawing.veil(drawing.union(view, corners, shown), B, .3)
            shared = [facet for facet in facets if facet not in outer][:1]
            drawing.veil(drawing.union(view, corners, shared), MARK, .22)
        drawing.solids(view, faces_of(inner, triangles_of(positive(inner, (0, 1, 2, 3))), A, .7))

    drawing.glass(view, corners, outer, B, inside)
    _, p, q, r = positive(inner, (0, 1, 2, 3))
    outside = np.array([*spike, *through])
    sides = [(i + 3, i, j, j + 3) for i, j in ((p, r), (r, q), (q, p))]
    drawing.line([*view.at(through), view.at(through)[0]], A, LINE)
    drawing.solids(view, faces_of(outside, [*sides, (p, q, r)], A, .7))
    drawing.dots(view.at([tip]), MARK, 7)
    return found


def drawn():
    drawing = Drawing(358, "What a contact is: a vertex in a tetrahedron, and a vertex on the facet that two tetrahedra share")
    left, right = View(28, 16, 160, (0, 0, 0), (180, 232)), View(-16, 18, 150, (0, 0, 0), (515, 222))
    assert scene(drawing, left, ONE, [(0, 1, 2, 3)], (.08, .1, .22)) == [0]
    found = scene(drawing, right, TWO, [(0, 2, 3, 4), (1, 2, 3, 4)], (0, 0, .15))
    assert found == [0]
    for tet, x in enumerate((415, 630)):
        drawing.label(x, 296, f"tet {tet}", bold=tet in found)
    drawing.label(180, 338, "in a tet: a contact")
    drawing.label(515, 338, "on a shared facet: the lowest tet")
    return drawing
