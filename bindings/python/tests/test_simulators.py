"""voxtet.mujoco, voxtet.newton, and the examples that step grids in other processes: each where its package is installed."""

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
        self.assertGreater(grid.penetrations.depth.max(), 0)
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
