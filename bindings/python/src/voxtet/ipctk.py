"""vox as a broad phase of IPC Toolkit: `candidates.build(mesh, start, end, radius, voxtet.ipctk.BroadPhase())`. For tests and
small scenes, as each candidate is a Python object there: for large ones take voxtet.surface, or in C++ the header of
docs/ipc-broad-phase.md. Experimental, as voxtet.surface is."""

from __future__ import annotations

from itertools import product
from typing import Any, Callable, Optional

import ipctk
import numpy as np

from .surface import Surface


class BroadPhase(ipctk.BroadPhase):  # type: ignore[misc]
    """Finds what ipctk's own broad phases of doubles find. cull: without the pairs that provably stay further apart than
    twice the inflation radius; a step that is free of collisions is the same then."""

    def __init__(self, cull: bool = False) -> None:
        super().__init__()
        self._cull = cull
        self._surface: Optional[Surface] = None
        self._corners: dict[str, list[Any]] = {}

    def name(self) -> str:
        """"vox"."""
        return "vox"

    def clear(self) -> None:
        """Forgets the scene."""
        self._surface = None
        self._corners = {}

    def build(self, *arguments: Any) -> None:
        """vertices, in two or three dimensions, or those at either end of the motion; edges; faces; the inflation radius (0)."""
        *given, edges, faces, radius = arguments if np.ndim(arguments[-1]) == 0 else (*arguments, 0.0)
        super().build(given[0], edges, faces, float(radius))  # which notes the dimension
        positions = [np.pad(p, ((0, 0), (0, 3 - np.shape(p)[1]))) for p in given]
        count = len(positions[0])
        self._corners = {"vertex": [(v,) for v in range(count)], "edge": edges.tolist(), "face": faces.tolist()}
        self._surface = Surface(faces.astype(np.uint32).reshape(-1, 3), edges=edges.astype(np.uint32).reshape(-1, 2),
                                vertex_count=count)
        self._surface.move(*positions, radius=float(radius), cull=self._cull)

    def _candidates(self, kind: Callable[[int, int], Any], a: str, b: str) -> list[Any]:
        if self._surface is None or not self._corners[a] or not self._corners[b]:
            return []
        may_meet, corners_a, corners_b = self.can_vertices_collide, self._corners[a], self._corners[b]
        return [kind(i, j) for i, j in self._surface.pairs(a, b).array().tolist()
                if any(may_meet(v, w) for v, w in product(corners_a[i], corners_b[j]))]

    def detect_vertex_vertex_candidates(self) -> list[Any]:
        """Pairs of vertices."""
        return self._candidates(ipctk.VertexVertexCandidate, "vertex", "vertex")

    def detect_edge_vertex_candidates(self) -> list[Any]:
        """Pairs of an edge and a vertex."""
        return self._candidates(ipctk.EdgeVertexCandidate, "edge", "vertex")

    def detect_edge_edge_candidates(self) -> list[Any]:
        """Pairs of edges."""
        return self._candidates(ipctk.EdgeEdgeCandidate, "edge", "edge")

    def detect_face_vertex_candidates(self) -> list[Any]:
        """Pairs of a face and a vertex."""
        return self._candidates(ipctk.FaceVertexCandidate, "face", "vertex")

    def detect_edge_face_candidates(self) -> list[Any]:
        """Pairs of an edge and a face."""
        return self._candidates(ipctk.EdgeFaceCandidate, "edge", "face")

    def detect_face_face_candidates(self) -> list[Any]:
        """Pairs of faces."""
        return self._candidates(ipctk.FaceFaceCandidate, "face", "face")
