#!/usr/bin/env python3
"""vox as a broad phase of IPC Toolkit in Python (ipctk), inside ipctk.Candidates.build: its candidates are those of
ipctk.SweepAndPrune, and the step that is free of collisions is the same with and without culling. For tests and small scenes:
each candidate is a Python object.

usage: ipc_python.py [FOLDER]   FOLDER: a scene of Sample-Scalable-CCD-Data; without it, two crumpled sheets
VOXTET_LIBRARY_DIR names the folder of libvox, PYTHONPATH that of voxtet."""

import glob
import sys

import ipctk
import numpy as np

import pairs
from voxtet.surface import Surface


class VoxBroadPhase(ipctk.BroadPhase):
    def __init__(self, cull=False):
        super().__init__()
        self.cull = cull

    def name(self):
        return "vox"

    def clear(self):
        self.surface = None

    def build(self, *arguments):
        *positions, edges, faces, radius = arguments
        self.surface = Surface(faces.astype(np.uint32), edges=edges.astype(np.uint32), vertex_count=len(positions[0]))
        self.surface.move(*positions, radius=radius, cull=self.cull)

    def detect_edge_edge_candidates(self):
        return [ipctk.EdgeEdgeCandidate(a, b) for a, b in self.surface.pairs("edge", "edge").array()]

    def detect_face_vertex_candidates(self):
        return [ipctk.FaceVertexCandidate(a, b) for a, b in self.surface.pairs("face", "vertex").array()]


def sheets(side=24):
    random = np.random.default_rng(1)
    i, j = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    flat = np.stack([i, j, np.zeros_like(i)], axis=-1).reshape(-1, 3) + 0.3 * random.random((side * side, 3))
    start = np.concatenate([flat, flat + [0.4, 0.3, 1]])
    corner = np.arange(side * side).reshape(side, side)
    quads = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[:-1, 1:], corner[1:, 1:]], axis=-1).reshape(-1, 4)
    faces = np.concatenate([quads[:, :3], quads[:, [2, 1, 3]]])
    end = start.copy()
    end[side * side:, 2] -= 1.5
    return start, end, np.concatenate([faces, faces + side * side]).astype(np.uint32)


def main():
    if len(sys.argv) > 1:
        (start, faces), (end, _) = (pairs.read_ply(path) for path in sorted(glob.glob(sys.argv[1] + "/frames/*.ply")))
    else:
        start, end, faces = sheets()
    start, end = np.asfortranarray(start), np.asfortranarray(end)
    edges = pairs.edges_of(faces)
    mesh = ipctk.CollisionMesh(start, np.asfortranarray(edges.astype(np.int32)),
                               np.asfortranarray(faces.astype(np.int32)))
    radius = 1e-4 * float(np.linalg.norm(start.max(0) - start.min(0)))
    found, steps = [], []
    for phase in (ipctk.SweepAndPrune(), VoxBroadPhase(), VoxBroadPhase(cull=True)):
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
