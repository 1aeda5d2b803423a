"""A surface filled in two ways, cut open: stuffed, with vertices on the surface, and with cubes, which cover it."""

import numpy as np

from canvas import A, B, LINE, MARK, Drawing, View, faces_of

CELL = .31


def opened(points, elements, level=0.0):
    """Those behind a plane."""
    return elements[points[elements].mean(axis=1)[:, 1] > level - .02]


def drawn():
    import voxtet.io
    ball = voxtet.io.make_ball(1, CELL)
    surface = voxtet.io.MeshData(ball.positions, triangles=voxtet.io.boundary(ball.tets))
    drawing = Drawing(292, "A surface, open to show that it is hollow; the same filled with tetrahedra, stuffed and as cubes")
    for x, words in ((118, "surface"), (350, "stuffed"), (576, "cubes")):
        view = View(-32, 24, 88, (0, .3, 0), (x, 126))
        if words == "surface":
            shell = opened(ball.positions, surface.triangles)
            faces = faces_of(ball.positions, shell, B, .38, B) + faces_of(ball.positions, shell[:, ::-1], "grey", .3, B)
        else:
            mesh = voxtet.io.tetrahedralize(surface, CELL, kind=words)
            across = mesh.positions[:, 1]
            level = across[abs(across).argmin()] if words == "cubes" else 0  # between two layers of cubes
            outer = {tuple(sorted(t)) for t in voxtet.io.boundary(mesh.tets).tolist()}
            faces = [(mesh.positions[t], B if tuple(sorted(t.tolist())) in outer else A, .42, B)
                     for t in voxtet.io.boundary(opened(mesh.positions, mesh.tets, level))]
        drawing.solids(view, faces)
        if words == "cubes":
            turn = np.linspace(0, 2 * np.pi, 49)
            rim = np.sqrt(1 - level ** 2) * np.array([np.cos(turn), 0 * turn, np.sin(turn)]).T + (0, level, 0)
            drawing.line(view.at(rim), MARK, LINE, "2 5")
        drawing.label(x, 274, words)
    return drawing
