"""How a depth is found: edges that lead out, waves from there, and the way out of every vertex. The middle layer of a block of
vertices in a ball, seen from the side."""

import numpy as np

from canvas import A, B, BOLD, LINE, MARK, THIN, Drawing, arc, edges_of, path_of

STEP, RADIUS = .36, 2
HIGH, WIDE = 4, 5  # cells of the block
PANELS = ("edges out", "SURFACE"), ("waves inward", "PROPAGATED"), ("depth and way out", "gap, normal")


def scene():
    """The vertices of the layer by row and column, the edges of the layer, and the constraint of each vertex that is inside."""
    import voxtet
    import voxtet.io
    block = voxtet.io.make_box(WIDE * STEP, 4 * STEP, HIGH * STEP, STEP)
    ball = voxtet.io.make_ball(RADIUS, .14)
    tilt = np.radians(-11)
    turn = np.array([[np.cos(tilt), 0, np.sin(tilt)], [0, 1, 0], [-np.sin(tilt), 0, np.cos(tilt)]])
    rest = block.positions - block.positions.mean(axis=0)
    points = rest @ turn.T + (-.03, 0, RADIUS - .2)
    with voxtet.Grid(constraints=True) as grid:
        body, other = grid.add(points, block.tets), grid.add(ball.positions.copy(), ball.tets)
        grid.step()
        inside = {int(c.vertices[0]): c for c in grid.constraints if c.body_a == body.id and c.body_b == other.id}
    layer = np.flatnonzero(abs(rest[:, 1]) < STEP / 3).tolist()
    return points, layer, edges_of(block.tets, set(layer)), block.tets, inside


def waves(tets, inside):
    """Of each vertex inside, how many waves it takes to reach it."""
    wave = {v: 0 for v, c in inside.items() if c.state == 0}
    while len(wave) < len(inside):
        reached = {v for tet in tets.tolist() if any(u in wave for u in tet) for v in tet if v in inside and v not in wave}
        wave |= dict.fromkeys(sorted(reached), max(wave.values()) + 1)
    return wave


def crossing(a, b):
    """Where the way from a, inside the ball, to b leaves it."""
    way = b - a
    p, q = way @ a / (way @ way), (a @ a - RADIUS ** 2) / (way @ way)
    return a + (-p + np.sqrt(p * p - q)) * way


def drawn():
    points, layer, edges, tets, inside = scene()
    wave = waves(tets, inside)
    drawing = Drawing(292, "How a depth is found: edges that lead out, waves inward from there, and the way out of each vertex")
    half, low, scale = 1.2, .84, 88
    for panel, (name, field) in enumerate(PANELS):
        def at(p, x=118 + 232 * panel):
            return np.array([x + p[0] * scale, 208 - (p[-1] - low) * scale])
        top = [at(p) for p in arc(RADIUS, half)]
        drawing.fill(path_of([*top, at((half, low)), at((-half, low))]) + "z", B, .16, .22)
        drawing.line(top, B, LINE)
        for a, b in edges:
            drawing.line([at(points[a]), at(points[b])], A, THIN)
        shown = [v for v in layer if v in inside]
        if panel == 0:
            for a, b in edges:
                if (a in inside) != (b in inside):
                    a, b = (a, b) if a in inside else (b, a)
                    drawing.line([at(points[a]), at(crossing(points[a], points[b]))], MARK, BOLD)
                    drawing.dots([at(crossing(points[a], points[b]))], MARK, 3.5)
        elif panel == 1:
            for a, b in edges:
                if a in wave and b in wave and wave[a] != wave[b]:
                    a, b = (a, b) if wave[a] < wave[b] else (b, a)
                    start, end = at(points[a]), at(points[b])
                    drawing.arrow(start, end - 7 * (end - start) / np.hypot(*(end - start)), MARK, LINE)
        else:
            for v in shown:
                drawing.line([at(points[v]), at(points[v] - inside[v].gap * inside[v].normal)], MARK, LINE + .5)
        drawing.dots([at(points[v]) for v in shown], "ink", 4.5)
        drawing.label(118 + 232 * panel, 245, name)
        drawing.label(118 + 232 * panel, 272, field, "axis", size=18)
    return drawing
