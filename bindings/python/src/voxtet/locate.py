"""Which tetrahedra are at a point, in a box, on a line, and where is the closest surface? Many questions at once, exact."""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import U32, Rows, integer, points as points_of, real, switch
from ._interop import arrays_of
from ._library import Handle, described, vox
from .errors import InvalidStateError
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


class Located(NamedTuple):
    """For each point: the tetrahedron it is in, -1 if in none; the weights of its corners, 0 if in none; the id of the body,
    0 if in none. Of several tetrahedra, the lowest (body, tet)."""

    tet: NDArray[np.int64]
    weights: NDArray[np.float64]
    body: NDArray[np.uint32]


_POINT_HIT = record_type("vox_point_hit")
_CLOSEST_HIT = record_type("vox_closest_hit")
_BOX_HIT = record_type("vox_box_hit")
_RAY_HIT = record_type("vox_ray_hit")
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
    beside its tetrahedra, `tet` is the index of the cell.

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

    def __init__(self, where: Any, tets: Optional[ArrayLike] = None) -> None:
        if isinstance(where, Grid) and tets is None:
            self.update(where)
            return
        positions, found, cells = arrays_of(where, tets)
        with Grid() as grid:
            grid.add(positions, found, copy=True)
            self._take(grid, cells)

    def update(self, grid: Grid) -> None:
        """From now on, the answers are about the grid as it is now. Other threads may ask meanwhile."""
        if not isinstance(grid, Grid):
            raise TypeError(f"grid is of type {type(grid).__name__}; it must be a voxtet.Grid")
        self._take(grid, None)

    def _take(self, grid: Grid, cells: Optional[NDArray[Any]]) -> None:
        pointer = ctypes.c_void_p()
        with grid._lock:
            vox.vox_grid_update_locator(grid._pointer, pointer)
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
        handle, cells = self._open()
        hits = np.empty(at.length, _CLOSEST_HIT).view(ClosestHits)
        vox.vox_locator_find_closest(handle.pointer, at.struct, desc, hits.ctypes.data)
        if cells is not None:
            found = hits.body > 0
            hits.tet[found] = cells[hits.tet[found]]
        return hits

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

    def locate(self, points: ArrayLike) -> Located:
        """The tetrahedron of each point: of those that find_point_hits has, the first."""
        at = _batch(points, "points")
        hits = self.find_point_hits(at.array)  # type: ignore[arg-type]
        found = Located(np.full(at.length, -1, np.int64), np.zeros((at.length, 4)), np.zeros(at.length, np.uint32))
        point = hits.point
        first = np.ones(len(hits), np.bool_)
        first[1:] = point[1:] != point[:-1]
        if not first.all():
            hits, point = hits[first], point[first]
        for name in Located._fields:
            getattr(found, name)[point] = hits[name]
        return found

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


def locate(points: ArrayLike, where: Any, tets: Optional[ArrayLike] = None) -> Located:
    """The tetrahedron that each of the points, (n, 3), is in. `where`: what a Locator is made of, as it is now, or a Locator.

    A point on a facet is in one of the tetrahedra beside it, never in none: decided exactly for the coordinates given. That
    is what VTK's locators, which test with a tolerance, cannot promise.

    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> tet, weights, _ = locate([[.25, .25, .25], [0, 0, 0], [1, 1, 1]], corners, [[0, 1, 2, 3]])
    >>> tet.tolist(), weights[0].tolist()
    ([0, 0, -1], [0.25, 0.25, 0.25, 0.25])
    """
    return (where if isinstance(where, Locator) else Locator(where, tets)).locate(points)
