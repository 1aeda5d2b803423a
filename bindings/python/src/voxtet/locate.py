"""Which tetrahedra are at a point, in a box, on a line, and where is the closest surface? Many questions at once, exact."""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._c import LocationState
from ._arguments import U32, Rows, indices, integer, points as points_of, real, switch
from ._interop import arrays_of
from ._library import Handle, described, vox
from .cells import Cells
from .errors import InvalidArgumentError, InvalidStateError
from .grid import Grid
from .mesh import Mesh
from .results import Records, hits_of, record_type


class PointHits(Records):
    """Tetrahedra that contain a point, sorted by (point, body, tet). `point` is the point's index."""

    point: NDArray[np.uint32]
    body: NDArray[np.uint32]
    tet: NDArray[np.uint32]
    weights: NDArray[np.float64]


class ClosestHits(Records):
    """The closest point of a surface for each point. `body` is 0 where there is none within the distance; `distance` is
    negative inside of that body; `inside` is how many bodies contain the point; `face` are the vertices of the facet."""

    body: NDArray[np.uint32]
    tet: NDArray[np.uint32]
    facet: NDArray[np.uint32]
    inside: NDArray[np.uint32]
    face: NDArray[np.uint32]
    weights: NDArray[np.float64]
    position: NDArray[np.float64]
    normal: NDArray[np.float64]
    distance: NDArray[np.float64]


class BoxHits(Records):
    """Tetrahedra whose bounding box meets a box, sorted by (box, body, tet). `box` is the box's index."""

    box: NDArray[np.uint32]
    body: NDArray[np.uint32]
    tet: NDArray[np.uint32]


class RayHits(Records):
    """Facets of surfaces that rays meet, sorted by (ray, t, body, tet, facet). `ray` is the ray's index, `side` a Side, `face`
    the vertices of the facet."""

    ray: NDArray[np.uint32]
    body: NDArray[np.uint32]
    tet: NDArray[np.uint32]
    facet: NDArray[np.uint32]
    side: NDArray[np.int32]
    face: NDArray[np.uint32]
    t: NDArray[np.float64]
    weights: NDArray[np.float64]


class TrackPieces(Records):
    """The parts of segments that lie in one tetrahedron each, sorted by (segment, body, t_in). `facet_in` and `facet_out` are
    those through which the segment enters and leaves, NONE where it begins or ends inside or runs along a facet."""

    segment: NDArray[np.uint32]
    body: NDArray[np.uint32]
    tet: NDArray[np.uint32]
    facet_in: NDArray[np.uint32]
    facet_out: NDArray[np.uint32]
    t_in: NDArray[np.float64]
    t_out: NDArray[np.float64]


class TriangleHits(Records):
    """Tetrahedra that triangles meet, sorted by (triangle, body, t, tet). Bit k of `edges` is set if the triangle meets edge k,
    first at `s[:, k]`, from 0 at the end with the lower vertex index to 1. Edges are corners 01, 02, 03, 12, 13, 23."""

    triangle: NDArray[np.uint32]
    body: NDArray[np.uint32]
    tet: NDArray[np.uint32]
    edges: NDArray[np.uint32]
    t: NDArray[np.float64]
    s: NDArray[np.float64]


class Tracks(NamedTuple):
    """What segments pass through. Segment i has the entries from offsets[i] to offsets[i + 1]: the tetrahedron, or the caller's
    cell, and where the segment enters and leaves it, from 0 at its start to 1 at its end."""

    offsets: NDArray[np.int64]
    tet: NDArray[np.int64]
    t_in: NDArray[np.float64]
    t_out: NDArray[np.float64]


class _Found(NamedTuple):
    tet: NDArray[np.int64]
    weights: NDArray[np.float64]
    body: NDArray[np.uint32]


class Located(_Found):
    """For each point: the tetrahedron it is in, -1 if in none; the weights of its corners, 0 if in none; the id of the body,
    0 if in none. `tet, weights, body = located` takes these apart. Of several tetrahedra it is one of the lowest body: the
    lowest that has the point inside or, if there is none, on its boundary.

    With `outside="nearest"` or "extrapolate", `tet`, `weights` and `body` of a point outside are those of the tetrahedron
    that has the closest point, and `state` tells: a LocationState, INSIDE, OUTSIDE, or NONE without an answer. `distance` is
    that to the closest point, 0 inside.

    `cell` is the tetrahedron, or the cell of a mesh of pyvista or meshio that it is a part of, counted through all blocks of
    meshio; -1 if there is no answer. `reference`, (n, 3), are reference coordinates there as VTK has them: (r, s, t), with
    the weights 1 - r - s - t, r, s, t in a tetrahedron."""

    state: NDArray[np.int32]
    distance: NDArray[np.float64]
    cell: NDArray[np.int64]
    reference: NDArray[np.float64]


_POINT_HIT = record_type("vox_point_hit")
_CLOSEST_HIT = record_type("vox_closest_hit")
_BOX_HIT = record_type("vox_box_hit")
_RAY_HIT = record_type("vox_ray_hit")
_LOCATION = record_type("vox_location")
_TRACK_PIECE = record_type("vox_track_piece")
_TRIANGLE_HIT = record_type("vox_triangle_hit")
_OUTSIDE = ("none", "nearest", "extrapolate")
_AT_ONCE = 1 << 16  # points whose answers stay in the cache until they are taken apart
_Body = Union[Mesh, int, None]


def _batch(value: ArrayLike, name: str) -> Rows:
    """Positions, (n, 3), or one, (3,)."""
    return points_of(np.reshape(value, (1, 3)) if np.shape(value) == (3,) else value, name)


def _desc(mask: int, excluded: _Body) -> Any:
    desc = described(_c.vox_query_desc)
    desc.mask = integer(mask, "mask")
    desc.excluded = 0 if excluded is None else integer(excluded, "excluded", 0, U32)
    return desc


class Locator:
    """The meshes of a grid as they were at one moment, or a mesh alone, to be asked again and again, in batches. Any number of
    threads may ask, also while the grid steps or is closed.

    `where`: a grid; positions, with `tets`; a mesh of a grid, of pyvista, meshio or voxtet.io. For a mesh with other cells
    beside its tetrahedra, `tet` is the index of the cell. Hexahedra, voxels, wedges and pyramids are split into tetrahedra for
    it, and tetrahedra of ten nodes, which may be curved, are taken by their corners first.

    In all questions: positions are (n, 3), or one (3,). `mask`: only bodies whose filter's category has a bit in common; 0:
    all. `excluded`: a body that takes no part.

    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> locator = Locator(corners, [[0, 1, 2, 3]])
    >>> locator.locate([[.1, .1, .1], [2, 0, 0]]).tet.tolist()
    [0, -1]
    >>> locator.find_closest([-1, .25, .25]).distance.tolist()
    [1.0]
    """

    _whole: Optional[tuple[int, NDArray[np.uint32], Optional[Cells]]]  # of one mesh: vertex count, tets, cells

    def __init__(self, where: Any, tets: Optional[ArrayLike] = None) -> None:
        if isinstance(where, Grid) and tets is None:
            self.update(where)
            return
        positions, found, numbers, cells = arrays_of(where, tets)
        with Grid() as grid:
            grid.add(positions, found, copy=True)
            self._take(grid, numbers)
        self._whole = len(positions), np.array(indices(found, "tets", 4)), cells

    def update(self, grid: Grid) -> None:
        """From now on, the answers are about the grid as it is now. Other threads may ask meanwhile."""
        if not isinstance(grid, Grid):
            raise TypeError(f"grid is of type {type(grid).__name__}; it must be a voxtet.Grid")
        self._take(grid, None)

    def _take(self, grid: Grid, cells: Optional[NDArray[Any]]) -> None:
        pointer = ctypes.c_void_p()
        with grid._lock:
            vox.vox_grid_update_locator(grid._pointer, pointer)
        self._whole = None
        self._taken: Optional[tuple[Handle, Optional[NDArray[Any]]]] = (
            Handle(pointer.value or 0, vox.vox_locator_release), cells)

    def _open(self) -> tuple[Handle, Optional[NDArray[Any]]]:
        """Whoever asks keeps it until the answer is there."""
        taken = self._taken
        if taken is None:
            raise InvalidStateError("the locator is closed")
        return taken

    def _find(self, call: Any, records: Any, dtype: Any, desc: Any, guess: int, *where: Rows) -> Any:
        handle, cells = self._open()
        structs = [rows.struct for rows in where]
        hits = hits_of(lambda to, room, count: call(handle.pointer, *structs, desc, to, room, count), records, dtype, guess)
        if cells is not None:
            hits["tet"] = cells[hits.tet]
        return hits

    def find_point_hits(self, points: ArrayLike, *, mask: int = 0, excluded: _Body = None) -> PointHits:
        """All tetrahedra that contain each of the points; exact. The hits of point i have `point == i`. A point in the
        interior of no tetrahedron of a body but on the boundary of some is in the lowest of them."""
        at = _batch(points, "points")
        return self._find(vox.vox_locator_find_point_hits, PointHits, _POINT_HIT,  # type: ignore[no-any-return]
                          _desc(mask, excluded), at.length + 8, at)

    def find_closest(self, points: ArrayLike, *, max_distance: float = 0.0, mask: int = 0,
                     excluded: _Body = None) -> ClosestHits:
        """The closest point on the surfaces of the bodies for each of the points; max_distance 0: at any distance."""
        at, desc = _batch(points, "points"), _desc(mask, excluded)
        desc.max_distance = real(max_distance, "max_distance")
        return self._closest(lambda locator, hits: vox.vox_locator_find_closest(locator, at.struct, desc, hits), at.length)

    def _closest(self, call: Any, count: int) -> ClosestHits:
        handle, cells = self._open()
        hits = np.empty(count, _CLOSEST_HIT).view(ClosestHits)
        call(handle.pointer, hits.ctypes.data)
        if cells is not None:
            found = hits.body > 0
            hits.tet[found] = cells[hits.tet[found]]
        return hits

    def find_closest_to_segments(self, start: ArrayLike, end: ArrayLike, *, max_distance: float = 0.0, mask: int = 0,
                                 excluded: _Body = None) -> ClosestHits:
        """The closest point on the surfaces of the bodies for each of the segments, e.g. the axes of capsules. The distance is 0
        where a segment meets the surface, which is exact; `inside` and its sign are those of start[i]."""
        start_, end_, desc = _batch(start, "start"), _batch(end, "end"), _desc(mask, excluded)
        desc.max_distance = real(max_distance, "max_distance")
        return self._closest(lambda locator, hits: vox.vox_locator_find_closest_to_segments(
            locator, start_.struct, end_.struct, desc, hits), start_.length)

    def find_triangle_hits(self, start: ArrayLike, end: Optional[ArrayLike] = None, *, mask: int = 0,
                           excluded: _Body = None) -> TriangleHits:
        """The tetrahedra that triangles meet, exact, and their edges that these cut. Each three rows are the corners of a
        triangle. With `end`, each corner moves there, on a line, and `t` says when the triangle first meets the
        tetrahedron."""
        start_, desc = _batch(np.reshape(start, (-1, 3)), "start"), _desc(mask, excluded)
        if end is not None:
            return self._find(vox.vox_locator_find_triangle_hits, TriangleHits, _TRIANGLE_HIT,  # type: ignore[no-any-return]
                              desc, 64, start_, _batch(np.reshape(end, (-1, 3)), "end"))
        return self._find(lambda locator, at, *rest: vox.vox_locator_find_triangle_hits(  # type: ignore[no-any-return]
            locator, at, None, *rest), TriangleHits, _TRIANGLE_HIT, desc, 64, start_)

    def find_box_hits(self, low: ArrayLike, high: ArrayLike, *, mask: int = 0, excluded: _Body = None) -> BoxHits:
        """All tetrahedra whose bounding box meets the box from low[i] to high[i]; exact. Corners may be infinite."""
        low_, high_ = _batch(low, "low"), _batch(high, "high")
        return self._find(vox.vox_locator_find_box_hits, BoxHits, _BOX_HIT,  # type: ignore[no-any-return]
                          _desc(mask, excluded), 64, low_, high_)

    def find_ray_hits(self, start: ArrayLike, end: ArrayLike, *, first: bool = False, mask: int = 0,
                      excluded: _Body = None) -> RayHits:
        """All facets of surfaces on the segment from start[i], where t is 0, to end[i], where it is 1; or the first one."""
        start_, end_, desc = _batch(start, "start"), _batch(end, "end"), _desc(mask, excluded)
        desc.flags = switch(first, "first") * _c.QueryFlags.FIRST_HIT
        return self._find(vox.vox_locator_find_ray_hits, RayHits, _RAY_HIT, desc,  # type: ignore[no-any-return]
                          2 * start_.length + 16, start_, end_)

    def test_rays(self, start: ArrayLike, end: ArrayLike, *, mask: int = 0, excluded: _Body = None) -> NDArray[np.bool_]:
        """Whether each segment meets a tetrahedron that has a volume; exact, and faster than a first hit."""
        start_, end_ = _batch(start, "start"), _batch(end, "end")
        handle, _ = self._open()
        blocked = np.empty(start_.length, np.bool_)
        vox.vox_locator_test_rays(handle.pointer, start_.struct, end_.struct, _desc(mask, excluded), blocked.ctypes.data)
        return blocked

    def find_tracks(self, start: ArrayLike, end: ArrayLike, *, mask: int = 0, excluded: _Body = None) -> TrackPieces:
        """The tetrahedra that the segments from start[i] to end[i] pass through, exact, in order: inside a body t_out of a
        piece is t_in of the next one, bit for bit. A stretch along a facet or an edge is in one of the tetrahedra there."""
        start_, end_, desc = _batch(start, "start"), _batch(end, "end"), _desc(mask, excluded)
        guess = 16 * start_.length + 64
        if start_.length > 256 and start_.length == end_.length:  # a second call would take as long as the first
            every = start_.length // 64
            few = [_batch(np.asarray(rows.array)[::every], "few") for rows in (start_, end_)]
            count = ctypes.c_uint64()
            vox.vox_locator_find_tracks(self._open()[0].pointer, few[0].struct, few[1].struct, desc, None, 0, count)
            guess = count.value * every * 5 // 4 + 64
        return self._find(vox.vox_locator_find_tracks, TrackPieces, _TRACK_PIECE,  # type: ignore[no-any-return]
                          desc, guess, start_, end_)

    def _locations(self, at: Rows, outside: str, max_distance: float, desc: Any) -> tuple[Any, ...]:
        """tet, weights, body, state and distance of the library."""
        if outside not in _OUTSIDE:
            raise InvalidArgumentError(f"outside is {outside!r}; it must be one of {', '.join(map(repr, _OUTSIDE))}")
        desc.max_distance = real(max_distance, "max_distance") if outside != "none" else np.finfo(float).smallest_subnormal
        desc.flags = _c.QueryFlags.EXTRAPOLATE * (outside == "extrapolate")
        handle, _ = self._open()
        n = at.length
        tet, weights, body = np.empty(n, np.int64), np.empty((n, 4)), np.empty(n, np.uint32)
        state, distance = np.empty(n, np.int32), np.empty(n)
        buffer = np.empty(n, _LOCATION)
        vox.vox_locator_locate(handle.pointer, at.struct, desc, buffer.ctypes.data)
        for begin in range(0, n, _AT_ONCE):
            part = slice(begin, begin + _AT_ONCE)
            for array, name in ((tet, "tet"), (weights, "weights"), (body, "body"), (state, "state"), (distance, "distance")):
                array[part] = buffer[part][name]
        tet[state == LocationState.NONE] = -1
        return tet, weights, body, state, distance

    def locate(self, points: ArrayLike, *, outside: str = "none", max_distance: float = 0.0, mask: int = 0,
               excluded: _Body = None) -> Located:
        """The tetrahedron of each point, exact, and the weights of its corners in double. The answer for a point depends on no
        other point.

        `outside`: what a point in no tetrahedron gets: "none", -1 and zeros; "nearest", the tetrahedron of the closest point
        no further than max_distance (0: at any distance) with the weights for that; "extrapolate", the same with the weights
        for the point itself, some of which are negative."""
        at, desc = _batch(points, "points"), _desc(mask, excluded)
        cells = self._whole[2] if self._whole else None
        if cells is not None and cells.bent:
            return self._in_cells(cells, at, outside, max_distance, desc)
        _, numbers = self._open()
        tet, weights, body, state, distance = self._locations(at, outside, max_distance, desc)
        if outside == "none":
            out = state == LocationState.OUTSIDE
            tet[out], weights[out], body[out], state[out], distance[out] = -1, 0, 0, LocationState.NONE, 0
        if numbers is not None:
            tet[tet >= 0] = numbers[tet[tet >= 0]]
        located = Located(tet, weights, body)
        located.state, located.distance, located.cell, located.reference = state, distance, tet, weights[:, 1:]
        if cells is not None and numbers is None:
            located.cell = np.where(tet >= 0, cells.of_tet[tet], -1)
        return located
    def _in_cells(self, cells: Cells, at: Rows, outside: str, max_distance: float, desc: Any) -> Located:
        """The same where cells have curved faces: those of split cells are flat, so that a point may be in a neighbour of its
        tetrahedron's cell, or outside of the tetrahedra. A point that is in a tetrahedron is never outside."""
        _, numbers = self._open()
        points = np.asarray(at.array).astype(np.float64, copy=False)
        most = 0.0 if outside == "none" else max_distance or np.inf
        tet, weights, body, state, distance = self._locations(
            at, "nearest" if outside == "none" else outside, 0 if most == np.inf else max(most, cells.reach), desc)
        there = np.flatnonzero(tet >= 0)
        reference, cell = np.zeros((at.length, 3)), np.full(at.length, -1, np.int64)
        inside = state == LocationState.INSIDE
        cell[there], reference[there], contained = cells.answer(points[there], tet[there], weights[there])
        inside[there[contained]] = True
        state[inside], distance[inside] = LocationState.INSIDE, 0
        out = there[~inside[there]]
        far, out = out[distance[out] > most], out[distance[out] <= most]
        if outside == "none":
            far, out = np.concatenate([far, out]), out[:0]
        for array, nothing in ((tet, -1), (weights, 0), (body, 0), (state, 0), (distance, 0), (cell, -1), (reference, 0)):
            array[far] = nothing
        if outside == "nearest":
            corners = cells.positions[cells.tets[tet[out]]]
            closest = sum(weights[out, i, None] * corners[:, i] for i in range(4))
            cell[out], reference[out], _ = cells.answer(closest, tet[out], weights[out])
        located = Located(tet if numbers is None else cell, weights, body)
        located.state, located.distance, located.cell, located.reference = state, distance, cell, reference
        return located

    def _interpolation(self, located: Located) -> tuple[int, NDArray[Any], NDArray[np.float64]]:
        """How many vertices the mesh has, and the vertices and their weights for each point, (n, k); weights 0 without an
        answer."""
        if self._whole is None:
            raise TypeError("the locator is of a grid; fields are transferred from one mesh")
        count, tets, cells = self._whole
        there = located.cell >= 0
        if cells is not None and cells.bent:
            nodes, weights = cells.interpolation(np.where(there, located.cell, cells.of_tet[0]), located.reference)
            return count, nodes, np.where(there[:, None], weights, 0)
        _, numbers = self._open()
        tet = located.tet if numbers is None else np.searchsorted(numbers, located.tet)
        return count, tets[np.where(there, tet, 0)], located.weights

    @property
    def epoch(self) -> int:
        """`Grid.epoch` when the locator was taken."""
        handle, _ = self._open()
        epoch = ctypes.c_uint64()
        vox.vox_locator_get_epoch(handle.pointer, epoch)
        return epoch.value

    def user_data(self, body: Union[Mesh, int]) -> int:
        """The user_data that a body of the locator was added with, even if it was removed since."""
        handle, _ = self._open()
        number = ctypes.c_uint64()
        vox.vox_locator_get_user_data(handle.pointer, integer(body, "body", 0, U32), number)
        return number.value

    def close(self) -> None:
        """Frees its memory, once the questions that other threads asked before are answered. Twice does nothing."""
        self._taken = None

    def __enter__(self) -> Locator:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def locate(points: ArrayLike, where: Any, tets: Optional[ArrayLike] = None, *, outside: str = "none") -> Located:
    """The tetrahedron that each of the points, (n, 3), is in. `where`: what a Locator is made of, as it is now, or a Locator.
    `outside`: as for Locator.locate.

    A point on a facet is in one of the tetrahedra beside it, never in none: decided exactly for the coordinates given. That
    is what VTK's locators, which test with a tolerance, cannot promise.

    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> tet, weights, _ = locate([[.25, .25, .25], [0, 0, 0], [1, 1, 1]], corners, [[0, 1, 2, 3]])
    >>> tet.tolist(), weights[0].tolist()
    ([0, 0, -1], [0.25, 0.25, 0.25, 0.25])
    """
    return (where if isinstance(where, Locator) else Locator(where, tets)).locate(points, outside=outside)


def tracks(start: ArrayLike, end: ArrayLike, where: Any, tets: Optional[ArrayLike] = None) -> Tracks:
    """What the segments from start[i] to end[i] pass through, in order; `where`: as for `locate`. Bodies of a grid, which may
    overlap, follow each other.

    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> offsets, tet, t_in, t_out = tracks([[0, .25, .25]], [[1, .25, .25]], corners, [[0, 1, 2, 3]])
    >>> offsets.tolist(), tet.tolist(), t_in.tolist(), t_out.tolist()
    ([0, 1], [0], [0.0], [0.5])
    """
    locator = where if isinstance(where, Locator) else Locator(where, tets)
    pieces = locator.find_tracks(start, end)
    numbers = locator._open()[1]
    if numbers is not None and (numbers[1:] == numbers[:-1]).any():  # cells were split: their pieces are joined
        same = np.zeros(len(pieces) + 1, np.bool_)
        same[1:-1] = pieces.t_in[1:] == pieces.t_out[:-1]
        for name in ("segment", "body", "tet"):
            same[1:-1] &= pieces[name][1:] == pieces[name][:-1]
        first, last = pieces[~same[:-1]], pieces[~same[1:]]
    else:
        first = last = pieces
    offsets = np.searchsorted(np.ascontiguousarray(first.segment), np.arange(_batch(start, "start").length + 1, dtype=np.uint32))
    return Tracks(offsets, first.tet.astype(np.int64), np.ascontiguousarray(first.t_in), np.ascontiguousarray(last.t_out))
