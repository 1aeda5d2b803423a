"""Contacts of MuJoCo's flexes, for programs that want to see them: `voxtet.mujoco.Flex(model).step(data)`. Forces need no Python:
the plugin in bindings/mujoco applies them within mj_step."""

from __future__ import annotations

from typing import Any, Optional, Sequence, Union

from .body import Filter
from .errors import InvalidArgumentError
from .grid import Grid
from .mesh import Mesh


class Flex:
    """The flexes of tetrahedra (dim 3) of an mjModel as meshes of a grid, tagged with their names. `flexes`: the names or ids of
    those that take part; None: all. `filter` and `workers` are those of Grid.add and Grid.

    `meshes` has the mesh of each flex by its id, after the first step. Vertices and tetrahedra of contacts are numbered
    within the flex: vertex v of flex f is row model.flex_vertadr[f] + v of data.flexvert_xpos.
    """

    def __init__(self, model: Any, flexes: Optional[Sequence[Union[str, int]]] = None, *, filter: Optional[Filter] = None,
                 workers: int = 1) -> None:
        dims = model.flex_dim.tolist()
        names = [model.names[address:].split(b"\0", 1)[0].decode() for address in model.name_flexadr.tolist()]
        if flexes is None:
            chosen = [flex for flex, dim in enumerate(dims) if dim == 3]
        else:
            for flex in flexes:
                if flex not in (names if isinstance(flex, str) else range(len(dims))):
                    raise InvalidArgumentError(f"there is no flex {flex!r} among the {len(dims)} of the model: {names}")
            chosen = sorted({names.index(flex) if isinstance(flex, str) else int(flex) for flex in flexes})
        if not chosen:
            raise InvalidArgumentError(f"the model has {len(dims)} flexes, but none of tetrahedra (dim 3) to take part")
        self._parts = []
        for flex in chosen:
            if dims[flex] != 3:
                raise InvalidArgumentError(f"flex {flex} \"{names[flex]}\" has dim {dims[flex]}; only those of tetrahedra, "
                                           "dim 3, can take part")
            first, corner = int(model.flex_vertadr[flex]), int(model.flex_elemdataadr[flex])
            tets = model.flex_elem[corner:corner + 4 * model.flex_elemnum[flex]].reshape(-1, 4).copy()
            rows = slice(first, first + int(model.flex_vertnum[flex]))
            self._parts.append((flex, names[flex], rows, tets))
        self._filter = filter
        self._address = 0
        self._vertices = len(model.flex_vertbodyid)
        self.grid = Grid(workers=workers)
        self.meshes: dict[int, Mesh] = {}

    def step(self, data: Any) -> Grid:
        """Finds all contacts of data.flexvert_xpos as it is now (mj_step, mj_forward and mj_kinematics with mj_flex write
        it). Returns the grid, whose `contacts`, `pairs` and `find_constraints()` are those of this step. The array is borrowed,
        never copied; the grid keeps `data` alive until it steps another one."""
        positions = data.flexvert_xpos
        if len(positions) != self._vertices:
            raise InvalidArgumentError(f"the data has {len(positions)} flex vertices, the model {self._vertices}")
        address = positions.ctypes.data
        if address != self._address:
            self._address = 0
            for flex, name, rows, tets in self._parts:
                if flex in self.meshes:
                    self.meshes[flex].positions = positions[rows]
                else:
                    self.meshes[flex] = self.grid.add(positions[rows], tets, tag=name, user_data=flex, filter=self._filter)
            self._address = address
        self.grid.step()
        return self.grid
