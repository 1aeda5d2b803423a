#!/usr/bin/env python3
"""The part of a motion that is free of contact: candidates and narrow phase, vox beside IPC Toolkit (ipctk: LBVH and its default
narrow phase, Tight-Inclusion), one thread each, on the frames of Sample-Scalable-CCD-Data, interleaved in one run. ipctk stops at a
fifth of the first distance, vox at a tenth, so its steps are greater. Checks that vox reports every pair that truly collides.

usage: safe_step.py LIBVOX FOLDER [--rounds N] [--scene NAME]"""

import argparse
import ctypes
import glob
import os
import time

import numpy as np

import pairs


class SafeStep(ctypes.Structure):
    _fields_ = [("step", ctypes.c_double), ("pairs", ctypes.c_uint64), ("kind_a", ctypes.c_int32), ("kind_b", ctypes.c_int32),
                ("a", ctypes.c_uint32), ("b", ctypes.c_uint32), ("unfinished", ctypes.c_uint32), ("reserved", ctypes.c_uint32)]


def timed(surface, a, b):
    view = pairs.View()
    surface.ok(surface.vox.vox_surface_find_impacts(surface.handle, a, b, None, ctypes.byref(view)))
    record = np.dtype([("a", "u4"), ("b", "u4"), ("time", "f8")])
    if view.count == 0:
        return np.zeros(0, record)
    bytes_of = ctypes.cast(view.data, ctypes.POINTER(ctypes.c_uint8 * (view.count * record.itemsize)))
    return np.frombuffer(bytes(bytes_of.contents), record)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("library")
    parser.add_argument("folder")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--scene", choices=pairs.SCENES, action="append")
    options = parser.parse_args()
    import ipctk

    vox = ctypes.CDLL(options.library)
    vox.vox_last_error.restype = ctypes.c_char_p
    ipctk.set_num_threads(1)
    print("| scene | ipctk ms | vox ms | ratio | ipctk's step | vox's | pairs examined | true pairs lost |\n|---|---|---|---|---|---|---|---|")
    for name in options.scene or pairs.SCENES:
        folder = os.path.join(options.folder, name)
        (v0, faces), (v1, _) = (pairs.read_ply(path) for path in sorted(glob.glob(folder + "/frames/*.ply")))
        edges = pairs.edges_of(faces)
        v0, v1 = np.asfortranarray(v0), np.asfortranarray(v1)
        surface = pairs.Surface(vox, v0, edges, np.ascontiguousarray(faces))
        mesh = ipctk.CollisionMesh(v0, np.asfortranarray(edges.astype(np.int32)),
                                   np.asfortranarray(faces.astype(np.int32)))
        candidates, broad = ipctk.Candidates(), ipctk.LBVH()
        best = {"ipctk": [], "vox": []}
        for _ in range(options.rounds):
            begin = time.perf_counter()
            candidates.build(mesh, v0, v1, 0, broad)
            their_step = candidates.compute_collision_free_stepsize(mesh, v0, v1)
            best["ipctk"].append(time.perf_counter() - begin)
            begin = time.perf_counter()
            surface.move(v0, v1, 0, True)
            out = SafeStep()
            surface.ok(vox.vox_surface_find_safe_step(surface.handle, None, ctypes.byref(out)))
            best["vox"].append(time.perf_counter() - begin)
        lost = 0
        for kind, a, b, first_a, first_b, count_b in (
                ("ee", pairs.EDGE, pairs.EDGE, len(v0), len(v0), len(edges)),
                ("vf", pairs.FACE, pairs.VERTEX, len(v0) + len(edges), 0, len(v0))):
            found = timed(surface, a, b)
            lost += len(np.setdiff1d(pairs.truth(folder, kind, first_a, first_b, count_b),
                                     found["a"].astype(np.int64) * count_b + found["b"]))
        theirs, ours = pairs.least(best["ipctk"]), pairs.least(best["vox"])
        print(f"| {name} | {theirs:.0f} | {ours:.0f} | {theirs / ours:.1f} | {their_step:.6g} | {out.step:.6g} | {out.pairs} | {lost} |",
              flush=True)
        if lost:
            raise SystemExit("true pairs are lost")


if __name__ == "__main__":
    main()
