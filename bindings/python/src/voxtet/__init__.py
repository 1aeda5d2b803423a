"""Exact contacts between deforming tetrahedral meshes, on a voxel grid that chooses its cell size itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._c import (VOX_NONE as NONE, CellSizeWarnings, CellsKept, CellsQueried, CellsStored, ConstraintKind, CostModel, DepthMethod,
                 DepthState, GridFlags, KnownGrid, LocationState, PairState, Result, ShapeKind, Side)
from ._library import vox as _vox
from .body import Body, Filter
from .errors import (BudgetError, FileError, FormatError, InternalError, InvalidArgumentError, InvalidHandleError,
                     InvalidMeshError, InvalidStateError, LimitError, MeshWarning, MissingFileError, NonFiniteError,
                     OutOfMemoryError, UnsupportedError, VoxError)
from .foreign import ForeignCounts, ForeignGrid, Primitives, tune
from .grid import ALL_CORES, Failure, Grid, step_all
from .locate import BoxHits, ClosestHits, Located, Locator, PointHits, RayHits, TrackPieces, Tracks, TriangleHits, locate, tracks
from .mesh import Mesh, MeshInfo
from .reference import Reference
from .results import Borrowed, Constraints, Contacts, Jacobian, Pairs
from .shapes import Box, Capsule, Cylinder, Field, HalfSpace, Heightfield, Polyline, Shape, Sheet, Solid, Sphere
from .suggest import (CellSizeResult, Curve, ForeignWeights, Geometry, Rules, Terms, Timings, calibrate, measure_geometry, minimise,
                      suggest_cell_size)
from .transfer import Embedding, Transfer, embed, sample

if TYPE_CHECKING:
    from . import experiment, io, ipctk, mpi, mujoco, newton, sim, skfem, surface
    from .sim import resolve

build_info: str = _vox.vox_build_info().decode()
__version__: str = build_info.split()[1].rstrip(",")


def __getattr__(name: str) -> Any:
    """Loaded when they are first used: voxtet.io and voxtet.sim are libraries of their own, the others for some people alone."""
    if name in ("experiment", "io", "ipctk", "mpi", "mujoco", "newton", "sim", "skfem", "surface"):
        import importlib
        return importlib.import_module("." + name, __name__)
    if name == "resolve":
        from .sim import resolve
        return resolve
    raise AttributeError(f"module 'voxtet' has no attribute {name!r}")
