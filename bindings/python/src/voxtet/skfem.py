"""Points in meshes of scikit-fem."""

from __future__ import annotations

from typing import Any, Callable, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InvalidArgumentError
from .locate import Locator

# In the order of VTK: the numbers of a cell's vertices, by how many there are.
_ORDERS = {4: ("tetra", (0, 1, 2, 3)), 6: ("wedge", (0, 1, 2, 3, 4, 5)), 8: ("hexahedron", (0, 3, 6, 2, 1, 5, 7, 4))}


class _Mesh(NamedTuple):
    points: NDArray[Any]
    cells_dict: dict[str, NDArray[Any]]


def element_finder(mesh: Any, mapping: Any = None, *, tolerance: Optional[float] = None) -> Callable[..., NDArray[np.int64]]:
    """What `mesh.element_finder(mapping)` is, for a MeshTet, MeshTet2, MeshHex or MeshWedge: a function of x, y, z that has the
    element of each point, and raises a ValueError if one is outside. It finds the lowest element, exactly, in any order of points.

    Points no further outside than `tolerance` are in the closest element: by default 1e-12 of the mesh's size, as
    points on the boundary may be rounded to its outer side. `mapping` is not used.

    To use it everywhere in scikit-fem: `skfem.MeshTet1.element_finder = voxtet.skfem.element_finder`."""
    cells = np.asarray(mesh.t).T
    if cells.shape[1] not in _ORDERS or len(mesh.p) != 3:
        raise InvalidArgumentError(f"a {type(mesh).__name__} has no tetrahedra, hexahedra or wedges")
    name, order = _ORDERS[cells.shape[1]]
    points, nodes = np.asarray(mesh.p).T, cells[:, order]
    if name == "tetra" and len(mesh.dofs.element_dofs) == 10:
        name, points, nodes = "tetra10", np.asarray(mesh.doflocs).T, np.asarray(mesh.dofs.element_dofs).T
    locator = Locator(_Mesh(np.ascontiguousarray(points, np.float64), {name: nodes}))
    near = 1e-12 * float(np.ptp(points, axis=0).max()) if tolerance is None else tolerance

    def finder(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> NDArray[np.int64]:
        asked = np.stack([np.ravel(x), np.ravel(y), np.ravel(z)], axis=1).astype(np.float64, copy=False)
        found = locator.locate(asked, outside="nearest", max_distance=near).cell
        if (found < 0).any():
            first = int((found < 0).argmax())
            raise ValueError(f"Point is outside of the mesh: point {first}, {asked[first].tolist()}, and "
                             f"{int((found < 0).sum()) - 1} more")
        return found

    return finder
