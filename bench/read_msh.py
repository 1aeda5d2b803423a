#!/usr/bin/env python3
"""Times reading a large ASCII .msh: vox against Gmsh's own reader and meshio, on the same file in the same run.

    bench/read_msh.py [--build build/release] [--megabytes 100] [--repeat 3] [--version 2.2]

The file is a ball of tets made and written by vox. Each reader runs in a process of its own, so that its peak memory
can be told; "time" is the reading alone, with vox's diagnosis of the mesh (for Gmsh: the whole process less one that reads
an empty file), the best of the repeats. Readers that are not installed are left out.
"""
import argparse
import ctypes
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--build", default="build/release", help="build folder with src/io/libvox_io.so")
parser.add_argument("--megabytes", type=float, default=100)
parser.add_argument("--repeat", type=int, default=3)
parser.add_argument("--version", choices=["2.2", "4.1"], default="2.2", help="version of the .msh format")
parser.add_argument("--file", help="read this file instead of making one")
parser.add_argument("--one", choices=["vox", "meshio"], help=argparse.SUPPRESS)
options = parser.parse_args()


class View(ctypes.Structure):
    _fields_ = [("positions", ctypes.c_void_p), ("vertex_count", ctypes.c_uint64), ("tets", ctypes.c_void_p),
                ("tet_count", ctypes.c_uint64), ("triangles", ctypes.c_void_p), ("triangle_count", ctypes.c_uint64)]


class WriteDesc(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("format", ctypes.c_int), ("binary", ctypes.c_uint32),
                ("reserved", ctypes.c_uint32), ("point_data", ctypes.c_void_p), ("point_data_count", ctypes.c_uint64)]


def library():
    lib = ctypes.CDLL(os.path.join(options.build, "src/io/libvox_io.so"))
    lib.vox_last_error.restype = ctypes.c_char_p
    return lib


def check(lib, result):
    if result != 0:
        sys.exit(lib.vox_last_error().decode())


def make_file(path):
    lib = library()
    desc = WriteDesc(ctypes.sizeof(WriteDesc), 1 if options.version == "2.2" else 2, 0, 0, None, 0)
    tets = int(options.megabytes * 1e6 / 52)
    for attempt in range(3):  # the bytes a tet takes depend on the digits of its numbers
        mesh = ctypes.c_void_p()
        check(lib, lib.vox_io_make_lattice_ball(ctypes.c_uint64(tets), ctypes.c_double(1), ctypes.byref(mesh)))
        check(lib, lib.vox_io_write(mesh, path.encode(), ctypes.byref(desc)))
        lib.vox_io_mesh_destroy(mesh)
        ratio = options.megabytes * 1e6 / os.path.getsize(path)
        if abs(ratio - 1) < 0.01:
            return
        tets = int(tets * ratio)


def status(key):
    with open("/proc/self/status") as file:
        return int(re.search(key + r":\s+(\d+) kB", file.read()).group(1)) * 1024


def read_with_vox(path):
    lib = library()
    mesh, view = ctypes.c_void_p(), View()
    start = time.perf_counter()
    check(lib, lib.vox_io_load(path.encode(), None, ctypes.byref(mesh)))
    seconds = time.perf_counter() - start
    lib.vox_io_mesh_destroy(mesh)

    # A second time for the memory: what the process holds beside the mapped file, looked at every millisecond.
    before, samples, stop = status("RssAnon"), [0], threading.Event()

    def sample():
        while not stop.wait(0.001):
            samples.append(status("RssAnon"))

    watcher = threading.Thread(target=sample)
    watcher.start()
    check(lib, lib.vox_io_load(path.encode(), None, ctypes.byref(mesh)))
    stop.set()
    watcher.join()
    check(lib, lib.vox_io_mesh_get_arrays(mesh, ctypes.byref(view)))
    return {"seconds": seconds, "vertices": view.vertex_count, "tets": view.tet_count,
            "own": max(samples) - before, "result": 24 * view.vertex_count + 16 * view.tet_count}


def read_with_meshio(path):
    import contextlib
    import io
    import meshio
    start = time.perf_counter()
    with contextlib.redirect_stdout(io.StringIO()):
        mesh = meshio.read(path)
    seconds = time.perf_counter() - start
    return {"seconds": seconds, "vertices": len(mesh.points),
            "tets": sum(len(c.data) for c in mesh.cells if c.type == "tetra")}


if options.one:
    out = {"vox": read_with_vox, "meshio": read_with_meshio}[options.one](options.file)
    out["peak"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(json.dumps(out))
    sys.exit()


def run_self(python, reader, path):
    done = subprocess.run([python, os.path.abspath(__file__), "--build", options.build, "--file", path, "--one", reader],
                          capture_output=True, text=True)
    if done.returncode != 0:
        return None
    return json.loads(done.stdout.splitlines()[-1])


def run_gmsh(path):
    """Gmsh reads the file named on its command line."""
    with tempfile.TemporaryDirectory() as folder:
        empty = os.path.join(folder, "empty.geo")
        open(empty, "w").close()
        times = []
        for file in (empty, path):
            start = time.perf_counter()
            gmsh = subprocess.Popen(["gmsh", file, "-parse_and_exit", "-v", "4"], stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, text=True)
            text = gmsh.stdout.read()
            _, code, usage = os.wait4(gmsh.pid, 0)
            gmsh.returncode = code
            times.append(time.perf_counter() - start)
    nodes = re.search(r"(\d+) nodes", text)
    elements = re.search(r"(\d+) elements", text)
    if not nodes or not elements:
        return None
    return {"seconds": times[1] - times[0], "vertices": int(nodes.group(1)), "tets": int(elements.group(1)),
            "peak": usage.ru_maxrss * 1024}


def meshio_python():
    for python in (sys.executable, "/usr/bin/python3"):
        if os.path.exists(python) and subprocess.run([python, "-c", "import meshio"], capture_output=True).returncode == 0:
            return python
    return None


with tempfile.TemporaryDirectory() as folder:
    path = options.file or os.path.join(folder, "ball.msh")
    if not options.file:
        make_file(path)
    readers = {"vox": lambda: run_self(sys.executable, "vox", path)}
    if shutil.which("gmsh"):
        readers["gmsh"] = lambda: run_gmsh(path)
    python = meshio_python()
    if python:
        readers["meshio"] = lambda: run_self(python, "meshio", path)
    best = {}
    for _ in range(options.repeat):
        for name, read in readers.items():
            out = read()
            if out is None:
                sys.exit("%s cannot read %s" % (name, path))
            if name not in best or out["seconds"] < best[name]["seconds"]:
                best[name] = out
    size = os.path.getsize(path)
    result = best["vox"]["result"]
    print("%.1f MB, %d vertices, %d tets, .msh %s ASCII; the arrays read take %.1f MB" %
          (size / 1e6, best["vox"]["vertices"], best["vox"]["tets"], options.version, result / 1e6))
    print("vox holds %.1f MB at most while it reads, %.2f times that (the file is mapped, not copied)" %
          (best["vox"]["own"] / 1e6, best["vox"]["own"] / result))
    for name, out in best.items():
        if (out["vertices"], out["tets"]) != (best["vox"]["vertices"], best["vox"]["tets"]):
            sys.exit("%s reads %d vertices and %d tets" % (name, out["vertices"], out["tets"]))
        print("%-7s %6.2f s %8.1f MB/s %6.1fx vox, peak of the process %5.0f MB" %
              (name, out["seconds"], size / 1e6 / out["seconds"], out["seconds"] / best["vox"]["seconds"],
               out["peak"] / 1e6))
