"""Fields from a mesh to points and forces back, a skin that follows a cage, and fields from mesh to mesh."""

from __future__ import annotations

import copy
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._c import LocationState
from ._interop import is_mesh
from .errors import InvalidArgumentError
from .locate import Located, Locator

_OUTSIDE = {"nearest": "nearest", "raise": "nearest", "nan": "none", "extrapolate": "extrapolate"}


def _points_of(points: Any) -> Any:
    """Those of a mesh, or points as they are."""
    if not is_mesh(points):
        return points
    return np.asarray(next(getattr(points, name) for name in ("points", "positions", "vertices") if hasattr(points, name)))


def _values_of(values: ArrayLike, count: int, what: str) -> NDArray[Any]:
    """(count, ...) of doubles or complex numbers."""
    array = np.asarray(values)
    if array.dtype.kind not in "iufcb":
        raise TypeError(f"the values have the dtype {array.dtype}; they must be numbers")
    if array.ndim == 0 or len(array) != count:
        raise InvalidArgumentError(f"the values have the shape {array.shape}; there are {count} {what}")
    return array if array.dtype.kind == "c" else array.astype(np.float64, copy=False)


class Transfer:
    """The interpolation of fields at the vertices of a mesh, `source`, at points: a matrix with few numbers in each row.

    `T @ values` are the values at the points, for (n,) or (n, ...) values at the vertices, and `T.T @ forces` the forces on
    the vertices of forces on the points, which have the same sum. In tetrahedra the field is linear; in the other cells of a
    mesh of pyvista or meshio it is the element's own.

    `source`: what a Locator takes, other than a grid, or a Locator. `points`: (n, 3), or a mesh, for its vertices. `outside`:
    what points outside of the mesh get: "nearest", the value at the closest point of the mesh; "extrapolate", the field of
    that tetrahedron continued; "nan", NaN, and forces there have no effect; "raise", an error.

    `located` says where the points are, `nodes` (k, n) and `weights` (k, n) are the vertices and weights of each point.

    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> T = Transfer(corners, [[.5, .25, 0], [2, 0, 0]], tets=[[0, 1, 2, 3]])
    >>> (T @ [10, 20, 30, 40]).tolist(), (T.T @ [1, 1]).tolist()
    ([20.0, 20.0], [0.25, 1.5, 0.25, 0.0])
    """

    def __init__(self, source: Any, points: Any, outside: str = "nearest", *, tets: Optional[ArrayLike] = None) -> None:
        if outside not in _OUTSIDE:
            raise InvalidArgumentError(f"outside is {outside!r}; it must be one of {', '.join(map(repr, _OUTSIDE))}")
        locator = source if isinstance(source, Locator) else Locator(source, tets)
        self.located: Located = locator.locate(_points_of(points), outside=_OUTSIDE[outside])
        out = self.located.state != LocationState.INSIDE
        if outside == "raise" and out.any():
            first = int(out.argmax())
            raise InvalidArgumentError(f"{int(out.sum())} of {len(out)} points are outside of the mesh, the first of them point "
                                       f"{first}, by {self.located.distance[first]:g}")
        self._missing: Optional[NDArray[Any]] = np.flatnonzero(out) if outside == "nan" and out.any() else None
        vertex_count, nodes, weights = locator._interpolation(self.located)
        self.shape = len(out), vertex_count
        self.nodes: NDArray[np.intp] = np.ascontiguousarray(nodes.T, np.intp)
        self.weights: NDArray[np.float64] = np.ascontiguousarray(weights.T)

    @property
    def outside(self) -> NDArray[np.bool_]:
        """Which points are outside of the mesh."""
        found: NDArray[np.bool_] = self.located.state != LocationState.INSIDE
        return found

    def __matmul__(self, values: ArrayLike) -> NDArray[Any]:
        given = _values_of(values, self.shape[1], "vertices")
        columns = self._at_points(given.reshape(len(given), -1).T)
        return columns.T.reshape(len(self.weights.T), *given.shape[1:])

    def _at_points(self, columns: NDArray[Any]) -> NDArray[Any]:
        """Of values in rows, (c, vertices), those at the points, (c, points)."""
        found = np.empty((len(columns), self.shape[0]), columns.dtype)
        part = np.empty(self.shape[0], columns.dtype)
        for column, total in zip(columns, found):
            column = np.ascontiguousarray(column)
            for i, (nodes, weights) in enumerate(zip(self.nodes, self.weights)):
                to = part if i else total
                np.take(column, nodes, out=to, mode="clip")  # all are in range; "raise" takes a copy
                to *= weights
                if i:
                    total += part
        if self._missing is not None:
            found[:, self._missing] = np.nan
        return found

    def _at_vertices(self, columns: NDArray[Any]) -> NDArray[Any]:
        """Of values in rows, (c, points), their sums at the vertices, (c, vertices)."""
        nodes = self.nodes.ravel()

        def total(column: NDArray[Any]) -> NDArray[Any]:
            return np.bincount(nodes, (self.weights * column).ravel(), self.shape[1])

        return np.stack([total(c.real) + 1j * total(c.imag) if c.dtype.kind == "c" else total(c) for c in columns])

    @property
    def T(self) -> Transposed:
        """What takes forces on the points to the vertices: `T.T @ forces`."""
        return Transposed(self)

    @property
    def matrix(self) -> Any:
        """The same as a scipy.sparse.csr_array, (points, vertices). Rows of points that get NaN are empty."""
        from scipy.sparse import csr_array
        used = self.weights.T != 0
        return csr_array((self.weights.T[used], self.nodes.T[used], np.append(0, np.cumsum(used.sum(axis=1)))), shape=self.shape)

    def __repr__(self) -> str:
        return f"<voxtet.{type(self).__name__}: {self.shape[0]} points, {int(self.outside.sum())} outside, {self.shape[1]} vertices>"


class Transposed:
    """A Transfer from the points to the vertices: `self @ forces`."""

    def __init__(self, transfer: Transfer) -> None:
        self.T = transfer
        self.shape = transfer.shape[::-1]

    def __matmul__(self, forces: ArrayLike) -> NDArray[Any]:
        given = _values_of(forces, self.shape[1], "points")
        rows = self.T._at_vertices(given.reshape(len(given), -1).T)
        return np.ascontiguousarray(rows.T).reshape(self.shape[0], *given.shape[1:])


class Embedding(Transfer):
    """A skin in a cage of tetrahedra, made by `embed`."""

    def move(self, positions: ArrayLike, out: Optional[NDArray[Any]] = None) -> NDArray[Any]:
        """The skin for new positions of the cage, (n, 3), of double precision and in whole columns, unless it is written to
        `out`."""
        found = self @ positions
        if out is None:
            return found
        out[...] = found
        return out


def embed(skin: Any, positions: ArrayLike, tets: ArrayLike) -> Embedding:
    """Binds a skin, points or a mesh, to a cage of tetrahedra: `embed(skin, positions, tets).move(new_positions)` is the skin in
    the moved cage. A vertex outside of the cage is moved as the closest tetrahedron is, so that it keeps its place there."""
    return Embedding(positions, skin, "extrapolate", tets=tets)


def sample(source: Any, target: Any, outside: str = "nearest") -> Any:
    """A copy of `target`, a mesh of pyvista or meshio, with the fields of `source`, another such mesh, at its points. Point data
    is interpolated. Cell data becomes point data as well: the value of the cell that the point is in. `outside`: as for
    Transfer."""
    transfer = Transfer(source, target, outside)
    found: dict[str, NDArray[Any]] = {}
    for name, values in _cell_data(source).items():
        at_points = values[transfer.located.cell]
        if outside == "nan" and transfer.outside.any():
            at_points = at_points.astype(np.result_type(at_points, np.float64))
            at_points[transfer.outside] = np.nan
        found[name] = at_points
    found.update({name: transfer @ values for name, values in source.point_data.items() if np.asarray(values).dtype.kind in "iufcb"})
    if hasattr(target, "celltypes") or hasattr(target, "regular_faces"):
        made = target.copy()
        for name, values in found.items():
            made.point_data[name] = np.ascontiguousarray(values)
        return made
    made = copy.copy(target)
    made.point_data = {**target.point_data, **found}
    return made


def _cell_data(mesh: Any) -> dict[str, NDArray[Any]]:
    """For all cells; meshio has it by blocks."""
    if hasattr(mesh, "celltypes"):
        arrays = {name: np.asarray(values) for name, values in mesh.cell_data.items()}
    else:
        arrays = {name: np.concatenate([np.asarray(part) for part in parts]) for name, parts in mesh.cell_data.items()}
    return {name: values for name, values in arrays.items() if values.dtype.kind in "iufcb"}
