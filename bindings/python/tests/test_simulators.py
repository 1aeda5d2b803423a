"""voxtet.mujoco, voxtet.newton, voxtet.ipctk, and the examples that step grids in other processes: each where its package is installed."""

import importlib.util
import os
import subprocess
import sys
import unittest

import numpy as np

import voxtet
from support import mpi_command

EXAMPLES = os.path.join(os.path.dirname(__file__), "..", "examples")


def needs(*packages):
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    return unittest.skipIf(missing, "not installed: " + ", ".join(missing))


def flex(name, position, dim=3):
    return (f'<flexcomp name="{name}" type="grid" dim="{dim}" count="3 3 {dim * 2 - 3}" spacing=".1 .1 .1" pos="{position}" '
            'mass="1"><edge equality="true"/><contact contype="0" conaffinity="0" selfcollide="none"/></flexcomp>')


@needs("mujoco")
class MuJoCo(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        import mujoco
        cls.mujoco = mujoco
        cls.model = mujoco.MjModel.from_xml_string(
            f'<mujoco><worldbody>{flex("cloth", "0 0 1", 2)}{flex("low", "0 0 0")}{flex("high", ".03 .02 .17")}'
            '</worldbody></mujoco>')

    def data(self):
        data = self.mujoco.MjData(self.model)
        self.mujoco.mj_forward(self.model, data)
        return data

    def test_contacts_are_those_of_the_positions(self):
        from voxtet.mujoco import Flex
        data = self.data()
        flex = Flex(self.model)
        grid = flex.step(data)
        self.assertEqual([mesh.tag for mesh in flex.meshes.values()], ["low", "high"])
        self.assertEqual(list(flex.meshes), [1, 2])
        self.assertGreater(len(grid.contacts), 0)
        self.assertLess(grid.find_constraints().gap.min(), 0)
        same = voxtet.Grid()
        for f in (1, 2):
            rows = slice(self.model.flex_vertadr[f], self.model.flex_vertadr[f] + self.model.flex_vertnum[f])
            same.add(data.flexvert_xpos[rows].copy(), flex.meshes[f].tets)
        same.step()
        self.assertEqual(same.hash, grid.hash)

    def test_positions_are_borrowed_from_whichever_data(self):
        from voxtet.mujoco import Flex
        first, second = self.data(), self.data()
        flex = Flex(self.model)
        for data in (first, second, first):
            flex.step(data)
            rows = self.model.flex_vertadr[2]
            self.assertEqual(flex.meshes[2].positions.ctypes.data, data.flexvert_xpos[rows:].ctypes.data)
        second.flexvert_xpos[:] += np.arange(len(second.flexvert_xpos))[:, None]
        self.assertNotEqual(flex.step(first).hash, flex.step(second).hash)
        alone = self.data()
        expected = flex.step(first).hash
        flex.step(alone)
        del alone  # the grid keeps it
        self.assertEqual(flex.grid.step(), None)
        self.assertEqual(flex.grid.hash, expected)

    def test_mistakes(self):
        from voxtet.mujoco import Flex
        with self.assertRaisesRegex(ValueError, '"cloth" has dim 2'):
            Flex(self.model, ["low", "cloth"])
        for wrong in ("nobody", 3, -1):
            with self.assertRaisesRegex(ValueError, f"no flex {wrong!r} among the 3 of the model"):
                Flex(self.model, [wrong])
        cloth = self.mujoco.MjModel.from_xml_string(f'<mujoco><worldbody>{flex("cloth", "0 0 1", 2)}</worldbody></mujoco>')
        with self.assertRaisesRegex(ValueError, "has 1 flexes, but none"):
            Flex(cloth)
        some = Flex(self.model, ["high"])
        with self.assertRaisesRegex(ValueError, "the data has 9 flex vertices, the model 63"):
            some.step(self.mujoco.MjData(cloth))
        self.assertEqual(len(some.step(self.data()).contacts), 0)


@needs("newton", "warp")
class Newton(unittest.TestCase):
    def test_contacts_are_those_of_the_particles(self):
        import newton
        import warp
        import voxtet.newton
        with warp.ScopedDevice("cpu"):
            builder = newton.ModelBuilder()
            for position in ((0, 0, 0), (0.3, 0.2, 0.7)):
                builder.add_soft_grid(pos=warp.vec3(*position), rot=warp.quat_identity(), vel=warp.vec3(), dim_x=3, dim_y=3, dim_z=3,
                                      cell_x=0.3, cell_y=0.3, cell_z=0.3, density=1, k_mu=1, k_lambda=1, k_damp=0)
            model = builder.finalize()
            state, other = model.state(), model.state()
        found = voxtet.newton.contacts(model, state)
        self.assertGreater(len(found), 0)
        positions = state.particle_q.numpy()
        same = voxtet.Grid()
        same.add(positions.copy(), model.tet_indices.numpy().reshape(-1, 4), self_collision=True)
        same.step()
        self.assertEqual(found.tobytes(), same.contacts.tobytes())
        particles = voxtet.newton.Particles(model)
        particles.step(state)
        self.assertEqual(particles.mesh.positions.ctypes.data, state.particle_q.ptr)
        other.particle_q.numpy()[64:] += 5  # the second body
        self.assertEqual(len(particles.step(other).contacts), 0)
        self.assertEqual(len(voxtet.newton.contacts(model, state)), len(found))


def edges_of(faces):
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(sides, axis=0)


def crumpled_sheets(side):
    """Two of them, one on its way through the other."""
    random = np.random.default_rng(1)
    i, j = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    flat = np.stack([i, j, np.zeros_like(i)], axis=-1).reshape(-1, 3) + 0.3 * random.random((side * side, 3))
    start = np.concatenate([flat, flat + [0.4, 0.3, 1]])
    corner = np.arange(side * side).reshape(side, side)
    quads = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[:-1, 1:], corner[1:, 1:]], axis=-1).reshape(-1, 4)
    faces = np.concatenate([quads[:, :3], quads[:, [2, 1, 3]]])
    end = start.copy()
    end[side * side:, 2] -= 1.5
    return start, end, np.concatenate([faces, faces + side * side])


@needs("ipctk")
class IpcToolkit(unittest.TestCase):
    KINDS = ("vertex_vertex", "edge_vertex", "edge_edge", "face_vertex", "edge_face", "face_face")

    @staticmethod
    def arrays(start, end, faces):
        return (np.asfortranarray(start), np.asfortranarray(end), np.asfortranarray(edges_of(faces).astype(np.int32)),
                np.asfortranarray(faces.astype(np.int32)))

    @staticmethod
    def names(candidates):
        """Kind and numbers; of a pair of one kind the lower one first."""
        fields = [[name for name in dir(c) if name.endswith("_id")] for c in candidates[:1]]
        found = [tuple(getattr(c, name) for name in fields[0]) for c in candidates]
        return sorted(tuple(sorted(pair)) if fields[0][0][-4].isdigit() else pair for pair in found)

    def test_all_kinds_are_those_of_brute_force(self):
        import ipctk
        from voxtet.ipctk import BroadPhase
        random = np.random.default_rng(3)
        start = random.random((40, 3))
        arrays = self.arrays(start, start + 0.4 * random.random((40, 3)), random.permutation(40)[:39].reshape(-1, 3))
        corners = {"vertex": np.arange(40)[:, None], "edge": arrays[2], "face": arrays[3]}
        every, some, brute = BroadPhase(), BroadPhase(), ipctk.BruteForce()
        some.can_vertices_collide = ipctk.CollisionFilter(lambda v, w: v % 3 != w % 3)
        for phase in (every, some, brute):
            phase.build(*arrays, 0.05)
        for kind in self.KINDS:
            found, filtered, expected = (self.names(getattr(phase, f"detect_{kind}_candidates")())
                                         for phase in (every, some, brute))
            self.assertEqual(found, expected, kind)
            a, b = (corners[name] for name in kind.split("_"))
            self.assertEqual(filtered, [(i, j) for i, j in expected if (a[i][:, None] % 3 != b[j] % 3).any()], kind)
            self.assertGreater(len(found), 10)
        self.assertLess(len(some.detect_vertex_vertex_candidates()), len(every.detect_vertex_vertex_candidates()))
        every.clear()
        self.assertEqual(every.detect_edge_edge_candidates(), [])

    def test_in_two_dimensions(self):
        """As in IPC Toolkit's own test of broad phases."""
        import ipctk
        from voxtet.ipctk import BroadPhase
        start = np.array([[1.11111, 0.5], [1.11111, 0.75], [1, 0.5], [1, 0.75]])
        end = start - [[0.222222, 0], [0.222222, 0], [0, 0], [0, 0]]
        mesh = ipctk.CollisionMesh(start, np.array([[1, 0], [2, 3]]), np.zeros((0, 3), int))
        found = []
        for phase in (BroadPhase(), ipctk.BruteForce()):
            candidates = ipctk.Candidates()
            candidates.build(mesh, start, end, 0, phase)
            self.assertFalse(candidates.is_step_collision_free(mesh, start, end))
            found.append(self.names(candidates.ev_candidates))
        self.assertEqual(found[0], found[1])
        self.assertEqual(len(found[0]), 4)

    def test_within_candidates(self):
        import ipctk
        from voxtet.ipctk import BroadPhase
        start, end, edges, faces = self.arrays(*crumpled_sheets(12))
        mesh = ipctk.CollisionMesh(start, edges, faces)
        found, steps = [], []
        for phase in (ipctk.SweepAndPrune(), BroadPhase(), BroadPhase(cull=True)):
            candidates = ipctk.Candidates()
            candidates.build(mesh, start, end, 1e-3, phase)
            found.append((self.names(candidates.ee_candidates), self.names(candidates.fv_candidates)))
            steps.append(candidates.compute_collision_free_stepsize(mesh, start, end))
        self.assertEqual(found[1], found[0])
        for kind in range(2):
            self.assertLess(set(found[2][kind]), set(found[1][kind]))
        self.assertTrue(0 < steps[0] < 1)
        self.assertEqual(len(set(steps)), 1, steps)


class Processes(unittest.TestCase):
    """The same grids, pickled, give the same hashes in any number of processes."""

    @classmethod
    def setUpClass(cls):
        sys.path.insert(0, EXAMPLES)
        try:
            import scenes
        finally:
            sys.path.remove(EXAMPLES)
        cls.expected = [f"{hash:016x} {depth:.6f}" for hash, depth in map(scenes.step, scenes.make(8))]

    def results(self, *command):
        path = [os.path.dirname(os.path.dirname(voxtet.__file__)), os.environ.get("PYTHONPATH", "")]
        done = subprocess.run(command, capture_output=True, text=True, timeout=500, cwd=EXAMPLES,
                              env={**os.environ, "PYTHONPATH": os.pathsep.join(path)})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.split("\n")[:-1]

    def check(self, command):
        """`command`: that for a number of processes."""
        self.assertEqual(len(set(self.expected)), 8)
        for processes in (1, 2, 8):
            self.assertEqual(self.results(*command(processes)), self.expected, f"{processes} processes")

    @needs("joblib")
    def test_joblib(self):
        self.check(lambda processes: [sys.executable, "with_joblib.py", str(processes)])

    @needs("distributed")
    def test_dask(self):
        self.check(lambda processes: [sys.executable, "with_dask.py", str(processes)])

    @needs("ray")
    def test_ray(self):
        self.check(lambda processes: [sys.executable, "with_ray.py", str(processes)])

    @needs("mpi4py")
    def test_mpi4py(self):
        self.check(lambda processes: [*mpi_command(self, processes + 1), "-m", "mpi4py.futures", "with_mpi4py.py"])


if __name__ == "__main__":
    unittest.main()
