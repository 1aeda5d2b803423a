"""The time of detection against the cell size, as in Sect. 5 of the paper: two bodies in contact, measured by `vox sweep`.

>>> import voxtet.io, voxtet.experiment
>>> ball = voxtet.io.make_lattice_ball(2000, 1)
>>> found = voxtet.experiment.sweep(ball, frames=2, share=0.02, count=6, rounds=2)
>>> found["fit"]["range"]["min"] <= found["optimum"]["cell_size"] <= found["fit"]["range"]["max"]
True
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from typing import Any

from . import io
from ._library import tool
from .errors import InvalidArgumentError


def sweep(*bodies: Any, **options: Any) -> dict[str, Any]:
    """What `vox sweep --json` prints of one body and its copy, or of two: paths of files, or meshes of voxtet.io, pyvista or
    meshio; of none with `ball=TETS`. The options are those of the command, with "_" for "-"; docs/command-line.md lists them and
    what is printed. `frames=2` is `--frames 2`, `axis=(1, 0, 0)` is `--axis 1 0 0`, and `as_placed=True` is `--as-placed`."""
    with tempfile.TemporaryDirectory() as folder:
        files = [body if isinstance(body, (str, bytes, os.PathLike)) else os.path.join(folder, f"{i}.msh")
                 for i, body in enumerate(bodies)]
        for body, file in zip(bodies, files):
            if file is not body:
                io.save(body, file)
        command = [tool(), "sweep", "--json", *files]
        for name, value in options.items():
            if value is not False:
                command.append("--" + name.replace("_", "-"))
            if not isinstance(value, bool):
                command += [str(v) for v in (value if isinstance(value, (tuple, list)) else [value])]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode:
        raise InvalidArgumentError(done.stderr.decode("utf-8", "replace").strip())
    found: dict[str, Any] = json.loads(done.stdout)
    return found
