"""A skin of 100,000 vertices follows a cage of 5,000 tetrahedra that is twisted, and becomes a grid's body itself. Needs numpy alone."""

import time

import numpy as np
import voxtet.io

cage = voxtet.io.make_lattice_ball(5000, 1.0)
random = np.random.default_rng(1)
skin = random.normal(size=(100_000, 3))
skin *= 0.985 / np.linalg.norm(skin, axis=1, keepdims=True)        # just inside the cage

start = time.perf_counter()
bound = voxtet.embed(skin, cage.positions, cage.tets)
bind = time.perf_counter() - start
print(bound)
print("at rest the skin stays where it is:", np.allclose(bound.move(cage.positions), skin, rtol=0, atol=1e-13))


def twisted(x, angle):
    turn = angle * x[:, 2]
    c, s = np.cos(turn), np.sin(turn)
    return np.stack([c * x[:, 0] - s * x[:, 1], s * x[:, 0] + c * x[:, 1], x[:, 2]], axis=1)


out = np.empty_like(skin)
start = time.perf_counter()
for angle in np.linspace(0, 1, 20):
    bound.move(twisted(cage.positions, angle), out)               # once a frame
move = (time.perf_counter() - start) / 20
print(f"off the twisted sphere by {abs(out - twisted(skin, 1)).max():.3f} at most")
if __name__ == "__main__":                                        # times differ from run to run
    print(f"bound in {1000 * bind:.0f} ms, moved in {1000 * move:.1f} ms")
