"""What each rank does in test_mpi: parts of two bodies in stripes along x, whose vertices touch exactly on facets between ranks."""

import sys

import numpy as np
from mpi4py import MPI

import voxtet
import voxtet.mpi
from support import box, global_contacts, in_order

# Halves and quarters: vertices of one body lie exactly on facets, edges and corners of the other. So many that messages are longer
# than those that MPI sends at once (4 KB), which it handles in another way.
POSITIONS, TETS = box(8, dtype=np.float64)
BODIES = {3: (4 * POSITIONS, TETS), 8: (4 * POSITIONS + [1.25, 0.5, 0.25], TETS)}


def part_of(positions, tets, rank, size):
    """The tetrahedra whose centres are in a stripe, their vertices, their numbers, and which vertices are owned."""
    centres = positions[tets].mean(axis=1)[:, 0]
    low, high = positions[:, 0].min(), positions[:, 0].max()
    stripe = np.minimum((centres - low) / (high - low) * size, size - 1).astype(int)
    here = np.flatnonzero(stripe == rank)
    owner = np.full(len(positions), size)
    for t, s in zip(tets, stripe):
        owner[t] = np.minimum(owner[t], s)
    vertices = np.unique(tets[here])
    local = np.searchsorted(vertices, tets[here])
    return positions[vertices], local, vertices, here, owner[vertices] == rank


def whole():
    """The whole bodies in one grid, and as a scene of this rank alone, which both borrow the positions."""
    grid, alone = voxtet.Grid(), voxtet.mpi.Scene()
    kept = [positions.copy() for positions, _ in BODIES.values()]
    for (body, (_, tets)), positions in zip(BODIES.items(), kept):
        grid.add(positions, tets, user_data=body)
        alone.insert(body, positions, tets)
    grid.step()
    alone.step()
    return grid, alone, kept


def expect_contacts(scene, grid, alone):
    """Both sides of all ranks are the contacts of one grid, and the hash is that of one rank."""
    expected = global_contacts(grid)
    for side in (scene.contacts, scene.tet_contacts):
        found = in_order(np.concatenate(MPI.COMM_WORLD.allgather(np.asarray(side))))
        for name, values in expected.items():
            assert np.array_equal(found[name], values), f"the contacts are not those of one grid: {name}"
    assert scene.hash() == alone.hash(), "the hash is not that of one rank"


def fails(here, kind, call):
    """Expects `kind` on the rank that failed, and on the others what the library says of that rank."""
    try:
        call()
    except (voxtet.VoxError, TypeError, MemoryError) as error:
        rank = MPI.COMM_WORLD.Get_size() - 1
        if here:
            assert isinstance(error, kind) and f"rank {rank} failed" not in str(error), error
        else:
            expected = MemoryError if kind is MemoryError else voxtet.InvalidArgumentError
            assert isinstance(error, expected) and f"rank {rank} failed" in str(error), error
    else:
        raise AssertionError("nothing was raised")


def without_memory(room, message):
    """As `room`, but there is none for one of the messages."""
    sizes = []

    def instead(size):
        sizes.append(size)
        if len(sizes) == message + 1:
            raise MemoryError
        return room(size)
    return instead


def main():
    world = MPI.COMM_WORLD
    rank, size = world.Get_rank(), world.Get_size()
    with voxtet.mpi.Scene(world) as scene:
        assert (scene.rank, scene.size) == (rank, size)
        parts = {}
        for body, (positions, tets) in BODIES.items():
            here, local, vertices, numbers, owned = part_of(positions, tets, rank, size)
            here = here.copy()
            parts[body] = here, numbers
            scene.insert(body, here, local, vertex_ids=vertices, tet_ids=numbers, owned=owned)
        scene.check()
        scene.step()
        grid, alone, kept = whole()
        expect_contacts(scene, grid, alone)
        found = world.allgather(len(scene.contacts))
        assert sum(found) == len(grid.contacts) > 100, found

        # A value of the vertex arrives at the tetrahedron's side of the same contact, and goes back.
        contacts, of_tets = scene.contacts, scene.tet_contacts
        sent = np.stack([contacts.vertex, contacts.tet], axis=1).astype(np.float64) + contacts.body_a[:, None] * 0.5
        arrived = scene.send(sent)
        assert np.array_equal(arrived, np.stack([of_tets.vertex, of_tets.tet], axis=1) + of_tets.body_a[:, None] * 0.5)
        assert np.array_equal(scene.send(arrived, side="tets"), sent)

        # Points on vertices, edges and facets, and outside: each has the tetrahedron that one rank alone finds.
        random = np.random.default_rng(rank)
        points = random.integers(-2, 30, (500, 3)) * 0.125
        expected, located = alone.locate(points), scene.locate(points)
        for name in ("body", "tet", "state", "weights", "distance"):
            assert np.array_equal(located[name], expected[name]), name
        assert 0 < np.count_nonzero(located.state == voxtet.mpi.OUTSIDE) < len(points)

        # Moved in place, everywhere alike.
        for body, (here, _) in parts.items():
            here += 0.0625 * body
        for (body, _), positions in zip(BODIES.items(), kept):
            positions += 0.0625 * body
        scene.step()
        grid.step()
        alone.step()
        expect_contacts(scene, grid, alone)
        assert scene.counters["collectives"] == 2
        assert [*scene.costs.body] == sorted(parts) and np.all(scene.costs.seconds >= 0)

        # A failure of one rank is one of all, and the next step works.
        if rank == size - 1:
            parts[3][0][0, 0] = np.nan
        try:
            scene.step()
        except voxtet.NonFiniteError as error:
            assert f"rank {size - 1}" in str(error) or rank == size - 1, error
        else:
            raise AssertionError("a position that is not a number was taken")
        if rank == size - 1:
            parts[3][0][0, 0] = kept[0][np.unique(BODIES[3][1][parts[3][1]])[0], 0]
        scene.step()
        expect_contacts(scene, grid, alone)

        # A bad argument of one rank fails on all, which would otherwise wait for it.
        bad = rank == size - 1
        rows = np.zeros((len(scene.contacts) + bad, 3))
        fails(bad, voxtet.InvalidArgumentError, lambda: scene.send(rows))
        fails(bad, voxtet.InvalidArgumentError, lambda: scene.send(rows[:len(rows) - bad], side="sideways" if bad else "vertices"))
        fails(bad, TypeError, lambda: scene.locate(points.astype(np.float16 if bad else np.float64)))
        fails(bad, TypeError, lambda: voxtet.mpi.Scene(world, reference="steam" if bad else None))
        assert np.array_equal(scene.send(scene.contacts.tet), scene.tet_contacts.tet)

        # So does a lack of memory for a message, after which nothing is left over for the next exchange.
        for message in range(3 if size > 1 else 0):
            room = voxtet.mpi._room
            if bad:
                voxtet.mpi._room = without_memory(room, message)
            fails(bad, MemoryError, scene.step)
            voxtet.mpi._room = room
            assert len(scene.contacts) == 0
            scene.step()
            expect_contacts(scene, grid, alone)
        world.Barrier()

        # Messages longer than MPI takes go as several.
        voxtet.mpi._LONGEST = 64
        scene.step()
        expect_contacts(scene, grid, alone)
        voxtet.mpi._LONGEST = 1 << 30
    if rank == 0:
        print(f"{size} ranks: {sum(found)} contacts")


if __name__ == "__main__":
    try:
        main()
    except BaseException:
        import traceback
        traceback.print_exc()
        sys.stderr.flush()
        MPI.COMM_WORLD.Abort(1)  # the others wait for this rank
