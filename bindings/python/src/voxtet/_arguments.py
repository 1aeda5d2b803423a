"""Checks of what callers pass. ctypes cuts numbers to size without a word and C reads arrays as it is told, so everything
that goes to the library goes through here."""

from __future__ import annotations

import ctypes
import enum
import numbers
import operator
from typing import Any, NamedTuple, Optional, TypeVar

import numpy as np
from numpy.typing import NDArray

from . import _c
from .errors import InvalidArgumentError

U32 = 2**32 - 1
U64 = 2**64 - 1

_Enum = TypeVar("_Enum", bound=enum.IntEnum)

DOUBLES = ctypes.c_double * 3
MATRIX = ctypes.c_double * 12


def integer(value: Any, name: str, low: int = 0, high: int = U64) -> int:
    """An int from low to high."""
    if isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} is a bool; it must be an integer")
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is of type {type(value).__name__}; it must be an integer") from None
    if not low <= number <= high:
        raise InvalidArgumentError(f"{name} is {number}; it must be from {low} to {high}")
    return number


def real(value: Any, name: str) -> float:
    """A float. The library checks its range."""
    if not isinstance(value, numbers.Real) or isinstance(value, bool):
        raise TypeError(f"{name} is of type {type(value).__name__}; it must be a number")
    try:
        return float(value)
    except OverflowError:
        raise InvalidArgumentError(f"{name} is too large for a double") from None


def switch(value: Any, name: str) -> int:
    """1 or 0 for a bool."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} is of type {type(value).__name__}; it must be True or False")
    return int(value)


def choice(kind: type[_Enum], value: Any, name: str) -> int:
    """The number of a member of an enum, which is given by its name in lower case, or as the member."""
    if isinstance(value, str):
        found = kind.__members__.get(value.upper()) if value == value.lower() else None
    elif isinstance(value, kind):
        found = value
    else:
        raise TypeError(f"{name} is of type {type(value).__name__}; it must be a string")
    if found is None:
        names = ", ".join(repr(n.lower()) for n in kind.__members__)
        raise InvalidArgumentError(f"{name} is {value!r}; it must be one of {names}")
    return int(found)


def vector(value: Any, name: str) -> Any:
    """Three doubles."""
    return _doubles(value, name, (3,), DOUBLES)


def _doubles(value: Any, name: str, shape: tuple[int, ...], kind: Any) -> Any:
    try:
        array = np.asarray(value)
    except ValueError:
        array = np.empty((), object)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must hold {' x '.join(map(str, shape))} numbers")
    if array.shape != shape:
        raise InvalidArgumentError(f"{name} has the shape {array.shape}; it must be {shape}")
    return kind(*array.astype(np.float64).ravel().tolist())


def weights_pointer(value: Any) -> Any:
    """A pointer to vox_cost_weights; None for None: those shipped with the library."""
    if value is None:
        return None
    ns = _doubles(value, "weights", (_c.VOX_COST_WEIGHT_CAPACITY,), ctypes.c_double * _c.VOX_COST_WEIGHT_CAPACITY)
    return ctypes.pointer(_c.vox_cost_weights(ctypes.sizeof(_c.vox_cost_weights), 0, ns))


def matrix(value: Any, name: str) -> Any:
    """Three rows of four numbers; a fourth row must be 0 0 0 1."""
    array = np.asarray(value)
    if array.shape == (4, 4):
        if array.dtype.kind not in "iuf":
            raise TypeError(f"{name} must hold numbers")
        if not np.array_equal(array[3], [0, 0, 0, 1]):
            raise InvalidArgumentError(f"{name} has the last row {array[3].tolist()}; it must be 0 0 0 1")
        array = array[:3]
    return _doubles(array, name, (3, 4), MATRIX)


class Rows(NamedTuple):
    """Positions as the library reads them. `array` keeps them alive."""

    array: Optional[NDArray[Any]]
    struct: Any  # vox_positions
    pin: Any = None  # a memoryview of the memory below the array, so that nobody closes a mapping that is in use


    @property
    def length(self) -> int:
        return int(self.struct.count)


NOTHING = Rows(None, _c.vox_positions())

_DEVICES = {2: "CUDA", 4: "OpenCL", 7: "Vulkan", 8: "Metal", 10: "ROCm", 13: "CUDA managed memory", 14: "oneAPI"}


def array_of(value: Any, name: str) -> NDArray[Any]:
    """`value` as a numpy array over the same memory: an array already, or what has __dlpack__ (torch, jax)."""
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array; fill it first")
    if isinstance(value, np.ndarray):
        return value
    device = getattr(value, "__dlpack_device__", None)
    if device is None:
        raise TypeError(f"{name} is of type {type(value).__name__}; it must be a numpy array, or have __dlpack__")
    kind, number = device()
    if kind not in (1, 3):  # the CPU's memory; the same, pinned for CUDA
        raise TypeError(f"{name} is on the device {_DEVICES.get(int(kind), int(kind))}:{number}; it must be in the memory "
                        "of the CPU")
    found: NDArray[Any] = np.from_dlpack(value)
    return found


def pinned(array: NDArray[Any]) -> Any:
    """To be kept with an array that the library goes on reading. numpy holds the object that memory comes from (a mapping, shared memory), but does not keep it from being closed."""
    base: Any = array
    while isinstance(base, np.ndarray):
        base = base.base
    try:
        return None if base is None else memoryview(base)
    except TypeError:
        return None


def rows(value: Any, name: str) -> Rows:
    """Borrows n x 3 floats or doubles with any strides that the library can follow: rows, or whole columns."""
    array = array_of(value, name)
    if array.dtype != np.float32 and array.dtype != np.float64:
        raise TypeError(f"{name} has the dtype {array.dtype}; it must be float32 or float64, for example "
                        f"{name}.astype(numpy.float32)")
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidArgumentError(f"{name} has the shape {array.shape}; it must be (n, 3)")
    if not array.flags.aligned:
        raise InvalidArgumentError(f"{name} is not aligned to {array.itemsize} bytes; copy it with numpy.array")
    count, size = array.shape[0], array.itemsize
    row, component = array.strides
    if count == 0:
        row, component = 3 * size, size
    elif count == 1:  # numpy's stride means nothing where there is no second row
        row = 3 * size if component == size else size
    fits = row >= 3 * size if component == size else row >= size and component >= count * row
    if not fits:
        raise InvalidArgumentError(
            f"{name} has the strides {array.strides} (shape {array.shape}, {array.dtype}); the library reads rows "
            f"(n or more, {size}) or whole columns ({size} or more, n times that). Copy it with numpy.ascontiguousarray")
    return Rows(array, _c.vox_positions(array.ctypes.data, count, _c.Format.FLOAT if size == 4 else _c.Format.DOUBLE, 0, row,
                                        component), pinned(array))


def _array_or_sequence(value: Any, name: str) -> NDArray[Any]:
    return array_of(value, name) if hasattr(value, "__dlpack_device__") else np.asarray(value)


def copied_rows(value: Any, name: str) -> Rows:
    """The same for positions that the library copies: any strides, and sequences of floats."""
    array = _array_or_sequence(value, name)
    return rows(np.ascontiguousarray(array) if array.ndim == 2 else array, name)


def points(value: Any, name: str = "points") -> Rows:
    """Points of a query: also integers and sequences, which are converted."""
    array = _array_or_sequence(value, name)
    return copied_rows(array.astype(np.float64) if array.dtype.kind in "iu" else array, name)


def indices(value: Any, name: str, width: int = 1) -> NDArray[np.uint32]:
    """Indices as the library wants them. Those that 32 bits do not hold raise: numpy would wrap them silently."""
    array = _array_or_sequence(value, name)
    if array.size == 0 and array.dtype.kind == "f" and not isinstance(value, np.ndarray):
        array = array.astype(np.uint32)  # an empty list
        array = array.reshape(0, width) if width > 1 else array
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} has the dtype {array.dtype}; it must hold integers")
    if array.ndim != (2 if width > 1 else 1) or (width > 1 and array.shape[1] != width):
        shape = f"(n, {width})" if width > 1 else "(n,)"
        raise InvalidArgumentError(f"{name} has the shape {array.shape}; it must be {shape}")
    if array.size and array.dtype != np.uint32 and not np.can_cast(array.dtype, np.uint32):
        for extreme in (array.min(), array.max()):
            if not 0 <= int(extreme) <= U32:
                where = tuple(int(i) for i in np.argwhere(array == extreme)[0])
                raise InvalidArgumentError(f"{name}{list(where)} is {extreme}; indices are from 0 to {U32}")
    return np.ascontiguousarray(array, np.uint32)
