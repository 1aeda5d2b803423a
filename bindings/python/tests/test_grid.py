"""Grids, meshes and what a step finds."""

import copy
import dataclasses
import gc
import math
import pickle
import unittest
import weakref

import numpy as np

import voxtet
from support import TET, GridCase, box, two_boxes
from voxtet import _c


class ReadmeScene(unittest.TestCase):
    """The program of the project's README: the same hash in every language."""

    def test_contact_and_hash(self):
        first = np.array([[5, 5, 5], [6, 5, 5], [5, 6, 5], [.2, .3, .4]], np.float32)
        second = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
        with voxtet.Grid() as grid:
            a, b = grid.add(first, TET, user_data=1), grid.add(second, TET, user_data=2)
            grid.step()
            contact, = grid.contacts
            self.assertEqual((contact.body_a, contact.vertex, contact.body_b, contact.tet), (a.id, 3, b.id, 0))
            constraint, = grid.find_constraints()
            np.testing.assert_allclose(constraint.weights, [1, -.1, -.2, -.3, -.4], atol=1e-6)
            self.assertEqual(f"{grid.hash:016x}", "20dfe036a1d1bec0")


class Results(GridCase):
    options = {"constraints": True}

    def test_structured_arrays(self):
        self.grid.step()
        contacts = self.grid.contacts
        self.assertEqual(len(contacts), self.grid.counters["contacts"])
        self.assertGreater(len(contacts), 10)
        np.testing.assert_array_equal(contacts.body_a, contacts["body_a"])
        self.assertIs(type(contacts.body_a), np.ndarray)
        self.assertTrue(np.shares_memory(contacts.tet, contacts))
        self.assertEqual(self.grid.constraints[:3].weights.shape, (3, 5))
        self.assertEqual({self.grid[i].tag for i in contacts.body_a}, {"a", "b"})
        self.assertIn("tet", dir(contacts))
        with self.assertRaises(AttributeError):
            contacts.nothing
        self.assertEqual(len(self.grid.interiors), len(contacts))
        self.assertIs(self.grid.interiors.dtype.type, np.bool_)

    def test_results_are_the_callers_own(self):
        self.grid.step()
        contacts, before = self.grid.contacts, self.grid.contacts
        contacts["tet"] = 0
        np.testing.assert_array_equal(self.grid.contacts, before)
        self.first += 100
        self.grid.step()
        self.assertEqual(len(self.grid.contacts), 0)
        self.grid.close()
        self.assertEqual(before[0].body_a, self.a.id)

    def gaps(self, constraints):
        """By the formula of the documentation."""
        positions = {self.a.id: self.first, self.b.id: self.second}
        for c in constraints:
            x = [positions[c.body_a if i < c.count_a else c.body_b][v] for i, v in enumerate(c.vertices)]
            yield c.offset + c.normal @ (c.weights @ x)

    def test_constraints(self):
        self.grid.step()
        found = self.grid.constraints
        self.assertEqual(len(found), len(self.grid.contacts))
        self.assertTrue((found.kind == voxtet.ConstraintKind.INSIDE).all())
        self.assertTrue(set(found.state) <= set(voxtet.DepthState))
        self.assertLess(found.gap.min(), -0.1)
        np.testing.assert_allclose(found.weights.sum(axis=1), 0, atol=1e-12)
        np.testing.assert_allclose(list(self.gaps(found)), found.gap, atol=1e-6)
        self.assertTrue((found.previous == voxtet.NONE).all())
        self.grid.step()
        np.testing.assert_array_equal(self.grid.constraints.previous, np.arange(len(found)))
        self.grid.set_flags(constraints=False)
        self.assertEqual(self.grid.flags, 0)
        self.grid.step()
        with self.assertRaises(voxtet.InvalidStateError):
            self.grid.constraints

    def test_find_constraints(self):
        other = self.grid.add(self.first + np.float32(0.1), self.tets, filter=voxtet.Filter(category=2))
        with self.assertRaises(voxtet.InvalidStateError):
            self.grid.find_constraints()
        self.grid.step()
        consistent = self.grid.constraints
        closest = self.grid.find_constraints("closest")
        np.testing.assert_array_equal(self.grid.constraints, closest)
        np.testing.assert_array_equal(closest.count, 4)
        np.testing.assert_array_equal(consistent.count, 5)
        plain = self.grid.find_constraints(voxtet.DepthMethod.NONE)
        np.testing.assert_array_equal(plain.weights, consistent.weights)
        self.assertEqual(set(plain.state), {voxtet.DepthState.UNKNOWN})
        some = self.grid.find_constraints("closest", closest_budget=1)
        self.assertEqual((some.state != voxtet.DepthState.UNKNOWN).sum(), 1)
        np.testing.assert_array_equal(self.grid.find_constraints(), consistent)

        ids = self.a.id, self.b.id, other.id
        for options, pairs in (({"body_a": self.b}, [0, 2]), ({"body_a": other.id, "body_b": self.b.id}, [2]), ({"mask": 2}, [1, 2])):
            with self.subTest(options):
                few = self.grid.find_constraints(**options)
                self.assertEqual(set(few.pair), set(pairs))
                np.testing.assert_array_equal(few.position, consistent.position[np.isin(consistent.pair, pairs)])
                offsets = self.grid.pair_offsets.tolist()
                for p, (a, b) in enumerate(((0, 1), (0, 2), (1, 2))):
                    of_pair = few[offsets[p]:offsets[p + 1]]
                    self.assertEqual(len(of_pair) > 0, p in pairs)
                    self.assertLessEqual(set(of_pair.body_a) | set(of_pair.body_b), {ids[a], ids[b]})
        for wrong in ({"method": "deep"}, {"mask": -1}, {"body_b": self.a}, {"body_a": 99}):
            with self.subTest(wrong), self.assertRaises((ValueError, LookupError)):
                self.grid.find_constraints(**wrong)
        other.remove()
        with self.assertRaisesRegex(voxtet.InvalidStateError, "was removed"):
            self.grid.find_constraints("closest")

    def test_edges(self):
        self.grid.set_flags(edges=True)
        self.grid.step()
        edges = self.grid.constraints[self.grid.constraints.kind == voxtet.ConstraintKind.EDGE]
        self.assertGreater(len(edges), 10)
        np.testing.assert_array_equal(edges.count_a, 2)
        np.testing.assert_allclose(list(self.gaps(edges)), edges.gap, atol=1e-6)

    def test_margin(self):
        self.second += np.float32(0.4)  # 0.01 apart along x
        self.grid.margin = 0.05
        self.grid.step()
        self.assertEqual((self.grid.margin, len(self.grid.contacts)), (0.05, 0))
        self.assertEqual(self.grid.pairs.state.tolist(), [voxtet.PairState.NEAR])
        near = self.grid.constraints
        self.assertGreater(len(near), 0)
        self.assertTrue((near.kind == voxtet.ConstraintKind.PROXIMITY).all())
        np.testing.assert_allclose(near.gap, 0.01, atol=1e-6)
        np.testing.assert_allclose(list(self.gaps(near)), near.gap, atol=1e-6)
        with voxtet.Grid(margin=0.25) as grid:
            for again in (grid, pickle.loads(pickle.dumps(grid))):
                self.assertEqual(again.margin, 0.25)
        with self.assertRaises(ValueError):
            self.grid.margin = -1

    def test_impacts(self):
        """A body that flies through another one within a step."""
        before = self.first.copy()
        self.first += np.array([5, 0.4, 0.4], np.float32)
        self.a.previous_positions = before
        self.assertIs(self.a.previous_positions, before)
        before[:, 0] -= 3
        self.grid.step()
        self.assertEqual(len(self.grid.contacts), 0)
        self.assertEqual(self.grid.pairs.state.tolist(), [voxtet.PairState.BEGAN])
        impacts = self.grid.constraints
        self.assertGreater(len(impacts), 0)
        self.assertTrue((impacts.kind == voxtet.ConstraintKind.IMPACT).all())
        self.assertTrue(((0 < impacts.time) & (impacts.time < 1)).all())
        np.testing.assert_allclose(list(self.gaps(impacts)), impacts.gap, atol=1e-5)
        watched = weakref.ref(before)
        del before
        gc.collect()
        self.grid.step()
        self.assertEqual(len(self.grid.constraints), len(impacts))
        self.a.previous_positions = None
        self.assertIsNone(watched())
        self.grid.step()
        self.assertEqual(len(self.grid.constraints), 0)
        self.a.previous_positions = self.first
        self.a.append_vertices(np.vstack([self.first, self.first[:1]]))
        self.assertIsNone(self.a.previous_positions)
        for wrong in (self.first[:-1], self.first.astype(int), [[0, 0, 0]]):
            with self.assertRaises((TypeError, ValueError)):
                self.a.previous_positions = wrong

    def test_pairs(self):
        self.grid.step()
        pair, = self.grid.pairs
        self.assertEqual((pair.user_data_a, pair.user_data_b), (7, 2**63))
        order = self.grid.pair_contacts
        np.testing.assert_array_equal(np.sort(order), np.arange(len(self.grid.contacts)))
        bodies = self.grid.contacts.body_a[order[pair.first_contact:][:pair.contact_count]]
        np.testing.assert_array_equal(bodies, np.sort(bodies))
        self.assertEqual(pair.state, voxtet.PairState.BEGAN)
        self.grid.step()
        self.assertEqual(self.grid.pairs.state.tolist(), [voxtet.PairState.PERSISTED])
        self.first += 100
        self.grid.step()
        self.assertEqual(self.grid.pairs.state.tolist(), [voxtet.PairState.ENDED])
        self.grid.step()
        self.assertEqual(len(self.grid.pairs), 0)

    def test_measurements(self):
        self.grid.step()
        self.assertEqual(self.grid.counters["tets"], 2 * len(self.tets))
        self.assertGreater(self.grid.counters["step_ns"], 0)
        self.assertEqual(self.grid.epoch, 1)

    def test_fields_are_those_of_the_library(self):
        self.assertEqual({f.name for f in dataclasses.fields(voxtet.Filter)} - {"self_collision", "sensor"},
                         {name for name, _ in _c.vox_filter._fields_ if name != "flags"})
        classes = [voxtet.Contacts, voxtet.Pairs, voxtet.Constraints, voxtet.PointHits, voxtet.ClosestHits, voxtet.BoxHits,
                   voxtet.RayHits]
        structs = ["contact", "pair", "constraint", "point_hit", "closest_hit", "box_hit", "ray_hit"]
        for kind, struct in zip(classes, structs):
            fields = _c.dtypes["vox_" + struct].fields
            self.assertEqual(kind.__annotations__, {name: f"NDArray[np.{fields[name][0].base.name}]" for name in fields
                                                    if name != "reserved"}, kind)


class Settings(GridCase):
    def test_same_contacts_with_every_setting(self):
        self.grid.step()
        for options in ({"cell_size": 0.1}, {"reference": voxtet.Reference()}, {"workers": voxtet.ALL_CORES},
                        {"reference": voxtet.Reference(dense=True, world=([0, 0, 0], [2, 2, 2]))},
                        {"reference": voxtet.Reference(paper_hash=True)},
                        {"workers": 2}, {"reference": voxtet.Reference(hash_table_size=1000)}, {"constraints": True, "edges": True}):
            with self.subTest(options), voxtet.Grid(**options) as grid:
                grid.add(self.first, self.tets)
                grid.add(self.second, self.tets)
                grid.step()
                self.assertEqual(grid.hash, self.grid.hash)

    def test_properties(self):
        self.grid.cell_size = 0.25
        self.assertEqual(self.grid.cell_size, 0.25)
        self.grid.workers = 2
        self.assertEqual(self.grid.workers, 2)
        self.grid.reserve(10, 1000)
        self.grid.step()

    def test_log(self):
        lines = []
        with voxtet.Grid(log=lambda level, text: lines.append((level, text))) as grid:
            grid.add(self.first)
        (level, text), = lines
        self.assertEqual(level, 30)  # logging.WARNING
        self.assertIn("tetrahedra", text)

    def test_log_outlives_its_name(self):
        lines = []

        class Log:
            def __call__(self, level, text):
                lines.append(text)

        grid = voxtet.Grid(log=Log())
        gc.collect()
        grid.add(self.first)
        self.assertEqual(len(lines), 1)

    def test_exceptions_in_a_log_are_reported_and_stop_there(self):
        import sys
        seen = []

        def log(level, text):
            raise RuntimeError("in the log")

        before, sys.unraisablehook = sys.unraisablehook, lambda unraisable: seen.append(unraisable.exc_value)
        try:
            with voxtet.Grid(log=log) as grid:
                grid.add(self.first)
        finally:
            sys.unraisablehook = before
        self.assertEqual([str(e) for e in seen], ["in the log"])

    def test_log_that_calls_its_grid(self):
        errors = []

        def log(level, text):
            try:
                grid.step()
            except voxtet.InvalidStateError as error:
                errors.append(str(error))

        with voxtet.Grid(log=log) as grid:
            grid.add(self.first)
            grid.step()
        self.assertEqual(errors, ["a log function must not call the grid it came from"])

    def test_budget(self):
        with voxtet.Grid(byte_budget=200000) as grid, self.assertRaises(MemoryError) as caught:
            grid.add(*box(8))
        self.assertIsInstance(caught.exception, voxtet.BudgetError)
        self.assertEqual(caught.exception.code, voxtet.Result.ERROR_BUDGET)
        self.assertIn("200000", str(caught.exception))


class Meshes(GridCase):
    def test_enumeration(self):
        self.assertEqual([m.tag for m in self.grid], ["a", "b"])
        self.assertEqual(self.grid.meshes, [self.a, self.b])
        self.assertEqual(len(self.grid), 2)
        self.assertIn(self.a, self.grid)
        self.assertIn(self.b.id, self.grid)
        self.assertNotIn(99, self.grid)
        self.assertNotIn("a", self.grid)
        self.assertEqual(self.grid[np.uint32(self.a.id)], self.a)
        with self.assertRaises(LookupError):
            self.grid[99]
        self.assertEqual(len({self.a, self.grid[self.a.id]}), 1)
        with voxtet.Grid() as other:
            for _ in range(100):
                other.add(self.first, self.tets, tag=_)
            self.assertEqual([m.tag for m in other], list(range(100)))

    def test_mesh_of_another_grid(self):
        with voxtet.Grid() as other:
            stranger = other.add(self.first, self.tets)
            self.assertEqual(stranger.id, self.a.id)
            for call in (self.grid.remove, lambda mesh: self.grid.find_constraints(body_a=mesh), self.grid.__getitem__):
                with self.assertRaises(voxtet.InvalidHandleError):
                    call(stranger)
            self.assertNotIn(stranger, self.grid)

    def test_info_and_arrays(self):
        info = self.a.info
        self.assertEqual((info.vertex_count, info.tet_count, info.user_data), (len(self.first), len(self.tets), 7))
        self.assertEqual(self.b.user_data, 2**63)
        np.testing.assert_array_equal(self.a.tets, self.tets)
        self.assertTrue(self.a.tets_enabled.all())
        self.assertIs(self.a.positions, self.first)

    def test_tag(self):
        self.a.tag = {"any": "thing"}
        self.assertEqual(self.grid[self.a.id].tag, {"any": "thing"})
        self.assertIn("any", repr(self.a))
        self.a.remove()
        self.assertIsNone(self.a.tag)
        self.assertFalse(self.a.valid)
        self.assertIn("removed", repr(self.a))

    def test_filter(self):
        self.assertEqual(self.a.filter, voxtet.Filter())
        self.a.filter = dataclasses.replace(self.a.filter, group=-4)
        self.b.filter = voxtet.Filter(group=-4)
        self.grid.step()
        self.assertEqual(len(self.grid.contacts), 0)
        self.b.filter = voxtet.Filter(self_collision=True, self_rings=2, self_rest_distance=0.5)
        self.assertEqual(self.b.filter, voxtet.Filter(self_collision=True, self_rings=2, self_rest_distance=0.5))
        with self.assertRaises(TypeError):
            self.a.filter = {"group": 1}
        with self.assertRaises(voxtet.InvalidArgumentError):
            self.a.filter = voxtet.Filter(mask=2**64)

    def test_filter_and_rest_pose_at_insertion(self):
        mesh = self.grid.add(self.first, self.tets, filter=voxtet.Filter(category=0, mask=6), rest_positions=self.second)
        self.assertEqual(mesh.filter.mask, 6)

    def test_enabled_and_pairs(self):
        self.b.enabled = False
        self.assertFalse(self.b.enabled)
        self.grid.step()
        self.assertEqual(len(self.grid.contacts), 0)
        self.b.enabled = True
        self.grid.set_pair_enabled(self.a, self.b, False)
        self.grid.step()
        self.assertEqual(len(self.grid.contacts), 0)
        self.grid.set_pair_enabled(self.a, self.b, True)
        self.grid.step()
        self.assertGreater(len(self.grid.contacts), 0)

    def test_transform(self):
        self.grid.step()
        before = self.grid.hash
        self.b.transform = [[1, 0, 0, 100], [0, 1, 0, 0], [0, 0, 1, 0]]
        self.assertEqual(self.b.transform[0, 3], 100)
        self.grid.step()
        self.assertEqual(len(self.grid.contacts), 0)
        self.b.transform = np.eye(4)
        self.grid.step()
        self.assertEqual(self.grid.hash, before)
        self.b.transform = None
        np.testing.assert_array_equal(self.b.transform, np.eye(3, 4))
        for wrong in (np.eye(3), np.ones((4, 4)), [[1, 2]], np.full((3, 4), np.nan)):
            with self.subTest(wrong), self.assertRaises(ValueError):
                self.b.transform = wrong

    def test_clear(self):
        self.grid.step()
        self.grid.clear()
        self.assertEqual((len(self.grid), len(self.grid.contacts)), (0, 0))
        self.assertFalse(self.a.valid)
        self.grid.add(self.first, self.tets)
        self.grid.step()

    def test_failures(self):
        self.second[5] = np.nan
        with self.assertRaises(voxtet.NonFiniteError) as caught:
            self.grid.step()
        self.assertIsInstance(caught.exception, ArithmeticError)
        failure, = self.grid.failures
        self.assertEqual((failure.body, failure.vertex, failure.result), (self.b.id, 5, voxtet.Result.ERROR_NON_FINITE))
        self.assertTrue(math.isnan(failure.position[0]))
        self.grid.set_flags(skip_bad_bodies=True)
        self.grid.step()
        self.assertEqual([failure.body for failure in self.grid.failures], [self.b.id])


class Cutting(GridCase):
    def test_tets(self):
        self.a.set_tets_enabled([0, 1], False)
        self.assertEqual(self.a.info.enabled_tet_count, len(self.tets) - 2)
        self.assertFalse(self.a.tets_enabled[:2].any())
        self.a.set_tets_enabled(np.array([0, 1]), True)
        first = self.a.append_tets([[0, 1, 2, 5]])
        self.assertEqual(first, len(self.tets))
        self.a.replace_tets([first], [[0, 1, 2, 6]])
        np.testing.assert_array_equal(self.a.tets[first], [0, 1, 2, 6])
        self.a.remove_tets([first])
        self.assertFalse(self.a.tets_enabled[first])
        self.a.remove_tets([])
        with self.assertRaises(voxtet.InvalidMeshError) as caught:
            self.a.append_tets([[0, 1, 2, 900]])
        self.assertIn("900", str(caught.exception))
        with self.assertRaises(ValueError):
            self.a.replace_tets([0, 1], [[0, 1, 2, 6]])

    def test_vertices_of_borrowed_positions(self):
        longer = np.vstack([self.first, self.first[:2]])
        self.assertEqual(self.a.append_vertices(longer), len(self.first))
        self.assertIs(self.a.positions, longer)
        self.assertEqual(self.a.info.vertex_count, len(longer))
        with self.assertRaises(ValueError):
            self.a.append_vertices(self.first)  # fewer than it has
        self.assertEqual(self.a.append_vertices(np.vstack([longer, longer[:1]]).astype(float)), len(longer))
        self.assertEqual(self.a.positions.dtype, np.float64)  # another array, so another dtype may be borrowed
        self.a.remove_vertices([len(longer) - 1])
        self.grid.step()

    def test_vertices_of_own_positions(self):
        own = self.grid.add(self.first, self.tets, copy=True)
        self.assertEqual(own.append_vertices(copies_of=[3, 4]), len(self.first))
        np.testing.assert_array_equal(own.positions[-2:], self.first[3:5])
        own.append_vertices(self.first[:1])
        self.assertEqual(own.info.vertex_count, len(self.first) + 3)
        held = own.positions
        with self.assertRaises(BufferError):
            own.append_vertices(copies_of=[0])
        del held
        own.append_vertices(copies_of=[0])
        for wrong in ({}, {"positions": self.first, "copies_of": [1]}):
            with self.assertRaises(ValueError):
                own.append_vertices(**wrong)

    def test_topology(self):
        positions, tets = box(2)
        self.a.set_topology(positions, tets)
        self.assertEqual((self.a.info.vertex_count, self.a.tag), (len(positions), "a"))
        self.assertIs(self.a.positions, positions)
        self.a.set_topology(None, tets[:3])
        self.assertIs(self.a.positions, positions)
        self.grid.step()
        self.a.set_topology(positions, tets, copy=True)
        self.assertTrue(self.a.info.owns_positions)

    def test_borrowed_tets(self):
        tets = self.tets.copy()
        watched = weakref.ref(tets)
        mesh = self.grid.add(self.first, tets, borrow_tets=True)
        self.assertTrue(mesh.info.borrows_tets)
        del tets
        gc.collect()
        self.assertIsNotNone(watched())
        mesh.remove_tets([0])
        self.assertIsNone(watched())
        self.grid.step()
        for wrong in (self.tets.astype(np.int64), self.tets.tolist(), self.tets[::2]):
            with self.assertRaises(ValueError):
                self.grid.add(self.first, wrong, borrow_tets=True)


class Snapshots(GridCase):
    def test_snapshot(self):
        self.grid.step()
        again = voxtet.Grid.from_snapshot(self.grid.snapshot(), workers=2)
        self.assertEqual(again.workers, 2)
        again.step()
        self.assertEqual(again.hash, self.grid.hash)
        self.assertEqual([m.id for m in again], [m.id for m in self.grid])
        mesh = again[self.a.id]
        np.testing.assert_array_equal(mesh.positions, self.first)
        mesh.positions[:] += 100
        again.step()
        self.assertEqual(len(again.contacts), 0)

    def test_pickle_and_copy(self):
        for again in (pickle.loads(pickle.dumps(self.grid)), copy.deepcopy(self.grid)):
            again.step()
            self.grid.step()
            self.assertEqual(again.hash, self.grid.hash)
            self.assertEqual([m.tag for m in again], ["a", "b"])
            self.first[0, 0] += 0.01
            self.grid.step()
            self.assertNotEqual(again.epoch, self.grid.epoch)
            self.first[0, 0] -= 0.01

    def test_the_engine_is_kept(self):
        with voxtet.Grid(reference=voxtet.Reference()) as grid:
            grid.add(self.first, self.tets)
            again = pickle.loads(pickle.dumps(grid))
        self.assertEqual(again.suggest_cell_size().cost, again.suggest_cell_size("reference").cost)  # that of its engine
        self.assertEqual(self.grid.suggest_cell_size().cost, self.grid.suggest_cell_size("fast").cost)

    def test_pickled_mesh(self):
        grid, mesh = pickle.loads(pickle.dumps((self.grid, self.b)))
        self.assertEqual((mesh.tag, mesh.id), ("b", self.b.id))
        self.assertIs(mesh.grid, grid)

    def test_hostile(self):
        good = self.grid.snapshot()
        for bad in (b"", b"nothing", good[:-1], good[:100], bytes(len(good))):
            with self.subTest(len(bad)), self.assertRaises(ValueError) as caught:
                voxtet.Grid.from_snapshot(bad)
            self.assertIsInstance(caught.exception, voxtet.VoxError)
        with self.assertRaises(TypeError):
            voxtet.Grid.from_snapshot("text")


class Many(unittest.TestCase):
    def setUp(self):
        self.grids = []
        for i in range(20):
            a, b, tets = two_boxes(2)
            grid = voxtet.Grid()
            grid.add(a, tets)
            grid.add(b + np.float32(0.02 * i), tets)
            self.grids.append(grid)

    def test_same_as_one_by_one(self):
        for grid in self.grids:
            grid.step()
        each = [grid.contacts for grid in self.grids]
        for steps, workers in enumerate((1, 2, 0), 2):
            voxtet.step_all(self.grids, workers)
            for i, grid in enumerate(self.grids):
                np.testing.assert_array_equal(grid.contacts, each[i])
                self.assertEqual(grid.epoch, steps)

    def test_errors(self):
        with self.assertRaises(ValueError):
            voxtet.step_all([self.grids[0]] * 2)
        with self.assertRaises(TypeError):
            voxtet.step_all([self.grids[0], None])
        self.grids[3].meshes[0].positions[0] = np.inf
        with self.assertRaises(voxtet.NonFiniteError) as caught:
            voxtet.step_all(self.grids)
        self.assertIn("grid 3", str(caught.exception))
        self.assertEqual(self.grids[4].epoch, 1)
        with self.grids[5].borrowed():
            with self.assertRaises(BufferError):
                voxtet.step_all(self.grids)
        self.grids[6].close()
        with self.assertRaises(voxtet.InvalidStateError):
            voxtet.step_all(self.grids)
        self.grids[7].step()  # no lock is left behind
        voxtet.step_all([])


if __name__ == "__main__":
    unittest.main()
