"""Exact contacts between deforming tetrahedral meshes, on a voxel grid that chooses its cell size itself."""

from ._c import (AreaReading, CostModel, Engine, GridFlags, Hash, PenetrationState, ReadingFlags, Result, Side, SizeReading,
                 Storage, Touch)
from ._library import vox as _vox
from .errors import (BudgetError, FileError, FormatError, InternalError, InvalidArgumentError, InvalidHandleError,
                     InvalidMeshError, InvalidStateError, LimitError, MissingFileError, NonFiniteError, OutOfMemoryError,
                     UnsupportedError, VoxError)
from .grid import Counters, Failure, Grid, Profile, contacts_of_all, step_all
from .mesh import Filter, Mesh, MeshInfo
from .queries import ClosestHits, FacetHits, PointHits, QueryView, TetHits
from .results import Borrowed, ContactEvents, Contacts, Depths, Pairs, Passages, Penetrations, Readings, TouchEvents, Touches

__version__: str = _vox.vox_version_string().decode()
build_info: str = _vox.vox_build_info().decode()
