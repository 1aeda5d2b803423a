"""vox.contact beside MuJoCo's own contacts of flexes: two boxes start inside each other, without gravity, and have half a second to part.
python compare.py, with VOX_MUJOCO (the plugin) in the environment, prints the table of README.md."""

import os
import time

import mujoco
import numpy as np

mujoco.mj_loadPluginLibrary(os.environ["VOX_MUJOCO"])
SIDE, COUNT, STEPS = 0.2, 8, 250
WAYS = {"vox.contact": 'contype="0" conaffinity="1"', "contacts": "", 'passive="true"': 'passive="true"'}


def scene(way, dof, overlap):
    """A plugin without stiffness only measures."""
    keys = "" if way == "vox.contact" else '<config key="stiffness" value="0"/><config key="damping" value="0"/>'
    bodies = "".join(f"""<flexcomp name="{name}" type="grid" dim="3" dof="{dof}" count="{COUNT} {COUNT} {COUNT}" mass="1" radius=".001"
        spacing="{SIDE / (COUNT - 1)} {SIDE / (COUNT - 1)} {SIDE / (COUNT - 1)}" pos="{pos}">
        <contact {WAYS[way]} selfcollide="none"/><elasticity young="5e4" poisson=".2" damping=".002"/></flexcomp>"""
                     for name, pos in (("low", "0 0 1"), ("high", f".031 .017 {1 + (1 - overlap) * SIDE}")))
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
        <option timestep=".002" integrator="discrete" solver="CG" tolerance="1e-6" gravity="0 0 0"/><size memory="200M"/>
        <extension><plugin plugin="vox.contact"><instance name="contact">{keys}</instance></plugin></extension>
        <worldbody>{bodies}</worldbody><sensor><plugin name="found" plugin="vox.contact" instance="contact"/></sensor></mujoco>""")


mujoco.set_mju_user_warning(lambda text: None)
print("| flexes | depth at first, mm | contacts by | vertices inside, after 0.5 s | depth, mm | step, ms |\n|---|---:|---|---:|---:|---:|")
for dof in ("full", "trilinear"):
    for overlap in (0.05, 0.3, 0.6):
        for way in WAYS:
            m = scene(way, dof, overlap)
            d = mujoco.MjData(m)
            mujoco.mj_forward(m, d)
            first, times = d.sensor("found").data[1], []
            for _ in range(STEPS):
                began = time.thread_time()
                mujoco.mj_step(m, d)
                times.append(time.thread_time() - began)
            mujoco.mj_forward(m, d)
            count, depth = d.sensor("found").data
            print(f"| `{dof}` | {1e3 * first:.0f} | {way} | {count:.0f} | {1e3 * depth:.1f} | {1e3 * np.median(times):.2f} |", flush=True)
