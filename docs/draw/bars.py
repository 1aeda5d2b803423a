"""Two bars that cross touch by their edges alone: where an edge of one meets faces of the other, and which way is out."""

import numpy as np

from canvas import A, B, BOLD, LINE, MARK, Drawing, View

LOW, HIGH = ((-2.1, -.5, -.5), (2.1, .5, .5)), ((-.5, -2.1, .03), (.5, 2.1, 1.03))  # corners of either bar
FACES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def box(low, high):
    return np.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)], float)


def constraints():
    """Of the upper bar's edges, which a step finds in the lower bar."""
    import voxtet
    import voxtet.io
    with voxtet.Grid(edges=True, constraints=True) as grid:
        ids = []
        for low, high in (LOW, HIGH):
            size = np.subtract(high, low)
            mesh = voxtet.io.make_box(*size, 5.0)  # a cell as long as the bar
            points = mesh.positions - mesh.positions.min(axis=0) + low
            ids.append(grid.add(points, mesh.tets).id)
        grid.step()
        return [c for c in grid.constraints if c.body_a == ids[1] and c.body_b == ids[0]]


def faces(low, high, colour):
    corners = box(low, high)
    return [(corners[list(face)], colour, .5, "") for face in FACES]


def drawn():
    drawing = Drawing(420, "Two crossing bars: where an edge of one meets faces of the other, and the way out")
    view = View(-52, 26, 108, (0, 0, .2), (350, 185))
    (x0, y0, z0), (x1, y1, z1) = HIGH
    (low_x, front, low_z), (high_x, back, top) = LOW

    def edges(colour, *lines, width=LINE, dash=""):
        for line in lines:
            drawing.line(view.at(line), colour, width, dash)

    # The bars pass through each other, so the upper one is drawn in parts: behind the lower one, above it, in front of it.
    drawing.solids(view, faces((x0, back, z0), (x1, y1, z1), A))
    edges(A, [(x0, back, z0), (x0, y1, z0), (x0, y1, z1)])
    drawing.solids(view, faces(*LOW, B))
    edges(B, [(low_x, back, top), (low_x, front, top), (high_x, front, top), (high_x, back, top), (low_x, back, top)],
          [(low_x, back, top), (low_x, back, low_z), (low_x, front, low_z), (high_x, front, low_z), (high_x, front, top)],
          [(low_x, front, low_z), (low_x, front, top)])
    drawing.solids(view, faces((x0, front, top), (x1, back + .006, z1), A))
    drawing.solids(view, faces((x0, y0, z0), (x1, front + .006, z1), A))
    edges(A, [(x0, y1, z1), (x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
          [(x0, y0, z1), (x0, y0, z0), (x1, y0, z0), (x1, y0, z1)],
          [(x0, y0, z0), (x0, front, z0)], [(x0, front, z0), (x0, front, top), (x0, back, top)])
    # What the step found of the edge at the left.
    ends = sorted((c for c in constraints() if np.allclose(c.position[[0, 2]], (x0, z0))), key=lambda c: c.position[1])
    assert np.allclose([c.position[1] for c in ends], (front, back))
    edges(MARK, [c.position for c in ends], width=BOLD, dash="2 6")
    middle = np.mean([c.position for c in ends], axis=0)
    drawing.arrow(*view.at([middle, middle - ends[0].gap * ends[0].normal]), MARK)
    drawing.rings(view.at([ends[1].position]), MARK, 6, 3)
    drawing.dots(view.at([ends[0].position]), MARK, 7)
    y = 398
    drawing.dots([(62, y - 7)], MARK, 7)
    drawing.label(80, y, "edge meets face", anchor="start")
    drawing.line([(302, y - 7), (342, y - 7)], MARK, BOLD, "2 6")
    drawing.label(354, y, "part inside", anchor="start")
    drawing.arrow((532, y + 4), (532, y - 22), MARK)
    drawing.label(550, y, "way out", anchor="start")
    return drawing
