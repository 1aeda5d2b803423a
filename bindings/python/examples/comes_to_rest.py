"""A soft box falls on a floor and comes to rest: springs along its edges, and for each vertex inside a force that grows with
its depth. The forces are the rows of the constraints, transposed. Needs numpy alone."""

import numpy as np
import voxtet.io

SPRINGS, CONTACTS, DAMPING, DT, STEPS = 1e3, 2e3, 5.0, 1e-3, 3000

box = voxtet.io.make_box(1, 1, 0.5, 0.25)
x = box.positions + [0, 0, 0.3]              # its bottom 0.05 above the floor
v = np.zeros_like(x)
mass = 1.0 / len(x)
edges = np.unique(np.sort(box.tets[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]].reshape(-1, 2), axis=1), axis=0)
rest = np.linalg.norm(x[edges[:, 1]] - x[edges[:, 0]], axis=1)

with voxtet.Grid(constraints=True) as grid:
    falling = grid.add(x, box.tets)          # borrowed
    grid.add_shape(voxtet.HalfSpace())       # all z <= 0
    for step in range(STEPS + 1):
        grid.step()
        c = grid.constraints
        if step % (STEPS // 3) == 0:
            print(f"{step * DT:.0f} s: height {x[:, 2].mean():.2f}, speed {abs(v).max():.2f}, deepest {max(-c.gap, default=0):.4f}")
        force = np.zeros_like(x)
        force[:, 2] = -9.81 * mass
        along = x[edges[:, 1]] - x[edges[:, 0]]
        length = np.linalg.norm(along, axis=1)
        pull = (SPRINGS * (length - rest) / length)[:, None] * along
        np.add.at(force, edges[:, 0], pull)
        np.add.at(force, edges[:, 1], -pull)
        rows = c.rows({falling: 0}, x.size)
        push = np.repeat(CONTACTS * np.maximum(-c.gap, 0), np.diff(rows.indptr))
        force += np.bincount(rows.indices, rows.data * push, x.size).reshape(-1, 3)
        v += DT * (force / mass - DAMPING * v)
        x += DT * v
