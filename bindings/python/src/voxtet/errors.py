"""Exceptions: one class for each result code of the library, each also of the built-in kind that a program would catch."""

from __future__ import annotations

import os
import sys
import warnings
from types import FrameType
from typing import Optional

from . import _c


class VoxError(Exception):
    """What the library refused, in its own words. `code` says why."""

    code = _c.Result.ERROR_INTERNAL


class InvalidArgumentError(VoxError, ValueError):
    """An argument is out of range, or does not have the shape or the strides that it should have."""

    code = _c.Result.ERROR_INVALID_ARGUMENT


class InvalidHandleError(VoxError, LookupError):
    """An id names no mesh of the grid."""

    code = _c.Result.ERROR_INVALID_HANDLE


class InvalidMeshError(VoxError, ValueError):
    """A tetrahedron names a vertex that does not exist."""

    code = _c.Result.ERROR_INVALID_MESH


class InvalidStateError(VoxError, RuntimeError):
    """The call does not fit the state, e.g. the grid is closed."""

    code = _c.Result.ERROR_INVALID_STATE


class NonFiniteError(VoxError, ArithmeticError, ValueError):
    """A position is NaN or infinite."""

    code = _c.Result.ERROR_NON_FINITE


class LimitError(VoxError, OverflowError):
    """A documented limit would be passed."""

    code = _c.Result.ERROR_LIMIT


class BudgetError(VoxError, MemoryError):
    """The grid's byte budget would be passed."""

    code = _c.Result.ERROR_BUDGET


class OutOfMemoryError(VoxError, MemoryError):
    """There is no memory left."""

    code = _c.Result.ERROR_OUT_OF_MEMORY


class UnsupportedError(VoxError, NotImplementedError):
    """Recognised, but not supported by this build or version."""

    code = _c.Result.ERROR_UNSUPPORTED


class FileError(VoxError, OSError):
    """A file cannot be opened, read or written; `errno` and `filename` where they are known, `strerror` and the text are the
    library's."""

    code = _c.Result.ERROR_FILE

    def __str__(self) -> str:  # OSError's would be without the text
        return str(self.args[0]) if self.args else super().__str__()


class MissingFileError(FileError, FileNotFoundError):
    """There is no such file."""


class FormatError(VoxError, ValueError):
    """A file or snapshot is malformed."""

    code = _c.Result.ERROR_FORMAT


class InternalError(VoxError, RuntimeError):
    """A defect of the library: please report it."""


class MeshWarning(UserWarning):
    """What is odd about a mesh that was loaded, or what of it was left out; in `MeshData.warnings`, too."""


def warn(text: str) -> None:
    """A MeshWarning at the line of the program that called into this package."""
    here = os.path.dirname(os.path.abspath(__file__))
    level, frame = 2, sys._getframe(1)  # type: tuple[int, Optional[FrameType]]
    while frame is not None and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == here:
        level, frame = level + 1, frame.f_back
    warnings.warn(text, MeshWarning, stacklevel=level)


_CLASSES: dict[int, type[VoxError]] = {kind.code: kind for kind in (
    InvalidArgumentError, InvalidHandleError, InvalidMeshError, InvalidStateError, NonFiniteError, LimitError, BudgetError,
    OutOfMemoryError, UnsupportedError, FileError, FormatError, InternalError)}


def error_of(code: int, text: str) -> VoxError:
    """The exception for a result code; InternalError for one that a later library may have."""
    return _CLASSES.get(code, InternalError)(text)
