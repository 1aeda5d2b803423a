"""Cells of finite elements as tetrahedra, and back: which cell a point is in, and its reference coordinates there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, NamedTuple, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]

AT_ONCE = 2048  # points whose numbers stay in the cache
STEPS = 30  # of Newton's method
TOLERANCE = 1e-12  # how far reference coordinates may leave a cell that contains the point: their rounding


@dataclass(frozen=True, eq=False)
class Shape:
    """A kind of cell as VTK describes it. `functions` takes reference coordinates (3, n), and gives the weights of the nodes
    (k, n) and their derivatives (3, k, n)."""

    name: str
    corners: Reals  # in reference coordinates, (c, 3)
    faces: tuple[tuple[int, ...], ...]  # counter-clockwise as seen from outside
    node_count: int
    functions: Callable[[Reals], tuple[Reals, Reals]]
    simplex: int  # so many of the first reference coordinates add up to at most 1


def _products(reference: Reals, corners: Reals) -> tuple[Reals, Reals]:
    """Each weight is a product of r or 1 - r, s or 1 - s, t or 1 - t."""
    factors = [np.where(corners[:, a, None] > 0, reference[a], 1 - reference[a]) for a in range(3)]
    slopes = np.where(corners.T > 0, 1.0, -1.0)[:, :, None]
    r, s, t = factors
    return r * s * t, np.stack([slopes[0] * (s * t), slopes[1] * (r * t), slopes[2] * (r * s)])


def _of_tet(reference: Reals) -> tuple[Reals, Reals]:
    r, s, t = reference
    slopes = np.array([[-1, 1, 0, 0], [-1, 0, 1, 0], [-1, 0, 0, 1]], float)
    return np.stack([1 - r - s - t, r, s, t]), np.repeat(slopes[:, :, None], len(r), axis=2)


_MIDDLES = np.array([[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]])  # the ends of the edges that nodes 4 to 9 are on


def _of_tet10(reference: Reals) -> tuple[Reals, Reals]:
    linear, slopes = _of_tet(reference)
    a, b = linear[_MIDDLES[:, 0]], linear[_MIDDLES[:, 1]]
    of_middles = 4 * (slopes[:, _MIDDLES[:, 0]] * b + slopes[:, _MIDDLES[:, 1]] * a)
    return (np.concatenate([linear * (2 * linear - 1), 4 * a * b]),
            np.concatenate([slopes * (4 * linear - 1), of_middles], axis=1))


def _of_wedge(reference: Reals) -> tuple[Reals, Reals]:
    r, s, t = reference
    triangle, up = np.stack([1 - r - s, r, s]), np.stack([1 - t, t])
    weights = (up[:, None] * triangle).reshape(6, -1)
    slopes = [(up[:, None] * np.array(d, float)[:, None]).reshape(6, -1) for d in ((-1, 1, 0), (-1, 0, 1))]
    return weights, np.stack([*slopes, np.concatenate([-triangle, triangle])])


def _of_pyramid(reference: Reals) -> tuple[Reals, Reals]:
    weights, slopes = _products(reference, _HEXAHEDRON[:4])
    apex = np.zeros_like(reference)
    apex[2] = 1
    return np.concatenate([weights, reference[2:]]), np.concatenate([slopes, apex[:, None]], axis=1)


_HEXAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
_TETRAHEDRON = np.concatenate([np.zeros((1, 3)), np.eye(3)])
_WEDGE = _HEXAHEDRON[[0, 1, 3, 4, 5, 7]]
_PYRAMID = np.concatenate([_HEXAHEDRON[:4], [[0.5, 0.5, 1]]])
_OF_TET = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))

TET = Shape("tetrahedron", _TETRAHEDRON, _OF_TET, 4, _of_tet, 3)
TET10 = Shape("quadratic tetrahedron", _TETRAHEDRON, _OF_TET, 10, _of_tet10, 3)
HEXAHEDRON = Shape("hexahedron", _HEXAHEDRON, ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)), 8,
                   lambda reference: _products(reference, _HEXAHEDRON), 0)
WEDGE = Shape("wedge", _WEDGE, ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)), 6, _of_wedge, 2)
PYRAMID = Shape("pyramid", _PYRAMID, ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)), 5, _of_pyramid, 0)


def split(shape: Shape, nodes: NDArray[Any]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Tetrahedra of cells of one shape with these nodes, (n, k): the cell of each and its corners, (m, 4), as indices into the
    cell's nodes; sorted by cell.

    Faces of four corners are split by the diagonal from their corner with the lowest number, so that neighbours agree, and
    each cell by joining its lowest corner with all faces that it is not on (J. Dompierre et al., How to subdivide pyramids,
    prisms, and hexahedra into tetrahedra, 1999). Tetrahedra with a corner twice, of collapsed cells, are left out."""
    corners = nodes[:, :len(shape.corners)]
    every = np.arange(len(nodes))
    if len(shape.corners) == 4:
        return every, np.tile(np.arange(4), (len(nodes), 1))
    lowest = corners.argmin(axis=1)
    cells, made = [np.empty(0, np.int64)], [np.empty((0, 4), np.int64)]
    for corner in range(len(shape.corners)):
        of_corner = every[lowest == corner]
        for face in (f for f in shape.faces if corner not in f):
            swapped = np.isin(corners[of_corner][:, face].argmin(axis=1), (1, 3)) if len(face) == 4 else np.zeros(len(of_corner), bool)
            for those, turned in ((of_corner[~swapped], face), (of_corner[swapped], (*face[1:], face[0]))):
                for second in range(1, len(face) - 1):
                    cells.append(those)
                    made.append(np.tile([corner, turned[0], turned[second], turned[second + 1]], (len(those), 1)))
    of_tet, local = np.concatenate(cells), np.concatenate(made)
    order = np.argsort(of_tet, kind="stable")
    of_tet, local = of_tet[order], local[order]
    four = np.sort(corners[of_tet[:, None], local], axis=1)
    whole = (four[:, 1:] != four[:, :-1]).all(axis=1)
    return of_tet[whole], local[whole]


def leaves(shape: Shape, reference: Reals) -> Reals:
    """How far reference coordinates (3, n) are outside of the cell; 0 or less inside."""
    far = np.maximum(-reference, reference - 1).max(axis=0)
    found: Reals = np.maximum(far, reference[:shape.simplex].sum(axis=0) - 1) if shape.simplex else far
    return found


def _cross(a: Reals, b: Reals) -> Reals:
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _dot(a: Reals, b: Reals) -> Reals:
    found: Reals = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return found


def invert(shape: Shape, nodes: Reals, points: Reals, start: Reals) -> Reals:
    """Reference coordinates (3, n) of points (3, n) in cells with nodes at (k, 3, n), by Newton's method. Where it finds none
    they are NaN. Those of one point depend on no other point."""
    found = np.full_like(start, np.nan)
    now, at, active = start.copy(), nodes - points, np.arange(points.shape[1])
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            weights, slopes = shape.functions(now)
            miss, columns = np.zeros_like(now), np.zeros((3, *now.shape))
            for node in range(shape.node_count):
                miss += weights[node] * at[node]
                for a in range(3):
                    columns[a] += slopes[a, node] * at[node]
            across = [_cross(columns[(a + 1) % 3], columns[(a + 2) % 3]) for a in range(3)]
            volume = _dot(columns[0], across[0])
            step = np.stack([_dot(normal, miss) / volume for normal in across])
            now = now - step
            far = np.abs(step).max(axis=0)
            near = far <= 1e-14  # the next step would be far below the rounding
            found[:, active[near]] = now[:, near]
            on = ~near & (np.abs(now).max(axis=0) < 1e3)
            now, at, active, far = now[:, on], at[:, :, on], active[on], far[on]
            if not len(active):
                break
        else:
            good = far <= 1e-9  # as near as the rounding of a thin cell lets it come
            found[:, active[good]] = now[:, good]
    return found


class Block(NamedTuple):
    """Cells of one shape: their indices in the mesh, and nodes (n, k)."""

    shape: Shape
    cells: NDArray[np.int64]
    nodes: NDArray[np.int64]


class Cells:
    """The cells that the tetrahedra of a mesh are parts of."""

    def __init__(self, positions: NDArray[Any], tets: NDArray[Any], blocks: Sequence[Block], of_tet: NDArray[Any],
                 local: NDArray[Any]) -> None:
        self.positions, self.tets, self.blocks, self.of_tet, self.local = positions, tets, blocks, of_tet, local
        self.bent = any(block.shape is not TET for block in blocks)
        count = 1 + max((int(block.cells.max()) for block in blocks if len(block.cells)), default=-1)
        self.block, self.row = np.full(count, -1, np.int64), np.zeros(count, np.int64)
        for number, block in enumerate(blocks):
            self.block[block.cells], self.row[block.cells] = number, np.arange(len(block.cells))
        extents = [np.ptp(positions[block.nodes], axis=1).max() for block in blocks if len(block.cells)] if self.bent else []
        self.reach = float(max(extents, default=0))  # no face is curved so far
        self._beside: Optional[tuple[NDArray[Any], NDArray[Any]]] = None

    def _each(self, cells: NDArray[Any]) -> Any:
        """(block, which of the cells are of it, their nodes (m, k))."""
        kinds = self.block[cells]
        for number, block in enumerate(self.blocks):
            those = np.flatnonzero(kinds == number)
            if len(those):
                yield block.shape, those, block.nodes[self.row[cells[those]]]

    def _inverted(self, cells: NDArray[Any], points: Reals, start: Reals) -> tuple[Reals, Reals]:
        """Reference coordinates (n, 3) of points in cells, and how far they are outside of these; infinite if there are none."""
        reference, far = start.copy(), np.full(len(cells), np.inf)
        parts = range(0, len(cells), AT_ONCE)
        for begin, (shape, those, nodes) in ((b, each) for b in parts for each in self._each(cells[b:b + AT_ONCE])):
            at = self.positions[nodes.T].astype(np.float64).transpose(0, 2, 1)
            those = those + begin
            found = invert(shape, np.ascontiguousarray(at), points[those].T, start[those].T)
            there = np.isfinite(found).all(axis=0)
            reference[those[there]] = found[:, there].T
            far[those[there]] = leaves(shape, found[:, there])
        return reference, far

    def _neighbours(self, cells: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Pairs (index into cells, a cell with a corner in common), each once, sorted."""
        if self._beside is None:
            parts = [(np.repeat(b.cells, len(b.shape.corners)), b.nodes[:, :len(b.shape.corners)].ravel()) for b in self.blocks]
            owner, vertex = (np.concatenate(p) for p in zip(*parts))
            order = np.argsort(vertex, kind="stable")
            self._beside = np.searchsorted(vertex[order], np.arange(len(self.positions) + 1)), owner[order]
        first, owner = self._beside
        pairs = [np.empty(0, np.int64)]
        for shape, those, nodes in self._each(cells):
            corners = nodes[:, :len(shape.corners)].ravel()
            count = first[corners + 1] - first[corners]
            asked = np.repeat(np.repeat(those, len(shape.corners)), count)
            begin = np.cumsum(count) - count
            found = owner[np.repeat(first[corners] - begin, count) + np.arange(len(asked))]
            pairs.append(asked * len(self.block) + found)
        unique = np.unique(np.concatenate(pairs))
        return unique // len(self.block), unique % len(self.block)

    def answer(self, points: Reals, tet: NDArray[Any], weights: Reals) -> tuple[NDArray[np.int64], Reals, NDArray[np.bool_]]:
        """For points in tetrahedra, (n,), or near them: the cell, reference coordinates (n, 3), and whether the cell, with its
        curved faces, contains the point. If the cell of the tetrahedron does not, but a neighbour does, it is the lowest such."""
        cells = self.of_tet[tet]
        start = np.empty((len(tet), 3))
        for shape, those, _ in self._each(cells):
            corners = shape.corners[self.local[tet[those]]]
            start[those] = sum(weights[those, i, None] * corners[:, i] for i in range(4))
            if shape is PYRAMID:
                start[those, 2] = np.minimum(start[those, 2], 1 - 1e-9)  # the apex has no unique coordinates
        reference, far = self._inverted(cells, points, start)
        cells = cells.copy()
        for begin in range(0, len(tet), 1 << 16):
            self._move(np.flatnonzero(far[begin:begin + (1 << 16)] > TOLERANCE) + begin, cells, points, reference, far)
        return cells, reference, far <= TOLERANCE

    def _move(self, out: NDArray[Any], cells: NDArray[Any], points: Reals, reference: Reals, far: Reals) -> None:
        """Gives the points `out`, which are outside of their cells, to neighbours that contain them."""
        asked, beside = self._neighbours(cells[out])
        near = np.zeros(len(asked), np.bool_)
        for shape, those, nodes in self._each(beside):
            at = self.positions[nodes]
            low, high = at.min(axis=1), at.max(axis=1)
            point = points[out[asked[those]]]
            room = (0.25 if shape is TET10 else 1e-9) * (high - low)  # others are in the hull of their nodes
            near[those] = ((point >= low - room) & (point <= high + room)).all(axis=1)
        asked, beside = asked[near], beside[near]
        found, outside = self._inverted(beside, points[out[asked]], np.full((len(asked), 3), 0.3))
        asked, beside, found, outside = (a[outside <= TOLERANCE] for a in (asked, beside, found, outside))
        taken, first = np.unique(asked, return_index=True)
        cells[out[taken]], reference[out[taken]], far[out[taken]] = beside[first], found[first], outside[first]

    def interpolation(self, cells: NDArray[Any], reference: Reals) -> tuple[NDArray[np.int64], Reals]:
        """The nodes of each cell and their weights at these reference coordinates, (n, k); weight 0 where a cell has fewer."""
        width = max(block.shape.node_count for block in self.blocks)
        nodes, weights = np.zeros((len(cells), width), np.int64), np.zeros((len(cells), width))
        for shape, those, of_those in self._each(cells):
            nodes[those, :shape.node_count] = of_those
            nodes[those, shape.node_count:] = of_those[:, :1]
            weights[those, :shape.node_count] = shape.functions(reference[those].T)[0].T
        return nodes, weights
