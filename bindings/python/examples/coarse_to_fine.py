"""A field goes from coarse balls to a fine one: the error of linear interpolation falls with the square of the edges' length, and
what is summed up of forces stays. Needs numpy alone."""

import numpy as np
import voxtet.io


def field(x):
    return np.sin(2 * x[:, 0]) * np.cos(x[:, 1]) + x[:, 2] ** 2


fine = voxtet.io.make_ball(0.9, 0.06)                    # within the coarse ones
print("  edge  vertices  largest error   mean error  linear field")
for edge in (0.4, 0.2, 0.1, 0.05):
    coarse = voxtet.io.make_ball(1.0, edge)
    T = voxtet.Transfer(coarse, fine, "raise")
    error = abs(T @ field(coarse.positions) - field(fine.positions))
    exact = np.allclose(T @ coarse.positions, fine.positions, rtol=0, atol=1e-14)
    print(f"{edge:6.2f} {len(coarse.positions):9} {error.max():14.5f} {error.mean():12.6f}  {'exact' if exact else 'wrong'}")
forces = np.random.default_rng(1).normal(size=fine.positions.shape)
print("forces on the coarse mesh have the same sum:", np.allclose((T.T @ forces).sum(axis=0), forces.sum(axis=0), rtol=0, atol=1e-10))
