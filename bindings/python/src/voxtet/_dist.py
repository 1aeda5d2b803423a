"""The structs and functions of vox_dist.h for voxtet.mpi. By hand, as no other language has them yet; a test compares their
layout with the header's."""

from __future__ import annotations

import ctypes
from ctypes import (CFUNCTYPE, POINTER, Structure, c_double, c_int32, c_uint32, c_uint64, c_void_p)
from typing import Any

import numpy as np

from . import _c
from ._library import check, load

VERTICES, TETS = 0, 1  # vox_dist_side


class vox_dist_message(Structure):
    _fields_ = [("data", c_void_p), ("size", c_uint64)]


Allgather = CFUNCTYPE(c_int32, c_void_p, c_uint64, c_void_p, c_void_p)
Exchange = CFUNCTYPE(c_int32, POINTER(c_uint32), c_uint32, POINTER(vox_dist_message), POINTER(vox_dist_message), c_void_p)
Agree = CFUNCTYPE(c_int32, POINTER(c_uint64), c_uint32, POINTER(c_uint64), c_uint32, c_void_p)


class vox_dist_transport(Structure):
    _fields_ = [("struct_size", c_uint32), ("rank", c_uint32), ("size", c_uint32), ("reserved", c_uint32),
                ("allgather", Allgather), ("exchange", Exchange), ("agree", Agree), ("user", c_void_p)]


class vox_dist_part_desc(Structure):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("body", c_uint64),
                ("mesh", POINTER(_c.vox_mesh_desc)), ("vertex_ids", c_void_p), ("tet_ids", c_void_p), ("owned", c_void_p)]


class vox_dist_contact(Structure):
    _fields_ = [("body_a", c_uint64), ("vertex", c_uint64), ("body_b", c_uint64), ("tet", c_uint64),
                ("weights", c_double * 4), ("index", c_uint32), ("rank", c_uint32), ("interior", c_uint32),
                ("reserved", c_uint32)]


class vox_dist_contact_view(Structure):
    _fields_ = [("data", c_void_p), ("count", c_uint64)]


class vox_dist_location(Structure):
    _fields_ = [("body", c_uint64), ("tet", c_uint64), ("state", c_int32), ("rank", c_uint32), ("weights", c_double * 4),
                ("distance", c_double)]


class vox_dist_cost(Structure):
    _fields_ = [("body", c_uint64), ("seconds", c_double)]


STRUCTS = [vox_dist_message, vox_dist_transport, vox_dist_part_desc, vox_dist_contact, vox_dist_contact_view,
           vox_dist_location, vox_dist_cost]


def dtype_of(struct: type[Structure]) -> np.dtype[Any]:
    """The records of a struct, without its reserved fields."""
    fields = [name for name, _ in struct._fields_ if name != "reserved"]  # type: ignore[misc]
    whole = np.dtype(struct)
    layout: Any = {"names": fields, "formats": [whole.fields[name][0] for name in fields],  # type: ignore[index]
                   "offsets": [whole.fields[name][1] for name in fields], "itemsize": ctypes.sizeof(struct)}  # type: ignore[index]
    found: np.dtype[Any] = np.dtype(layout)
    return found


contact_type = np.dtype((np.record, dtype_of(vox_dist_contact)))
location_type = np.dtype((np.record, dtype_of(vox_dist_location)))
cost_type = np.dtype((np.record, dtype_of(vox_dist_cost)))

_ARGUMENTS: dict[str, list[Any]] = {
    "vox_dist_scene_create": [POINTER(_c.vox_grid_desc), POINTER(vox_dist_transport), POINTER(c_void_p)],
    "vox_dist_scene_insert": [c_void_p, POINTER(vox_dist_part_desc)],
    "vox_dist_scene_remove": [c_void_p, c_uint64],
    "vox_dist_scene_bind_positions": [c_void_p, c_uint64, POINTER(_c.vox_positions)],
    "vox_dist_scene_step": [c_void_p],
    "vox_dist_scene_get_contacts": [c_void_p, c_int32, POINTER(vox_dist_contact_view)],
    "vox_dist_scene_send": [c_void_p, c_int32, c_uint64, c_void_p, c_void_p],
    "vox_dist_scene_get_hash": [c_void_p, POINTER(c_uint64)],
    "vox_dist_scene_locate": [c_void_p, POINTER(_c.vox_positions), c_void_p],
    "vox_dist_scene_check": [c_void_p],
    "vox_dist_scene_get_costs": [c_void_p, c_void_p, c_uint64, POINTER(c_uint64)],
    "vox_dist_scene_get_counters": [c_void_p, POINTER(_c.vox_counter_view)],
}


def _declared() -> Any:
    library = load("vox_dist")
    for name, arguments in _ARGUMENTS.items():
        function = getattr(library, name)
        function.argtypes, function.restype, function.errcheck = arguments, c_int32, check
    library.vox_dist_scene_destroy.argtypes, library.vox_dist_scene_destroy.restype = [c_void_p], None
    return library


dist: Any = _declared()

__all__ = ["STRUCTS", "TETS", "VERTICES", "Agree", "Allgather", "Exchange", "contact_type", "cost_type", "dist", "location_type",
           "vox_dist_message", "vox_dist_part_desc", "vox_dist_contact_view", "vox_dist_transport"]
