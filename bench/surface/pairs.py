#!/usr/bin/env python3
"""Pairs of surface features, vox beside IPC Toolkit's LBVH (ipctk, one thread each), on the frames of
Sample-Scalable-CCD-Data (https://github.com/Continuous-Collision-Detection/Sample-Scalable-CCD-Data), interleaved in one
run. Checks that both find the same numbers of pairs, and that every pair that truly collides by that data is found, also
with VOX_MOTION_CULL.

usage: pairs.py LIBVOX FOLDER [--rounds N] [--radius R] [--scene NAME] [--sweep] [--json FILE] [--docs]
--docs writes the table of docs/evidence/surface-pairs.md.
FOLDER holds the data's folders (armadillo-rollers, cloth-ball, ...), of which frames/, boxes/ and mma_bool/ are read."""

import argparse
import ctypes
import glob
import json
import os
import re
import time

import numpy as np

VERTEX, EDGE, FACE = 0, 1, 2
SCENES = ["armadillo-rollers", "cloth-ball", "cloth-funnel", "n-body-simulation", "rod-twist"]


class Desc(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("worker_count", ctypes.c_uint32)] + [
        (name, ctypes.c_uint64) for name in ("vertex_count", "edge_count", "face_count")] + [
        (name, ctypes.c_void_p) for name in ("edges", "faces", "patches", "categories", "masks")] + [
        ("patch_count", ctypes.c_uint64), ("cell_size", ctypes.c_double), ("byte_budget", ctypes.c_uint64),
        ("allocator", ctypes.c_void_p), ("tasks", ctypes.c_void_p)]


class Positions(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("count", ctypes.c_uint64), ("format", ctypes.c_int32), ("reserved", ctypes.c_uint32),
                ("byte_stride", ctypes.c_uint64), ("component_byte_stride", ctypes.c_uint64)]


class Motion(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("flags", ctypes.c_uint32), ("start", Positions), ("end", Positions),
                ("radius", ctypes.c_double)]


class Lists(ctypes.Structure):
    _fields_ = [("offsets", ctypes.POINTER(ctypes.c_uint64)), ("partners", ctypes.POINTER(ctypes.c_uint32)), ("first", ctypes.c_uint64),
                ("count", ctypes.c_uint64)]

    @property
    def pair_count(self):
        return self.offsets[self.count]


class View(ctypes.Structure):
    """Any list."""
    _fields_ = [("data", ctypes.c_void_p), ("count", ctypes.c_uint64)]


class Counter(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("value", ctypes.c_uint64)]


class Suggestion(ctypes.Structure):
    """Its first fields."""
    _fields_ = [("struct_size", ctypes.c_uint32), ("warnings", ctypes.c_uint32), ("cell_size", ctypes.c_double)]


class Surface:
    def __init__(self, vox, vertices, edges, faces):
        self.vox, self.handle = vox, ctypes.c_void_p()
        desc = Desc(struct_size=ctypes.sizeof(Desc))
        desc.vertex_count, desc.edge_count, desc.face_count = len(vertices), len(edges), len(faces)
        desc.edges, desc.faces = edges.ctypes.data, faces.ctypes.data
        self.ok(vox.vox_surface_create(ctypes.byref(desc), ctypes.byref(self.handle)))

    def ok(self, result):
        if result != 0:
            raise RuntimeError(self.vox.vox_last_error().decode())

    def move(self, start, end, radius, cull):
        """Columns, as Eigen has them."""
        at = [Positions(a.ctypes.data, len(a), 1, 0, 8, 8 * len(a)) for a in (start, end)]
        motion = Motion(ctypes.sizeof(Motion), int(cull), *at, radius)
        self.ok(self.vox.vox_surface_move(self.handle, ctypes.byref(motion)))

    def pairs(self, a, b):
        lists = Lists()
        self.ok(self.vox.vox_surface_find_pairs(self.handle, a, b, 0, ctypes.c_uint64(2**63), ctypes.byref(lists)))
        return lists

    def arrays(self, a, b):
        lists = self.pairs(a, b)
        offsets = np.ctypeslib.as_array(lists.offsets, (lists.count + 1,))
        if lists.pair_count == 0:
            return offsets.copy(), np.zeros(0, np.uint32)
        return offsets.copy(), np.ctypeslib.as_array(lists.partners, (lists.pair_count,)).copy()

    def counters(self):
        view = View()
        self.ok(self.vox.vox_surface_get_counters(self.handle, ctypes.byref(view)))
        return {c.name.decode(): c.value for c in (Counter * view.count).from_address(view.data)}

    def suggest_cell_size(self, a, b):
        out = Suggestion(ctypes.sizeof(Suggestion))
        self.ok(self.vox.vox_surface_suggest_cell_size(self.handle, a, b, ctypes.byref(out)))
        return out.cell_size


def read_ply(path):
    with open(path, "rb") as file:
        data = file.read()
    header, body = data.split(b"end_header\n", 1)
    order = "<" if b"little" in header else ">"
    kind = "f8" if b"property double" in header else "f4"
    lines = [line.split() for line in header.decode().splitlines()]
    vertices = next(int(line[2]) for line in lines if line[:2] == ["element", "vertex"])
    faces = next(int(line[2]) for line in lines if line[:2] == ["element", "face"])
    if b"format ascii" in header:
        rows = body.decode().splitlines()
        return (np.array([row.split()[:3] for row in rows[:vertices]], float),
                np.array([row.split()[1:4] for row in rows[vertices:vertices + faces]], np.uint32))
    colours = header.count(b"property uchar ")
    row = np.dtype([("at", order + kind, 3), ("colour", "u1", colours)])
    points = np.frombuffer(body, row, vertices)["at"].astype(float)
    record = np.dtype([("n", "u1"), ("v", order + "i4", 3)])
    return points, np.frombuffer(body, record, faces, vertices * row.itemsize)["v"].astype(np.uint32)


def edges_of(faces):
    """Of each edge the lower vertex first; ascending by the higher one, then by the lower, as the data numbers them."""
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.ascontiguousarray(np.unique(sides[:, ::-1], axis=0)[:, ::-1]).astype(np.uint32)


def keys(offsets, partners, count):
    return np.repeat(np.arange(len(offsets) - 1, dtype=np.int64), np.diff(offsets.astype(np.int64))) * count + partners


def truth(folder, kind, first_a, first_b, count_b):
    """Pairs that collide, as keys."""
    (boxes,), (answers,) = (glob.glob(f"{folder}/{where}/*{kind}{end}.json")
                            for where, end in (("boxes", ""), ("mma_bool", "_mma_bool")))
    with open(boxes, encoding="ascii") as file:
        pairs = np.array(json.load(file), np.int64)
    with open(answers, encoding="ascii") as file:
        pairs = pairs[np.array(json.load(file), bool)]
    pairs.sort(axis=1)
    if kind == "ee":
        return (pairs[:, 0] - first_a) * count_b + pairs[:, 1] - first_b
    return (pairs[:, 1] - first_a) * count_b + pairs[:, 0] - first_b # faces are numbered above vertices


def least(times):
    return min(times) * 1e3


def run_scene(vox, folder, name, options, ipctk):
    folder = os.path.join(folder, name)
    start, end = sorted(glob.glob(folder + "/frames/*.ply"))
    (v0, faces), (v1, _) = read_ply(start), read_ply(end)
    edges = edges_of(faces)
    v0, v1 = np.asfortranarray(v0), np.asfortranarray(v1)
    diagonal = float(np.linalg.norm(v0.max(0) - v0.min(0)))
    radius = options.radius * diagonal
    surface = Surface(vox, v0, edges, np.ascontiguousarray(faces))

    mesh = ipctk.CollisionMesh(v0, np.asfortranarray(edges.astype(np.int32)), np.asfortranarray(faces.astype(np.int32)))
    ipctk.set_num_threads(1)
    candidates, broad = ipctk.Candidates(), ipctk.LBVH()
    times = {"lbvh": [], "vox": [], "move": [], "ee": [], "fv": [], "cull": [], "write": []}
    for _ in range(options.rounds):
        begin = time.perf_counter()
        candidates.build(mesh, v0, v1, radius, broad)
        times["lbvh"].append(time.perf_counter() - begin)
        for cull in (False, True):
            begin = time.perf_counter()
            surface.move(v0, v1, radius, cull)
            moved = time.perf_counter()
            ee = surface.pairs(EDGE, EDGE).pair_count
            edged = time.perf_counter()
            fv = surface.pairs(FACE, VERTEX).pair_count
            done = time.perf_counter()
            times["cull" if cull else "vox"].append(done - begin)
            if not cull:
                times["move"].append(moved - begin)
                times["ee"].append(edged - moved)
                times["fv"].append(done - edged)
                total = ee + fv
        # What writing the output takes: one copy of the partners into memory that is in use.
        source = np.zeros(total, np.uint32)
        target = np.ones_like(source)
        begin = time.perf_counter()
        np.copyto(target, source)
        times["write"].append(time.perf_counter() - begin)
    row = {"scene": name, "vertices": len(v0), "faces": len(faces), "pairs": total, "lbvh pairs": len(candidates),
           "radius": radius, **{key + " ms": least(values) for key, values in times.items()}}
    sweep = ipctk.Candidates()
    sweep.build(mesh, v0, v1, radius, ipctk.SweepAndPrune())
    row["sweep pairs"] = len(sweep)
    row["ratio"] = row["lbvh ms"] / row["vox ms"]

    for cull in (False, True):
        surface.move(v0, v1, radius, cull)
        false_pairs = kept_false = 0
        for kind, a, b, first_a, first_b, count_b in (
                ("ee", EDGE, EDGE, len(v0), len(v0), len(edges)), ("vf", FACE, VERTEX, len(v0) + len(edges), 0, len(v0))):
            found = keys(*surface.arrays(a, b), count_b)
            true = truth(folder, kind, first_a, first_b, count_b)
            missing = np.setdiff1d(true, found)
            row[f"{kind} true"] = len(true)
            row[f"{kind} lost" + (" by culling" if cull else "")] = len(missing)
            false_pairs += surface.counters()["overlaps"] - len(true)
            kept_false += len(found) - len(true)
        if cull:
            row["false pairs culled"] = 1 - kept_false / max(false_pairs, 1)
            row["cull ns a pair"] = (row["cull ms"] - row["vox ms"]) * 1e6 / max(total, 1)
    features = len(v0) + len(edges) + len(faces)
    surface = Surface(vox, v0, edges, np.ascontiguousarray(faces))
    empty = surface.counters()["bytes"]
    surface.move(v0, v1, radius, True)
    surface.pairs(FACE, VERTEX)
    surface.pairs(EDGE, VERTEX)
    lists = surface.pairs(EDGE, EDGE) # the longest lists, last: their room is kept
    held = surface.counters()["bytes"]
    row["bytes a feature"] = (held - 24 * 2 * len(v0) - 8 * len(edges) - 12 * len(faces) -
                              8 * lists.count - 4 * lists.pair_count) / features
    row["bytes held"] = held
    row["bytes empty"] = empty
    if options.sweep:
        row["cell sizes"] = []
        surface.move(v0, v1, radius, False)
        suggested = surface.suggest_cell_size(EDGE, EDGE)
        sizes = [0.0] + [suggested * 2 ** (k / 3) for k in range(-9, 10)]
        best = {size: [] for size in sizes}
        for _ in range(options.rounds):
            for size in sizes:
                surface.ok(vox.vox_surface_set_cell_size(surface.handle, ctypes.c_double(size)))
                begin = time.perf_counter()
                surface.pairs(EDGE, EDGE)
                best[size].append(time.perf_counter() - begin)
        row["cell sizes"] = [(size / suggested, least(values)) for size, values in best.items()]
        times_of = [ms for _, ms in row["cell sizes"]]
        row["cell size loss"] = times_of[0] / min(times_of) - 1
    return row


def write_docs(rows):
    page = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "evidence", "surface-pairs.md")
    lines = ["| scene | faces | pairs | LBVH ms | vox ms | ratio | copying the pairs ms | with culling ms | a pair ns | false pairs culled | "
             "true pairs lost | bytes a feature |", "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        lost = sum(row[kind + " lost" + how] for kind in ("ee", "vf") for how in ("", " by culling"))
        lines.append(f"| {row['scene']} | {row['faces']} | {row['pairs']} | {row['lbvh ms']:.1f} | {row['vox ms']:.1f} | "
                     f"{row['ratio']:.1f} | {row['write ms']:.2f} | {row['cull ms']:.1f} | {row['cull ns a pair']:.0f} | "
                     f"{100 * row['false pairs culled']:.1f} % | {lost} | {row['bytes a feature']:.0f} |")
    with open(page, encoding="utf-8") as file:
        text = file.read()
    mark = "<!-- bench/surface -->", "<!-- /bench/surface -->"
    text = re.sub(f"{mark[0]}.*?{mark[1]}", lambda _: "\n".join([mark[0], *lines, mark[1]]), text, flags=re.S)
    with open(page, "w", encoding="utf-8") as file:
        file.write(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("library")
    parser.add_argument("folder")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--radius", type=float, default=1e-4, help="in diagonals of the scene's box")
    parser.add_argument("--scene", choices=SCENES, action="append")
    parser.add_argument("--sweep", action="store_true", help="cell sizes, too")
    parser.add_argument("--json")
    parser.add_argument("--docs", action="store_true")
    options = parser.parse_args()
    import ipctk # after the arguments: it takes a while

    vox = ctypes.CDLL(options.library)
    vox.vox_last_error.restype = ctypes.c_char_p
    rows = []
    for name in options.scene or SCENES:
        row = run_scene(vox, options.folder, name, options, ipctk)
        rows.append(row)
        print(json.dumps(row, indent=1), flush=True)
    ratios = sorted(row["ratio"] for row in rows)
    print(f"LBVH over vox: least {ratios[0]:.1f}, median {ratios[len(ratios) // 2]:.1f}")
    if options.docs:
        write_docs(rows)
    if options.json:
        with open(options.json, "w", encoding="ascii") as file:
            json.dump(rows, file, indent=1)
    wrong = [row["scene"] for row in rows if row["pairs"] != row["sweep pairs"] or row["ee lost"] or row["vf lost"] or
             row["ee lost by culling"] or row["vf lost by culling"]]
    if wrong:
        raise SystemExit("wrong: " + ", ".join(wrong))


if __name__ == "__main__":
    main()
