"""The answers that the project promises on real bodies: contacts of the paper's models, exact, whatever the cell
size, engine, storage and hash; and the paper's Table 2 on its lattice spheres. Reads the folder VOX_MESHES."""

import os
import sys
import unittest

from vox import run_json

MESHES = os.environ["VOX_MESHES"]

# The fast engine; the reference engine in its storages, of which only the hashed one has a hash to choose.
SETTINGS = (["--engine", "fast"], ["--storage", "dense"], ["--storage", "hashed", "--hash", "mixed"],
            ["--storage", "hashed", "--hash", "paper"])


def mesh(name):
    return os.path.join(MESHES, name)


class Contacts(unittest.TestCase):
    def check_scene(self, count, edges, *arguments):
        """`count` contacts and one hash for every setting and every cell size, given in mean edges of A."""
        found = run_json("collide", *arguments)
        self.assertEqual(found["contact_count"], count)
        self.assertEqual(len(found["contacts"]), count)
        order = [(c["body_a"], c["vertex"], c["body_b"], c["tet"]) for c in found["contacts"]]
        self.assertEqual(order, sorted(set(order)))
        for c in found["constraints"]:
            self.assertAlmostEqual(sum(c["weights"]), 0, 12)
            self.assertTrue(all(-1 <= weight <= 0 for weight in c["weights"][c["count_a"]:]))
        mean_edge = run_json("info", arguments[0])["meshes"][0]["mean_edge"]
        for settings in SETTINGS:
            for factor in edges:
                with self.subTest(arguments=arguments, settings=settings, factor=factor):
                    size = repr(factor * mean_edge)
                    other = run_json("collide", *arguments, "--cell-size", size, *settings)
                    self.assertEqual(other["cell_size"], float(size))
                    self.assertEqual((other["contact_count"], other["hash"]), (count, found["hash"]))

    def test_bunny_pair(self):
        self.check_scene(1310, (0.2, 0.5, 1, 1.5, 3, 8), mesh("paper/bunny.msh"), mesh("paper/bunny.msh"), "--offset",
                         1.0, 0.3, 0.1)

    def test_sphere_pair(self):
        self.check_scene(128, (0.2, 1.5, 8), mesh("paper/sphere01.msh"), mesh("paper/sphere01.msh"), "--offset", 1.9,
                         0, 0)

    def test_coincident_spheres(self):
        self.check_scene(16366, (0.2, 1.5, 8), mesh("paper/sphere01.msh"), mesh("paper/sphere01.msh"), "--offset", 0,
                         0, 0)

    def test_cow_with_itself(self):
        self.check_scene(0, (0.2, 1.5, 8), mesh("paper/cow.msh"), "--self")

    def test_tetgen_files_give_the_same(self):
        found = run_json("collide", mesh("paper/sphere01.node"), mesh("paper/sphere01.ele"), "--offset", 1.9, 0, 0)
        gmsh = run_json("collide", mesh("paper/sphere01.msh"), mesh("paper/sphere01.msh"), "--offset", 1.9, 0, 0)
        self.assertEqual((found["contact_count"], found["hash"]), (128, gmsh["hash"]))


class Suggest(unittest.TestCase):
    def test_table_2(self):
        for name, n_trad, n_a in (("sphere01", 41.90, 28.73), ("sphere03", 47.40, 32.49)):
            found = run_json("suggest", "--model", "paper", "--world", 4, mesh(f"paper-lattice/{name}_lattice.msh"))
            self.assertAlmostEqual(4 / found["geometry"]["mean_edge"] / n_trad, 1, delta=0.01)
            self.assertAlmostEqual(found["cells_per_axis"] / n_a, 1, delta=0.01)

    def test_agrees_with_info(self):
        for name in "bunny", "cow", "armadillo":
            geometry = run_json("suggest", mesh(f"paper/{name}.msh"))["geometry"]
            info = run_json("info", mesh(f"paper/{name}.msh"))["meshes"][0]
            self.assertEqual((geometry["vertices"], geometry["tets"]), (info["vertices"], info["tets"]))
            # Meshes of up to 200,000 tetrahedra are measured as a whole, from positions rounded to floats.
            for key in "mean_edge", "mean_longest_edge", "mean_facet_area", "mean_volume":
                self.assertAlmostEqual(geometry[key] / info[key], 1, delta=1e-6)
            self.assertEqual(geometry["boundary_facets"], info["surface_triangles"])


class Info(unittest.TestCase):
    def test_counts(self):
        for name, vertices, tets, triangles, mean_edge in (("bunny", 4717, 20426, 5486, 0.08901),
                                                           ("sphere01", 8183, 41883, 4740, 0.10028)):
            found = run_json("info", mesh(f"paper/{name}.msh"))["meshes"][0]
            self.assertEqual((found["vertices"], found["tets"], found["surface_triangles"]),
                             (vertices, tets, triangles))
            self.assertAlmostEqual(found["mean_edge"], mean_edge, delta=1e-5)
            self.assertEqual((found["inverted"], found["degenerate"], found["warnings"]), (0, 0, []))

    def test_surface(self):
        found = run_json("info", mesh("surfaces/bunny.obj"))["meshes"][0]
        self.assertEqual((found["vertices"], found["tets"]), (8904, 0))
        self.assertIsNone(found["mean_volume"])
        self.assertGreater(found["mean_edge"], 0)


if __name__ == "__main__":
    if not os.path.isdir(MESHES):
        print(f"no meshes in {MESHES}: set VOX_MESHES to the folder that holds them")
        sys.exit(1 if os.environ.get("VOX_REQUIRE_MESHES") else 77)
    unittest.main()
