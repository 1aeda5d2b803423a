"""vox_demo, the demo as a program of its own: it prints what `vox demo` prints but for times, and where to go next."""

import os
import re
import subprocess
import unittest

from vox import run

DEMO = os.environ["VOX_DEMO"]


def run_demo(*arguments):
    environment = {**os.environ, "LC_ALL": "C"}
    done = subprocess.run([DEMO, *arguments], capture_output=True, env=environment, timeout=600)
    busy = b"vox: warning: the machine is busy"  # which it may say at any time
    done.stderr = b"".join(line for line in done.stderr.splitlines(keepends=True) if not line.startswith(busy))
    return done


def without_times(text):
    return re.sub(rb" +[0-9.]+ ms", b" TIME ms", text)


class Demo(unittest.TestCase):
    def test_lines(self):
        done = run_demo()
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        lines = done.stdout.decode("ascii").splitlines()
        self.assertEqual(lines[0], "Two soft balls of 20001 tetrahedra each (5002 vertices) wobble through each other.")
        found = [re.match(r" +(\d+) +(\d+) +[0-9.]+ ms +[0-9.]+ ms", line) for line in lines]
        self.assertEqual([tuple(map(int, line.groups())) for line in found if line],
                         list(enumerate([0, 0, 0, 192, 788, 1723, 1871, 885, 24, 0, 0, 0])))
        self.assertEqual(lines[-1], "With your own files:  ./dev vox suggest MESH...   ./dev vox collide A B   ./dev vox --help")

    def test_same_as_the_command(self):
        arguments = ["--tets", "1500", "--frames", "5"]
        command = run("demo", *arguments).stdout
        program = run_demo(*arguments).stdout.replace(b"./dev vox", b"vox")
        self.assertEqual(without_times(program), without_times(command))
        self.assertIn(b" TIME ms", without_times(program))

    def test_usage(self):
        for arguments in (["--json"], ["--tets"], ["--tets", "0"], ["--tets", "9x"], ["--frames", "-1"], ["x", "1"]):
            done = run_demo(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, b""))
            self.assertIn(b"usage: vox_demo", done.stderr)


if __name__ == "__main__":
    unittest.main()
