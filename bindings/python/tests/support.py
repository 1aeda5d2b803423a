"""What the tests share: bodies, and grids of them."""

import gc
import shutil
import subprocess
import sys
import unittest

import numpy as np

import voxtet

TET = np.array([[0, 1, 2, 3]], np.uint32)


def box(cells=4, at=(0, 0, 0), dtype=np.float32):
    """A cube of side 1 of cells**3 cubes, each split into five tetrahedra."""
    n = cells + 1
    grid = np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    positions = np.ascontiguousarray(grid / cells + np.asarray(at, float), dtype)
    fives = [[(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(1, 1, 0), (1, 0, 0), (0, 1, 0), (1, 1, 1)],
             [(1, 0, 1), (1, 0, 0), (0, 0, 1), (1, 1, 1)], [(0, 1, 1), (0, 1, 0), (0, 0, 1), (1, 1, 1)],
             [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]]
    tets = []
    for corner in np.ndindex(cells, cells, cells):
        mirrored = sum(corner) % 2
        for five in fives:
            tets.append([np.dot(np.add(corner, np.bitwise_xor(c, (mirrored, 0, 0))), (n * n, n, 1)) for c in five])
    tets = np.array(tets, np.uint32)
    inverted = np.linalg.det(grid[tets[:, 1:]] - grid[tets[:, :1]]) < 0
    tets[inverted] = tets[inverted][:, [0, 2, 1, 3]]
    return positions, tets


def two_boxes(cells=4, dtype=np.float32):
    """Positions of two cubes that overlap at a corner, and the tetrahedra of each."""
    a, tets = box(cells, dtype=dtype)
    return a, (a + np.array([0.61, 0.52, 0.43], dtype)).astype(dtype), tets


class GridCase(unittest.TestCase):
    """With a grid of two cubes that touch, `self.a` and `self.b`, not stepped yet."""

    options = {}

    def setUp(self):
        self.first, self.second, self.tets = two_boxes()
        self.grid = voxtet.Grid(**self.options)
        self.a = self.grid.add(self.first, self.tets, tag="a", user_data=7)
        self.b = self.grid.add(self.second, self.tets, tag="b", user_data=2**63)
        self.addCleanup(self.end)

    def end(self):
        gc.collect()
        self.grid.close()


def global_contacts(grid):
    """What scenes of voxtet.mpi should find, field by field: the contacts of a grid of whole bodies, whose user_data are their numbers."""
    contacts, number_of = grid.contacts, {mesh.id: mesh.user_data for mesh in grid}
    found = {name: np.array([number_of[body] for body in contacts[name].tolist()], np.uint64) for name in ("body_a", "body_b")}
    found.update({name: contacts[name] for name in ("vertex", "tet")}, interior=grid.interiors)
    return in_order(found)


def in_order(contacts):
    """These fields of contacts, sorted by (body_a, vertex, body_b, tet)."""
    order = np.lexsort([contacts[name] for name in ("tet", "body_b", "vertex", "body_a")])
    return {name: contacts[name][order] for name in ("body_a", "vertex", "body_b", "tet", "interior")}


def mpi_command(test, processes):
    """What runs a Python program in so many processes of the MPI that mpi4py was built with; skips the test where there is none."""
    # In a process of its own: MPI that runs here would be inherited.
    asked = subprocess.run([sys.executable, "-c", "from mpi4py import MPI; print(MPI.Get_library_version())"],
                           capture_output=True, text=True)
    if asked.returncode != 0:
        test.skipTest(asked.stderr.strip().splitlines()[-1])
    openmpi = asked.stdout.startswith("Open MPI")
    run = shutil.which("mpiexec.openmpi" if openmpi else "mpiexec.mpich") or shutil.which("mpiexec")
    if run is None:
        test.skipTest("there is no mpiexec")
    return [run, *(["--allow-run-as-root", "--oversubscribe"] if openmpi else []), "-n", str(processes), sys.executable]
