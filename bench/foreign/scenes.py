"""Scenes for grids that are not ours, made of lattices and random points: anybody gets the same ones.

A scene has one body, which meets itself, or two. `scale` multiplies the number of primitives."""

from __future__ import annotations

import dataclasses
from typing import Optional

import numpy as np

# The six tetrahedra of a cube around its diagonal; corner x + 2 y + 4 z.
KUHN = np.array([[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]])


@dataclasses.dataclass
class Body:
    vertices: np.ndarray  # [n, 3] float64
    tets: np.ndarray  # [m, 4] int32

    def moved(self, offset):
        return Body(self.vertices + offset, self.tets)


@dataclasses.dataclass
class Scene:
    name: str
    title: str
    bodies: list  # one, or two
    points: Optional[np.ndarray] = None  # of a cloud, [n, 3]; then there are no bodies

    def is_cloud(self):
        return self.points is not None


def compact(vertices, tets):
    used, renumbered = np.unique(tets, return_inverse=True)
    return Body(np.ascontiguousarray(vertices[used]), np.ascontiguousarray(renumbered.reshape(-1, 4).astype(np.int32)))


def lattice(shape, keep=None, jitter=0.18, seed=1):
    """Cubes of edge 1, six tetrahedra each, of those whose centre `keep` accepts; vertices moved at random."""
    counts = np.array(shape) + 1
    axes = np.meshgrid(*(np.arange(n) for n in counts), indexing="ij")
    vertices = np.stack([axis.ravel() for axis in axes], 1).astype(float)
    corner = np.arange(counts.prod()).reshape(counts)
    corners = np.stack([corner[x:x + shape[0], y:y + shape[1], z:z + shape[2]].ravel()
                        for z in (0, 1) for y in (0, 1) for x in (0, 1)], 1)
    if keep is not None:
        corners = corners[keep(vertices[corners[:, 0]] + 0.5)]
    vertices += np.random.default_rng(seed).uniform(-jitter, jitter, vertices.shape)
    return compact(vertices, corners[:, KUHN].reshape(-1, 4))


def ball(across, seed=1):
    """A ball of `across` cubes, its centre at 0, turned anyhow."""
    across = round(across)
    body = lattice([across] * 3, lambda c: ((c - across / 2) ** 2).sum(1) <= (across / 2) ** 2, seed=seed)
    return turned(body.moved(-across / 2), seed)


def joined(bodies):
    first = np.cumsum([0] + [len(b.vertices) for b in bodies[:-1]])
    return Body(np.concatenate([b.vertices for b in bodies]),
                np.concatenate([b.tets + np.int32(f) for b, f in zip(bodies, first)]))


def turned(body, seed):
    """By an arbitrary rotation, so that no lattice lies along that of a grid: with it, some cell sizes would fit
    particularly well."""
    axes, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return Body(np.ascontiguousarray(body.vertices @ axes.T), body.tets)


def coil(scale):
    """A bar wound up so that neighbouring turns touch."""
    side = max(round(5 * scale ** (1 / 3)), 2)
    length = round(scale * 160 * 25 / side ** 2)
    body = lattice([side, side, length])
    x, y, z = body.vertices.T
    radius = length / (2 * np.pi * 3)  # three turns
    angle = z / radius
    out = radius + x - side / 2
    return Body(np.stack([out * np.cos(angle), out * np.sin(angle), y + 0.97 * side * angle / (2 * np.pi)], 1), body.tets)


def sheets(scale):
    """Two waving sheets, one tetrahedron thick, through each other."""
    side = round(44 * scale ** 0.5)
    both = []
    for k in (0, 1):
        body = lattice([side, side, 1], seed=2 + k)
        x, y, z = body.vertices.T
        both.append(Body(np.stack([x + 0.37 * k, y + 0.21 * k, 0.35 * z + (1 - 2 * k) * 1.5 * np.sin(x / 5 + k) * np.cos(y / 7)], 1),
                         body.tets))
    return both


def pile(scale):
    """Small balls in random order, each in light contact with some others."""
    rng = np.random.default_rng(5)
    across, side = 5, max(round(4 * scale ** (1 / 3)), 2)
    places = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)
    return joined([ball(across, seed=10 + i).moved(0.93 * across * place + rng.uniform(-.4, .4, 3))
                   for i, place in enumerate(rng.permutation(places))])


def graded(scale):
    """Cubes whose sides grow sevenfold along each axis; two of them, the fine corners together."""
    side = round(13 * scale ** (1 / 3))
    body = lattice([side] * 3)
    grown = side * np.expm1(2 * body.vertices / side) / np.expm1(2)
    first = Body(grown, body.tets)
    return [first, Body(-grown + 0.3 * side, body.tets)]


def stretched(scale):
    """Balls of tetrahedra four times as long as wide, half in each other."""
    first, second = (ball(16 * scale ** (1 / 3), seed) for seed in (1, 2))
    return [Body(body.vertices * [1, 1, 4], body.tets) for body in (first, second.moved([0, 8 * scale ** (1 / 3), 0]))]


def meshes(scale=1.0):
    """Scenes of tetrahedra, about 30,000 at scale 1."""
    size = scale ** (1 / 3)
    across = round(17 * size)
    fine = round(19 * size)
    coarse = lattice([round(9 * size), round(9 * size), round(5 * size)], seed=8)
    coarse = Body(3 * coarse.vertices, coarse.tets)
    top = coarse.vertices.max(0)
    found = [
        Scene("light", "two balls in light contact", [ball(across), ball(across, 2).moved([0.93 * across, 1.3, 0.7])]),
        Scene("half", "two balls, half overlap", [ball(across), ball(across, 2).moved([0.35 * across, 0.4, 0.3])]),
        Scene("unlike", "a ball in a block three times as coarse", [coarse, ball(fine).moved([0.5 * top[0], 0.4 * top[1], 0.8 * top[2]])]),
        Scene("coil", "a coil that meets itself", [coil(scale)]),
        Scene("sheets", "two thin sheets", sheets(scale)),
        Scene("pile", "a pile of small balls", [pile(scale)]),
        Scene("graded", "sizes that grow sevenfold", graded(scale)),
        Scene("stretched", "tetrahedra four times as long as wide", stretched(scale)),
    ]
    for scene in found:
        scene.bodies = [turned(body, 4) for body in scene.bodies]
    return found


def clouds(scale=1.0):
    """Scenes of points, about 20,000 at scale 1."""
    rng = np.random.default_rng(7)
    n = round(20000 * scale)
    directions = rng.normal(size=(n, 3))
    scan = directions / np.linalg.norm(directions, axis=1)[:, None] * (1 + 0.002 * rng.normal(size=(n, 1)))
    clusters = rng.uniform(0, 1, (12, 3))[rng.integers(0, 12, n)] + 0.06 * rng.normal(size=(n, 3))
    # Rings at equal angles from a scanner above a rolling ground: dense near it, thin far away.
    angle = rng.uniform(0, 2 * np.pi, n)
    far = 2 / np.tan(rng.uniform(0.05, 0.8, n))
    ground = np.stack([far * np.cos(angle), far * np.sin(angle), 0.3 * np.sin(far) + 0.01 * rng.normal(size=n)], 1)
    return [Scene(name, title, [], np.ascontiguousarray(points)) for name, title, points in (
        ("volume", "points anywhere in a cube", rng.uniform(0, 1, (n, 3))),
        ("sphere", "points on a sphere", scan),
        ("clusters", "points in clusters", clusters),
        ("ground", "a scan of a ground", ground))]


class Generated:
    """All scenes, `scale` times the usual number of primitives."""
    some = ("half", "coil", "graded")  # whose vertices are clouds too

    def __init__(self, scale=1.0):
        self.scale = scale

    def meshes(self, part=1.0):
        return meshes(part * self.scale)

    def clouds(self):
        return clouds(self.scale)


class Real:
    """Each mesh of a folder (.msh, version 2.2, text, at most 60,000 tetrahedra) against itself, moved by a third of its
    longest side. To check what was found in generated scenes."""
    some = ("bunny",)
    most = 60000

    def __init__(self, folder):
        import glob
        import os
        self.found = []
        for path in sorted(glob.glob(os.path.join(folder, "*.msh"))):
            body = read_msh(path)
            if body and len(body.tets) <= self.most:
                extent = body.vertices.max(0) - body.vertices.min(0)
                other = body.moved(np.where(extent == extent.max(), extent / 3, 0))
                self.found.append(Scene(os.path.splitext(os.path.basename(path))[0], path, [body, other]))

    def meshes(self, part=1.0):
        """part: a slice with so many of the tetrahedra."""
        return [Scene(s.name, s.title, [sliced(body, part) for body in s.bodies]) for s in self.found]

    def clouds(self):
        return [Scene(s.name, s.title, [], s.bodies[0].vertices) for s in self.found]


def sliced(body, part):
    axis = np.ptp(body.vertices, axis=0).argmin()
    along = body.vertices[body.tets, axis].mean(1)
    return compact(body.vertices, body.tets[along <= np.quantile(along, part)])


def read_msh(path):
    """None if it is of another version, or binary."""
    with open(path, encoding="utf-8", errors="replace") as file:
        words = file.read().split()
    if words[:4] != ["$MeshFormat", "2.2", "0", "8"]:
        return None
    at = words.index("$Nodes") + 1
    count = int(words[at])
    nodes = np.array(words[at + 1:at + 1 + 4 * count]).reshape(count, 4)
    number = {name: i for i, name in enumerate(nodes[:, 0])}
    at = words.index("$Elements") + 2
    tets = []
    corners = {"1": 2, "2": 3, "4": 4, "15": 1}
    for _ in range(int(words[at - 1])):
        first = at + 3 + int(words[at + 2])
        after = first + corners[words[at + 1]]
        if words[at + 1] == "4":
            tets.append([number[name] for name in words[first:after]])
        at = after
    return compact(nodes[:, 1:].astype(float), np.array(tets)) if tets else None


def edges_of(tets):
    pairs = np.sort(tets[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]].reshape(-1, 2), axis=1)
    return np.unique(pairs, axis=0)


def mean_edge(body):
    edges = edges_of(body.tets)
    return float(np.linalg.norm(body.vertices[edges[:, 0]] - body.vertices[edges[:, 1]], axis=1).mean())


def surface(body):
    """The facets of only one tetrahedron: vertices, edges, faces."""
    facets = body.tets[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3)
    _, first, count = np.unique(np.sort(facets, axis=1), axis=0, return_index=True, return_counts=True)
    faces = facets[first[count == 1]]
    used, renumbered = np.unique(faces, return_inverse=True)
    faces = renumbered.reshape(-1, 3).astype(np.int32)
    edges = np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0).astype(np.int32)
    return body.vertices[used], edges, faces


def cloud_spacing(points):
    """The mean distance of a point to its six nearest: what an edge is in a mesh of them. From 500 of the points."""
    some = points[np.random.default_rng(3).choice(len(points), min(500, len(points)), replace=False)]
    squares = np.concatenate([np.sort(((points - p) ** 2).sum(1))[1:7] for p in some])
    return float(np.sqrt(squares).mean())
