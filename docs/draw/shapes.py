"""A soft block in a floor, under a finger and around a blade: what each of the three shapes finds."""

import numpy as np

from canvas import A, B, BOLD, LINE, MARK, THIN, Drawing, edges_of, path_of

STEP = .3
FINGER, TIP = .5, (-.45, 0, 1.3)  # its radius, and the centre of its round end
BLADE, DEEP = .48, .38  # where it stands, and how far down it reaches


def found():
    """The middle layer of the block, and its constraints with each shape."""
    import voxtet
    import voxtet.io
    block = voxtet.io.make_box(8 * STEP, 2 * STEP, 4 * STEP, STEP)
    rest = block.positions - block.positions.mean(axis=0)
    points = rest + (0, 0, 2 * STEP - .17)
    with voxtet.Grid(constraints=True, edges=True) as grid:
        grid.add(points, block.tets)
        floor = grid.add_shape(voxtet.HalfSpace())
        finger = grid.add_shape(voxtet.Capsule(FINGER, 1), transform=[[1, 0, 0, TIP[0]], [0, 1, 0, 0], [0, 0, 1, TIP[2] + 1]])
        corners = [(BLADE, y, z) for y, z in ((-2, DEEP), (2, DEEP), (2, 3), (-2, 3))]
        blade = grid.add_shape(voxtet.Sheet(corners, [(0, 1, 2), (0, 2, 3)]))
        grid.step()
        all_of = {shape.id: [c for c in grid.constraints if c.body_b == shape.id] for shape in (floor, finger, blade)}
    layer = set(np.flatnonzero(abs(rest[:, 1]) < STEP / 3).tolist())
    kept = [[c for c in cs if set(c.vertices[:c.count].tolist()) <= layer] for cs in all_of.values()]
    return points, layer, edges_of(block.tets, layer), kept


def drawn():
    drawing = Drawing(345, "A soft block in a floor, under a finger, around a blade, and how each pushes it")
    points, layer, edges, (of_floor, of_finger, of_blade) = found()

    def at(p):
        return np.array([350 + 180 * p[0], 272 - 180 * p[-1]])

    drawing.fill(path_of([at((-1.9, 0)), at((1.9, 0)), at((1.9, -.28)), at((-1.9, -.28))]) + "z", B, .16, .22)
    drawing.line([at((-1.9, 0)), at((1.9, 0))], B, LINE)
    for a, b in edges:
        drawing.line([at(points[a]), at(points[b])], A, THIN)
    turn = np.linspace(0, np.pi, 25)
    finger = [at((TIP[0] - FINGER * np.cos(t), TIP[2] - FINGER * np.sin(t))) for t in turn]
    finger = [at((TIP[0] - FINGER, 1.48)), *finger, at((TIP[0] + FINGER, 1.48))]
    drawing.veil(path_of(finger) + "z", B, .2)
    drawing.line(finger, B, LINE)
    drawing.line([at((BLADE, DEEP)), at((BLADE, 1.48))], B, BOLD)
    for c in (*of_floor, *of_finger):
        p = points[c.vertices[0]]
        drawing.line([at(p), at(p - c.gap * c.normal)], MARK, BOLD)
    drawing.dots([at(points[c.vertices[0]]) for c in (*of_floor, *of_finger)], "ink", 5)
    cut = [c for c in of_blade if c.count == 2]
    for c in cut:
        drawing.line([at(points[v]) for v in c.vertices[:2]], MARK, LINE)
    drawing.dots([at(c.position) for c in cut], MARK, 5)
    for x, z, words, anchor in ((-1.05, 1.28, "CAPSULE", "end"), (BLADE + .1, 1.28, "SHEET", "start"), (1.86, -.2, "HALF_SPACE", "end")):
        drawing.label(*at((x, z)), words, "axis", anchor, 18)
    return drawing
