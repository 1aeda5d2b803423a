"""Rigid shapes of a grid: floors, tools, terrain. The vertices of meshes collide with them. Experimental."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import Any, Callable, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import indices, matrix, points, real, vector
from ._library import described, vox
from .body import Body
from .errors import InvalidArgumentError

Function = Callable[[NDArray[np.float64]], "tuple[ArrayLike, ArrayLike]"]


class FieldCall:
    """A function of numpy arrays as the library calls it, on threads of a step. What it raises is kept, and the step fails for a
    distance that is no number."""

    def __init__(self, function: Function) -> None:
        self._function = function
        self._raised: Optional[BaseException] = None
        self.c = _c.vox_shape_desc_field(self._call)

    def _call(self, at: int, count: int, distances: int, gradients: int, _user: Any) -> None:
        out, out_gradients = _doubles_at(distances, (count,)), _doubles_at(gradients, (count, 3))
        out[:] = np.nan
        if self._raised is None:
            try:
                found, found_gradients = self._function(_doubles_at(at, (count, 3)).copy())
                out_gradients[:] = found_gradients
                out[:] = found
            except BaseException as error:
                self._raised = error

    def raised(self) -> Optional[BaseException]:
        """What the function has raised since the last call."""
        error, self._raised = self._raised, None
        return error


def _doubles_at(address: int, shape: tuple[int, ...]) -> NDArray[np.float64]:
    buffer: Any = (ctypes.c_double * int(np.prod(shape))).from_address(address)
    found: NDArray[np.float64] = np.frombuffer(buffer, np.float64).reshape(shape)
    return found


class Shape(Body):
    """A rigid shape of a grid, from `Grid.add_shape` or `grid[id]`. It is a name only, as a Mesh is."""

    __slots__ = ()

    @property
    def kind(self) -> _c.ShapeKind:
        """What it is."""
        with self.grid._lock:
            return _c.ShapeKind(self._raw_info().shape)

    def set_previous_transform(self, transform: Optional[ArrayLike]) -> None:
        """Says where the shape was before: each step then looks for IMPACT constraints, on the way from there to `transform`.
        None: it stands still."""
        numbers = None if transform is None else matrix(transform, "previous_transform")
        with self.grid._lock:
            vox.vox_shape_set_previous_transform(self.grid._pointer, self.id, numbers)


class Geometry:
    """A kind of shape, for `Grid.add_shape`. It lies in a frame of its own; a transform places it."""

    def _fill(self, desc: Any) -> Any:
        """Writes the fields of a vox_shape_desc, and returns what must live as long as the shape or, if longer, the call."""
        raise NotImplementedError

    def _described(self) -> tuple[Any, Any]:
        desc = described(_c.vox_shape_desc)
        desc.kind = self._KIND
        return desc, self._fill(desc)

    _KIND = _c.ShapeKind.NONE


@dataclasses.dataclass(frozen=True)
class HalfSpace(Geometry):
    """All z <= 0: a floor."""

    _KIND = _c.ShapeKind.HALF_SPACE

    def _fill(self, desc: Any) -> Any:
        return None


@dataclasses.dataclass(frozen=True)
class Sphere(Geometry):
    """A ball around the origin."""

    radius: float
    _KIND = _c.ShapeKind.SPHERE

    def _fill(self, desc: Any) -> Any:
        desc.radius = real(self.radius, "radius")


@dataclasses.dataclass(frozen=True)
class Capsule(Geometry):
    """Along the z axis, around the origin; half_length is half the distance between the centres of its round ends."""

    radius: float
    half_length: float
    _KIND = _c.ShapeKind.CAPSULE

    def _fill(self, desc: Any) -> Any:
        desc.radius, desc.half_length = real(self.radius, "radius"), real(self.half_length, "half_length")


@dataclasses.dataclass(frozen=True)
class Cylinder(Capsule):
    """Along the z axis, around the origin, with flat ends."""

    _KIND = _c.ShapeKind.CYLINDER


@dataclasses.dataclass(frozen=True)
class Box(Geometry):
    """Around the origin, with these half sides, three numbers."""

    half_size: Any
    _KIND = _c.ShapeKind.BOX

    def _fill(self, desc: Any) -> Any:
        desc.half_size = vector(self.half_size, "half_size")


@dataclasses.dataclass(frozen=True, eq=False)
class Heightfield(Geometry):
    """Terrain, solid below. heights[row, column] is z at x = column * spacing[0], y = row * spacing[1]; spacing is a number or two.
    Between four heights are two triangles, with the diagonal from the lower left to the upper right."""

    heights: Any
    spacing: Any = 1.0
    _KIND = _c.ShapeKind.HEIGHTFIELD

    def _fill(self, desc: Any) -> Any:
        heights = np.asarray(self.heights)
        if heights.dtype.kind not in "iuf":
            raise TypeError(f"heights has the dtype {heights.dtype}; it must hold numbers")
        if heights.ndim != 2:
            raise InvalidArgumentError(f"heights has the shape {heights.shape}; it must be (rows, columns)")
        heights = np.ascontiguousarray(heights, np.float64)
        desc.rows, desc.columns = heights.shape
        desc.heights = heights.ctypes.data
        spacing = [self.spacing] * 2 if np.ndim(self.spacing) == 0 else list(self.spacing)
        if len(spacing) != 2:
            raise InvalidArgumentError(f"spacing has {len(spacing)} numbers; it must be one or two")
        desc.spacing[:] = [real(step, "spacing") for step in spacing]
        return heights


@dataclasses.dataclass(frozen=True, eq=False)
class Solid(Geometry):
    """The inside of a closed surface: points (n, 3), triangles (m, 3), counter-clockwise as seen from outside."""

    points: Any
    triangles: Any
    _KIND = _c.ShapeKind.SOLID

    def _fill(self, desc: Any) -> Any:
        at, corners = points(self.points), indices(self.triangles, "triangles", 3)
        desc.positions = at.struct
        desc.triangles, desc.triangle_count = corners.ctypes.data, len(corners)
        return at, corners


@dataclasses.dataclass(frozen=True, eq=False)
class Sheet(Solid):
    """What is within `radius` of triangles: a blade, a wall. It has two sides."""

    radius: float = 0.0
    _KIND = _c.ShapeKind.SHEET

    def _fill(self, desc: Any) -> Any:
        desc.radius = real(self.radius, "radius")
        return super()._fill(desc)


def Polyline(points: ArrayLike, radius: float = 0.0) -> Sheet:
    """The Sheet of what is within `radius` of the segments between points (n, 3), one after the other: a needle, a thread."""
    first = np.arange(max(len(points) - 1, 0), dtype=np.uint32)  # type: ignore[arg-type]
    return Sheet(points, np.stack([first, first + 1, first + 1], axis=1), radius)


@dataclasses.dataclass(frozen=True, eq=False)
class Field(Geometry):
    """Where a function is not positive, in a box around the origin with these half sides.

    `function` takes points (n, 3) in the shape's frame, at most 8, and returns distances (n,) and gradients (n, 3). Of a point
    outside, the distance is at most the true one; of a point inside it is not above 0. Gradients point out of the shape; their
    length does not matter. Steps call it, also from other threads, and raise what it raises. It must not call the grid."""

    function: Function
    half_size: Any
    _KIND = _c.ShapeKind.FIELD

    def _fill(self, desc: Any) -> Any:
        if not callable(self.function):
            raise TypeError(f"function is of type {type(self.function).__name__}; it must be a function of points")
        desc.half_size = vector(self.half_size, "half_size")
        call = FieldCall(self.function)
        desc.field = call.c
        return call
