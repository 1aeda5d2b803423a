"""A margin finds vertices near a surface; previous positions find those that went through a body within one step."""

import numpy as np

from canvas import A, B, BOLD, LINE, MARK, THIN, Drawing, arc, edges_of, path_of

STEP, RADIUS, MARGIN = .4, 2, .5
PLATE = .13  # half of its thickness
SHAPE = np.array([(0, 0, 0), (-.5, 0, .62), (.42, 0, .74), (0, .3, .6)])  # of the body that goes through it
MOTION = np.array([.6, 0, -1.62])


def near():
    """A block above a ball: its middle layer, and the proximities of that."""
    import voxtet
    import voxtet.io
    block, ball = voxtet.io.make_box(5 * STEP, 2 * STEP, 2 * STEP, STEP), voxtet.io.make_ball(RADIUS, .14)
    turn = np.radians(-9)
    rest = block.positions - block.positions.mean(axis=0)
    turned = np.array([[np.cos(turn), 0, -np.sin(turn)], [0, 1, 0], [np.sin(turn), 0, np.cos(turn)]])
    points = rest @ turned + (.1, 0, RADIUS + .72)
    with voxtet.Grid(constraints=True, margin=MARGIN) as grid:
        body, other = grid.add(points, block.tets), grid.add(ball.positions.copy(), ball.tets)
        grid.step()
        found = {int(c.vertices[0]): c for c in grid.constraints if c.body_a == body.id and c.body_b == other.id}
    layer = set(np.flatnonzero(abs(rest[:, 1]) < STEP / 3).tolist())
    assert all(c.kind == voxtet.ConstraintKind.PROXIMITY for c in found.values())
    return points, layer, edges_of(block.tets, layer), found


def through():
    """A small body that goes through a plate: where it is before and after, and its impacts."""
    import voxtet
    import voxtet.io
    plate = voxtet.io.make_box(4, 4, 2 * PLATE, .5)
    before = SHAPE + (-.28, 0, .34)
    after = before + MOTION
    with voxtet.Grid(constraints=True) as grid:
        other = grid.add(plate.positions - plate.positions.mean(axis=0), plate.tets)
        body = grid.add(after, [[0, 1, 2, 3]])
        body.previous_positions = before
        grid.step()
        found = {int(c.vertices[0]): c for c in grid.constraints if c.body_a == body.id and c.body_b == other.id}
    assert all(c.kind == voxtet.ConstraintKind.IMPACT for c in found.values())
    return before, after, found


def drawn():
    drawing = Drawing(345, "A margin finds vertices near a surface; previous positions find vertices that went through a body")
    points, layer, edges, found = near()

    def left(p):
        return np.array([175 + 122 * p[0], 212 - 122 * (p[-1] - RADIUS)])

    surface, far = ([left(p) for p in arc(radius, 1.22)] for radius in (RADIUS, RADIUS + MARGIN))
    drawing.veil(path_of([*far, *surface[::-1]]) + "z", MARK, .12)
    drawing.fill(path_of([*surface, left((1.22, RADIUS - .52)), left((-1.22, RADIUS - .52))]) + "z", B, .16, .22)
    drawing.line(surface, B, LINE)
    for a, b in edges:
        drawing.line([left(points[a]), left(points[b])], A, THIN)
    shown = sorted(layer & set(found))
    for v in shown:
        drawing.line([left(points[v]), left(points[v] - found[v].gap * found[v].normal)], MARK, BOLD)
    drawing.dots([left(points[v]) for v in shown], "ink", 5)

    before, after, impacts = through()

    def right(p):
        return np.array([520 + 104 * p[0], 138 - 104 * p[-1]])
    top, bottom = ([right((x, z)) for x in (-1.45, 1.45)] for z in (PLATE, -PLATE))
    drawing.fill(path_of([*top, *bottom[::-1]]) + "z", B, .16, .22)
    drawing.line(top, B, LINE)
    drawing.line(bottom, B, LINE)
    drawing.line([*(right(p) for p in before[:3]), right(before[0])], A, LINE, "4 5")
    drawing.fill(path_of([right(p) for p in after[:3]]) + "z", A, .3, .3, A, LINE)
    for v in range(3):
        drawing.line([right(before[v]), right(after[v])], "axis", THIN, "3 5")
    drawing.rings([right(p) for p in before[:3]], "ink", 4)
    drawing.dots([right(p) for p in after[:3]], "ink", 5)
    drawing.dots([right(before[v] + impacts[v].time * MOTION) for v in range(3)], MARK, 6)
    drawing.label(572, 64, "before", anchor="start")
    drawing.label(620, 226, "after", anchor="start")
    for x, words, name in ((175, "near: within the margin", "PROXIMITY"), (520, "through, within one step", "IMPACT")):
        drawing.label(x, 306, words)
        drawing.label(x, 332, name, "axis", size=18)
    return drawing
