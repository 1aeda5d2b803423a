"""Contacts of the soft bodies of Newton: `voxtet.newton.contacts(model, state)`."""

from __future__ import annotations

import weakref
from typing import Any, Optional

from .body import Filter
from .errors import InvalidArgumentError
from .grid import Grid
from .mesh import Mesh
from .results import Contacts


class Particles:
    """All particles and tetrahedra of a newton.Model, as one mesh that collides with itself: vertices and tetrahedra of contacts
    are rows of state.particle_q and model.tet_indices. Particles without tetrahedra, as of cloth, collide with those of others.
    Newton does not keep which tetrahedra are one body. `rings` is that of Filter.self_rings."""

    def __init__(self, model: Any, *, rings: int = 0, workers: int = 1) -> None:
        if not model.tet_count:
            raise InvalidArgumentError(f"the model has {model.particle_count} particles, but no tetrahedra")
        self._tets = model.tet_indices.numpy().reshape(-1, 4).copy()
        self._filter = Filter(self_collision=True, self_rings=rings)
        self._address = 0
        self.grid = Grid(workers=workers)
        self.mesh: Optional[Mesh] = None

    def step(self, state: Any) -> Grid:
        """Finds all contacts of state.particle_q as it is now. Returns the grid, whose `contacts` and `find_constraints()` are
        those of this step. An array on the CPU is borrowed, one on a GPU copied by Warp."""
        positions = state.particle_q.numpy()
        address = positions.ctypes.data
        if self.mesh is None:
            self.mesh = self.grid.add(positions, self._tets, filter=self._filter)
        elif address != self._address or state.particle_q.device.is_cuda:
            self.mesh.positions = positions
        self._address = address
        self.grid.step()
        return self.grid


_of_models: weakref.WeakKeyDictionary[Any, Particles] = weakref.WeakKeyDictionary()


def contacts(model: Any, state: Any) -> Contacts:
    """The contacts of state.particle_q, by a `Particles` that is kept for the model."""
    particles = _of_models.get(model)
    if particles is None:
        particles = _of_models[model] = Particles(model)
    return particles.step(state).contacts
