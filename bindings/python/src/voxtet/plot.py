"""Pictures of a grid with pyvista: bodies, contacts, and which way leads out of them."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from .errors import InvalidStateError
from .grid import Grid
from .io import boundary

if TYPE_CHECKING:
    import pyvista

_COLOURS = ("#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377")


def plot(grid: Grid, plotter: Optional[pyvista.Plotter] = None, *, opacity: float = 0.5, contacts: bool = True,
         constraints: bool = True, **options: Any) -> pyvista.Plotter:
    """As `Grid.plot`."""
    import pyvista
    if plotter is None:
        plotter = pyvista.Plotter(**options)
    positions = {}
    for number, mesh in enumerate(grid):
        points, tets, _ = mesh._as_it_collides()
        if points is None or not mesh.enabled:
            continue
        positions[mesh.id] = points
        colour = _COLOURS[number % len(_COLOURS)]
        if len(tets):
            faces = np.insert(boundary(tets).astype(np.int64), 0, 3, axis=1)
            plotter.add_mesh(pyvista.PolyData(points, faces.ravel()), color=colour, opacity=opacity, show_edges=True)
        elif len(points):
            plotter.add_mesh(pyvista.PolyData(points), color=colour, point_size=4)
    found = grid.contacts
    known = np.isin(found.body_a, list(positions))
    if contacts and known.any():
        at = np.array([positions[c.body_a][c.vertex] for c in found[known]])
        plotter.add_mesh(pyvista.PolyData(at), color="red", point_size=8, render_points_as_spheres=True)
    if constraints:
        with contextlib.suppress(InvalidStateError):  # none were looked for
            deep = grid.constraints
            deep = deep[deep.gap < 0]
            if len(deep):
                plotter.add_arrows(deep.position, deep.normal * -deep.gap[:, None], mag=1, color="black")
    return plotter
