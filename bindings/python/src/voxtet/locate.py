"""Which tetrahedron each point is in, for people who come from VTK: many points at once, exact on facets."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .grid import Grid
from ._interop import arrays_of
from .mesh import Mesh
from .queries import QueryView


class Located(NamedTuple):
    """For each point: the tetrahedron it is in, -1 if in none; the weights of its corners, 0 if in none; the id of the mesh,
    0 if in none. Of several tetrahedra, the lowest (mesh, tet)."""

    tet: NDArray[np.int64]
    barycentric: NDArray[np.float32]
    mesh: NDArray[np.uint32]


def _located(view: QueryView, where: ArrayLike, cells: Optional[NDArray[Any]] = None) -> Located:
    hits = view.query_points(where)
    count = 1 if np.shape(where) == (3,) else len(where)  # type: ignore[arg-type]
    tet = np.full(count, -1, np.int64)
    barycentric = np.zeros((count, 4), np.float32)
    mesh = np.zeros(count, np.uint32)
    points = hits.point
    first = np.ones(len(hits), np.bool_)
    first[1:] = points[1:] != points[:-1]
    if not first.all():
        hits, points = hits[first], points[first]
    tet[points] = hits.tet if cells is None else cells[hits.tet]
    barycentric[points] = hits.barycentric
    mesh[points] = hits.mesh
    return Located(tet, barycentric, mesh)


class Locator:
    """A mesh that is asked where points are, again and again. What `locate` accepts: positions and tets, or a mesh of pyvista,
    meshio or voxtet.io. Any number of threads may ask.

    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> Locator(corners, [[0, 1, 2, 3]]).locate([[.1, .1, .1], [2, 0, 0]]).tet.tolist()
    [0, -1]
    """

    def __init__(self, positions: Any, tets: Optional[ArrayLike] = None) -> None:
        points, found, self._cells = arrays_of(positions, tets)
        with Grid(penetrations=False) as grid:
            grid.add(points, found, copy=True)
            self._view = grid.query_view()

    def locate(self, points: ArrayLike) -> Located:
        """The tetrahedron (for a mesh of pyvista: the cell) of each point, (n, 3)."""
        return _located(self._view, points, self._cells)


def locate(points: ArrayLike, where: Union[Grid, QueryView, Locator, Mesh, Any], tets: Optional[ArrayLike] = None) -> Located:
    """The tetrahedron that each of the points, (n, 3), is in. `where`: positions, with `tets`; or a mesh of pyvista, meshio or
    voxtet.io; or a grid or a mesh of one, as they are now; or what was prepared before, a Locator or a QueryView.

    A point on a facet is in one of the tetrahedra beside it, never in none: decided exactly for the coordinates given. That
    is what VTK's locators, which test with a tolerance, cannot promise.

    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> tet, weights, _ = locate([[.25, .25, .25], [0, 0, 0], [1, 1, 1]], corners, [[0, 1, 2, 3]])
    >>> tet.tolist(), weights[0].tolist()
    ([0, 0, -1], [0.25, 0.25, 0.25, 0.25])
    """
    if isinstance(where, Locator):
        return where.locate(points)
    if isinstance(where, QueryView):
        return _located(where, points)
    if isinstance(where, Grid):
        with where.query_view() as view:
            return _located(view, points)
    return Locator(where, tets).locate(points)
