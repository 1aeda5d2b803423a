"""The cell size that a cost model predicts to be best, and why; and the same method for algorithms of your own."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import choice, integer, real, switch, weights_pointer
from ._library import Relay, described, sized, values_of, vox
from .errors import InvalidArgumentError
from .mesh import Topology
from .results import Records, record_type

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .grid import Grid

_Records = TypeVar("_Records", bound=Records)


class Curve(Records):
    """A predicted cost at ascending cell sizes, evenly spaced in the logarithm."""

    cell_size: NDArray[np.float64]
    cost: NDArray[np.float64]


class Terms(Records):
    """Kinds of work: how often each is done at the suggested cell size, and what that costs."""

    name: NDArray[np.str_]
    count: NDArray[np.float64]
    cost: NDArray[np.float64]


class Rules(Records):
    """Cell sizes that rules of thumb give, 0 where a rule does not apply, and the predicted costs there, 0 where unknown."""

    name: NDArray[np.str_]
    cell_size: NDArray[np.float64]
    cost: NDArray[np.float64]


class Timings(Records):
    """Runs at cell sizes, and how long each took; infinity where it was impossible."""

    cell_size: NDArray[np.float64]
    seconds: NDArray[np.float64]


class ForeignWeights(NamedTuple):
    """How many nanoseconds a foreign grid takes for each kind of work (vox_foreign_weights)."""

    run: float = 0.0  # for a run, whatever the cell size
    store: float = 0.0  # to store a primitive in a cell
    visit: float = 0.0  # to visit a cell in a query
    found: float = 0.0  # extra, to visit a cell that is not empty
    read: float = 0.0  # to read a primitive in a visited cell
    occupied: float = 0.0  # to create and drop a cell that is not empty
    cell: float = 0.0  # to clear a cell of a dense grid


class Geometry(NamedTuple):
    """Sizes in meshes, of all together (vox_geometry)."""

    vertices: int
    tets: int
    edges: int
    facets: int
    boundary_facets: int
    degenerate_tets: int
    mean_edge: float
    mean_longest_edge: float
    mean_box_side: float
    median_box_side: float
    mean_facet_area: float
    mean_tet_facet_area: float
    mean_boundary_facet_area: float
    mean_volume: float
    bounds_min: tuple[float, float, float]
    bounds_max: tuple[float, float, float]


def _plain(kind: type[_Records], items: Any, count: int) -> _Records:
    """Structs of numbers as records."""
    return np.ctypeslib.as_array(items)[:count].astype(record_type(items._type_.__name__)).view(kind)


def _named(kind: type[_Records], items: Any, count: int) -> _Records:
    """Structs of a name and two numbers as records."""
    _, first, second = (name for name, _ in items._type_._fields_)
    rows = [(item.name.decode(), getattr(item, first), getattr(item, second)) for item in items[:count]]
    width = max((len(name) for name, *_ in rows), default=1)
    dtype = np.dtype((np.record, [("name", f"U{width}"), (first, "f8"), (second, "f8")]))
    return np.array(rows, dtype).view(kind)


class CellSizeResult:
    """A cell size and the reasons for it. What a function does not know is 0 or empty.

    cell_size, zone: the best size, and (min, max) of those nearly as good. cost: predicted at cell_size: seconds of a step or a
    run, for the model "paper" visits of cells per tetrahedron, for `minimise` what its function gives. min_cell_size: the smallest
    that gives right answers, or fits the byte budget; 0: any. cells_per_axis: edge of the world divided by cell_size. curve:
    predicted costs. terms: kinds of work, whose costs add up to `cost`. rules: what rules of thumb would choose.
    warnings: CellSizeWarnings; note: the same in words, with numbers.
    Of foreign grids: weights: those used, or those found by `fit` and `tune`. fit_error: root mean square of fitted / measured - 1.
    timings: the runs of `tune`, in order. expected_loss: how much longer one may take than at the best cell size; 0.03 for 3 %."""

    def __init__(self, out: Any, unit: str = "seconds") -> None:
        self.cell_size: float = out.cell_size
        self.zone: tuple[float, float] = (out.zone_min, out.zone_max)
        self.cost: float = out.cost
        self.min_cell_size: float = out.min_cell_size
        self.cells_per_axis: float = out.cells_per_axis
        self.fit_error: float = out.fit_error
        self.expected_loss: float = out.expected_loss
        self.curve = _plain(Curve, out.curve, out.curve_count)
        self.terms = _named(Terms, out.terms, out.term_count)
        self.rules = _named(Rules, out.rules, out.rule_count)
        self.timings = _plain(Timings, out.timings, out.timing_count)
        self.weights = values_of(ForeignWeights, out.weights)
        self.warnings = _c.CellSizeWarnings(out.warnings)
        self.note: str = out.note.decode("utf-8", "replace")
        self._unit = unit

    def __repr__(self) -> str:
        note = f"; {self.note}" if self.note else ""
        return f"<voxtet.CellSizeResult: cell size {self.cell_size:.6g}, good from {self.zone[0]:.6g} to {self.zone[1]:.6g}{note}>"

    def plot(self, ax: Optional[Axes] = None) -> Axes:
        """Draws the curve of predicted costs with matplotlib, into `ax` or into new axes, which are returned."""
        if ax is None:
            from matplotlib import pyplot
            ax = pyplot.figure().add_subplot()
        self._draw(ax)
        return ax

    def _draw(self, ax: Axes) -> None:
        for rule in self.rules[(self.rules.cell_size > 0) & (self.rules.cost > 0)]:
            ax.plot([rule.cell_size], [rule.cost], "o", markersize=4, label=rule.name)
        ran = self.timings[np.isfinite(self.timings.seconds)]
        if len(ran):
            ax.plot(ran.cell_size, ran.seconds, "o", color="C1", markersize=4, label="measured")
        ax.loglog(self.curve.cell_size, self.curve.cost, color="C0")
        ax.axvspan(*self.zone, color="C0", alpha=0.15, label=f"zone {self.zone[0]:.3g} to {self.zone[1]:.3g}")
        ax.axvline(self.cell_size, color="C0", linestyle="--", label=f"suggested {self.cell_size:.4g}")
        ax.set_xlabel("cell size")
        ax.set_ylabel(self._unit)
        ax.legend()

    def _repr_png_(self) -> Optional[bytes]:
        """For notebooks; nothing where matplotlib is not installed."""
        try:
            from matplotlib.backends.backend_agg import FigureCanvasAgg
            from matplotlib.figure import Figure
        except ImportError:
            return None
        figure = Figure(figsize=(6, 4), layout="tight")
        FigureCanvasAgg(figure)
        self._draw(figure.add_subplot())
        png = io.BytesIO()
        figure.savefig(png, format="png")
        return png.getvalue()


_REALS = ("p_nc", "cost_ratio", "world_edge", "zone_loss")


def suggest_desc(model: Union[str, _c.CostModel], options: dict[str, Any]) -> Any:
    """The struct of the options."""
    desc = described(_c.vox_cell_size_desc)
    desc.model = choice(_c.CostModel, model, "model")
    for name, value in options.items():
        if name in _REALS:
            setattr(desc, name, real(value, name))
        elif name == "byte_budget":
            desc.byte_budget = integer(value, name)
        elif name == "dense":
            desc.reference_flags = switch(value, name) * _c.ReferenceFlags.DENSE
        elif name == "weights":
            desc.weights = weights_pointer(value)
        else:
            raise TypeError(f"there is no option {name!r}; those of vox_cell_size_desc are {', '.join(_REALS)}, "
                            "byte_budget, dense, weights")
    return desc


class _Scene:
    """Meshes as an array of descriptions."""

    def __init__(self, positions: Any, tets: Any, self_collision: bool) -> None:
        if tets is None:
            pairs = list(positions)
            if not all(isinstance(pair, (tuple, list)) and len(pair) == 2 for pair in pairs):
                raise TypeError("without tets, the meshes must be pairs of positions and tets")
        else:
            pairs = [(positions, tets)]
        self.topologies = [Topology(p, t, None, False, None, False) for p, t in pairs]
        if self_collision:
            for topology in self.topologies:
                topology.desc.filter.flags |= _c.FilterFlags.SELF_COLLISION
        self.array = (_c.vox_mesh_desc * len(pairs))(*(t.desc for t in self.topologies))

    def __len__(self) -> int:
        return len(self.topologies)


def _result(desc: Any, out: Any) -> CellSizeResult:
    paper = desc is not None and desc.model == _c.CostModel.PAPER
    return CellSizeResult(out, "cell visits a tetrahedron" if paper else "seconds of a step")


def suggest_cell_size(positions: Any, tets: Optional[ArrayLike] = None, *, model: Union[str, _c.CostModel] = "paper",
                      self_collision: bool = False, **options: Any) -> CellSizeResult:
    """The cell size that minimises a cost model for a mesh, or for several: `suggest_cell_size([(p, t), (q, u)])`.

    model: "paper", "reference", "fast" or "surface". options: the other fields of vox_cell_size_desc, e.g. zone_loss, p_nc,
    weights=calibrate().

    >>> import numpy as np
    >>> cube = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
    >>> s = suggest_cell_size(cube, [[0, 1, 2, 3], [1, 2, 3, 4]])
    >>> s.zone[0] < s.cell_size < s.zone[1]
    True
    """
    desc, scene, out = suggest_desc(model, options), _Scene(positions, tets, self_collision), sized(_c.vox_cell_size_result)
    vox.vox_suggest_cell_size(desc, scene.array, len(scene), out)
    return _result(desc, out)


def measure_geometry(positions: Any, tets: Optional[ArrayLike] = None) -> Geometry:
    """Sizes in a mesh, or in several, which are given as for `suggest_cell_size`. Above 200,000 tetrahedra, means are estimated
    from samples.

    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    >>> measure_geometry(corners, [[0, 1, 2, 3]]).mean_box_side
    1.0
    """
    scene, out = _Scene(positions, tets, False), sized(_c.vox_geometry)
    vox.vox_measure_geometry(scene.array, len(scene), out)
    return values_of(Geometry, out)


def suggest_for_grid(grid: Grid, model: Union[str, _c.CostModel, None], options: dict[str, Any]) -> CellSizeResult:
    """As `Grid.suggest_cell_size`."""
    if model is None and options:
        raise InvalidArgumentError("options of a suggestion need a model")
    desc, out = None if model is None else suggest_desc(model, options), sized(_c.vox_cell_size_result)
    with grid._lock:
        vox.vox_grid_suggest_cell_size(grid._pointer, desc, out)
    return _result(desc, out)


def calibrate() -> NDArray[np.float64]:
    """Measures the weights of the models "reference" and "fast" on this machine, in about ten milliseconds: nanoseconds of
    one unit of each piece of work, in the library's own order. For `weights` of a suggestion and of a `Reference`."""
    out = sized(_c.vox_cost_weights)
    vox.vox_cost_calibrate(out)
    return np.array(out.ns)


def minimise(cost: Callable[[float], float], low: float, high: float, *, zone_loss: float = 0.05) -> CellSizeResult:
    """The cell size from low to high of least cost, for an algorithm of your own. `cost` is a function of the cell size.

    >>> round(minimise(lambda size: size + 4 / size, 0.1, 100).cell_size, 3)
    2.0
    """
    out, called = sized(_c.vox_cell_size_result), Relay(lambda size, _user: float(cost(size)), math.nan)
    with called:
        vox.vox_cost_minimise(_c.vox_cost_function(called), None, real(low, "low"), real(high, "high"),
                              real(zone_loss, "zone_loss"), out)
    return CellSizeResult(out, "cost")
