#!/usr/bin/env python3
"""voxtet.ipctk.BroadPhase inside ipctk.Candidates.build, on a scene of Sample-Scalable-CCD-Data: its candidates are those of
ipctk.SweepAndPrune, and the step that is free of collisions is the same with and without culling. Small scenes are a test
(bindings/python/tests/test_simulators.py).

usage: ipc_python.py FOLDER
VOXTET_LIBRARY_DIR names the folder of libvox, PYTHONPATH that of voxtet."""

import glob
import sys

import ipctk
import numpy as np

import pairs
from voxtet.ipctk import BroadPhase


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    (start, faces), (end, _) = (pairs.read_ply(path) for path in sorted(glob.glob(sys.argv[1] + "/frames/*.ply")))
    start, end = np.asfortranarray(start), np.asfortranarray(end)
    edges = pairs.edges_of(faces)
    mesh = ipctk.CollisionMesh(start, np.asfortranarray(edges.astype(np.int32)),
                               np.asfortranarray(faces.astype(np.int32)))
    radius = 1e-4 * float(np.linalg.norm(start.max(0) - start.min(0)))
    found, steps = [], []
    for phase in (ipctk.SweepAndPrune(), BroadPhase(), BroadPhase(cull=True)):
        candidates = ipctk.Candidates()
        candidates.build(mesh, start, end, radius, phase)
        found.append({(kind, *c) for kind, cs in (
            ("ee", [tuple(sorted((c.edge0_id, c.edge1_id))) for c in candidates.ee_candidates]),
            ("fv", [(c.face_id, c.vertex_id) for c in candidates.fv_candidates])) for c in cs})
        steps.append(candidates.compute_collision_free_stepsize(mesh, start, end))
        print(f"{phase.name():>16}: {len(candidates)} candidates, a step of {steps[-1]:.17g}")
    if found[0] != found[1] or not found[2] <= found[1] or len(set(steps)) > 1:
        sys.exit("they differ")


if __name__ == "__main__":
    main()
