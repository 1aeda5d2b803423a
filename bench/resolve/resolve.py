#!/usr/bin/env python3
"""How often voxtet.resolve leaves nothing, with IPC Toolkit as the referee:

    VOXTET_LIBRARY_DIR=build/release PYTHONPATH=bindings/python/src python3 bench/resolve/resolve.py MESHES [WORD...]

MESHES: a folder with paper/, real/ and surfaces/ (bench/README.md). Needs numpy, scipy and ipctk. WORD: only scenes with it."""

import os
import sys
import time

import ipctk
import numpy as np
from scipy.spatial.transform import Rotation

import voxtet
import voxtet.io

MESHES = sys.argv[1]


def load(name, size=2.0):
    """Centred, its longest side as long as `size`."""
    mesh = voxtet.io.load(os.path.join(MESHES, name))
    positions = np.array(mesh.positions)
    cells = np.array(mesh.tets if len(mesh.tets) else mesh.triangles)
    return (positions - positions.mean(0)) * (size / np.ptp(positions, axis=0).max()), cells


def outside_of(cells):
    if cells.shape[1] == 3:
        return cells
    facets = np.vstack([cells[:, k] for k in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    _, first, count = np.unique(np.sort(facets, axis=1), axis=0, return_index=True, return_counts=True)
    return facets[first[count == 1]]


def touching(a, b):
    """The share of tetrahedra with a vertex of the other body in them, and the greatest depth."""
    with voxtet.Grid(constraints=True) as grid:
        grid.add(np.array(a[0]), a[1])
        grid.add(np.array(b[0]), b[1])
        grid.step()
        contacts = grid.contacts
        tets = len(set(zip(contacts.body_b.tolist(), contacts.tet.tolist())))
        return tets / (len(a[1]) + len(b[1])), -min(grid.constraints.gap.min(initial=0), 0)


def pressed(a, b, seed, wanted, what):
    """b, turned at random, comes as close as touching()[what] wants."""
    rng = np.random.default_rng(seed)
    turned = b[0] @ Rotation.random(random_state=seed).as_matrix().T
    way = rng.normal(size=3)
    way /= np.linalg.norm(way)
    low, high = 0.0, 4.0
    for _ in range(18):
        middle = (low + high) / 2
        low, high = (middle, high) if touching(a, (turned + middle * way, b[1]))[what] >= wanted else (low, middle)
    return [a, (turned + low * way, b[1])]


def folded(count, depth, wave):
    """A square of cloth whose half lies on the other half and goes through it, as cloth does in a frame that went wrong."""
    x, y = np.meshgrid(np.linspace(0, 1, count), np.linspace(0, 1, count), indexing="ij")
    at = np.arange(count * count).reshape(count, count)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    s, y, radius = x.ravel(), y.ravel(), 0.05
    flat = (1 - np.pi * radius) / 2
    turn, back = (s - flat) / radius, np.clip((s - flat - np.pi * radius) / flat, 0, 1)
    x = np.where(turn < 0, s, np.where(turn < np.pi, flat + radius * np.sin(turn), flat * (1 - back)))
    z = np.where(turn < 0, 0, np.where(turn < np.pi, radius * (1 - np.cos(turn)), 2 * radius))
    z = z - (2 * radius + depth) * back ** 2 + wave * np.sin(9 * y) * np.sin(7 * s)
    return [(np.c_[x, y, z], np.r_[np.c_[a, b, c], np.c_[a, c, d]])]


def divided(mesh):
    """Each triangle in four."""
    p, f = mesh
    sides = np.sort(np.vstack([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
    sides, back = np.unique(sides, axis=0, return_inverse=True)
    ab, bc, ca = len(p) + back.reshape(3, -1)
    a, b, c = f.T
    return np.vstack([p, p[sides].mean(1)]), np.vstack([np.c_[a, ab, ca], np.c_[b, bc, ab], np.c_[c, ca, bc], np.c_[ab, bc, ca]])


def scenes():
    for name in ("bunny", "cow", "armadillo"):
        body = load(f"paper/{name}.msh")
        for share in (0.005, 0.05):
            for seed in (1, 2, 3, 4):
                yield f"{name} {100 * share:g} % {seed}", lambda b=body, w=share, s=seed: pressed(b, b, s, w, 0), 1e-3
    organs = {name: load(f"real/{name}_v22.msh", 0.2) for name in ("liver", "torus_low_res", "cylinder", "Bunny")}
    for other, organ in organs.items():
        for depth in (0.001, 0.003, 0.005):
            for seed in (1, 2):
                yield (f"liver {other} {1000 * depth:g} mm {seed}",
                       lambda o=organ, d=depth, s=seed: pressed(organs["liver"], o, s, d, 1), 1e-4)
    for count in (30, 50, 70):
        for depth, wave in ((0.0, 0.02), (0.01, 0.0), (0.02, 0.01), (0.03, 0.0)):
            yield f"cloth {count} {depth:g} {wave:g}", lambda n=count, d=depth, w=wave: folded(n, d, w), 1e-3
    cow, bunny, armadillo = (load(f"surfaces/{name}.obj") for name in ("cow", "bunny", "armadillo"))
    yield "surface of the cow, by itself", lambda: [cow], 1e-3
    yield "surfaces, 96,000 triangles", lambda: [divided(bunny), (armadillo[0] + [0, 0, 1.2], armadillo[1])], 1e-3


def judge(bodies, positions, gap):
    """Whether they intersect, and the least distance or infinity if it is above the gap, by IPC Toolkit."""
    first, faces = 0, []
    for points, cells in bodies:
        faces.append(first + outside_of(cells))
        first += len(points)
    used, faces = np.unique(np.vstack(faces), return_inverse=True)
    points, faces = np.vstack(positions)[used], faces.reshape(-1, 3)
    mesh = ipctk.CollisionMesh(points, ipctk.edges(faces), faces)
    near = ipctk.NormalCollisions()
    near.build(mesh, points, gap)
    least = np.sqrt(near.compute_minimum_distance(mesh, points)) if len(near) else np.inf
    return ipctk.has_intersections(mesh, points), least


def main():
    print("| scene | triangles | crossings | depth | move / depth | volume | inverted | CPU s | left | IPC Toolkit |\n" + "|---" * 10 + "|")
    good = count = 0
    for name, make, gap in scenes():
        if sys.argv[2:] and not any(word in name for word in sys.argv[2:]):
            continue
        bodies = make()
        start = time.process_time()
        done = voxtet.resolve(bodies, gap=gap)
        seconds = time.process_time() - start
        meets, least = judge(bodies, done.positions, gap)
        free = not meets and least >= gap * (1 - 1e-6)
        good, count = good + free, count + 1
        volume = max((abs(after / before - 1) for before, after in done.volumes if before), default=0)
        print(f"| {name} | {sum(len(outside_of(c)) for _, c in bodies)} | {done.first_crossings} | {done.first_depth:.3g} | "
              f"{done.largest_move / done.first_depth if done.first_depth else np.nan:.2f} | {100 * volume:.2f} % | {sum(done.inverted_tets)} | "
              f"{seconds:.2f} | {done.crossings + done.inside_vertices + done.close_pairs} | {'free' if free else 'not free'} |", flush=True)
    print(f"\n{good} of {count} free")


main()
