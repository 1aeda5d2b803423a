"""vox_foreign_grid_suggest, _count, _fit and _tune by ctypes. The structs are those of include/vox/vox_cell_size.h.
Nothing but Python is needed, so that the test of the plain grids runs without numpy, which voxtet needs."""

from __future__ import annotations

import ctypes
from ctypes import (CFUNCTYPE, POINTER, Structure, byref, c_char, c_char_p, c_double, c_int, c_uint32, c_uint64, c_void_p,
                    sizeof)

from losses import COUNTS, WEIGHTS

CURVE, TERMS, RULES, TIMINGS, NOTE = 64, 12, 8, 32, 256  # capacities
DOUBLE = 1  # vox_format
OCCUPIED, DENSE = 1, 2  # vox_cells_kept


class Positions(Structure):
    _fields_ = [("data", c_void_p), ("count", c_uint64), ("format", c_int), ("reserved", c_uint32),
                ("byte_stride", c_uint64), ("component_byte_stride", c_uint64)]


class Primitives(Structure):
    _fields_ = [("struct_size", c_uint32), ("type", c_int), ("positions", Positions), ("indices", c_void_p),
                ("index_byte_stride", c_uint64), ("count", c_uint64), ("radii", c_void_p),
                ("radius_byte_stride", c_uint64), ("radius_format", c_int), ("reserved", c_uint32), ("radius", c_double)]


class Counts(Structure):
    _fields_ = [(name, c_double) for name in COUNTS]


class Weights(Structure):
    _fields_ = [(name, c_double) for name in WEIGHTS]


class Grid(Structure):
    _fields_ = [("struct_size", c_uint32), ("known", c_int), ("cells_stored", c_int), ("cells_queried", c_int),
                ("cells_kept", c_int), ("reserved", c_uint32), ("stored", POINTER(Primitives)), ("querying", POINTER(Primitives)),
                ("radius", c_double), ("min_cell_size", c_double), ("zone_loss", c_double), ("weights", Weights),
                ("allocator", c_void_p)]


class Sample(Structure):
    _fields_ = [("cell_size", c_double), ("cost", c_double)]


class Term(Structure):
    _fields_ = [("name", c_char_p), ("count", c_double), ("cost", c_double)]


class Rule(Structure):
    _fields_ = [("name", c_char_p), ("cell_size", c_double), ("cost", c_double)]


class Timing(Structure):
    _fields_ = [("cell_size", c_double), ("seconds", c_double)]


class Result(Structure):
    _fields_ = [("struct_size", c_uint32), ("warnings", c_uint32),
                *((name, c_double) for name in ("cell_size", "zone_min", "zone_max", "cost", "min_cell_size", "cells_per_axis",
                                                "fit_error", "expected_loss")),
                *((name, c_uint32) for name in ("curve_count", "term_count", "rule_count", "timing_count")),
                ("curve", Sample * CURVE), ("terms", Term * TERMS), ("rules", Rule * RULES), ("timings", Timing * TIMINGS),
                ("weights", Weights), ("note", c_char * NOTE)]


class TuneDesc(Structure):
    _fields_ = [("struct_size", c_uint32), ("max_runs", c_uint32), ("min", c_double), ("max", c_double),
                ("first", c_double), ("wanted_loss", c_double)]


Run = CFUNCTYPE(c_double, c_double, c_void_p)


class Failed(Exception):
    pass


def address(array):
    """Of the values of an array of numpy or of the standard library's array module."""
    return array.ctypes.data if hasattr(array, "ctypes") else array.buffer_info()[0]


class Described:
    """A vox_foreign_grid, with the arrays that it points to."""

    def __init__(self, vox, stored, querying, cells_stored=0, cells_queried=0, cells_kept=0):
        """stored, querying: {type, count, vertex_count, positions, indices, radii}, querying None for the same set; cells_stored,
        cells_queried and cells_kept 0: the library's defaults."""
        self.vox, self.kept = vox, (stored, querying)
        self.grid = Grid(struct_size=sizeof(Grid), cells_stored=cells_stored, cells_queried=cells_queried, cells_kept=cells_kept)
        self.stored = self.primitives(stored)
        self.grid.stored = ctypes.pointer(self.stored)
        if querying is not None:
            self.querying = self.primitives(querying)
            self.grid.querying = ctypes.pointer(self.querying)

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

    def call(self, name, *arguments):
        found = Result(struct_size=sizeof(Result))
        self.vox.call("vox_foreign_grid_" + name, self.grid, *arguments, found)
        return found

    def suggest(self):
        return self.call("suggest")

    def count(self, size):
        found = Counts()
        self.vox.call("vox_foreign_grid_count", self.grid, c_double(size), found)
        return {name: getattr(found, name) for name in COUNTS}

    def fit(self, timings):
        return self.call("fit", (Timing * len(timings))(*timings), c_uint64(len(timings)))

    def tune(self, run):
        """run(size) returns seconds."""
        callback = Run(lambda size, _: run(size))
        return self.call("tune", TuneDesc(struct_size=sizeof(TuneDesc)), callback, c_void_p())


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
