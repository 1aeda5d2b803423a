"""The plugin vox.contact in MuJoCo: python test_contact.py, with VOX_MUJOCO (the plugin) and VOX_TOOL (the tool vox, may be
missing) in the environment; `check` does it. `python test_contact.py measure` prints what the plugin costs."""

import copy
import ctypes
import importlib.util
import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import mujoco
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
PLUGIN = os.environ["VOX_MUJOCO"]
TOOL = os.environ.get("VOX_TOOL", "")
mujoco.mj_loadPluginLibrary(PLUGIN)
LIBRARY = ctypes.CDLL(PLUGIN)  # its functions, and those of vox
LIBRARY.vox_mujoco_grid.restype = ctypes.c_void_p
SIDE = 0.2


def flex(name, position, count=4, rest='', dof="full", side=SIDE):
    return f"""<flexcomp name="{name}" type="grid" dim="3" count="{count} {count} {count}" dof="{dof}" mass="1" radius="0.001"
        spacing="{side / (count - 1)} {side / (count - 1)} {side / (count - 1)}" pos="{position}" {rest}>
        <contact contype="0" conaffinity="1" selfcollide="none"/>
        {'' if 'rigid' in rest else '<elasticity young="5e4" poisson="0.2" damping="0.002"/>'}</flexcomp>"""


def model(*bodies, gravity="0 0 -9.81", **config):
    keys = "".join(f'<config key="{key}" value="{value}"/>' for key, value in config.items())
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
        <option timestep="0.002" integrator="discrete" solver="CG" tolerance="1e-6" gravity="{gravity}"/>
        <extension><plugin plugin="vox.contact"><instance name="contact">{keys}</instance></plugin></extension>
        <worldbody><geom type="plane" size="2 2 .1"/>{"".join(bodies)}</worldbody>
        <sensor><plugin name="found" plugin="vox.contact" instance="contact"/></sensor></mujoco>""")


def overlapping(**config):
    """Two bodies without gravity, far from the floor, one a little inside the other."""
    return model(flex("low", "0 0 1"), flex("high", f".031 .017 {1 + 0.93 * SIDE}"), gravity="0 0 0", **config)


class MeshInfo(ctypes.Structure):
    """vox_body_info, up to its positions."""

    _fields_ = [("struct_size", ctypes.c_uint32), ("before", ctypes.c_char * 36), ("positions", ctypes.c_void_p)]


def grid_of(data):
    return ctypes.c_void_p(LIBRARY.vox_mujoco_grid(ctypes.c_void_p(data._address), 0))


def grid_hash(data):
    value = ctypes.c_uint64()
    assert LIBRARY.vox_grid_get_hash(grid_of(data), ctypes.byref(value)) == 0
    return value.value


def contact_forces(m, d):
    """What the plugin adds to the passive forces of dofs that are sliders: a row for three of them."""
    mujoco.mj_forward(m, d)
    both = d.qfrc_passive.copy()
    m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    mujoco.mj_forward(m, d)
    m.opt.disableflags = 0
    return (both - d.qfrc_passive).reshape(-1, 3)


def vertices(m, d, name):
    flex_id = mujoco.mj_name2id(m, mujoco.mjtObj.mjOBJ_FLEX, name)
    first = m.flex_vertadr[flex_id]
    return slice(first, first + m.flex_vertnum[flex_id])


class TwoBodies(unittest.TestCase):
    def test_they_fall_on_each_other_and_rest(self):
        m = model(flex("low", f"0 0 {0.51 * SIDE}"), flex("high", f".031 .017 {1.8 * SIDE}"))
        d = mujoco.MjData(m)
        low, high = vertices(m, d, "low"), vertices(m, d, "high")
        mass = m.body_mass[m.dof_bodyid]  # each vertex is a body with three sliders

        def kinetic():
            return 0.5 * float(mass @ d.qvel**2)

        def height():
            return float(m.body_mass[m.flex_vertbodyid] @ d.flexvert_xpos[:, 2])

        mujoco.mj_step(m, d)
        energy = kinetic() + 9.81 * height()
        greatest = deepest = 0
        for _ in range(400):
            mujoco.mj_step(m, d)
            greatest = max(greatest, kinetic() + 9.81 * height())
            deepest = max(deepest, d.sensor("found").data[1])
        self.assertLess(greatest, energy * 1.01)
        count, depth = d.sensor("found").data
        self.assertGreater(count, 0)
        self.assertLess(deepest, 0.1 * SIDE)
        self.assertLess(depth, 0.02 * SIDE)
        self.assertLess(kinetic(), 1e-3)
        gap = d.flexvert_xpos[high, 2].mean() - d.flexvert_xpos[low, 2].mean()
        self.assertGreater(gap, 0.9 * SIDE)
        self.assertLess(gap, 1.1 * SIDE)

    def test_without_stiffness_they_fall_through_each_other(self):
        m = model(flex("low", f"0 0 {0.51 * SIDE}"), flex("high", f".031 .017 {1.8 * SIDE}"), stiffness=0)
        d = mujoco.MjData(m)
        for _ in range(150):
            mujoco.mj_step(m, d)
        self.assertGreater(d.sensor("found").data[1], 0.2 * SIDE)
        gap = d.flexvert_xpos[vertices(m, d, "high"), 2].mean() - d.flexvert_xpos[vertices(m, d, "low"), 2].mean()
        self.assertLess(gap, 0.8 * SIDE)

    def test_forces_keep_momentum_and_separate(self):
        m = overlapping()
        d = mujoco.MjData(m)
        d.qvel[:] = np.random.default_rng(1).normal(size=m.nv) * 0.01
        force = contact_forces(m, d)  # dofs are those of the vertices, in their order
        greatest = abs(force).sum()
        self.assertGreater(greatest, 0)
        self.assertLess(abs(force.sum(axis=0)).max(), 1e-12 * greatest)
        self.assertLess(abs(np.cross(d.flexvert_xpos - d.flexvert_xpos[0], force).sum(axis=0)).max(), 1e-7 * greatest)
        self.assertGreater(force[vertices(m, d, "high"), 2].sum(), 0)

    def test_friction_is_that_of_the_flexes(self):
        def pulls(friction):
            m = overlapping()
            m.flex_friction[:, 0] = friction
            d = mujoco.MjData(m)
            d.qvel.reshape(-1, 3)[vertices(m, d, "high"), 0] = 0.5
            mujoco.mj_forward(m, d)
            force = d.qfrc_passive.reshape(-1, 3)[vertices(m, d, "high")].sum(axis=0)
            return force[0], force[2]
        none, normal = pulls(0)
        some, same = pulls(0.5)
        self.assertAlmostEqual(normal, same, delta=0.2 * normal)
        self.assertLess(some, none - 0.2 * normal)

    def test_a_rigid_flex_gets_force_and_torque(self):
        m = model(flex("soft", "0 0 1"), f'<body name="box" pos=".031 .017 {1 + 0.93 * SIDE}"><freejoint/>'
                  '<geom size=".01" mass="1" contype="0" conaffinity="0"/>' + flex("hard", "0 0 0", rest='rigid="true"') + "</body>", gravity="0 0 0")
        d = mujoco.MjData(m)
        mujoco.mj_forward(m, d)
        body = m.body("box")
        free = m.jnt_dofadr[body.jntadr[0]]
        soft = d.flexvert_xpos[vertices(m, d, "soft")]
        sliders = d.qfrc_passive[:free].reshape(-1, 3)
        force, torque = d.qfrc_passive[free:free + 3], d.xmat[body.id].reshape(3, 3) @ d.qfrc_passive[free + 3:free + 6]
        self.assertGreater(force[2], 0)
        self.assertLess(abs(sliders.sum(axis=0) + force).max(), 1e-10 * force[2])
        angular = np.cross(soft - d.xpos[body.id], sliders).sum(axis=0) + torque
        self.assertLess(abs(angular).max(), 1e-6 * force[2])


class Nodes(unittest.TestCase):
    """Flexes whose vertices are interpolated from nodes."""

    KINDS = [("trilinear", "1 1 1"), ("trilinear", "2 1 3"), ("quadratic", "1 1 1"), ("quadratic", "2 2 1")]

    def test_forces_are_those_of_the_vertices_by_the_weights_of_the_nodes(self):
        def bodies(**dof):
            return [flex("low", "0 0 1", **dof), flex("high", f".031 .017 {1 + 0.93 * SIDE}", **dof)]
        config = {"stiffness": 100, "damping": 3}
        full = model(*bodies(), gravity="0 0 0", **config)
        for dof, cells in self.KINDS:
            m = model(*bodies(dof=dof, rest=f'cellcount="{cells}"'), gravity="0 0 0", **config)
            d, of_vertices = mujoco.MjData(m), mujoco.MjData(full)
            mujoco.mj_forward(m, d)
            start = d.flexvert_xpos.copy()
            weights = np.zeros((len(start), m.nv // 3))  # how MuJoCo moves vertices when a node moves
            for dof_id in range(0, m.nv, 3):
                d.qpos[:] = 0
                d.qpos[dof_id] = 1
                mujoco.mj_kinematics(m, d)
                mujoco.mj_comPos(m, d)
                mujoco.mj_flex(m, d)
                weights[:, dof_id // 3] = np.linalg.norm(d.flexvert_xpos - start, axis=1) * np.sign((d.flexvert_xpos - start).sum(axis=1))
            rng = np.random.default_rng(5)
            d.qpos[:] = 0.004 * rng.normal(size=m.nv)
            d.qvel[:] = 0.3 * rng.normal(size=m.nv)
            forces = contact_forces(m, d)
            of_vertices.qpos[:] = (d.flexvert_xpos - start).ravel()
            of_vertices.qvel[:] = (weights @ d.qvel.reshape(-1, 3)).ravel()
            vertex_forces = contact_forces(full, of_vertices)
            self.assertGreater(abs(vertex_forces).max(), 0.1, (dof, cells))
            np.testing.assert_allclose(forces, weights.T @ vertex_forces, rtol=0, atol=1e-8 * abs(vertex_forces).max())

    def test_they_fall_on_each_other_and_rest(self):
        for dof, cells in self.KINDS:
            rest = f'cellcount="{cells}"'
            m = model(flex("low", f"0 0 {0.51 * SIDE}", dof=dof, rest=rest), flex("high", f".003 .002 {1.7 * SIDE}", dof=dof, rest=rest))
            m.opt.timestep = 0.001
            d = mujoco.MjData(m)
            for _ in range(800):
                mujoco.mj_step(m, d)
            count, depth = d.sensor("found").data
            self.assertGreater(count, 0, (dof, cells))
            self.assertLess(depth, 0.03 * SIDE, (dof, cells))
            self.assertLess(abs(d.qvel).max(), 0.05, (dof, cells))

    def test_a_pinned_corner_is_carried_by_the_body_it_is_pinned_to(self):
        pinned = flex("high", f".031 .017 {1 + 0.93 * SIDE}", dof="trilinear").replace("</flexcomp>", '<pin id="4 5"/></flexcomp>')
        m = model(flex("low", "0 0 1"), f'<body name="holder"><freejoint/><geom size=".01" mass="1" contype="0" conaffinity="0"/>{pinned}</body>', gravity="0 0 0")
        d = mujoco.MjData(m)
        mujoco.mj_forward(m, d)
        low = d.qfrc_passive[:3 * 64].reshape(-1, 3).sum(axis=0)
        free = m.jnt_dofadr[np.flatnonzero(m.jnt_type == mujoco.mjtJoint.mjJNT_FREE)[0]]
        self.assertLess(low[2], 0)
        self.assertLess(abs(low + d.qfrc_passive[free:free + 3]).max(), 1e-6 * abs(low[2]))


class Excluded(unittest.TestCase):
    def test_elements_take_no_part(self):
        every = overlapping().flex_elemnum[0]
        counts = []
        for text in ("", f"low:0-{every // 2} low:{every - 1}", f"high:0-{every - 1}", f"low:0-{every - 1}"):
            m = overlapping(**({"exclude": text} if text else {}))
            d = mujoco.MjData(m)
            mujoco.mj_forward(m, d)
            counts.append(d.sensor("found").data[0])
        self.assertTrue(counts[0] > counts[1] > 0, counts)
        self.assertEqual(counts[2:], [0, 0])

    def test_of_its_mistakes(self):
        for text, pattern in (("nobody:1", "nobody:1.*not a flex"), ("low", '"low".*not a flex'), ("low:5-2", "elements 0 to"),
                              ("low:1x", "elements 0 to"), ("low:-1", "elements 0 to"), ("low:99999", "elements 0 to")):
            with self.assertRaisesRegex(ValueError, "vox.contact: exclude has.*" + pattern):
                overlapping(exclude=text)

class Geoms(unittest.TestCase):
    def world(self, geom, *more, position="0 0 .15", assets="", **config):
        """A flex above a geom, which MuJoCo does not collide with it."""
        return mujoco.MjModel.from_xml_string(f"""<mujoco><option timestep="0.002" integrator="discrete" solver="CG" tolerance="1e-6"/>
            <extension><plugin plugin="vox.contact"><instance name="contact"><config key="geoms" value="{config.get('geoms', 'g')}"/>
            </instance></plugin></extension><asset>{assets}</asset><worldbody>{geom}{flex("soft", position)}{"".join(more)}</worldbody>
            <sensor><plugin name="found" plugin="vox.contact" instance="contact"/></sensor></mujoco>""")

    def test_a_flex_rests_on_each_kind(self):
        pad = 'contype="0" conaffinity="0" friction="1 0 0"'
        assets = """<hfield name="h" nrow="3" ncol="3" size=".5 .4 .1 .1" elevation="0 0 0 0 0 0 0 0 1"/>
            <mesh name="m" vertex="-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 0  1 -1 0  -1 1 0  1 1 0"
              face="0 2 1  1 2 3  4 5 6  5 7 6  0 1 4  1 5 4  2 6 3  3 6 7  0 4 2  2 4 6  1 3 5  3 7 5"/>"""
        # Of each kind its height at the top.
        for geom, top in ((f'<geom name="g" type="plane" size="1 1 .1" {pad}/>', 0),
                          (f'<geom name="g" type="sphere" size=".8" pos="0 0 -.8" {pad}/>', 0),
                          (f'<geom name="g" type="capsule" size=".5 1" euler="90 0 0" pos="0 0 -.5" {pad}/>', 0),
                          (f'<geom name="g" type="cylinder" size=".6 .2" pos="0 0 -.2" {pad}/>', 0),
                          (f'<geom name="g" type="box" size=".5 .5 .2" pos="0 0 -.2" {pad}/>', 0),
                          (f'<geom name="g" type="hfield" hfield="h" {pad}/>', 0),
                          (f'<geom name="g" type="mesh" mesh="m" {pad}/>', 0)):
            m = self.world(geom, assets=assets)
            d = mujoco.MjData(m)
            for _ in range(500):
                mujoco.mj_step(m, d)
            count, depth = d.sensor("found").data
            self.assertGreater(count, 0, geom)
            self.assertLess(depth, 0.05 * SIDE, geom)
            self.assertAlmostEqual(d.flexvert_xpos[:, 2].mean(), top + SIDE / 2, delta=0.25 * SIDE, msg=geom)

    def test_force_and_torque_on_the_body_of_a_geom_are_opposite(self):
        m = self.world('<body name="tool" pos="0 0 .42"><freejoint/>'
                       '<geom name="g" type="box" size=".15 .15 .1" pos=".1 .03 0" mass="1" contype="0" conaffinity="0"/></body>', position="0 0 .23")
        d = mujoco.MjData(m)
        mujoco.mj_forward(m, d)
        with_plugin = d.qfrc_passive.copy()
        m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
        mujoco.mj_forward(m, d)
        change = with_plugin - d.qfrc_passive
        tool = m.body("tool")
        free = m.jnt_dofadr[tool.jntadr[0]]
        force, torque = change[free:free + 3], d.xmat[tool.id].reshape(3, 3) @ change[free + 3:free + 6]
        sliders = np.delete(change, np.s_[free:free + 6]).reshape(-1, 3)
        self.assertGreater(force[2], 0)
        self.assertLess(abs(sliders.sum(axis=0) + force).max(), 1e-10 * force[2])
        angular = np.cross(d.flexvert_xpos - d.xpos[tool.id], sliders).sum(axis=0) + torque
        self.assertLess(abs(angular).max(), 1e-6 * force[2])

    def test_mistakes(self):
        pad = 'contype="0" conaffinity="0"'
        for geom, names, pattern in ((f'<geom name="g" size=".1" {pad}/>', "g h", 'geoms names "h", but no geom'),
                                     (f'<geom name="g" type="ellipsoid" size=".1 .1 .2" {pad}/>', "g", "is an ellipsoid"),
                                     ('<geom name="g" size=".1"/>', "g", 'MuJoCo collides geom "g" with flex 0 "soft", too')):
            with self.assertRaisesRegex(ValueError, pattern):
                self.world(geom, geoms=names)


class Contacts(unittest.TestCase):
    def write(self, m, d, flex_id, name):
        first, count = m.flex_vertadr[flex_id], m.flex_vertnum[flex_id]
        tets = m.flex_elem[m.flex_elemdataadr[flex_id]:][:4 * m.flex_elemnum[flex_id]].reshape(-1, 4)
        with open(name + ".node", "w") as out:
            print(count, 3, 0, 0, file=out)
            for i, p in enumerate(d.flexvert_xpos[first:first + count].tolist()):
                print(i, *map(repr, p), file=out)
        with open(name + ".ele", "w") as out:
            print(len(tets), 4, 0, file=out)
            for i, tet in enumerate(tets.tolist()):
                print(i, *tet, file=out)
        return name + ".node"

    @unittest.skipUnless(os.path.exists(TOOL), "the tool vox is not built")
    def test_they_are_those_of_the_command_line(self):
        m = overlapping()
        d = mujoco.MjData(m)
        for _ in range(3):
            mujoco.mj_step(m, d)
        mujoco.mj_forward(m, d)
        with tempfile.TemporaryDirectory() as folder:
            files = [self.write(m, d, i, os.path.join(folder, f"flex{i}")) for i in range(2)]
            found = json.loads(subprocess.run([TOOL, "collide", "--double", "--json", *files], check=True,
                                              capture_output=True, timeout=120).stdout)
        self.assertGreater(found["contact_count"], 0)
        self.assertEqual(f"{grid_hash(d):016x}", found["hash"])
        count, depth = d.sensor("found").data
        self.assertEqual(count, len(found["constraints"]))
        self.assertAlmostEqual(depth, max(-c["gap"] for c in found["constraints"]), places=6)

    def test_positions_are_borrowed(self):
        m = overlapping()
        d = mujoco.MjData(m)
        mujoco.mj_forward(m, d)
        grid, meshes, count = grid_of(d), (ctypes.c_uint32 * 2)(), ctypes.c_uint64()
        LIBRARY.vox_grid_get_bodies(grid, meshes, ctypes.c_uint64(2), ctypes.byref(count))
        self.assertEqual(count.value, 2)
        for mesh, name in zip(meshes, ("low", "high")):
            info = MeshInfo(struct_size=ctypes.sizeof(MeshInfo))
            LIBRARY.vox_body_get_info(grid, mesh, ctypes.byref(info))
            self.assertEqual(info.positions, d.flexvert_xpos[vertices(m, d, name)].ctypes.data)

    def test_self_contact_is_found_where_it_is_asked_for(self):
        for wanted in ("false", "true"):
            m = model(flex("one", "0 0 1"), gravity="0 0 0", self=wanted, rings=1)
            d = mujoco.MjData(m)
            mujoco.mj_forward(m, d)
            positions = d.flexvert_xpos
            top, bottom = positions[:, 2] > 1.099, positions[:, 2] < 0.901
            self.assertTrue(top.any() and bottom.any())
            positions[top, 2] -= 0.19 - 0.02 * positions[top, 0]  # fold the top into what is below
            mujoco.mj_passive(m, d)
            self.assertEqual(grid_hash(d) != self.empty(), wanted == "true")

    def empty(self):
        m = model(flex("one", "0 0 1"), gravity="0 0 0")
        d = mujoco.MjData(m)
        mujoco.mj_forward(m, d)
        return grid_hash(d)


class Mistakes(unittest.TestCase):
    def fails(test, pattern, *bodies, **config):  # `self` is a setting
        with test.assertRaisesRegex(ValueError, "vox.contact: " + pattern):  # MuJoCo makes an mjData to compile a model
            model(*(bodies or (flex("low", "0 0 1"),)), **config)

    def test_of_numbers(self):
        self.fails(r'stiffness = "soft" is not a number', stiffness="soft")
        self.fails(r'stiffness = "1 2" is not a number', stiffness="1 2")
        self.fails(r'timeconst = "nan" is not a number', timeconst="nan")
        self.fails(r"timeconst = -1 is not a number in \[0, inf\]", timeconst="-1")
        self.fails(r"damping = -0.5 is not a number in \[0, inf\]", damping="-0.5")
        self.fails(r"self = 2 is not a whole number in \[0, 1\]", self="2")
        self.fails(r"rings = 9 is not a whole number in \[0, 8\]", rings="9")
        self.fails(r"rings = 1.5 is not a whole number in \[0, 8\]", rings="1.5")
        self.fails(r"workers = 1e\+09 is not a whole number in \[0, 256\]", workers="1e9")
        for key in ("workers", "rings", "stiffness", "damping", "timeconst"):
            self.fails(key + r' = "true" is not a number', **{key: "true"})
        self.fails(r'self = "' + "x" * 100 + '" is not a number', self="x" * 5000)

    def test_of_names(self):
        self.fails(r'flexes names "nobody", but no flex of the model', flexes="low nobody")
        with self.assertRaisesRegex(ValueError, "stifness"):
            model(flex("low", "0 0 1"), stifness="1")

    def test_of_models(self):
        cloth = '<flexcomp name="cloth" type="grid" dim="2" count="3 3 1" spacing=".1 .1 .1" pos="0 0 1" mass="1"/>'
        self.fails(r"the model has 1 flexes, but none of tetrahedra", cloth)
        self.fails(r'flex "cloth" has dim 2', flex("low", "0 0 1"), cloth, flexes="cloth")
        self.fails(r'flex 0 "low" is a shell', flex("low", "0 0 1", dof="trilinear").replace("<elasticity", '<elasticity elastic2d="both" thickness=".01"'))
        d = mujoco.MjData(model(flex("low", "0 0 1"), cloth))  # the cloth takes no part
        self.assertEqual(d.sensor("found").data.tolist(), [0, 0])

    def test_a_bad_position_is_reported_once_and_forgotten(self):
        m = overlapping()
        d = mujoco.MjData(m)
        mujoco.mj_forward(m, d)
        count = d.sensor("found").data[0]
        warnings = []
        mujoco.set_mju_user_warning(warnings.append)
        try:
            for _ in range(3):
                d.flexvert_xpos[7, 1] = np.nan
                mujoco.mj_passive(m, d)
            mujoco.mj_forward(m, d)
        finally:
            mujoco.set_mju_user_warning(None)
        self.assertEqual(len(warnings), 1, warnings)
        self.assertRegex(warnings[0], "vox.contact: no forces: .*vertex 7")
        self.assertEqual(d.sensor("found").data[0], count)

    def test_what_turns_it_off_empties_the_sensor(self):
        m = overlapping()
        d = mujoco.MjData(m)
        off = mujoco.mjtDisableBit
        for flags in (off.mjDSBL_CONTACT, off.mjDSBL_SPRING | off.mjDSBL_DAMPER):
            m.opt.disableflags = 0
            mujoco.mj_forward(m, d)
            self.assertGreater(d.sensor("found").data[0], 0)
            m.opt.disableflags = flags
            mujoco.mj_forward(m, d)
            self.assertEqual(d.sensor("found").data.tolist(), [0, 0])

    def test_a_grid_of_nothing(self):
        m = overlapping()
        d = mujoco.MjData(m)
        self.assertIsNone(LIBRARY.vox_mujoco_grid(None, 0))
        for instance in (-1, 1, 1 << 30):
            self.assertIsNone(LIBRARY.vox_mujoco_grid(ctypes.c_void_p(d._address), instance))


class SeveralData(unittest.TestCase):
    @staticmethod
    def run_to(m, start, steps, out, place):
        d = mujoco.MjData(m)
        d.qvel[:] = start
        for _ in range(steps):
            mujoco.mj_step(m, d)
        out[place] = (d.qpos.copy(), grid_hash(d), d.sensor("found").data.copy())

    def test_of_one_model_in_threads(self):
        m = overlapping()
        starts = [0.02 * i for i in range(4)]
        alone, together = [None] * 4, [None] * 4
        for i, start in enumerate(starts):
            self.run_to(m, start, 20, alone, i)
        threads = [threading.Thread(target=self.run_to, args=(m, start, 20, together, i)) for i, start in enumerate(starts)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for a, b in zip(alone, together):
            np.testing.assert_array_equal(a[0], b[0])
            self.assertEqual(a[1], b[1])
            np.testing.assert_array_equal(a[2], b[2])

    @unittest.skipUnless(importlib.util.find_spec("mujoco.batch"), "this MuJoCo has no batches")
    def test_a_batch_is_a_loop(self):
        from mujoco.batch import Batch
        m, count = overlapping(self="true", rings=1), 64
        rng = np.random.default_rng(3)
        starts = 0.02 * rng.normal(size=(count, m.nv))
        alone = []
        for start in starts:
            d = mujoco.MjData(m)
            d.qvel[:] = start
            for _ in range(10):
                mujoco.mj_step(m, d)
            alone.append((d.qpos.copy(), d.qvel.copy(), d.sensordata.copy()))
        batch = Batch(m, nsim=count, nthread=3)  # simulations share three mjData
        qpos, qvel, found = batch.bind("qpos"), batch.bind("qvel"), batch.bind("sensordata")
        qvel[:] = starts
        for _ in range(10):
            batch.step()
        np.testing.assert_array_equal(qpos, [a[0] for a in alone])
        np.testing.assert_array_equal(qvel, [a[1] for a in alone])
        np.testing.assert_array_equal(found, [a[2] for a in alone])
        self.assertGreater(found[:, 0].min(), 0)

    def test_a_copy_goes_on_alike_and_a_reset_begins_anew(self):
        m = overlapping(workers=2)
        d = mujoco.MjData(m)
        for _ in range(5):
            mujoco.mj_step(m, d)
        twin = copy.copy(d)
        for _ in range(5):
            mujoco.mj_step(m, d)
            mujoco.mj_step(m, twin)
        np.testing.assert_array_equal(d.qpos, twin.qpos)
        self.assertEqual(grid_hash(d), grid_hash(twin))
        mujoco.mj_resetData(m, twin)
        again = mujoco.MjData(m)
        for _ in range(10):
            mujoco.mj_step(m, twin)
            mujoco.mj_step(m, again)
        np.testing.assert_array_equal(twin.qpos, again.qpos)

    def test_a_model_may_go_before_its_data(self):
        m = overlapping()
        d = mujoco.MjData(m)
        mujoco.mj_step(m, d)
        twin = copy.deepcopy(m)
        del m
        mujoco.mj_step(twin, d)
        self.assertGreater(d.sensor("found").data[0], 0)


class Readme(unittest.TestCase):
    def test_its_program_runs_and_rests(self):
        with open(os.path.join(HERE, "README.md"), encoding="utf-8") as file:
            text = file.read()
        xml, = re.findall(r"```xml\n(.*?)```", text, re.S)
        program, = re.findall(r"```python\n(.*?)```", text, re.S)
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "two_bodies.xml"), "w", encoding="utf-8") as out:
                out.write(xml)
            printed = subprocess.run([sys.executable, "-c", program.replace("libvox_mujoco.so", PLUGIN)], cwd=folder,
                                     check=True, capture_output=True, text=True, timeout=500).stdout
        count, depth = map(float, printed.split())
        self.assertGreater(count, 0)
        self.assertLess(depth, 0.002)


def measure():
    """Processor time of a step of two bodies of 20,250 tets, and of the plugin in it: the difference that it makes to
    mj_passive, at positions that change. Least of several."""
    m = model(flex("low", f"0 0 {0.51 * SIDE}", 16), flex("high", f".031 .017 {1.49 * SIDE}", 16))
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    print("tets", m.flex_elemnum.tolist(), "dofs", m.nv, flush=True)

    def least(repeats, function, between=lambda: None):
        times = []
        for _ in range(repeats):
            between()
            began = time.thread_time()
            function()
            times.append(time.thread_time() - began)
        return 1e3 * min(times)

    step = least(5, lambda: mujoco.mj_step(m, d))
    print("penetrations", d.sensor("found").data[0], "deepest", d.sensor("found").data[1], f"mj_step {step:.2f} ms", flush=True)
    rng = np.random.default_rng(0)

    def move():
        d.flexvert_xpos[:] += rng.normal(size=d.flexvert_xpos.shape) * 1e-7

    with_plugin = least(20, lambda: mujoco.mj_passive(m, d), move)
    m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    without = least(20, lambda: mujoco.mj_passive(m, d), move)
    plugin = with_plugin - without
    print(f"mj_step {step:.2f} ms, plugin {plugin:.3f} ms: {100 * plugin / step:.2f} % of it")


if __name__ == "__main__":
    if sys.argv[1:] == ["measure"]:
        measure()
    else:
        unittest.main()
