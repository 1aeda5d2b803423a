"""Finds and loads the native libraries, and turns their results into exceptions."""

from __future__ import annotations

import ctypes
import os
import sys
from typing import Any, Callable, Optional, TypeVar

from . import _c
from .errors import InvalidStateError, MissingFileError, error_of

_HERE = os.path.dirname(os.path.abspath(__file__))
_OF_A_BUILD = ("src", "src/io", "src/sim", "src/dist", "bin")  # where CMake leaves the libraries, bin on Windows
_Struct = TypeVar("_Struct", bound=ctypes.Structure)
_Values = TypeVar("_Values")


def file_name(name: str) -> str:
    """What the shared library `name` (vox, vox_io, vox_sim, vox_dist) is called on this system."""
    if sys.platform == "win32":
        return name + ".dll"
    if sys.platform == "darwin":
        return f"lib{name}.{_c.VOX_ABI_VERSION}.dylib"
    return f"lib{name}.so.{_c.VOX_ABI_VERSION}"


def _named() -> list[str]:
    """The folders in VOXTET_LIBRARY_DIR, each a build folder or one that holds libraries."""
    return [folder for folder in os.environ.get("VOXTET_LIBRARY_DIR", "").split(os.pathsep) if folder]


def find(name: str) -> str:
    """The file to load: the package's own; else that of a folder in VOXTET_LIBRARY_DIR; else whatever the system finds by
    that name."""
    folders = [os.path.join(_HERE, "bin" if sys.platform == "win32" else "lib")]  # DLLs lie beside the tool, which finds them there
    for named in _named():
        folders += [named, *(os.path.join(named, part) for part in _OF_A_BUILD)]
    for folder in folders:
        path = os.path.join(folder, file_name(name))
        if os.path.exists(path):
            return path
    return file_name(name)


def tool() -> str:
    """The native command line, vox: the package's own; else that of a build folder in VOXTET_LIBRARY_DIR."""
    name = "vox.exe" if sys.platform == "win32" else "vox"
    own = os.path.join(_HERE, "bin", name)
    for path in (own, *(os.path.join(folder, part, name) for folder in _named() for part in ("tools", "bin"))):
        if os.path.exists(path):
            return path
    raise MissingFileError(f"there is no {own}; the wheels have it")


def load(name: str) -> Any:
    """The library `name`, with the types of its functions. vox_io and vox_sim find the libvox that was loaded before."""
    path = find(name)
    try:
        library = ctypes.CDLL(path, mode=ctypes.RTLD_GLOBAL)
    except OSError as error:
        named = os.pathsep.join(_named())
        if named and path == file_name(name):
            help = f"VOXTET_LIBRARY_DIR is {named}, where it is not built: cmake --build BUILD_FOLDER --target {name}"
        else:
            help = "The wheels have it inside; in a clone, name the build folder: VOXTET_LIBRARY_DIR=build/release"
        raise ImportError(f"voxtet cannot load {path} ({error}). {help}") from error
    return library


# What the library says of a null pointer, which it gets when a thread waited for a lock while another closed what it is of.
_CLOSED = {"grid is null": "the grid is closed", "sim is null": "the simulation is closed"}


def check(result: int, _function: Any, _arguments: Any) -> int:
    """The errcheck of every function that can fail. The text is that of this thread's last failure."""
    if result:
        text = vox.vox_last_error().decode("utf-8", "replace")
        if text in _CLOSED:
            raise InvalidStateError(_CLOSED[text])
        raise error_of(result, text)
    return result


def _load_vox() -> Any:
    library = load("vox")
    try:
        library.vox_abi_version.restype = ctypes.c_uint32
        found = library.vox_abi_version()
    except AttributeError:
        found = 0
    if found != _c.VOX_ABI_VERSION:
        raise ImportError(f"{find('vox')} has version {found} of the binary interface; this package was made for version "
                          f"{_c.VOX_ABI_VERSION}")
    for header in ("vox", "vox_query", "vox_cell_size", "vox_surface"):
        _c.declare(library, header, check)
    return library


def load_part(name: str) -> Any:
    """vox_io or vox_sim."""
    library = load(name)
    _c.declare(library, name, check)
    return library


vox: Any = _load_vox()


def described(kind: type[_Struct]) -> _Struct:
    """A struct with the library's defaults."""
    desc = kind()
    if hasattr(desc, "struct_size"):
        desc.struct_size = ctypes.sizeof(kind)
    for name, value in _c.DEFAULTS.get(kind.__name__, {}).items():
        if isinstance(value, list):
            getattr(desc, name)[:] = value
        else:
            setattr(desc, name, value)
    return desc


def values_of(kind: type[_Values], struct: Any) -> _Values:
    """The fields of a struct that a NamedTuple names; arrays as tuples."""
    values = (getattr(struct, name) for name in kind._fields)  # type: ignore[attr-defined]
    return kind(*(tuple(v) if isinstance(v, ctypes.Array) else v for v in values))


def sized(kind: type[_Struct]) -> Any:
    """A struct for the library to fill."""
    out = kind()
    out.struct_size = ctypes.sizeof(kind)
    return out


class Relay:
    """A function for the library to call, and what it raised: a callback must not raise. From then on it answers `stopped`,
    which ends the call of the library. `with relay:` around that call raises it; also Ctrl-C, which Python notices in it."""

    def __init__(self, function: Callable[..., Any], stopped: Any) -> None:
        self._function = function
        self._stopped = stopped
        self._raised: Optional[BaseException] = None

    def __call__(self, *arguments: Any) -> Any:
        if self._raised is None:
            try:
                return self._function(*arguments)
            except BaseException as error:
                self._raised = error
        return self._stopped

    def __enter__(self) -> None:
        pass

    def __exit__(self, *_: object) -> None:
        if self._raised is not None:
            raise self._raised from None


class Handle:
    """Owns something of the library's, and destroys it with the last reference to the handle."""

    __slots__ = ("__weakref__", "destroy", "kept", "pointer")

    def __init__(self, pointer: int, destroy: Any, kept: Any = None) -> None:
        self.pointer = pointer
        self.destroy = destroy
        self.kept = kept  # what the library may call or read until then

    def __del__(self) -> None:
        self.destroy(self.pointer)
