"""Results of a step as structured arrays: copies that are the caller's own, or borrowed memory of the library."""

from __future__ import annotations

import ctypes
import sys
import weakref
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from . import _c
from ._library import vox
from .errors import InvalidStateError

if TYPE_CHECKING:
    from .grid import Grid


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


def record_type(struct: str) -> np.dtype[Any]:
    """The dtype of a struct of the library. Single elements have their fields as attributes, too."""
    return np.dtype((np.record, _c.dtypes[struct]))


class Contacts(Records):
    """Contacts of a step, sorted by (body_a, vertex, body_b, tet): the vertex of body_a is in the tetrahedron of body_b."""

    body_a: NDArray[np.uint32]
    vertex: NDArray[np.uint32]
    body_b: NDArray[np.uint32]
    tet: NDArray[np.uint32]
    barycentric: NDArray[np.float32]


class Penetrations(Records):
    """How deep each vertex is in another body, and which way leads out. `state` is a PenetrationState."""

    body_a: NDArray[np.uint32]
    vertex: NDArray[np.uint32]
    body_b: NDArray[np.uint32]
    state: NDArray[np.int32]
    contact: NDArray[np.uint64]
    depth: NDArray[np.float32]
    direction: NDArray[np.float32]


class Depths(Records):
    """Depth and direction in double."""

    depth: NDArray[np.float64]
    direction: NDArray[np.float64]


class Pairs(Records):
    """Meshes that touch, and where their contacts are in `Grid.pair_contacts`."""

    body_a: NDArray[np.uint32]
    body_b: NDArray[np.uint32]
    user_data_a: NDArray[np.uint64]
    user_data_b: NDArray[np.uint64]
    first: NDArray[np.uint64]
    a_in_b: NDArray[np.uint64]
    b_in_a: NDArray[np.uint64]


class TouchEvents(Records):
    """Pairs of meshes that began to touch, still touch, or ended. `kind` is a Touch."""

    body_a: NDArray[np.uint32]
    body_b: NDArray[np.uint32]
    user_data_a: NDArray[np.uint64]
    user_data_b: NDArray[np.uint64]
    kind: NDArray[np.int32]
    pair: NDArray[np.uint32]


class ContactEvents(Records):
    """Vertices that entered a mesh or left it. `kind` is a Touch."""

    body_a: NDArray[np.uint32]
    vertex: NDArray[np.uint32]
    body_b: NDArray[np.uint32]
    kind: NDArray[np.int32]


class Readings(Records):
    """What responding to, drawing or reporting contacts needs. `known` are ReadingFlags: which parts are there."""

    contact: NDArray[np.uint64]
    known: NDArray[np.uint32]
    state: NDArray[np.int32]
    depth: NDArray[np.float32]
    direction: NDArray[np.float32]
    position: NDArray[np.float64]
    distance: NDArray[np.float64]
    surface_position: NDArray[np.float64]
    barycentric: NDArray[np.float64]
    normal: NDArray[np.float64]
    triangle: NDArray[np.uint32]
    user_data_a: NDArray[np.uint64]
    user_data_b: NDArray[np.uint64]


class Touches(NamedTuple):
    """The touch events of a step in three parts."""

    began: TouchEvents
    persisted: TouchEvents
    ended: TouchEvents


class Passages(NamedTuple):
    """The events of single vertices of a step in two parts."""

    began: ContactEvents
    ended: ContactEvents


class View(NamedTuple):
    """How to get one kind of array: the function that gives a view, the view's type, and what its elements become."""

    function: Any
    struct: Any
    records: Any
    dtype: np.dtype[Any]
    of_readings: bool


def _view(function: Any, records: Any, dtype: Any, of_readings: bool = False) -> View:
    """`dtype`: or the name of the struct that the elements are."""
    struct = function.argtypes[1]._type_
    return View(function, struct, records, record_type(dtype) if isinstance(dtype, str) else dtype, of_readings)


CONTACTS = _view(vox.vox_grid_get_contacts, Contacts, "vox_contact")
INTERIORS = View(None, None, np.ndarray, np.dtype(np.bool_), False)  # beside the contacts
PENETRATIONS = _view(vox.vox_grid_penetrations, Penetrations, "vox_penetration")
DEPTHS = _view(vox.vox_grid_depths, Depths, "vox_depth")
PAIRS = _view(vox.vox_grid_get_pairs, Pairs, "vox_pair")
TOUCHES = _view(vox.vox_grid_touch_events, TouchEvents, "vox_touch_event")
PASSAGES = _view(vox.vox_grid_contact_events, ContactEvents, "vox_contact_event")
READINGS = _view(vox.vox_grid_readings, Readings, "vox_reading", of_readings=True)
READING_DEPTHS = _view(vox.vox_grid_reading_depths, Depths, "vox_depth", of_readings=True)
INDICES = View(None, None, np.ndarray, np.dtype(np.uint32), False)

_BYTE = np.dtype(np.uint8)
# ctypes makes a type for each length, which takes longer than all the rest: one that is long enough for all, and cut to size by
# a memoryview.
_span_at: Any = (ctypes.c_char * sys.maxsize).from_address

_new = np.ndarray.__new__
_from_buffer: Any = ctypes.c_char.from_buffer


def copy_of(address: int, count: int, stride: int, records: Any, dtype: np.dtype[Any]) -> Any:
    """An array of the caller's own."""
    if count == 0:
        return _new(records, 0, dtype)
    size = dtype.itemsize
    if stride != size:
        return borrow_of(address, count, stride, records, dtype, None).copy()
    memory = np.empty(count * size, _BYTE)
    ctypes.memmove(ctypes.byref(_from_buffer(memory)), address, count * size)
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


def borrow_of(address: int, count: int, stride: int, records: Any, dtype: np.dtype[Any], owner: Any,
              writable: bool = False) -> Any:
    """An array over the library's memory. It, its slices and its fields keep `owner` alive."""
    if count == 0:
        return _new(records, 0, dtype)
    size = (count - 1) * stride + dtype.itemsize
    span = _span_at(address)
    span.owner = owner
    memory = memoryview(span)[:size] if writable else memoryview(span)[:size].toreadonly()
    if stride == dtype.itemsize:
        return np.frombuffer(memory, dtype).view(records)
    return _new(records, count, dtype, np.frombuffer(memory, _BYTE), 0, (stride,))


class Results:
    """What a step found: of a grid as copies, in a `with grid.borrowed()` as borrowed memory."""

    def _source(self) -> Grid:
        raise NotImplementedError

    def _make(self, view: View, address: int, count: int, stride: int) -> Any:
        """The array; called with the grid's lock held."""
        raise NotImplementedError

    def _array(self, view: View) -> Any:
        grid = self._source()
        with grid._lock:
            out = view.struct()
            view.function(grid._pointer, out)
            return self._make(view, out.data, out.count, out.byte_stride)

    @property
    def contacts(self) -> Contacts:
        """The contacts of the last step; none before the first, after a failed one and after a clear."""
        return self._array(CONTACTS)  # type: ignore[no-any-return]

    @property
    def interiors(self) -> NDArray[np.bool_]:
        """For each contact, whether the vertex is in the interior of the tetrahedron (and not on its boundary); exact."""
        grid = self._source()
        with grid._lock:
            out = CONTACTS.struct()
            CONTACTS.function(grid._pointer, out)
            return self._make(INTERIORS, out.interiors, out.count, 1)  # type: ignore[no-any-return]

    @property
    def penetrations(self) -> Penetrations:
        """The penetrations of the last step. Raises InvalidStateError for a grid without them."""
        return self._array(PENETRATIONS)  # type: ignore[no-any-return]

    @property
    def depths(self) -> Depths:
        """Depth and direction of each penetration in double."""
        return self._array(DEPTHS)  # type: ignore[no-any-return]

    @property
    def pairs(self) -> Pairs:
        """The pairs of meshes that touched in the last step."""
        return self._array(PAIRS)  # type: ignore[no-any-return]

    @property
    def pair_contacts(self) -> NDArray[np.uint32]:
        """The index of each contact, pair by pair: those of a pair begin at `pair.first`, first `a_in_b` vertices of
        body_a, then `b_in_a` of body_b."""
        grid = self._source()
        with grid._lock:
            pairs, contacts = PAIRS.struct(), CONTACTS.struct()
            PAIRS.function(grid._pointer, pairs)
            CONTACTS.function(grid._pointer, contacts)
            return self._make(INDICES, pairs.contacts, contacts.count, 4)  # type: ignore[no-any-return]

    @property
    def events(self) -> Touches:
        """Pairs that began to touch in the last step, that still touch, and that ended."""
        grid = self._source()
        with grid._lock:
            view = TOUCHES.struct()
            TOUCHES.function(grid._pointer, view)
            events = self._make(TOUCHES, view.data, view.count, view.byte_stride)
        middle = view.began + view.persisted
        return Touches(events[:view.began], events[view.began:middle], events[middle:])

    @property
    def contact_events(self) -> Passages:
        """Vertices that entered a mesh in the last step, and that left one. For a grid with contact_events=True."""
        grid = self._source()
        with grid._lock:
            view = PASSAGES.struct()
            PASSAGES.function(grid._pointer, view)
            events = self._make(PASSAGES, view.data, view.count, view.byte_stride)
        return Passages(events[:view.began], events[view.began:])


class Borrowed(Results):
    """Results of a step without a copy, by `with grid.borrowed() as results`. While it is open or an array of it lives (also
    a slice or a field), whatever would end the memory raises BufferError: step, clear, reserve, flags, close."""

    def __init__(self, grid: Grid) -> None:
        self._grid = grid
        self._lease: Optional[Lease] = None
        self._readings_lease: Optional[Lease] = None

    def _held(self) -> Lease:
        lease = self._lease  # read once: another thread may leave the `with` at any time
        if lease is None:
            raise InvalidStateError("borrowed results are there inside of `with grid.borrowed() as results` only")
        return lease

    def _source(self) -> Grid:
        self._held()
        return self._grid

    def _array(self, view: View) -> Any:  # as the general one, but for calls that take half a microsecond
        function, struct, records, dtype, of_readings = view
        lease = self._lease
        if of_readings or lease is None:
            return super()._array(view)
        grid = self._grid
        with grid._lock:
            out = struct()
            function(grid._pointer, out)
            return borrow_of(out.data, out.count, out.byte_stride, records, dtype, lease)

    def _make(self, view: View, address: int, count: int, stride: int) -> Any:
        lease = self._held()
        if view.of_readings:
            lease = self._readings_lease or Lease(self._grid._handle, self._grid._borrowed_readings)
            self._readings_lease = lease
        return borrow_of(address, count, stride, view.records, view.dtype, lease)

    @property
    def readings(self) -> Readings:
        """The readings that `Grid.prepare_readings` made last."""
        return self._array(READINGS)  # type: ignore[no-any-return]

    @property
    def reading_depths(self) -> Depths:
        """Depth and direction of these readings in double."""
        return self._array(READING_DEPTHS)  # type: ignore[no-any-return]

    def __enter__(self) -> Borrowed:
        with self._grid._lock:
            self._lease = Lease(self._grid._handle, self._grid._borrowed)
        return self

    def __exit__(self, *_: object) -> None:
        self._lease = self._readings_lease = None
