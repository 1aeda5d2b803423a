"""Two boxes, each cut in stripes among all ranks: mpiexec -n 4 python3 mpi_blocks.py. On any number of ranks it prints the same."""

import numpy as np
from mpi4py import MPI

import voxtet.io
import voxtet.mpi

world = MPI.COMM_WORLD


def part_of(positions, tets):
    """The stripe of this rank along x: arguments of Scene.insert. A program with many ranks would read or make its stripe alone."""
    centres = positions[tets].mean(axis=1)[:, 0]
    low, high = positions[:, 0].min(), positions[:, 0].max()
    rank_of_tet = np.minimum((centres - low) / (high - low) * world.size, world.size - 1).astype(int)
    rank_of_vertex = np.full(len(positions), world.size)
    np.minimum.at(rank_of_vertex, tets, rank_of_tet[:, None])  # of the ranks that have a vertex, the lowest owns it
    tet_ids = np.flatnonzero(rank_of_tet == world.rank)
    vertex_ids = np.unique(tets[tet_ids])
    return dict(positions=positions[vertex_ids], tets=np.searchsorted(vertex_ids, tets[tet_ids]), vertex_ids=vertex_ids,
                tet_ids=tet_ids, owned=rank_of_vertex[vertex_ids] == world.rank)


box = voxtet.io.make_box(1, 1, 1, 0.125)
kept = [part_of(box.positions, box.tets), part_of(box.positions + [0.5, 0.25, 0.375], box.tets)]
with voxtet.mpi.Scene(world) as scene:
    for body, part in enumerate(kept):
        scene.insert(body, **part)
    scene.check()                       # each vertex has one owner; for debugging
    for frame in range(3):
        kept[1]["positions"] -= [0.0625, 0, 0]  # in place: the scene borrows this very array
        scene.step()
        hashed, count = scene.hash(), world.allreduce(len(scene.contacts))
        if world.rank == 0:
            print(f"{count} contacts, hash {hashed:032x}")

    # A force for each vertex in contact goes to the rank of the tetrahedron, which shares it among the corners by their weights.
    forces = np.zeros((len(scene.contacts), 3))
    forces[:, 0] = 1.0
    arrived, contacts = scene.send(forces), scene.tet_contacts
    corners = contacts.weights[:, :, None] * arrived[:, None, :]
    total = world.allreduce(float(corners.sum()))

    # Where points of one rank are, on whichever rank.
    places = np.array([[-0.25, -0.25, -0.25], [0.75, 0.5, 0.5], [9.0, 9.0, 9.0]])
    found = scene.locate(places if world.rank == 0 else places[:0])
    if world.rank == 0:
        inside = found.state == voxtet.mpi.INSIDE
        print(f"forces add up to {total:.3f}; {np.count_nonzero(inside)} of 3 points are in bodies {found.body[inside].tolist()}")
