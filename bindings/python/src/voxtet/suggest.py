"""The cell size that a cost model predicts to be best, and why; and the same method for algorithms of your own."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional, Union

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

_DTYPE_SAMPLE = record_type("vox_cost_sample")
_DTYPE_TERM = np.dtype((np.record, [("name", "U24"), ("count", "f8"), ("cost", "f8"), ("share", "f8")]))


class Curve(Records):
    """A predicted cost at ascending cell sizes, evenly spaced in the logarithm."""

    cell_size: NDArray[np.float64]
    cost: NDArray[np.float64]


class Terms(Records):
    """Terms of a cost: a piece of work, how often it is done, what that costs, and its share of the whole."""

    name: NDArray[np.str_]
    count: NDArray[np.float64]
    cost: NDArray[np.float64]
    share: NDArray[np.float64]


class Rules(NamedTuple):
    """Cell sizes that other rules would choose, or their predicted costs; 0 where a rule does not apply."""

    mean_edge: float  # Teschner et al. 2003
    mean_edge_multiple: float  # Gregory et al. 2000
    object_512: float  # Garcia-Alonso et al. 1994
    resolution: float  # McNeely et al. 1999
    mean_volume: float
    median_box_side: float  # IPC Toolkit


class Stats(NamedTuple):
    """Geometry of all meshes together (vox_geometry_stats)."""

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


def curve_of(out: Any) -> Curve:
    """The curve of an answer of the library."""
    return np.ctypeslib.as_array(out.curve)[:out.curve_count].astype(_DTYPE_SAMPLE).view(Curve)


def terms_of(out: Any) -> Terms:
    """The terms of an answer of the library."""
    return np.array([(t.name.decode(), t.count, t.cost, t.share) for t in out.terms[:out.term_count]],
                    _DTYPE_TERM).view(Terms)


class Plotted:
    """Draws a cost curve with its minimum and zone."""

    cell_size: float
    zone: tuple[float, float]
    curve: Curve

    def _unit(self) -> str:
        return "cost"

    def plot(self, ax: Optional[Axes] = None) -> Axes:
        """Draws the curve of predicted costs with matplotlib, into `ax` or into new axes, which are returned."""
        if ax is None:
            from matplotlib import pyplot
            ax = pyplot.figure().add_subplot()
        self._draw(ax)
        return ax

    def _draw(self, ax: Axes) -> None:
        ax.loglog(self.curve.cell_size, self.curve.cost, color="C0")
        ax.axvspan(*self.zone, color="C0", alpha=0.15, label=f"zone {self.zone[0]:.3g} to {self.zone[1]:.3g}")
        ax.axvline(self.cell_size, color="C0", linestyle="--", label=f"suggested {self.cell_size:.4g}")
        ax.set_xlabel("cell size")
        ax.set_ylabel(self._unit())
        ax.legend()

    @staticmethod
    def _draw_rules(ax: Axes, rules: Any, costs: Any) -> None:
        for name, size, cost in zip(rules._fields, rules, costs):
            if size > 0 and cost > 0:
                ax.plot([size], [cost], "o", markersize=4, label=name.replace("_", " "))

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


class Suggestion(Plotted):
    """A cell size and the reasons for it. Costs are in cell visits for each tetrahedron (paper), or nanoseconds of a
    step."""

    def __init__(self, out: Any) -> None:
        self.model = _c.CostModel(out.model)
        self.cell_size: float = out.cell_size
        self.cells_per_axis: float = out.cells_per_axis
        self.zone: tuple[float, float] = (out.zone_min, out.zone_max)
        self.predicted_cost: float = out.predicted_cost
        self.rules = values_of(Rules, out.rules)
        self.rule_costs = values_of(Rules, out.rule_costs)
        self.stats = values_of(Stats, out.stats)
        self.curve = curve_of(out)
        self.terms = terms_of(out)
        self.budget_cell_size: float = out.budget_cell_size
        self.uniform_loss: float = out.uniform_loss
        self.levels: tuple[float, ...] = tuple(out.levels[:out.level_count])

    def __repr__(self) -> str:
        return (f"<voxtet.Suggestion: cell size {self.cell_size:.6g}, good from {self.zone[0]:.6g} to {self.zone[1]:.6g}, "
                f"by the model {self.model.name.lower()}>")

    def _unit(self) -> str:
        return "cell visits a tetrahedron" if self.model == _c.CostModel.PAPER else "nanoseconds of a step"

    def _draw(self, ax: Axes) -> None:
        self._draw_rules(ax, self.rules, self.rule_costs)
        super()._draw(ax)


class Minimum(Plotted):
    """The cell size of least cost, and the zone around it."""

    def __init__(self, out: Any) -> None:
        self.cell_size: float = out.cell_size
        self.cost: float = out.cost
        self.zone: tuple[float, float] = (out.zone_min, out.zone_max)
        self.curve = curve_of(out)

    def __repr__(self) -> str:
        return (f"<voxtet.Minimum: cell size {self.cell_size:.6g}, cost {self.cost:.6g}, zone {self.zone[0]:.6g} to "
                f"{self.zone[1]:.6g}>")


_REALS = ("p_nc", "cost_ratio", "world_edge", "zone_loss", "mean_edge_factor", "resolution")


def suggest_desc(model: Union[str, _c.CostModel], options: dict[str, Any]) -> Any:
    """The struct of the options."""
    desc = described(_c.vox_suggest_desc)
    desc.model = choice(_c.CostModel, model, "model")
    for name, value in options.items():
        if name in _REALS:
            setattr(desc, name, real(value, name))
        elif name == "byte_budget":
            desc.byte_budget = integer(value, name)
        elif name == "dense":
            desc.reference_flags = switch(value, name) * _c.ReferenceFlags.DENSE
        elif name == "size_reading":
            desc.size_reading = choice(_c.SizeReading, value, name)
        elif name == "area_reading":
            desc.area_reading = choice(_c.AreaReading, value, name)
        elif name == "weights":
            desc.weights = weights_pointer(value)
        else:
            raise TypeError(f"there is no option {name!r}; those of vox_suggest_desc are {', '.join(_REALS)}, byte_budget, "
                            "dense, size_reading, area_reading, weights")
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


def suggest_cell_size(positions: Any, tets: Optional[ArrayLike] = None, *, model: Union[str, _c.CostModel] = "paper",
                      self_collision: bool = False, **options: Any) -> Suggestion:
    """The cell size that minimises a cost model for a mesh, or for several: `suggest_cell_size([(p, t), (q, u)])`.

    model: "paper", "reference", "fast" or "surface". options: the other fields of vox_suggest_desc, e.g. zone_loss, p_nc,
    size_reading="mean_edge", weights=calibrate().

    >>> import numpy as np
    >>> cube = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
    >>> s = suggest_cell_size(cube, [[0, 1, 2, 3], [1, 2, 3, 4]])
    >>> s.zone[0] < s.cell_size < s.zone[1]
    True
    """
    desc, scene, out = suggest_desc(model, options), _Scene(positions, tets, self_collision), sized(_c.vox_suggestion)
    vox.vox_suggest_cell_size(desc, scene.array, len(scene), out)
    return Suggestion(out)


def suggest_for_grid(grid: Grid, model: Union[str, _c.CostModel, None], options: dict[str, Any]) -> Suggestion:
    """As `Grid.suggest_cell_size`."""
    if model is None and options:
        raise InvalidArgumentError("options of a suggestion need a model")
    desc, out = None if model is None else suggest_desc(model, options), sized(_c.vox_suggestion)
    with grid._lock:
        vox.vox_grid_suggest_cell_size(grid._pointer, desc, out)
    return Suggestion(out)


def calibrate() -> NDArray[np.float64]:
    """Measures the weights of the models "reference" and "fast" on this machine, in about ten milliseconds: nanoseconds of
    one unit of each piece of work, in the library's own order. For `weights` of a suggestion and of a `Reference`."""
    out = sized(_c.vox_cost_weights)
    vox.vox_cost_calibrate(out)
    return np.array(out.ns)


def minimise(cost: Callable[[float], float], low: float, high: float, *, zone_loss: float = 0.05) -> Minimum:
    """The cell size from low to high of least cost, for an algorithm of your own. `cost` is a function of the cell size.

    >>> round(minimise(lambda size: size + 4 / size, 0.1, 100).cell_size, 3)
    2.0
    """
    out, called = sized(_c.vox_cost_minimum), Relay(lambda size, _user: float(cost(size)), math.nan)
    with called:
        vox.vox_cost_minimise(_c.vox_cost_function(called), None, real(low, "low"), real(high, "high"),
                              real(zone_loss, "zone_loss"), out)
    return Minimum(out)
