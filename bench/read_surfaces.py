#!/usr/bin/env python3
"""Times reading large surfaces: the readers of vox_io beside assimp, through the same library, on the same files in turns.

    bench/read_surfaces.py [--build build/release] [--rows 560] [--repeat 5]

The surface is a torus of 2 * rows * rows vertices and twice as many triangles. "s" is the processor time of vox_io_load,
the diagnosis of the mesh included, the best of the repeats. The library must be built with VOX_IO_ASSIMP.
"""
import argparse
import ctypes
import json
import math
import os
import struct
import tempfile
import time

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--build", default="build/release", help="build folder with src/io/libvox_io.so")
parser.add_argument("--rows", type=int, default=560)
parser.add_argument("--repeat", type=int, default=5)
options = parser.parse_args()

AUTO, ASSIMP = 0, 8  # VOX_IO_FORMAT_*
ALL_MESHES = 0xffffffff


class LoadDesc(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("format", ctypes.c_int), ("mesh_index", ctypes.c_uint32),
                ("reserved", ctypes.c_uint32)]


def torus(rows):
    points, triangles = [], []
    for i in range(2 * rows):
        for j in range(rows):
            u, v = math.pi * i / rows, 2 * math.pi * j / rows
            p = ((3 + math.cos(v)) * math.cos(u), (3 + math.cos(v)) * math.sin(u), math.sin(v))
            points.append(struct.unpack("3f", struct.pack("3f", *p)))
            a, b = i * rows + j, (i + 1) % (2 * rows) * rows + j
            c, d = b - j + (j + 1) % rows, a - j + (j + 1) % rows
            triangles += [(a, b, c), (a, c, d)]
    return points, triangles


def write_files(folder):
    points, triangles = torus(options.rows)

    def write(name, *pieces):
        with open(os.path.join(folder, name), "wb") as file:
            for piece in pieces:
                file.write(piece)

    def lines(pattern, rows):
        return "".join(pattern % row for row in rows).encode()

    head = ("ply\nformat %s 1.0\nelement vertex " + str(len(points)) + "\nproperty float x\nproperty float y\nproperty "
            "float z\nelement face " + str(len(triangles)) + "\nproperty list uchar int vertex_indices\nend_header\n")
    flat = b"".join(struct.pack("<3f", *p) for p in points)
    corners = b"".join(struct.pack("<3I", *t) for t in triangles)
    write("torus.obj", lines("v %.7g %.7g %.7g\n", points), lines("f %d %d %d\n", ((a + 1, b + 1, c + 1) for a, b, c in triangles)))
    write("text.ply", (head % "ascii").encode(), lines("%.7g %.7g %.7g\n", points), lines("3 %d %d %d\n", triangles))
    write("binary.ply", (head % "binary_little_endian").encode(), flat,
          b"".join(struct.pack("<B3i", 3, *t) for t in triangles))
    write("binary.stl", bytes(80), struct.pack("<I", len(triangles)),
          b"".join(struct.pack("<12fH", 0, 0, 0, *points[a], *points[b], *points[c], 0) for a, b, c in triangles))
    facet = "facet normal 0 0 0\nouter loop\n" + 3 * "vertex %e %e %e\n" + "endloop\nendfacet\n"
    write("text.stl", b"solid torus\n", lines(facet, ((*points[a], *points[b], *points[c]) for a, b, c in triangles)),
          b"endsolid torus\n")
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(flat)},
                        {"buffer": 0, "byteOffset": len(flat), "byteLength": len(corners)}],
        "buffers": [{"byteLength": len(flat) + len(corners)}]}).encode()
    text += b" " * (-len(text) % 4)
    write("torus.glb", struct.pack("<4s3I4s", b"glTF", 2, 28 + len(text) + len(flat) + len(corners), len(text), b"JSON"),
          text, struct.pack("<I4s", len(flat) + len(corners), b"BIN\0"), flat, corners)


def seconds(lib, path, format):
    desc = LoadDesc(ctypes.sizeof(LoadDesc), format, ALL_MESHES, 0)
    mesh = ctypes.c_void_p()
    start = time.process_time()
    result = lib.vox_io_load(path.encode(), ctypes.byref(desc), ctypes.byref(mesh))
    taken = time.process_time() - start
    if result != 0:
        raise SystemExit(lib.vox_last_error().decode())
    lib.vox_io_mesh_destroy(mesh)
    return taken


lib = ctypes.CDLL(os.path.join(options.build, "src/io/libvox_io.so"))
lib.vox_last_error.restype = ctypes.c_char_p
with tempfile.TemporaryDirectory() as folder:
    write_files(folder)
    for name in "binary.stl", "text.stl", "torus.obj", "binary.ply", "text.ply", "torus.glb":
        path = os.path.join(folder, name)
        rounds = [[seconds(lib, path, format) for format in (AUTO, ASSIMP)] for _ in range(options.repeat)]
        vox, assimp = (min(times) for times in zip(*rounds))
        size = os.path.getsize(path) / 1e6
        print("%-11s %6.1f MB   vox %.3f s %6.1f MB/s   assimp %.3f s %6.1f MB/s   %.2f times" %
              (name, size, vox, size / vox, assimp, size / assimp, assimp / vox))
