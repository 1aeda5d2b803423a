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
import html
import os
import sys
from typing import TYPE_CHECKING, Any, Callable, Mapping, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _c
from ._arguments import U32, choice, copied_rows, indices, integer, real, switch
from ._interop import Parts, arrays_of, is_mesh, parts_of, triangles_of
from ._library import Handle, Relay, described, load_part, sized, values_of
from .errors import FileError, InvalidArgumentError, MissingFileError, warn
from .grid import Grid
from .results import borrow_of

if TYPE_CHECKING:
    import meshio
    import pyvista
    import trimesh

_io = load_part("vox_io")
_DOUBLE = np.dtype(np.float64)
_INDEX = np.dtype(np.uint32)
_REGION = np.dtype(np.int32)

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
    left_out_vertices: int
    left_out_triangles: int
    split_cells: int
    left_out_tets: int


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
    the library's memory, read-only, and live as long as anybody has them. A body that moves needs a copy, which
    `grid.add(data)` makes.

    `regions`: a number for each tet (physical groups of Gmsh, references of Medit, cell data of VTK), or None.
    `file_vertices`: for each vertex its number in the file or mesh that it comes from, from 0, where vertices were left out;
    else None. Values for the vertices go back by `of_file[data.file_vertices] = values`. `cells`: for each tet the number of its
    cell in the file or mesh, from 0 through cells of every kind, where that differs from its own; else None."""

    positions: NDArray[np.float64]
    tets: NDArray[np.uint32]
    triangles: NDArray[np.uint32]
    regions: Optional[NDArray[np.int32]]
    file_vertices: Optional[NDArray[np.uint32]]
    cells: Optional[NDArray[np.uint32]]

    def __init__(self, positions: ArrayLike, tets: Optional[ArrayLike] = None, triangles: Optional[ArrayLike] = None,
                 regions: Optional[ArrayLike] = None, file_vertices: Optional[ArrayLike] = None,
                 cells: Optional[ArrayLike] = None) -> None:
        found = copied_rows(positions, "positions").array
        assert found is not None
        points = np.ascontiguousarray(found, np.float64)
        view = _c.vox_io_mesh_view()
        view.positions, view.vertex_count = points.ctypes.data, len(points)
        corners = indices([] if tets is None else tets, "tets", 4)
        view.tets, view.tet_count = corners.ctypes.data, len(corners)
        facets = indices([] if triangles is None else triangles, "triangles", 3)
        view.triangles, view.triangle_count = facets.ctypes.data, len(facets)
        of_tets = _column(regions, "regions", len(corners), _REGION)
        of_vertices = _column(file_vertices, "file_vertices", len(points), _INDEX)
        of_cells = _column(cells, "cells", len(corners), _INDEX)
        view.tet_regions = None if of_tets is None else of_tets.ctypes.data
        view.file_vertices = None if of_vertices is None else of_vertices.ctypes.data
        view.tet_cells = None if of_cells is None else of_cells.ctypes.data
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
        self.regions = self.file_vertices = self.cells = None
        if view.tet_regions:
            self.regions = borrow_of(view.tet_regions, view.tet_count, np.ndarray, _REGION, self._handle)
        if view.file_vertices:
            self.file_vertices = borrow_of(view.file_vertices, view.vertex_count, np.ndarray, _INDEX, self._handle)
        if view.tet_cells:
            self.cells = borrow_of(view.tet_cells, view.tet_count, np.ndarray, _INDEX, self._handle)

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
        return MeshData, tuple(None if array is None else np.array(array) for array in (
            self.positions, self.tets, self.triangles, self.regions, self.file_vertices, self.cells))


def _column(values: Optional[ArrayLike], name: str, count: int, dtype: np.dtype[Any]) -> Optional[NDArray[Any]]:
    """One whole number for each of `count` things."""
    if values is None:
        return None
    array = np.asarray(values)
    if array.dtype.kind not in "iu" and array.size:
        raise TypeError(f"{name} has the dtype {array.dtype}; it must hold integers")
    if array.shape != (count,):
        raise InvalidArgumentError(f"{name} has the shape {array.shape}; it must be ({count},)")
    range_ = np.iinfo(dtype)
    if array.size and not range_.min <= int(array.min()) <= int(array.max()) <= range_.max:
        raise InvalidArgumentError(f"{name} has numbers from {array.min()} to {array.max()}; they must fit {dtype}")
    return np.ascontiguousarray(array, dtype)


def _said(data: MeshData, name: str) -> MeshData:
    """A mesh that was loaded; its warnings become one of Python's."""
    if data.warnings:
        warn(f"{name}: {'; '.join(data.warnings)}")
    return data


def _load_desc(format: Union[str, _c.IoFormat], mesh_index: Optional[int], keep_unused: bool, split_cells: bool) -> Any:
    desc = described(_c.vox_io_load_desc)
    desc.flags = (_c.IoLoadFlags.KEEP_UNUSED * switch(keep_unused, "keep_unused")
                  + _c.IoLoadFlags.SPLIT_CELLS * switch(split_cells, "split_cells"))
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
    error.strerror = str(error)
    error.filename = os.fsdecode(path)
    return error


def load(path: Path, *, format: Union[str, _c.IoFormat] = "auto", mesh_index: Optional[int] = None,
         keep_unused: bool = False, split_cells: bool = False) -> MeshData:
    """Reads a file: Gmsh, TetGen, Medit, Vega, VTK, VTU; surfaces: STL, OBJ, PLY, OFF, glTF. mesh_index: the one to take of a
    scene; None joins all. keep_unused: keep vertices that belong to no tetrahedron, which are left out otherwise, as they would
    collide like all others. split_cells: split hexahedra, wedges and pyramids into tetrahedra, as `from_meshio` does; they are left
    out otherwise. What is odd about the mesh is a MeshWarning."""
    desc, pointer = _load_desc(format, mesh_index, keep_unused, split_cells), ctypes.c_void_p()
    try:
        _io.vox_io_load(_bytes_of(path), desc, pointer)
    except FileError as error:
        raise _with_reason(error, path, os.fsdecode(path)) from None
    return _said(MeshData._of(pointer), os.fsdecode(path))


def read(data: Union[bytes, Mapping[str, bytes]], name: Optional[str] = None, *, format: Union[str, _c.IoFormat] = "auto",
         mesh_index: Optional[int] = None, keep_unused: bool = False, split_cells: bool = False) -> MeshData:
    """The same from memory: the bytes of a file, whose name says the format where its content does not; or the bytes of
    several files by name (TetGen's .node and .ele)."""
    files = data if isinstance(data, Mapping) else {name: data}
    arrays = [np.frombuffer(content, np.uint8) if len(content) else np.empty(0, np.uint8) for content in files.values()]
    sources = (_c.vox_io_source * len(arrays))()
    for source, key, array in zip(sources, files, arrays):
        source.name = None if key is None else _text(key, "a name", "surrogateescape")
        source.data, source.size = array.ctypes.data, array.size
    desc, pointer = _load_desc(format, mesh_index, keep_unused, split_cells), ctypes.c_void_p()
    _io.vox_io_read(sources, len(sources), desc, pointer)
    return _said(MeshData._of(pointer), " and ".join(str(key or "a mesh in memory") for key in files))


def _data_of(mesh: Any) -> MeshData:
    if isinstance(mesh, MeshData):
        return mesh
    parts = parts_of(mesh)
    if parts is not None:
        return _of_parts(parts, keep_unused=True)
    if is_mesh(mesh) and not hasattr(mesh, "tets"):
        return MeshData(*_surface(mesh))
    positions, tets = arrays_of(mesh)[:2]
    return MeshData(positions, tets)


def _of_parts(parts: Parts, keep_unused: bool) -> MeshData:
    """Of a mesh of another package. Its tets, or its triangles, must not be lost in silence."""
    parts = parts.checked() if switch(keep_unused, "keep_unused") else parts.checked().without_unused()
    if parts.notes or parts.as_tets:
        warn("; ".join(parts.notes + parts.as_tets))
    own = np.array_equal(parts.cells, np.arange(len(parts.tets)))
    return MeshData(parts.positions, parts.tets, parts.triangles, parts.regions, parts.file_vertices, None if own else parts.cells)


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
    """Writes a mesh (MeshData, or of pyvista, meshio or trimesh) as .msh or .vtu, with arrays by name: a row of 1, 3 or 9
    numbers for each vertex, or for each cell (the triangles, then the tets).

    Of a grid, writes all bodies as they collide, with the id of its body for each tet (`body`), and for each vertex in how
    many contacts it is (`contacts`) and how deep (`depth`, where the grid looked for constraints)."""
    data, point_data, cell_data = _to_write(mesh, point_data, cell_data)
    writing = _Writing(data, format, binary, point_data, cell_data)
    try:
        _io.vox_io_write(data._handle.pointer, _bytes_of(path), writing.desc)
    except FileError as error:
        raise _with_reason(error, path, os.path.dirname(os.fsdecode(path)) or ".") from None


def write(mesh: Any, format: Union[str, _c.IoWriteFormat], *, binary: bool = False,
          point_data: Optional[Mapping[str, ArrayLike]] = None, cell_data: Optional[Mapping[str, ArrayLike]] = None) -> bytes:
    """The bytes that `save` would write, as "msh_22", "msh_41" or "vtu"."""
    data, point_data, cell_data = _to_write(mesh, point_data, cell_data)
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


def _to_write(mesh: Any, point_data: Optional[Mapping[str, ArrayLike]],
              cell_data: Optional[Mapping[str, ArrayLike]]) -> tuple[MeshData, Any, Any]:
    """A mesh with its arrays; of a grid, all bodies in one mesh, with what the last step found."""
    if not isinstance(mesh, Grid):
        return _data_of(mesh), point_data, cell_data
    grid = mesh
    meshes = [mesh for mesh in grid if mesh.enabled]
    bodies = [mesh._as_it_collides()[:2] for mesh in meshes]
    counts = [0 if positions is None else len(positions) for positions, _ in bodies]
    starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    first = {mesh.id: start for mesh, start in zip(meshes, starts.tolist())}
    tets = [found.astype(np.int64) + start for (_, found), start in zip(bodies, starts)]
    body = np.repeat([mesh.id for mesh in meshes], [len(found) for found in tets])
    touching, depth = np.zeros(starts[-1]), np.zeros(starts[-1])

    def rows(ids: Any, vertices: Any) -> Any:
        known = np.isin(ids, list(first))
        return known, np.array([first[i] for i in ids[known].tolist()], np.int64) + vertices[known]

    contacts = grid.contacts
    np.add.at(touching, rows(contacts.body_a, contacts.vertex)[1], 1)
    points = {"contacts": touching}
    if grid.flags & _c.GridFlags.CONSTRAINTS:
        inside = grid.constraints
        inside = inside[(inside.kind == _c.ConstraintKind.INSIDE) & (inside.gap < 0)]
        known, at = rows(inside.body_a, inside.vertices[:, 0])
        np.maximum.at(depth, at, -inside.gap[known])
        points["depth"] = depth
    positions = [np.asarray(p, np.float64) for p, _ in bodies if p is not None]
    data = MeshData(np.concatenate([np.empty((0, 3)), *positions]), np.concatenate([np.empty((0, 4), np.int64), *tets]))
    return data, {**points, **(point_data or {})}, {"body": body, **(cell_data or {})}


class Series:
    """A series of .vtu files for ParaView, with the .pvd that names them: `series.add(grid, time)` writes the next one, beside
    it (`run.pvd`: `run_0000.vtu`, ...), and the .pvd anew."""

    def __init__(self, path: Path) -> None:
        self._path = os.fsdecode(path)
        if not self._path.lower().endswith(".pvd"):
            raise InvalidArgumentError(f"{self._path}: expected a name that ends with .pvd")
        self._entries: list[str] = []

    def add(self, mesh: Any, time: Optional[float] = None, **options: Any) -> str:
        """As `save`, with its options. time: by default the number of the file. Returns the path of the new file."""
        number = len(self._entries)
        path = f"{self._path[:-4]}_{number:04}.vtu"
        save(mesh, path, **options)
        name = html.escape(os.path.basename(path))
        at = float(number) if time is None else real(time, "time")
        self._entries.append(f'<DataSet timestep="{at!r}" file="{name}"/>\n')
        text = ('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n'
                f'{"".join(self._entries)}</Collection>\n</VTKFile>\n')
        with open(self._path, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
        return path


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


def from_meshio(mesh: meshio.Mesh, *, keep_unused: bool = False) -> MeshData:
    """The tetrahedra and triangles of a mesh of meshio, of any order by their corners, with regions where its cell data has
    some; hexahedra, wedges and pyramids are split into tetrahedra. keep_unused: as for `load`. A mesh without all of these is
    refused."""
    parts = parts_of(mesh)
    if parts is None:
        raise TypeError(f"a mesh of type {type(mesh).__name__} is none of meshio")
    return _of_parts(parts, keep_unused)


def to_meshio(data: MeshData) -> meshio.Mesh:
    """For `meshio.write`. Regions become the cell data "region"."""
    import meshio
    blocks = [(name, array.astype(np.int64)) for name, array in (("triangle", data.triangles), ("tetra", data.tets))
              if len(array)]
    regions = {} if data.regions is None else {"region": [
        np.array(data.regions) if name == "tetra" else np.zeros(len(array), np.int32) for name, array in blocks]}
    return meshio.Mesh(np.array(data.positions), blocks, cell_data=regions)


def from_pyvista(mesh: Union[pyvista.UnstructuredGrid, pyvista.PolyData], *, keep_unused: bool = False) -> MeshData:
    """The tetrahedra and triangles of an UnstructuredGrid, as from_meshio, or the triangles of a PolyData."""
    parts = parts_of(mesh)
    return MeshData(*_surface(mesh)) if parts is None else _of_parts(parts, keep_unused)


def to_pyvista(data: Any) -> Union[pyvista.UnstructuredGrid, pyvista.PolyData]:
    """An UnstructuredGrid of the tetrahedra, with its cell data "region" where there are regions, or a PolyData of the
    triangles if there are none."""
    import pyvista
    data = _data_of(data)
    positions = data.positions
    if len(data.tets):
        made = pyvista.UnstructuredGrid({10: np.asarray(data.tets, np.int64)}, np.array(positions))
        if data.regions is not None:
            made.cell_data["region"] = np.array(data.regions)
        return made
    faces = np.insert(np.asarray(data.triangles, np.int64), 0, 3, axis=1)
    return pyvista.PolyData(np.array(positions), faces.ravel())


def from_trimesh(mesh: Union[trimesh.Trimesh, trimesh.Scene]) -> MeshData:
    """The surface, for `tetrahedralize`; of a scene, all of them joined, where its graph places them."""
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
