#!/usr/bin/env python3
"""Looks for the scenes in which vox is slowest at pairs of surface features: families of hard ones with random settings, each beside
IPC Toolkit's LBVH in turns, one thread each. Prints the worst of each family: nanoseconds for each feature and pair, and how
many times as long LBVH takes. Checks that the numbers of pairs are those of ipctk's sweep and prune.

usage: hard.py LIBVOX [--tries N] [--seed S]"""

import argparse
import ctypes
import time

import numpy as np

import pairs


def triangles(middles, sizes, random):
    """A loose triangle around each middle."""
    corners = middles[:, None, :] + sizes[:, None, None] * (random.random((len(middles), 3, 3)) - 0.5)
    return corners.reshape(-1, 3), np.arange(3 * len(middles), dtype=np.uint32).reshape(-1, 3)


def soup(random, count):
    """Triangles of one size, anywhere."""
    return triangles(random.random((count, 3)), np.full(count, count ** (-1 / 3) * random.uniform(0.2, 0.8)), random)


def sizes_apart(random, count):
    """Sizes spread over orders of magnitude."""
    return triangles(random.random((count, 3)), 10 ** random.uniform(-random.uniform(1, 6), -1, count), random)


def giant_over_fine(random, count):
    """A few triangles over all of the others."""
    points, faces = soup(random, count)
    few = random.integers(1, 12)
    points[: 9 * few] = 3 * random.random((9 * few, 3)) - 1
    return points, faces


def clumps(random, count):
    """Clumps far apart, so that a lattice would be empty but for a few cells."""
    where = 10 ** random.uniform(1, 6) * random.random((random.integers(2, 20), 3))
    points, faces = soup(random, count)
    return points + np.repeat(where[random.integers(0, len(where), count)], 3, axis=0), faces


def slivers(random, count):
    """Long thin triangles in all directions: boxes that are much larger than what is in them."""
    points, faces = triangles(random.random((count, 3)), np.full(count, 1e-3), random)
    along = random.normal(size=(count, 3))
    points[2::3] += random.uniform(0.02, 0.08) * along / np.linalg.norm(along, axis=1)[:, None]
    return points, faces


def one_line(random, count):
    """All along a diagonal."""
    at = np.sort(random.random(count))[:, None] * np.ones(3)
    return triangles(at + 1e-3 * random.random((count, 3)), np.full(count, random.uniform(1, 8) / count), random)


def shuffled_sheet(random, count):
    """A sheet whose faces and vertices are numbered at random."""
    side = int((count / 2) ** 0.5)
    i, j = np.meshgrid(np.arange(side + 1), np.arange(side + 1), indexing="ij")
    points = np.stack([i, j, random.uniform(0.1, 2) * random.random(i.shape)], axis=-1).reshape(-1, 3).astype(float)
    corner = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)
    quads = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[:-1, 1:], corner[1:, 1:]], axis=-1).reshape(-1, 4)
    faces = random.permutation(np.concatenate([quads[:, :3], quads[:, [2, 1, 3]]]))
    order = random.permutation(len(points))
    points[order] = points.copy()
    return points, order[faces].astype(np.uint32)


def lattice_box(random, count):
    """The surface of a box of equal squares, near the origin or far away: most boxes touch, or miss each other by the radius."""
    side = max(2, int((count / 12) ** 0.5))
    numbers = {}
    faces = []
    for axis in range(3):
        for at in (0, side):
            for i in range(side):
                for j in range(side):
                    corners = []
                    for u, v in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        point = [0, 0, 0]
                        point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = at, u, v
                        corners.append(numbers.setdefault(tuple(point), len(numbers)))
                    faces += [corners[:3], [corners[0], corners[2], corners[3]]]
    far = 10 ** random.uniform(-2, 4) * random.random(3) * random.integers(0, 2)
    return np.array(list(numbers), float) / side + far, np.array(faces, np.uint32)


FAMILIES = [soup, sizes_apart, giant_over_fine, clumps, slivers, one_line, shuffled_sheet, lattice_box]


def motion(random, points, size):
    """Standing still, all together, everyone for himself, or as if the tiles were made for another shape."""
    kind = random.integers(0, 4)
    if kind == 0:
        return points
    if kind == 1:
        return points + 20 * size * random.random(3)
    if kind == 2:
        return points + random.uniform(0.1, 3) * size * (random.random(points.shape) - 0.5)
    return points * random.uniform(0.5, 1.5, 3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("library")
    parser.add_argument("--tries", type=int, default=12)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    import ipctk

    vox = ctypes.CDLL(options.library)
    vox.vox_last_error.restype = ctypes.c_char_p
    ipctk.set_num_threads(1)
    print("| scene | tries | worst, ns a feature and pair | its features, pairs | least LBVH over vox | its features, pairs |")
    print("|---|---|---|---|---|---|")
    for number, family in enumerate(FAMILIES):
        slowest, closest = (0,), (np.inf,)
        for attempt in range(options.tries):
            random = np.random.default_rng([options.seed, number, attempt])
            points, faces = family(random, int(10 ** random.uniform(3, 4.4)))
            size = np.linalg.norm(points[faces[:, 0]] - points[faces[:, 1]], axis=1).mean() # of an edge
            end = motion(random, points, size)
            radius = size * 10 ** random.uniform(-7, -1) * random.integers(0, 2)
            edges = pairs.edges_of(faces)
            start, end = np.asfortranarray(points), np.asfortranarray(end)
            surface = pairs.Surface(vox, start, edges, np.ascontiguousarray(faces))
            mesh = ipctk.CollisionMesh(start, np.asfortranarray(edges.astype(np.int32)),
                                       np.asfortranarray(faces.astype(np.int32)))
            candidates, broad, times = ipctk.Candidates(), ipctk.LBVH(), {"lbvh": [], "vox": []}
            for _ in range(3):
                begin = time.perf_counter()
                candidates.build(mesh, start, end, radius, broad)
                times["lbvh"].append(time.perf_counter() - begin)
                begin = time.perf_counter()
                surface.move(start, end, radius, False)
                found = surface.pairs(pairs.EDGE, pairs.EDGE).pair_count + surface.pairs(pairs.FACE, pairs.VERTEX).pair_count
                times["vox"].append(time.perf_counter() - begin)
            candidates.build(mesh, start, end, radius, ipctk.SweepAndPrune())
            if len(candidates) != found:
                raise SystemExit(f"{family.__name__}: {found} pairs, expected {len(candidates)}")
            features = len(points) + len(edges) + len(faces)
            theirs, ours = min(times["lbvh"]), min(times["vox"])
            slowest = max(slowest, (1e9 * ours / (features + found), features, found))
            closest = min(closest, (theirs / ours, features, found))
        print(f"| {family.__doc__.split('.')[0].split(':')[0].split(',')[0].lower()} | {options.tries} | {slowest[0]:.0f} | "
              f"{slowest[1]}, {slowest[2]} | {closest[0]:.1f} | {closest[1]}, {closest[2]} |", flush=True)


if __name__ == "__main__":
    main()
