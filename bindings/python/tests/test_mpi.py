"""Scenes on many ranks. Skipped where vox_dist was not built; with ranks, where mpi4py and its MPI are not there."""

import ctypes
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import voxtet
from support import global_contacts, mpi_command

try:
    import voxtet.mpi
    from voxtet import _dist
except ImportError as missing:
    raise unittest.SkipTest(str(missing)) from None

HERE = os.path.dirname(os.path.abspath(__file__))
INCLUDE = os.path.join(HERE, "..", "..", "..", "include")
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)


class Layout(unittest.TestCase):
    def test_structs_are_those_of_the_header(self):
        compiler = shutil.which("cc")
        if compiler is None or not os.path.exists(INCLUDE):
            self.skipTest("there is no C compiler, or no header")
        lines = []
        for struct in _dist.STRUCTS:
            name = struct.__name__
            lines.append(f'printf("{name} %zu\\n", sizeof({name}));')
            lines += [f'printf("{name}.{field} %zu\\n", offsetof({name}, {field}));' for field, *_ in struct._fields_]
        lines += [f'printf("{name} %u\\n", (unsigned){name});' for name in ("VOX_DIST_VERTICES", "VOX_DIST_TETS", "VOX_NONE")]
        program = "#include <vox/vox_dist.h>\n#include <stddef.h>\n#include <stdio.h>\nint main(void) {" + "\n".join(lines) + "}\n"
        with tempfile.TemporaryDirectory() as folder:
            source, built = os.path.join(folder, "layout.c"), os.path.join(folder, "layout")
            with open(source, "w") as file:
                file.write(program)
            subprocess.run([compiler, "-std=c99", "-I", INCLUDE, "-DVOX_STATIC", "-c", source, "-o", built + ".o"], check=True)
            # No function of the library is called, so nothing of it is linked.
            subprocess.run([compiler, built + ".o", "-o", built, "-Wl,--unresolved-symbols=ignore-all"], check=True)
            printed = subprocess.run([built], check=True, capture_output=True, text=True).stdout
        expected = dict(line.split() for line in printed.splitlines())
        for struct in _dist.STRUCTS:
            self.assertEqual(int(expected[struct.__name__]), ctypes.sizeof(struct), struct)
            for field, *_ in struct._fields_:
                self.assertEqual(int(expected[f"{struct.__name__}.{field}"]), getattr(struct, field).offset, (struct, field))
        numbers = [int(expected[name]) for name in ("VOX_DIST_VERTICES", "VOX_DIST_TETS", "VOX_NONE")]
        self.assertEqual(numbers, [_dist.VERTICES, _dist.TETS, voxtet.mpi.NONE])

    def test_every_function_of_the_header_is_there(self):
        with open(os.path.join(INCLUDE, "vox", "vox_dist.h"), encoding="utf-8") as file:
            declared = set(re.findall(r"VOX_EXPERIMENTAL (?:vox_result|void) (vox_\w+)\(", file.read()))
        self.assertEqual(declared, set(_dist._ARGUMENTS) | {"vox_dist_scene_destroy"})


class OneRank(unittest.TestCase):
    def setUp(self):
        self.scene = voxtet.mpi.Scene()
        self.addCleanup(self.scene.close)

    def test_contacts_are_those_of_a_grid(self):
        random = np.random.default_rng(4)
        bodies = {5: random.uniform(0, 1, (40, 3)), 9: random.uniform(0.3, 1.3, (40, 3))}
        tets = np.array([random.permutation(40)[:4] for _ in range(200)])
        grid = voxtet.Grid()
        for body, positions in bodies.items():
            self.scene.insert(body, positions, tets)
            grid.add(positions, tets, user_data=body)
        hashes = set()
        for _ in range(3):
            self.scene.step()
            grid.step()
            self.assertGreater(len(grid.contacts), 20)
            for side in (self.scene.contacts, self.scene.tet_contacts):
                for name, values in global_contacts(grid).items():
                    self.assertEqual(side[name].tolist(), values.tolist(), name)
            c = self.scene.contacts
            for body, positions in bodies.items():  # the weights give the vertices back
                mine = c[c.body_b == body]
                corners, (vertices,) = positions[tets[mine.tet]], (p for b, p in bodies.items() if b != body)
                np.testing.assert_allclose(np.einsum("ij,ijk->ik", mine.weights, corners), vertices[mine.vertex], atol=1e-9)
            hashes.add(self.scene.hash())
            for positions in bodies.values():
                positions += random.uniform(-0.05, 0.05, positions.shape)
        self.assertEqual(len(hashes), 3)

    def test_parts_come_move_and_go(self):
        self.assertIsNone(self.scene.insert(6, CORNERS, [[0, 1, 2, 3]]))
        small = (CORNERS * 0.5 + 0.1).astype(np.float32)
        self.scene.insert(2**63, small, [[0, 1, 2, 3]])
        self.scene.step()
        self.assertEqual(len(self.scene.contacts), 4)
        small += 5
        self.scene.step()
        self.assertEqual(len(self.scene.contacts), 0)
        self.scene.move(2**63, CORNERS * 0.25 + 0.1)  # nobody else keeps this array
        self.scene.step()
        self.assertEqual(len(self.scene.contacts), 4)
        self.assertEqual(self.scene.tet_contacts.index.tolist(), [0] * 4)
        self.scene.remove(6)
        self.scene.step()
        self.assertEqual(len(self.scene.contacts), 0)
        with self.assertRaisesRegex(voxtet.InvalidArgumentError, "count is 3, expected 4"):
            self.scene.move(2**63, CORNERS[:3])
        for call in (lambda: self.scene.remove(6), lambda: self.scene.move(6, CORNERS)):
            with self.assertRaisesRegex(voxtet.InvalidHandleError, "no part of body 6"):
                call()
        self.scene.insert(6, CORNERS, [[0, 1, 2, 3]])
        self.scene.step()
        self.assertEqual(len(self.scene.contacts), 4)

    def test_numbers_and_values(self):
        self.scene.insert(2, CORNERS, [[0, 1, 2, 3]], vertex_ids=[40, 30, 20, 10], tet_ids=[2**40], owned=[True] * 4)
        self.scene.insert(1, CORNERS * 0.5 + 0.1, [[0, 1, 2, 3]], vertex_ids=np.arange(4) + 2**50)
        self.scene.step()
        self.assertEqual(self.scene.contacts.tet.tolist(), [2**40] * 4)
        self.assertEqual(self.scene.contacts.vertex.tolist(), [2**50 + i for i in range(4)])
        forces = np.arange(12, dtype=np.float32).reshape(4, 3)
        self.assertEqual(self.scene.send(forces).tolist(), forces.tolist())
        self.assertEqual(self.scene.send(np.arange(4), side="tets").tolist(), [0, 1, 2, 3])
        located = self.scene.locate([[0.1, 0.1, 0.1], [7, 7, 7]] * np.ones((2, 3)))
        self.assertEqual(located.body.tolist(), [1, 2])
        self.assertEqual(located.state.tolist(), [voxtet.mpi.INSIDE, voxtet.mpi.OUTSIDE])
        self.assertEqual(located.rank.tolist(), [0, 0])
        self.assertAlmostEqual(located.distance[1], 20 / 3**0.5)
        self.assertEqual(self.scene.costs.body.tolist(), [1, 2])
        self.assertTrue(np.all((self.scene.costs.seconds > 0) & (self.scene.costs.seconds < 1e-3)), self.scene.costs.seconds)
        self.assertEqual(self.scene.counters["contacts"], 4)
        self.scene.check()

    def test_a_rank_may_have_nothing(self):
        for body, options in enumerate([dict(), dict(vertex_ids=[], tet_ids=[], owned=[]), dict(owned=np.empty(0, bool))]):
            self.scene.insert(body, np.empty((0, 3)), np.empty((0, 4), int), **options)
        self.scene.step()
        self.assertEqual(len(self.scene.contacts) + len(self.scene.tet_contacts), 0)
        self.assertEqual(self.scene.send(np.empty((0, 3))).shape, (0, 3))
        self.assertEqual(len(self.scene.locate(np.empty((0, 3)))), 0)
        self.assertEqual(self.scene.locate([[0, 0, 0]]).rank.tolist(), [voxtet.mpi.NONE])

    def test_bad_arguments_change_nothing(self):
        self.scene.insert(0, CORNERS, [[0, 1, 2, 3]])
        bad = [
            (voxtet.InvalidArgumentError, "vertex_ids.*shape", dict(vertex_ids=[1, 2])),
            (voxtet.InvalidArgumentError, r"vertex_ids\[1\] is -2", dict(vertex_ids=[1, -2, 3, 4])),
            (TypeError, "vertex_ids.*float64", dict(vertex_ids=[1.0, 2, 3, 4])),
            (voxtet.InvalidArgumentError, "twice|7", dict(vertex_ids=[7, 7, 3, 4])),
            (voxtet.InvalidArgumentError, r"owned\[2\] is 5", dict(owned=[0, 1, 5, 1])),
            (TypeError, "owned.*float", dict(owned=[0.5] * 4)),
            (TypeError, "filter", dict(filter=3)),
        ]
        for kind, words, options in bad:
            with self.subTest(words), self.assertRaisesRegex(kind, words):
                self.scene.insert(1, CORNERS, [[0, 1, 2, 3]], **options)
        with self.assertRaisesRegex(voxtet.InvalidArgumentError, "body 0"):
            self.scene.insert(0, CORNERS, [[0, 1, 2, 3]])
        with self.assertRaisesRegex(voxtet.InvalidMeshError, "vertex 9"):
            self.scene.insert(1, CORNERS, [[0, 1, 2, 9]])
        with self.assertRaises(voxtet.InvalidHandleError):
            self.scene.remove(77)
        with self.assertRaisesRegex(voxtet.InvalidArgumentError, "0 rows"):
            self.scene.send([1.0])
        with self.assertRaisesRegex(voxtet.InvalidArgumentError, "sideways"):
            self.scene.send([], side="sideways")
        with self.assertRaises(TypeError):
            voxtet.mpi.Scene("world")
        with self.assertRaisesRegex(TypeError, "a voxtet.Reference"):
            voxtet.mpi.Scene(reference="steam")
        with self.assertRaisesRegex(TypeError, "float16"):
            self.scene.locate(CORNERS.astype(np.float16))
        self.scene.step()
        self.assertEqual(len(self.scene.costs), 1)
        self.scene.close()
        with self.assertRaisesRegex(voxtet.InvalidStateError, "closed"):
            self.scene.step()


class Ranks(unittest.TestCase):
    def test_parts_on_ranks_have_the_contacts_of_one_grid(self):
        for ranks in (1, 2, 5):
            with self.subTest(ranks=ranks):
                done = subprocess.run([*mpi_command(self, ranks), os.path.join(HERE, "mpi_ranks.py")],
                                      capture_output=True, text=True, timeout=300)
                self.assertEqual(done.returncode, 0, done.stderr[-3000:])
                self.assertIn(f"{ranks} ranks:", done.stdout)
                print(done.stdout, end="")

    def test_example(self):
        try:
            import voxtet.io  # noqa: F401
        except ImportError as missing:
            self.skipTest(str(missing))
        printed = set()
        for ranks in (1, 4):
            done = subprocess.run([*mpi_command(self, ranks), os.path.join(HERE, "..", "examples", "mpi_blocks.py")],
                                  capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 0, done.stderr[-3000:])
            printed.add(done.stdout)
        self.assertEqual(len(printed), 1, printed)
        self.assertRegex(printed.pop(), r"^([1-9]\d* contacts, hash [0-9a-f]{32}\n){3}forces .* 2 of 3 points are in bodies \[0, 1\]\n$")

    def test_meshes_of_dolfinx(self):
        asked = subprocess.run([sys.executable, "-c", "import dolfinx"], capture_output=True, text=True)
        if asked.returncode != 0:
            self.skipTest(asked.stderr.strip().splitlines()[-1])
        done = subprocess.run([*mpi_command(self, 3), os.path.join(HERE, "..", "examples", "mpi_dolfinx.py"), "6"],
                              capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        self.assertRegex(done.stdout, r"[1-9]\d* contacts between parts.*those of one grid")
        self.assertIn("20000 points: 0 in no tetrahedron", done.stdout)


if __name__ == "__main__":
    unittest.main()
