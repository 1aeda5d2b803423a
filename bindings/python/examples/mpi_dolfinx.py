"""Contacts between two meshes of dolfinx, where dolfinx has partitioned them, and points located in one of them.

usage: mpirun -n 4 python3 mpi_dolfinx.py [CUBES]    CUBES: along each side, 12 by default"""

import sys
import time

import dolfinx
import numpy as np
from mpi4py import MPI

import voxtet
import voxtet.mpi

world = MPI.COMM_WORLD
rank = world.Get_rank()
cubes = int(sys.argv[1]) if len(sys.argv) > 1 else 12


def part_of(mesh):
    """The cells of this rank and their vertices, by the numbers of the whole mesh: arguments of Scene.insert."""
    cells = np.arange(mesh.topology.index_map(3).size_local)  # without the ghosts
    corners = mesh.geometry.dofmap.array.reshape(-1, 4)[cells]
    vertices, tets = np.unique(corners, return_inverse=True)
    return dict(positions=mesh.geometry.x[vertices].copy(), tets=tets.reshape(-1, 4),
                vertex_ids=np.asarray(mesh.geometry.input_global_indices)[vertices],
                tet_ids=np.asarray(mesh.topology.original_cell_index)[cells],
                owned=vertices < mesh.geometry.index_map().size_local)


def boxes(communicator):
    """Two boxes, the second a quarter of a cube into the first, so that vertices lie on facets and edges of the other."""
    for corner in (0.0, 1 - 2.25 / cubes):
        yield dolfinx.mesh.create_box(communicator, [[corner] * 3, [corner + 1] * 3], [cubes] * 3,
                                      dolfinx.mesh.CellType.tetrahedron, ghost_mode=dolfinx.mesh.GhostMode.none)


scene = voxtet.mpi.Scene(world)
kept = [part_of(mesh) for mesh in boxes(world)]
for body, part in enumerate(kept):
    scene.insert(body, **part)
scene.check()  # each vertex has one owner, and its copies are where that has it
scene.step()
found = world.gather(np.asarray(scene.contacts))
tets = world.gather([len(part["tets"]) for part in kept])

# The whole, from the parts of all ranks, as one grid on rank 0: the same contacts.
parts = world.gather(kept)
if rank == 0:
    grid = voxtet.Grid()
    whole = []
    for body in range(2):
        count = 1 + max(int(p[body]["vertex_ids"].max()) for p in parts)
        positions, cells = np.zeros((count, 3)), np.zeros((sum(t[body] for t in tets), 4), np.int64)
        for p in parts:
            positions[p[body]["vertex_ids"]] = p[body]["positions"]
            cells[p[body]["tet_ids"]] = p[body]["vertex_ids"][p[body]["tets"]]
        whole.append((positions, cells))
        grid.add(positions, cells, user_data=body)
    grid.step()
    found, expected = np.sort(np.concatenate(found), order=["body_a", "vertex", "body_b", "tet"]), grid.contacts
    number_of = {mesh.id: mesh.user_data for mesh in grid}
    for name in ("body_a", "vertex", "body_b", "tet"):
        values = [number_of[body] for body in expected[name]] if name.startswith("body") else expected[name]
        assert np.array_equal(found[name], values), "other contacts"
    print(f"{len(found)} contacts between parts of {tets} tetrahedra: those of one grid")

# Points on vertices, and in the middle of edges, of the first mesh: each is in one tetrahedron, on one rank.
random = np.random.default_rng(1)
points = random.integers(0, 2 * cubes + 1, (20000, 3)) / (2 * cubes)
mine = points[rank::world.Get_size()].copy()
start = time.perf_counter()
located = scene.locate(mine)
seconds = world.allreduce(time.perf_counter() - start, MPI.MAX)
missing = world.reduce(int(np.count_nonzero(located.state != voxtet.mpi.INSIDE)))
if rank == 0:
    print(f"{len(points)} points: {missing} in no tetrahedron, {1e6 * seconds / len(points):.2f} microseconds each")

# dolfinx's own on one rank, with the same mesh: boxes of cells, then distances with a tolerance.
if rank == 0:
    mesh = next(boxes(MPI.COMM_SELF))
    start = time.perf_counter()
    tree = dolfinx.geometry.BoundingBoxTree(mesh, 3)
    candidates = dolfinx.geometry.compute_collisions(tree, points)
    found = np.diff(dolfinx.geometry.compute_colliding_cells(mesh, candidates, points).offsets)
    theirs = time.perf_counter() - start
    alone = voxtet.mpi.Scene()
    part = part_of(mesh)
    alone.insert(0, **part)
    start = time.perf_counter()
    alone.locate(points)
    ours = time.perf_counter() - start
    print(f"on one rank: dolfinx has {np.count_nonzero(found == 0)} points in no cell and {np.count_nonzero(found > 1)} in several, "
          f"{1e6 * theirs / len(points):.1f} microseconds each; voxtet has each in one, {1e6 * ours / len(points):.2f} microseconds")
scene.close()
