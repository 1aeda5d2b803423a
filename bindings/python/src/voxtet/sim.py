"""Deformable bodies that fall, collide and rest (vox_sim): small and stable, for experiments and examples.

>>> import voxtet.io, voxtet.sim
>>> ball = voxtet.io.make_ball(0.5, 0.25)
>>> with voxtet.sim.Sim() as sim:
...     body = sim.add(ball.positions + [0, 0, 0.6], ball.tets, youngs_modulus=1e5)
...     for frame in range(30):
...         sim.step(1 / 60)
...     low = body.positions[:, 2].min()
>>> bool(-0.05 < low < 0.05)
True
"""

from __future__ import annotations

import ctypes
from typing import Any, Iterable, Iterator, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import DOUBLES, U32, copied_rows, indices, integer, real, switch, vector
from ._library import Handle, described, load_part, values_of
from .errors import InvalidArgumentError, InvalidHandleError, InvalidStateError
from .grid import Grid, Log
from .results import Lease, borrow_of

_sim = load_part("vox_sim")
_DOUBLE = np.dtype(np.float64)


class Energy(NamedTuple):
    """Energy and motion of a body, or of all that are not fixed (vox_sim_energy)."""

    kinetic: float
    potential: float
    elastic: float
    mass: float
    momentum: tuple[float, float, float]
    centre: tuple[float, float, float]
    max_speed: float


class _SimGrid(Grid):
    """The grid of a simulation, which closes it."""

    def close(self) -> None:
        if self._pointer is not None:
            raise InvalidStateError("the grid belongs to a simulation, which closes it")

    def clear(self) -> None:
        raise InvalidStateError("the grid belongs to a simulation: remove its bodies instead")

    def __reduce__(self) -> Any:
        raise TypeError("the grid of a simulation cannot be pickled; its snapshot() can")


def _positions(value: Any, name: str, count: Optional[int] = None) -> NDArray[np.float64]:
    rows = copied_rows(value, name)
    if count is not None and rows.length != count:
        raise InvalidArgumentError(f"there are {rows.length} {name} for {count} vertices")
    return np.ascontiguousarray(rows.array, np.float64)


class DescribedBody(NamedTuple):
    """A body as the library reads it, and the arrays that it reads."""

    desc: Any
    arrays: Any


def described_body(positions: ArrayLike, tets: ArrayLike, *, rest_positions: Optional[ArrayLike] = None,
                   velocities: Optional[ArrayLike] = None, **material: float) -> DescribedBody:
    """material: density, youngs_modulus, bulk_modulus, damping."""
    desc = described(_c.vox_sim_body_desc)
    p, t = _positions(positions, "positions"), indices(tets, "tets", 4)
    rest = None if rest_positions is None else _positions(rest_positions, "rest_positions", len(p))
    speed = None if velocities is None else _positions(velocities, "velocities", len(p))
    desc.positions, desc.vertex_count, desc.tets, desc.tet_count = p.ctypes.data, len(p), t.ctypes.data, len(t)
    desc.rest_positions = None if rest is None else rest.ctypes.data
    desc.velocities = None if speed is None else speed.ctypes.data
    for name, value in material.items():
        if name not in ("density", "youngs_modulus", "bulk_modulus", "damping"):
            raise TypeError(f"a body has no {name!r}, but density, youngs_modulus, bulk_modulus and damping")
        setattr(desc, name, real(value, name))
    return DescribedBody(desc, (p, t, rest, speed))


class Body:
    """A body of a simulation, from `Sim.add`."""

    __slots__ = ("id", "sim")

    def __init__(self, sim: Sim, id: int) -> None:
        self.sim = sim
        self.id = id

    @property
    def tag(self) -> Any:
        """Any object of yours; also that of the body's mesh in the grid."""
        return self.sim.grid._tags.get(self.id)

    @tag.setter
    def tag(self, tag: Any) -> None:
        with self.sim._lock:
            _sim.vox_sim_body_get_view(self.sim._pointer, self.id, _c.vox_sim_body_view())
            self.sim.grid._tags[self.id] = tag

    def __index__(self) -> int:
        return self.id

    def __repr__(self) -> str:
        return f"<voxtet.sim.Body {self.id}>"

    def _array(self, name: str, width: int, dtype: Any = _DOUBLE) -> Any:
        sim = self.sim
        with sim._lock:
            view = _c.vox_sim_body_view()
            _sim.vox_sim_body_get_view(sim._pointer, self.id, view)
            lease = Lease(sim._handle, sim.grid._exports_of(self.id))
            count = view.tet_count if name == "tets" else view.vertex_count
            flat = borrow_of(getattr(view, name), count * width, np.ndarray, dtype, lease)
        return flat.reshape(-1, width) if width > 1 else flat

    @property
    def positions(self) -> NDArray[np.float64]:
        """The positions, (n, 3): the simulation's own memory, read-only. Every step changes what is in it; copy it to keep a
        state. While such an array lives, the body cannot be removed nor the simulation closed (BufferError)."""
        return self._array("positions", 3)  # type: ignore[no-any-return]

    @property
    def velocities(self) -> NDArray[np.float64]:
        """The velocities, as `positions`."""
        return self._array("velocities", 3)  # type: ignore[no-any-return]

    @property
    def masses(self) -> NDArray[np.float64]:
        """The masses of the vertices, as `positions`."""
        return self._array("masses", 1)  # type: ignore[no-any-return]

    @property
    def tets(self) -> NDArray[np.uint32]:
        """The corners of the tetrahedra, (m, 4), as `positions`."""
        return self._array("tets", 4, np.dtype(np.uint32))  # type: ignore[no-any-return]

    def set_state(self, positions: Optional[ArrayLike] = None, velocities: Optional[ArrayLike] = None) -> None:
        """Sets positions and velocities, (n, 3); what is None stays."""
        sim = self.sim
        with sim._lock:
            view = _c.vox_sim_body_view()
            _sim.vox_sim_body_get_view(sim._pointer, self.id, view)
            p = None if positions is None else _positions(positions, "positions", view.vertex_count)
            v = None if velocities is None else _positions(velocities, "velocities", view.vertex_count)
            _sim.vox_sim_body_set_state(sim._pointer, self.id, None if p is None else p.ctypes.data,
                                        None if v is None else v.ctypes.data)

    @property
    def energy(self) -> Energy:
        """Energy and motion of this body."""
        return self.sim._energy(self.id)

    def remove(self) -> None:
        """Removes the body from the simulation."""
        self.sim.remove(self)


class Sim:
    """Bodies, and the grid they collide in. Arguments are those of vox_sim_desc. floor: a normal and an offset, or None."""

    def __init__(self, *, substeps: int = 10, detect_every: int = 1, gravity: ArrayLike = (0, 0, -9.81),
                 max_time_step: float = 1 / 30, floor: Optional[tuple[ArrayLike, float]] = ((0, 0, 1), 0.0),
                 friction: float = 0.5, contact_compliance: float = 0.0, max_push_speed: float = 1.0,
                 contact_slop: float = -1.0, workers: int = 1, cell_size: float = 0.0, log: Optional[Log] = None) -> None:
        self._pointer: Optional[int] = None
        grid = _SimGrid.__new__(_SimGrid)
        grid_desc, desc = described(_c.vox_grid_desc), described(_c.vox_sim_desc)
        grid._prepare(grid_desc, workers, grid_desc.byte_budget, 0, log)
        grid_desc.cell_size = real(cell_size, "cell_size")
        desc.substeps = integer(substeps, "substeps", 0, U32)
        desc.detect_every = integer(detect_every, "detect_every", 0, U32)
        desc.gravity = vector(gravity, "gravity")
        desc.floor_normal = DOUBLES() if floor is None else vector(floor[0], "the floor's normal")
        desc.floor_offset = 0.0 if floor is None else real(floor[1], "the floor's offset")
        for name, value in (("max_time_step", max_time_step), ("friction", friction), ("contact_slop", contact_slop),
                            ("contact_compliance", contact_compliance), ("max_push_speed", max_push_speed)):
            setattr(desc, name, real(value, name))
        desc.grid = ctypes.pointer(grid_desc)
        desc.log = grid_desc.log
        pointer, inside = ctypes.c_void_p(), ctypes.c_void_p()
        _sim.vox_sim_create(desc, pointer)
        self._handle: Optional[Handle] = Handle(pointer.value or 0, _sim.vox_sim_destroy, grid_desc)
        self._pointer = pointer.value
        _sim.vox_sim_get_grid(self._pointer, inside)
        grid._hold(self._handle)
        grid._pointer = inside.value
        self.grid: Grid = grid  # contacts and constraints of the last detection
        self._bodies: dict[int, None] = {}  # a set in the order of addition

    @property
    def _lock(self) -> Any:
        return self.grid._lock  # one for both

    def close(self) -> None:
        """Frees the simulation with its grid. Twice does nothing. Raises BufferError while arrays of bodies or borrowed results
        are in use."""
        if self._pointer is None:
            return
        grid = self.grid
        with self._lock:
            grid._refuse("close")
            for exports in grid._mapped.values():
                exports.refuse("close")
            self._pointer = self._handle = None
            grid._forget()

    def __enter__(self) -> Sim:
        with self._lock:
            return self

    def __exit__(self, kind: Any, *_: object) -> None:
        try:
            self.close()
        except BufferError:
            if kind is None:
                raise

    def step(self, time_step: float) -> None:
        """Moves everything forward. Other Python threads run meanwhile."""
        seconds = real(time_step, "time_step")
        with self._lock:
            self.grid._refuse("step")
            _sim.vox_sim_step(self._pointer, seconds)

    def add(self, positions: ArrayLike, tets: ArrayLike, *, rest_positions: Optional[ArrayLike] = None,
            velocities: Optional[ArrayLike] = None, density: float = 1000.0, youngs_modulus: float = 1e6,
            bulk_modulus: float = 1e6, damping: float = 0.01, fixed: bool = False, self_collision: bool = False,
            user_data: int = 0, tag: Any = None) -> Body:
        """Adds a body. All arrays are copied."""
        new = described_body(positions, tets, rest_positions=rest_positions, velocities=velocities, density=density,
                             youngs_modulus=youngs_modulus, bulk_modulus=bulk_modulus, damping=damping)
        desc = new.desc
        desc.flags = (switch(fixed, "fixed") * _c.SimBodyFlags.FIXED
                      | switch(self_collision, "self_collision") * _c.SimBodyFlags.SELF_COLLISION)
        desc.user_data = integer(user_data, "user_data")
        body = ctypes.c_uint32()
        with self._lock:
            _sim.vox_sim_body_insert(self._pointer, desc, body)
            self._bodies[body.value] = None
            if tag is not None:
                self.grid._tags[body.value] = tag
        return Body(self, body.value)

    def remove(self, body: Union[Body, int]) -> None:
        """Removes a body."""
        if isinstance(body, Body) and body.sim is not self:
            raise InvalidHandleError(f"body {body.id} is of another simulation")
        id = integer(body, "body", 0, U32)
        with self._lock:
            self.grid._refuse_positions(id, "removal of the body")
            _sim.vox_sim_body_remove(self._pointer, id)
            self._bodies.pop(id, None)
            self.grid._tags.pop(id, None)
            self.grid._mapped.pop(id, None)

    @property
    def bodies(self) -> list[Body]:
        """All bodies, in the order in which they were added."""
        with self._lock:
            return [Body(self, id) for id in self._bodies]

    def __iter__(self) -> Iterator[Body]:
        return iter(self.bodies)

    def _energy(self, id: int) -> Energy:
        out = _c.vox_sim_energy()
        with self._lock:
            _sim.vox_sim_get_energy(self._pointer, id, out)
        return values_of(Energy, out)

    @property
    def energy(self) -> Energy:
        """Energy and motion of all bodies that are not fixed."""
        return self._energy(0)

    @property
    def counters(self) -> dict[str, int]:
        """Sizes, totals, and times in nanoseconds (names that end with _ns). docs/sim.md lists them."""
        view = _c.vox_counter_view()
        with self._lock:
            _sim.vox_sim_get_counters(self._pointer, view)
            return {c.name.decode(): c.value for c in (_c.vox_counter * view.count).from_address(view.data)}


class Resolved(NamedTuple):
    """What `resolve` did and what is left (vox_resolve_report)."""

    positions: list[NDArray[np.float64]]  # of each body
    left: NDArray[Any]  # places where something is left: bodies, distance, position (vox_resolve_place)
    moves: list[float]  # of each body, the largest of a vertex
    volumes: list[tuple[float, float]]  # of each body, before and after; 0 where there is none
    inverted_tets: list[int]
    resolved: bool  # nothing is left
    first_crossings: int
    crossings: int
    inside_vertices: int
    close_pairs: int
    first_depth: float
    least_distance: float
    largest_move: float
    iterations: int


def resolve(bodies: Iterable[Any], *, gap: float = 0.0, fixed: Iterable[int] = (), max_move: float = 0.0,
            max_iterations: int = 0, workers: int = 1, places: int = 1000) -> Resolved:
    """Moves bodies and surfaces apart until nothing passes through anything (vox_resolve). A body is a pair of positions and
    tetrahedra (m, 4) or triangles (m, 3), or a mesh that has them. fixed: indices of bodies that stay. places: the most that
    `left` lists.

    >>> import voxtet.io
    >>> ball = voxtet.io.make_ball(1, 0.3)
    >>> done = resolve([(ball.positions, ball.tets), (ball.positions + [1.9, 0, 0], ball.tets)], gap=1e-3, fixed=[0])
    >>> done.resolved, done.moves[0], bool(done.moves[1] < 2 * done.first_depth)
    (True, 0.0, True)
    """
    desc, report = described(_c.vox_resolve_desc), described(_c.vox_resolve_report)
    given, stay = list(bodies), {integer(i, "fixed", 0, U32) for i in fixed}
    if stay and max(stay) >= len(given):
        raise InvalidArgumentError(f"fixed names body {max(stay)} of {len(given)}")
    list_of = (_c.vox_resolve_body * max(len(given), 1))()
    arrays: list[Any] = []
    for i, one in enumerate(given):
        points, cells = one if isinstance(one, tuple) else (one.positions, one.tets if len(one.tets) else one.triangles)
        p = _positions(points, f"positions of body {i}").copy()
        width = np.shape(cells)[-1] if np.ndim(cells) == 2 else 0
        if width not in (3, 4):
            raise InvalidArgumentError(f"body {i}: cells have the shape {np.shape(cells)}, expected (m, 3) or (m, 4)")
        c = indices(cells, f"cells of body {i}", width)
        body = list_of[i]
        body.struct_size, body.flags = ctypes.sizeof(body), int(i in stay)
        body.positions, body.vertex_count = p.ctypes.data, len(p)
        if width == 4:
            body.tets, body.tet_count = c.ctypes.data, len(c)
        else:
            body.faces, body.face_count = c.ctypes.data, len(c)
        arrays.append((p, c))
    left = np.zeros(integer(places, "places", 0, U32), _c.dtypes["vox_resolve_place"])
    desc.gap, desc.max_move = real(gap, "gap"), real(max_move, "max_move")
    desc.max_iterations, desc.worker_count = integer(max_iterations, "max_iterations", 0, U32), integer(workers, "workers", 0, U32)
    desc.places, desc.place_capacity = left.ctypes.data, len(left)
    _sim.vox_resolve(desc, ctypes.addressof(list_of), len(given), report)
    done = list_of[:len(given)]
    return Resolved([p for p, _ in arrays], left[:report.place_count], [b.largest_move for b in done],
                    [(b.volume_before, b.volume) for b in done], [b.inverted_tets for b in done], bool(report.resolved),
                    report.first_crossings, report.crossings, report.inside_vertices, report.close_pairs, report.first_depth,
                    report.least_distance, report.largest_move, report.iterations)
