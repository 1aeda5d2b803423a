"""vox collide --save and vox replay: the same contacts whatever the engine, and files that are refused."""

import os
import subprocess
import unittest

from command_line import TETS, TWO_TETS, msh
from vox import TOOL, Files, run, run_json


class Replay(Files):
    def setUp(self):
        super().setUp()
        self.mesh = self.write("two.msh", msh(TWO_TETS[:5], TETS))
        self.snapshot = self.path("grid.vox")
        self.collided = run_json("collide", self.mesh, self.mesh, "--offset", 0.1, 0.1, 0.1, "--save", self.snapshot)

    def refused(self, code, pattern, *arguments):
        done = run(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(done.stdout, b"")
        self.assertRegex(done.stderr.decode(), pattern)

    def test_same_contacts(self):
        self.assertGreater(self.collided["contact_count"], 0)
        for options in [], ["--engine", "reference"], ["--steps", 5], ["--threads", 2]:
            found = run_json("replay", self.snapshot, *options)
            self.assertEqual(found["hash"], self.collided["hash"], options)
            self.assertEqual(found["contact_count"], self.collided["contact_count"])
            self.assertEqual(found["counters"]["tets"], 4)
            self.assertEqual(found["saved_epoch"], 3)  # to warm up, timed, and at the end
            self.assertGreaterEqual(found["profile"]["step_ns"], 0)

    def test_as_text(self):
        done = run("replay", self.snapshot)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 meshes, 10 vertices, 4 tetrahedra", done.stdout.decode())
        self.assertIn(self.collided["hash"], done.stdout.decode())

    def test_shapes_are_no_meshes(self):
        saved = self.snapshot + ".floor"
        run_json("collide", self.mesh, "--floor=0,0,1,0.5", "--save", saved)
        self.assertIn(": 1 meshes, 1 shape, ", run("replay", saved).stdout.decode())

    @unittest.skipUnless(hasattr(os, "openpty"), "no terminals here")
    def test_progress_on_a_terminal_is_erased_before_results(self):
        def on_a_terminal(*arguments):
            try:
                ours, terminal = os.openpty()
            except OSError as error:  # a bare root without /dev/pts
                raise unittest.SkipTest(f"there are no terminals here: {error}") from error
            self.addCleanup(os.close, ours)
            with subprocess.Popen([TOOL, "replay", *arguments], stdout=terminal, stderr=terminal) as vox:
                os.close(terminal)
                text = b""
                try:
                    while piece := os.read(ours, 4096):
                        text += piece
                except OSError:  # how Linux says that nobody writes any more
                    pass
            self.assertEqual(vox.returncode, 0)
            return text.decode()
        for json in [], ["--json"]:
            for steps in "100000", "500000":  # progress is shown after half a second
                text = on_a_terminal(self.snapshot, self.snapshot, "--steps", steps, *json)
                self.assertNotRegex(text, r"of 2(?!\r\x1b\[K)")
                if "snapshot 2 of 2" in text:
                    break

    def test_refused(self):
        self.refused(1, "cannot be opened: No such file", "replay", self.snapshot + ".not")
        self.refused(1, "two.msh: snapshot: byte 0 is 0x24, expected 0x89: not a snapshot", "replay", self.mesh)
        with open(self.snapshot, "r+b") as file:
            file.truncate(100)
        self.refused(1, "grid.vox: snapshot: 100 bytes, the header says", "replay", self.snapshot)
        self.refused(2, "FILE is required", "replay")
        self.refused(2, "--steps", "replay", self.snapshot, "--steps", 0)
        self.refused(1, "cannot be written", "collide", self.mesh, self.mesh, "--save", self.folder.name)


if __name__ == "__main__":
    unittest.main()
