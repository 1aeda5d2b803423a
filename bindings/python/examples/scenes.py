"""Scenes that the examples here send to other processes: two balls each, ever closer. A grid is pickled as its snapshot."""

import voxtet
import voxtet.io


def make(count):
    ball = voxtet.io.make_ball(1.0, 0.25)
    grids = []
    for i in range(count):
        grids.append(voxtet.Grid())
        grids[-1].add(ball.positions, ball.tets, copy=True)
        grids[-1].add(ball.positions + [1.9 - 0.1 * i, 0.03, 0.01], ball.tets, copy=True)
    return grids


def step(grid):
    """Runs in the other process: what it finds there, as numbers and arrays, which are small beside the grid."""
    grid.step()
    return grid.hash, abs(grid.find_constraints().gap.min(initial=0))


def show(results):
    for hash, depth in results:
        print(f"{hash:016x} {depth:.6f}")
