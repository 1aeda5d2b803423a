"""Positions, tetrahedra and triangles of the meshes of other packages, by what they have, so that none of them is imported."""

from __future__ import annotations

from typing import Any, Iterable, Mapping, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from .cells import HEXAHEDRON, PYRAMID, TET, TET10, WEDGE, Block, Cells, Shape, split
from .errors import InvalidMeshError, warn
from .mesh import Mesh

# Of vtkCellType.h, linear and of higher order; those have their corners first.
_VTK_TRIANGLES = (5, 22, 34, 69, 76)
_VTK_NAMES = {5: "triangle", 10: "tetra", 11: "voxel", 12: "hexahedron", 13: "wedge", 14: "pyramid", 15: "pentagonal prism",
              16: "hexagonal prism", 24: "tetra10", 25: "quadratic hexahedron", 26: "quadratic wedge", 27: "quadratic pyramid",
              29: "triquadratic hexahedron", 31: "quadratic linear wedge",
              32: "biquadratic quadratic wedge", 33: "biquadratic quadratic hexahedron",
              37: "triquadratic pyramid", 41: "convex point set", 42: "polyhedron", 71: "Lagrange tetrahedron",
              72: "Lagrange hexahedron", 73: "Lagrange wedge", 74: "Lagrange pyramid", 78: "Bezier tetrahedron",
              79: "Bezier hexahedron", 80: "Bezier wedge", 81: "Bezier pyramid"}
_SHAPES = {"tetra": TET, "hexahedron": HEXAHEDRON, "voxel": HEXAHEDRON, "wedge": WEDGE, "pyramid": PYRAMID}  # words of names
_VOXEL = (0, 1, 3, 2, 4, 5, 7, 6)  # its corners in the order of a hexahedron
_VOLUMES = ("prism", "polyhedron", "convex point set")  # words of names of those that are left out
# Those that vox_io knows.
_REGIONS = frozenset("""region regions region_id regionid region_ids gmsh:physical medit:ref cell_tags cell_markers celltags
    cellentityids physical physical_id material materials materialids material_id material_ids mat_id subdomain subdomains
    subdomain_id domain domain_id label labels part_id tet_regions""".split())


class Parts(NamedTuple):
    """A mesh of another package."""

    positions: Any
    tets: NDArray[Any]
    triangles: NDArray[Any]
    cells: NDArray[Any]  # for each tet the index of its cell
    regions: Optional[NDArray[np.int32]]  # of the tets
    notes: list[str]  # what is not as it was
    others: dict[str, int]  # cells of other kinds, by name
    blocks: list[Block]
    local: NDArray[np.int64]  # the corners of the tets as indices into the nodes of their cells
    as_tets: list[str]  # what is not as it was where the tets are used without the cells
    file_vertices: Optional[NDArray[np.uint32]] = None  # where vertices were left out

    def checked(self) -> Parts:
        """Itself, unless it has volume elements and none of them is a tetrahedron, or nothing at all."""
        if len(self.tets) or len(self.triangles):
            return self
        raise InvalidMeshError(f"the mesh has no tetrahedra and no triangles{self._but()}")

    def with_tets(self, cells: bool = False) -> Parts:
        """Itself, if it has tetrahedra. Says what is not as it was, if the cells are used or if the tets are."""
        if not len(self.tets):
            raise InvalidMeshError(f"the mesh has no tetrahedra{self._but()}")
        notes = self.notes if cells else [*self.notes, *self.as_tets]
        if notes:
            warn("; ".join(notes))
        return self

    def with_triangles(self) -> tuple[Any, NDArray[Any]]:
        """Positions and triangles, if it has some."""
        if not len(self.triangles):
            raise InvalidMeshError(f"the mesh has no triangles{self._but()}")
        return self.positions, self.triangles

    def _but(self) -> str:
        found = dict(self.others)
        for name, elements in (("tetrahedron", self.tets), ("triangle", self.triangles)):
            if len(elements):
                found[name] = len(elements)
        return f", but cells of other kinds ({', '.join(f'{n} {name}' for name, n in found.items())})" if found else ""

    def without_unused(self) -> Parts:
        """Without vertices that belong to no tetrahedron, as the library reads files; they would collide like all others."""
        count = len(self.positions)
        if not len(self.tets) or int(self.tets.min()) < 0 or int(self.tets.max()) >= count:  # for the library to refuse
            return self
        used = np.zeros(count, np.bool_)
        used[self.tets] = True
        unused = count - int(used.sum())
        if not unused:
            return self
        number = np.cumsum(used) - 1
        whole = used[self.triangles].all(axis=1) if len(self.triangles) else np.empty(0, np.bool_)
        notes = [*self.notes, counted(unused, "vertex belongs", "vertices belong", "to no tet and", "left out")]
        if not whole.all():
            notes.append(counted(int((~whole).sum()), "triangle has", "triangles have", "such a vertex and", "left out"))
        return self._replace(positions=np.asarray(self.positions)[used], tets=number[self.tets],
                             triangles=number[self.triangles[whole]], notes=notes,
                             file_vertices=np.flatnonzero(used).astype(np.uint32))


def counted(number: int, one: str, many: str, middle: str, end: str) -> str:
    """As vox_io says it."""
    return f"{number} {one if number == 1 else many} {middle} {'was' if number == 1 else 'were'} {end}"


def _regions(arrays: Mapping[str, Any], cells: NDArray[Any]) -> Optional[NDArray[np.int32]]:
    """The array that vox_io would take, for these cells."""
    best: Optional[NDArray[np.int32]] = None
    for name, given in arrays.items():
        named, values = str(name).lower() in _REGIONS, np.asarray(given)
        if values.ndim == 2 and values.shape[1] == 1:
            values = values[:, 0]
        wanted = named or (best is None and values.dtype.kind in "iu" and not str(name).startswith("vtk"))
        if not wanted or values.ndim != 1 or values.dtype.kind not in "iuf":
            continue
        if values.size and ((values != np.floor(values)) | (values < -2**31) | (values >= 2**31)).any():
            continue
        best = values[cells].astype(np.int32)
        if named:
            break
    return best if best is not None and best.any() else None


def _shape_of(name: str, node_count: int) -> Optional[Shape]:
    """Of a cell with this name of VTK or meshio; None for one that is not taken."""
    if any(word in name for word in _VOLUMES):
        return None
    shape = next((shape for word, shape in _SHAPES.items() if word in name), None)
    return TET10 if shape is TET and node_count == 10 and "bezier" not in name.lower() else shape


def _parts(points: Any, given: Iterable[tuple[str, NDArray[Any], NDArray[Any]]], data: Mapping[str, Any]) -> Parts:
    """Of cells by their names, (name, indices, nodes), and arrays of values for all cells."""
    triangles = [np.empty((0, 3), np.int64)]
    tets, cells, local = [np.empty((0, 4), np.int64)], [np.empty(0, np.int64)], [np.empty((0, 4), np.int64)]
    blocks: list[Block] = []
    others: dict[str, int] = {}
    high = dict.fromkeys((False, True), 0)  # tets with more than four nodes, by whether there are ten
    notes: list[str] = []
    as_tets: list[str] = []
    for name, indices, nodes in given:
        shape = _shape_of(name, nodes.shape[1])
        if "triangle" in name:
            triangles.append(nodes[:, :3])
        elif shape is None:
            others[name] = others.get(name, 0) + len(nodes)
        elif len(nodes):
            block = Block(shape, indices, nodes[:, _VOXEL] if name == "voxel" else nodes[:, :shape.node_count])
            of_tet, corners = split(shape, block.nodes)
            blocks.append(block)
            tets.append(block.nodes[of_tet[:, None], corners])
            cells.append(indices[of_tet])
            local.append(corners)
            if shape in (TET, TET10):
                high[shape is TET10] += len(nodes) if nodes.shape[1] > 4 else 0
            else:
                as_tets.append(f"{len(nodes)} {'cell was' if len(nodes) == 1 else 'cells were'} split into {len(of_tet)} tets: {name}")
                if nodes.shape[1] > shape.node_count:
                    notes.append(f"of {name} only the corners were used")
    for name, number in others.items():
        if any(word in name for word in _VOLUMES):
            notes.append(counted(number, "volume element", "volume elements", "of another kind", f"left out: {name}"))
    for ten, number in high.items():
        if number:
            (as_tets if ten else notes).append(f"{number} {'tet has' if number == 1 else 'tets have'} more than four nodes; only "
                                               f"{'its' if number == 1 else 'their'} corners were used")
    found, of_cell, corner = np.concatenate(tets), np.concatenate(cells), np.concatenate(local)
    if (of_cell[1:] < of_cell[:-1]).any():  # so that the lowest tetrahedron is in the lowest cell
        order = np.argsort(of_cell, kind="stable")
        found, of_cell, corner = found[order], of_cell[order], corner[order]
    return Parts(points, found, np.concatenate(triangles), of_cell, _regions(data, of_cell), notes, others, blocks, corner, as_tets)


def _of_pyvista(mesh: Any, starts: NDArray[Any]) -> Parts:
    """A pyvista.UnstructuredGrid. Cell c begins at starts[c] of its connectivity."""
    kinds, connectivity = np.asarray(mesh.celltypes), np.asarray(mesh.cell_connectivity)
    starts = np.append(starts[:len(kinds)], len(connectivity))

    def blocks() -> Iterable[tuple[str, NDArray[Any], NDArray[Any]]]:
        for kind in np.unique(kinds):
            cells = np.flatnonzero(kinds == kind)
            name = _VTK_NAMES.get(int(kind)) or ("triangle" if kind in _VTK_TRIANGLES else f"of VTK's type {kind}")
            sizes = starts[cells + 1] - starts[cells]
            for size in np.unique(sizes):
                those = cells[sizes == size]
                yield name, those, connectivity[starts[those][:, None] + np.arange(size)]

    return _parts(np.asarray(mesh.points), blocks(), mesh.cell_data)


def _of_meshio(mesh: Any) -> Parts:
    """A meshio.Mesh, or what has points and a cells_dict."""
    blocks, first = [], 0
    for kind, nodes in [(b.type, b.data) for b in mesh.cells] if hasattr(mesh, "cells") else mesh.cells_dict.items():
        name = _VTK_NAMES.get(kind) or str(kind).lower()
        indices = np.arange(first, first + len(nodes))
        first += len(nodes)
        if len(nodes):
            ragged = len({len(cell) for cell in nodes}) > 1 if not isinstance(nodes, np.ndarray) else nodes.ndim != 2
            blocks.append((name, indices, np.zeros((len(nodes), 0), np.int64) if ragged else np.asarray(nodes)))
    cell_data = getattr(mesh, "cell_data", {})
    arrays = {name: np.concatenate([np.asarray(part) for part in parts]) for name, parts in cell_data.items()
              if len({np.shape(part)[1:] for part in parts}) == 1}
    return _parts(_three_columns(mesh.points), blocks, arrays)


def parts_of(mesh: Any) -> Optional[Parts]:
    """Of a mesh of cells of pyvista or meshio; None for anything else."""
    if hasattr(mesh, "celltypes") and hasattr(mesh, "cell_connectivity"):
        return _of_pyvista(mesh, np.asarray(mesh.cell_offsets if hasattr(type(mesh), "cell_offsets") else mesh.offset))
    if hasattr(mesh, "cells_dict") and hasattr(mesh, "points"):
        return _of_meshio(mesh)
    return None


def arrays_of(mesh: Any, tets: Any = None) -> tuple[Any, Any, Optional[NDArray[Any]], Optional[Cells]]:
    """Positions and tets; where these are not all cells of the mesh, the index of the cell that each of them is in; and the
    cells of a mesh of another package. Without tets such a mesh is refused, and so is a surface of voxtet.io."""
    if tets is not None:
        return mesh, tets, None, None
    if isinstance(mesh, Mesh):
        positions, found, there = mesh._as_it_collides()
        return positions, found, None if there.all() else np.flatnonzero(there), None
    if hasattr(mesh, "positions") and hasattr(mesh, "tets"):  # voxtet.io.MeshData, a body of a sim
        if not len(mesh.tets):
            raise InvalidMeshError(f"the mesh has no tetrahedra, but {len(getattr(mesh, 'triangles', ()))} triangles")
        return mesh.positions, mesh.tets, None, None
    parts = parts_of(mesh)
    if parts is None:
        raise TypeError(f"a mesh of type {type(mesh).__name__} is not known; give positions and tets, or a mesh of pyvista, "
                        "meshio or voxtet.io")
    parts = parts.with_tets(cells=True)
    numbered = len(parts.local) > sum(len(block.cells) for block in parts.blocks)  # cells were split
    if hasattr(mesh, "celltypes"):
        numbered = numbered or len(parts.cells) < mesh.n_cells
    return (parts.positions, parts.tets, parts.cells if numbered else None,
            Cells(np.asarray(parts.positions), parts.tets, parts.blocks, parts.cells, parts.local))


def triangles_of(mesh: Any) -> tuple[Any, Any]:
    """Positions and triangles of a surface, of which there must be some."""
    if hasattr(mesh, "geometry") and hasattr(mesh, "graph"):  # trimesh.Scene
        mesh = mesh.to_mesh() if hasattr(mesh, "to_mesh") else mesh.dump(concatenate=True)
        if isinstance(mesh, (list, tuple)):  # an older trimesh's, of a scene without surfaces
            raise InvalidMeshError("the scene has no triangles")
    found: Optional[tuple[Any, Any]] = None
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces") and not hasattr(mesh, "cells_dict"):  # trimesh.Trimesh
        found = np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces)
    elif hasattr(mesh, "regular_faces"):  # pyvista.PolyData
        surface = mesh if mesh.is_all_triangles and not mesh.n_strips else mesh.triangulate()
        found = np.asarray(surface.points), np.asarray(surface.regular_faces)
    else:
        parts = parts_of(mesh)
        if parts is not None:
            found = parts.with_triangles()
    if found is None:
        raise TypeError(f"{type(mesh).__name__} is no surface of triangles")
    if not len(found[1]):
        raise InvalidMeshError(f"the {type(mesh).__name__} has no triangles, but {len(found[0])} points")
    return found


def is_mesh(value: Any) -> bool:
    """Whether it is a mesh of some package, not positions."""
    return any(all(hasattr(value, name) for name in names) for names in (
        ("positions", "tets"), ("points", "celltypes"), ("points", "cells_dict"), ("points", "regular_faces"),
        ("vertices", "faces"), ("geometry", "graph")))


def body_of(mesh: Any) -> tuple[Any, Any]:
    """Positions and tets of a mesh that is to collide; None for the tets of a surface."""
    if hasattr(mesh, "positions") and hasattr(mesh, "tets"):
        positions, tets = mesh._as_it_collides()[:2] if isinstance(mesh, Mesh) else (mesh.positions, mesh.tets)
        return positions, tets if len(tets) else None
    parts = parts_of(mesh)
    if parts is not None and len(parts.tets):
        parts = parts.without_unused().with_tets()
        return parts.positions, parts.tets
    if parts is not None:
        parts.checked()
    positions, triangles = triangles_of(mesh)
    used = np.unique(triangles)
    if len(used) < len(positions):
        warn(counted(len(positions) - len(used), "vertex belongs", "vertices belong", "to no triangle and", "left out"))
    return np.asarray(positions)[used], None


def _three_columns(points: Any) -> Any:
    return points if points.dtype in (np.float32, np.float64) else points.astype(np.float64)


def _first(candidates: Iterable[Any]) -> Any:
    return next((c for c in candidates if len(c)), None)


def primitives_of(mesh: Any) -> tuple[Any, Any]:
    """Positions and indices: tetrahedra, else triangles, else None, for a cloud of points."""
    if isinstance(mesh, Mesh):
        points, tets = arrays_of(mesh)[:2]
        return points, _first((tets,))
    if hasattr(mesh, "positions") and hasattr(mesh, "tets"):
        return mesh.positions, _first((mesh.tets, getattr(mesh, "triangles", ())))
    parts = parts_of(mesh)
    if parts is not None:
        if parts.notes:
            parts.checked()  # a cloud of points has no volume elements
        return parts.positions, _first((parts.tets, parts.triangles))
    if hasattr(mesh, "regular_faces") and not len(mesh.faces) and not mesh.n_strips:  # pyvista.PolyData
        return np.asarray(mesh.points), None
    if hasattr(mesh, "vertices") and not hasattr(mesh, "faces") and not hasattr(mesh, "graph"):  # trimesh.PointCloud
        return np.asarray(mesh.vertices, np.float64), None
    if is_mesh(mesh):
        return triangles_of(mesh)
    raise TypeError(f"{type(mesh).__name__} is not known; give points, positions and indices, voxtet.Primitives, or a mesh of "
                    "pyvista, meshio, trimesh or voxtet.io")
