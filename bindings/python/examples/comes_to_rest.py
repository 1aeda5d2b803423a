"""A soft box falls on a fixed one and comes to rest: springs along its edges, and for each vertex inside a force that grows with
its depth. The forces are the rows of the constraints, transposed. Needs numpy alone."""

import numpy as np
import voxtet.io

SPRINGS, CONTACTS, DAMPING, DT, STEPS = 1e3, 2e3, 5.0, 1e-3, 3000

box = voxtet.io.make_box(1, 1, 0.5, 0.25)
n = len(box.positions)
x = np.concatenate([box.positions, box.positions + [0.2, 0.1, 0.55]])   # the fixed one, and one that falls
v = np.zeros_like(x)
mass = 1.0 / n
edges = np.unique(np.sort(box.tets[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]].reshape(-1, 2), axis=1), axis=0) + n
rest = np.linalg.norm(x[edges[:, 1]] - x[edges[:, 0]], axis=1)

with voxtet.Grid(constraints=True) as grid:
    fixed, falling = grid.add(x[:n], box.tets, tag="fixed"), grid.add(x[n:], box.tets, tag="falling")   # borrowed: parts of x
    first = {fixed: 0, falling: n}
    for step in range(STEPS + 1):
        grid.step()
        c = grid.constraints
        if step % (STEPS // 3) == 0:
            print(f"{step * DT:.0f} s: height {x[n:, 2].mean():.2f}, speed {abs(v).max():.2f}, deepest {max(-c.gap, default=0):.4f}")
        force = np.zeros_like(x)
        force[:, 2] = -9.81 * mass
        along = x[edges[:, 1]] - x[edges[:, 0]]
        length = np.linalg.norm(along, axis=1)
        pull = (SPRINGS * (length - rest) / length)[:, None] * along
        np.add.at(force, edges[:, 0], pull)
        np.add.at(force, edges[:, 1], -pull)
        rows = c.rows(first, x.size)
        push = np.repeat(CONTACTS * np.maximum(-c.gap, 0), np.diff(rows.indptr))
        force += np.bincount(rows.indices, rows.data * push, x.size).reshape(-1, 3)
        v[n:] += DT * (force[n:] / mass - DAMPING * v[n:])
        x[n:] += DT * v[n:]
