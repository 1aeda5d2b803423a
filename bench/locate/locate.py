#!/usr/bin/env python3
"""Points, nearest tetrahedra and tracks in 48,000 tetrahedra: voxtet beside scikit-fem, VTK, pyvista, medcoupling and dolfinx, whichever are
installed, on one thread. All answers are compared with voxtet's, which are exact. Prints the table of docs/evidence/locate.md.

usage: VOXTET_LIBRARY_DIR=build/release PYTHONPATH=bindings/python/src locate.py [--rounds N]"""

import argparse
import importlib
import time
from fractions import Fraction

import numpy as np

import voxtet.io

COUNTS = (1000, 100_000, 1_000_000)
MOST_SECONDS = 30  # of a run; an entrant that would take longer is left out


def lattice(n=20):
    """A cube of n^3 cubes of six tetrahedra each, inner vertices moved."""
    index = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    corners = [index[a:n + a, b:n + b, c:n + c].ravel() for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    paths = [(0, a, a | b, 7) for a in (1, 2, 4) for b in (1, 2, 4) if a != b]
    tets = np.concatenate([np.stack([corners[i] for i in path], axis=1) for path in paths])
    positions = np.stack(np.meshgrid(*[np.arange(n + 1.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    inner = ((positions > 0) & (positions < n)).all(axis=1)
    positions[inner] += np.random.default_rng(0).uniform(-.15, .15, (inner.sum(), 3))
    return positions / n, tets


class Static:
    """vtkStaticCellLocator."""

    def __init__(self, vtk, pyvista, positions, tets):
        self.vtk, self.cells = vtk, vtk.vtkStaticCellLocator()
        self.grid = pyvista.UnstructuredGrid({10: tets.astype(np.int64)}, positions)
        self.grid.cell_data["cell"] = np.arange(len(tets))
        self.cells.SetDataSet(self.grid)
        self.cells.BuildLocator()

    def find(self, points):
        return np.array([self.cells.FindCell(p) for p in points])

    def closest(self, points):
        cell, at, sub, square = self.vtk.vtkGenericCell(), [0.0] * 3, self.vtk.reference(0), self.vtk.reference(0.0)
        found, distances = self.vtk.reference(0), []
        for p in points:
            self.cells.FindClosestPoint(p, at, cell, found, sub, square)
            distances.append(square.get() ** 0.5)
        return np.array(distances)

    def tracks(self, segments):
        points, ids, cell = self.vtk.vtkPoints(), self.vtk.vtkIdList(), self.vtk.vtkGenericCell()
        found = []
        for start, end in zip(*segments):
            self.cells.IntersectWithLine(start, end, 0, points, ids, cell)
            found.append({ids.GetId(i) for i in range(ids.GetNumberOfIds())})
        return found


def contains(corners, point):
    """Whether a tetrahedron has a point, in rational numbers."""
    corners, point = [[Fraction(float(x)) for x in c] for c in corners], [Fraction(float(x)) for x in point]

    def volume(c):
        a, b, d = ([x - y for x, y in zip(c[k], c[0])] for k in (1, 2, 3))
        return sum(a[i] * (b[i - 2] * d[i - 1] - b[i - 1] * d[i - 2]) for i in range(3))

    return all(volume(corners[:k] + [point] + corners[k + 1:]) * volume(corners) >= 0 for k in range(4))


def entrants(positions, tets):
    """{name: {task: function}}"""
    locator = voxtet.Locator(positions, tets)
    found = {"voxtet": {"find": lambda p: locator.locate(p).tet,
                        "closest": lambda p: locator.locate(p, outside="nearest").distance,
                        "tracks": lambda s: voxtet.tracks(*s, locator)}}

    def needs(*names):
        try:
            return [importlib.import_module(name) for name in names]
        except ImportError as missing:
            print(f"left out: {missing}")
            return None

    if modules := needs("skfem", "voxtet.skfem"):
        mesh = modules[0].MeshTet(positions.T, tets.T)
        finder, drop_in = mesh.element_finder(), modules[1].element_finder(mesh)
        found["voxtet.skfem.element_finder"] = {"find": lambda p: drop_in(*p.T)}
        found["scikit-fem, element_finder"] = {"find": lambda p: finder(*p.T)}
    if modules := needs("vtk", "pyvista"):
        static, pyvista = Static(*modules, positions, tets), modules[1]
        found["vtkStaticCellLocator, in a loop"] = {"find": static.find, "closest": static.closest, "tracks": static.tracks}
        found["pyvista, sample"] = {"find": lambda p: pyvista.PolyData(p).sample(static.grid)["cell"]}
    if modules := needs("medcoupling"):
        medcoupling, = modules
        mesh = medcoupling.MEDCouplingUMesh("", 3)
        mesh.setCoords(medcoupling.DataArrayDouble(positions))
        mesh.allocateCells(len(tets))
        for tet in tets[:, [0, 2, 1, 3]].tolist():
            mesh.insertNextCell(medcoupling.NORM_TETRA4, 4, tet)
        mesh.finishInsertingCells()

        def by_medcoupling(p):
            cells, index = mesh.getCellsContainingPoints(medcoupling.DataArrayDouble(p), 1e-12)
            return cells.toNumPyArray()[index.toNumPyArray()[:-1]]

        found["medcoupling, getCellsContainingPoints"] = {"find": by_medcoupling}
    if modules := needs("dolfinx", "mpi4py.MPI", "ufl"):
        by_dolfinx = dolfinx_finder(*modules, positions, tets)
        found["dolfinx, compute_colliding_cells"] = {"find": by_dolfinx}
    return found


def dolfinx_finder(dolfinx, mpi, ufl, positions, tets):
    """The lowest cell of each point among the several that it may have, by dolfinx 0.5."""
    geometry = importlib.import_module("dolfinx.geometry")
    mesh = importlib.import_module("dolfinx.mesh").create_mesh(
        mpi.COMM_SELF, tets.astype(np.int64), positions, ufl.Mesh(ufl.VectorElement("Lagrange", ufl.tetrahedron, 1)))
    tree = geometry.BoundingBoxTree(mesh, 3)
    number = np.asarray(mesh.topology.original_cell_index)

    def find(points):
        cells = geometry.compute_colliding_cells(mesh, geometry.compute_collisions(tree, points), points)
        none = np.diff(cells.offsets) == 0
        first = np.minimum.reduceat(np.append(number[cells.array], len(tets)), cells.offsets[:-1])
        return np.where(none, -1, first)

    return find


def measured(run, given, count, rounds, differ, expected):
    """Microseconds per item, the least of some runs, and the share of other answers; "-" where it would take too long."""
    began = time.perf_counter()
    run(given(min(count, 200)))
    if (time.perf_counter() - began) / min(count, 200) * count > MOST_SECONDS:
        return "-"
    best = float("inf")
    for _ in range(rounds):
        items = given(count)
        began = time.perf_counter()
        found = run(items)
        best = min(best, time.perf_counter() - began)
        if best > MOST_SECONDS / 10:
            break
    other = np.mean(differ(found, expected))
    return f"{best / count * 1e6:.3g}" + (f" ({100 * other:.2g} % other answers)" if other else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    positions, tets = lattice()
    random = np.random.default_rng(1)
    inside, around = random.random((COUNTS[-1], 3)), random.random((COUNTS[-1], 3)) * 2 - 0.5
    segments = random.random((2, COUNTS[-1] // 10, 3)) * 1.4 - 0.2
    rows = entrants(positions, tets)
    ours = rows["voxtet"]

    def other_tracks(found, expected):
        if isinstance(found, voxtet.Tracks):
            return False
        return [cells != set(expected.tet[a:b].tolist()) for cells, a, b in zip(found, expected.offsets, expected.offsets[1:])]

    judged = [0, 0]  # points with other answers: vox is right, the other is

    def other_points(found, expected):
        for i in np.flatnonzero(found != expected)[:2000]:
            for k, tet in enumerate((expected[i], found[i])):
                judged[k] += tet >= 0 and contains(positions[tets[tet]], inside[i])
        return found != expected

    tasks = {"find": (lambda n: inside[:n], COUNTS, other_points),
             "closest": (lambda n: around[:n], COUNTS, lambda a, b: abs(a - b) > 1e-12),
             "tracks": (lambda n: segments[:, :n], COUNTS[:2], other_tracks)}
    for task, (given, counts, differ) in tasks.items():
        print(f"\n| µs | {' | '.join(f'{task}, {count:,}' for count in counts)} |\n|---|{'---:|' * len(counts)}")
        answers = {count: ours[task](given(count)) for count in counts}
        for name, functions in rows.items():
            if task in functions:
                times = [measured(functions[task], given, count, rounds, differ, answers[count]) for count in counts]
                print(f"| {name} | {' | '.join(times)} |", flush=True)
    print(f"\nother answers of find, in rational numbers: vox is right in {judged[0]}, the other in {judged[1]}")
    cage = voxtet.io.make_lattice_ball(5000, 1.0)
    skin = random.normal(size=(100_000, 3))
    skin *= 0.97 / np.linalg.norm(skin, axis=1, keepdims=True)
    times = []
    for _ in range(75):
        began = time.perf_counter()
        bound = voxtet.embed(skin, cage.positions, cage.tets)
        middle = time.perf_counter()
        bound.move(cage.positions)
        times.append((1e3 * (middle - began), 1e3 * (time.perf_counter() - middle)))
    (bind, move), (bind_median, move_median) = np.min(times, axis=0), np.median(times, axis=0)
    print(f"skin bound in {bind:.1f} ms (median {bind_median:.1f}), moved in {move:.2f} ms (median {move_median:.2f})")
    print(f"{len(answers[counts[-1]].tet) / counts[-1]:.1f} tetrahedra a segment")


if __name__ == "__main__":
    main()
