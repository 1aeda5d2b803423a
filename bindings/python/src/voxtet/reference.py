"""The paper's engine, for `Grid(reference=...)`."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike

from . import _c
from ._arguments import integer, switch, weights_pointer
from ._library import described
from .errors import InvalidArgumentError


@dataclasses.dataclass(frozen=True)
class Reference:
    """The paper's engine (vox_reference_desc), which is slower than the fast one and finds the same."""

    dense: bool = False  # a list for every cell of a box, instead of a hash table
    paper_hash: bool = False  # the hash of Teschner et al. 2003
    hash_table_size: int = 0  # 0: twice the number of vertices
    world: Optional[tuple[ArrayLike, ArrayLike]] = None  # dense: two corners of the box that has cells; None: that of all positions
    weights: Optional[ArrayLike] = None  # by which it chooses its cell size, from `calibrate`; None: those shipped with the library

    def _struct(self) -> Any:
        out = described(_c.vox_reference_desc)
        out.flags = (switch(self.dense, "dense") * _c.ReferenceFlags.DENSE
                     | switch(self.paper_hash, "paper_hash") * _c.ReferenceFlags.PAPER_HASH)
        out.hash_table_size = integer(self.hash_table_size, "hash_table_size")
        if self.world is not None:
            corners = np.asarray(self.world)
            if corners.shape != (2, 3) or corners.dtype.kind not in "iuf":
                raise InvalidArgumentError("world must be two corners of three numbers")
            out.world_min[:], out.world_max[:] = corners[0].tolist(), corners[1].tolist()
        out.weights = weights_pointer(self.weights)
        return out


def pointer_to(reference: Optional[Reference]) -> Any:
    """For vox_grid_desc.reference."""
    if reference is None:
        return None
    if not isinstance(reference, Reference):
        raise TypeError(f"reference is of type {type(reference).__name__}; it must be a voxtet.Reference")
    return ctypes.pointer(reference._struct())
