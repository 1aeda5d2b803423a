"""The best cell size of a uniform grid of your own, whatever is in it: from what it stores, from timings, or by running it.
docs/your-own-grid.md says how, and why.

>>> import numpy as np
>>> points = np.random.default_rng(1).random((2000, 3))
>>> ForeignGrid(points, known="point_voxels", radius=0.1).suggest().zone[1] < 0.5
True
"""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Mapping
from typing import Any, Callable, Iterable, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import U32, choice, indices, integer, pinned, points, real, rows
from ._interop import primitives_of
from ._library import Relay, described, sized, values_of, vox
from .errors import InvalidArgumentError
from .suggest import CellSizeResult, ForeignWeights

_UNIT = "seconds of a run"
_TYPES = {2: _c.PrimitiveType.EDGE, 3: _c.PrimitiveType.TRIANGLE, 4: _c.PrimitiveType.TET}


class ForeignCounts(NamedTuple):
    """How often a run does what, on average over all positions of the lattice (vox_foreign_counts)."""

    stored: float  # primitives stored in a cell
    visits: float  # cells visited; with cells_queried="pairs", cells that store something
    empty: float  # visited cells that store nothing
    reads: float  # primitives read in visited cells; with cells_queried="pairs", pairs within a cell
    occupied: float  # cells that store something
    cells: float  # cells in the box of the stored primitives


# ---- what a grid stores -----------------------------------------------------------------------------------------------


def _is_array(value: Any) -> bool:
    return isinstance(value, (list, tuple)) or hasattr(value, "__dlpack_device__") or hasattr(value, "__array__")


def _followed(value: Any, name: str) -> Any:
    """(n, 3) numbers as the library reads them: borrowed where it can follow the strides of floats, else copied."""
    if isinstance(value, np.ndarray):
        try:
            return rows(value, name)
        except (TypeError, InvalidArgumentError):
            pass  # the copy below may do; if not, it says why
    return points(value, name)


class Primitives:
    """What a grid stores, or its queries: points, edges, triangles, tetrahedra or boxes, each of which may have a radius. Only
    the box of each counts, larger by the radius on all sides.

    positions: points, (n, 3); or a mesh of pyvista, meshio, trimesh, voxtet.io, or of a grid: its tetrahedra, else its triangles,
    else its points. indices: (m, 2) for edges, (m, 3) for triangles, (m, 4) for tetrahedra. radii: one for each primitive, (m,);
    radius: of all, added to these. Arrays of float32 or float64, and of uint32 for the indices, are borrowed, with any strides
    that the library can follow, and read in each call; others are copied.

    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> Primitives(corners, [[0, 1, 2], [0, 1, 3]])
    <voxtet.Primitives: 2 triangles>
    >>> Primitives.boxes(corners, corners + 0.5, radius=0.1)
    <voxtet.Primitives: 4 boxes>
    """

    __slots__ = ("_kept", "_struct")

    def __init__(self, positions: Any, indices: Optional[ArrayLike] = None, *, radius: float = 0.0,
                 radii: Optional[ArrayLike] = None) -> None:
        if indices is None and not _is_array(positions):
            positions, indices = primitives_of(positions)
        self._describe(_followed(positions, "positions"), radius)
        if indices is None:
            self._struct.count = self._struct.positions.count
        else:
            self._set_indices(indices)
        if radii is not None:
            self._set_radii(radii)

    @classmethod
    def boxes(cls, minimum: ArrayLike, maximum: ArrayLike, *, radius: float = 0.0,
              radii: Optional[ArrayLike] = None) -> Primitives:
        """Boxes along the axes, from opposite corners, (n, 3) each. They are borrowed if they alternate in one array, as
        `both[:, :3]` and `both[:, 3:]` do; else they are copied."""
        self = cls.__new__(cls)
        low, high = _followed(minimum, "minimum"), _followed(maximum, "maximum")
        if low.length != high.length:
            raise InvalidArgumentError(f"minimum has {low.length} rows and maximum {high.length}")
        a, b = low.struct, high.struct
        apart = (b.data or 0) - (a.data or 0)
        size = 4 if a.format == _c.Format.FLOAT else 8
        if (a.count > 1 and a.format == b.format and a.component_byte_stride == b.component_byte_stride == size
                and a.byte_stride == b.byte_stride == 2 * apart and apart >= 3 * size and apart % size == 0):
            self._describe(low, radius)
            self._struct.positions.byte_stride, self._struct.positions.count = apart, 2 * a.count
            self._kept.append(high)
        else:
            both = np.stack([low.array, high.array], axis=1)
            self._describe(rows(both.reshape(-1, 3), "boxes"), radius)
        self._struct.type, self._struct.count = _c.PrimitiveType.BOX, low.length
        if radii is not None:
            self._set_radii(radii)
        return self

    def _describe(self, found: Any, radius: float) -> None:
        self._struct = struct = described(_c.vox_primitives)
        self._kept: list[Any] = [found]
        struct.positions = found.struct
        struct.radius = real(radius, "radius")

    def _set_indices(self, value: Any) -> None:
        array: NDArray[Any] = value if isinstance(value, np.ndarray) else np.asarray(value)
        width = array.shape[1] if array.ndim == 2 else 0
        if width not in _TYPES:
            raise InvalidArgumentError(f"indices has the shape {array.shape}; it must be (m, 2) for edges, (m, 3) for triangles "
                                       "or (m, 4) for tetrahedra")
        followed = (array.dtype == np.uint32 and array.flags.aligned and len(array) > 1 and array.strides[1] == 4
                    and array.strides[0] >= 4 * width)
        if not followed:
            array = indices(array, "indices", width)
        self._kept += [array, pinned(array)]
        struct = self._struct
        struct.type, struct.indices, struct.count = _TYPES[width], array.ctypes.data, len(array)
        struct.index_byte_stride = array.strides[0] if followed else 0

    def _set_radii(self, value: Any) -> None:
        array = value if isinstance(value, np.ndarray) else np.asarray(value)
        if array.dtype.kind not in "iuf":
            raise TypeError(f"radii has the dtype {array.dtype}; it must hold numbers")
        if array.shape != (self._struct.count,):
            raise InvalidArgumentError(f"radii has the shape {array.shape}; it must be ({self._struct.count},)")
        followed = (array.dtype in (np.float32, np.float64) and array.dtype.isnative and array.flags.aligned and len(array) > 1
                    and array.strides[0] >= array.itemsize)
        if not followed:
            array = np.ascontiguousarray(array, np.float32 if array.dtype == np.float32 else np.float64)
        self._kept += [array, pinned(array)]
        struct = self._struct
        struct.radii = array.ctypes.data
        struct.radius_format = _c.Format.FLOAT if array.itemsize == 4 else _c.Format.DOUBLE
        struct.radius_byte_stride = array.strides[0] if followed else 0

    def __len__(self) -> int:
        return int(self._struct.count)

    def __repr__(self) -> str:
        names = ("points", "edges", "triangles", "tetrahedra", "boxes")
        return f"<voxtet.Primitives: {len(self)} {names[self._struct.type]}>"


def _primitives(value: Any) -> Primitives:
    if isinstance(value, Primitives):
        return value
    if isinstance(value, tuple) and len(value) == 2 and np.ndim(value[0]) == 2:
        return Primitives(*value)
    return Primitives(value)


# ---- grids ------------------------------------------------------------------------------------------------------------

class ForeignGrid:
    """A uniform grid of another library. A run stores primitives in cells; then each query visits cells and reads the primitives
    stored there.

    stored: Primitives, or points, (n, 3), a pair of positions and indices, or a mesh, as Primitives takes them. querying: the
    queries; None: the stored primitives query each other.
    known: the grid that it is like: "none", "sorted", "hashed", "warp", "ipc", "ipc_pairs", "vtk", "pbat", "point_voxels" or
    "numpy" (vox_known_grid). What is not given below is as in this grid.
    cells_stored: the cells that store a primitive: "box", all that its box meets, or "centre", the one with the centre of its box.
    cells_queried: the cells that a query visits: "box", all that its box meets; "27", the one with its centre and those around it,
    only with "centre"; "pairs", none: the grid reports every pair within a cell.
    cells_kept: the cells that exist: "occupied", those that store something, or "dense", all in the box of the stored primitives.
    radius: grows the boxes of queries on all sides.
    min_cell_size: the smallest one that gives right answers; 0: with "27" what the boxes demand, otherwise any.
    weights: ForeignWeights, or a dict of some of them.
    zone_loss: the zone is where the cost is at most 1 + zone_loss times the least.

    Nothing is computed here, and what is in the arrays is read in each call. Any thread.
    """

    __slots__ = ("_querying", "_stored", "_struct")

    def __init__(self, stored: Any, querying: Any = None, *, known: Union[str, _c.KnownGrid] = "none",
                 cells_stored: Union[str, _c.CellsStored] = "default", cells_queried: Union[str, _c.CellsQueried] = "default",
                 cells_kept: Union[str, _c.CellsKept] = "default", radius: float = 0.0, min_cell_size: float = 0.0,
                 weights: Union[ForeignWeights, Mapping[str, float], None] = None, zone_loss: float = 0.05) -> None:
        self._struct = struct = described(_c.vox_foreign_grid)
        struct.known = choice(_c.KnownGrid, known, "known")
        struct.cells_stored = choice(_c.CellsStored, cells_stored, "cells_stored")
        if isinstance(cells_queried, str) and cells_queried == "27":
            cells_queried = _c.CellsQueried(2)  # no name begins with a digit
        struct.cells_queried = choice(_c.CellsQueried, cells_queried, "cells_queried")
        struct.cells_kept = choice(_c.CellsKept, cells_kept, "cells_kept")
        if weights is not None:
            if not isinstance(weights, (ForeignWeights, Mapping)):
                raise TypeError(f"weights is of type {type(weights).__name__}; it must be ForeignWeights or a dict")
            given = weights._asdict() if isinstance(weights, ForeignWeights) else weights
            unknown = set(given) - set(ForeignWeights._fields)
            if unknown:
                raise InvalidArgumentError(f"weights has the keys {', '.join(sorted(map(repr, unknown)))}; they must be of "
                                           f"{', '.join(ForeignWeights._fields)}")
            for name, value in given.items():
                setattr(struct.weights, name, real(value, f"weights[{name!r}]"))
        struct.radius, struct.zone_loss = real(radius, "radius"), real(zone_loss, "zone_loss")
        struct.min_cell_size = real(min_cell_size, "min_cell_size")
        self._stored = _primitives(stored)
        self._querying = None if querying is None else _primitives(querying)
        struct.stored = ctypes.pointer(self._stored._struct)
        if self._querying is not None:
            struct.querying = ctypes.pointer(self._querying._struct)

    # Not to be set: the struct points into their arrays.
    @property
    def stored(self) -> Primitives:
        """The primitives in cells."""
        return self._stored

    @property
    def querying(self) -> Optional[Primitives]:
        """The queries; None: the stored primitives."""
        return self._querying

    def __repr__(self) -> str:
        return f"<voxtet.ForeignGrid of {self._stored!r}" + (">" if self._querying is None else f", queried by {self._querying!r}>")

    def suggest(self) -> CellSizeResult:
        """The cell size with the least cost. Many primitives are sampled.

        >>> import numpy as np
        >>> points = np.random.default_rng(1).random((2000, 3))
        >>> s = ForeignGrid(points, known="hashed", cells_stored="centre", radius=0.1).suggest()
        >>> s.zone[0] <= s.cell_size <= s.zone[1]
        True
        >>> bool(abs(s.terms.cost.sum() / s.cost - 1) < 1e-6)
        True
        >>> ForeignGrid(points, radius=0.1).suggest().warnings
        <CellSizeWarnings.GUESSED_WEIGHTS: 1>
        """
        out = sized(_c.vox_cell_size_result)
        vox.vox_foreign_grid_suggest(self._struct, out)
        return CellSizeResult(out, _UNIT)

    def count(self, cell_size: float) -> ForeignCounts:
        """How often a run does what at a cell size.

        >>> import numpy as np
        >>> unit = np.eye(3)
        >>> ForeignGrid(Primitives.boxes(unit, unit + 1)).count(0.5).stored  # three boxes, 1 / 0.5 + 1 cells along each axis
        81.0
        """
        out = _c.vox_foreign_counts()
        vox.vox_foreign_grid_count(self._struct, real(cell_size, "cell_size"), out)
        return values_of(ForeignCounts, out)

    def fit(self, timings: Iterable[tuple[float, float]]) -> CellSizeResult:
        """The weights from timings of whole runs, (cell size, seconds), at three or more cell sizes, and the cell size that they
        lead to. 0.6, 1.2 and 2.4 mean edges will do. The weights also hold for other scenes in the same grid.

        >>> import numpy as np
        >>> grid = ForeignGrid(np.random.default_rng(1).random((2000, 3)), cells_stored="centre", radius=0.1)
        >>> def seconds(size):  # of a grid that needs 10 ns to visit a cell, and 2 ns to read a primitive
        ...     counts = grid.count(size)
        ...     return 1e-9 * (10 * counts.visits + 2 * counts.reads)
        >>> fit = grid.fit([(size, seconds(size)) for size in (0.05, 0.1, 0.2)])
        >>> fit.fit_error < 0.05
        True
        >>> abs(fit.weights.read - 2) < 0.4
        True
        """
        given = [_c.vox_timing(real(size, "a cell size"), real(seconds, "a time")) for size, seconds in timings]
        out = sized(_c.vox_cell_size_result)
        vox.vox_foreign_grid_fit(self._struct, (_c.vox_timing * len(given))(*given), len(given), out)
        return CellSizeResult(out, _UNIT)

    def tune(self, run: Callable[[float], Optional[float]], *, first: float = 0.0, low: float = 0.0, high: float = 0.0,
             max_runs: int = 7, wanted_loss: float = 0.02) -> CellSizeResult:
        """As voxtet.tune, with what is known of this grid. first: the one that `suggest` gives, if it is not given."""
        return _tune(self._struct, run, first, low, high, max_runs, wanted_loss)


def _timed(run: Callable[[float], Optional[float]], cell_size: float) -> float:
    began = time.perf_counter()
    seconds = run(cell_size)
    taken = time.perf_counter() - began
    return taken if seconds is None else real(seconds, "what run returned")


def _tune(grid: Any, run: Callable[[float], Optional[float]], first: float, low: float, high: float, max_runs: int,
          wanted_loss: float) -> CellSizeResult:
    if not callable(run):
        raise TypeError(f"run is of type {type(run).__name__}; it must be a function of the cell size")
    desc, out = described(_c.vox_tune_desc), sized(_c.vox_cell_size_result)
    desc.first, desc.min, desc.max = real(first, "first"), real(low, "low"), real(high, "high")
    desc.max_runs, desc.wanted_loss = integer(max_runs, "max_runs", 0, U32), real(wanted_loss, "wanted_loss")
    called = Relay(lambda size, _user: _timed(run, size), math.nan)
    with called:
        vox.vox_foreign_grid_tune(grid, desc, _c.vox_foreign_run(called), None, out)
    return CellSizeResult(out, _UNIT)


def tune(run: Callable[[float], Optional[float]], first: float, *, low: float = 0.0, high: float = 0.0, max_runs: int = 7,
         wanted_loss: float = 0.02) -> CellSizeResult:
    """The best cell size of a grid of which nothing else is known, by running it: at three sizes first, then where the fit to all
    runs so far is lowest or least sure, until the expected loss is below `wanted_loss`, or `max_runs` are made (3 to 32).
    `ForeignGrid.tune` needs fewer runs.

    run(cell_size) runs the grid once and returns the seconds that took; or None, and the call is timed. Infinity: this size is
    impossible, and others are tried. NaN or a negative number: stop, and the result is from the runs so far. What it raises
    comes out of here, Ctrl-C too.
    first: the cell size to begin with. low, high: the sizes to try, an eighth to eight times the first if not given.

    >>> result = tune(lambda size: 1e-3 * (size + 4 / size), 1)
    >>> bool(1.6 < result.cell_size < 2.5), len(result.timings) <= 7
    (True, True)
    """
    return _tune(None, run, first, low, high, max_runs, wanted_loss)
