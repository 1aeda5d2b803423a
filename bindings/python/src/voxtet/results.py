"""Results of a step as structured arrays: copies that are the caller's own, or borrowed memory of the library."""

from __future__ import annotations

import ctypes
import html
import sys
import weakref
from typing import TYPE_CHECKING, Any, Callable, Iterable, Mapping, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _c
from ._arguments import choice, integer
from ._library import described, vox
from .errors import InvalidArgumentError, InvalidHandleError, InvalidStateError

if TYPE_CHECKING:
    from .body import Body
    from .grid import Grid


SHOWN = 10  # rows in a notebook


def html_table(title: str, columns: Iterable[Any], rows: Iterable[Iterable[Any]]) -> str:
    """A table with a title."""
    def line(tag: str, cells: Iterable[Any]) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"

    body = "".join(line("td", row) for row in rows)
    return f"<table><caption>{html.escape(title)}</caption>{line('th', columns)}{body}</table>"


class Records(np.ndarray[Any, Any]):
    """A structured array whose fields are attributes as well: `contacts.tet` is `contacts["tet"]`, without a copy."""

    def __getitem__(self, key: Any) -> Any:
        found = super().__getitem__(key)
        return found.view(np.ndarray) if isinstance(key, str) else found

    def __getattr__(self, name: str) -> Any:
        if name in (self.dtype.names or ()):
            return self[name]
        raise AttributeError(f"{type(self).__name__} of {self.dtype} has no attribute {name!r}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(self.dtype.names or ())]

    def __repr__(self) -> str:
        if self.ndim != 1 or self.dtype.names is None:
            return super().__repr__()
        return f"<voxtet.{type(self).__name__}: {len(self)}, each with {', '.join(self.dtype.names)}>"

    def _repr_html_(self) -> str:
        """For notebooks: the first ones, with kinds and states by their names."""
        if self.ndim != 1 or self.dtype.names is None:
            return html.escape(super().__repr__())
        names = {"kind": _c.ConstraintKind, "side": _c.Side,
                 "state": _c.PairState if isinstance(self, Pairs) else _c.DepthState}

        def cell(name: str, value: Any) -> str:
            return names[name](int(value)).name if name in names else str(value)

        rows = [[cell(name, record[name]) for name in self.dtype.names] for record in self[:SHOWN]]
        return html_table(f"{len(self)} {type(self).__name__}", self.dtype.names, rows)


def record_type(struct: str) -> np.dtype[Any]:
    """The dtype of a struct of the library. Single elements have their fields as attributes, too."""
    return np.dtype((np.record, _c.dtypes[struct]))


class Contacts(Records):
    """Contacts of a step, sorted by (body_a, vertex, body_b, tet): the vertex of body_a is in the tetrahedron of body_b."""

    body_a: NDArray[np.uint32]
    vertex: NDArray[np.uint32]
    body_b: NDArray[np.uint32]
    tet: NDArray[np.uint32]


class Pairs(Records):
    """Bodies that touch, stopped touching in the last step, or are within the margin, sorted by (body_a, body_b). `state` is a
    PairState. The contacts of a pair are contact_count from first_contact on in `Grid.pair_contacts`."""

    body_a: NDArray[np.uint32]
    body_b: NDArray[np.uint32]
    user_data_a: NDArray[np.uint64]
    user_data_b: NDArray[np.uint64]
    state: NDArray[np.int32]
    first_contact: NDArray[np.uint64]
    contact_count: NDArray[np.uint64]


class Constraints(Records):
    """What a solver needs (vox_constraint). With x[i] for the position of vertices[i], of body_a for i < count_a and else of
    body_b, gap = offset + normal @ sum(weights[i] * x[i]) is negative while the two overlap; a shape has no vertices and is always
    body_b. Vertices beyond `count` are 0, and so are their weights. `kind` is a ConstraintKind, `state` a DepthState; `pair` is an
    index of `Grid.pairs`, `previous` that of the same constraint in the step before, or NONE. Sorted by pair (`Grid.pair_offsets`), kind, body_a and vertices."""

    body_a: NDArray[np.uint32]
    body_b: NDArray[np.uint32]
    kind: NDArray[np.int32]
    state: NDArray[np.int32]
    count_a: NDArray[np.uint32]
    count: NDArray[np.uint32]
    vertices: NDArray[np.uint32]
    element_b: NDArray[np.uint32]
    weights: NDArray[np.float64]
    normal: NDArray[np.float64]
    gap: NDArray[np.float64]
    offset: NDArray[np.float64]
    position: NDArray[np.float64]
    time: NDArray[np.float64]
    user_data_a: NDArray[np.uint64]
    user_data_b: NDArray[np.uint64]
    pair: NDArray[np.uint32]
    previous: NDArray[np.uint32]
    left_out: NDArray[np.uint64]

    def rows(self, offsets: Mapping[Any, int], columns: Optional[int] = None) -> Jacobian:
        """The derivative of `gap` by all coordinates, a row for each constraint. offsets: for each mesh, by its id or as a Mesh,
        the number of its first vertex among all; coordinate k of vertex v has column 3 * v + k. columns: how many there are;
        None: up to the last one in use.

        `scipy.sparse.csr_array(rows[:3], shape=rows.shape)` is the matrix, and `matrix @ x + constraints.offset` the gaps."""
        first_of = {int(body): integer(first, "offsets") for body, first in offsets.items()}
        of_a = np.arange(self.vertices.shape[1]) < self.count_a[:, None]
        bodies = np.where(of_a, self.body_a[:, None], self.body_b[:, None])
        used = np.arange(self.vertices.shape[1]) < self.count[:, None]
        known = np.unique(bodies[used])
        for body in known.tolist():
            if body not in first_of:
                raise InvalidHandleError(f"offsets has no body {body}")
        first = np.array([first_of[body] for body in known.tolist()], np.int64)[np.searchsorted(known, bodies[used])]
        columns_ = (3 * (first + self.vertices[used])[:, None] + np.arange(3)).ravel()
        values = (self.weights[:, :, None] * self.normal[:, None])[used].ravel()
        starts = np.concatenate([[0], np.cumsum(3 * self.count.astype(np.int64))])
        least = int(columns_.max()) + 1 if columns_.size else 0
        width = least if columns is None else integer(columns, "columns")
        if width < least:
            raise InvalidArgumentError(f"columns is {width}, but column {least - 1} is in use")
        return Jacobian(values, columns_, starts, (len(self), width))


class Jacobian(NamedTuple):
    """Rows of a sparse matrix (CSR): the values of row i are data[indptr[i]:indptr[i + 1]], in the columns `indices`."""

    data: NDArray[np.float64]
    indices: NDArray[np.int64]
    indptr: NDArray[np.int64]
    shape: tuple[int, int]


class View(NamedTuple):
    """How to get one kind of array: the function that gives a view, its type, and what the elements become; the field with the
    array, that with its length, and how much longer it is."""

    function: Any
    struct: Any
    records: Any
    dtype: np.dtype[Any]
    array: str = "data"
    length: str = "count"
    more: int = 0


_contacts = vox.vox_grid_get_contacts, _c.vox_contact_view
_pairs = vox.vox_grid_get_pairs, _c.vox_pair_view
_constraints = vox.vox_grid_get_constraints, _c.vox_constraint_view
CONTACTS = View(*_contacts, Contacts, record_type("vox_contact"))
INTERIORS = View(*_contacts, np.ndarray, np.dtype(np.bool_), "interiors")
PAIRS = View(*_pairs, Pairs, record_type("vox_pair"))
INDICES = View(*_pairs, np.ndarray, np.dtype(np.uint32))  # of contacts
CONSTRAINTS = View(*_constraints, Constraints, record_type("vox_constraint"))
PAIR_OFFSETS = View(*_constraints, np.ndarray, np.dtype(np.uint64), "pair_offsets", "pair_count", 1)

_BYTE = np.dtype(np.uint8)
# ctypes makes a type for each length, which takes longer than all the rest: one that is long enough for all, and cut to size by
# a memoryview.
_span_at: Any = (ctypes.c_char * sys.maxsize).from_address

_new = np.ndarray.__new__
_from_buffer: Any = ctypes.c_char.from_buffer


def copy_of(address: int, count: int, records: Any, dtype: np.dtype[Any]) -> Any:
    """An array of the caller's own."""
    if count == 0:
        return _new(records, 0, dtype)
    memory = np.empty(count * dtype.itemsize, _BYTE)
    ctypes.memmove(ctypes.byref(_from_buffer(memory)), address, memory.size)
    return _new(records, count, dtype, memory)


def hits_of(call: Callable[[int, int, Any], Any], records: Any, dtype: np.dtype[Any], guess: int) -> Any:
    """What a function finds that writes as many hits as there is room for, and says how many there are."""
    count = ctypes.c_uint64()
    while True:
        hits = np.empty(guess, dtype)
        call(hits.ctypes.data, guess, count)
        if count.value <= guess:
            found = hits[:count.value]
            return (found if 2 * count.value >= guess else found.copy()).view(records)
        guess = count.value


class Exports(list["weakref.ref[Any]"]):
    """Which leases are alive. A list, as whether it is empty is asked in every step."""

    __slots__ = ("_full",)

    def __init__(self) -> None:
        self._full = 16  # when to drop those that are dead

    def add(self, lease: Any) -> None:
        """Notes one more, without keeping it."""
        if len(self) >= self._full:
            self._drop_dead()
            self._full = 2 * len(self) + 16
        self.append(weakref.ref(lease))

    def _drop_dead(self) -> None:
        self[:] = [r for r in self if r() is not None]

    def refuse(self, what: str) -> None:
        """Raises BufferError if one is alive."""
        self._drop_dead()
        if self:
            raise BufferError(f"{what} would end borrowed memory that is in use: leave the `with grid.borrowed()`, and delete "
                              "its arrays and their slices or copy them")


class Lease:
    """What borrowed arrays have in common: it lives as long as one of them, and keeps the library's memory for them."""

    __slots__ = ("__weakref__", "_handle")

    def __init__(self, handle: Any, exports: Exports) -> None:
        self._handle = handle
        exports.add(self)


def borrow_of(address: int, count: int, records: Any, dtype: np.dtype[Any], owner: Any, writable: bool = False) -> Any:
    """An array over the library's memory. It, its slices and its fields keep `owner` alive."""
    if count == 0:
        return _new(records, 0, dtype)
    span = _span_at(address)
    span.owner = owner
    memory = memoryview(span)[:count * dtype.itemsize]
    return np.frombuffer(memory if writable else memory.toreadonly(), dtype).view(records)


class Results:
    """What a step found: of a grid as copies, in a `with grid.borrowed()` as borrowed memory."""

    def _source(self) -> Grid:
        raise NotImplementedError

    def _make(self, view: View, address: int, count: int) -> Any:
        """The array; called with the grid's lock held."""
        raise NotImplementedError

    def _array(self, view: View) -> Any:
        grid = self._source()
        with grid._lock:
            return self._read(grid, view)

    def _read(self, grid: Grid, view: View) -> Any:
        out = view.struct()
        view.function(grid._pointer, out)
        return self._make(view, getattr(out, view.array), getattr(out, view.length) + view.more)

    @property
    def contacts(self) -> Contacts:
        """The contacts of the last step; none before the first, after a failed one and after a clear."""
        return self._array(CONTACTS)  # type: ignore[no-any-return]

    @property
    def interiors(self) -> NDArray[np.bool_]:
        """For each contact, whether the vertex is in the interior of the tetrahedron (and not on its boundary); exact."""
        return self._array(INTERIORS)  # type: ignore[no-any-return]

    @property
    def pairs(self) -> Pairs:
        """The pairs of the last step: those that began to touch, still touch, ended, or are near."""
        return self._array(PAIRS)  # type: ignore[no-any-return]

    @property
    def pair_contacts(self) -> NDArray[np.uint32]:
        """The index of each contact, pair by pair; of a pair first those of vertices of body_a, then those of body_b."""
        grid = self._source()
        with grid._lock:
            pairs, contacts = PAIRS.struct(), CONTACTS.struct()
            PAIRS.function(grid._pointer, pairs)
            CONTACTS.function(grid._pointer, contacts)
            return self._make(INDICES, pairs.contacts, contacts.count)  # type: ignore[no-any-return]

    def find_constraints(self, method: Union[str, _c.DepthMethod] = "consistent", *, body_a: Union[Body, int, None] = None,
                         body_b: Union[Body, int, None] = None, mask: int = 0, closest_budget: int = 0) -> Constraints:
        """Finds the constraints of the last step, in place of those found before, and returns them. Call it before anything
        moves. method: "consistent" depth, smooth along the surface; to the "closest" point; "none". body_a, body_b: only pairs of
        this mesh, or this one pair; mask: only where the category of a mesh has a bit in common. closest_budget: most searches
        for a closest point; 0: no limit."""
        desc, grid = described(_c.vox_constraint_desc), self._source()
        desc.method = choice(_c.DepthMethod, method, "method")
        desc.body_a = 0 if body_a is None else grid._id(body_a, "body_a")
        desc.body_b = 0 if body_b is None else grid._id(body_b, "body_b")
        desc.mask, desc.closest_budget = integer(mask, "mask"), integer(closest_budget, "closest_budget")
        with grid._lock:
            grid._borrowed_constraints.refuse("find_constraints")
            vox.vox_grid_find_constraints(grid._pointer, desc)
            return self._read(grid, CONSTRAINTS)  # type: ignore[no-any-return]

    @property
    def constraints(self) -> Constraints:
        """The constraints that the last step found (constraints=True) or `find_constraints` since. Raises InvalidStateError if
        there are none yet."""
        return self._array(CONSTRAINTS)  # type: ignore[no-any-return]

    @property
    def pair_offsets(self) -> NDArray[np.uint64]:
        """Where the constraints of each pair are: those of pair p are constraints[pair_offsets[p]:pair_offsets[p + 1]]."""
        return self._array(PAIR_OFFSETS)  # type: ignore[no-any-return]


class Borrowed(Results):
    """Results of a step without a copy, by `with grid.borrowed() as results`. While it is open or an array of it lives (also
    a slice or a field), whatever would end the memory raises BufferError: step, clear, reserve, flags, margin, close; while
    constraints live, find_constraints, too."""

    def __init__(self, grid: Grid) -> None:
        self._grid = grid
        self._lease: Optional[Lease] = None

    def _held(self) -> Lease:
        lease = self._lease  # read once: another thread may leave the `with` at any time
        if lease is None:
            raise InvalidStateError("borrowed results are there inside of `with grid.borrowed() as results` only")
        return lease

    def _source(self) -> Grid:
        self._held()
        return self._grid

    def _make(self, view: View, address: int, count: int) -> Any:
        lease = self._held()
        if view.struct is CONSTRAINTS.struct:
            lease = Lease(self._grid._handle, self._grid._borrowed_constraints)
        return borrow_of(address, count, view.records, view.dtype, lease)

    def __enter__(self) -> Borrowed:
        with self._grid._lock:
            self._lease = Lease(self._grid._handle, self._grid._borrowed)
        return self

    def __exit__(self, *_: object) -> None:
        self._lease = None
