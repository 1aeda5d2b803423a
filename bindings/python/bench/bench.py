"""What Python costs over C, and point location beside VTK. Runs that are compared are interleaved, and the least times of many are
taken, so that a busy machine changes little; for point location, of the processor time.

usage: bench.py [calls] [locate] [warp] [scenes] [suggest]   (VOXTET_LIBRARY_DIR and PYTHONPATH as in ../check)
"""

import ctypes
import os
import sys
import time

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests"))
from support import box  # noqa: E402

import voxtet  # noqa: E402
from voxtet import _library  # noqa: E402


def least(functions, calls, rounds, clock=time.perf_counter_ns):
    """Least microseconds of a call of each."""
    best = [float("inf")] * len(functions)
    for _ in range(rounds):
        for i, function in enumerate(functions):
            began = clock()
            for _ in range(calls):
                function()
            best[i] = min(best[i], (clock() - began) / calls / 1000)
    return best


def calls():
    empty = voxtet.Grid()
    raw = ctypes.CDLL(_library.vox._name).vox_grid_step
    raw.argtypes = [ctypes.c_void_p]
    nothing, ctypes_alone, step = least([lambda: None, lambda: raw(empty._pointer), lambda: empty.step()], 50, 3000)
    inside = min(empty.counters["step_ns"] for _ in range(300) if not empty.step()) / 1000
    print(f"step of an empty grid: {step - nothing:.2f} us from Python, {ctypes_alone - nothing:.2f} by ctypes alone, "
          f"{inside:.2f} within the library")
    for cells in (2, 6, 12, 24):
        positions, tets = box(cells)
        grid = voxtet.Grid()
        grid.add(positions, tets)
        grid.add(positions + np.float32(0.31), tets)
        grid.step()
        count = len(grid.contacts)
        with grid.borrowed() as results:
            copied, borrowed, nothing = least([lambda: grid.contacts, lambda: results.contacts, lambda: None], 50, 1000)
        print(f"contacts, {count}: copied {copied - nothing:.2f} us, which is {(copied - borrowed) * 1000 / count:.2f} ns each "
              f"over borrowed {borrowed - nothing:.2f} us")


def scenes():
    """4096 scenes of two bodies of a thousand tetrahedra each, stepped from Python and in one call of C."""
    positions, tets = box(6)
    tets = tets[:1000]
    grids = []
    for i in range(4096):
        grid = voxtet.Grid()
        grid.add(positions, tets, borrow_tets=True)
        grid.add(positions + np.float32(0.5 + i % 7 * 0.01), tets, borrow_tets=True)
        grids.append(grid)
    pointers = (ctypes.c_void_p * len(grids))(*[grid._pointer for grid in grids])
    step = ctypes.CDLL(_library.vox._name).vox_grids_step
    step.argtypes = [ctypes.c_void_p, ctypes.c_uint64, ctypes.c_uint32, ctypes.c_void_p, ctypes.c_void_p]

    def moved():
        positions[0, 0] += np.float32(1e-6)

    def from_c():
        moved()
        step(pointers, len(grids), 1, None, None)

    def from_python():
        moved()
        voxtet.step_all(grids, 1)

    c, python = least([from_c, from_python], 1, 15)
    print(f"4096 scenes: {c / 1000:.1f} ms in C, {python / 1000:.1f} ms from Python: {100 * (python / c - 1):+.1f} %")


def locate():
    import pyvista
    import vtk
    positions, tets = box(20, dtype=np.float64)
    positions += np.random.default_rng(0).uniform(-.2, .2, positions.shape) / 20
    grid = pyvista.UnstructuredGrid({10: tets.astype(np.int64)}, positions)
    points = np.random.default_rng(1).uniform(0, 1, (20000, 3))
    locator = voxtet.Locator(positions, tets)
    cells = vtk.vtkStaticCellLocator()
    cells.SetDataSet(grid)
    cells.BuildLocator()
    few = points[:5000]

    def by_pyvista():
        return np.array([grid.find_containing_cell(p) for p in few])

    def by_vtk():
        return np.array([cells.FindCell(p) for p in few])

    def by_vtk_alone():
        """The loop in C++: a probe of the points with this locator."""
        probe = vtk.vtkProbeFilter()
        probe.SetCellLocator(cells)
        probe.SetInputData(pyvista.PolyData(points))
        probe.SetSourceData(grid)
        probe.Update()
        return probe

    ours, pv, static, probe = least([lambda: locator.locate(points), by_pyvista, by_vtk, by_vtk_alone], 1, 12,
                                    time.process_time_ns)
    ours, probe, pv, static = ours / len(points), probe / len(points), pv / len(few), static / len(few)
    print(f"locate, {len(tets)} tets: {ours:.3f} us a point; find_containing_cell in a loop {pv:.1f} ({pv / ours:.0f} times), "
          f"vtkStaticCellLocator.FindCell in a loop {static:.2f} ({static / ours:.1f} times), vtkProbeFilter with it {probe:.2f} "
          f"({probe / ours:.1f} times)")
    whole = least([lambda: voxtet.locate(points, positions, tets)], 1, 5, time.process_time_ns)[0] / len(points)
    print(f"with the preparation in each call: {whole:.3f} us a point")
    # Points on facets: a quarter, a quarter, a half of corners that are multiples of 1/8.
    positions, tets = box(8, dtype=np.float64)
    facets = tets[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3)
    points = np.einsum("fcx,c->fx", positions[facets], np.array([.25, .25, .5]))
    own = np.repeat(np.arange(len(tets)), 4)
    found = voxtet.locate(points, positions, tets).tet
    beside = (np.sort(tets[found][:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]], axis=2) ==
              np.sort(facets, axis=1)[:, None]).all(axis=2).any(axis=1)
    print(f"points on facets: {np.count_nonzero((found < 0) | ~beside | (found > own))} of {len(points)} wrong")


def suggest():
    """Of the library; Python adds less than 0.1 ms."""
    names = ("none", "sorted", "hashed", "ipc", "ipc_pairs", "vtk", "numpy", "pbat", "warp", "point_voxels")
    for count, rounds in ((20000, 30), (1000000, 8)):
        ball = voxtet.io.make_lattice_ball(count, 1)
        positions, tets = np.asarray(ball.positions, np.float32), np.asarray(ball.tets, np.uint32)
        of_tets, of_points = voxtet.Primitives(positions, tets), voxtet.Primitives(positions, radius=0.05)
        grids = [voxtet.ForeignGrid(of_points if name in names[-2:] else of_tets, known=name) for name in names]
        times = least([grid.suggest for grid in grids], 1, rounds)
        print(f"ForeignGrid.suggest, {len(tets)} tetrahedra, the last two their {len(positions)} vertices: "
              + ", ".join(f"{name} {us / 1000:.2f}" for name, us in zip(names, times)) + " ms")


def warp():
    """Points in tetrahedra beside Warp's BVH on the processor, which runs its kernels on one thread: in single precision,
    with the tetrahedron found last."""
    import warp as wp
    wp.config.quiet = True

    @wp.kernel
    def find(bvh: wp.uint64, positions: wp.array(dtype=wp.vec3), tets: wp.array(dtype=wp.vec4i),
             points: wp.array(dtype=wp.vec3), found: wp.array(dtype=int)):
        i = wp.tid()
        p = points[i]
        query = wp.bvh_query_aabb(bvh, p, p)
        t = int(0)
        best = int(-1)
        while wp.bvh_query_next(query, t):
            c = tets[t]
            a = positions[c[0]] - p
            b = positions[c[1]] - p
            d = positions[c[2]] - p
            e = positions[c[3]] - p
            v0 = wp.dot(b, wp.cross(d, e))
            v1 = -wp.dot(a, wp.cross(d, e))
            v2 = wp.dot(a, wp.cross(b, e))
            v3 = -wp.dot(a, wp.cross(b, d))
            low = wp.min(wp.min(v0, v1), wp.min(v2, v3))
            high = wp.max(wp.max(v0, v1), wp.max(v2, v3))
            if low >= 0.0 or high <= 0.0:
                best = t
        found[i] = best

    def beside(positions, tets, points):
        locator = voxtet.Locator(positions, tets)
        corners = positions[tets]
        bvh = wp.Bvh(wp.array(corners.min(axis=1), dtype=wp.vec3, device="cpu"),
                     wp.array(corners.max(axis=1), dtype=wp.vec3, device="cpu"))
        arguments = [bvh.id, *(wp.array(a, dtype=d, device="cpu") for a, d in [
            (positions, wp.vec3), (tets.astype(np.int32), wp.vec4i), (points, wp.vec3)])]
        found = wp.zeros(len(points), dtype=int, device="cpu")
        inputs = [*arguments, found]
        ours, hits, theirs = least([lambda: locator.locate(points), lambda: locator.find_point_hits(points),
                                     lambda: wp.launch(find, len(points), inputs, device="cpu")], 1, 9,
                                    time.process_time_ns)
        ours, hits, theirs = ours / len(points), hits / len(points), theirs / len(points)
        print(f"{len(tets)} tets, us a point: locate {ours:.3f}, find_point_hits {hits:.3f}, Warp's BVH {theirs:.3f} "
              f"({theirs / ours:.1f} and {theirs / hits:.1f} times)", end="; ")
        return locator.locate(points).tet, found.numpy()

    for cells in [14, 20, 34]:
        positions, tets = box(cells)
        positions += np.random.default_rng(0).uniform(-.2, .2, positions.shape).astype(np.float32) / cells
        points = np.random.default_rng(1).uniform(0, 1, (100000, 3)).astype(np.float32)
        ours, theirs = beside(positions, tets, points)
        print(f"{np.count_nonzero(ours != theirs)} of {len(points)} found in another one")
    for cells in [16, 32]:
        # Points on facets, exactly: multiples of 1/128.
        positions, tets = box(cells)
        sides = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]
        facets = np.random.default_rng(1).permutation(tets[:, sides].reshape(-1, 3))[:100000]
        points = np.einsum("fcx,c->fx", positions[facets], np.array([.25, .25, .5], np.float32))
        wrong = [np.count_nonzero((found < 0) | ~(np.sort(tets[found][:, sides], axis=2) ==
                                                  np.sort(facets, axis=1)[:, None]).all(axis=2).any(axis=1))
                 for found in beside(positions, tets, points)]
        print(f"of {len(points)} points on facets {wrong[0]} and {wrong[1]} wrong")


if __name__ == "__main__":
    for name in sys.argv[1:] or ["calls", "locate", "scenes"]:
        {"calls": calls, "locate": locate, "warp": warp, "scenes": scenes, "suggest": suggest}[name]()
