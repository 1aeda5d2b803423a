"""Positions and tetrahedra of the meshes of other packages, by what they have, so that none of them is imported."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from .mesh import Mesh

_VTK_TRIANGLE = 5
_VTK_TETRA = 10


def arrays_of(mesh: Any, tets: Any = None) -> tuple[Any, Any, Optional[NDArray[Any]]]:
    """Positions, tets, and where these are not all cells of the mesh, the index of the cell that each of them is."""
    if tets is not None:
        return mesh, tets, None
    if isinstance(mesh, Mesh):
        positions, found, there = mesh._as_it_collides()
        return positions, found, None if there.all() else np.flatnonzero(there)
    if hasattr(mesh, "positions") and hasattr(mesh, "tets"):  # voxtet.io.MeshData, a body of a sim
        return mesh.positions, mesh.tets, None
    if hasattr(mesh, "celltypes") and hasattr(mesh, "points"):  # pyvista.UnstructuredGrid
        cells = np.flatnonzero(mesh.celltypes == _VTK_TETRA)
        found = mesh.cells_dict.get(_VTK_TETRA, np.empty((0, 4), np.int64))
        return np.asarray(mesh.points), found, None if len(cells) == mesh.n_cells else cells
    if hasattr(mesh, "cells_dict") and hasattr(mesh, "points"):  # meshio.Mesh
        return _three_columns(mesh.points), mesh.cells_dict.get("tetra", np.empty((0, 4), np.int64)), None
    raise TypeError(f"a mesh of type {type(mesh).__name__} is not known; give positions and tets, or a mesh of pyvista, meshio "
                    "or voxtet.io")


def triangles_of(mesh: Any) -> tuple[Any, Any]:
    """Positions and triangles of a surface."""
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces") and not hasattr(mesh, "cells_dict"):  # trimesh.Trimesh
        return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces)
    if hasattr(mesh, "regular_faces"):  # pyvista.PolyData
        surface = mesh if mesh.is_all_triangles else mesh.triangulate()
        return np.asarray(surface.points), np.asarray(surface.regular_faces)
    if hasattr(mesh, "cells_dict") and "triangle" in mesh.cells_dict:
        return _three_columns(mesh.points), mesh.cells_dict["triangle"]
    raise TypeError(f"{type(mesh).__name__} is no surface of triangles")


def _three_columns(points: Any) -> Any:
    return points if points.dtype in (np.float32, np.float64) else points.astype(np.float64)


def primitives_of(mesh: Any) -> tuple[Any, Any]:
    """Positions and indices: tetrahedra, else triangles, else None, for a cloud of points."""
    if isinstance(mesh, Mesh) or hasattr(mesh, "positions") and hasattr(mesh, "tets"):
        points, tets, _ = arrays_of(mesh)
        triangles = getattr(mesh, "triangles", ())
        return points, tets if len(tets) else triangles if len(triangles) else None
    if hasattr(mesh, "regular_faces"):  # pyvista.PolyData
        return triangles_of(mesh) if len(mesh.faces) else (np.asarray(mesh.points), None)
    if hasattr(mesh, "celltypes") and hasattr(mesh, "points"):  # pyvista.UnstructuredGrid
        cells = mesh.cells_dict
        return np.asarray(mesh.points), next((cells[kind] for kind in (_VTK_TETRA, _VTK_TRIANGLE) if kind in cells), None)
    if hasattr(mesh, "cells_dict") and hasattr(mesh, "points"):  # meshio.Mesh
        cells = mesh.cells_dict
        return _three_columns(mesh.points), next((cells[kind] for kind in ("tetra", "triangle") if kind in cells), None)
    if hasattr(mesh, "vertices"):  # trimesh
        return triangles_of(mesh) if hasattr(mesh, "faces") else (np.asarray(mesh.vertices, np.float64), None)
    raise TypeError(f"{type(mesh).__name__} is not known; give points, positions and indices, voxtet.Primitives, or a mesh of "
                    "pyvista, meshio, trimesh or voxtet.io")
