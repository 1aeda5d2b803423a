"""When the pair of two bodies began, persists and ended: a ball passes over another, and the state of their pair at each step."""

import numpy as np

from canvas import A, B, LINE, MARK, Drawing, circle, number

RADIUS, HEIGHT = .5, .5  # of either ball; of the moving one's middle over the other's
PLACES = (-1.2, -.66, -.1, .5, 1.1)  # of the moving ball, step by step


def states():
    """The name of the pair's state at each step, or none."""
    import voxtet
    import voxtet.io
    ball = voxtet.io.make_ball(RADIUS, .12)
    moving, found = ball.positions.copy(), []
    with voxtet.Grid() as grid:
        grid.add(ball.positions, ball.tets)
        grid.add(moving, ball.tets)
        for place in PLACES:
            moving[:] = ball.positions + (place, 0, HEIGHT)
            grid.step()
            found.append(next((voxtet.PairState(p.state).name for p in grid.pairs), ""))
    return found


def drawn():
    drawing = Drawing(262, "The states of a pair of bodies: began, persisted as long as they touch, and ended")
    wide, scale, line = 136, 56, 160
    radius = scale * RADIUS
    names = states()
    assert names == ["", "BEGAN", "PERSISTED", "PERSISTED", "ENDED"]
    middles = [78 + wide * i for i in range(len(names))]
    for x, place, name in zip(middles, PLACES, names):
        still, other = np.array([x - .5 * scale * place, 88]), np.array([x + .5 * scale * place, 88 - scale * HEIGHT])
        for (cx, cy), colour in ((still, B), (other, A)):
            drawing.fill(circle(cx, cy, radius), colour, .3, .38, colour, LINE)
        way = other - still
        apart = np.hypot(*way)
        if apart < 2 * radius:
            half = np.sqrt(radius ** 2 - (apart / 2) ** 2) * np.array([-way[1], way[0]]) / apart
            (ax, ay), (bx, by) = still + way / 2 - half, still + way / 2 + half
            arc = f"A{number(radius)} {number(radius)} 0 0 0 "
            first, second = f"{number(ax)} {number(ay)}", f"{number(bx)} {number(by)}"
            drawing.add(f'<path class="f {MARK}" d="M{first}{arc}{second}{arc}{first}z"/>')
        assert (apart < 2 * radius) == (name in ("BEGAN", "PERSISTED"))
        drawing.label(x, line + 38, name, MARK if name else "ink", size=18, bold=True)
    drawing.arrow((24, line), (676, line), "axis", LINE)
    drawing.line([(middles[1], line), (middles[4], line)], MARK, 8)
    drawing.rings([(middles[0], line), (middles[4], line)], "axis", 6, LINE)
    drawing.dots([(x, line) for x in middles[1:4]], MARK, 7)
    drawing.label(middles[2] + wide / 2, line + 76, "touching")
    drawing.label(middles[4], line + 76, "no more")
    drawing.label(middles[0], line + 76, "apart")
    return drawing
