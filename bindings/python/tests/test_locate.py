"""Locations in double, outside of meshes, and in cells that are no tetrahedra; tracks."""

import unittest

import numpy as np

import voxtet
from support import box
from voxtet import cells as shapes
from voxtet.cells import HEXAHEDRON, PYRAMID, TET, TET10, WEDGE, split

try:
    import vtkmodules.vtkCommonDataModel as vtk
    from vtkmodules.vtkCommonCore import reference
except ImportError:
    vtk = None

VTK = {HEXAHEDRON: ("vtkHexahedron", 12), WEDGE: ("vtkWedge", 13), PYRAMID: ("vtkPyramid", 14), TET10: ("vtkQuadraticTetra", 24)}
WEIGHTS = {  # of the nodes at (0.3, 0.2, 0.4), by VTK's EvaluateLocation
    HEXAHEDRON: [.336, .144, .036, .084, .224, .096, .024, .056],
    WEDGE: [.3, .18, .12, .2, .12, .08],
    PYRAMID: [.336, .144, .036, .084, .4],
    TET10: [-.08, -.12, -.12, -.08, .12, .24, .08, .16, .48, .32],
}
NAMES = {HEXAHEDRON: "hexahedron", WEDGE: "wedge", PYRAMID: "pyramid", TET10: "tetra10", TET: "tetra"}


class Mesh:
    """As meshio has it."""

    def __init__(self, points, blocks):
        self.points = np.asarray(points, float)
        self.cells_dict = {name: np.asarray(nodes) for name, nodes in blocks.items()}


def nodes_of(shape):
    """Of the reference cell."""
    corners = shape.corners
    if shape is PYRAMID:
        return corners
    return corners if shape is not TET10 else np.concatenate([corners, corners[shapes._MIDDLES].mean(axis=1)])


def slabs(n=3):
    """Hexahedra, then wedges and pyramids on top, that meet in whole faces."""
    random = np.random.default_rng(8)
    lattice = np.stack(np.meshgrid(*[np.arange(n + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    inner = ((lattice > 0) & (lattice < n)).all(axis=1)
    points = lattice / n + random.uniform(-0.2, 0.2, lattice.shape) / n * inner[:, None]
    hexahedra, wedges, pyramids, middles = [], [], [], []
    for cell in np.ndindex(n, n, n):
        c = [int(np.dot(np.add(cell, c).astype(int), ((n + 1)**2, n + 1, 1))) for c in HEXAHEDRON.corners]
        if cell[0] == 0:  # columns along z, split alike
            wedges += [[c[i] for i in w] for w in ((0, 1, 3, 4, 5, 7), (1, 2, 3, 5, 6, 7))]
        elif cell[0] == 1:
            hexahedra.append(c)
        else:
            middles.append(points[c].mean(axis=0))
            pyramids += [[c[i] for i in reversed(face)] + [len(points) + len(middles) - 1] for face in HEXAHEDRON.faces]
    points = np.concatenate([points, middles])
    order = random.permutation(len(points))
    return Mesh(points[np.argsort(order)], {"hexahedron": order[hexahedra], "wedge": order[wedges], "pyramid": order[pyramids]})


def volumes(points, tets):
    return np.linalg.det(points[tets[:, 1:]] - points[tets[:, :1]]) / 6


class Splits(unittest.TestCase):
    def test_volumes_and_faces(self):
        """The tetrahedra fill each cell and the whole, and have all inner facets in common."""
        mesh = slabs()
        tets = []
        for name, shape in (("hexahedron", HEXAHEDRON), ("wedge", WEDGE), ("pyramid", PYRAMID)):
            nodes = mesh.cells_dict[name]
            of_tet, local = split(shape, nodes)
            self.assertEqual(len(of_tet), len(nodes) * {"hexahedron": 6, "wedge": 3, "pyramid": 2}[name])
            tets.append(nodes[of_tet[:, None], local])
            self.assertTrue((volumes(mesh.points, tets[-1]) > 0).all())
        tets = np.concatenate(tets)
        self.assertAlmostEqual(volumes(mesh.points, tets).sum(), 1, places=13)
        facets = np.sort(tets[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]], axis=2).reshape(-1, 3)
        unique, count = np.unique(facets, axis=0, return_counts=True)
        self.assertEqual(count.max(), 2)
        flat = [(np.isclose(mesh.points[facet][:, axis], side)).all() for facet in unique[count == 1]
                for axis in range(3) for side in (0, 1)]
        self.assertEqual(np.reshape(flat, (-1, 6)).any(axis=1).sum(), (count == 1).sum())  # all on the cube's sides

    def test_every_lowest_corner_and_collapsed_cells(self):
        for shape in (HEXAHEDRON, WEDGE, PYRAMID):
            volume = {"hexahedron": 1, "wedge": 1 / 2, "pyramid": 1 / 3}[shape.name]
            for seed in range(40):
                order = np.random.default_rng(seed).permutation(len(shape.corners))
                of_tet, local = split(shape, order[None])
                np.testing.assert_array_less(0, volumes(shape.corners, local))
                self.assertAlmostEqual(volumes(shape.corners, local).sum(), volume)
        collapsed = np.array([[0, 1, 2, 2, 4, 5, 6, 6]])  # a wedge
        self.assertEqual(len(split(HEXAHEDRON, collapsed)[0]), 3)

    def test_warnings(self):
        with self.assertWarnsRegex(voxtet.MeshWarning, "9 cells were split into 54 tets: hexahedron"), voxtet.Grid() as grid:
            self.assertEqual(grid.add(slabs()).info.tet_count, 54 + 18 * 3 + 54 * 2)


class InCells(unittest.TestCase):
    def moved(self, shape, seed):
        random = np.random.default_rng(seed)
        nodes = nodes_of(shape) + random.uniform(-0.08, 0.08, (shape.node_count, 3))
        return nodes @ random.uniform(-1, 1, (3, 3)) + random.uniform(-2, 2, 3)

    def inside(self, shape, count, seed):
        random = np.random.default_rng(seed)
        reference = random.random((20 * count, 3)) * 0.98 + 0.01
        return reference[shapes.leaves(shape, reference.T) < -0.01][:count]

    def test_reference_coordinates(self):
        """Those of a point that was made from them, by VTK where it is installed, come back to 1e-12."""
        for shape in VTK:
            for seed in range(20):
                nodes, wanted = self.moved(shape, seed), self.inside(shape, 50, seed)
                points = np.einsum("kn,kx->nx", shape.functions(wanted.T)[0], nodes)
                found = voxtet.locate(points, Mesh(nodes, {NAMES[shape]: [np.arange(len(nodes))]}))
                inside = found.cell == 0
                self.assertGreater(inside.sum(), 45)  # others lie outside of the cell's nodes
                np.testing.assert_allclose(found.reference[inside], wanted[inside], atol=1e-12, rtol=0)
                if vtk:
                    cell = self.vtk_cell(shape, nodes)
                    for r, p in zip(wanted[:5], points):
                        x, weights = [0.0] * 3, [0.0] * len(nodes)
                        cell.EvaluateLocation(reference(0), r, x, weights)
                        np.testing.assert_allclose(x, p, atol=1e-14)

    def test_weights_of_nodes_are_those_of_vtk(self):
        for shape, stored in WEIGHTS.items():
            np.testing.assert_allclose(shape.functions(np.array([[0.3], [0.2], [0.4]]))[0][:, 0], stored, atol=1e-15)

    def test_evaluate_position(self):
        """In cells with flat faces. In others VTK stops its iteration at about 1e-9."""
        if not vtk:
            self.skipTest("there is no vtk")
        for shape in (HEXAHEDRON, WEDGE, PYRAMID):
            nodes = nodes_of(shape) @ np.array([[2, 0.3, 0.1], [0.2, 1, -0.4], [0, 0.5, 3]]) + 1
            points = np.einsum("kn,kx->nx", shape.functions(self.inside(shape, 40, 1).T)[0], nodes)
            found, cell = voxtet.locate(points, Mesh(nodes, {NAMES[shape]: [np.arange(len(nodes))]})), self.vtk_cell(shape, nodes)
            for point, mine in zip(points, found.reference):
                theirs, weights = [0.0] * 3, [0.0] * len(nodes)
                self.assertEqual(cell.EvaluatePosition(point, [0.0] * 3, reference(0), theirs, reference(0.0), weights), 1)
                np.testing.assert_allclose(mine, theirs, atol=1e-12)

    def test_no_point_is_lost(self):
        """Also on faces that are not flat, whose points are in either of two cells; and each cell has those that it should."""
        mesh = slabs()
        random = np.random.default_rng(2)
        points = [random.random((2000, 3)), mesh.points]
        for name, shape in (("hexahedron", HEXAHEDRON), ("wedge", WEDGE), ("pyramid", PYRAMID)):
            nodes = mesh.points[mesh.cells_dict[name]]
            for face in shape.faces:
                points += [nodes[:, face].mean(axis=1), nodes[:, face[:2]].mean(axis=1)]
        points = np.concatenate(points).clip(0, 1)
        locator = voxtet.Locator(mesh)
        found = locator.locate(points)
        self.assertTrue((found.state == voxtet.LocationState.INSIDE).all())
        self.assertTrue((found.tet == found.cell).all())
        blocks = [(shape, mesh.cells_dict[NAMES[shape]]) for shape in (HEXAHEDRON, WEDGE, PYRAMID)]
        first = 0
        for shape, nodes in blocks:
            here = (found.cell >= first) & (found.cell < first + len(nodes))
            r = found.reference[here].T
            self.assertLess(shapes.leaves(shape, r).max(), 1e-11)
            weights = shape.functions(r)[0]
            np.testing.assert_allclose(np.einsum("kn,nkx->nx", weights, mesh.points[nodes[found.cell[here] - first]]), points[here],
                                       atol=1e-14)
            first += len(nodes)
        order = random.permutation(len(points))
        again = locator.locate(points[order])
        np.testing.assert_array_equal(again.cell, found.cell[order])
        np.testing.assert_array_equal(again.reference, found.reference[order])

    def test_outside(self):
        mesh, points = slabs(), np.random.default_rng(3).random((500, 3)) * 1.6 - 0.3
        locator = voxtet.Locator(mesh)
        out = ((points < 0) | (points > 1)).any(axis=1)
        nearest = locator.locate(points, outside="nearest")
        np.testing.assert_array_equal(nearest.state == voxtet.LocationState.OUTSIDE, out)
        distance = np.linalg.norm(points - points.clip(0, 1), axis=1)
        np.testing.assert_allclose(nearest.distance, distance, atol=1e-15)
        np.testing.assert_array_equal(locator.locate(points).cell, np.where(out, -1, nearest.cell))
        near = locator.locate(points, outside="nearest", max_distance=0.1)
        np.testing.assert_array_equal(near.cell >= 0, distance <= 0.1)
        values = mesh.points @ [1, 2, 3]
        np.testing.assert_allclose(voxtet.Transfer(locator, points) @ values, points.clip(0, 1) @ [1, 2, 3], atol=1e-14)
        np.testing.assert_allclose(voxtet.Transfer(locator, points, "extrapolate") @ values, points @ [1, 2, 3], atol=1e-12)

    def test_curved_tetrahedra(self):
        """A point in a bulge beyond the corners' tetrahedron is inside, and one between two cells is in the one that has it."""
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
        tens, nodes = [[0, 1, 2, 3], [1, 4, 2, 3]], list(corners)
        number = {}
        for ten in tens:
            for a, b in shapes._MIDDLES:
                pair = frozenset((ten[a], ten[b]))
                if pair not in number:
                    number[pair] = len(nodes)
                    nodes.append((corners[ten[a]] + corners[ten[b]]) / 2 + (0.1 if pair == {1, 2} else -0.03 if 0 in pair else 0))
                ten.append(number[pair])
        nodes = np.array(nodes)
        locator = voxtet.Locator(Mesh(nodes, {"tetra10": tens}))
        reference = self.inside(TET10, 3000, 9)
        for cell, ten in enumerate(tens):
            found = locator.locate(np.einsum("kn,kx->nx", TET10.functions(reference.T)[0], nodes[ten]))
            np.testing.assert_array_equal(found.cell, cell)
            np.testing.assert_allclose(found.reference, reference, atol=1e-12)
        moved = locator.locate(np.einsum("kn,kx->nx", TET10.functions(reference.T)[0], nodes[tens[0]]))
        self.assertTrue({0, 1} <= set(moved.tet))

    def vtk_cell(self, shape, nodes):
        cell = getattr(vtk, VTK[shape][0])()
        for i, node in enumerate(nodes):
            cell.GetPoints().SetPoint(i, node)
        return cell


class InTetrahedra(unittest.TestCase):
    def setUp(self):
        self.positions, self.tets = box(4, dtype=np.float64)
        self.locator = voxtet.Locator(self.positions, self.tets)

    def test_vertices_edges_and_facets(self):
        """All are found, in the lowest tetrahedron that has them, in any order. Corners are multiples of 1/4, weights of 1/4."""
        corners = self.positions[self.tets]
        points = np.concatenate([self.positions, *((corners[:, a] + 3 * corners[:, b]) / 4 for a, b in shapes._MIDDLES),
                                 *((corners[:, f[0]] + corners[:, f[1]] + 2 * corners[:, f[2]]) / 4 for f in TET.faces)])
        found = self.locator.locate(points)
        weights = np.linalg.solve(np.concatenate([corners, np.ones((len(corners), 4, 1))], axis=2).transpose(0, 2, 1)[None],
                                  np.concatenate([points, np.ones((len(points), 1))], axis=1)[:, None, :, None])[..., 0]
        np.testing.assert_array_equal(found.tet, (weights > -1e-9).all(axis=2).argmax(axis=1))
        self.assertTrue((found.state == voxtet.LocationState.INSIDE).all())
        order = np.random.default_rng(1).permutation(len(points))
        for mine, again in zip(found, self.locator.locate(points[order])):
            np.testing.assert_array_equal(mine[order], again)
        hits = self.locator.find_point_hits(points)
        np.testing.assert_array_equal(hits.point, np.arange(len(points)))  # none is doubled
        np.testing.assert_array_equal(hits.weights, found.weights)

    def test_outside(self):
        points = np.random.default_rng(2).random((400, 3)) * 3 - 1
        out = ((points < 0) | (points > 1)).any(axis=1)
        none, nearest, extrapolated = (self.locator.locate(points, outside=o) for o in ("none", "nearest", "extrapolate"))
        np.testing.assert_array_equal(none.tet, np.where(out, -1, nearest.tet))
        self.assertFalse(none.weights[out].any() or none.body[out].any() or none.distance.any())
        np.testing.assert_array_equal(extrapolated.tet, nearest.tet)
        np.testing.assert_array_equal(nearest.state, np.where(out, voxtet.LocationState.OUTSIDE, voxtet.LocationState.INSIDE))
        at = np.einsum("nc,ncx->nx", nearest.weights, self.positions[self.tets[nearest.tet]])
        np.testing.assert_allclose(at, points.clip(0, 1), atol=1e-15)
        np.testing.assert_allclose(nearest.distance, np.linalg.norm(points - points.clip(0, 1), axis=1), rtol=1e-15)
        at = np.einsum("nc,ncx->nx", extrapolated.weights, self.positions[self.tets[nearest.tet]])
        np.testing.assert_allclose(at, points, atol=1e-14)
        near = self.locator.locate(points, outside="nearest", max_distance=0.5)
        np.testing.assert_array_equal(near.tet >= 0, nearest.distance <= 0.5)
        np.testing.assert_array_equal(nearest.reference, nearest.weights[:, 1:])
        self.assertEqual(self.locator.locate(points, mask=2).state.sum(), 0)
        for wrong in ({"outside": "far"}, {"outside": "nearest", "max_distance": -1}):
            with self.assertRaises(ValueError):
                self.locator.locate(points, **wrong)

    def test_tracks(self):
        random = np.random.default_rng(4)
        start = np.concatenate([random.random((200, 3)) * 3 - 1, [[-1, 0.5, 0.5], [5, 5, 5], [0, 0, 0]]])
        end = np.concatenate([random.random((200, 3)) * 3 - 1, [[2, 0.5, 0.5], [6, 6, 6], [1, 1, 1]]])
        offsets, tet, t_in, t_out = voxtet.tracks(start, end, self.positions, self.tets)
        self.assertEqual((len(offsets), offsets[0], offsets[-1]), (204, 0, len(tet)))
        step = end - start
        with np.errstate(divide="ignore"):
            sides = np.sort([(0 - start) / step, (1 - start) / step], axis=0)
        inside = np.maximum(sides[1].min(axis=1).clip(0, 1) - sides[0].max(axis=1).clip(0, 1), 0)
        for i in range(len(start)):
            part = slice(offsets[i], offsets[i + 1])
            np.testing.assert_array_equal(t_in[part][1:], t_out[part][:-1])
            self.assertAlmostEqual((t_out[part] - t_in[part]).sum(), inside[i], places=12)
        segment = np.repeat(np.arange(len(start)), np.diff(offsets))
        middles = start[segment] + ((t_in + t_out) / 2)[:, None] * step[segment]
        inner = segment < 200
        np.testing.assert_array_equal(self.locator.locate(middles[inner]).tet, tet[inner])
        pieces = self.locator.find_tracks(start, end)
        np.testing.assert_array_equal(pieces.tet, tet)
        self.assertEqual(pieces.facet_in[0] == voxtet.NONE, bool(t_in[0] == 0))

    def test_instruments(self):
        axis = self.locator.find_closest_to_segments([[-5, 0, 0], [9, 9, 9]], [[5, 0, 0], [9, 9, 8]])
        self.assertEqual(axis.distance[0], 0)
        self.assertGreater(axis.distance[1], 0)
        near = self.locator.find_closest_to_segments([9, 9, 9], [9, 9, 8], max_distance=0.5)
        self.assertEqual(near.body[0], 0)
        needle = [[-5, 0.01, 0.02], [5, 0.03, 0.01], [5, 0.03, 0.01]]
        hits = self.locator.find_triangle_hits(needle)
        pieces = self.locator.find_tracks(needle[0], needle[1])
        np.testing.assert_array_equal(np.unique(hits.tet), np.unique(pieces.tet))
        pushed = self.locator.find_triangle_hits([needle[0]] * 3, needle)
        np.testing.assert_array_equal(np.unique(pushed.tet), np.unique(hits.tet))
        self.assertTrue((np.diff(pushed.t) >= 0).all() and pushed.t[0] > 0)
        with self.assertRaises(ValueError):
            self.locator.find_triangle_hits(needle[:2])

    def test_tracks_in_cells(self):
        """Those of a cell that was split are joined."""
        offsets, cell, t_in, t_out = voxtet.tracks([[-1, 0.3, 0.4]], [[3, 0.3, 0.4]], Mesh(
            np.concatenate([HEXAHEDRON.corners, HEXAHEDRON.corners[[1, 2, 5, 6]] + [1, 0, 0]]),
            {"hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7], [1, 8, 9, 2, 5, 10, 11, 6]]}))
        self.assertEqual((offsets.tolist(), cell.tolist(), t_in.tolist(), t_out.tolist()), ([0, 2], [0, 1], [0.25, 0.5], [0.5, 0.75]))


if __name__ == "__main__":
    unittest.main()
