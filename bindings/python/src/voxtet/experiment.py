"""The time of detection against the cell size, as in Sect. 5 of the paper: two bodies in contact, measured (vox_sim).

>>> import voxtet.io, voxtet.experiment
>>> ball = voxtet.io.make_lattice_ball(2000, 1)
>>> with voxtet.experiment.Experiment(ball, frames=2, contact_share=0.02) as experiment:
...     best = experiment.suggest().cell_size
...     sizes = best * 2 ** np.linspace(-1, 1, 7)
...     fit = voxtet.experiment.fit(sizes, experiment.sweep(sizes, rounds=2))
>>> bool(sizes[0] <= fit.cell_size <= sizes[-1])
True
"""

from __future__ import annotations

import ctypes
import threading
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import U32, integer, real, switch, vector
from ._interop import arrays_of
from ._library import Handle, described, load_part, sized, values_of
from .errors import InvalidArgumentError, InvalidStateError
from .reference import Reference, pointer_to
from .sim import described_body
from .suggest import Suggestion, suggest_desc

_sim = load_part("vox_sim")


class Facts(NamedTuple):
    """How the two bodies stand and move (vox_experiment_facts). `shares`: the share of tets in contact in each frame."""

    frames: int
    vertices: int
    tets: int
    contacts: int
    hash: int
    distance: float
    mean_share: float
    shares: tuple[float, ...]
    bounds_min: tuple[float, float, float]
    bounds_max: tuple[float, float, float]


class Sample(NamedTuple):
    """The detection of all frames at one cell size (vox_experiment_sample). `frame_ns`: nanoseconds of each frame."""

    cell_size: float
    mean_ns: float
    contacts: int
    visited_cells: int
    visited_entries: int
    candidates: int
    frame_ns: NDArray[np.uint64]


class Experiment:
    """Two bodies that touch and push each other apart, for some frames. The motion is computed once, here, and
    every sample detects the contacts of the same frames.

    a, b: pairs of positions and tets, or meshes of voxtet.io, pyvista or meshio; without b, a copy of a. b is moved along
    `axis` until the share of the tets that are in contact is `contact_share` on average, and with `turn`, both are rotated
    first. `material`: density, youngs_modulus, bulk_modulus and damping of both, as in `voxtet.sim.Sim.add`. reference and workers
    are those of the grid that is measured."""

    def __init__(self, a: Any, b: Any = None, *, frames: int = 10, axis: ArrayLike = (1, 0, 0), contact_share: float = 0.01,
                 time_step: float = 0.01, turn: bool = True, reference: Optional[Reference] = Reference(), workers: int = 1,
                 **material: float) -> None:
        self._handle: Optional[Handle] = None
        self._lock = threading.Lock()
        desc, grid = described(_c.vox_experiment_desc), described(_c.vox_grid_desc)
        bodies = [described_body(*_arrays(body), **material) for body in (a, b) if body is not None]
        desc.a = ctypes.pointer(bodies[0].desc)
        if b is not None:
            desc.b = ctypes.pointer(bodies[1].desc)
        grid.reference = pointer_to(reference)
        grid.worker_count = integer(workers, "workers", 0, U32)
        desc.grid = ctypes.pointer(grid)
        desc.frames = integer(frames, "frames", 0, U32)
        desc.axis = vector(axis, "axis")
        desc.contact_share = real(contact_share, "contact_share")
        desc.time_step = real(time_step, "time_step")
        desc.turn = switch(turn, "turn")
        pointer = ctypes.c_void_p()
        _sim.vox_experiment_create(desc, pointer)
        self._handle = Handle(pointer.value or 0, _sim.vox_experiment_destroy)
        facts = sized(_c.vox_experiment_facts)
        _sim.vox_experiment_get(self._pointer, facts)
        shares = (ctypes.c_double * facts.frames).from_address(facts.shares)
        self.facts = values_of(Facts, facts)._replace(shares=tuple(shares))

    @property
    def _pointer(self) -> int:
        handle = self._handle
        if handle is None:
            raise InvalidStateError("the experiment is closed")
        return handle.pointer

    def close(self) -> None:
        """Frees the recorded frames. Twice does nothing."""
        with self._lock:
            self._handle = None

    def __enter__(self) -> Experiment:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def suggest(self, model: Union[str, _c.CostModel] = "paper", **options: Any) -> Suggestion:
        """As `voxtet.suggest_cell_size` for the two bodies of the first frame."""
        desc, out = suggest_desc(model, options), sized(_c.vox_suggestion)
        with self._lock:
            _sim.vox_experiment_suggest(self._pointer, desc, out)
        return Suggestion(out)

    def measure(self, cell_size: float) -> Sample:
        """One sample, after a step that is not timed. Other Python threads run meanwhile, and lengthen its times."""
        size, times = real(cell_size, "cell_size"), np.empty(self.facts.frames, np.uint64)
        out = sized(_c.vox_experiment_sample)
        with self._lock:
            _sim.vox_experiment_measure(self._pointer, size, times.ctypes.data, out)
        return Sample(out.cell_size, out.mean_ns, out.contacts, out.visited_cells, out.visited_entries, out.candidates, times)

    def sweep(self, cell_sizes: ArrayLike, rounds: int = 7, seed: int = 1) -> NDArray[np.float64]:
        """Nanoseconds of a frame at each of the cell sizes, by the median over the rounds. Each round measures them in another
        order, so that a disturbance of the machine does not always meet the same ones."""
        sizes = _doubles(cell_sizes, "cell_sizes")
        count, seed = integer(rounds, "rounds", 1, U32), integer(seed, "seed")
        samples = np.empty((len(sizes), count, self.facts.frames), np.uint64)
        order = np.empty(len(sizes), np.uint64)
        for number in range(count):
            _sim.vox_experiment_order(len(order), seed, number, order.ctypes.data)
            for i in order.tolist():
                samples[i, number] = self.measure(float(sizes[i])).frame_ns
        times, time = np.empty(len(sizes)), ctypes.c_double()
        for i, of_size in enumerate(samples):
            _sim.vox_experiment_time(of_size.ctypes.data, count, self.facts.frames, time)
            times[i] = time.value
        return times


class Fit:
    """A polynomial in the logarithm of the cell size, fitted to the logarithms of times (vox_time_fit). The least time
    is at `cell_size`; `bracketed`: it is not at an end of `range`. `prediction_error` is roughly a relative error."""

    def __init__(self, out: Any) -> None:
        self._struct = out
        self.degree: int = out.degree
        self.range: tuple[float, float] = (out.range_min, out.range_max)
        self.coefficients: tuple[float, ...] = tuple(out.coefficients[:out.degree + 1])
        self.r_squared: float = out.r_squared
        self.prediction_error: float = out.prediction_error
        self.cell_size: float = out.cell_size
        self.time: float = out.time
        self.bracketed = bool(out.bracketed)

    def __repr__(self) -> str:
        return (f"<voxtet.experiment.Fit: time {self.time:.6g} at cell size {self.cell_size:.6g}, degree {self.degree}, "
                f"prediction error {self.prediction_error:.2g}>")

    def time_at(self, cell_size: float) -> float:
        """The fitted time at a cell size of the range."""
        time = ctypes.c_double()
        _sim.vox_fit_time_at(self._struct, real(cell_size, "cell_size"), time)
        return time.value

    def zone(self, limit: float) -> tuple[float, float]:
        """The cell sizes around the best one between which the fitted time is at most `limit`."""
        low, high = ctypes.c_double(), ctypes.c_double()
        _sim.vox_fit_zone(self._struct, real(limit, "limit"), low, high)
        return low.value, high.value


def fit(cell_sizes: ArrayLike, times: ArrayLike) -> Fit:
    """Fits times, in any unit, to cell sizes, of which five at least differ.

    >>> sizes = np.geomspace(0.1, 10, 9)
    >>> found = fit(sizes, sizes + 4 / sizes)
    >>> abs(found.cell_size - 2) < 0.1, found.bracketed
    (True, True)
    """
    sizes, values, out = _doubles(cell_sizes, "cell_sizes"), _doubles(times, "times"), sized(_c.vox_time_fit)
    if len(sizes) != len(values):
        raise InvalidArgumentError(f"there are {len(values)} times for {len(sizes)} cell sizes")
    _sim.vox_fit_times(sizes.ctypes.data, values.ctypes.data, len(sizes), out)
    return Fit(out)


def _arrays(body: Any) -> tuple[Any, Any]:
    if isinstance(body, (tuple, list)) and len(body) == 2:
        return body[0], body[1]
    return arrays_of(body)[:2]


def _doubles(values: ArrayLike, name: str) -> NDArray[np.float64]:
    array = np.asarray(values)
    if array.dtype.kind not in "iuf" or array.ndim != 1:
        raise TypeError(f"{name} must be a sequence of numbers")
    return np.ascontiguousarray(array, np.float64)
