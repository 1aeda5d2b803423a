"""Questions about the meshes of a grid: what is at a point, in a box, closest to a point or along a ray."""

from __future__ import annotations

import ctypes
import math
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import U32, U64, integer, points, real, vector
from ._library import Handle, described, vox
from .errors import InvalidStateError
from .results import Records, record_type

if TYPE_CHECKING:
    from .grid import Grid
    from .mesh import Mesh

ALL = U64  # every category


class PointHits(Records):
    """Tetrahedra that contain a point, sorted by (point, mesh, tet). `point` is the point's index."""

    point: NDArray[np.uint32]
    mesh: NDArray[np.uint32]
    tet: NDArray[np.uint32]
    barycentric: NDArray[np.float32]


class TetHits(Records):
    """Tetrahedra, sorted by (mesh, tet)."""

    mesh: NDArray[np.uint32]
    tet: NDArray[np.uint32]


class ClosestHits(Records):
    """The closest point of a surface for each point. `mesh` is 0 where there is none within the distance; `distance` is
    negative inside of that mesh; `inside` is how many meshes contain the point."""

    mesh: NDArray[np.uint32]
    tet: NDArray[np.uint32]
    facet: NDArray[np.uint32]
    inside: NDArray[np.uint32]
    barycentric: NDArray[np.float64]
    position: NDArray[np.float64]
    normal: NDArray[np.float64]
    distance: NDArray[np.float64]


class FacetHits(Records):
    """Facets of surfaces along a segment, sorted by (t, mesh, tet, facet). `side` is a Side."""

    mesh: NDArray[np.uint32]
    tet: NDArray[np.uint32]
    facet: NDArray[np.uint32]
    side: NDArray[np.int32]
    t: NDArray[np.float64]
    barycentric: NDArray[np.float64]


_POINT_HIT = record_type("vox_point_hit")
_TET_HIT = record_type("vox_tet_hit")
_SURFACE_HIT = record_type("vox_surface_hit")
_CLOSEST_HIT = record_type("vox_closest_hit")
_RAY_HIT = record_type("vox_ray_hit")
_FACET_HIT = record_type("vox_facet_hit")


class Questions(NamedTuple):
    """The library's functions, for grids or for views."""

    point: Any
    points: Any
    box: Any
    closest_points: Any
    ray: Any
    ray_hits: Any
    ray_any: Any


OF_GRIDS = Questions(vox.vox_grid_query_point, vox.vox_grid_query_points, vox.vox_grid_query_box,
                     vox.vox_grid_query_closest_points, vox.vox_grid_query_ray, vox.vox_grid_query_ray_hits,
                     vox.vox_grid_query_ray_any)
OF_VIEWS = Questions(vox.vox_query_view_point, vox.vox_query_view_points, vox.vox_query_view_box,
                     vox.vox_query_view_closest_points, vox.vox_query_view_ray, vox.vox_query_view_ray_hits,
                     vox.vox_query_view_ray_any)


def hits_of(call: Callable[[int, int, Any], Any], records: Any, dtype: np.dtype[Any], guess: int) -> Any:
    """What a function finds that writes as many hits as there is room for, and says how many there are."""
    count = ctypes.c_uint64()
    while True:
        hits = np.empty(guess, dtype)
        call(hits.ctypes.data, guess, count)
        if count.value <= guess:
            found = hits[:count.value]
            return (found if 2 * count.value >= guess else found.copy()).view(records)
        guess = count.value


class Queries:
    """The questions, of a grid as it was at the last `prepare_queries`, or of a QueryView. `mask`: only meshes whose
    filter's category has a bit in common. `excluded`: a mesh that takes no part."""

    _questions: Questions
    _pointer: Optional[int]
    _lock: Any

    def _excluded(self, mesh: Union[Mesh, int, None]) -> int:
        raise NotImplementedError

    def query_points(self, points_: ArrayLike, mask: int = ALL) -> PointHits:
        """All tetrahedra that contain each of the points, (n, 3) or one point (3,); exact. The hits of point i have
        `point == i`. A point in the interior of no tetrahedron but on the boundary of some is in the lowest of them."""
        mask = integer(mask, "mask")
        if np.shape(points_) == (3,):
            one, call = vector(points_, "points"), self._questions.point
            with self._lock:
                return hits_of(lambda hits, room, count: call(self._pointer, one, mask, hits, room, count),  # type: ignore
                               PointHits, _POINT_HIT, 8)
        many, call = points(points_), self._questions.points
        of = many.struct
        with self._lock:
            return hits_of(lambda hits, room, count: call(  # type: ignore[no-any-return]
                self._pointer, of.data, of.format, of.byte_stride, of.count, mask, hits, room, count),
                PointHits, _POINT_HIT, many.length + 8)

    def query_box(self, low: ArrayLike, high: ArrayLike, mask: int = ALL) -> TetHits:
        """All tetrahedra whose bounding box meets the box from `low` to `high`; exact. Corners may be infinite."""
        low_, high_, mask = vector(low, "low"), vector(high, "high"), integer(mask, "mask")
        call = self._questions.box
        with self._lock:
            return hits_of(lambda hits, room, count: call(  # type: ignore[no-any-return]
                self._pointer, low_, high_, mask, hits, room, count), TetHits, _TET_HIT, 64)

    def query_closest(self, points_: ArrayLike, max_distance: float = math.inf, mask: int = ALL,
                      excluded: Union[Mesh, int, None] = None) -> ClosestHits:
        """The closest point on the surfaces of the meshes for each of the points, (n, 3) or one point (3,)."""
        many = points(np.reshape(points_, (1, 3)) if np.shape(points_) == (3,) else points_)
        desc = described(_c.vox_closest_desc)
        desc.points, desc.format, desc.point_count = many.struct.data, many.struct.format, many.length
        desc.byte_stride, desc.component_byte_stride = many.struct.byte_stride, many.struct.component_byte_stride
        desc.mask, desc.max_distance = integer(mask, "mask"), real(max_distance, "max_distance")
        hits = np.empty(many.length, _CLOSEST_HIT)
        with self._lock:
            desc.excluded = self._excluded(excluded)
            self._questions.closest_points(self._pointer, desc, hits.ctypes.data)
        return hits.view(ClosestHits)

    def query_ray(self, start: ArrayLike, end: ArrayLike, mask: int = ALL) -> np.record:
        """The first tetrahedron and the first facet of a surface on the segment, with `t` from 0 to 1. `mesh` and
        `surface_mesh` are 0 where there is none."""
        start_, end_, mask = vector(start, "start"), vector(end, "end"), integer(mask, "mask")
        hits = np.empty(1, _RAY_HIT)
        out = _c.vox_ray_hit.from_buffer(hits.view(np.uint8).data)
        with self._lock:
            self._questions.ray(self._pointer, start_, end_, mask, out)
        return hits[0]  # type: ignore[no-any-return]

    def query_ray_hits(self, start: ArrayLike, end: ArrayLike, mask: int = ALL,
                       excluded: Union[Mesh, int, None] = None) -> FacetHits:
        """All facets of surfaces on the segment."""
        start_, end_, mask = vector(start, "start"), vector(end, "end"), integer(mask, "mask")
        call = self._questions.ray_hits
        with self._lock:
            without = self._excluded(excluded)
            return hits_of(lambda hits, room, count: call(  # type: ignore[no-any-return]
                self._pointer, start_, end_, mask, without, hits, room, count), FacetHits, _FACET_HIT, 16)

    def query_ray_any(self, start: ArrayLike, end: ArrayLike, mask: int = ALL,
                      excluded: Union[Mesh, int, None] = None) -> bool:
        """Whether the segment hits any tetrahedron; exact, and faster than `query_ray`."""
        start_, end_, mask = vector(start, "start"), vector(end, "end"), integer(mask, "mask")
        any_ = ctypes.c_uint32()
        with self._lock:
            self._questions.ray_any(self._pointer, start_, end_, mask, self._excluded(excluded), any_)
        return bool(any_.value)


class _Held:
    """Keeps a view's memory while a question runs, also if another thread closes the view meanwhile."""

    def __init__(self, handle: Handle) -> None:
        self._handle = handle

    def __enter__(self) -> None:
        pass

    def __exit__(self, *_: object) -> None:
        pass


class QueryView(Queries):
    """The meshes of a grid at one moment, from `Grid.query_view`. It never changes, any number of threads may ask it at
    once, also while the grid steps, and it outlives the grid."""

    _questions = OF_VIEWS

    def __init__(self, handle: Handle) -> None:
        self._handle: Optional[Handle] = handle

    def _open(self) -> Handle:
        handle = self._handle
        if handle is None:
            raise InvalidStateError("the query view is closed")
        return handle

    @property
    def _lock(self) -> _Held:
        return _Held(self._open())

    @property
    def _pointer(self) -> int:  # type: ignore[override]
        return self._open().pointer

    def _excluded(self, mesh: Union[Mesh, int, None]) -> int:
        return 0 if mesh is None else integer(mesh, "excluded", 0, U32)

    @property
    def epoch(self) -> int:
        """`Grid.epoch` when the view was taken."""
        epoch = ctypes.c_uint64()
        with self._lock:
            vox.vox_query_view_epoch(self._pointer, epoch)
        return epoch.value

    def user_data(self, mesh: Union[Mesh, int]) -> int:
        """The user_data that a mesh of the view was added with."""
        number = ctypes.c_uint64()
        with self._lock:
            vox.vox_query_view_user_data(self._pointer, integer(mesh, "mesh", 0, U32), number)
        return number.value

    def close(self) -> None:
        """Ends the view. A question that another thread asks just then is answered or raises InvalidStateError. Twice does
        nothing."""
        self._handle = None

    def __enter__(self) -> QueryView:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
