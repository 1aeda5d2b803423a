"""The dose along many rays through an organ, and the length of their way in it: each tetrahedron has an attenuation, and what is left of
a ray when it leaves the body is exp(-the sum of attenuation times chord). The organ is a ball that is bent here; any mesh of
voxtet.io.load, pyvista or meshio can be given instead. Needs numpy alone."""

import numpy as np
import voxtet.io

RAYS = 100_000

organ = voxtet.io.make_ball(1.0, 0.15)
x = organ.positions + np.stack([0.3 * organ.positions[:, 1] ** 2, np.zeros(len(organ.positions)), 0.2 * organ.positions[:, 0]], axis=1)
attenuation = 0.5 + (np.linalg.norm(x[organ.tets].mean(axis=1), axis=1) < 0.4)   # a denser core

random = np.random.default_rng(1)
source = np.array([-4.0, 0.3, 0.1])
aim = np.stack([np.full(RAYS, 3.0), *random.uniform(-1.8, 1.8, (2, RAYS))], axis=1)
offsets, tet, t_in, t_out = voxtet.tracks(np.broadcast_to(source, aim.shape), aim, x, organ.tets)
ray = np.repeat(np.arange(RAYS), np.diff(offsets))
chord = (t_out - t_in) * np.linalg.norm(aim - source, axis=1)[ray]
length = np.bincount(ray, chord, RAYS)
depth = np.bincount(ray, chord * attenuation[tet], RAYS)          # optical, along the whole ray
after = np.cumsum(chord * attenuation[tet])                       # at the end of each chord, from the first ray on
left = np.exp(-(after - np.append(0, after)[offsets[ray]]))
absorbed = np.exp(-(after - chord * attenuation[tet] - np.append(0, after)[offsets[ray]])) - left
dose = np.bincount(tet, absorbed, len(organ.tets))                # in each tetrahedron

hit = length > 0
print(f"{hit.sum()} of {RAYS} rays pass through {len(tet)} tetrahedra; mean length {length[hit].mean():.4f}, longest {length.max():.4f}")
print("each ray's loss is the sum of its doses:", np.allclose(np.bincount(ray, absorbed, RAYS), 1 - np.exp(-depth), atol=1e-9))
print(f"dose {dose.sum():.1f}, {100 * dose[attenuation > 1].sum() / dose.sum():.1f} % of it in the core")
