"""The tool on Windows, or under Wine: names in UTF-8, the same bytes printed as elsewhere, exit codes."""

import json
import os
import subprocess
import tempfile
import unittest

COMMAND = [*os.environ.get("VOX_EMULATOR", "").split(), os.environ["VOX_TOOL"]]
HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "..", "data")
# Letters that no code page of Windows has all of.
NAME = "Würfel 立方体 куб"


def run(*arguments, folder=None):
    return subprocess.run([*COMMAND, *arguments], capture_output=True, cwd=folder, timeout=300,
                          env={**os.environ, "WINEDEBUG": "-all"})


class Tool(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def run_here(self, *arguments):
        done = run(*arguments, folder=self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, b""), done.stderr.decode(errors="replace"))
        return done.stdout

    def copy(self, source, name):
        with open(os.path.join(DATA, source), "rb") as read, open(os.path.join(self.folder, name), "wb") as write:
            write.write(read.read())
        return name

    def test_names_in_utf8(self):
        mesh = self.copy("box_41.msh", NAME + ".msh")
        out = self.run_here("info", mesh, "--json")
        self.assertNotIn(b"\r", out)
        self.assertIn(NAME, json.dumps(json.loads(out), ensure_ascii=False))
        self.copy("box.ele", NAME + ".ele")  # found beside the .node
        for source in ("box_30_binary.vtk", "box_appended_base64_zlib.vtu", "box.node"):
            mesh = self.copy(source, NAME + os.path.splitext(source)[1])
            self.assertIn(NAME.encode(), self.run_here("info", mesh))

    def test_files_that_are_written(self):
        mesh = self.copy("box_41.msh", "box.msh")
        snapshot, drawing = NAME + ".vox", NAME + ".svg"
        self.run_here("collide", mesh, mesh, "--save", snapshot)
        self.assertTrue(os.path.getsize(os.path.join(self.folder, snapshot)) > 100)
        self.run_here("suggest", mesh, "--svg", drawing)
        with open(os.path.join(self.folder, drawing), "rb") as file:
            self.assertIn(b"<svg", file.read())
        self.run_here("replay", snapshot)

    def test_a_surface_becomes_tetrahedra(self):
        surface = self.copy("cube.obj", NAME + ".obj")
        self.run_here("tetrahedralize", surface, NAME + ".msh")
        self.assertIn(b"tets", self.run_here("info", NAME + ".msh"))

    def test_failures(self):
        done = run("info", NAME + ".msh", folder=self.folder)
        self.assertEqual(done.returncode, 1)
        self.assertIn(NAME, done.stderr.decode("utf-8"))
        self.assertEqual(run("colide").returncode, 2)

    def test_demo(self):
        self.assertIn(b"contacts", self.run_here("demo", "--json"))


if __name__ == "__main__":
    unittest.main()
