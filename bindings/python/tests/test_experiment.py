"""The paper's experiment, by the native tool. Skipped where that or vox_io was not built."""

import os
import unittest
from unittest import mock

import numpy as np

import voxtet
from support import box

try:
    from voxtet import io
    from voxtet._library import tool
    from voxtet.experiment import sweep
    tool()
except (ImportError, voxtet.FileError) as missing:
    raise unittest.SkipTest(str(missing))

FEW = {"frames": 3, "share": 0.03, "count": 5, "rounds": 1}


class Sweeps(unittest.TestCase):
    def test_bodies(self):
        """A mesh, two, files and the tool's own ball; the same motion from each way to say it."""
        body = io.MeshData(*box(4, dtype=np.float64))
        found = sweep(body, **FEW)
        self.assertEqual((found["frames"], found["tets"], len(found["contact_share"]["frames"])), (3, 2 * len(body.tets), 3))
        self.assertTrue(0.015 < found["contact_share"]["mean"] < 0.06)
        self.assertEqual(sweep(body, body, engine="fast", **FEW)["hash"], found["hash"])
        self.assertNotEqual(sweep(body, as_placed=True, axis=(1, 2, 0), **FEW)["hash"], found["hash"])
        self.assertGreater(sweep(ball=1500, as_placed=False, **FEW)["tets"], 1500)

    def test_mistakes(self):
        for wrong, words in (({"share": 2}, "--share"), ({"share": 0.9}, "expected 0.9"), ({"bal": 2}, "--bal"),
                             ({"axis": (0, 0, 0)}, "--axis"), ({}, "needs a mesh file")):
            with self.assertRaisesRegex(voxtet.InvalidArgumentError, words):
                sweep(**({"ball": 1500, **FEW, **wrong} if wrong else {}))
        with self.assertRaisesRegex(voxtet.InvalidArgumentError, "no such file.msh"):
            sweep("no such file.msh")
        with mock.patch("os.path.exists", lambda path: False), self.assertRaisesRegex(voxtet.FileError, "the wheels have it"):
            sweep(ball=1500)


if __name__ == "__main__":
    unittest.main()
