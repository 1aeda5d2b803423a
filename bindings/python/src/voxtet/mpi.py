"""Exact contacts between bodies that lie on many ranks, or are cut into parts among them, over a communicator of mpi4py
(docs/distributed.md). Experimental: it may change in any release.

Partitioning stays yours. Each rank inserts its parts: the tetrahedra that lie there and all vertices that they name, with global
numbers, and which of the vertices it owns. The contacts are those of one grid of the whole, for any number of ranks and any
partition. Without a communicator a scene has one rank, and needs no mpi4py:

>>> import numpy as np
>>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
>>> scene = Scene()
>>> scene.insert(0, corners, [[0, 1, 2, 3]])
>>> scene.insert(1, corners * 0.5 + 0.1, [[0, 1, 2, 3]])
>>> scene.step()
>>> scene.contacts.vertex.tolist(), scene.contacts.body_b.tolist()
([0, 1, 2, 3], [0, 0, 0, 0])

All ranks call the methods that say so, in the same order. Where one of them raises, all do: the rank that failed says why, the
others name it. Afterwards the scene can be used as before.
"""

from __future__ import annotations

import contextlib
import ctypes
import sys
import threading
from typing import Any, Callable, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c, _dist
from ._arguments import integer, real, rows, switch
from ._arguments import points as point_rows
from ._dist import dist
from ._library import Handle, described, sized, values_of
from .body import Filter
from .errors import InvalidArgumentError, InvalidStateError, VoxError
from .mesh import Topology
from .reference import Reference, pointer_to
from .results import Records, copy_of

_LONGEST = 1 << 30  # bytes of one message of MPI, whose counts are ints
_TAG = 1


class SceneContacts(Records):
    """Contacts, sorted by (body_a, vertex, body_b, tet), in global numbers: the vertex of body_a is in the tetrahedron of body_b.
    `index` is the vertex (in `Scene.contacts`) or the tetrahedron (in `Scene.tet_contacts`) in the part of this rank, `rank` where the
    other side is. `interior` is 1, or 0 for a vertex on the boundary of the tetrahedron."""

    body_a: NDArray[np.uint64]
    vertex: NDArray[np.uint64]
    body_b: NDArray[np.uint64]
    tet: NDArray[np.uint64]
    weights: NDArray[np.float64]
    index: NDArray[np.uint32]
    rank: NDArray[np.uint32]
    interior: NDArray[np.uint32]


class SceneLocations(Records):
    """Where points are: body, tetrahedron and its rank, weights of its corners. `state` is INSIDE or OUTSIDE; a point outside has
    the closest tetrahedron, the weights of the closest point, and its distance. Without any tetrahedron, `rank` is NONE."""

    body: NDArray[np.uint64]
    tet: NDArray[np.uint64]
    state: NDArray[np.int32]
    rank: NDArray[np.uint32]
    weights: NDArray[np.float64]
    distance: NDArray[np.float64]


class SceneCosts(Records):
    """What the part of each body costs in a step, as the cost model predicts it: weights for a partitioner."""

    body: NDArray[np.uint64]
    seconds: NDArray[np.float64]


NONE = _c.VOX_NONE  # SceneLocations.rank where there is no tetrahedron
INSIDE, OUTSIDE = _c.LocationState.INSIDE, _c.LocationState.OUTSIDE  # SceneLocations.state
_SIDES = {"vertices": _dist.VERTICES, "tets": _dist.TETS}


def _bytes_at(address: Optional[int], size: int) -> Any:
    return (ctypes.c_char * size).from_address(address or 0) if size else b""


def _room(size: int) -> NDArray[np.uint8]:
    """Memory for a message."""
    return np.empty(size, np.uint8)


class _Transport:
    """The three functions of a vox_dist_transport over a communicator. An exception must not cross the library: it gets a code, and goes
    on with the calls that the other ranks wait for. `raise_kept` raises the exception after that."""

    def __init__(self, communicator: Any) -> None:
        MPI = getattr(sys.modules.get("mpi4py"), "MPI", None)  # whoever has a communicator has imported it
        if MPI is None or not isinstance(communicator, MPI.Intracomm):
            raise TypeError(f"communicator is of type {type(communicator).__name__}; it must be an mpi4py.MPI.Intracomm")
        self._mpi = MPI
        self._kept: Optional[BaseException] = None
        self._received: dict[int, NDArray[np.uint8]] = {}
        self.communicator = communicator.Dup()
        self.communicator.Set_errhandler(MPI.ERRORS_RETURN)  # as exceptions, also where the caller's end the program
        self.struct = _dist.vox_dist_transport(
            ctypes.sizeof(_dist.vox_dist_transport), self.communicator.Get_rank(), self.communicator.Get_size(), 0,
            _dist.Allgather(self._guarded(self._allgather)), _dist.Exchange(self._guarded(self._exchange)),
            _dist.Agree(self._guarded(self._agree)), None)

    def _guarded(self, function: Callable[..., None]) -> Callable[..., int]:
        def guarded(*arguments: Any) -> int:
            try:
                function(*arguments)
            except BaseException as error:  # also Ctrl-C, which Python notices in here
                self._kept = self._kept or error
                return int(_c.Result.ERROR_OUT_OF_MEMORY if isinstance(error, MemoryError) else _c.Result.ERROR_INTERNAL)
            return int(_c.Result.OK)
        return guarded

    def raise_kept(self) -> None:
        kept, self._kept = self._kept, None
        if kept is not None:
            raise kept from None

    def free(self) -> None:
        if not self._mpi.Is_finalized():
            self.communicator.Free()

    def _allgather(self, given: int, size: int, out: int, _user: Any) -> None:
        ranks = self.communicator.Get_size()
        self.communicator.Allgather([_bytes_at(given, size), self._mpi.BYTE], [_bytes_at(out, size * ranks), self._mpi.BYTE])

    def _exchange(self, ranks: Any, count: int, out: Any, received: Any, _user: Any) -> None:
        requests = []
        lacking = 0
        try:
            for i in range(count):
                data, size = out[i].data, out[i].size
                for sent in range(0, size + 1, _LONGEST):  # a message shorter than the longest is the last
                    piece = _bytes_at((data or 0) + sent, min(size - sent, _LONGEST))
                    requests.append(self.communicator.Isend([piece, self._mpi.BYTE], ranks[i], _TAG))
            for i in range(count):
                whole = self._receive(ranks[i])
                if whole is None:
                    lacking += 1
                else:
                    self._received[ranks[i]] = whole
                    received[i].data, received[i].size = whole.ctypes.data, len(whole)
        finally:
            self._mpi.Request.Waitall(requests)  # the memory that they send from is the library's again
        if lacking:
            raise MemoryError(f"there is no memory for the messages of {lacking} ranks")

    def _receive(self, rank: int) -> Optional[NDArray[np.uint8]]:
        """A message; None where there is no memory for it. It is taken from MPI in any case, or the next exchange would get it."""
        pieces = []
        lacking = False
        size = _LONGEST
        while size == _LONGEST:
            status = self._mpi.Status()
            message = self.communicator.Mprobe(rank, _TAG, status)
            size = status.Get_count(self._mpi.BYTE)
            try:
                piece = _room(size)
            except MemoryError:
                lacking = True
                # Without any buffer: Open MPI 4.1 writes the whole of a long message past the end of a short one.
                with contextlib.suppress(self._mpi.Exception):  # which says that the message was cut off
                    message.Recv((None, 0, self._mpi.BYTE))
            else:
                message.Recv([piece, self._mpi.BYTE])
                pieces.append(piece)
        if lacking:
            return None
        try:
            return pieces[0] if len(pieces) == 1 else np.concatenate(pieces)
        except MemoryError:
            return None

    def _agree(self, minima: Any, minimum_count: int, sums: Any, sum_count: int, _user: Any) -> None:
        # As signed numbers, in the same order: MPICH 4.0 takes 2**64 - 1 of UINT64_T for the least of all.
        for numbers, count, operation, offset in ((minima, minimum_count, self._mpi.MIN, 1 << 63),
                                                  (sums, sum_count, self._mpi.SUM, 0)):
            if count:
                mine = np.array(numbers[:count], np.uint64) ^ np.uint64(offset)
                combined = np.empty_like(mine)
                self.communicator.Allreduce([mine, self._mpi.INT64_T], [combined, self._mpi.INT64_T], operation)
                for i in range(count):
                    numbers[i] = int(combined[i]) ^ offset


class _Calls:
    """Around a call of the library: one thread at a time, and what a function of the transport has raised instead of the
    library's word for it."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def __enter__(self) -> int:
        self._scene._lock.acquire()
        if self._scene._handle is None:
            self._scene._lock.release()
            raise InvalidStateError("the scene is closed")
        return self._scene._handle.pointer

    def __exit__(self, *_: object) -> None:
        try:
            if self._scene._transport is not None:
                self._scene._transport.raise_kept()
        finally:
            self._scene._lock.release()


def _fail(function: Any, *arguments: Any) -> None:
    """Takes part in a call of all ranks with arguments that the library refuses. Where this rank alone has a bad argument, the
    others, which have made the call already, would wait for it."""
    with contextlib.suppress(VoxError):
        function(*arguments)


def _numbers(value: Optional[ArrayLike], name: str, count: int, dtype: Any) -> Optional[NDArray[Any]]:
    """One number for each of `count`, as the library wants them."""
    if value is None:
        return None
    array = np.asarray(value)
    if array.size == 0 and not isinstance(value, np.ndarray):
        array = array.astype(dtype)  # an empty list, of a rank without vertices
    if array.dtype.kind not in ("b" if dtype == np.uint8 else "") + "iu":
        raise TypeError(f"{name} has the dtype {array.dtype}; it must hold {'booleans' if dtype == np.uint8 else 'integers'}")
    if array.shape != (count,):
        raise InvalidArgumentError(f"{name} has the shape {array.shape}; it must be ({count},)")
    if array.size and array.dtype.kind == "i" and array.min() < 0:
        raise InvalidArgumentError(f"{name}[{int(array.argmin())}] is {int(array.min())}; it must not be negative")
    if dtype == np.uint8 and array.size and array.max() > 1:
        raise InvalidArgumentError(f"{name}[{int(array.argmax())}] is {int(array.max())}; it must be 0 or 1")
    return np.ascontiguousarray(array, dtype)


class Scene:
    """The parts of bodies that lie on this rank. `communicator`: of mpi4py, duplicated here (all ranks make their scene together);
    None: one rank. reference, cell_size, workers: as in `Grid`."""

    def __init__(self, communicator: Any = None, *, reference: Optional[Reference] = None, cell_size: float = 0.0, workers: int = 1) -> None:
        self._lock = threading.Lock()
        self._handle: Optional[Handle] = None
        self._kept: dict[int, Any] = {}  # what is borrowed, by body
        self._transport = None if communicator is None else _Transport(communicator)
        pointer = ctypes.c_void_p()
        transport = None if self._transport is None else ctypes.pointer(self._transport.struct)
        grid = described(_c.vox_grid_desc)
        try:
            try:
                grid.flags = 0
                grid.reference = pointer_to(reference)
                grid.cell_size = real(cell_size, "cell_size")
                grid.worker_count = integer(workers, "workers", 0, _c.VOX_MAX_WORKERS)
            except Exception:
                _fail(dist.vox_dist_scene_create, _c.vox_grid_desc(), transport, pointer)
                raise
            dist.vox_dist_scene_create(grid, transport, pointer)
        except BaseException:
            if self._transport is not None:
                self._transport.raise_kept()
                self._transport.free()  # by all ranks, as all of them have failed
            raise
        self._handle = Handle(pointer.value or 0, dist.vox_dist_scene_destroy, self._transport)

    def close(self) -> None:
        """Releases everything. Called by all ranks, as it frees the communicator; a scene that is merely dropped leaves that to
        the end of the program."""
        with self._lock:
            self._handle = None
            self._kept.clear()
            if self._transport is not None:
                self._transport.free()
            self._transport = None

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def rank(self) -> int:
        """Of this process."""
        return 0 if self._transport is None else int(self._transport.struct.rank)

    @property
    def size(self) -> int:
        """How many ranks there are."""
        return 1 if self._transport is None else int(self._transport.struct.size)

    def insert(self, body: int, positions: Any, tets: Optional[ArrayLike] = None, *, vertex_ids: Optional[ArrayLike] = None,
               tet_ids: Optional[ArrayLike] = None, owned: Optional[ArrayLike] = None, filter: Optional[Filter] = None,
               self_collision: bool = False) -> None:
        """Adds the part of a body that lies on this rank, for the next steps.

        body: its number, the same on all ranks; a rank has one part of a body at most. positions: as in `Grid.add`, borrowed, so
        move the part by writing to this array. vertex_ids, tet_ids: global numbers; None: 0, 1, 2 and so on. owned: whether this
        rank owns each vertex; None: all. A vertex is owned by one rank, and has the same position wherever there is a copy of it.
        """
        new = Topology(positions, tets, None, False, None, False)
        if filter is not None:
            if not isinstance(filter, Filter):
                raise TypeError(f"filter is of type {type(filter).__name__}; it must be a voxtet.Filter")
            new.desc.filter = filter._struct()
        new.desc.filter.flags |= switch(self_collision, "self_collision") * _c.FilterFlags.SELF_COLLISION
        desc = described(_dist.vox_dist_part_desc)
        desc.body = integer(body, "body")
        desc.mesh = ctypes.pointer(new.desc)
        arrays = [_numbers(vertex_ids, "vertex_ids", new.desc.positions.count, np.uint64),
                  _numbers(tet_ids, "tet_ids", new.desc.tet_count, np.uint64),
                  _numbers(owned, "owned", new.desc.positions.count, np.uint8)]
        desc.vertex_ids, desc.tet_ids, desc.owned = (None if a is None else a.ctypes.data for a in arrays)
        with _Calls(self) as pointer:
            dist.vox_dist_scene_insert(pointer, desc)
            self._kept[desc.body] = new.kept()["positions"]

    def remove(self, body: int) -> None:
        """Removes the part of a body that lies on this rank."""
        number = integer(body, "body")
        with _Calls(self) as pointer:
            dist.vox_dist_scene_remove(pointer, number)
            self._kept.pop(number, None)

    def move(self, body: int, positions: Any) -> None:
        """Borrows other positions for the part of a body that lies on this rank, of as many vertices. What is written to the same array
        needs no such call."""
        number = integer(body, "body")
        found = rows(positions, "positions")
        with _Calls(self) as pointer:
            dist.vox_dist_scene_bind_positions(pointer, number, found.struct)
            self._kept[number] = found

    def step(self) -> None:
        """By all ranks. Finds all contacts of the positions as they are now, between all bodies of all ranks."""
        with _Calls(self) as pointer:
            dist.vox_dist_scene_step(pointer)

    def _contacts(self, side: int) -> SceneContacts:
        view = _dist.vox_dist_contact_view()
        with _Calls(self) as pointer:
            dist.vox_dist_scene_get_contacts(pointer, side, view)
            found: SceneContacts = copy_of(view.data or 0, view.count, SceneContacts, _dist.contact_type)
            return found

    @property
    def contacts(self) -> SceneContacts:
        """Of the vertices that this rank owns, as the last step found them."""
        return self._contacts(_dist.VERTICES)

    @property
    def tet_contacts(self) -> SceneContacts:
        """With the tetrahedra that lie on this rank: the same contacts, seen from the other side."""
        return self._contacts(_dist.TETS)

    def send(self, values: ArrayLike, side: str = "vertices") -> NDArray[Any]:
        """By all ranks. Sends a row for each contact from one side to the other: one for each of `contacts`, which arrive in the order of
        `tet_contacts`, or with side="tets" the way back. Rows have the same shape and dtype on all ranks."""
        with _Calls(self) as pointer:
            try:
                if side not in _SIDES:
                    raise InvalidArgumentError(f"side is {side!r}; it must be 'vertices' or 'tets'")
                array = np.ascontiguousarray(values)
                if array.dtype.hasobject:
                    raise TypeError(f"values has the dtype {array.dtype}; it must hold plain numbers")
                counts = []
                for number in (_SIDES[side], 1 - _SIDES[side]):
                    view = _dist.vox_dist_contact_view()
                    dist.vox_dist_scene_get_contacts(pointer, number, view)
                    counts.append(view.count)
                given, wanted = counts
                if array.ndim < 1 or len(array) != given:
                    raise InvalidArgumentError(f"values has the shape {array.shape}; it must have {given} rows")
                out = np.empty((wanted, *array.shape[1:]), array.dtype)
                item = int(np.prod(array.shape[1:], dtype=np.int64)) * array.dtype.itemsize
            except Exception:
                _fail(dist.vox_dist_scene_send, pointer, 0, 0, None, None)
                raise
            dist.vox_dist_scene_send(pointer, _SIDES[side], item, array.ctypes.data if given else None,
                                out.ctypes.data if wanted else None)
        return out

    def hash(self) -> int:
        """By all ranks. A hash of all contacts of all ranks, of 128 bits, the same for any partition."""
        out = (ctypes.c_uint64 * 2)()
        with _Calls(self) as pointer:
            dist.vox_dist_scene_get_hash(pointer, out)
        return out[0] | out[1] << 64

    def locate(self, points: Any) -> SceneLocations:
        """By all ranks, each with points of its own, (n, 3). The body and the tetrahedron that contain each point, or the closest
        ones: the same for any partition, bit for bit."""
        with _Calls(self) as pointer:
            try:
                found = point_rows(points)
                out = np.zeros(found.length, _dist.location_type)
            except Exception:
                _fail(dist.vox_dist_scene_locate, pointer, None, None)
                raise
            dist.vox_dist_scene_locate(pointer, found.struct, out.ctypes.data if len(out) else None)
        return out.view(SceneLocations)

    def check(self) -> None:
        """By all ranks. Raises InvalidStateError where vertices have no owner or several, copies have other positions than their
        owner's, or a tetrahedron is on two ranks. For debugging: it sends every position."""
        with _Calls(self) as pointer:
            dist.vox_dist_scene_check(pointer)

    @property
    def costs(self) -> SceneCosts:
        """Of the parts here, in the order of bodies."""
        out = np.zeros(len(self._kept), _dist.cost_type)
        count = ctypes.c_uint64()
        with _Calls(self) as pointer:
            dist.vox_dist_scene_get_costs(pointer, out.ctypes.data if len(out) else None, len(out), count)
        return out[:count.value].view(SceneCosts)

    @property
    def counters(self) -> dict[str, int]:
        """What the last step, or `locate` since, sent from this rank (docs/distributed.md lists the names)."""
        view = _c.vox_counter_view()
        with _Calls(self) as pointer:
            dist.vox_dist_scene_get_counters(pointer, view)
            return {c.name.decode(): c.value for c in (_c.vox_counter * view.count).from_address(view.data)}
