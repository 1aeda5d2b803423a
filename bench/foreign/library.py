"""vox_suggest_for, vox_count_for, vox_cost_fit and vox_cost_tune by ctypes. The structs are those of include/vox/vox.h.
Nothing but Python is needed, so that the test of the plain grids runs without numpy, which voxtet needs."""

from __future__ import annotations

import ctypes
from ctypes import (CFUNCTYPE, POINTER, Structure, byref, c_char, c_char_p, c_double, c_int, c_uint32, c_uint64, c_void_p,
                    sizeof)

from losses import WEIGHTS, WORK

CURVE, TERMS, NOTE, RUNS = 64, 12, 256, 32
DOUBLE = 1
DENSE = 1


class Positions(Structure):
    _fields_ = [("data", c_void_p), ("count", c_uint64), ("format", c_int), ("reserved", c_uint32),
                ("byte_stride", c_uint64), ("component_byte_stride", c_uint64)]


class Primitives(Structure):
    _fields_ = [("struct_size", c_uint32), ("type", c_int), ("positions", Positions), ("indices", c_void_p),
                ("index_byte_stride", c_uint64), ("count", c_uint64), ("radii", c_void_p),
                ("radius_byte_stride", c_uint64), ("radius_format", c_int), ("reserved", c_uint32), ("radius", c_double)]


class Work(Structure):
    _fields_ = [(name, c_double) for name in WORK]


class Weights(Structure):
    _fields_ = [(name, c_double) for name in WEIGHTS]


class Grid(Structure):
    _fields_ = [("struct_size", c_uint32), ("flags", c_uint32), ("content", c_int), ("look", c_int),
                ("held", POINTER(Primitives)), ("asking", POINTER(Primitives)), ("radius", c_double),
                ("least_cell_size", c_double), ("zone_loss", c_double), ("known", c_int), ("reserved", c_uint32),
                ("weights", Weights), ("allocator", c_void_p)]


class Rules(Structure):
    _fields_ = [(name, c_double) for name in ("mean_edge", "mean_box_side", "median_box_side", "spacing", "radius")]


class Sample(Structure):
    _fields_ = [("cell_size", c_double), ("cost", c_double)]


class Share(Structure):
    _fields_ = [("name", c_char * 24), ("count", c_double), ("cost", c_double), ("share", c_double)]


class Suggestion(Structure):
    _fields_ = [("struct_size", c_uint32), ("warnings", c_uint32), ("cell_size", c_double), ("zone_min", c_double),
                ("zone_max", c_double), ("predicted_cost", c_double), ("least_cell_size", c_double), ("work", Work),
                ("weights", Weights), ("rules", Rules), ("rule_costs", Rules), ("curve", Sample * CURVE),
                ("curve_count", c_uint32), ("term_count", c_uint32), ("terms", Share * TERMS), ("rule", c_int),
                ("reserved", c_uint32), ("note", c_char * NOTE)]


class Timing(Structure):
    _fields_ = [("cell_size", c_double), ("seconds", c_double)]


class Fit(Structure):
    _fields_ = [("struct_size", c_uint32), ("warnings", c_uint32), ("weights", Weights), ("residual", c_double),
                ("cell_size", c_double), ("zone_min", c_double), ("zone_max", c_double), ("predicted_seconds", c_double),
                ("curve", Sample * CURVE), ("curve_count", c_uint32), ("reserved", c_uint32), ("note", c_char * NOTE)]


class TuneDesc(Structure):
    _fields_ = [("struct_size", c_uint32), ("most_runs", c_uint32), ("min", c_double), ("max", c_double),
                ("first", c_double), ("zone_loss", c_double), ("wanted_loss", c_double)]


class Tuning(Structure):
    _fields_ = [("struct_size", c_uint32), ("warnings", c_uint32), ("cell_size", c_double), ("zone_min", c_double),
                ("zone_max", c_double), ("seconds", c_double), ("expected_loss", c_double), ("noise", c_double),
                ("weights", Weights), ("runs", Timing * RUNS), ("run_count", c_uint32), ("curve_count", c_uint32),
                ("curve", Sample * CURVE), ("note", c_char * NOTE)]


Run = CFUNCTYPE(c_double, c_double, c_void_p)


class Failed(Exception):
    pass


def address(array):
    """Of the values of an array of numpy or of the standard library's array module."""
    return array.ctypes.data if hasattr(array, "ctypes") else array.buffer_info()[0]


class Described:
    """A vox_foreign_grid, with the arrays that it points to."""

    def __init__(self, vox, held, asking, content=None, look=None, dense=False):
        """held, asking: {type, count, vertex_count, positions, indices, radii}, asking None for the same set; content and
        look None: the library's defaults."""
        self.vox, self.kept = vox, (held, asking)
        self.grid = Grid(struct_size=sizeof(Grid))
        self.held = self.primitives(held)
        self.grid.held = ctypes.pointer(self.held)
        if asking is not None:
            self.asking = self.primitives(asking)
            self.grid.asking = ctypes.pointer(self.asking)
        if content is not None:
            self.grid.content, self.grid.look, self.grid.flags = content, look, DENSE if dense else 0

    def primitives(self, values):
        p = Primitives(struct_size=sizeof(Primitives))
        p.type, p.count = values["type"], values["count"]
        p.positions = Positions(data=address(values["positions"]), count=values["vertex_count"], format=DOUBLE)
        if values.get("indices") is not None:
            p.indices = address(values["indices"])
        if values.get("radii") is not None:
            p.radii, p.radius_format = address(values["radii"]), DOUBLE
        return p

    def weigh(self, known):
        """Takes the weights of a known grid; the description stays. Returns itself."""
        self.grid.known = known
        return self

    def suggest(self):
        found = Suggestion(struct_size=sizeof(Suggestion))
        self.vox.call("vox_suggest_for", self.grid, found)
        return found

    def count(self, size):
        found = Work()
        self.vox.call("vox_count_for", self.grid, c_double(size), found)
        return {name: getattr(found, name) for name in WORK}

    def fit(self, timings):
        found = Fit(struct_size=sizeof(Fit))
        given = (Timing * len(timings))(*timings)
        self.vox.call("vox_cost_fit", self.grid, given, c_uint64(len(timings)), found)
        return found

    def tune(self, run):
        """run(size) returns seconds."""
        described, found = TuneDesc(struct_size=sizeof(TuneDesc)), Tuning(struct_size=sizeof(Tuning))
        callback = Run(lambda size, _: run(size))
        self.vox.call("vox_cost_tune", self.grid, described, callback, c_void_p(), found)
        return found


class Vox:
    def __init__(self, path):
        self.library = ctypes.CDLL(path)
        self.library.vox_last_error.restype = c_char_p

    def call(self, name, *arguments):
        function = getattr(self.library, name)
        function.restype = c_int
        given = [byref(a) if isinstance(a, Structure) else a for a in arguments]
        result = function(*(c_uint32(a) if isinstance(a, int) else a for a in given))
        if result:
            raise Failed(f"{name}: {result}, {self.library.vox_last_error().decode()}")
