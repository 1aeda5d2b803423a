"""What a reader must answer for each hostile file is tested with the readers; here: the command line ends with one object
or one complaint, and does not crash. Reads the folder VOX_MESHES."""

import os
import sys
import unittest

from vox import run, run_json

MESHES = os.environ["VOX_MESHES"]


class Hostile(unittest.TestCase):
    def test_every_bad_file_ends_with_0_or_1(self):
        folder = os.path.join(MESHES, "bad")
        names = sorted(set(os.listdir(folder)) - {"MANIFEST.tsv"})
        self.assertGreater(len(names), 100)
        for name in names:
            with self.subTest(name=name):
                done = run("info", os.path.join(folder, name), "--json")
                self.assertIn(done.returncode, (0, 1), done.stderr)
                if done.returncode == 0:
                    self.assertEqual(run_json("info", os.path.join(folder, name))["meshes"][0]["file"],
                                     os.path.join(folder, name))
                else:
                    self.assertEqual(done.stdout, b"")
                    self.assertRegex(done.stderr.decode(errors="replace"), r"\Avox: .")


if __name__ == "__main__":
    if not os.path.isdir(MESHES):
        print(f"no meshes in {MESHES}: set VOX_MESHES to the folder that holds them")
        sys.exit(1 if os.environ.get("VOX_REQUIRE_MESHES") else 77)
    unittest.main()
