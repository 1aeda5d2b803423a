"""Mesh files, ready-made bodies, surfaces filled with tetrahedra, and meshes of other packages.

>>> import voxtet.io
>>> ball = voxtet.io.make_ball(1.0, 0.25)
>>> ball.positions.shape[1], ball.tets.shape[1], ball.warnings
(3, 4, [])
>>> again = voxtet.io.read(voxtet.io.write(ball, "msh_22"), "ball.msh")
>>> bool((again.positions == ball.positions).all())
True
"""

from __future__ import annotations

import ctypes
import os
import sys
from typing import TYPE_CHECKING, Any, Callable, Mapping, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import U32, choice, copied_rows, indices, integer, real
from ._interop import arrays_of, triangles_of
from ._library import Handle, Relay, described, load_part, sized, values_of
from .errors import FileError, InvalidArgumentError, MissingFileError
from .results import borrow_of

if TYPE_CHECKING:
    import meshio
    import pyvista
    import trimesh

_io = load_part("vox_io")
_DOUBLE = np.dtype(np.float64)
_INDEX = np.dtype(np.uint32)

Path = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
Progress = Callable[[float], Any]


class Report(NamedTuple):
    """What was read, what was left out, and what is odd about a mesh (vox_io_report)."""

    format: int
    vertices: int
    tets: int
    triangles: int
    skipped_elements: int
    second_order_tets: int
    inverted_tets: int
    degenerate_tets: int
    nearly_flat_tets: int
    duplicate_tets: int
    degenerate_triangles: int
    duplicate_vertices: int
    unused_vertices: int
    boundary_facets: int
    non_manifold_facets: int
    open_edges: int
    misoriented_edges: int
    components: int
    volume: float
    bounds_min: tuple[float, float, float]
    bounds_max: tuple[float, float, float]
    unit_in_metres: float


class Quality(NamedTuple):
    """How good a tet mesh is, and how close its boundary is to a surface (vox_io_quality)."""

    vertices: int
    tets: int
    boundary_facets: int
    min_dihedral: float
    max_dihedral: float
    volume: float
    surface_volume: float
    mesh_to_surface: float
    surface_to_mesh: float
    hausdorff: float


class MeshData:
    """A mesh in memory that never changes: `positions` (n, 3) of doubles, `tets` (m, 4), `triangles` (k, 3). The arrays are
    the library's memory, read-only, and live as long as anybody has them. A body that moves needs a copy:
    `grid.add(data.positions.copy(), data.tets)`."""

    positions: NDArray[np.float64]
    tets: NDArray[np.uint32]
    triangles: NDArray[np.uint32]

    def __init__(self, positions: ArrayLike, tets: Optional[ArrayLike] = None, triangles: Optional[ArrayLike] = None) -> None:
        found = copied_rows(positions, "positions").array
        assert found is not None
        points = np.ascontiguousarray(found, np.float64)
        view = _c.vox_io_mesh_view()
        view.positions, view.vertex_count = points.ctypes.data, len(points)
        corners = indices([] if tets is None else tets, "tets", 4)
        view.tets, view.tet_count = corners.ctypes.data, len(corners)
        facets = indices([] if triangles is None else triangles, "triangles", 3)
        view.triangles, view.triangle_count = facets.ctypes.data, len(facets)
        pointer = ctypes.c_void_p()
        _io.vox_io_mesh_create(view, pointer)
        self._hold(pointer)

    @classmethod
    def _of(cls, pointer: ctypes.c_void_p) -> MeshData:
        data = cls.__new__(cls)
        data._hold(pointer)
        return data

    def _hold(self, pointer: ctypes.c_void_p) -> None:
        self._handle = Handle(pointer.value or 0, _io.vox_io_mesh_destroy)
        view = _c.vox_io_mesh_view()
        _io.vox_io_mesh_get_arrays(self._handle.pointer, view)
        for name, address, count, width, dtype in (("positions", view.positions, view.vertex_count, 3, _DOUBLE),
                                                   ("tets", view.tets, view.tet_count, 4, _INDEX),
                                                   ("triangles", view.triangles, view.triangle_count, 3, _INDEX)):
            flat = borrow_of(address, count * width, np.ndarray, dtype, self._handle)
            setattr(self, name, flat.reshape(-1, width))

    @property
    def report(self) -> Report:
        """What is in the mesh, and what is odd about it."""
        out = sized(_c.vox_io_report)
        _io.vox_io_mesh_get_report(self._handle.pointer, out)
        return values_of(Report, out)

    @property
    def warnings(self) -> list[str]:
        """The problems in the report as texts."""
        return _io.vox_io_mesh_get_warnings(self._handle.pointer).decode().splitlines()  # type: ignore[no-any-return]

    @property
    def format(self) -> str:
        """What it was read from, e.g. "Gmsh .msh"."""
        return _io.vox_io_format_string(self.report.format).decode()  # type: ignore[no-any-return]

    def __repr__(self) -> str:
        return (f"<voxtet.io.MeshData of {len(self.positions)} vertices, {len(self.tets)} tets, {len(self.triangles)} "
                "triangles>")

    def __reduce__(self) -> Any:
        return MeshData, (np.array(self.positions), np.array(self.tets), np.array(self.triangles))


def _load_desc(format: Union[str, _c.IoFormat], mesh_index: Optional[int]) -> Any:
    desc = described(_c.vox_io_load_desc)
    desc.format = choice(_c.IoFormat, format, "format")
    if mesh_index is not None:
        desc.mesh = 1 + integer(mesh_index, "mesh_index", 0, U32 - 1)
    return desc


def _bytes_of(path: Path) -> bytes:
    """A path as the library takes it: as the system has it, UTF-8 on Windows."""
    name = os.fspath(path)
    encoded = name if isinstance(name, bytes) else name.encode() if sys.platform == "win32" else os.fsencode(name)
    return _without_zero(encoded, "a path")


def _text(value: Any, what: str, errors: str = "strict") -> bytes:
    """A name as the library takes it."""
    if not isinstance(value, str):
        raise TypeError(f"{what} is of type {type(value).__name__}; it must be a string")
    return _without_zero(value.encode("utf-8", errors), what)


def _without_zero(encoded: bytes, what: str) -> bytes:
    if b"\0" in encoded:  # where the library would take it to end
        raise InvalidArgumentError(f"{what} must not have a zero in it")
    return encoded


def _with_reason(error: FileError, path: Path, opened: str) -> FileError:
    """The library's words with the system's number for what is wrong with the file: opening `opened` fails alike."""
    try:
        os.close(os.open(opened, os.O_RDONLY))
    except FileNotFoundError as reason:
        error = MissingFileError(*error.args)
        error.errno = reason.errno
    except OSError as reason:
        error.errno = reason.errno
    error.filename = os.fsdecode(path)
    return error


def load(path: Path, *, format: Union[str, _c.IoFormat] = "auto", mesh_index: Optional[int] = None) -> MeshData:
    """Reads a file: Gmsh, TetGen, Medit, Vega, VTK, VTU; surfaces: STL, OBJ, PLY, OFF, glTF. mesh_index: the one to take of a
    scene; None joins all."""
    desc, pointer = _load_desc(format, mesh_index), ctypes.c_void_p()
    try:
        _io.vox_io_load(_bytes_of(path), desc, pointer)
    except FileError as error:
        raise _with_reason(error, path, os.fsdecode(path)) from None
    return MeshData._of(pointer)


def read(data: Union[bytes, Mapping[str, bytes]], name: Optional[str] = None, *, format: Union[str, _c.IoFormat] = "auto",
         mesh_index: Optional[int] = None) -> MeshData:
    """The same from memory: the bytes of a file, whose name says the format where its content does not; or the bytes of
    several files by name (TetGen's .node and .ele)."""
    files = data if isinstance(data, Mapping) else {name: data}
    arrays = [np.frombuffer(content, np.uint8) if len(content) else np.empty(0, np.uint8) for content in files.values()]
    sources = (_c.vox_io_source * len(arrays))()
    for source, key, array in zip(sources, files, arrays):
        source.name = None if key is None else _text(key, "a name", "surrogateescape")
        source.data, source.size = array.ctypes.data, array.size
    desc, pointer = _load_desc(format, mesh_index), ctypes.c_void_p()
    _io.vox_io_read(sources, len(sources), desc, pointer)
    return MeshData._of(pointer)


def _data_of(mesh: Any) -> MeshData:
    if isinstance(mesh, MeshData):
        return mesh
    positions, tets, _ = arrays_of(mesh)
    return MeshData(positions, tets)


class _Writing:
    """vox_io_write_desc with the numbers it points to."""

    def __init__(self, data: MeshData, format: Union[str, _c.IoWriteFormat], binary: bool,
                 point_data: Optional[Mapping[str, ArrayLike]], cell_data: Optional[Mapping[str, ArrayLike]]) -> None:
        self.desc = described(_c.vox_io_write_desc)
        self.desc.format = choice(_c.IoWriteFormat, format, "format")
        self.desc.binary = int(bool(binary))
        self._kept: list[Any] = []
        self.desc.point_data, self.desc.point_data_count = self._fields(point_data, len(data.positions), "point_data")
        self.desc.cell_data, self.desc.cell_data_count = self._fields(
            cell_data, len(data.triangles) + len(data.tets), "cell_data")

    def _fields(self, fields: Optional[Mapping[str, ArrayLike]], count: int, what: str) -> tuple[Optional[int], int]:
        if not fields:
            return None, 0
        structs = (_c.vox_io_point_data * len(fields))()
        for struct, (name, given) in zip(structs, fields.items()):
            array = np.asarray(given)
            if array.dtype.kind not in "biuf":
                raise TypeError(f"{what}[{name!r}] has the dtype {array.dtype}; it must hold numbers")
            if array.ndim == 0 or len(array) != count:
                raise InvalidArgumentError(f"{what}[{name!r}] has the shape {array.shape}; it must have {count} rows")
            values = np.ascontiguousarray(array, np.float64)
            struct.name, struct.values = _text(name, f"a name in {what}"), values.ctypes.data
            struct.components = values.size // count if count else 1
            self._kept.append(values)
        self._kept.append(structs)
        return ctypes.addressof(structs), len(structs)


def save(mesh: Any, path: Path, *, format: Union[str, _c.IoWriteFormat] = "auto", binary: bool = False,
         point_data: Optional[Mapping[str, ArrayLike]] = None, cell_data: Optional[Mapping[str, ArrayLike]] = None) -> None:
    """Writes a mesh (MeshData, or of pyvista or meshio) as .msh or .vtu, with arrays by name: a row of 1, 3 or 9 numbers for
    each vertex, or for each cell (the triangles, then the tets)."""
    data = _data_of(mesh)
    writing = _Writing(data, format, binary, point_data, cell_data)
    try:
        _io.vox_io_write(data._handle.pointer, _bytes_of(path), writing.desc)
    except FileError as error:
        raise _with_reason(error, path, os.path.dirname(os.fsdecode(path)) or ".") from None


def write(mesh: Any, format: Union[str, _c.IoWriteFormat], *, binary: bool = False,
          point_data: Optional[Mapping[str, ArrayLike]] = None, cell_data: Optional[Mapping[str, ArrayLike]] = None) -> bytes:
    """The bytes that `save` would write, as "msh_22", "msh_41" or "vtu"."""
    data = _data_of(mesh)
    writing = _Writing(data, format, binary, point_data, cell_data)
    parts: list[bytes] = []

    def append(address: int, size: int, _user: Any) -> int:
        parts.append(ctypes.string_at(address, size))
        return 0

    sink, struct = Relay(append, 1), _c.vox_io_sink()
    struct.write = _c.vox_io_sink_write(sink)
    with sink:
        _io.vox_io_write_to(data._handle.pointer, writing.desc, struct)
    return b"".join(parts)


def tetrahedralize(surface: Any, cell: float = 0.0, *, kind: str = "stuffed", max_tets: int = 100000000,
                   max_distance: float = 0.0, coarsen: int = 0, progress: Optional[Progress] = None) -> MeshData:
    """Fills a closed surface (MeshData with triangles, or a surface of trimesh, pyvista or meshio) with tetrahedra. cell: edge of
    a lattice cube; 0: a fiftieth of the longest side. kind: "stuffed" or "cubes". progress: called with a fraction from 0 to
    1 now and then; a result that is true cancels, and Ctrl-C does."""
    data = surface if isinstance(surface, MeshData) else MeshData(*_surface(surface))
    desc = described(_c.vox_io_tetrahedralize_desc)
    desc.kind, desc.cell = choice(_c.IoSolidKind, kind, "kind"), real(cell, "cell")
    desc.max_tets, desc.max_distance = integer(max_tets, "max_tets"), real(max_distance, "max_distance")
    desc.coarsen = integer(coarsen, "coarsen", 0, U32)
    called = Relay(lambda fraction, _user: int(bool(progress is not None and progress(fraction))), 1)
    desc.progress = _c.vox_io_tetrahedralize_desc_progress(called)
    pointer = ctypes.c_void_p()
    with called:
        _io.vox_io_tetrahedralize(data._handle.pointer, desc, pointer)
        made = MeshData._of(pointer)
    return made


def _surface(mesh: Any) -> tuple[Any, None, Any]:
    positions, triangles = triangles_of(mesh)
    return positions, None, triangles


def quality(mesh: Any, surface: Any = None) -> Quality:
    """How good a mesh is, and how far its boundary is from a surface."""
    out = sized(_c.vox_io_quality)
    data = _data_of(mesh)
    other = None if surface is None else surface if isinstance(surface, MeshData) else MeshData(*_surface(surface))
    _io.vox_io_mesh_measure(data._handle.pointer, None if other is None else other._handle.pointer, out)
    return values_of(Quality, out)


def _made(function: Any, *numbers: Any) -> MeshData:
    pointer = ctypes.c_void_p()
    function(*numbers, pointer)
    return MeshData._of(pointer)


def make_lattice_ball(tet_count: int, radius: float) -> MeshData:
    """A ball of about so many tetrahedra, on a lattice of cubes."""
    return _made(_io.vox_io_make_lattice_ball, integer(tet_count, "tet_count"), real(radius, "radius"))


def make_ball(radius: float, cell: float) -> MeshData:
    """A ball around the origin, of good tetrahedra with edges of about `cell`."""
    return _made(_io.vox_io_make_ball, real(radius, "radius"), real(cell, "cell"))


def make_torus(radius: float, tube_radius: float, cell: float) -> MeshData:
    """A torus around the z axis; radius: from the axis to the middle of the tube."""
    return _made(_io.vox_io_make_torus, real(radius, "radius"), real(tube_radius, "tube_radius"), real(cell, "cell"))


def make_capsule(radius: float, length: float, cell: float) -> MeshData:
    """A capsule along the z axis; length: between the centres of the round ends."""
    return _made(_io.vox_io_make_capsule, real(radius, "radius"), real(length, "length"), real(cell, "cell"))


def make_cylinder(radius: float, length: float, cell: float) -> MeshData:
    """A cylinder along the z axis."""
    return _made(_io.vox_io_make_cylinder, real(radius, "radius"), real(length, "length"), real(cell, "cell"))


def make_box(size_x: float, size_y: float, size_z: float, cell: float) -> MeshData:
    """An exact box of cubes with edges of about `cell`, split into five tetrahedra each."""
    return _made(_io.vox_io_make_box, real(size_x, "size_x"), real(size_y, "size_y"), real(size_z, "size_z"),
                 real(cell, "cell"))


# ---- other packages -------------------------------------------------------------------------------


def from_meshio(mesh: meshio.Mesh) -> MeshData:
    """The tetrahedra and triangles of a mesh of meshio."""
    positions, tets, _ = arrays_of(mesh)
    return MeshData(positions, tets, mesh.cells_dict.get("triangle"))


def to_meshio(data: MeshData) -> meshio.Mesh:
    """For `meshio.write`."""
    import meshio
    cells = [(name, array.astype(np.int64)) for name, array in (("triangle", data.triangles), ("tetra", data.tets))
             if len(array)]
    return meshio.Mesh(np.array(data.positions), cells)


def from_pyvista(mesh: Union[pyvista.UnstructuredGrid, pyvista.PolyData]) -> MeshData:
    """The tetrahedra of an UnstructuredGrid, or the triangles of a PolyData."""
    if hasattr(mesh, "celltypes"):
        positions, tets, _ = arrays_of(mesh)
        return MeshData(positions, tets)
    return MeshData(*_surface(mesh))


def to_pyvista(data: Any) -> Union[pyvista.UnstructuredGrid, pyvista.PolyData]:
    """An UnstructuredGrid of the tetrahedra, or a PolyData of the triangles if there are none."""
    import pyvista
    positions, tets, _ = arrays_of(data)
    if len(tets):
        return pyvista.UnstructuredGrid({10: np.asarray(tets, np.int64)}, np.array(positions))
    faces = np.insert(np.asarray(data.triangles, np.int64), 0, 3, axis=1)
    return pyvista.PolyData(np.array(positions), faces.ravel())


def from_trimesh(mesh: trimesh.Trimesh) -> MeshData:
    """The surface, for `tetrahedralize`."""
    return MeshData(*_surface(mesh))


def to_trimesh(data: MeshData) -> trimesh.Trimesh:
    """The boundary of the tetrahedra, or the triangles if there are none."""
    import trimesh
    faces = boundary(data.tets) if len(data.tets) else data.triangles
    return trimesh.Trimesh(np.array(data.positions), faces.astype(np.int64), process=False)


def boundary(tets: ArrayLike) -> NDArray[np.uint32]:
    """The facets of exactly one tetrahedron, (k, 3), counter-clockwise as seen from outside where its volume is positive."""
    corners = indices(tets, "tets", 4)
    facets = corners[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)
    _, first, count = np.unique(np.sort(facets, axis=1), axis=0, return_index=True, return_counts=True)
    found: NDArray[np.uint32] = facets[np.sort(first[count == 1])]
    return found
