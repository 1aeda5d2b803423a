"""Pairs of surface features: which vertices, edges and triangles of moving surfaces can meet, cross, are close, or how far they
may move before they meet (docs/surface-pairs.md). Experimental: it may change in any release.

>>> import numpy as np
>>> square = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], float)
>>> positions = np.concatenate([square, square + [0.1, 0.1, 0.5]])
>>> faces = np.array([[0, 1, 2], [2, 1, 3], [4, 5, 6], [6, 5, 7]])
>>> surface = Surface(faces)
>>> surface.move(positions, positions * [1, 1, -1])
>>> len(surface.pairs("face", "vertex").partners) > 0
True
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Iterator
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import U32, choice, copied_rows, indices, integer, real, switch
from ._library import Handle, described, sized, vox
from .errors import InvalidArgumentError
from .suggest import CellSizeResult

FeatureName = Union[str, _c.Feature]


class FeaturePairs(NamedTuple):
    """The partners of feature i are partners[offsets[i]:offsets[i + 1]], ascending."""

    offsets: NDArray[np.uint64]
    partners: NDArray[np.uint32]

    def array(self) -> NDArray[np.uint32]:
        """All pairs, (n, 2), in order."""
        offsets = self.offsets.astype(np.int64)
        firsts = np.repeat(np.arange(len(offsets) - 1, dtype=np.uint32), offsets[1:] - offsets[:-1])
        return np.stack([firsts, self.partners], axis=1)


class SafeStep(NamedTuple):
    """Up to this part of the motion no two features touch. Below 1, the kinds and numbers of the two that touch first."""

    step: float
    pairs: int
    unfinished: int
    kind_a: _c.Feature
    kind_b: _c.Feature
    a: int
    b: int


def _copy(address: Optional[int], count: int, dtype: Any) -> NDArray[Any]:
    out = np.empty(count, dtype)
    if count:
        ctypes.memmove(out.ctypes.data, ctypes.c_void_p(address), out.nbytes)
    return out


class Surface:
    """Vertices, edges and triangles. faces: (n, 3) indices of vertices; edges: (m, 2), or None for those of the faces;
    vertex_count: None for one more than the greatest index. patches: the patch of each vertex; two vertices may meet if the
    category of the patch of each has a bit in common with the mask of the other's. One thread at a time may use it."""

    def __init__(self, faces: Optional[ArrayLike] = None, *, edges: Optional[ArrayLike] = None,
                 vertex_count: Optional[int] = None, patches: Optional[ArrayLike] = None,
                 patch_categories: Optional[ArrayLike] = None, patch_masks: Optional[ArrayLike] = None,
                 workers: int = 1, cell_size: float = 0.0, byte_budget: int = 0) -> None:
        desc = described(_c.vox_surface_desc)
        kept: list[NDArray[Any]] = []

        def pass_indices(value: Optional[ArrayLike], name: str, width: int) -> tuple[Optional[int], int]:
            if value is None:
                return None, 0
            array = indices(value, name, width)
            kept.append(array)
            return array.ctypes.data, array.size // width

        desc.faces, desc.face_count = pass_indices(faces, "faces", 3)
        desc.edges, desc.edge_count = pass_indices(edges, "edges", 2)
        if vertex_count is None:
            vertex_count = 1 + max((int(array.max()) for array in kept if array.size), default=-1)
        desc.vertex_count = integer(vertex_count, "vertex_count")
        if patches is not None:
            desc.patches, count = pass_indices(patches, "patches", 1)
            if count != vertex_count:
                raise InvalidArgumentError(f"patches has {count} numbers; it must have {vertex_count}, one for each vertex")
            desc.patch_count = 1 + int(kept[-1].max()) if count else 0
            for name, value in (("patch_categories", patch_categories), ("patch_masks", patch_masks)):
                if value is None:
                    continue
                array = np.ascontiguousarray(value, np.uint64)
                if array.shape != (desc.patch_count,):
                    raise InvalidArgumentError(f"{name} has the shape {array.shape}; it must be ({desc.patch_count},)")
                kept.append(array)
                setattr(desc, name, array.ctypes.data)
        elif patch_categories is not None or patch_masks is not None:
            raise InvalidArgumentError("patches is None, but patch_categories or patch_masks is not")
        desc.worker_count = integer(workers, "workers", high=U32)
        desc.cell_size = real(cell_size, "cell_size")
        desc.byte_budget = integer(byte_budget, "byte_budget")
        out = ctypes.c_void_p()
        vox.vox_surface_create(desc, out)
        assert out.value is not None
        self._handle = Handle(out.value, vox.vox_surface_destroy)
        self._vertex_count = vertex_count
        self._lock = threading.Lock()
        self._counts = (vertex_count, len(self.edges), len(self.faces))

    def _features(self, feature: _c.Feature) -> NDArray[np.uint32]:
        view, width = _c.vox_feature_view(), int(feature) + 1
        with self._lock:
            vox.vox_surface_get_features(self._handle.pointer, int(feature), view)
            return _copy(view.vertices, view.count * width, np.uint32).reshape(-1, width)

    @property
    def vertex_count(self) -> int:
        return self._vertex_count

    @property
    def edges(self) -> NDArray[np.uint32]:
        """(m, 2): the vertices of each edge."""
        return self._features(_c.Feature.EDGE)

    @property
    def faces(self) -> NDArray[np.uint32]:
        """(n, 3): the vertices of each face."""
        return self._features(_c.Feature.FACE)

    def move(self, start: ArrayLike, end: Optional[ArrayLike] = None, *, radius: float = 0.0, cull: bool = False) -> None:
        """Sets the motion that is asked about: every vertex moves from its position in start, (n, 3), along a straight line to that
        in end (None: everything stands still). Both are float32, or both float64. cull leaves out pairs that are proven to stay
        further apart than twice the radius."""
        motion = described(_c.vox_motion)
        first = copied_rows(start, "start")
        if end is not None:
            second = copied_rows(end, "end")
            if first.struct.format != second.struct.format:
                first, second = (copied_rows(np.ascontiguousarray(rows.array, np.float64), name)
                                 for rows, name in ((first, "start"), (second, "end")))
            motion.to = second.struct
        setattr(motion, "from", first.struct)
        motion.radius = real(radius, "radius")
        motion.flags = int(_c.MotionFlags.CULL) if switch(cull, "cull") else 0
        with self._lock:
            vox.vox_surface_move(self._handle.pointer, motion)

    def pieces(self, a: FeatureName, b: FeatureName) -> Iterator[FeaturePairs]:
        """The pairs of features whose boxes overlap, in pieces that fit into the byte budget, each for the next features of a."""
        kind_a, kind_b = choice(_c.Feature, a, "a"), choice(_c.Feature, b, "b")
        first, count = 0, self._counts[kind_a]
        while True:
            lists = _c.vox_partner_lists()
            with self._lock:
                vox.vox_surface_find_pairs(self._handle.pointer, kind_a, kind_b, first, count, lists)
                offsets = _copy(lists.offsets, lists.count + 1, np.uint64)
                piece = FeaturePairs(offsets, _copy(lists.partners, int(offsets[-1]), np.uint32))
            yield piece
            first += lists.count
            if first == count:
                return

    def pairs(self, a: FeatureName, b: FeatureName) -> FeaturePairs:
        """For each feature of kind a ("vertex", "edge", "face") the features of kind b whose boxes overlap its own. Of two of one
        kind, the lower one has the pair."""
        found = list(self.pieces(a, b))
        if len(found) == 1:
            return found[0]
        starts = np.cumsum([0] + [len(piece.partners) for piece in found[:-1]]).astype(np.uint64)
        offsets = [piece.offsets[:-1] + start for piece, start in zip(found, starts)]
        end = found[-1].offsets[-1:] + starts[-1]
        return FeaturePairs(np.concatenate([*offsets, end]), np.concatenate([piece.partners for piece in found]))

    def suggest_cell_size(self, a: FeatureName, b: FeatureName) -> CellSizeResult:
        """The cell size with the least cost for finding the pairs of kinds a and b."""
        out = sized(_c.vox_cell_size_result)
        with self._lock:
            vox.vox_surface_suggest_cell_size(self._handle.pointer, choice(_c.Feature, a, "a"), choice(_c.Feature, b, "b"), out)
        return CellSizeResult(out)

    @property
    def counters(self) -> dict[str, int]:
        """What the last search did, and what the surface holds. docs/surface-pairs.md lists the names."""
        view = _c.vox_counter_view()
        with self._lock:
            vox.vox_surface_get_counters(self._handle.pointer, view)
            return {c.name.decode(): c.value for c in (_c.vox_counter * view.count).from_address(view.data)}

    def _list(self, function: Any, view: Any, element: str, *arguments: Any) -> NDArray[Any]:
        """A copy of what it lists, as records of which numpy knows the fields."""
        with self._lock:
            function(self._handle.pointer, *arguments, view)
            return _copy(view.data, view.count, _c.dtypes[element])

    def crossings(self) -> NDArray[Any]:
        """Edges that have a point in common with a face at the end of the motion, decided exactly: records with edge, face, kind,
        edge_weights, face_weights, position. Empty: the surface does not intersect itself."""
        return self._list(vox.vox_surface_find_crossings, _c.vox_crossing_view(), "vox_crossing")

    def proximities(self, a: FeatureName, b: FeatureName, distance: float) -> NDArray[Any]:
        """Pairs at most this far apart at the end of the motion, with their closest points."""
        return self._list(vox.vox_surface_find_proximities, _c.vox_proximity_view(), "vox_proximity", choice(_c.Feature, a, "a"),
                          choice(_c.Feature, b, "b"), real(distance, "distance"))

    def clearances(self, max_distance: float) -> NDArray[np.float64]:
        """For each vertex how far it may move, at most this far, so that nothing touches what it does not touch now."""
        out = np.empty(self._vertex_count)
        with self._lock:
            vox.vox_surface_find_clearances(self._handle.pointer, real(max_distance, "max_distance"), out.ctypes.data)
        return out

    def _impact_desc(self, distance: float, slack: float, max_iterations: int) -> Any:
        desc = described(_c.vox_impact_desc)
        desc.distance, desc.slack = real(distance, "distance"), real(slack, "slack")
        desc.max_iterations = integer(max_iterations, "max_iterations", high=U32)
        return desc

    def safe_step(self, distance: float = 0.0, *, slack: float = 0.1, max_iterations: int = 10000) -> SafeStep:
        """How much of the motion is free of impacts: never more than in truth."""
        desc, out = self._impact_desc(distance, slack, max_iterations), _c.vox_safe_step()
        with self._lock:
            vox.vox_surface_find_safe_step(self._handle.pointer, desc, out)
        return SafeStep(out.step, out.pairs, out.unfinished, _c.Feature(out.kind_a), _c.Feature(out.kind_b), out.a, out.b)

    def impacts(self, a: FeatureName, b: FeatureName, distance: float = 0.0, *, slack: float = 0.1,
                max_iterations: int = 10000) -> NDArray[Any]:
        """Pairs of face and vertex, or of edges, that may meet, each with the earliest time: records with a, b, time."""
        return self._list(vox.vox_surface_find_impacts, _c.vox_impact_view(), "vox_impact", choice(_c.Feature, a, "a"),
                          choice(_c.Feature, b, "b"), self._impact_desc(distance, slack, max_iterations))
