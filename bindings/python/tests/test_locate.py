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
                        np.testing.assert_allclose(shape.functions(r[:, None])[0][:, 0], weights, atol=1e-15)

    def vtk_cell(self, shape, nodes):
        cell = getattr(vtk, VTK[shape][0])()
        for i, node in enumerate(nodes):
            cell.GetPoints().SetPoint(i, node)
        return cell


if __name__ == "__main__":
    unittest.main()
