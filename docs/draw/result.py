"""A result as ParaView shows it: a body, coloured by how deep its vertices are in another, from a run of the tool."""

import os
import subprocess
import tempfile
import xml.etree.ElementTree as ET

import numpy as np

from canvas import B, LINE, MARK, Drawing, View, circle

PLACE = np.array([.5, -.9, .45])
RADIUS = .62  # of the ball at PLACE
LEVELS = 8
COMMAND = "vox collide a.msh b.msh -o result.vtu"


def result():
    """What the file of COMMAND has: points, tetrahedra, depths in the ball, and the body of each point."""
    import voxtet.io
    from voxtet import _library
    with tempfile.TemporaryDirectory() as folder:
        voxtet.io.save(voxtet.io.make_torus(1, .42, .26), f"{folder}/a.msh")
        ball = voxtet.io.make_ball(RADIUS, .15)
        voxtet.io.save(voxtet.io.MeshData(ball.positions + PLACE, ball.tets), f"{folder}/b.msh")
        command = [os.path.abspath(_library.tool()), *COMMAND.split()[1:]]
        subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
        arrays = {}
        for array in ET.parse(f"{folder}/result.vtu").iter("DataArray"):
            arrays.setdefault(array.get("Name"), np.array(array.text.split(), float))
    points, tets, mesh = arrays["Points"].reshape(-1, 3), arrays["connectivity"].astype(int).reshape(-1, 4), arrays["mesh"]
    return points, tets, np.where(mesh == 0, -arrays["gap"], 0), mesh


def drawn():
    import voxtet.io
    points, tets, depth, mesh = result()
    drawing = Drawing(400, "A result in ParaView: a torus, coloured by the depth of its vertices in a ball")
    view, most = View(-24, 42, 150, (.05, 0, 0), (300, 190)), depth.max()

    def amount(level):
        return .25 + .75 * level / LEVELS if level else 0

    faces = []
    for t in voxtet.io.boundary(tets[mesh[tets[:, 0]] == 0]):
        level = int(np.ceil(depth[t].mean() / most * LEVELS))
        faces.append((points[t], MARK if level else "grey", amount(level) or .22, "grey"))
    drawing.solids(view, faces, lamp=False)
    x, y = view.at(PLACE)
    drawing.veil(circle(x, y, RADIUS * view.scale), B, .05)
    drawing.stroke(circle(x, y, RADIUS * view.scale), B, LINE, "6 5")
    for level in range(LEVELS):
        drawing.fill(f"M600 {300 - 28 * level}h26v-28h-26z", MARK, amount(level + 1))
    drawing.label(640, 307, "0", anchor="start")
    drawing.label(640, 83, f"{most:.2f}", anchor="start")
    drawing.label(613, 48, "depth")
    drawing.label(350, 384, COMMAND, "axis", size=18)
    return drawing
