"""Written by bindings/generate.py from bindings/api.json. Do not edit."""

import enum
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t,
                    c_uint8, c_uint32, c_uint64, c_void_p)
from typing import Any

from numpy import dtype

VOX_ABI_VERSION = 1
VOX_NONE = 4294967295
VOX_ALL_CORES = 4294967295
VOX_MAX_BODIES = 1048576
VOX_MAX_VERTICES = 2147483647
VOX_MAX_TETS = 2147483647
VOX_MAX_SURFACE_TETS = 357913941
VOX_MAX_CONTACTS = 4294967295
VOX_MAX_WORKERS = 256
VOX_MAX_CONSTRAINTS_PER_PAIR = 256
VOX_NULL_BODY = 0
VOX_MAX_RINGS = 8
VOX_STENCIL_CAPACITY = 5
VOX_MAX_TASKS = 64
VOX_CURVE_CAPACITY = 64
VOX_TERM_CAPACITY = 12
VOX_RULE_CAPACITY = 8
VOX_TIMING_CAPACITY = 32
VOX_NOTE_CAPACITY = 256
VOX_COST_WEIGHT_CAPACITY = 24
VOX_MAX_FEATURES = 2147483647
VOX_MAX_PATCHES = 65536


class Result(enum.IntEnum):
    OK = 0
    ERROR_INVALID_ARGUMENT = -1
    ERROR_INVALID_HANDLE = -2
    ERROR_INVALID_MESH = -3
    ERROR_INVALID_STATE = -4
    ERROR_NON_FINITE = -5
    ERROR_LIMIT = -6
    ERROR_BUDGET = -7
    ERROR_OUT_OF_MEMORY = -8
    ERROR_UNSUPPORTED = -9
    ERROR_FILE = -10
    ERROR_FORMAT = -11
    ERROR_INTERNAL = -12


class Format(enum.IntEnum):
    FLOAT = 0
    DOUBLE = 1


class GridFlags(enum.IntFlag):
    CONSTRAINTS = 1
    EDGES = 2
    SKIP_BAD_BODIES = 4


class FilterFlags(enum.IntFlag):
    SELF_COLLISION = 1
    SENSOR = 2


class MeshFlags(enum.IntFlag):
    COPY_POSITIONS = 1
    BORROW_TETS = 2


class PairState(enum.IntEnum):
    NEAR = 0
    BEGAN = 1
    PERSISTED = 2
    ENDED = 3


class ConstraintKind(enum.IntEnum):
    INSIDE = 0
    EDGE = 1
    PROXIMITY = 2
    IMPACT = 3


class DepthState(enum.IntEnum):
    SURFACE = 0
    PROPAGATED = 1
    CLOSEST = 2
    AMBIGUOUS = 3
    TOUCHING = 4
    UNKNOWN = 5
    PLANE = 6


class DepthMethod(enum.IntEnum):
    CONSISTENT = 0
    CLOSEST = 1
    NONE = 2


class ShapeKind(enum.IntEnum):
    NONE = 0
    HALF_SPACE = 1
    SPHERE = 2
    CAPSULE = 3
    CYLINDER = 4
    BOX = 5
    HEIGHTFIELD = 6
    SOLID = 7
    SHEET = 8
    FIELD = 9


class LogLevel(enum.IntEnum):
    INFO = 0
    WARNING = 1


class QueryFlags(enum.IntFlag):
    FIRST_HIT = 1
    EXTRAPOLATE = 2


class LocationState(enum.IntEnum):
    NONE = 0
    INSIDE = 1
    OUTSIDE = 2


class Side(enum.IntEnum):
    NONE = 0
    ENTERS = 1
    LEAVES = 2


class CellSizeWarnings(enum.IntFlag):
    GUESSED_WEIGHTS = 1
    BY_RULE = 2
    AT_MINIMUM = 4
    FROM_SPACING = 8
    ONE_PLACE = 16
    MODEL_DISAGREES = 32
    TIMINGS_DISAGREE = 64
    OUT_OF_RANGE = 128
    STOPPED = 256


class CostModel(enum.IntEnum):
    PAPER = 0
    REFERENCE = 1
    FAST = 2
    SURFACE = 3


class ReferenceFlags(enum.IntFlag):
    DENSE = 1
    PAPER_HASH = 2


class PrimitiveType(enum.IntEnum):
    POINT = 0
    EDGE = 1
    TRIANGLE = 2
    TET = 3
    BOX = 4


class KnownGrid(enum.IntEnum):
    NONE = 0
    SORTED = 1
    HASHED = 2
    WARP = 3
    IPC = 4
    IPC_PAIRS = 5
    VTK = 6
    PBAT = 7
    POINT_VOXELS = 8
    NUMPY = 9


class CellsStored(enum.IntEnum):
    DEFAULT = 0
    BOX = 1
    CENTRE = 2


class CellsQueried(enum.IntEnum):
    DEFAULT = 0
    BOX = 1
    QUERIED_27 = 2
    PAIRS = 3


class CellsKept(enum.IntEnum):
    DEFAULT = 0
    OCCUPIED = 1
    DENSE = 2


class Feature(enum.IntEnum):
    VERTEX = 0
    EDGE = 1
    FACE = 2


class MotionFlags(enum.IntFlag):
    CULL = 1


class CrossingKind(enum.IntEnum):
    THROUGH = 0
    TOUCHING = 1
    COPLANAR = 2


class IoFormat(enum.IntEnum):
    AUTO = 0
    GMSH = 1
    TETGEN = 2
    MEDIT = 3
    VEGA = 4
    VTK = 5
    VTU = 6
    SURFACE = 7
    ASSIMP = 8
    ABAQUS = 9


class IoLoadFlags(enum.IntFlag):
    KEEP_UNUSED = 1
    SPLIT_CELLS = 2


class IoSolidKind(enum.IntEnum):
    STUFFED = 0
    CUBES = 1


class IoWriteFormat(enum.IntEnum):
    AUTO = 0
    MSH_22 = 1
    MSH_41 = 2
    VTU = 3


class SimBodyFlags(enum.IntFlag):
    SELF_COLLISION = 1
    FIXED = 2


class ResolveFlags(enum.IntFlag):
    FIXED = 1


class vox_result(c_int32):
    """Marks the functions that can fail."""


# Of structs without pointers: for arrays over the library's memory.
dtypes: dict[str, Any] = {}


vox_task = CFUNCTYPE(None, c_uint64, c_uint64, c_uint32, c_void_p)
vox_cost_function = CFUNCTYPE(c_double, c_double, c_void_p)
vox_foreign_run = CFUNCTYPE(c_double, c_double, c_void_p)

class vox_positions(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_uint64),
        ("format", c_int32),
        ("reserved", c_uint32),
        ("byte_stride", c_uint64),
        ("component_byte_stride", c_uint64),
    ]


vox_allocator_allocate = CFUNCTYPE(c_void_p, c_size_t, c_size_t, c_void_p)
vox_allocator_release = CFUNCTYPE(None, c_void_p, c_size_t, c_size_t, c_void_p)
class vox_allocator(Structure):
    _fields_ = [
        ("allocate", vox_allocator_allocate),
        ("release", vox_allocator_release),
        ("user", c_void_p),
    ]


vox_log_write = CFUNCTYPE(None, c_int32, c_char_p, c_void_p)
class vox_log(Structure):
    _fields_ = [
        ("write", vox_log_write),
        ("user", c_void_p),
    ]


vox_task_system_enqueue = CFUNCTYPE(c_void_p, vox_task, c_uint64, c_uint64, c_void_p, c_void_p)
vox_task_system_finish = CFUNCTYPE(None, c_void_p, c_void_p)
class vox_task_system(Structure):
    _fields_ = [
        ("enqueue", vox_task_system_enqueue),
        ("finish", vox_task_system_finish),
        ("user", c_void_p),
    ]


class vox_cost_weights(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("measured", c_uint32),
        ("ns", c_double * 24),
    ]

dtypes["vox_cost_weights"] = dtype({
    "names": ["struct_size", "measured", "ns"],
    "formats": ["u4", "u4", ("f8", (24,))],
    "offsets": [0, 4, 8],
    "itemsize": 200})


class vox_reference_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("flags", c_uint32),
        ("hash_table_size", c_uint64),
        ("world_min", c_double * 3),
        ("world_max", c_double * 3),
        ("weights", POINTER(vox_cost_weights)),
    ]


class vox_grid_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("flags", c_uint32),
        ("worker_count", c_uint32),
        ("max_constraints_per_pair", c_uint32),
        ("cell_size", c_double),
        ("margin", c_double),
        ("byte_budget", c_uint64),
        ("allocator", POINTER(vox_allocator)),
        ("log", POINTER(vox_log)),
        ("tasks", POINTER(vox_task_system)),
        ("reference", POINTER(vox_reference_desc)),
    ]


class vox_filter(Structure):
    _fields_ = [
        ("flags", c_uint32),
        ("group", c_int32),
        ("category", c_uint64),
        ("mask", c_uint64),
        ("world", c_uint32),
        ("self_rings", c_uint32),
        ("self_rest_distance", c_double),
    ]

dtypes["vox_filter"] = dtype({
    "names": ["flags", "group", "category", "mask", "world", "self_rings", "self_rest_distance"],
    "formats": ["u4", "i4", "u8", "u8", "u4", "u4", "f8"],
    "offsets": [0, 4, 8, 16, 24, 28, 32],
    "itemsize": 40})


class vox_mesh_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("flags", c_uint32),
        ("positions", vox_positions),
        ("tets", c_void_p),
        ("tet_count", c_uint64),
        ("user_data", c_uint64),
        ("filter", vox_filter),
        ("rest_positions", vox_positions),
    ]


class vox_contact(Structure):
    _fields_ = [
        ("body_a", c_uint32),
        ("vertex", c_uint32),
        ("body_b", c_uint32),
        ("tet", c_uint32),
    ]

dtypes["vox_contact"] = dtype({
    "names": ["body_a", "vertex", "body_b", "tet"],
    "formats": ["u4", "u4", "u4", "u4"],
    "offsets": [0, 4, 8, 12],
    "itemsize": 16})


class vox_contact_view(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_uint64),
        ("interiors", c_void_p),
    ]


class vox_pair(Structure):
    _fields_ = [
        ("body_a", c_uint32),
        ("body_b", c_uint32),
        ("user_data_a", c_uint64),
        ("user_data_b", c_uint64),
        ("state", c_int32),
        ("reserved", c_uint32),
        ("first_contact", c_uint64),
        ("contact_count", c_uint64),
    ]

dtypes["vox_pair"] = dtype({
    "names": ["body_a", "body_b", "user_data_a", "user_data_b", "state", "reserved", "first_contact", "contact_count"],
    "formats": ["u4", "u4", "u8", "u8", "i4", "u4", "u8", "u8"],
    "offsets": [0, 4, 8, 16, 24, 28, 32, 40],
    "itemsize": 48})


class vox_pair_view(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_uint64),
        ("contacts", c_void_p),
    ]


class vox_constraint(Structure):
    _fields_ = [
        ("body_a", c_uint32),
        ("body_b", c_uint32),
        ("kind", c_int32),
        ("state", c_int32),
        ("count_a", c_uint32),
        ("count", c_uint32),
        ("vertices", c_uint32 * 5),
        ("element_b", c_uint32),
        ("weights", c_double * 5),
        ("normal", c_double * 3),
        ("gap", c_double),
        ("offset", c_double),
        ("position", c_double * 3),
        ("time", c_double),
        ("user_data_a", c_uint64),
        ("user_data_b", c_uint64),
        ("pair", c_uint32),
        ("previous", c_uint32),
        ("left_out", c_uint64),
    ]

dtypes["vox_constraint"] = dtype({
    "names": ["body_a", "body_b", "kind", "state", "count_a", "count", "vertices", "element_b", "weights", "normal",
        "gap", "offset", "position", "time", "user_data_a", "user_data_b", "pair", "previous", "left_out"],
    "formats": ["u4", "u4", "i4", "i4", "u4", "u4", ("u4", (5,)), "u4", ("f8", (5,)), ("f8", (3,)), "f8", "f8", ("f8",
        (3,)), "f8", "u8", "u8", "u4", "u4", "u8"],
    "offsets": [0, 4, 8, 12, 16, 20, 24, 44, 48, 88, 112, 120, 128, 152, 160, 168, 176, 180, 184],
    "itemsize": 192})


class vox_constraint_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("method", c_int32),
        ("body_a", c_uint32),
        ("body_b", c_uint32),
        ("mask", c_uint64),
        ("closest_budget", c_uint64),
    ]

dtypes["vox_constraint_desc"] = dtype({
    "names": ["struct_size", "method", "body_a", "body_b", "mask", "closest_budget"],
    "formats": ["u4", "i4", "u4", "u4", "u8", "u8"],
    "offsets": [0, 4, 8, 12, 16, 24],
    "itemsize": 32})


class vox_constraint_view(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_uint64),
        ("pair_offsets", c_void_p),
        ("pair_count", c_uint64),
    ]


class vox_body_info(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("shape", c_uint32),
        ("user_data", c_uint64),
        ("enabled", c_uint32),
        ("flags", c_uint32),
        ("tet_count", c_uint64),
        ("enabled_tet_count", c_uint64),
        ("positions", vox_positions),
        ("filter", vox_filter),
        ("transform", c_double * 12),
    ]


vox_shape_desc_field = CFUNCTYPE(None, c_void_p, c_uint64, c_void_p, c_void_p, c_void_p)
class vox_shape_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("radius", c_double),
        ("half_length", c_double),
        ("half_size", c_double * 3),
        ("positions", vox_positions),
        ("triangles", c_void_p),
        ("triangle_count", c_uint64),
        ("heights", c_void_p),
        ("columns", c_uint32),
        ("rows", c_uint32),
        ("spacing", c_double * 2),
        ("field", vox_shape_desc_field),
        ("field_user", c_void_p),
        ("user_data", c_uint64),
        ("filter", vox_filter),
    ]


class vox_grid_info(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("flags", c_uint32),
        ("epoch", c_uint64),
        ("cell_size", c_double),
        ("margin", c_double),
        ("bytes", c_uint64),
        ("peak_bytes", c_uint64),
        ("step_ns", c_uint64),
        ("moved_bodies", c_uint64),
        ("skipped_bodies", c_uint64),
        ("total_began", c_uint64),
        ("total_ended", c_uint64),
    ]

dtypes["vox_grid_info"] = dtype({
    "names": ["struct_size", "flags", "epoch", "cell_size", "margin", "bytes", "peak_bytes", "step_ns", "moved_bodies",
        "skipped_bodies", "total_began", "total_ended"],
    "formats": ["u4", "u4", "u8", "f8", "f8", "u8", "u8", "u8", "u8", "u8", "u8", "u8"],
    "offsets": [0, 4, 8, 16, 24, 32, 40, 48, 56, 64, 72, 80],
    "itemsize": 88})


class vox_counter(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("value", c_uint64),
    ]


class vox_counter_view(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_uint64),
    ]


class vox_failure(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("result", c_int32),
        ("body", c_uint32),
        ("vertex", c_uint32),
        ("user_data", c_uint64),
        ("position", c_double * 3),
    ]

dtypes["vox_failure"] = dtype({
    "names": ["struct_size", "result", "body", "vertex", "user_data", "position"],
    "formats": ["u4", "i4", "u4", "u4", "u8", ("f8", (3,))],
    "offsets": [0, 4, 8, 12, 16, 24],
    "itemsize": 48})


class vox_vertices_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("count", c_uint64),
        ("positions", vox_positions),
        ("copies_of", c_void_p),
        ("rest_positions", vox_positions),
    ]


class vox_query_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("flags", c_uint32),
        ("mask", c_uint64),
        ("excluded", c_uint32),
        ("reserved", c_uint32),
        ("max_distance", c_double),
    ]

dtypes["vox_query_desc"] = dtype({
    "names": ["struct_size", "flags", "mask", "excluded", "reserved", "max_distance"],
    "formats": ["u4", "u4", "u8", "u4", "u4", "f8"],
    "offsets": [0, 4, 8, 16, 20, 24],
    "itemsize": 32})


class vox_location(Structure):
    _fields_ = [
        ("body", c_uint32),
        ("tet", c_uint32),
        ("state", c_int32),
        ("reserved", c_uint32),
        ("weights", c_double * 4),
        ("distance", c_double),
    ]

dtypes["vox_location"] = dtype({
    "names": ["body", "tet", "state", "reserved", "weights", "distance"],
    "formats": ["u4", "u4", "i4", "u4", ("f8", (4,)), "f8"],
    "offsets": [0, 4, 8, 12, 16, 48],
    "itemsize": 56})


class vox_point_hit(Structure):
    _fields_ = [
        ("point", c_uint32),
        ("body", c_uint32),
        ("tet", c_uint32),
        ("reserved", c_uint32),
        ("weights", c_double * 4),
    ]

dtypes["vox_point_hit"] = dtype({
    "names": ["point", "body", "tet", "reserved", "weights"],
    "formats": ["u4", "u4", "u4", "u4", ("f8", (4,))],
    "offsets": [0, 4, 8, 12, 16],
    "itemsize": 48})


class vox_closest_hit(Structure):
    _fields_ = [
        ("body", c_uint32),
        ("tet", c_uint32),
        ("facet", c_uint32),
        ("inside", c_uint32),
        ("face", c_uint32 * 3),
        ("reserved", c_uint32),
        ("weights", c_double * 3),
        ("position", c_double * 3),
        ("normal", c_double * 3),
        ("distance", c_double),
    ]

dtypes["vox_closest_hit"] = dtype({
    "names": ["body", "tet", "facet", "inside", "face", "reserved", "weights", "position", "normal", "distance"],
    "formats": ["u4", "u4", "u4", "u4", ("u4", (3,)), "u4", ("f8", (3,)), ("f8", (3,)), ("f8", (3,)), "f8"],
    "offsets": [0, 4, 8, 12, 16, 28, 32, 56, 80, 104],
    "itemsize": 112})


class vox_box_hit(Structure):
    _fields_ = [
        ("box", c_uint32),
        ("body", c_uint32),
        ("tet", c_uint32),
    ]

dtypes["vox_box_hit"] = dtype({
    "names": ["box", "body", "tet"],
    "formats": ["u4", "u4", "u4"],
    "offsets": [0, 4, 8],
    "itemsize": 12})


class vox_ray_hit(Structure):
    _fields_ = [
        ("ray", c_uint32),
        ("body", c_uint32),
        ("tet", c_uint32),
        ("facet", c_uint32),
        ("side", c_int32),
        ("face", c_uint32 * 3),
        ("t", c_double),
        ("weights", c_double * 3),
    ]

dtypes["vox_ray_hit"] = dtype({
    "names": ["ray", "body", "tet", "facet", "side", "face", "t", "weights"],
    "formats": ["u4", "u4", "u4", "u4", "i4", ("u4", (3,)), "f8", ("f8", (3,))],
    "offsets": [0, 4, 8, 12, 16, 20, 32, 40],
    "itemsize": 64})


class vox_track_piece(Structure):
    _fields_ = [
        ("segment", c_uint32),
        ("body", c_uint32),
        ("tet", c_uint32),
        ("facet_in", c_uint32),
        ("facet_out", c_uint32),
        ("reserved", c_uint32),
        ("t_in", c_double),
        ("t_out", c_double),
    ]

dtypes["vox_track_piece"] = dtype({
    "names": ["segment", "body", "tet", "facet_in", "facet_out", "reserved", "t_in", "t_out"],
    "formats": ["u4", "u4", "u4", "u4", "u4", "u4", "f8", "f8"],
    "offsets": [0, 4, 8, 12, 16, 20, 24, 32],
    "itemsize": 40})


class vox_triangle_hit(Structure):
    _fields_ = [
        ("triangle", c_uint32),
        ("body", c_uint32),
        ("tet", c_uint32),
        ("edges", c_uint32),
        ("t", c_double),
        ("s", c_double * 6),
    ]

dtypes["vox_triangle_hit"] = dtype({
    "names": ["triangle", "body", "tet", "edges", "t", "s"],
    "formats": ["u4", "u4", "u4", "u4", "f8", ("f8", (6,))],
    "offsets": [0, 4, 8, 12, 16, 24],
    "itemsize": 72})


class vox_cost_sample(Structure):
    _fields_ = [
        ("cell_size", c_double),
        ("cost", c_double),
    ]

dtypes["vox_cost_sample"] = dtype({
    "names": ["cell_size", "cost"],
    "formats": ["f8", "f8"],
    "offsets": [0, 8],
    "itemsize": 16})


class vox_cost_term(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("count", c_double),
        ("cost", c_double),
    ]


class vox_cell_size_rule(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("cell_size", c_double),
        ("cost", c_double),
    ]


class vox_timing(Structure):
    _fields_ = [
        ("cell_size", c_double),
        ("seconds", c_double),
    ]

dtypes["vox_timing"] = dtype({
    "names": ["cell_size", "seconds"],
    "formats": ["f8", "f8"],
    "offsets": [0, 8],
    "itemsize": 16})


class vox_foreign_weights(Structure):
    _fields_ = [
        ("run", c_double),
        ("store", c_double),
        ("visit", c_double),
        ("found", c_double),
        ("read", c_double),
        ("occupied", c_double),
        ("cell", c_double),
    ]

dtypes["vox_foreign_weights"] = dtype({
    "names": ["run", "store", "visit", "found", "read", "occupied", "cell"],
    "formats": ["f8", "f8", "f8", "f8", "f8", "f8", "f8"],
    "offsets": [0, 8, 16, 24, 32, 40, 48],
    "itemsize": 56})


class vox_cell_size_result(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("warnings", c_uint32),
        ("cell_size", c_double),
        ("zone_min", c_double),
        ("zone_max", c_double),
        ("cost", c_double),
        ("min_cell_size", c_double),
        ("cells_per_axis", c_double),
        ("fit_error", c_double),
        ("expected_loss", c_double),
        ("curve_count", c_uint32),
        ("term_count", c_uint32),
        ("rule_count", c_uint32),
        ("timing_count", c_uint32),
        ("curve", vox_cost_sample * 64),
        ("terms", vox_cost_term * 12),
        ("rules", vox_cell_size_rule * 8),
        ("timings", vox_timing * 32),
        ("weights", vox_foreign_weights),
        ("note", c_char * 256),
    ]


class vox_cell_size_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("model", c_int32),
        ("reference_flags", c_uint32),
        ("reserved", c_uint32),
        ("zone_loss", c_double),
        ("p_nc", c_double),
        ("cost_ratio", c_double),
        ("world_edge", c_double),
        ("byte_budget", c_uint64),
        ("weights", POINTER(vox_cost_weights)),
        ("allocator", POINTER(vox_allocator)),
    ]


class vox_geometry(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("vertices", c_uint64),
        ("tets", c_uint64),
        ("edges", c_uint64),
        ("facets", c_uint64),
        ("boundary_facets", c_uint64),
        ("degenerate_tets", c_uint64),
        ("mean_edge", c_double),
        ("mean_longest_edge", c_double),
        ("mean_box_side", c_double),
        ("median_box_side", c_double),
        ("mean_facet_area", c_double),
        ("mean_tet_facet_area", c_double),
        ("mean_boundary_facet_area", c_double),
        ("mean_volume", c_double),
        ("bounds_min", c_double * 3),
        ("bounds_max", c_double * 3),
    ]

dtypes["vox_geometry"] = dtype({
    "names": ["struct_size", "reserved", "vertices", "tets", "edges", "facets", "boundary_facets", "degenerate_tets",
        "mean_edge", "mean_longest_edge", "mean_box_side", "median_box_side", "mean_facet_area", "mean_tet_facet_area",
        "mean_boundary_facet_area", "mean_volume", "bounds_min", "bounds_max"],
    "formats": ["u4", "u4", "u8", "u8", "u8", "u8", "u8", "u8", "f8", "f8", "f8", "f8", "f8", "f8", "f8", "f8", ("f8",
        (3,)), ("f8", (3,))],
    "offsets": [0, 4, 8, 16, 24, 32, 40, 48, 56, 64, 72, 80, 88, 96, 104, 112, 120, 144],
    "itemsize": 168})


class vox_primitives(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("type", c_int32),
        ("positions", vox_positions),
        ("indices", c_void_p),
        ("index_byte_stride", c_uint64),
        ("count", c_uint64),
        ("radii", c_void_p),
        ("radius_byte_stride", c_uint64),
        ("radius_format", c_int32),
        ("reserved", c_uint32),
        ("radius", c_double),
    ]


class vox_foreign_grid(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("known", c_int32),
        ("cells_stored", c_int32),
        ("cells_queried", c_int32),
        ("cells_kept", c_int32),
        ("reserved", c_uint32),
        ("stored", POINTER(vox_primitives)),
        ("querying", POINTER(vox_primitives)),
        ("radius", c_double),
        ("min_cell_size", c_double),
        ("zone_loss", c_double),
        ("weights", vox_foreign_weights),
        ("allocator", POINTER(vox_allocator)),
    ]


class vox_foreign_counts(Structure):
    _fields_ = [
        ("stored", c_double),
        ("visits", c_double),
        ("empty", c_double),
        ("reads", c_double),
        ("occupied", c_double),
        ("cells", c_double),
    ]

dtypes["vox_foreign_counts"] = dtype({
    "names": ["stored", "visits", "empty", "reads", "occupied", "cells"],
    "formats": ["f8", "f8", "f8", "f8", "f8", "f8"],
    "offsets": [0, 8, 16, 24, 32, 40],
    "itemsize": 48})


class vox_tune_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("max_runs", c_uint32),
        ("min", c_double),
        ("max", c_double),
        ("first", c_double),
        ("wanted_loss", c_double),
    ]

dtypes["vox_tune_desc"] = dtype({
    "names": ["struct_size", "max_runs", "min", "max", "first", "wanted_loss"],
    "formats": ["u4", "u4", "f8", "f8", "f8", "f8"],
    "offsets": [0, 4, 8, 16, 24, 32],
    "itemsize": 40})


class vox_surface_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("worker_count", c_uint32),
        ("vertex_count", c_uint64),
        ("edge_count", c_uint64),
        ("face_count", c_uint64),
        ("edges", c_void_p),
        ("faces", c_void_p),
        ("patches", c_void_p),
        ("patch_categories", c_void_p),
        ("patch_masks", c_void_p),
        ("patch_count", c_uint64),
        ("cell_size", c_double),
        ("byte_budget", c_uint64),
        ("allocator", POINTER(vox_allocator)),
        ("tasks", POINTER(vox_task_system)),
    ]


class vox_feature_view(Structure):
    _fields_ = [
        ("vertices", c_void_p),
        ("count", c_uint64),
    ]


class vox_motion(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("flags", c_uint32),
        ("from", vox_positions),
        ("to", vox_positions),
        ("radius", c_double),
    ]


class vox_partner_lists(Structure):
    _fields_ = [
        ("offsets", c_void_p),
        ("partners", c_void_p),
        ("first", c_uint64),
        ("count", c_uint64),
    ]


class vox_crossing(Structure):
    _fields_ = [
        ("edge", c_uint32),
        ("face", c_uint32),
        ("kind", c_int32),
        ("reserved", c_uint32),
        ("edge_weights", c_double * 2),
        ("face_weights", c_double * 3),
        ("position", c_double * 3),
    ]

dtypes["vox_crossing"] = dtype({
    "names": ["edge", "face", "kind", "reserved", "edge_weights", "face_weights", "position"],
    "formats": ["u4", "u4", "i4", "u4", ("f8", (2,)), ("f8", (3,)), ("f8", (3,))],
    "offsets": [0, 4, 8, 12, 16, 32, 56],
    "itemsize": 80})


class vox_crossing_view(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_uint64),
    ]


class vox_proximity(Structure):
    _fields_ = [
        ("a", c_uint32),
        ("b", c_uint32),
        ("distance", c_double),
        ("weights_a", c_double * 3),
        ("weights_b", c_double * 3),
        ("point_a", c_double * 3),
        ("point_b", c_double * 3),
    ]

dtypes["vox_proximity"] = dtype({
    "names": ["a", "b", "distance", "weights_a", "weights_b", "point_a", "point_b"],
    "formats": ["u4", "u4", "f8", ("f8", (3,)), ("f8", (3,)), ("f8", (3,)), ("f8", (3,))],
    "offsets": [0, 4, 8, 16, 40, 64, 88],
    "itemsize": 112})


class vox_proximity_view(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_uint64),
    ]


class vox_impact_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("max_iterations", c_uint32),
        ("distance", c_double),
        ("slack", c_double),
    ]

dtypes["vox_impact_desc"] = dtype({
    "names": ["struct_size", "max_iterations", "distance", "slack"],
    "formats": ["u4", "u4", "f8", "f8"],
    "offsets": [0, 4, 8, 16],
    "itemsize": 24})


class vox_safe_step(Structure):
    _fields_ = [
        ("step", c_double),
        ("pairs", c_uint64),
        ("kind_a", c_int32),
        ("kind_b", c_int32),
        ("a", c_uint32),
        ("b", c_uint32),
        ("unfinished", c_uint32),
        ("reserved", c_uint32),
    ]

dtypes["vox_safe_step"] = dtype({
    "names": ["step", "pairs", "kind_a", "kind_b", "a", "b", "unfinished", "reserved"],
    "formats": ["f8", "u8", "i4", "i4", "u4", "u4", "u4", "u4"],
    "offsets": [0, 8, 16, 20, 24, 28, 32, 36],
    "itemsize": 40})


class vox_impact(Structure):
    _fields_ = [
        ("a", c_uint32),
        ("b", c_uint32),
        ("time", c_double),
    ]

dtypes["vox_impact"] = dtype({
    "names": ["a", "b", "time"],
    "formats": ["u4", "u4", "f8"],
    "offsets": [0, 4, 8],
    "itemsize": 16})


class vox_impact_view(Structure):
    _fields_ = [
        ("data", c_void_p),
        ("count", c_uint64),
    ]


vox_io_load_desc_progress = CFUNCTYPE(c_int32, c_double, c_void_p)
class vox_io_load_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("format", c_int32),
        ("mesh", c_uint32),
        ("flags", c_uint32),
        ("allocator", POINTER(vox_allocator)),
        ("progress", vox_io_load_desc_progress),
        ("progress_user", c_void_p),
    ]


class vox_io_source(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("data", c_void_p),
        ("size", c_size_t),
    ]


class vox_io_mesh_view(Structure):
    _fields_ = [
        ("positions", c_void_p),
        ("vertex_count", c_uint64),
        ("tets", c_void_p),
        ("tet_count", c_uint64),
        ("triangles", c_void_p),
        ("triangle_count", c_uint64),
        ("tet_regions", c_void_p),
        ("file_vertices", c_void_p),
        ("tet_cells", c_void_p),
    ]


class vox_io_report(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("format", c_int32),
        ("vertices", c_uint64),
        ("tets", c_uint64),
        ("triangles", c_uint64),
        ("skipped_elements", c_uint64),
        ("second_order_tets", c_uint64),
        ("inverted_tets", c_uint64),
        ("degenerate_tets", c_uint64),
        ("nearly_flat_tets", c_uint64),
        ("duplicate_tets", c_uint64),
        ("degenerate_triangles", c_uint64),
        ("duplicate_vertices", c_uint64),
        ("unused_vertices", c_uint64),
        ("boundary_facets", c_uint64),
        ("non_manifold_facets", c_uint64),
        ("open_edges", c_uint64),
        ("misoriented_edges", c_uint64),
        ("components", c_uint64),
        ("volume", c_double),
        ("bounds_min", c_double * 3),
        ("bounds_max", c_double * 3),
        ("unit_in_metres", c_double),
        ("left_out_vertices", c_uint64),
        ("left_out_triangles", c_uint64),
        ("split_cells", c_uint64),
        ("left_out_tets", c_uint64),
    ]

dtypes["vox_io_report"] = dtype({
    "names": ["struct_size", "format", "vertices", "tets", "triangles", "skipped_elements", "second_order_tets",
        "inverted_tets", "degenerate_tets", "nearly_flat_tets", "duplicate_tets", "degenerate_triangles",
        "duplicate_vertices", "unused_vertices", "boundary_facets", "non_manifold_facets", "open_edges",
        "misoriented_edges", "components", "volume", "bounds_min", "bounds_max", "unit_in_metres", "left_out_vertices",
        "left_out_triangles", "split_cells", "left_out_tets"],
    "formats": ["u4", "i4", "u8", "u8", "u8", "u8", "u8", "u8", "u8", "u8", "u8", "u8", "u8", "u8", "u8", "u8", "u8",
        "u8", "u8", "f8", ("f8", (3,)), ("f8", (3,)), "f8", "u8", "u8", "u8", "u8"],
    "offsets": [0, 4, 8, 16, 24, 32, 40, 48, 56, 64, 72, 80, 88, 96, 104, 112, 120, 128, 136, 144, 152, 176, 200, 208,
        216, 224, 232],
    "itemsize": 240})


vox_io_tetrahedralize_desc_progress = CFUNCTYPE(c_int32, c_double, c_void_p)
class vox_io_tetrahedralize_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("cell", c_double),
        ("max_tets", c_uint64),
        ("max_distance", c_double),
        ("coarsen", c_uint32),
        ("reserved", c_uint32),
        ("progress", vox_io_tetrahedralize_desc_progress),
        ("progress_user", c_void_p),
        ("allocator", POINTER(vox_allocator)),
    ]


class vox_io_quality(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_uint32),
        ("vertices", c_uint64),
        ("tets", c_uint64),
        ("boundary_facets", c_uint64),
        ("min_dihedral", c_double),
        ("max_dihedral", c_double),
        ("volume", c_double),
        ("surface_volume", c_double),
        ("mesh_to_surface", c_double),
        ("surface_to_mesh", c_double),
        ("hausdorff", c_double),
    ]

dtypes["vox_io_quality"] = dtype({
    "names": ["struct_size", "reserved", "vertices", "tets", "boundary_facets", "min_dihedral", "max_dihedral",
        "volume", "surface_volume", "mesh_to_surface", "surface_to_mesh", "hausdorff"],
    "formats": ["u4", "u4", "u8", "u8", "u8", "f8", "f8", "f8", "f8", "f8", "f8", "f8"],
    "offsets": [0, 4, 8, 16, 24, 32, 40, 48, 56, 64, 72, 80],
    "itemsize": 88})


class vox_io_point_data(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("values", c_void_p),
        ("components", c_uint32),
        ("reserved", c_uint32),
    ]


class vox_io_write_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("format", c_int32),
        ("binary", c_uint32),
        ("reserved", c_uint32),
        ("point_data", c_void_p),
        ("point_data_count", c_uint64),
        ("cell_data", c_void_p),
        ("cell_data_count", c_uint64),
    ]


vox_io_sink_write = CFUNCTYPE(c_int32, c_void_p, c_size_t, c_void_p)
class vox_io_sink(Structure):
    _fields_ = [
        ("write", vox_io_sink_write),
        ("user", c_void_p),
    ]


class vox_sim_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("substeps", c_uint32),
        ("detect_every", c_uint32),
        ("reserved", c_uint32),
        ("gravity", c_double * 3),
        ("max_time_step", c_double),
        ("floor_normal", c_double * 3),
        ("floor_offset", c_double),
        ("friction", c_double),
        ("contact_compliance", c_double),
        ("max_push_speed", c_double),
        ("contact_slop", c_double),
        ("grid", POINTER(vox_grid_desc)),
        ("log", POINTER(vox_log)),
        ("allocator", POINTER(vox_allocator)),
    ]


class vox_sim_body_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("flags", c_uint32),
        ("positions", c_void_p),
        ("rest_positions", c_void_p),
        ("velocities", c_void_p),
        ("tets", c_void_p),
        ("vertex_count", c_uint64),
        ("tet_count", c_uint64),
        ("density", c_double),
        ("youngs_modulus", c_double),
        ("bulk_modulus", c_double),
        ("damping", c_double),
        ("user_data", c_uint64),
    ]


class vox_sim_body_view(Structure):
    _fields_ = [
        ("positions", c_void_p),
        ("velocities", c_void_p),
        ("masses", c_void_p),
        ("grid_positions", c_void_p),
        ("tets", c_void_p),
        ("vertex_count", c_uint64),
        ("tet_count", c_uint64),
    ]


class vox_sim_energy(Structure):
    _fields_ = [
        ("kinetic", c_double),
        ("potential", c_double),
        ("elastic", c_double),
        ("mass", c_double),
        ("momentum", c_double * 3),
        ("centre", c_double * 3),
        ("max_speed", c_double),
    ]

dtypes["vox_sim_energy"] = dtype({
    "names": ["kinetic", "potential", "elastic", "mass", "momentum", "centre", "max_speed"],
    "formats": ["f8", "f8", "f8", "f8", ("f8", (3,)), ("f8", (3,)), "f8"],
    "offsets": [0, 8, 16, 24, 32, 56, 80],
    "itemsize": 88})


class vox_resolve_body(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("flags", c_uint32),
        ("positions", c_void_p),
        ("vertex_count", c_uint64),
        ("tets", c_void_p),
        ("tet_count", c_uint64),
        ("faces", c_void_p),
        ("face_count", c_uint64),
        ("moved_vertices", c_uint64),
        ("largest_move", c_double),
        ("volume_before", c_double),
        ("volume", c_double),
        ("inverted_tets", c_uint64),
    ]


class vox_resolve_place(Structure):
    _fields_ = [
        ("body_a", c_uint32),
        ("body_b", c_uint32),
        ("distance", c_double),
        ("position", c_double * 3),
    ]

dtypes["vox_resolve_place"] = dtype({
    "names": ["body_a", "body_b", "distance", "position"],
    "formats": ["u4", "u4", "f8", ("f8", (3,))],
    "offsets": [0, 4, 8, 16],
    "itemsize": 40})


class vox_resolve_desc(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("worker_count", c_uint32),
        ("max_iterations", c_uint32),
        ("reserved", c_uint32),
        ("gap", c_double),
        ("max_move", c_double),
        ("places", c_void_p),
        ("place_capacity", c_uint64),
        ("allocator", POINTER(vox_allocator)),
    ]


class vox_resolve_report(Structure):
    _fields_ = [
        ("struct_size", c_uint32),
        ("resolved", c_uint32),
        ("first_crossings", c_uint64),
        ("crossings", c_uint64),
        ("inside_vertices", c_uint64),
        ("close_pairs", c_uint64),
        ("first_depth", c_double),
        ("least_distance", c_double),
        ("largest_move", c_double),
        ("iterations", c_uint64),
        ("place_count", c_uint64),
    ]

dtypes["vox_resolve_report"] = dtype({
    "names": ["struct_size", "resolved", "first_crossings", "crossings", "inside_vertices", "close_pairs",
        "first_depth", "least_distance", "largest_move", "iterations", "place_count"],
    "formats": ["u4", "u4", "u8", "u8", "u8", "u8", "f8", "f8", "f8", "u8", "u8"],
    "offsets": [0, 4, 8, 16, 24, 32, 40, 48, 56, 64, 72],
    "itemsize": 80})


# What vox_default_X sets in a struct, beside struct_size, where that is not all 0.
DEFAULTS: dict[str, dict[str, Any]] = {
    "vox_sim_desc": {'substeps': 10, 'detect_every': 1, 'gravity': [0, 0, -9.81], 'max_time_step': 0.03333333333333333, 'floor_normal': [0, 0, 1], 'friction': 0.5, 'max_push_speed': 1, 'contact_slop': -1},
    "vox_sim_body_desc": {'density': 1000, 'youngs_modulus': 1000000, 'bulk_modulus': 1000000, 'damping': 0.01},
}


# Of each header: name, type of the result, types of the parameters.
FUNCTIONS: dict[str, dict[str, tuple[Any, Any]]] = {
    "vox": {
        "vox_last_error": (c_char_p, ()),
        "vox_result_string": (c_char_p, (c_int32,)),
        "vox_grid_create": (vox_result, (POINTER(vox_grid_desc), POINTER(c_void_p))),
        "vox_grid_destroy": (None, (c_void_p,)),
        "vox_mesh_insert": (vox_result, (c_void_p, POINTER(vox_mesh_desc), POINTER(c_uint32))),
        "vox_body_remove": (vox_result, (c_void_p, c_uint32)),
        "vox_mesh_bind_positions": (vox_result, (c_void_p, c_uint32, POINTER(vox_positions))),
        "vox_grid_step": (vox_result, (c_void_p,)),
        "vox_grids_step": (vox_result, (c_void_p, c_uint64, c_uint32, POINTER(vox_task_system), c_void_p)),
        "vox_grid_get_contacts": (vox_result, (c_void_p, POINTER(vox_contact_view))),
        "vox_grid_get_hash": (vox_result, (c_void_p, POINTER(c_uint64))),
        "vox_grid_get_pairs": (vox_result, (c_void_p, POINTER(vox_pair_view))),
        "vox_grid_find_constraints": (vox_result, (c_void_p, POINTER(vox_constraint_desc))),
        "vox_grid_get_constraints": (vox_result, (c_void_p, POINTER(vox_constraint_view))),
        "vox_body_set_transform": (vox_result, (c_void_p, c_uint32, c_void_p)),
        "vox_body_set_enabled": (vox_result, (c_void_p, c_uint32, c_uint32)),
        "vox_body_set_filter": (vox_result, (c_void_p, c_uint32, POINTER(vox_filter))),
        "vox_grid_set_pair_enabled": (vox_result, (c_void_p, c_uint32, c_uint32, c_uint32)),
        "vox_body_mark_moved": (vox_result, (c_void_p, c_uint32)),
        "vox_mesh_map_positions": (vox_result, (c_void_p, c_uint32, POINTER(c_void_p))),
        "vox_mesh_bind_previous_positions": (vox_result, (c_void_p, c_uint32, POINTER(vox_positions))),
        "vox_body_get_info": (vox_result, (c_void_p, c_uint32, POINTER(vox_body_info))),
        "vox_body_get_user_data": (vox_result, (c_void_p, c_uint32, POINTER(c_uint64))),
        "vox_body_is_valid": (c_uint32, (c_void_p, c_uint32)),
        "vox_grid_get_bodies": (vox_result, (c_void_p, c_void_p, c_uint64, POINTER(c_uint64))),
        "vox_shape_insert": (vox_result, (c_void_p, POINTER(vox_shape_desc), POINTER(c_uint32))),
        "vox_shape_set_previous_transform": (vox_result, (c_void_p, c_uint32, c_void_p)),
        "vox_grid_clear": (vox_result, (c_void_p,)),
        "vox_grid_reserve": (vox_result, (c_void_p, c_uint32, c_uint64)),
        "vox_grid_prepare": (vox_result, (c_void_p,)),
        "vox_grid_set_cell_size": (vox_result, (c_void_p, c_double)),
        "vox_grid_set_worker_count": (vox_result, (c_void_p, c_uint32)),
        "vox_grid_set_flags": (vox_result, (c_void_p, c_uint32)),
        "vox_grid_set_margin": (vox_result, (c_void_p, c_double)),
        "vox_grid_get_info": (vox_result, (c_void_p, POINTER(vox_grid_info))),
        "vox_grid_get_counters": (vox_result, (c_void_p, POINTER(vox_counter_view))),
        "vox_grid_get_failure": (vox_result, (c_void_p, c_uint32, POINTER(vox_failure))),
        "vox_mesh_set_topology": (vox_result, (c_void_p, c_uint32, POINTER(vox_mesh_desc))),
        "vox_mesh_set_tets_enabled": (vox_result, (c_void_p, c_uint32, c_void_p, c_uint64, c_uint32)),
        "vox_mesh_replace_tets": (vox_result, (c_void_p, c_uint32, c_void_p, c_uint64, c_void_p)),
        "vox_mesh_append_tets": (vox_result, (c_void_p, c_uint32, c_void_p, c_uint64, POINTER(c_uint32))),
        "vox_mesh_remove_tets": (vox_result, (c_void_p, c_uint32, c_void_p, c_uint64)),
        "vox_mesh_append_vertices": (vox_result, (c_void_p, c_uint32, POINTER(vox_vertices_desc), POINTER(c_uint32))),
        "vox_mesh_remove_vertices": (vox_result, (c_void_p, c_uint32, c_void_p, c_uint64)),
        "vox_mesh_get_tets": (vox_result, (c_void_p, c_uint32, c_void_p, c_void_p, c_uint64, POINTER(c_uint64))),
        "vox_grid_save": (vox_result, (c_void_p, c_void_p, c_uint64, POINTER(c_uint64))),
        "vox_grid_load": (vox_result, (c_void_p, c_uint64, POINTER(vox_grid_desc), POINTER(c_void_p))),
        "vox_version": (c_uint32, ()),
        "vox_abi_version": (c_uint32, ()),
        "vox_build_info": (c_char_p, ()),
        "vox_fail": (vox_result, (c_int32, c_char_p)),
    },
    "vox_query": {
        "vox_grid_update_locator": (vox_result, (c_void_p, POINTER(c_void_p))),
        "vox_locator_retain": (vox_result, (c_void_p,)),
        "vox_locator_release": (None, (c_void_p,)),
        "vox_locator_get_epoch": (vox_result, (c_void_p, POINTER(c_uint64))),
        "vox_locator_get_user_data": (vox_result, (c_void_p, c_uint32, POINTER(c_uint64))),
        "vox_locator_locate": (vox_result, (c_void_p, POINTER(vox_positions), POINTER(vox_query_desc), c_void_p)),
        "vox_locator_find_point_hits": (vox_result, (c_void_p, POINTER(vox_positions), POINTER(vox_query_desc),
            c_void_p, c_uint64, POINTER(c_uint64))),
        "vox_locator_find_closest": (vox_result, (c_void_p, POINTER(vox_positions), POINTER(vox_query_desc), c_void_p)),
        "vox_locator_find_box_hits": (vox_result, (c_void_p, POINTER(vox_positions), POINTER(vox_positions),
            POINTER(vox_query_desc), c_void_p, c_uint64, POINTER(c_uint64))),
        "vox_locator_find_ray_hits": (vox_result, (c_void_p, POINTER(vox_positions), POINTER(vox_positions),
            POINTER(vox_query_desc), c_void_p, c_uint64, POINTER(c_uint64))),
        "vox_locator_test_rays": (vox_result, (c_void_p, POINTER(vox_positions), POINTER(vox_positions),
            POINTER(vox_query_desc), c_void_p)),
        "vox_locator_find_tracks": (vox_result, (c_void_p, POINTER(vox_positions), POINTER(vox_positions),
            POINTER(vox_query_desc), c_void_p, c_uint64, POINTER(c_uint64))),
        "vox_locator_find_closest_to_segments": (vox_result, (c_void_p, POINTER(vox_positions), POINTER(vox_positions),
            POINTER(vox_query_desc), c_void_p)),
        "vox_locator_find_triangle_hits": (vox_result, (c_void_p, POINTER(vox_positions), POINTER(vox_positions),
            POINTER(vox_query_desc), c_void_p, c_uint64, POINTER(c_uint64))),
    },
    "vox_cell_size": {
        "vox_suggest_cell_size": (vox_result, (POINTER(vox_cell_size_desc), c_void_p, c_uint64,
            POINTER(vox_cell_size_result))),
        "vox_grid_suggest_cell_size": (vox_result, (c_void_p, POINTER(vox_cell_size_desc),
            POINTER(vox_cell_size_result))),
        "vox_cost_calibrate": (vox_result, (POINTER(vox_cost_weights),)),
        "vox_measure_geometry": (vox_result, (c_void_p, c_uint64, POINTER(vox_geometry))),
        "vox_cost_minimise": (vox_result, (vox_cost_function, c_void_p, c_double, c_double, c_double,
            POINTER(vox_cell_size_result))),
        "vox_foreign_grid_suggest": (vox_result, (POINTER(vox_foreign_grid), POINTER(vox_cell_size_result))),
        "vox_foreign_grid_count": (vox_result, (POINTER(vox_foreign_grid), c_double, POINTER(vox_foreign_counts))),
        "vox_foreign_grid_fit": (vox_result, (POINTER(vox_foreign_grid), c_void_p, c_uint64,
            POINTER(vox_cell_size_result))),
        "vox_foreign_grid_tune": (vox_result, (POINTER(vox_foreign_grid), POINTER(vox_tune_desc), vox_foreign_run,
            c_void_p, POINTER(vox_cell_size_result))),
    },
    "vox_surface": {
        "vox_surface_create": (vox_result, (POINTER(vox_surface_desc), POINTER(c_void_p))),
        "vox_surface_destroy": (None, (c_void_p,)),
        "vox_surface_get_features": (vox_result, (c_void_p, c_int32, POINTER(vox_feature_view))),
        "vox_surface_move": (vox_result, (c_void_p, POINTER(vox_motion))),
        "vox_surface_find_pairs": (vox_result, (c_void_p, c_int32, c_int32, c_uint64, c_uint64,
            POINTER(vox_partner_lists))),
        "vox_surface_find_crossings": (vox_result, (c_void_p, POINTER(vox_crossing_view))),
        "vox_surface_find_proximities": (vox_result, (c_void_p, c_int32, c_int32, c_double,
            POINTER(vox_proximity_view))),
        "vox_surface_find_clearances": (vox_result, (c_void_p, c_double, c_void_p)),
        "vox_surface_find_safe_step": (vox_result, (c_void_p, POINTER(vox_impact_desc), POINTER(vox_safe_step))),
        "vox_surface_find_impacts": (vox_result, (c_void_p, c_int32, c_int32, POINTER(vox_impact_desc),
            POINTER(vox_impact_view))),
        "vox_surface_set_cell_size": (vox_result, (c_void_p, c_double)),
        "vox_surface_suggest_cell_size": (vox_result, (c_void_p, c_int32, c_int32, POINTER(vox_cell_size_result))),
        "vox_surface_get_counters": (vox_result, (c_void_p, POINTER(vox_counter_view))),
    },
    "vox_io": {
        "vox_io_load": (vox_result, (c_char_p, POINTER(vox_io_load_desc), POINTER(c_void_p))),
        "vox_io_read": (vox_result, (c_void_p, c_size_t, POINTER(vox_io_load_desc), POINTER(c_void_p))),
        "vox_io_mesh_destroy": (None, (c_void_p,)),
        "vox_io_mesh_get_arrays": (vox_result, (c_void_p, POINTER(vox_io_mesh_view))),
        "vox_io_mesh_describe": (vox_result, (c_void_p, POINTER(vox_mesh_desc))),
        "vox_io_mesh_create": (vox_result, (POINTER(vox_io_mesh_view), POINTER(c_void_p))),
        "vox_io_mesh_get_report": (vox_result, (c_void_p, POINTER(vox_io_report))),
        "vox_io_mesh_get_warnings": (c_char_p, (c_void_p,)),
        "vox_io_format_string": (c_char_p, (c_int32,)),
        "vox_io_tetrahedralize": (vox_result, (c_void_p, POINTER(vox_io_tetrahedralize_desc), POINTER(c_void_p))),
        "vox_io_mesh_measure": (vox_result, (c_void_p, c_void_p, POINTER(vox_io_quality))),
        "vox_io_write": (vox_result, (c_void_p, c_char_p, POINTER(vox_io_write_desc))),
        "vox_io_write_to": (vox_result, (c_void_p, POINTER(vox_io_write_desc), POINTER(vox_io_sink))),
        "vox_io_make_lattice_ball": (vox_result, (c_uint64, c_double, POINTER(c_void_p))),
        "vox_io_make_ball": (vox_result, (c_double, c_double, POINTER(c_void_p))),
        "vox_io_make_torus": (vox_result, (c_double, c_double, c_double, POINTER(c_void_p))),
        "vox_io_make_capsule": (vox_result, (c_double, c_double, c_double, POINTER(c_void_p))),
        "vox_io_make_cylinder": (vox_result, (c_double, c_double, c_double, POINTER(c_void_p))),
        "vox_io_make_box": (vox_result, (c_double, c_double, c_double, c_double, POINTER(c_void_p))),
    },
    "vox_sim": {
        "vox_sim_create": (vox_result, (POINTER(vox_sim_desc), POINTER(c_void_p))),
        "vox_sim_destroy": (None, (c_void_p,)),
        "vox_sim_get_grid": (vox_result, (c_void_p, POINTER(c_void_p))),
        "vox_sim_step": (vox_result, (c_void_p, c_double)),
        "vox_sim_body_insert": (vox_result, (c_void_p, POINTER(vox_sim_body_desc), POINTER(c_uint32))),
        "vox_sim_body_remove": (vox_result, (c_void_p, c_uint32)),
        "vox_sim_body_get_view": (vox_result, (c_void_p, c_uint32, POINTER(vox_sim_body_view))),
        "vox_sim_body_set_state": (vox_result, (c_void_p, c_uint32, c_void_p, c_void_p)),
        "vox_sim_get_energy": (vox_result, (c_void_p, c_uint32, POINTER(vox_sim_energy))),
        "vox_sim_get_counters": (vox_result, (c_void_p, POINTER(vox_counter_view))),
        "vox_resolve": (vox_result, (POINTER(vox_resolve_desc), c_void_p, c_uint64, POINTER(vox_resolve_report))),
    },
}


def declare(library: Any, name: str, check: Any = None) -> None:
    """Gives the functions of the header `name` (vox, vox_query, vox_cell_size, vox_surface, vox_io, vox_sim) in a ctypes library their types. `check` becomes the errcheck
    of those whose result is a vox_result: a failure unless it is 0."""
    for function, (result, parameters) in FUNCTIONS[name].items():
        found = getattr(library, function)
        found.restype, found.argtypes = result, parameters
        if result is vox_result:
            found.restype = c_int32  # so that ctypes gives a plain number
            if check:
                found.errcheck = check
