"""Two balls that overlap, with the points where edges meet faces, and what `voxtet.resolve` makes of them."""

import numpy as np

from canvas import A, B, MARK, Drawing, View, faces_of

CELL = .42


def drawn():
    import voxtet
    import voxtet.io
    ball = voxtet.io.make_ball(1, CELL)
    skin = voxtet.io.boundary(ball.tets)
    before = [ball.positions, ball.positions + (1.35, .15, .25)]
    done = voxtet.resolve([(p, ball.tets) for p in before], gap=.02)
    drawing = Drawing(292, "Two balls that pass through each other, and the same two moved apart")
    for x, words, bodies in ((180, "before", before), (524, "after", done.positions)):
        view = View(-12, 24, 74, np.mean(np.vstack(bodies), axis=0), (x, 126))
        drawing.solids(view, faces_of(bodies[0], skin, A, .42, A) + faces_of(bodies[1], skin, B, .42, B))
        if words == "before":
            surface = voxtet.surface.Surface(np.vstack([skin, skin + len(ball.positions)]), vertex_count=2 * len(ball.positions))
            surface.move(np.vstack(bodies))
            seen = [p for p in surface.crossings()["position"] if view.towards(p - view.centre) > 0]
            drawing.dots(view.at(seen), MARK, 3.5)
        drawing.label(x, 274, words)
    return drawing
