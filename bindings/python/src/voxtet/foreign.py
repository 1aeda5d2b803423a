"""The best cell size of a uniform grid of your own, whatever is in it: from what it holds, from timings, or by running it.
docs/your-own-grid.md says how, and why.

>>> import numpy as np
>>> points = np.random.default_rng(1).random((2000, 3))
>>> suggest_for(points, known="point_voxels", radius=0.1).zone[1] < 0.5
True
"""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Callable, Iterable, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import U32, choice, indices, integer, pinned, points, real, rows, switch
from ._interop import primitives_of
from ._library import Relay, described, sized, values_of, vox
from .errors import InvalidArgumentError
from .suggest import Plotted, curve_of, terms_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_TYPES = {2: _c.PrimitiveType.EDGE, 3: _c.PrimitiveType.TRIANGLE, 4: _c.PrimitiveType.TET}


class GridWork(NamedTuple):
    """What a run of a grid does at one cell size: the means over all positions of its cells."""

    entries: float  # primitives put into a cell
    visits: float  # cells looked at; with look="pairs", those that hold something
    empty: float  # visits of a cell that holds nothing
    reads: float  # entries of the cells looked at; with look="pairs", pairs in a cell
    occupied: float  # cells that hold something
    cells: float  # of the box of all that is held: cells of a dense grid


class GridWeights(NamedTuple):
    """Nanoseconds for one of each piece of work."""

    fixed: float = 0.0  # a run, whatever the cell size
    entries: float = 0.0
    visits: float = 0.0
    found: float = 0.0  # what a visit of a cell that holds something takes more than one of an empty cell
    reads: float = 0.0
    occupied: float = 0.0  # making and forgetting a cell
    cells: float = 0.0  # for grids with dense storage: clearing one


class ForeignRules(NamedTuple):
    """Cell sizes that other rules would choose, or their predicted costs; 0 where a rule does not apply."""

    mean_edge: float
    mean_box_side: float
    median_box_side: float
    spacing: float  # cube root of the volume of the box of all, over their number
    radius: float  # mean radius of those that ask


class Timing(NamedTuple):
    """A run at this cell size took so long; infinity: it could not run."""

    cell_size: float
    seconds: float


# ---- what a grid holds ------------------------------------------------------------------------------------------------


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
    """What a grid holds, or what asks it: points, edges, triangles, tetrahedra or boxes, each of which may have a radius. Only
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

_CONTENTS = {"centres": _c.CellContent.CELLS_HOLD_CENTRES, "boxes": _c.CellContent.CELLS_HOLD_BOXES}


class ForeignGrid:
    """A uniform grid that is not this library's. A run of it puts primitives into cells; then each of those that ask looks at
    cells and reads what is in them.

    held: what is put into cells: Primitives, or points, (n, 3), a pair of positions and indices, or a mesh, as Primitives takes
    them. asking: what asks; None: those held ask themselves, each of all.
    known: the grid that it is like, which sets content, look, dense and weights where these are not given: "any", "sorted",
    "hashed", "warp", "ipc", "ipc_pairs", "vtk", "pbat", "point_voxels" or "numpy" (vox_known_grid).
    content: which cells hold a primitive: "boxes", all that its box meets, or "centres", the one with the centre of its box.
    look: which cells one that asks looks at: "box", those that its box meets; "around", 27, the one with its centre and those
    around; "pairs": nobody asks, and what is in a cell is paired.
    dense: whether there is a list for each cell of the box of all that is held.
    radius: boxes that ask are larger by this on all sides.
    least_cell_size: the smallest one that gives right answers; 0: with "around" it follows from the boxes, otherwise any.
    weights: GridWeights, or a dict of some of them: nanoseconds of each piece of work.
    zone_loss: the zone is where the cost is at most 1 + zone_loss times its minimum.

    Nothing is computed here, and what is in the arrays is read in each call. Any thread.
    """

    __slots__ = ("_asking", "_held", "_struct")

    def __init__(self, held: Any, asking: Any = None, *, known: Union[str, _c.KnownGrid] = "any",
                 content: Optional[str] = None, look: Union[str, _c.CellLook, None] = None, dense: Optional[bool] = None,
                 radius: float = 0.0, least_cell_size: float = 0.0,
                 weights: Union[GridWeights, Mapping[str, float], None] = None, zone_loss: float = 0.05) -> None:
        self._struct = struct = described(_c.vox_foreign_grid)
        number = choice(_c.KnownGrid, known, "known")
        if number != _c.KnownGrid.ANY:
            vox.vox_foreign_grid_set_known(struct, number)
        if content is not None:
            if not isinstance(content, str):
                raise TypeError(f"content is of type {type(content).__name__}; it must be a string")
            if content not in _CONTENTS:
                raise InvalidArgumentError(f"content is {content!r}; it must be 'boxes' or 'centres'")
            struct.content = _CONTENTS[content]
        if look is not None:
            struct.look = choice(_c.CellLook, look, "look")
        if dense is not None:
            struct.flags = _c.ForeignFlags.DENSE * switch(dense, "dense")
        if weights is not None:
            if not isinstance(weights, (GridWeights, Mapping)):
                raise TypeError(f"weights is of type {type(weights).__name__}; it must be GridWeights or a dict")
            given = weights._asdict() if isinstance(weights, GridWeights) else weights
            unknown = set(given) - set(GridWeights._fields)
            if unknown:
                raise InvalidArgumentError(f"weights has the keys {', '.join(sorted(map(repr, unknown)))}; they must be of "
                                           f"{', '.join(GridWeights._fields)}")
            struct.weights = _c.vox_grid_weights(**{name: real(value, f"weights[{name!r}]") for name, value in given.items()})
        struct.radius, struct.zone_loss = real(radius, "radius"), real(zone_loss, "zone_loss")
        struct.least_cell_size = real(least_cell_size, "least_cell_size")
        self._held = _primitives(held)
        self._asking = None if asking is None else _primitives(asking)
        struct.held = ctypes.pointer(self._held._struct)
        if self._asking is not None:
            struct.asking = ctypes.pointer(self._asking._struct)

    # Not to be set: the struct points into their arrays.
    @property
    def held(self) -> Primitives:
        """What is put into cells."""
        return self._held

    @property
    def asking(self) -> Optional[Primitives]:
        """What asks; None: those held."""
        return self._asking

    @property
    def weights(self) -> GridWeights:
        """The weights that it was given, or those of the known grid; all 0 where nothing is known."""
        return values_of(GridWeights, self._struct.weights)

    def __repr__(self) -> str:
        return f"<voxtet.ForeignGrid of {self._held!r}" + (">" if self._asking is None else f", asked by {self._asking!r}>")


def _grid(held: Any, asking: Any, description: dict[str, Any]) -> ForeignGrid:
    if not isinstance(held, ForeignGrid):
        return ForeignGrid(held, asking, **description)
    if asking is not None or description:
        raise InvalidArgumentError("a ForeignGrid has its description already")
    return held


class _Answer(Plotted):
    """What the answers have in common."""

    def __init__(self, out: Any) -> None:
        self.cell_size: float = out.cell_size
        self.zone: tuple[float, float] = (out.zone_min, out.zone_max)
        self.weights = values_of(GridWeights, out.weights)
        self.warnings = _c.ForeignWarnings(out.warnings)
        self.note: str = out.note.decode("utf-8", "replace")
        self.curve = curve_of(out)

    def __repr__(self) -> str:
        note = f"; {self.note}" if self.note else ""
        return (f"<voxtet.{type(self).__name__}: cell size {self.cell_size:.6g}, good from {self.zone[0]:.6g} to "
                f"{self.zone[1]:.6g}{note}>")

    def _unit(self) -> str:
        return "seconds of a run"


class ForeignSuggestion(_Answer):
    """The cell size that costs a grid least, and the reasons for it. Costs are nanoseconds of a run.

    cell_size, zone: the best size, and (min, max) of those nearly as good. predicted_cost: at cell_size. work: what a run does
    there. terms: what that costs. weights: those that were used. rules, rule_costs: what other rules would choose, and its cost.
    rule: whose size cell_size is; ForeignRule.NONE: the minimum of the model. least_cell_size: the smallest legal size; 0: any.
    warnings: ForeignWarnings; note: the same in words, with numbers. curve: predicted costs."""

    def __init__(self, out: Any) -> None:
        super().__init__(out)
        self.predicted_cost: float = out.predicted_cost
        self.least_cell_size: float = out.least_cell_size
        self.work = values_of(GridWork, out.work)
        self.terms = terms_of(out)
        self.rules = values_of(ForeignRules, out.rules)
        self.rule_costs = values_of(ForeignRules, out.rule_costs)
        self.rule = _c.ForeignRule(out.rule)

    def _unit(self) -> str:
        return "nanoseconds of a run"

    def _draw(self, ax: Axes) -> None:
        self._draw_rules(ax, self.rules, self.rule_costs)
        super()._draw(ax)


class CostFit(_Answer):
    """Weights from timings, and the cell size that they lead to.

    weights: of the best fit, for this grid in other scenes, too. residual: root mean square of fitted / measured - 1.
    predicted_seconds: of a run at cell_size. timings: those that it was given. cell_size, zone, curve (in seconds), warnings,
    note: as of a ForeignSuggestion."""

    def __init__(self, out: Any, timings: tuple[Timing, ...]) -> None:
        super().__init__(out)
        self.residual: float = out.residual
        self.predicted_seconds: float = out.predicted_seconds
        self.timings = timings

    def _draw(self, ax: Axes) -> None:
        _draw_timings(ax, self.timings)
        super()._draw(ax)


class Tuning(_Answer):
    """What tuning found.

    seconds: of a run at cell_size, as fitted. expected_loss: how much longer a run may take than at the best cell size, as far as
    it can tell; 0.03 for 3 %. noise: how far the runs are from the fitted curve, root mean square of the relative errors.
    runs: all of them, in order. weights: for a grid that was described, else all 0. cell_size, zone, curve (in seconds),
    warnings, note: as of a ForeignSuggestion."""

    def __init__(self, out: Any) -> None:
        super().__init__(out)
        self.seconds: float = out.seconds
        self.expected_loss: float = out.expected_loss
        self.noise: float = out.noise
        self.runs = tuple(values_of(Timing, run) for run in out.runs[:out.run_count])

    def _draw(self, ax: Axes) -> None:
        _draw_timings(ax, self.runs)
        super()._draw(ax)


def _draw_timings(ax: Axes, timings: tuple[Timing, ...]) -> None:
    ran = [timing for timing in timings if math.isfinite(timing.seconds)]
    ax.plot([t.cell_size for t in ran], [t.seconds for t in ran], "o", color="C1", markersize=4, label="measured")


# ---- calls ------------------------------------------------------------------------------------------------------------


def suggest_for(held: Any, asking: Any = None, **description: Any) -> ForeignSuggestion:
    """The cell size that costs a grid least. held: a ForeignGrid; or what the arguments of ForeignGrid say: what is held, what
    asks, and known, content, look, dense, radius, least_cell_size, weights, zone_loss.

    >>> import numpy as np
    >>> points = np.random.default_rng(1).random((2000, 3))
    >>> s = suggest_for(points, known="hashed", content="centres", radius=0.1)
    >>> s.zone[0] <= s.cell_size <= s.zone[1]
    True
    >>> bool(abs(s.terms.cost.sum() / s.predicted_cost - 1) < 1e-6)
    True
    >>> suggest_for(points, radius=0.1).warnings
    <ForeignWarnings.WEIGHTS_UNKNOWN: 1>
    """
    grid, out = _grid(held, asking, description), sized(_c.vox_foreign_suggestion)
    vox.vox_suggest_for(grid._struct, out)
    return ForeignSuggestion(out)


def count_for(cell_size: float, held: Any, asking: Any = None, **description: Any) -> GridWork:
    """What a run of a grid does at one cell size. The grid: as for `suggest_for`.

    >>> import numpy as np
    >>> unit = np.eye(3)
    >>> work = count_for(0.5, Primitives.boxes(unit, unit + 1))
    >>> work.entries  # three boxes of side 1 meet 1 / 0.5 + 1 cells along each axis, on average
    81.0
    """
    grid, out = _grid(held, asking, description), _c.vox_grid_work()
    vox.vox_count_for(grid._struct, real(cell_size, "cell_size"), out)
    return values_of(GridWork, out)


def cost_fit(timings: Iterable[tuple[float, float]], held: Any, asking: Any = None, **description: Any) -> CostFit:
    """The weights of a grid from timings of whole runs, (cell size, seconds), at three different cell sizes or more, and the
    cell size that they lead to. 0.6, 1.2 and 2.4 mean edges do. The grid: as for `suggest_for`.

    >>> import numpy as np
    >>> grid = ForeignGrid(np.random.default_rng(1).random((2000, 3)), content="centres", radius=0.1)
    >>> def seconds(size):  # of a grid that needs 10 ns to look at a cell, and 2 ns to read an entry
    ...     work = count_for(size, grid)
    ...     return 1e-9 * (10 * work.visits + 2 * work.reads)
    >>> fit = cost_fit([(size, seconds(size)) for size in (0.05, 0.1, 0.2)], grid)
    >>> fit.residual < 0.05
    True
    >>> abs(fit.weights.reads - 2) < 0.4
    True
    """
    read = tuple(Timing(real(size, "a cell size"), real(seconds, "a time")) for size, seconds in timings)
    grid, out = _grid(held, asking, description), sized(_c.vox_grid_fit)
    vox.vox_cost_fit(grid._struct, (_c.vox_grid_timing * len(read))(*(_c.vox_grid_timing(*t) for t in read)), len(read), out)
    return CostFit(out, read)


def _timed(run: Callable[[float], Optional[float]], cell_size: float) -> float:
    began = time.perf_counter()
    seconds = run(cell_size)
    taken = time.perf_counter() - began
    return taken if seconds is None else real(seconds, "what run returned")


def tune(run: Callable[[float], Optional[float]], held: Any = None, asking: Any = None, *, first: float = 0.0, low: float = 0.0,
         high: float = 0.0, most_runs: int = 7, wanted_loss: float = 0.02, zone_loss: Optional[float] = None,
         **description: Any) -> Tuning:
    """The best cell size of a grid, by running it: at three sizes first, then where the fit to all runs so far is lowest or least
    sure, until that is within `wanted_loss` of the best one, as far as it can tell, or `most_runs` are made (3 to 32).

    run(cell_size) runs the grid once and returns the seconds that took; or None, and the call is timed. Infinity: it cannot run
    at this size, and others are tried. NaN or a negative number: stop, and the answer is from the runs so far. What it raises
    comes out of here, Ctrl-C too.
    The grid: as for `suggest_for`; if nothing is said of it, `first` is needed, the cell size to begin with. low, high: the sizes
    to try, an eighth to eight times the first if not given. zone_loss: as in ForeignGrid, 0.05 if not given.

    >>> tuning = tune(lambda size: 1e-3 * (size + 4 / size), first=1)
    >>> bool(1.6 < tuning.cell_size < 2.5), len(tuning.runs) <= 7
    (True, True)
    """
    if not callable(run):
        raise TypeError(f"run is of type {type(run).__name__}; it must be a function of the cell size")
    desc, out = described(_c.vox_tune_desc), sized(_c.vox_tuning)
    desc.first, desc.min, desc.max = real(first, "first"), real(low, "low"), real(high, "high")
    desc.most_runs, desc.wanted_loss = integer(most_runs, "most_runs", 0, U32), real(wanted_loss, "wanted_loss")
    grid = None
    if held is not None:
        grid = _grid(held, asking, description)
        desc.zone_loss = grid._struct.zone_loss
    elif asking is not None or description:
        raise InvalidArgumentError("a grid is described by what it holds: held is None")
    if zone_loss is not None:
        desc.zone_loss = real(zone_loss, "zone_loss")
    called = Relay(lambda size, _user: _timed(run, size), math.nan)
    with called:
        vox.vox_cost_tune(None if grid is None else grid._struct, desc, _c.vox_grid_run(called), None, out)
    return Tuning(out)
