"""Grids that are not ours, on the scenes: each case is one of them on one scene, described as vox_foreign_grid does, and
can be run at any cell size. Functions NAME_cases(library, source): library is that of plain_grids.cpp, source of scenes.py."""

from __future__ import annotations

import ctypes
import dataclasses
import functools
from typing import Callable, Optional

import numpy as np

import losses
import scenes

STORED_BOX, STORED_CENTRE = 1, 2  # vox_cells_stored
BOX, AROUND, PAIRS = 1, 2, 3  # vox_cells_queried
POINT, EDGE, TRIANGLE, TET, BOX_TYPE = range(5)  # vox_primitive_type
_, SORTED, HASHED, WARP, IPC, IPC_PAIRS, VTK, PBAT, POINT_VOXELS, NUMPY = range(len(losses.KNOWN))


@dataclasses.dataclass
class Primitives:
    """As vox_primitives."""
    type: int
    positions: np.ndarray
    indices: Optional[np.ndarray] = None
    radii: Optional[np.ndarray] = None

    def boxes(self):
        """[n, 6]: low corners, high corners."""
        if self.indices is None:
            each = self.positions.reshape(-1, {POINT: 1, EDGE: 2, TRIANGLE: 3, TET: 4, BOX_TYPE: 2}[self.type], 3)
        else:
            each = self.positions[self.indices]
        grown = 0 if self.radii is None else self.radii[:, None]
        return np.ascontiguousarray(np.concatenate([each.min(1) - grown, each.max(1) + grown], 1))


def of_boxes(low, high):
    return Primitives(BOX_TYPE, np.ascontiguousarray(np.stack([low, high], 1).reshape(-1, 3)))


@dataclasses.dataclass
class Case:
    grid: str
    known: int
    scene: str
    cells_stored: int
    cells_queried: int
    dense: bool
    stored: Primitives
    querying: Optional[Primitives]  # None: those stored
    mean_edge: float  # of the scene; of a cloud the spacing of its points
    run: Callable[[float], object]  # at a cell size
    default: Optional[float] = None  # the cell size that the grid's own library chooses
    unit: Optional[float] = None  # of the sweep; None: mean_edge

    def min_cell_size(self):
        """The smallest legal cell size."""
        if self.cells_queried != AROUND:
            return 0.0
        return max(0.5 * (b[:, 3:] - b[:, :3]).max() for b in (self.stored.boxes(), self.queries().boxes()))

    def queries(self):
        return self.stored if self.querying is None else self.querying


def doubles(array):
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


@functools.cache
def plain(path):
    library = ctypes.CDLL(path)
    boxes = [ctypes.POINTER(ctypes.c_double), ctypes.c_size_t]
    for name in ("plain_run_sorted", "plain_run_hashed"):
        function = getattr(library, name)
        function.restype, function.argtypes = ctypes.c_uint64, [*boxes, *boxes, ctypes.c_double, ctypes.c_int, ctypes.c_int]
    library.plain_run_voxels.restype = ctypes.c_uint64
    library.plain_run_voxels.argtypes = [*boxes, ctypes.c_double, ctypes.c_double]
    library.plain_count.restype = None
    library.plain_count.argtypes = [*boxes, *boxes, ctypes.c_double, *[ctypes.c_int] * 3, ctypes.POINTER(ctypes.c_double)]
    return library


def count(library, case, cell_size, samples=2):
    """The fields of vox_foreign_counts, counted."""
    stored, queries = case.stored.boxes(), case.queries().boxes()
    counts = (ctypes.c_double * len(losses.COUNTS))()
    library.plain_count(doubles(stored), len(stored), doubles(queries), len(queries), cell_size, case.cells_stored, case.cells_queried,
                        samples, counts)
    return dict(zip(losses.COUNTS, counts))


def tets(body):
    return Primitives(TET, body.vertices, body.tets.astype(np.uint32))


def stored_and_querying(scene):
    """Its bodies: the one that is stored, and the other, or None."""
    return scene.bodies[0], scene.bodies[1] if len(scene.bodies) > 1 else None


# ---- the plain grids in C++

def plain_cases(source, run, name, known, dense):
    for scene in source.meshes():
        body, other = stored_and_querying(scene)
        edge = scenes.mean_edge(body)
        for cells_stored, stored in ((STORED_BOX, tets(body)), (STORED_CENTRE, Primitives(POINT, body.vertices))):
            querying = tets(other if other else body) if other or cells_stored == STORED_CENTRE else None
            boxes, asked = stored.boxes(), (querying or stored).boxes()

            def at(size, boxes=boxes, asked=asked, cells_stored=cells_stored):
                return run(doubles(boxes), len(boxes), doubles(asked), len(asked), size, cells_stored, BOX)
            title = f"{name}, {'boxes' if cells_stored == STORED_BOX else 'points'}"
            yield Case(title, known, scene.name, cells_stored, BOX, dense, stored, querying, edge, at)


def sorted_cases(library, source):
    yield from plain_cases(source, library.plain_run_sorted, "C++, sorted", SORTED, True)


def hashed_cases(library, source):
    yield from plain_cases(source, library.plain_run_hashed, "C++, unordered_map", HASHED, False)


def voxel_cases(library, source):
    """Each point asks for the others in a ball of 1.5 or 3 spacings; the default of Open3D is the radius."""
    found = [(s.name, s.points, scenes.cloud_spacing(s.points)) for s in source.clouds()]
    for scene in source.meshes():
        if scene.name in source.some:
            found.append((scene.name, scene.bodies[0].vertices, scenes.mean_edge(scene.bodies[0])))
    for name, points, spacing in found:
        for multiple in (1.5, 3):
            radius = multiple * spacing

            def at(size, points=points, radius=radius):
                return library.plain_run_voxels(doubles(points), len(points), radius, size)
            yield Case("hashed voxels of points", POINT_VOXELS, f"{name}, {multiple:g}", STORED_CENTRE, BOX, False,
                       Primitives(POINT, points), Primitives(POINT, points, radii=np.full(len(points), radius)), spacing,
                       at, radius, radius)


# ---- numpy

def expanded(counts):
    """0 0 0 1 1 2 ...: the number of each, and which of its own it is."""
    owner = np.repeat(np.arange(len(counts)), counts)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)


def cells_of(boxes, origin, size, dims):
    """Key of each cell that each box meets, and the number of the box."""
    low = np.floor((boxes[:, :3] - origin) / size).astype(np.int64)
    sides = np.floor((boxes[:, 3:] - origin) / size).astype(np.int64) - low + 1
    owner, which = expanded(sides.prod(1))
    side = sides[owner]
    cell = low[owner]
    cell[:, 0] += which % side[:, 0]
    which //= side[:, 0]
    cell[:, 1] += which % side[:, 1]
    cell[:, 2] += which // side[:, 1]
    return (cell[:, 2] * dims[1] + cell[:, 1]) * dims[0] + cell[:, 0], owner


def run_numpy(stored, asked, size):
    """How many pairs of boxes meet: keys of cells, sorted, and the run of each key that is asked."""
    origin = np.minimum(stored[:, :3].min(0), asked[:, :3].min(0))
    dims = np.floor((np.maximum(stored[:, 3:].max(0), asked[:, 3:].max(0)) - origin) / size).astype(np.int64) + 1
    keys, owner = cells_of(stored, origin, size, dims)
    order = np.argsort(keys, kind="stable")
    keys, owner = keys[order], owner[order]
    found = 0
    for chunk in np.array_split(asked, max(len(asked) // 1000, 1)):  # so that memory stays small
        wanted, asker = cells_of(chunk, origin, size, dims)
        first = np.searchsorted(keys, wanted)
        which, index = expanded(np.searchsorted(keys, wanted, side="right") - first)
        a, b = chunk[asker[which]], stored[owner[first[which] + index]]
        low = np.maximum(a[:, :3], b[:, :3])
        meet = (low <= np.minimum(a[:, 3:], b[:, 3:])).all(1)
        cell = np.floor((low[meet] - origin) / size).astype(np.int64)
        found += int(((cell[:, 2] * dims[1] + cell[:, 1]) * dims[0] + cell[:, 0] == wanted[which[meet]]).sum())
    return found


def numpy_cases(_, source):
    for scene in source.meshes(0.08):
        body, other = stored_and_querying(scene)
        stored, querying = tets(body), tets(other) if other else None
        boxes, asked = stored.boxes(), (querying or stored).boxes()
        yield Case("numpy, sorted keys", NUMPY, scene.name, STORED_BOX, BOX, False, stored, querying, scenes.mean_edge(body),
                   functools.partial(run_numpy, boxes, asked))


# ---- NVIDIA Warp

def warp_cases(_, source):
    """Vertices in cells; a tetrahedron asks for those around it and tests them against its box. Points of a cloud ask for
    their neighbours."""
    import warp as wp
    wp.config.quiet = True
    wp.init()
    kernel = warp_kernel(wp)
    found = []
    for scene in source.meshes():
        body, other = stored_and_querying(scene)
        found.append((scene.name, body.vertices, tets(other if other else body).boxes(), scenes.mean_edge(body), None))
    for scene in source.clouds():
        spacing = scenes.cloud_spacing(scene.points)
        radius = 2 * spacing
        found.append((scene.name, scene.points, np.concatenate([scene.points - radius, scene.points + radius], 1), spacing, radius))
    grid = wp.HashGrid(128, 128, 128, device="cpu")
    for name, points, boxes, edge, unit in found:
        centres = 0.5 * (boxes[:, :3] + boxes[:, 3:])
        radii = np.full(len(boxes), unit) if unit else 0.5 * np.linalg.norm(boxes[:, 3:] - boxes[:, :3], axis=1)
        arrays = [wp.array(a.astype(np.float32), dtype=t, device="cpu") for a, t in (
            (points, wp.vec3), (centres, wp.vec3), (radii, float), (boxes[:, :3], wp.vec3), (boxes[:, 3:], wp.vec3))]
        hits = wp.zeros(len(boxes), dtype=int, device="cpu")

        def at(size, arrays=arrays, hits=hits):
            grid.build(points=arrays[0], radius=size)
            wp.launch(kernel, dim=len(hits), inputs=[grid.id, *arrays, hits], device="cpu")
        yield Case("Warp HashGrid", WARP, name, STORED_CENTRE, BOX, False, Primitives(POINT, points),
                   Primitives(POINT, np.ascontiguousarray(centres), radii=radii), edge, at, float(radii.mean()), unit)


@functools.cache
def warp_kernel(wp):
    @wp.kernel
    def ask(grid: wp.uint64, points: wp.array(dtype=wp.vec3), centres: wp.array(dtype=wp.vec3), radii: wp.array(dtype=float),
            lows: wp.array(dtype=wp.vec3), highs: wp.array(dtype=wp.vec3), hits: wp.array(dtype=int)):
        t = wp.tid()
        low = lows[t]
        high = highs[t]
        found = int(0)
        for i in wp.hash_grid_query(grid, centres[t], radii[t]):
            p = points[i]
            if (p[0] >= low[0] and p[1] >= low[1] and p[2] >= low[2] and p[0] <= high[0] and p[1] <= high[1] and p[2] <= high[2]):
                found += 1
        hits[t] = found
    return ask


# ---- IPC Toolkit

def surfaces(scene):
    """Of all bodies together: vertices, edges, faces."""
    vertices, edges, faces, first = [], [], [], 0
    for body in scene.bodies:
        v, e, f = scenes.surface(body)
        vertices.append(v)
        edges.append(e + first)
        faces.append(f + first)
        first += len(v)
    return np.concatenate(vertices), np.concatenate(edges), np.concatenate(faces)


def lows_and_highs(vertices, *indices, grown):
    each = [vertices[i] for i in indices]
    return np.concatenate([e.min(1) for e in each]) - grown, np.concatenate([e.max(1) for e in each]) + grown


def ipc_cases(_, source):
    """All candidates of the surfaces: edges against edges, vertices against faces, boxes a twentieth of an edge larger."""
    import ipctk
    ipctk.set_num_threads(1)
    for scene in source.meshes():
        vertices, edges, faces = surfaces(scene)
        edge = float(np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1).mean())
        grown = 0.05 * edge
        fortran = [np.asfortranarray(a) for a in (vertices, edges, faces)]
        alone = np.arange(len(vertices))[:, None]
        grid = ipctk.SpatialHash()

        def at(size, grid=grid, fortran=fortran, grown=grown):
            grid.build(*fortran, grown, size)
            grid.detect_edge_edge_candidates()
            grid.detect_face_vertex_candidates()
            grid.clear()
        default = ipctk.suggest_good_voxel_size(fortran[0], fortran[1], grown)
        yield Case("ipctk SpatialHash", IPC, scene.name, STORED_BOX, BOX, False,
                   of_boxes(*lows_and_highs(vertices, alone, edges, faces, grown=grown)),
                   of_boxes(*lows_and_highs(vertices, alone, edges, grown=grown)), edge, at, default)


def ipc_pairs_cases(_, source):
    """Vertices and faces, paired cell by cell. The grid takes its cell size from the boxes of the edges, so one edge of the
    length that gives the wanted size stands for them."""
    import ipctk
    ipctk.set_num_threads(1)
    for scene in source.meshes():
        vertices, edges, faces = surfaces(scene)
        edge = float(np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1).mean())
        grown = 0.02 * edge
        low = vertices.min(0)
        faces_in = np.asfortranarray(faces)
        edge_in = np.asfortranarray(np.array([[len(vertices), len(vertices) + 1]], dtype=np.int32))
        grid = ipctk.HashGrid()

        def at(size, grid=grid, vertices=vertices, low=low, faces_in=faces_in, edge_in=edge_in, grown=grown):
            with_edge = np.asfortranarray(np.concatenate([vertices, [low, low + [size - 2 * grown, 0, 0]]]))
            grid.build(with_edge, edge_in, faces_in, grown)
            assert abs(grid.cell_size / size - 1) < 0.01, (grid.cell_size, size)
            grid.detect_face_vertex_candidates()
            grid.clear()
        all_edges = ipctk.HashGrid()
        all_edges.build(np.asfortranarray(vertices), np.asfortranarray(edges), faces_in, grown)
        alone = np.arange(len(vertices))[:, None]
        yield Case("ipctk HashGrid", IPC_PAIRS, scene.name, STORED_BOX, PAIRS, False,
                   of_boxes(*lows_and_highs(vertices, alone, faces, grown=grown)), None, edge, at, all_edges.cell_size)


# ---- VTK

def vtk_cases(_, source):
    """Tetrahedra in all cells that they meet; the vertices of the other body (or its own) that are in its box ask in which
    tetrahedron they are."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    for scene in source.meshes():
        body, other = stored_and_querying(scene)
        low, high = body.vertices.min(0), body.vertices.max(0)
        points = (other if other else body).vertices
        points = np.ascontiguousarray(points[((points >= low) & (points <= high)).all(1)])
        mesh = vtk.vtkUnstructuredGrid()
        coordinates = vtk.vtkPoints()
        coordinates.SetData(numpy_to_vtk(body.vertices, deep=True))
        mesh.SetPoints(coordinates)
        cells = vtk.vtkCellArray()
        cells.SetData(4, numpy_to_vtkIdTypeArray(np.ascontiguousarray(body.tets.ravel().astype(np.int64)), deep=True))
        mesh.SetCells(vtk.VTK_TETRA, cells)

        def at(size, mesh=mesh, extent=high - low, asked=points.tolist()):
            locator = vtk.vtkStaticCellLocator()
            locator.SetDataSet(mesh)
            locator.AutomaticOff()
            locator.SetDivisions(*(int(max(np.ceil(side / size - 1e-9), 1)) for side in extent))
            locator.BuildLocator()
            for p in asked:
                locator.FindCell(p)
        automatic = vtk.vtkStaticCellLocator()
        automatic.SetDataSet(mesh)
        automatic.BuildLocator()
        default = float(((high - low) / automatic.GetDivisions()).prod() ** (1 / 3))
        yield Case("VTK static cell locator", VTK, scene.name, STORED_BOX, BOX, True, tets(body), Primitives(POINT, points),
                   scenes.mean_edge(body), at, default)


# ---- PBAT

def pbat_cases(_, source):
    """Centres of boxes in cells; vertices of the other body (or its own) look at 27."""
    from pbatoolkit import pbat
    for scene in source.meshes(0.1):
        body, other = stored_and_querying(scene)
        points = (other if other else body).vertices
        stored = tets(body)
        boxes = stored.boxes()
        low, high, asked = (np.asfortranarray(a.T) for a in (boxes[:, :3], boxes[:, 3:], points))
        expected = 8

        def at(size, low=low, high=high, asked=asked):
            grid = pbat.geometry.HashGrid3(size, 2 * low.shape[1])
            grid.construct(low, high)
            grid.broad_phase(asked, expected)
        yield Case("PBAT HashGrid3", PBAT, scene.name, STORED_CENTRE, AROUND, False, stored, Primitives(POINT, np.ascontiguousarray(points)),
                   scenes.mean_edge(body), at, float((boxes[:, 3:] - boxes[:, :3]).max()))


GRIDS = {"sorted": sorted_cases, "hashed": hashed_cases, "warp": warp_cases, "ipc": ipc_cases, "ipc_pairs": ipc_pairs_cases,
         "vtk": vtk_cases, "pbat": pbat_cases, "voxels": voxel_cases, "numpy": numpy_cases}
