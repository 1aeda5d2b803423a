"""A grid: meshes that collide, the step that finds their contacts, and what it found."""

from __future__ import annotations

import _thread
import ctypes
import html
import logging
import threading
import weakref
from typing import TYPE_CHECKING, Any, Callable, Iterable, Iterator, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c, results
from ._interop import body_of, is_mesh
from ._arguments import U32, Rows, integer, matrix, real, switch
from ._library import Handle, described, sized, vox
from .body import Body, Filter
from .errors import InvalidArgumentError, InvalidHandleError, InvalidStateError, VoxError
from .mesh import Mesh, Topology
from .reference import Reference, pointer_to
from .results import Borrowed, Exports, Results, copy_of, hits_of
from .shapes import FieldCall, Geometry, Shape
from .suggest import CellSizeResult, suggest_for_grid

if TYPE_CHECKING:
    from .locate import Locator

ALL_CORES = _c.VOX_ALL_CORES
Log = Callable[[int, str], Any]
_LEVELS: dict[int, int] = {_c.LogLevel.INFO: logging.INFO, _c.LogLevel.WARNING: logging.WARNING}
_step = vox.vox_grid_step


class Failure(NamedTuple):
    """A mesh that made a step fail, or that it left out."""

    result: _c.Result
    body: int
    user_data: int
    vertex: Optional[int]  # the first with a bad coordinate; None if the failure is about none
    position: tuple[float, float, float]


class _Closed:
    """Stands for the lock of a closed grid."""

    def __enter__(self) -> None:
        raise InvalidStateError("the grid is closed")

    def __exit__(self, *_: object) -> None:
        pass


class _InLog:
    """Stands for the lock while the log is written: a log function that calls its grid would wait for itself."""

    def __init__(self, lock: Any) -> None:
        self._lock, self._thread = lock, threading.get_ident()

    def __enter__(self) -> None:
        if threading.get_ident() == self._thread:
            raise InvalidStateError("a log function must not call the grid it came from")
        self._lock.acquire()

    def __exit__(self, *_: object) -> None:
        self._lock.release()


class _Lending:
    """Keeps arrays while the library begins to borrow them. Python raises KeyboardInterrupt as soon as the library has
    returned, before the grid has noted whose they are: then they stay kept, as long as the grid's meshes."""

    def __init__(self, lent: list[Any], arrays: Any) -> None:
        self._lent, self._arrays = lent, arrays

    def __enter__(self) -> None:
        self._lent.append(self._arrays)

    def __exit__(self, kind: Any, *_: object) -> None:
        if kind is None or issubclass(kind, Exception):
            self._lent.pop()


def _log_function(grid: Grid, log: Log) -> Any:
    """`log` as the library calls it, maybe on another thread. An exception in it is reported and goes no further."""
    itself = weakref.ref(grid)

    def write(level: int, text: bytes, _user: Any) -> None:
        grid = itself()
        lock = grid and grid._lock
        try:
            if grid is not None:
                grid._lock = _InLog(lock)
            log(_LEVELS.get(level, level), text.decode("utf-8", "replace"))
        except KeyboardInterrupt:
            _thread.interrupt_main()  # once more, where it can be raised
        finally:
            if grid is not None:
                grid._lock = lock

    return _c.vox_log_write(write)


class Grid(Results):
    """A set of meshes, and of rigid shapes, that collide. `step` finds all contacts of their positions as they are then.

    cell_size, worker_count (`workers`: 0 or 1 thread, or ALL_CORES), margin, byte budget and
    max_constraints_per_pair (0: all) are those of vox_grid_desc;
    constraints, edges and skip_bad_bodies its flags; `reference` chooses the paper's engine in place of the fast one. `log` is
    called with a level of `logging` and a text; `logging.getLogger("voxtet").log` is one.

    Arrays that a grid returns are copies of yours. Any thread may use a grid; one at a time does. `with Grid() as grid:`
    closes it at the end.

    >>> import numpy as np
    >>> tet = [[0, 1, 2, 3]]
    >>> first = np.array([[5, 5, 5], [6, 5, 5], [5, 6, 5], [.2, .3, .4]], np.float32)
    >>> second = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    >>> with Grid() as grid:
    ...     a, b = grid.add(first, tet, tag="a"), grid.add(second, tet, tag="b")
    ...     grid.step()
    ...     for c in grid.contacts:
    ...         print("vertex", c.vertex, "of", grid[c.body_a].tag, "in tet", c.tet, "of", grid[c.body_b].tag)
    vertex 3 of a in tet 0 of b
    """

    def __init__(self, cell_size: float = 0.0, *, workers: int = 1, reference: Optional[Reference] = None, byte_budget: int = 0,
                 constraints: bool = False, edges: bool = False, skip_bad_bodies: bool = False, margin: float = 0.0,
                 max_constraints_per_pair: int = 0, log: Optional[Log] = None, **unknown: Any) -> None:
        for name in unknown:
            threads = "; the threads of a step are `workers`" if name in ("threads", "num_threads", "n_jobs", "thread_count") else ""
            raise TypeError(f"Grid() has no argument {name!r}{threads}")
        desc = described(_c.vox_grid_desc)
        desc.cell_size = real(cell_size, "cell_size")
        desc.reference = pointer_to(reference)
        desc.flags = _changed(0, constraints=constraints, edges=edges, skip_bad_bodies=skip_bad_bodies)
        desc.max_constraints_per_pair = integer(max_constraints_per_pair, "max_constraints_per_pair", 0, U32)
        self._prepare(desc, workers, byte_budget, margin, log)
        pointer = ctypes.c_void_p()
        vox.vox_grid_create(desc, pointer)
        self._hold(Handle(pointer.value or 0, vox.vox_grid_destroy, desc))

    def _prepare(self, desc: Any, workers: int, byte_budget: int, margin: float, log: Optional[Log]) -> None:
        """The settings that a snapshot does not hold."""
        self._pointer: Optional[int] = None
        self._lock: Any = threading.Lock()
        desc.worker_count = integer(workers, "workers", 0, U32)
        desc.byte_budget = integer(byte_budget, "byte_budget")
        desc.margin = real(margin, "margin")
        self._settings = {"workers": desc.worker_count, "byte_budget": desc.byte_budget, "margin": desc.margin}
        if log is not None:
            if not callable(log):
                raise TypeError(f"log is of type {type(log).__name__}; it must be a function of a level and a text")
            desc.log = ctypes.pointer(_c.vox_log(_log_function(self, log)))

    def _hold(self, handle: Handle) -> None:
        self._handle: Optional[Handle] = handle
        self._pointer = handle.pointer
        # By id: the arrays that the mesh borrows (positions, previous, tets), and the caller's tags. Meshes themselves are
        # made when asked for, so that nothing here refers to the grid, and a grid that is dropped goes at once.
        self._kept: dict[int, dict[str, Any]] = {}
        self._lent: list[Any] = []
        self._tags: dict[int, Any] = {}
        self._borrowed = Exports()
        self._borrowed_constraints = Exports()
        self._mapped: dict[int, Exports] = {}
        self._fields: dict[int, FieldCall] = {}  # that steps call
        self._kinds: dict[int, int] = {}  # ShapeKind by id, of bodies that were asked

    # ---- life ----

    def close(self) -> None:
        """Frees the grid's memory. Twice does nothing. Raises BufferError while borrowed arrays are in use."""
        if self._pointer is None:
            return
        with self._lock:
            self._refuse("close")
            for exports in self._mapped.values():
                exports.refuse("close")
            self._forget()

    def _forget(self) -> None:
        self._pointer = self._handle = None
        self._kept, self._lent, self._tags, self._mapped, self._fields = {}, [], {}, {}, {}
        self._lock = _Closed()

    @property
    def closed(self) -> bool:
        """Whether the grid was closed."""
        return self._pointer is None

    def __enter__(self) -> Grid:
        with self._lock:
            return self

    def __exit__(self, kind: Any, *_: object) -> None:
        try:
            self.close()
        except BufferError:
            if kind is None:
                raise  # otherwise the exception on its way says more, and its traceback may be what holds the arrays

    def __repr__(self) -> str:
        if self._pointer is None:
            return "<voxtet.Grid, closed>"
        shapes = len(self._ids()) - len(self)
        return f"<voxtet.Grid of {len(self)} meshes{f' and {shapes} shapes' if shapes else ''}>"

    def _repr_html_(self) -> str:
        """For notebooks: the meshes by their tags."""
        if self._pointer is None:
            return html.escape(repr(self))
        columns = ("mesh", "tag", "vertices", "tets", "")
        rows = []
        for mesh in self.meshes[:results.SHOWN]:
            info = mesh.info
            rows.append((mesh.id, "" if mesh.tag is None else repr(mesh.tag), info.vertex_count, info.enabled_tet_count,
                         "" if info.enabled else "disabled"))
        return results.html_table(repr(self), columns, rows)

    def clear(self) -> None:
        """Removes all meshes and contacts, and keeps the settings."""
        with self._lock:
            self._refuse("clear")
            for exports in self._mapped.values():
                exports.refuse("clear")
            vox.vox_grid_clear(self._pointer)
            self._kept, self._lent, self._tags, self._mapped, self._fields = {}, [], {}, {}, {}

    def reserve(self, mesh_count: int, contact_count: int) -> None:
        """Allocates the memory for so many meshes and contacts in advance."""
        meshes, contacts = integer(mesh_count, "mesh_count", 0, U32), integer(contact_count, "contact_count")
        with self._lock:
            self._refuse("reserve")
            vox.vox_grid_reserve(self._pointer, meshes, contacts)

    def prepare(self) -> None:
        """Makes now what steps make of a mesh once, when they first need it."""
        with self._lock:
            vox.vox_grid_prepare(self._pointer)

    def _refuse(self, what: str) -> None:
        if self._borrowed:
            self._borrowed.refuse(what)
        if self._borrowed_constraints:
            self._borrowed_constraints.refuse(what)

    def _refuse_positions(self, mesh: int, what: str) -> None:
        exports = self._mapped.get(mesh)
        if exports is not None:
            exports.refuse(what)

    def _exports_of(self, mesh: int) -> Exports:
        return self._mapped.setdefault(mesh, Exports())

    def _keep(self, mesh: int, **arrays: Any) -> None:
        """Remembers what a mesh borrows, and forgets what it borrowed before."""
        self._kept.setdefault(mesh, {}).update(arrays)

    def _keeps(self, mesh: int, what: str) -> Any:
        return self._kept.get(mesh, {}).get(what)

    def _lending(self, arrays: Any) -> _Lending:
        return _Lending(self._lent, arrays)

    # ---- settings ----

    def _info(self) -> Any:
        """The state of the grid, for a caller that has the lock."""
        out = sized(_c.vox_grid_info)
        vox.vox_grid_get_info(self._pointer, out)
        return out

    @property
    def cell_size(self) -> float:
        """The cell size in use. Set it for the following steps; 0: the library chooses. It never changes the contacts."""
        with self._lock:
            return float(self._info().cell_size)

    @cell_size.setter
    def cell_size(self, cell_size: float) -> None:
        size = real(cell_size, "cell_size")
        with self._lock:
            vox.vox_grid_set_cell_size(self._pointer, size)

    @property
    def workers(self) -> int:
        """Threads of a step; 0: one for each core."""
        return int(self._settings["workers"])

    @workers.setter
    def workers(self, workers: int) -> None:
        count = integer(workers, "workers", 0, U32)
        with self._lock:
            vox.vox_grid_set_worker_count(self._pointer, count)
            self._settings["workers"] = count

    @property
    def margin(self) -> float:
        """How far from a surface the following steps find PROXIMITY constraints. Experimental."""
        with self._lock:
            return float(self._info().margin)

    @margin.setter
    def margin(self, margin: float) -> None:
        distance = real(margin, "margin")
        with self._lock:
            self._refuse("a change of the margin")
            vox.vox_grid_set_margin(self._pointer, distance)
            self._settings["margin"] = distance

    def set_flags(self, *, constraints: Optional[bool] = None, edges: Optional[bool] = None,
                  skip_bad_bodies: Optional[bool] = None) -> None:
        """Changes what the following steps do; what is None stays."""
        with self._lock:
            before = self._info().flags
            flags = _changed(before, constraints=constraints, edges=edges, skip_bad_bodies=skip_bad_bodies)
            if flags != before:
                self._refuse("a change of the flags")
            vox.vox_grid_set_flags(self._pointer, flags)

    @property
    def flags(self) -> _c.GridFlags:
        """What the steps do."""
        with self._lock:
            return _c.GridFlags(self._info().flags)

    # ---- meshes ----

    def add(self, positions: Any, tets: Optional[ArrayLike] = None, *, vertex_count: Optional[int] = None,
            copy: bool = False, tag: Any = None, user_data: int = 0, filter: Optional[Filter] = None,
            self_collision: bool = False, rest_positions: Any = None, borrow_tets: bool = False,
            fill: Optional[float] = None) -> Mesh:
        """Adds a mesh, which takes part from the next step on.

        positions: float32 or float64, (n, 3), in rows or whole columns with any strides; anything else raises. They are
        borrowed: move the body by writing to this very array in place. The grid holds a reference. With copy=True they
        are copied instead, may be any sequence of floats, and are moved through `mesh.positions`. None: set them before
        the next step, and say how many by vertex_count.
        tets: integers, (m, 4), copied unless borrow_tets (uint32 only). None: a surface or points, whose vertices
        collide with the tetrahedra of others.
        tag: any object, for `mesh.tag`. user_data: a number that pairs and constraints repeat.
        rest_positions: for `Filter.self_rest_distance`, copied.

        In place of positions and tets, a mesh: of voxtet.io, pyvista, meshio or trimesh. It is copied, without vertices that
        belong to no element, and moved through `mesh.positions`. The vertices of a surface collide, but it has no inside,
        unless `fill` fills it with tetrahedra; that is the edge of a lattice cell, or 0 for a fiftieth of the longest side.
        """
        if tets is None and not isinstance(positions, np.ndarray) and is_mesh(positions):
            positions, tets = _filled(positions, fill)
            copy = True
        elif fill is not None:
            raise InvalidArgumentError("fill is for meshes with triangles, not for arrays")
        new = Topology(positions, tets, vertex_count, copy, rest_positions, borrow_tets)
        new.desc.user_data = integer(user_data, "user_data")
        new.desc.filter = _filter_struct(filter)
        new.desc.filter.flags |= switch(self_collision, "self_collision") * _c.FilterFlags.SELF_COLLISION
        mesh = ctypes.c_uint32()
        with self._lock:
            kept = new.kept()
            with self._lending(kept):
                vox.vox_mesh_insert(self._pointer, new.desc, mesh)
                self._keep(mesh.value, **kept)
            if tag is not None:
                self._tags[mesh.value] = tag
        return Mesh(self, mesh.value)

    def add_shape(self, shape: Geometry, *, transform: Optional[ArrayLike] = None,
                  previous_transform: Optional[ArrayLike] = None, tag: Any = None, user_data: int = 0,
                  filter: Optional[Filter] = None) -> Shape:
        """Adds a rigid shape, which takes part from the next step on: a HalfSpace, Sphere, Capsule, Cylinder, Box, Heightfield,
        Solid, Sheet, Polyline or Field. It is copied. The vertices of meshes collide with it; it is body_b of their constraints,
        which have vertices of body_a alone. Experimental.

        transform: where it is, as `shape.transform`. previous_transform: see Shape.set_previous_transform.

        >>> import voxtet
        >>> with voxtet.Grid(constraints=True) as grid:
        ...     floor = grid.add_shape(voxtet.HalfSpace())
        ...     points = grid.add(np.array([[0, 0, -.5], [0, 0, 1]]))
        ...     grid.step()
        ...     print(grid.constraints.vertices[:, 0], grid.constraints.gap, grid.constraints.normal)
        [0] [-0.5] [[0. 0. 1.]]
        """
        if not isinstance(shape, Geometry):
            raise TypeError(f"shape is of type {type(shape).__name__}; it must be a voxtet.Sphere or another shape")
        desc, kept = shape._described()
        desc.user_data, desc.filter = integer(user_data, "user_data"), _filter_struct(filter)
        places = [None if m is None else matrix(m, name) for m, name in
                  ((transform, "transform"), (previous_transform, "previous_transform"))]
        id = ctypes.c_uint32()
        with self._lock:
            with self._lending(kept):
                vox.vox_shape_insert(self._pointer, desc, id)
                if isinstance(kept, FieldCall):
                    self._fields[id.value] = kept
            try:
                for place, numbers in zip((vox.vox_body_set_transform, vox.vox_shape_set_previous_transform), places):
                    if numbers is not None:
                        place(self._pointer, id, numbers)
            except VoxError:
                vox.vox_body_remove(self._pointer, id)
                self._fields.pop(id.value, None)
                raise
            if tag is not None:
                self._tags[id.value] = tag
        return Shape(self, id.value)

    def _id(self, body: Union[Body, int], name: str = "body") -> int:
        if isinstance(body, Body) and body.grid is not self:
            raise InvalidHandleError(f"{name} is body {body.id} of another grid")
        return integer(body, name, 0, U32)

    def remove(self, body: Union[Body, int]) -> None:
        """Removes a mesh or a shape. The contacts of the last step stay until the next one."""
        id = self._id(body)
        with self._lock:
            self._refuse_positions(id, "removal of the mesh")
            vox.vox_body_remove(self._pointer, id)
            for of_bodies in (self._kept, self._tags, self._mapped, self._fields):
                of_bodies.pop(id, None)

    def _ids(self) -> NDArray[np.uint32]:
        with self._lock:
            return hits_of(lambda ids, room, count: vox.vox_grid_get_bodies(self._pointer, ids, room, count),  # type: ignore
                           np.ndarray, np.dtype(np.uint32), 16)

    def _body(self, id: int) -> Body:
        with self._lock:
            kind = Body(self, id)._raw_info().shape
        return Shape(self, id) if kind else Mesh(self, id)

    def _kind_of_all(self) -> dict[int, int]:
        ids = self._ids().tolist()
        with self._lock:
            known = self._kinds
            self._kinds = kinds = {id: known[id] if id in known else Body(self, id)._raw_info().shape for id in ids}
            return kinds

    @property
    def meshes(self) -> list[Mesh]:
        """All meshes, in the order of their ids, disabled ones included."""
        return [Mesh(self, id) for id, kind in self._kind_of_all().items() if not kind]

    @property
    def shapes(self) -> list[Shape]:
        """All rigid shapes, likewise."""
        return [Shape(self, id) for id, kind in self._kind_of_all().items() if kind]

    def __iter__(self) -> Iterator[Mesh]:
        return iter(self.meshes)

    def __len__(self) -> int:
        return sum(not kind for kind in self._kind_of_all().values())

    def __bool__(self) -> bool:
        return True

    def __contains__(self, body: object) -> bool:
        if isinstance(body, Body) and body.grid is not self:
            return False
        try:
            id = integer(body, "body")
        except (TypeError, InvalidArgumentError):
            return False
        with self._lock:
            return id <= U32 and bool(vox.vox_body_is_valid(self._pointer, id))

    def __getitem__(self, body: Union[Body, int]) -> Any:
        """The Mesh or Shape with an id, e.g. of a constraint."""
        return self._body(self._id(body))

    def set_pair_enabled(self, body_a: Union[Body, int], body_b: Union[Body, int], enabled: bool) -> None:
        """With False, the two bodies do not collide in the following steps, whatever their filters say."""
        a, b, number = self._id(body_a, "body_a"), self._id(body_b, "body_b"), switch(enabled, "enabled")
        with self._lock:
            vox.vox_grid_set_pair_enabled(self._pointer, a, b, number)

    # ---- the step ----

    def step(self) -> None:
        """Finds all contacts of the positions as they are now. Other Python threads run meanwhile."""
        with self._lock:
            if self._borrowed or self._borrowed_constraints:
                self._refuse("step")
            try:
                _step(self._pointer)
            except VoxError as error:
                raise self._raised() or self._tagged(error) from None

    def _raised(self) -> Optional[BaseException]:
        """What a voxtet.Field has raised in a step that failed."""
        raised = [field.raised() for field in self._fields.values()]
        return next((error for error in raised if error is not None), None)

    def _tagged(self, error: VoxError) -> VoxError:
        """With the tag of the mesh that made a step fail, for a caller that has the lock."""
        failure = sized(_c.vox_failure)
        vox.vox_grid_get_failure(self._pointer, 0, failure)
        tag = self._tags.get(failure.body)
        return error if tag is None else type(error)(f"{error}; its tag is {tag!r}")

    def borrowed(self) -> Borrowed:
        """The results without a copy: `with grid.borrowed() as results: results.contacts`. See Borrowed."""
        return Borrowed(self)

    def _source(self) -> Grid:
        return self

    def _make(self, view: results.View, address: int, count: int) -> Any:
        return copy_of(address, count, view.records, view.dtype)

    # ---- queries ----

    def locator(self) -> Locator:
        """The meshes as they are now, to be asked at any time and by any thread, also while the grid steps."""
        from .locate import Locator
        return Locator(self)

    # ---- cell size and pictures ----

    def suggest_cell_size(self, model: Union[str, _c.CostModel, None] = None, **options: Any) -> CellSizeResult:
        """As voxtet.suggest_cell_size for the meshes of the grid, from samples. Without a model, that of its engine."""
        return suggest_for_grid(self, model, options)

    def plot(self, plotter: Any = None, *, opacity: float = 0.5, contacts: bool = True, constraints: bool = True,
             **options: Any) -> Any:
        """Adds bodies, contacts and constraints to a plotter of pyvista, or to a new one made with `options`, and returns
        it: `grid.plot().show()`."""
        from .plot import plot
        return plot(self, plotter, opacity=opacity, contacts=contacts, constraints=constraints, **options)

    def show(self, **options: Any) -> Any:
        """Shows the grid with pyvista."""
        return self.plot().show(**options)

    # ---- measurements ----

    def _number(self, call: Any) -> int:
        out = ctypes.c_uint64()
        with self._lock:
            call(self._pointer, out)
        return out.value

    @property
    def epoch(self) -> int:
        """Number of steps, clears, reserves and changes of flags and margin so far."""
        with self._lock:
            return int(self._info().epoch)

    @property
    def hash(self) -> int:
        """A hash of the contacts, the same on every machine and with every setting."""
        return self._number(vox.vox_grid_get_hash)

    @property
    def info(self) -> dict[str, Any]:
        """State and sums of the grid, such as its bytes and the bodies that moved: the fields of `vox_grid_info` by name."""
        with self._lock:
            out = self._info()
        return {name: getattr(out, name) for name, *_ in out._fields_ if name != "struct_size"}

    @property
    def counters(self) -> dict[str, int]:
        """What the last successful step did, and how many nanoseconds its stages took (names that end with _ns).
        docs/engine.md lists the names."""
        view = _c.vox_counter_view()
        with self._lock:
            vox.vox_grid_get_counters(self._pointer, view)
            return {c.name.decode(): c.value for c in (_c.vox_counter * view.count).from_address(view.data)}

    @property
    def failures(self) -> list[Failure]:
        """The mesh that made the last step fail, or the meshes that it left out (skip_bad_bodies)."""
        found: list[Failure] = []
        with self._lock:
            while True:
                f = sized(_c.vox_failure)
                vox.vox_grid_get_failure(self._pointer, len(found), f)
                if not f.body:
                    return found
                found.append(Failure(_c.Result(f.result), f.body, f.user_data,
                                     None if f.vertex == _c.VOX_NONE else f.vertex, tuple(f.position)))

    # ---- snapshots ----

    def snapshot(self) -> bytes:
        """The grid as it is now, in a format that is the same on every machine. Not in it: workers, budget, margin, log, tags,
        previous positions, and the results of the last step. `pickle` uses this, and keeps workers, budget, margin and tags."""
        size = ctypes.c_uint64()
        with self._lock:
            vox.vox_grid_save(self._pointer, None, 0, size)
            bytes_ = ctypes.create_string_buffer(size.value)
            vox.vox_grid_save(self._pointer, ctypes.addressof(bytes_), size.value, size)
        return bytes_.raw

    @classmethod
    def from_snapshot(cls, snapshot: Union[bytes, bytearray, memoryview], *, reference: Optional[Reference] = None,
                      workers: int = 1, byte_budget: int = 0, margin: float = 0.0, log: Optional[Log] = None) -> Grid:
        """A grid from a snapshot: the same ids, the same contacts, and without `reference` the same engine. Its meshes have
        positions of their own (`mesh.positions`). The bytes need not be trusted."""
        data = np.frombuffer(snapshot, np.uint8)
        grid = cls.__new__(cls)
        desc = described(_c.vox_grid_desc)
        desc.reference = pointer_to(reference)
        grid._prepare(desc, workers, byte_budget, margin, log)
        pointer = ctypes.c_void_p()
        vox.vox_grid_load(data.ctypes.data, data.size, desc, pointer)
        grid._hold(Handle(pointer.value or 0, vox.vox_grid_destroy, desc))
        return grid

    def __reduce__(self) -> Any:
        return _restored, (type(self), self.snapshot(), dict(self._settings), dict(self._tags))


def _filter_struct(filter: Optional[Filter]) -> Any:
    if filter is not None and not isinstance(filter, Filter):
        raise TypeError(f"filter is of type {type(filter).__name__}; it must be a voxtet.Filter")
    return _c.vox_filter() if filter is None else filter._struct()


def _filled(mesh: Any, cell: Optional[float]) -> tuple[Any, Any]:
    """Positions and tets of a mesh; of a surface, also those that fill it, if there is a cell size."""
    positions, tets = body_of(mesh)
    if tets is None and cell is not None:
        from .io import tetrahedralize
        filled = tetrahedralize(mesh, cell)
        return filled.positions, filled.tets
    return positions, tets


def _changed(flags: int, **wanted: Optional[bool]) -> int:
    """vox_grid_desc.flags with those changed that are not None."""
    for name, value in wanted.items():
        if value is not None:
            flag = _c.GridFlags[name.upper()]
            flags = flags & ~flag | switch(value, name) * flag
    return flags


def _restored(kind: type[Grid], snapshot: bytes, settings: dict[str, Any], tags: dict[int, Any]) -> Grid:
    grid = kind.from_snapshot(snapshot, **settings)
    grid._tags.update(tags)
    return grid


def step_all(grids: Iterable[Grid], workers: int = ALL_CORES) -> None:
    """Steps many grids in one call, several at the same time. For many small scenes. If
    some fail, the others are stepped nevertheless, and the exception is that of the first. A log function of one of them
    must not call another: it would wait for the end of this call, and this call for it."""
    count = integer(workers, "workers", 0, U32)
    all_ = _distinct(grids)
    with _Locked(all_):
        for grid in all_:
            grid._refuse("step_all")
        pointers = (ctypes.c_void_p * len(all_))(*[grid._pointer for grid in all_])
        try:
            vox.vox_grids_step(pointers, len(all_), count, None, None)
        except VoxError as error:
            raise next((e for e in (grid._raised() for grid in all_) if e is not None), error) from None


def _distinct(grids: Iterable[Grid]) -> list[Grid]:
    all_ = list(grids)
    for i, grid in enumerate(all_ if set(map(type, all_)) != {Grid} else ()):
        if not isinstance(grid, Grid):
            raise TypeError(f"grids[{i}] is of type {type(grid).__name__}; it must be a Grid")
    if len(set(map(id, all_))) != len(all_):
        raise InvalidArgumentError("a grid is given twice")
    return all_


class _Locked:
    """The locks of many grids, always taken in the same order, so that two such calls do not wait for each other."""

    def __init__(self, grids: list[Grid]) -> None:
        self._grids = sorted(grids, key=id)
        self._locks = [grid._lock for grid in self._grids]

    def __enter__(self) -> None:
        held = 0
        try:
            for lock in self._locks:
                lock.__enter__()
                held += 1
            if None in [grid._pointer for grid in self._grids]:  # closed while this thread waited
                raise InvalidStateError("the grid is closed")
        except BaseException:
            self._release(held)
            raise

    def __exit__(self, *_: object) -> None:
        self._release(len(self._locks))

    def _release(self, held: int) -> None:
        for lock in self._locks[:held]:
            lock.__exit__(None, None, None)
