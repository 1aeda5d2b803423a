"""What meshes and shapes of a grid have in common, and what they do not collide with."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import U32, U64, integer, matrix, real, switch
from ._library import sized, vox

if TYPE_CHECKING:
    from .grid import Grid


@dataclasses.dataclass(frozen=True)
class Filter:
    """What a mesh does not collide with. `dataclasses.replace(mesh.filter, category=2)` changes one of them."""

    group: int = 0  # meshes with the same group collide if it is positive, and do not if it is negative
    category: int = 1  # otherwise they do if the category of each has a bit in common with the mask of the other
    mask: int = U64
    world: int = 0  # meshes of different worlds never collide: for copies of a scene in one grid
    self_collision: bool = False  # vertices of the mesh inside its own tetrahedra are contacts
    self_rings: int = 0  # ... but not those within so many edges of the tetrahedron
    self_rest_distance: float = 0.0  # ... nor those closer to it than this in the rest pose
    sensor: bool = False  # the mesh has contacts and pairs, but no constraints

    def _struct(self) -> Any:
        out = _c.vox_filter()
        out.group = integer(self.group, "group", -2**31, 2**31 - 1)
        out.category, out.mask = integer(self.category, "category"), integer(self.mask, "mask")
        out.world = integer(self.world, "world", 0, U32)
        out.flags = (switch(self.self_collision, "self_collision") * _c.FilterFlags.SELF_COLLISION
                     | switch(self.sensor, "sensor") * _c.FilterFlags.SENSOR)
        out.self_rings = integer(self.self_rings, "self_rings", 0, U32)
        out.self_rest_distance = real(self.self_rest_distance, "self_rest_distance")
        return out


class Body:
    """A mesh or a shape of a grid. It is a name only: the grid keeps the body. Where an id is wanted, a Body may be given, and
    the reverse."""

    __slots__ = ("grid", "id")

    def __init__(self, grid: Grid, id: int) -> None:
        self.grid = grid
        self.id = id

    def __index__(self) -> int:
        return self.id

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Body) and other.grid is self.grid and other.id == self.id

    def __hash__(self) -> int:
        return hash((id(self.grid), self.id))

    def __repr__(self) -> str:
        tag = f", tag={self.tag!r}" if self.tag is not None else ""
        return f"<voxtet.{type(self).__name__} {self.id}{tag if self.valid else ', removed'}>"

    @property
    def valid(self) -> bool:
        """Whether it is still in the grid."""
        return self.grid._pointer is not None and self in self.grid

    @property
    def tag(self) -> Any:
        """Any object of yours."""
        return self.grid._tags.get(self.id)

    @tag.setter
    def tag(self, tag: Any) -> None:
        with self.grid._lock:
            self._raw_info()
            self.grid._tags[self.id] = tag

    def _raw_info(self) -> Any:
        info = sized(_c.vox_body_info)
        vox.vox_body_get_info(self.grid._pointer, self.id, info)
        return info

    @property
    def user_data(self) -> int:
        """The number that it was added with."""
        number = ctypes.c_uint64()
        with self.grid._lock:
            vox.vox_body_get_user_data(self.grid._pointer, self.id, number)
        return number.value

    @property
    def transform(self) -> NDArray[np.float64]:
        """The affine map of the positions, three rows of four numbers; for a shape it rotates, moves, and scales all axes alike.
        Set it to such an array, to one of (4, 4) with the last row 0 0 0 1, or to None for no transform."""
        with self.grid._lock:
            return np.array(self._raw_info().transform[:]).reshape(3, 4)

    @transform.setter
    def transform(self, transform: Optional[ArrayLike]) -> None:
        numbers = None if transform is None else matrix(transform, "transform")
        with self.grid._lock:
            vox.vox_body_set_transform(self.grid._pointer, self.id, numbers)

    def mark_moved(self) -> None:
        """Makes the next step process it even if it is at rest."""
        with self.grid._lock:
            vox.vox_body_mark_moved(self.grid._pointer, self.id)

    @property
    def filter(self) -> Filter:
        """What it does not collide with."""
        with self.grid._lock:
            info = self._raw_info()
        f, flags = info.filter, _c.FilterFlags(info.filter.flags)
        return Filter(f.group, f.category, f.mask, f.world, _c.FilterFlags.SELF_COLLISION in flags, f.self_rings,
                      f.self_rest_distance, _c.FilterFlags.SENSOR in flags)

    @filter.setter
    def filter(self, filter: Filter) -> None:
        if not isinstance(filter, Filter):
            raise TypeError(f"filter is of type {type(filter).__name__}; it must be a voxtet.Filter")
        struct = filter._struct()
        with self.grid._lock:
            vox.vox_body_set_filter(self.grid._pointer, self.id, struct)

    @property
    def enabled(self) -> bool:
        """Whether it takes part in the following steps."""
        with self.grid._lock:
            return bool(self._raw_info().enabled)

    @enabled.setter
    def enabled(self, enabled: bool) -> None:
        number = switch(enabled, "enabled")
        with self.grid._lock:
            vox.vox_body_set_enabled(self.grid._pointer, self.id, number)

    def remove(self) -> None:
        """Removes it from its grid."""
        self.grid.remove(self)
