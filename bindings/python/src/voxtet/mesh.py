"""A mesh of a grid."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import NOTHING, Rows, copied_rows, indices, integer, pinned, rows, switch
from ._library import described, vox
from .body import Body
from .errors import InvalidArgumentError
from .results import Lease, borrow_of

if TYPE_CHECKING:
    from .grid import Grid


class MeshInfo(NamedTuple):
    """A mesh as it is now."""

    user_data: int
    vertex_count: int  # with the removed ones
    tet_count: int  # with those that are disabled or removed
    enabled_tet_count: int
    enabled: bool
    owns_positions: bool  # copied, mapped or loaded
    borrows_tets: bool


class Topology:
    """Vertices and tetrahedra as `vox_mesh_desc`, with the arrays that the library borrows."""

    def __init__(self, positions: Any, tets: Any, vertex_count: Optional[int], copy: bool, rest_positions: Any,
                 borrow_tets: bool) -> None:
        self.desc = desc = described(_c.vox_mesh_desc)
        self.rows = NOTHING
        if positions is not None:
            self.rows = copied_rows(positions, "positions") if copy else rows(positions, "positions")
            if vertex_count is not None and vertex_count != self.rows.length:
                raise InvalidArgumentError(f"vertex_count is {vertex_count}, but there are {self.rows.length} positions")
            desc.positions = self.rows.struct
            if copy:
                desc.flags |= _c.MeshFlags.COPY_POSITIONS
        elif vertex_count is not None:
            desc.positions.count = integer(vertex_count, "vertex_count")
        self.tets: Optional[NDArray[np.uint32]] = None
        if tets is not None:
            if borrow_tets and not (isinstance(tets, np.ndarray) and tets.dtype == np.uint32
                                    and tets.flags.c_contiguous):
                raise InvalidArgumentError("tets that are borrowed must be a numpy array of uint32 in rows")
            self.tets = indices(tets, "tets", 4)
            desc.tets, desc.tet_count = self.tets.ctypes.data, len(self.tets)
            if borrow_tets:
                desc.flags |= _c.MeshFlags.BORROW_TETS
        self.rest = NOTHING
        if rest_positions is not None:
            self.rest = copied_rows(rest_positions, "rest_positions")
            desc.rest_positions = self.rest.struct

    def kept(self) -> dict[str, Any]:
        """What the library goes on reading after the call."""
        copies, borrows_tets = self.desc.flags & _c.MeshFlags.COPY_POSITIONS, self.desc.flags & _c.MeshFlags.BORROW_TETS
        return {"positions": None if copies or self.rows.array is None else self.rows, "previous": None,
                "tets": (self.tets, pinned(self.tets)) if self.tets is not None and borrows_tets else None}


class Mesh(Body):
    """A mesh of a grid, from `Grid.add` or `grid[id]`. It is a name only: the grid keeps the mesh. Where an id is wanted,
    a Mesh may be given, and the reverse."""

    __slots__ = ()

    @property
    def info(self) -> MeshInfo:
        """Counts and state, as they are now."""
        with self.grid._lock:
            i = self._raw_info()
        return MeshInfo(i.user_data, i.positions.count, i.tet_count, i.enabled_tet_count, bool(i.enabled),
                        bool(i.flags & _c.MeshFlags.COPY_POSITIONS), bool(i.flags & _c.MeshFlags.BORROW_TETS))

    # ---- positions ----

    @property
    def positions(self) -> Optional[NDArray[Any]]:
        """The array that the mesh borrows. If the mesh has positions of its own: the library's memory, writable. While
        such an array lives, what would end its memory raises BufferError (remove, new positions, clear, close). None if
        the mesh has no positions. Write to it in place (`mesh.positions[:] = moved`), or set it to have another array
        borrowed."""
        grid = self.grid
        with grid._lock:
            kept: Optional[Rows] = grid._keeps(self.id, "positions")
            info = self._raw_info()
            if kept is not None:
                return kept.array
            at = info.positions
            if not at.data:
                return None if at.count else np.empty((0, 3), np.float32)
            own = bool(info.flags & _c.MeshFlags.COPY_POSITIONS)  # else those of a body of a voxtet.sim
            address = ctypes.c_void_p(at.data)
            if own:
                vox.vox_mesh_map_positions(grid._pointer, self.id, address)
            kind = np.dtype(np.float64 if at.format == _c.Format.DOUBLE else np.float32)
            flat = borrow_of(address.value or 0, 3 * at.count, np.ndarray, kind, Lease(grid._handle, grid._exports_of(self.id)),
                             writable=own)
            mapped: NDArray[Any] = flat.reshape(-1, 3)
            return mapped

    @positions.setter
    def positions(self, positions: Any) -> None:
        grid = self.grid
        new = rows(positions, "positions")
        with grid._lock:
            info = self._raw_info()
            if info.flags & _c.MeshFlags.COPY_POSITIONS and bytes(info.positions) == bytes(new.struct):
                return  # mesh.positions += ... : its own already
            grid._refuse_positions(self.id, "new positions")
            with grid._lending(new):
                vox.vox_mesh_bind_positions(grid._pointer, self.id, new.struct)
                grid._keep(self.id, positions=new)

    @property
    def previous_positions(self) -> Optional[NDArray[Any]]:
        """An array that the mesh borrows, of where its vertices were before: each step then looks for IMPACT constraints, on the
        way from there to `positions`. None, as after a change of its vertices: the mesh stands still. Experimental."""
        with self.grid._lock:
            kept: Rows = self.grid._keeps(self.id, "previous") or NOTHING
            return kept.array

    @previous_positions.setter
    def previous_positions(self, positions: Any) -> None:
        grid = self.grid
        new = None if positions is None else rows(positions, "previous_positions")
        with grid._lock, grid._lending(new):
            vox.vox_mesh_bind_previous_positions(grid._pointer, self.id, None if new is None else new.struct)
            grid._keep(self.id, previous=new)

    # ---- tetrahedra and vertices ----

    def _as_it_collides(self) -> tuple[Any, NDArray[np.uint32], NDArray[np.bool_]]:
        """Positions with the transform, to the bit those that the grid computes; the tetrahedra that are there; and of all,
        which they are."""
        positions, (tets, enabled), transform = self.positions, self._tets(), self.transform
        if positions is not None and not np.array_equal(transform, np.eye(3, 4)):
            x, y, z = positions.T.astype(np.float64)
            positions = np.stack([((m[0] * x + m[1] * y) + m[2] * z) + m[3] for m in transform], axis=1)
        return positions, tets[enabled], enabled

    @property
    def tets(self) -> NDArray[np.uint32]:
        """A copy of the corners of all tetrahedra, (n, 4), with those that are disabled or removed."""
        return self._tets()[0]

    @property
    def tets_enabled(self) -> NDArray[np.bool_]:
        """For each tetrahedron, whether it is there: neither disabled nor removed."""
        return self._tets()[1]

    def _tets(self) -> tuple[NDArray[np.uint32], NDArray[np.bool_]]:
        with self.grid._lock:
            count = self._raw_info().tet_count
            corners, enabled = np.empty((count, 4), np.uint32), np.empty(count, np.bool_)
            vox.vox_mesh_get_tets(self.grid._pointer, self.id, corners.ctypes.data, enabled.ctypes.data, count,
                                   ctypes.c_uint64())
        return corners, enabled

    def set_tets_enabled(self, tets: ArrayLike, enabled: bool) -> None:
        """Turns tetrahedra off, or on again."""
        which, number = indices(tets, "tets"), switch(enabled, "enabled")
        with self.grid._lock:
            vox.vox_mesh_set_tets_enabled(self.grid._pointer, self.id, which.ctypes.data, len(which), number)
            self._own_tets()

    def replace_tets(self, tets: ArrayLike, corners: ArrayLike) -> None:
        """Gives tetrahedra other corners, (n, 4)."""
        which, new = indices(tets, "tets"), indices(corners, "corners", 4)
        if len(which) != len(new):
            raise InvalidArgumentError(f"there are {len(which)} tets and the corners of {len(new)}")
        with self.grid._lock:
            vox.vox_mesh_replace_tets(self.grid._pointer, self.id, which.ctypes.data, len(which), new.ctypes.data)
            self._own_tets()

    def append_tets(self, corners: ArrayLike) -> int:
        """Adds tetrahedra with these corners, (n, 4). Returns the index of the first."""
        new, first = indices(corners, "corners", 4), ctypes.c_uint32()
        with self.grid._lock:
            vox.vox_mesh_append_tets(self.grid._pointer, self.id, new.ctypes.data, len(new), first)
            self._own_tets()
        return first.value

    def remove_tets(self, tets: ArrayLike) -> None:
        """Removes tetrahedra. The others keep their indices."""
        which = indices(tets, "tets")
        with self.grid._lock:
            vox.vox_mesh_remove_tets(self.grid._pointer, self.id, which.ctypes.data, len(which))
            self._own_tets()

    def append_vertices(self, positions: Any = None, *, copies_of: Optional[ArrayLike] = None,
                        rest_positions: Any = None) -> int:
        """Adds vertices, and returns the index of the first. For a mesh that borrows its positions: `positions` is an array
        of all positions, those of the vertices it has first, and is borrowed from now on. For a mesh with positions of
        its own: those of the new vertices, copied, or None to copy them from the vertices `copies_of`."""
        grid = self.grid
        desc = described(_c.vox_vertices_desc)
        of = None if copies_of is None else indices(copies_of, "copies_of")
        rest = NOTHING if rest_positions is None else copied_rows(rest_positions, "rest_positions")
        with grid._lock:
            info = self._raw_info()
            own = bool(info.flags & _c.MeshFlags.COPY_POSITIONS)
            borrowed = not own and positions is not None
            new = NOTHING if positions is None else rows(positions, "positions") if borrowed else \
                copied_rows(positions, "positions")
            before = info.positions.count
            counts = [n for n in (None if positions is None else new.length - (before if borrowed else 0),
                                  None if of is None else len(of), None if rest_positions is None else rest.length)
                      if n is not None]
            if not counts or min(counts) != max(counts) or counts[0] < 0:
                raise InvalidArgumentError(f"mesh {self.id} of {before} vertices cannot get {counts} new ones, by "
                                           "positions, copies_of and rest_positions")
            desc.count = counts[0]
            desc.positions, desc.rest_positions = new.struct, rest.struct
            desc.copies_of = None if of is None else of.ctypes.data
            grid._refuse_positions(self.id, "new vertices")
            first = ctypes.c_uint32()
            with grid._lending(new):
                vox.vox_mesh_append_vertices(grid._pointer, self.id, desc, first)
                if borrowed:
                    grid._keep(self.id, positions=new)
                if counts[0]:
                    grid._keep(self.id, previous=None)
        return first.value

    def remove_vertices(self, vertices: ArrayLike) -> None:
        """Removes vertices that belong to no tetrahedron any more. The others keep their indices."""
        which = indices(vertices, "vertices")
        with self.grid._lock:
            vox.vox_mesh_remove_vertices(self.grid._pointer, self.id, which.ctypes.data, len(which))

    def set_topology(self, positions: Any, tets: Optional[ArrayLike] = None, *, vertex_count: Optional[int] = None,
                     copy: bool = False, rest_positions: Any = None, borrow_tets: bool = False) -> None:
        """Replaces tetrahedra, vertices and positions, as if the mesh had been added with these. Its id, tag, filter and
        transform stay. With positions None and as many vertices as before, it keeps its positions."""
        new = Topology(positions, tets, vertex_count, copy, rest_positions, borrow_tets)
        grid = self.grid
        with grid._lock:
            before = self._raw_info()
            if positions is None and vertex_count is None:
                new.desc.positions.count = before.positions.count
            keeps = positions is None and new.desc.positions.count == before.positions.count
            if not keeps:
                grid._refuse_positions(self.id, "new positions")
            kept = new.kept()
            if keeps:
                kept["positions"] = grid._keeps(self.id, "positions")
            with grid._lending(kept):
                vox.vox_mesh_set_topology(grid._pointer, self.id, new.desc)
                grid._keep(self.id, **kept)

    def _own_tets(self) -> None:
        """After an edit: tetrahedra that were borrowed have been copied."""
        if not self._raw_info().flags & _c.MeshFlags.BORROW_TETS:
            self.grid._keep(self.id, tets=None)
