"""The command line on files made here: exit codes, words on standard error, JSON keys, the demo, and Table 2 of
the paper on the lattice spheres that the demo makes."""

import os
import re
import unittest
import xml.etree.ElementTree

from vox import Files, run, run_json

# Two tetrahedra on one face, and a vertex 6 that no element uses.
TWO_TETS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1), (9, 9, 9)]
TETS = [(1, 2, 3, 4), (2, 3, 4, 5)]

SUGGEST_KEYS = ["cell_size", "zone_min", "zone_max", "cost", "min_cell_size", "cells_per_axis", "curve", "terms", "rules",
                "collides", "model", "geometry"]
COLLIDE_KEYS = ["contact_count", "contacts", "constraints", "hash", "cell_size", "profile", "counters"]
INFO_KEYS = ["file", "format", "vertices", "tets", "surface_triangles", "mean_edge", "mean_longest_edge",
             "mean_facet_area", "mean_volume", "inverted", "degenerate", "duplicate_vertices", "bounds", "warnings"]


def msh(points, tets):
    """Gmsh 2.2 text; tetrahedra count vertices from 1."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", len(points)]
    lines += ["%d %r %r %r" % (i + 1, *p) for i, p in enumerate(points)]
    lines += ["$EndNodes", "$Elements", len(tets)]
    lines += ["%d 4 0 %s" % (i + 1, " ".join(map(str, t))) for i, t in enumerate(tets)]
    return "\n".join(map(str, lines + ["$EndElements", ""]))


class CommandLine(Files):
    def setUp(self):
        super().setUp()
        self.two = self.write("two.msh", msh(TWO_TETS[:5], TETS))
        self.one = self.write("one.msh", msh(TWO_TETS[:4], TETS[:1]))
        self.far = self.write("far.msh", msh([(x + 100, y, z) for x, y, z in TWO_TETS[:4]], TETS[:1]))
        self.surface = self.write("surface.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 3 4\n")

    def refused(self, code, pattern, *arguments):
        """vox ends with `code`, says nothing on standard output and one thing on standard error."""
        for json in [], ["--json"]:
            done = run(*arguments, *json)
            words = done.stderr.decode()
            self.assertEqual(done.returncode, code, (arguments, words))
            self.assertEqual(done.stdout, b"", arguments)
            self.assertRegex(words, r"\Avox: ")
            self.assertRegex(words, pattern)
            self.assertEqual(words.count("\n"), 1 if code == 1 else 2, words)

    # ---- usage ----

    def test_version_and_help(self):
        done = run("--version")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout.decode(), r"\Avox \d+\.\d+\.\d+, .+\n\Z")
        self.assertEqual(done.stderr, b"")
        for command in [], ["info"], ["suggest"], ["collide"], ["demo"], ["tetrahedralize"]:
            done = run(*command, "--help")
            self.assertEqual(done.returncode, 0, command)
            self.assertIn(b"--help", done.stdout)
            self.assertEqual(done.stderr, b"")

    def test_wrong_usage(self):
        for arguments in (
            ["nonsense"], ["--nonsense"], ["info"], ["suggest"], ["collide"], ["info", self.two, "--nonsense"],
            ["collide", self.two],                              # neither B nor --self
            ["collide", self.two, "--self", "--offset", 1, 0, 0],  # moves B, and there is none
            ["collide", self.two, "--self", "--scale", 2],
            ["collide", self.two, self.two, self.two],
            ["collide", self.two, self.two, "--offset", 1, 2],
            ["collide", self.two, self.two, "--offset", 1, 2, "nan"],
            ["collide", self.two, self.two, "--offset", "-.x", 1, 2],
            ["collide", self.two, self.two, "--scale", "inf"],
            ["collide", self.two, self.two, "--scale", "2x"],
            ["collide", self.two, self.two, "--scale", 0],
            ["collide", self.two, self.two, "--cell-size", -1],
            ["collide", self.two, self.two, "--cell-size", "nan"],
            ["collide", self.two, self.two, "--engine", "warp"],
            ["collide", self.two, self.two, "--storage", "1"],
            ["collide", self.two, self.two, "--hash", "md5"],
            ["collide", self.two, self.two, "--repeat", 0],
            ["collide", self.two, self.two, "--repeat", -3],
            ["collide", self.two, self.two, "--limit", "few"],
            ["collide", self.two, self.two, "--limit", -1],
            ["collide", self.two, self.two, "--threads", -1],
            ["collide", self.two, self.two, "--threads", 257],
            ["suggest", self.two, "--p-nc", 1], ["suggest", self.two, "--p-nc", 0],
            ["suggest", self.two, "--ratio", 0], ["suggest", self.two, "--world", -4],
            ["suggest", self.two, "--model", "guess"], ["suggest", self.two, "--grid", "guess"],
            ["suggest", self.two, "--zone-loss", -1], ["suggest", self.two, "--radius", "nan"],
            ["suggest", "--tune", "true {}", "--first", 1, "--max-runs", 2],
            ["suggest", "--tune", "true {}", "--first", 1, "--max-runs", 33],
            ["tetrahedralize"], ["tetrahedralize", self.surface], ["tetrahedralize", "-o", "out.msh"],
            ["tetrahedralize", self.surface, "-o", "out.msh", "--cell", -1],
            ["tetrahedralize", self.surface, "-o", "out.msh", "--kind", "spheres"],
            ["demo", "--tets", 0], ["demo", "--frames", 0], ["demo", self.two],
        ):
            with self.subTest(arguments=arguments):
                self.refused(2, "--help", *arguments)

    def test_bad_input(self):
        missing = self.path("missing.msh")
        index = self.write("index.msh", msh(TWO_TETS[:4], [(1, 2, 3, 900)]))
        garbage = self.write("garbage.msh", "neither a mesh nor anything else\n")
        empty = self.write("empty.msh", "")
        flat = self.write("flat.msh", msh([(2, 2, 2)] * 4, TETS[:1]))
        for command in ["info"], ["suggest"], ["collide", self.two], ["collide", "--self"]:
            self.refused(1, re.escape(missing), *command, missing)
            self.refused(1, re.escape(index) + ".*900", *command, index)
            self.refused(1, re.escape(garbage), *command, garbage)
            self.refused(1, re.escape(empty), *command, empty)
            self.refused(1, re.escape(self.folder.name), *command, self.folder.name)
        self.refused(1, ".", "suggest", flat)            # none that has a size

    def test_coordinates_beyond_float(self):
        far = self.write("far.msh", msh([(0, 0, 0), (1e39, 0, 0), (0, 1, 0), (0, 0, 1)], TETS[:1]))
        self.refused(1, re.escape(far) + ".*vertex 1 .*1e\\+39", "collide", far, self.two)
        self.refused(1, "one.msh.*vertex", "collide", self.two, self.one, "--offset", "1e300", 0, 0)
        self.refused(1, "one.msh.*vertex", "collide", self.two, self.one, "--scale", "1e200", "--offset", 0, 0, 1)
        # Scaled back into range they are as good as any: the product is taken in double.
        found = run_json("collide", self.two, far, "--scale", "1e-39")
        self.assertEqual(found["counters"]["vertices"], 9)
        # info describes the file, and a mean of squares that overflows is null, never Infinity.
        huge = self.write("huge.msh", msh([(0, 0, 0), (1e300, 0, 0), (0, 1e300, 0), (0, 0, 1e300)], TETS[:1]))
        self.assertIsNone(run_json("info", huge)["meshes"][0]["mean_volume"])

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full here")
    def test_output_that_cannot_be_written(self):
        import subprocess
        from vox import TOOL
        for arguments in ["--version"], ["--help"], ["info", self.two], ["info", self.two, "--json"]:
            with open("/dev/full", "w") as full:
                done = subprocess.run([TOOL, *arguments], stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, 1, arguments)
            self.assertIn(b"vox: cannot write to standard output", done.stderr)

    # ---- info ----

    def test_info(self):
        points = TWO_TETS + [TWO_TETS[0]]
        odd = self.write("odd.msh", msh(points, TETS + [(1, 2, 3, 3)]))
        meshes = run_json("info", self.two, odd, "--keep-unused")["meshes"]
        self.assertEqual(len(meshes), 2)
        for mesh in meshes:
            for key in INFO_KEYS:
                self.assertIn(key, mesh)
        two, odd = meshes
        self.assertEqual((two["file"], two["vertices"], two["tets"], two["surface_triangles"]), (self.two, 5, 2, 6))
        self.assertEqual(two["warnings"] == [], two["inverted"] == 0)
        root = 2 ** 0.5
        self.assertAlmostEqual(two["mean_edge"], (3 + 6 * root) / 9, 12)  # three legs; 3 + 3 diagonals
        self.assertAlmostEqual(two["mean_longest_edge"], root, 12)
        self.assertAlmostEqual(two["mean_facet_area"], (3 * 0.5 + 4 * 3 ** 0.5 / 2) / 7, 12)
        self.assertAlmostEqual(two["mean_volume"], (1 / 6 + 1 / 3) / 2, 12)
        self.assertEqual(two["bounds"], {"min": [0, 0, 0], "max": [1, 1, 1]})
        self.assertEqual((odd["degenerate"], odd["duplicate_vertices"], odd["unused_vertices"]), (1, 1, 2))
        self.assertTrue(odd["warnings"])

    def test_info_of_a_surface(self):
        surface = run_json("info", self.surface)["meshes"][0]
        self.assertEqual((surface["tets"], surface["surface_triangles"]), (0, 2))
        self.assertIsNone(surface["mean_volume"])
        self.assertAlmostEqual(surface["mean_edge"], (2 + 3 * 2 ** 0.5) / 5, 12)

    def test_a_process_of_its_own_reads_what_only_assimp_reads(self):
        triangle = ("AC3Db\nMATERIAL \"m\" rgb 1 1 1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0\nOBJECT world\n"
                    "kids 1\nOBJECT poly\nnumvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x0\nmat 0\nrefs 3\n"
                    "0 0 0\n1 0 0\n2 0 0\nkids 0\n")
        unknown = r"neither known content nor a known extension"
        self.refused(1, unknown + r"[^;]*$", "info", self.write("a.xyz", triangle[9:]))
        if not int(os.environ["VOX_ASSIMP"]):
            return self.refused(1, unknown, "info", self.write("a.ac", triangle))
        found = run_json("info", self.write("a.ac", triangle))["meshes"][0]
        self.assertEqual((found["format"], found["vertices"], found["surface_triangles"]), ("surface, by assimp", 3, 1))
        # assimp 5.2.5 reads beyond its memory here; whatever another version does, the tool lives to say it.
        damaged = ("*3DSMAX_ASCIIEXPORT 200\n*GEOMOBJECT {\n*NODE_NAME \"a\"\n*MESH {\n*MESH_NUMVERTEX 3\n"
                   "*MESH_NUMFACES 1\n*MESH_VERTEX_LIST {\n*MESH_VERTEX 0 0 0 0\n*MESH_VERTEX 1 1 0 0\n*X 2 0 1 0\n}\n"
                   "*MESH_FACE_LIST {\n*-1MESH_FACE 0: A: 0 B: 1 C: 2 AB: 1 BC: 1 CA: 1\n}\n}\n}\n")
        self.refused(1, unknown + ".*; assimp, in a process of its own: ", "info", self.write("a.ase", damaged))

    def test_info_as_text(self):
        text = run("info", self.two).stdout.decode()
        self.assertRegex(text, r"vertices +5\n")
        self.assertRegex(text, r"mean volume +0\.25\n")

    def test_names_that_are_no_utf8(self):
        path = os.path.join(os.fsencode(self.folder.name), b"\xff.msh")
        with open(path, "w") as file:
            file.write(msh(TWO_TETS[:5], TETS))
        self.assertIn("\ufffd", run_json("info", path)["meshes"][0]["file"])

    def test_info_as_text_has_what_json_has(self):
        text = run("info", self.two).stdout.decode()
        for pattern in (r"components +1\n", r"volume +0\.5\n", r"dihedral angles +[0-9.]+ to [0-9.]+ degrees\n",
                        r"unit +not stated in the file\n"):
            self.assertRegex(text, pattern)
        found = run_json("info", self.one)["meshes"][0]
        self.assertAlmostEqual(found["max_dihedral"], 90, 9)
        self.assertAlmostEqual(found["min_dihedral"], 54.7356103, 6)
        self.assertIsNone(run_json("info", self.surface)["meshes"][0]["min_dihedral"])

    def test_info_of_huge_coordinates(self):
        huge = [tuple(1e300 * x for x in point) for point in TWO_TETS[:5]]
        path = self.write("huge.msh", msh(huge, TETS))
        text = run("info", path).stdout.decode()
        self.assertNotRegex(text, r"nan|inf\b")
        self.assertRegex(text, r"mean volume +too large for a double\n")
        found = run_json("info", path)["meshes"][0]
        self.assertAlmostEqual(found["mean_edge"] / 1e300, run_json("info", self.two)["meshes"][0]["mean_edge"], 12)
        self.assertIsNone(found["mean_facet_area"])

    # ---- suggest ----

    def test_suggest_where_nothing_collides(self):
        for arguments in [self.one], [self.one, self.far]:
            text = run("suggest", *arguments, "--model", "fast").stdout.decode()
            self.assertRegex(text, r"\ANothing collides: ")
            self.assertNotIn("Between", text)
            found = run_json("suggest", *arguments, "--model", "fast")
            self.assertFalse(found["collides"])
            self.assertEqual((found["zone_min"], found["zone_max"]), (None, None))
        self.refused(1, "nothing collides", "suggest", self.one, "--model", "fast", "--svg",
                     self.path("none.svg"))
        for model in "paper", "reference", "surface":  # these cost something even then
            self.assertIsNotNone(run_json("suggest", self.one, "--model", model)["zone_min"])

    def test_suggest(self):
        self.assertEqual(run_json("suggest", self.two, "--model", "surface")["model"], "surface")
        self.assertRegex(run("suggest", self.two, "--model", "surface").stdout.decode(), "ms a search, of the grid alone")
        found = run_json("suggest", self.two, self.one, "--world", 8)
        for key in SUGGEST_KEYS:
            self.assertIn(key, found)
        self.assertEqual(found["model"], "paper")
        self.assertLess(found["zone_min"], found["cell_size"])
        self.assertGreater(found["zone_max"], found["cell_size"])
        self.assertAlmostEqual(found["cells_per_axis"], 8 / found["cell_size"], 9)
        edge = found["geometry"]["mean_edge"]
        sizes = [(rule["name"], rule["cell_size"]) for rule in found["rules"]]
        self.assertIn(("mean edge (Teschner et al. 2003)", edge), sizes)
        self.assertIn(("2 mean edges (Gregory et al. 2000)", 2 * edge), sizes)
        self.assertEqual(found["geometry"]["tets"], 3)
        sizes = [sample["cell_size"] for sample in found["curve"]]
        self.assertEqual(sizes, sorted(sizes))
        self.assertGreater(len(sizes), 1)
        self.assertLessEqual(found["cost"], min(s["cost"] for s in found["curve"]) * (1 + 1e-12))
        flat = self.write("flat.msh", msh([(x, y, 0) for x, y, _ in TWO_TETS[:4]], TETS[:1]))  # its box has no volume
        self.assertEqual([rule["cell_size"] for rule in run_json("suggest", flat)["rules"] if "512" in rule["name"]], [None])

    def test_suggest_models(self):
        """Every model: terms that add up to the cost at the minimum, and rules that cost no less."""
        for model in "paper", "reference", "fast":
            found = run_json("suggest", self.two, self.one, "--self", "--model", model)
            self.assertEqual(found["model"], model)
            cost = found["cost"]
            self.assertAlmostEqual(sum(term["cost"] for term in found["terms"]) / cost, 1, 9)
            self.assertLess(cost, 1000 if model == "paper" else 1e-3)  # cell visits, or seconds
            for rule in found["rules"]:
                if rule["cell_size"]:
                    self.assertGreaterEqual(rule["cost"], cost * (1 - 1e-6))
            text = run("suggest", self.two, self.one, "--self", "--model", model).stdout.decode()
            self.assertIn("What the cost is made of", text)
            shown = re.search(r"predicted cost ([0-9.e+-]+) (cell visits a tetrahedron|ms a step)\.\n", text)
            self.assertEqual(shown[2], "cell visits a tetrahedron" if model == "paper" else "ms a step")
            self.assertAlmostEqual(float(shown[1]) / (cost if model == "paper" else 1e3 * cost), 1, delta=1e-3)
        run_json("suggest", self.two, "--self", "--model", "reference", "--calibrate")

    def test_suggest_picture(self):
        path = self.path("curve.svg")
        run_json("suggest", self.two, "--svg", path)
        root = xml.etree.ElementTree.parse(path).getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        points = root.find("{http://www.w3.org/2000/svg}polyline").get("points").split()
        self.assertEqual(len(points), 64)
        self.assertEqual(root.find("{http://www.w3.org/2000/svg}title").text, "Predicted cost over cell size")
        words = " | ".join(text.text for text in root.iter("{http://www.w3.org/2000/svg}text"))
        for expected in "two.msh", "cost model of the paper", "cell size", "cost, in units of the least", "nearly as good":
            self.assertIn(expected, words)
        heights = [float(point.split(",")[1]) for point in points]  # a curve that is steeper than the picture leaves it
        self.assertLess(min(heights[0], heights[-1]), 64)
        self.assertIn("prefers-color-scheme:dark", root.find("{http://www.w3.org/2000/svg}style").text)
        odd = self.write("a&b <c>.msh", msh(TWO_TETS[:5], TETS))
        run_json("suggest", odd, "--svg", path)
        self.assertIn("a&b <c>.msh", "".join(xml.etree.ElementTree.parse(path).getroot().itertext()))
        self.refused(1, "cannot be written", "suggest", self.two, "--svg", self.path("no/such.svg"))

    def test_suggest_for_other_grids(self):
        surface = run_json("suggest", self.surface)
        self.assertEqual(surface["primitives"]["type"], "triangles")
        self.assertLessEqual(surface["zone_min"], surface["cell_size"])
        self.assertGreaterEqual(surface["zone_max"], surface["cell_size"])
        cost = sum(term["cost"] for term in surface["terms"])
        self.assertAlmostEqual(cost / surface["cost"], 1, 9)
        self.assertEqual(run_json("suggest", self.two, "--grid", "ipc")["primitives"],
                         {"type": "tetrahedra", "count": 2})
        balls = run_json("suggest", self.two, "--points", "--radius", 0.25, "--grid", "warp")
        self.assertEqual(balls["primitives"], {"type": "points", "count": 5})
        self.assertIn(("mean radius", 0.25), [(rule["name"], rule["cell_size"]) for rule in balls["rules"]])
        one, two = (run_json("suggest", self.two, "--grid", "vtk", "--querying", file) for file in (self.one, self.two))
        self.assertLess(one["cost"], two["cost"])  # of fewer queries
        self.assertGreater(one["weights"]["store"], 0)
        text = run("suggest", self.surface, "--svg", self.path("surface.svg")).stdout.decode()
        self.assertIn("Suggested cell size", text)
        self.assertIn("What the cost is made of", text)
        words = "".join(xml.etree.ElementTree.parse(self.path("surface.svg")).getroot().itertext())
        self.assertIn("a grid of triangles", words)
        self.refused(1, "no triangles", "suggest", self.two, "--triangles")
        self.refused(2, "exclude", "suggest", self.two, "--triangles", "--points")

    def test_suggest_tunes_a_command(self):
        """A command whose time is (d - 0.5)^2 + 1, which it prints, at the cell size d."""
        prints = "echo cells; echo {} | awk '{print ($1-0.5)*($1-0.5)+1; print \"\"}'"
        found = run_json("suggest", "--tune", prints, "--first", 0.3)
        self.assertLessEqual(len(found["timings"]), 7)
        self.assertLess((found["cell_size"] - 0.5) ** 2, 0.05)
        for r in found["timings"]:
            self.assertAlmostEqual((r["cell_size"] - 0.5) ** 2 + 1, r["seconds"], 4)
        self.assertEqual(len(run_json("suggest", "--tune", prints, "--first", 0.3, "--max-runs", 3)["timings"]), 3)
        timed = run_json("suggest", self.two, "--tune", "echo nothing like a number {}")
        self.assertTrue(all(0 < r["seconds"] < 60 for r in timed["timings"]))
        text = run("suggest", "--tune", prints, "--first", 0.3, "--svg", self.path("tuned.svg")).stdout.decode()
        self.assertIn("Best cell size", text)
        failed = run("suggest", "--tune", "exit 3 # {}", "--first", 0.3)
        self.assertEqual(failed.returncode, 1)
        self.assertIn(b"no run succeeded: 7 could not run", failed.stderr)
        self.refused(2, "{}", "suggest", "--tune", "true", "--first", 0.3)
        self.refused(2, "--first", "suggest", "--tune", prints)
        self.refused(2, "MESH", "suggest")

    def test_suggest_solves_the_cubic(self):
        """4 K d^3 - s K d^2 - 3 s p_nc = 0 with K = (1 - p_nc) r 3 sqrt(3) / (2 A), Sect. 4."""
        for p_nc, ratio in ((0.99, 5), (0.9, 0.5)):
            found = run_json("suggest", self.two, "--p-nc", p_nc, "--ratio", ratio, "--model", "paper")
            s, a, d = found["geometry"]["mean_edge"], found["geometry"]["mean_facet_area"], found["cell_size"]
            k = (1 - p_nc) * ratio * 3 * 3 ** 0.5 / (2 * a)
            self.assertAlmostEqual((4 * k * d ** 3 - s * k * d ** 2) / (3 * s * p_nc), 1, 6)

    def test_suggest_as_text(self):
        plain = run("suggest", self.two, LC_ALL="C").stdout
        self.assertTrue(plain.isascii())
        self.assertIn(b"#", plain)
        drawn = run("suggest", self.two, LC_ALL="C.UTF-8").stdout.decode()
        self.assertIn("\u2588", drawn)
        for text in plain.decode(), drawn:
            self.assertRegex(text, r"\ASuggested cell size [0-9.]+, ")

    # ---- collide ----

    def test_collide_constraints(self):
        found = run_json("collide", self.one, self.one, "--offset", 0.1, 0.2, 0.3)
        self.assertEqual(found["contact_count"], 1)
        contact, (c,) = found["contacts"][0], found["constraints"]
        self.assertEqual((c["body_a"], c["vertices"][0], c["body_b"], c["element_b"]),
                         (contact["body_a"], contact["vertex"], contact["body_b"], contact["tet"]))
        # Vertex 0 of B, at (0.1, 0.2, 0.3), is in A, and its edges lead out through the slanted face.
        self.assertEqual((c["kind"], c["state"], c["body_a"], c["count_a"], c["vertices"]),
                         ("inside", "surface", 1, 1, [0, 0, 1, 2, 3]))
        self.assertAlmostEqual(c["gap"], -0.4 / 3 ** 0.5, 6)
        for coordinate in c["normal"]:
            self.assertAlmostEqual(coordinate, 3 ** -0.5, 6)
        for coordinate, expected in zip(c["position"], (0.1, 0.2, 0.3)):
            self.assertAlmostEqual(coordinate, expected, 6)
        self.assertEqual(c["time"], 1)
        self.assertEqual(found["counters"]["penetrations"], 1)
        self.assertEqual(found["counters"]["constraints"], 1)
        self.assertEqual(found["counters"]["leaving_edges"], 3)
        self.assertGreater(found["profile"]["depth_ns"], 0)
        text = run("collide", self.one, self.one, "--offset", 0.1, 0.2, 0.3).stdout.decode()
        self.assertRegex(text, r"\n1 contact of 1 vertex; the deepest is 0.2309 inside, at \(0.1, 0.2, 0.3\)\n1 constraint: 1 inside\n\n"
                         r".*\n  inside +-0.23094  0.1 0.2 0.3 +0.5774 0.5774 0.5774 +surface +B 0 in A 0 1 2 3\n")
        sunk = [(x / 2, y / 2, z / 2 + 0.1) for x, y, z in TWO_TETS]  # the deepest comes first
        text = run("collide", self.two, self.write("sunk.msh", msh(sunk, TETS))).stdout.decode()
        gaps = [float(line.split()[1]) for line in text.splitlines() if line.startswith("  inside")]
        self.assertGreater(len(gaps), 2)
        self.assertEqual(gaps, sorted(gaps))

    def test_help_has_defaults_and_examples(self):
        for command in ("demo", "info", "check", "suggest", "collide", "replay", "resolve", "sweep", "tetrahedralize"):
            text = run(command, "--help").stdout.decode()
            self.assertRegex(text, rf"Examples:\n  vox {command}\b.*\n  vox {command}\b" if command != "demo" else r"Examples:\n  vox demo\n")
        self.assertIn("--threads UINT=1", run("collide", "--help").stdout.decode())
        self.assertIn("(default: paper)", run("generate", "man").stdout.decode().replace("\\-", "-"))

    def test_suggest_says_for_whom(self):
        self.assertIn("for the paper's algorithm (the default engine chooses its own: leave cell_size at 0)",
                      run("suggest", self.two).stdout.decode().splitlines()[0])

    def test_collide_threads(self):
        serial, *others = [run_json("collide", self.two, self.one, "--offset", 0.1, 0.2, 0.3, "--threads", threads)
                           for threads in (1, 0, 2, 256)]
        self.assertEqual(serial["contact_count"], 1)
        for found in others:
            self.assertEqual(found["contacts"], serial["contacts"])
            self.assertEqual(found["hash"], serial["hash"])

    def test_collide(self):
        found = run_json("collide", self.two, self.one, "--offset", 0.1, 0.2, 0.3, "--repeat", 3)
        for key in COLLIDE_KEYS:
            self.assertIn(key, found)
        # B's first corner lies in A's first tet; A's last vertex, (1, 1, 1), and its others lie outside B.
        self.assertEqual(found["contact_count"], 1)
        contact = found["contacts"][0]
        self.assertEqual([contact[k] for k in ("body_a", "vertex", "body_b", "tet")], [1, 0, 0, 0])
        for weight, expected in zip(found["constraints"][0]["weights"], (1, -0.4, -0.1, -0.2, -0.3)):
            self.assertAlmostEqual(weight, expected, 6)
        self.assertRegex(found["hash"], r"\A[0-9a-f]{16}\Z")
        self.assertEqual([m["file"] for m in found["meshes"]], [self.two, self.one])
        for key in ("step_ns", "bin_ns", "broad_ns", "narrow_ns", "contacts_ns", "stream_ns", "winding_ns",
                    "broad_phase_ns", "windows_ns", "lookup_ns", "decide_ns"):
            self.assertGreaterEqual(found["profile"][key], 0)
        self.assertEqual(found["counters"]["contacts"], 1)

    def test_scale_comes_before_offset(self):
        # B's far corner (1, 0, 0) goes to 0.5 * 1 + 0.1; the other order would take it to 0.55.
        found = run_json("collide", self.one, self.one, "--scale", 0.5, "--offset", 0.1, 0.2, 0.1)
        positions = {c["vertices"][0]: c["position"] for c in found["constraints"] if c["body_a"] == 1}
        self.assertAlmostEqual(positions[1][0], 0.6, 6)

    def test_double_keeps_what_a_float_rounds_away(self):
        # A's corner (1, 0, 0) is a hair outside B, moved by less than floats near 1 are apart.
        placed = ["collide", self.one, self.one, "--offset", 1 + 1e-12, 0, 0]
        self.assertEqual(run_json(*placed)["contact_count"], 2)
        self.assertEqual(run_json(*placed, "--double")["contact_count"], 0)

    def test_negative_and_exponent_offsets(self):
        found = run_json("collide", self.one, self.one, "--offset", "-1e-1", "-.1", -0.1)
        self.assertEqual([(c["body_a"], c["vertex"]) for c in found["contacts"]], [(0, 0)])

    def test_self_collision(self):
        # A second tetrahedron whose corner pokes into the first, in one mesh.
        points = TWO_TETS[:4] + [(0.1, 0.1, 0.1), (-1, 0, 0), (-1, 1, 0), (-1, 0, 1)]
        folded = self.write("folded.msh", msh(points, [(1, 2, 3, 4), (5, 6, 7, 8)]))
        found = run_json("collide", folded, "--self")
        self.assertIn((0, 4, 0, 0), [(c["body_a"], c["vertex"], c["body_b"], c["tet"]) for c in found["contacts"]])
        alone = found["contact_count"]
        apart = ["collide", folded, folded, "--offset", 50, 0, 0]
        self.assertEqual(run_json(*apart)["contact_count"], 0)
        self.assertEqual(run_json(*apart, "--self")["contact_count"], 2 * alone)

    def test_surface_takes_part_with_its_vertices(self):
        found = run_json("collide", self.surface, self.one, "--offset", -0.1, -0.1, -0.1)
        self.assertEqual([(c["body_a"], c["vertex"], c["body_b"]) for c in found["contacts"]], [(0, 0, 1)])

    def test_surfaces_alone_are_refused(self):
        self.refused(1, "surface.*no inside.*--fill", "collide", self.surface, self.surface)
        self.refused(1, "surface.*no inside.*--fill", "collide", self.surface, "--self")
        self.assertIn("it has no inside", run("collide", self.surface, self.one).stdout.decode())

    def test_repeat_moves_the_bodies_and_puts_them_back(self):
        """All vertices move in the steps that are timed, and the result is that of the positions given."""
        for double in [], ["--double"]:
            placed = ["collide", self.two, self.one, "--offset", 0.1, 0.2, 0.3, *double]
            once, often = run_json(*placed), run_json(*placed, "--repeat", 20)
            for key in "contacts", "constraints", "hash", "meshes":
                self.assertEqual(once[key], often[key])
        self.assertIn("in which all vertices move", run(*placed, "--repeat", 3).stdout.decode())
        # A hair inside, the corner of B leaves A and comes back as it moves.
        for double in [], ["--double"]:
            near = ["collide", self.one, self.one, "--scale", 2, "--offset", 0.0001, 0.2, 0.3, *double]
            once, often = run_json(*near)["counters"], run_json(*near, "--repeat", 20)["counters"]
            self.assertEqual(once["total_began"], 1)
            self.assertGreater(often["total_began"], 1)
            self.assertEqual(often["total_ended"], often["total_began"] - 1)

    def test_collide_with_shapes(self):
        # The tetrahedron with corners 0, and 1 along each axis.
        placed = {"floor": ("0,0,2,1", [0, 1, 2], 0.5, [0, 0, 1]), "sphere": ("0,0,1,.25", [3], 0.25, None),
                  "box": ("1,0,0,0.25,0.5,0.5", [1], 0.25, None), "capsule": ("-5,1,0,5,1,0,0.25", [2], 0.25, None)}
        for kind, (numbers, vertices, depth, normal) in placed.items():
            with self.subTest(kind=kind):
                found = run_json("collide", self.one, f"--{kind}", numbers)
                self.assertEqual(found["shapes"], [{"kind": kind, "numbers": [float(x) for x in numbers.split(",")]}])
                self.assertEqual([c["vertices"] for c in found["constraints"]], [[v] for v in vertices])
                for c in found["constraints"]:
                    self.assertEqual((c["kind"], c["body_a"], c["body_b"], c["count_a"], c["weights"]), ("inside", 0, 1, 1, [1]))
                    self.assertAlmostEqual(c["gap"], -depth, 12)
                    self.assertEqual(c["normal"], normal or c["normal"])
                self.assertEqual((found["contact_count"], len(found["meshes"])), (0, 1))

        # Several of a kind, in the order of the kinds, after the meshes; options before the file.
        found = run_json("collide", "--sphere", "0,0,0,0.1", "--sphere", "1,0,0,0.1", "--floor", "0,0,1,-9", self.one, self.one,
                         "--offset", 0.1, 0.2, 0.3)
        self.assertEqual([shape["kind"] for shape in found["shapes"]], ["floor", "sphere", "sphere"])
        self.assertEqual({(c["body_a"], c["vertices"][0], c["body_b"]) for c in found["constraints"] if c["count_a"] == len(c["vertices"])},
                         {(0, 0, 3), (0, 1, 4)})
        self.assertGreater(found["contact_count"], 0)

        # Tilted, against the distance from the plane; a surface alone; edges and margins.
        found = run_json("collide", self.one, "--floor=-1,-2,-2,-1.5")
        self.assertEqual({c["vertices"][0]: round(c["gap"], 12) for c in found["constraints"]}, {2: round(-0.5 / 3, 12), 3: round(-0.5 / 3, 12)})
        self.assertEqual(len(run_json("collide", self.surface, "--floor", "0,0,1,0.5")["constraints"]), 3)
        kinds = {c["kind"] for c in run_json("collide", self.one, "--box", "0.4,0.1,0,0.05,0.05,1", "--edges", "--margin", 1)["constraints"]}
        self.assertEqual(kinds, {"edge", "proximity"})
        text = run("collide", self.one, "--floor", "0,0,1,0.5", "--capsule", "0,0,1,0,0,1,0.25").stdout.decode()
        self.assertIn("B  floor 0,0,1,0.5\nC  capsule 0,0,1,0,0,1,0.25\n\n0 contacts of 0 vertices, 4 with shapes; the deepest is 0.5 inside", text)
        self.assertRegex(text, r"inside +-0\.25 .*A 3 in C\n")

        # Results go into files: a line each, and the least gap of each vertex.
        table, drawing = self.path("shapes.csv"), self.path("shapes.vtu")
        run_json("collide", self.one, "--floor", "0,0,1,0.5", "--csv", table, "-o", drawing)
        with open(table, encoding="ascii") as file:
            self.assertEqual([line.split(",")[:5] for line in file][1:], [["inside", "closest", "0", "1", str(v)] for v in range(3)])
        with open(drawing, encoding="ascii") as file:
            self.assertIn('Name="gap"', file.read())
        for arguments in (["--floor", "0,0,1"], ["--floor", "0,0,1,0,0"], ["--floor", "0,0,x,0"], ["--floor", "0,0,nan,0"], ["--floor", ""],
                          ["--floor", "0,0,0,1"], ["--sphere", "0 0 0 1"], ["--sphere", "0,0,0,1,"], ["--box", "1,2,3"], ["--capsule", "1"]):
            with self.subTest(arguments=arguments):
                self.refused(2, arguments[0], "collide", self.one, *arguments)
        self.refused(2, "or a shape such as --floor", "collide", self.one)
        self.refused(1, "radius is -1", "collide", self.one, "--sphere", "0,0,0,-1")

    def test_collide_as_text(self):
        done = run("collide", self.two, self.two, "--limit", 2)
        text = done.stdout.decode()
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stderr, b"")
        self.assertRegex(text, r"\n10 contacts of 10 vertices\n10 constraints: 10 inside\n")
        self.assertEqual(len(re.findall(r"^  inside ", text, re.M)), 2)
        self.assertIn("and 8 more", text)
        text = run("collide", self.two, self.two, "--limit", 2, "--no-depth").stdout.decode()
        self.assertEqual(len(re.findall(r"^  [AB] +\d+   [AB] +\d+$", text, re.M)), 2)

    # ---- tetrahedralize ----

    def test_tetrahedralize(self):
        corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        faces = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
        lines = ["v %d %d %d" % corner for corner in corners] + ["f %d %d %d %d" % face for face in faces]
        cube = self.write("cube.obj", "\n".join(lines) + "\n")
        for out, more in ("cube.msh", []), ("cube.vtu", ["--binary"]), ("cubes.msh", ["--kind", "cubes"]):
            out = self.path(out)
            found = run_json("tetrahedralize", cube, "-o", out, "--cell", 0.1, *more)
            self.assertEqual(found["file"], out)
            self.assertAlmostEqual(found["surface_volume"], 1, 9)
            self.assertLess(abs(found["volume"] - 1), 0.05 if "--kind" not in more else 1)
            self.assertLess(found["hausdorff"], 0.2)
            self.assertTrue(5 < found["min_dihedral"] < found["max_dihedral"] < 170)
            written = run_json("info", out)["meshes"][0]
            for key in "tets", "vertices", "surface_triangles":
                self.assertEqual(written[key], found[key])
            self.assertAlmostEqual(written["volume"], found["volume"], 9)
            self.assertEqual(written["inverted"], 0)
        # Filled on the way in it gives what the written file gives.
        filled = run_json("collide", cube, self.one, "--fill", "--fill-cell", 0.1, "--offset", 0.4, 0.4, 0.4)
        out = self.path("cube.msh")
        read = run_json("collide", out, self.one, "--offset", 0.4, 0.4, 0.4)
        self.assertGreater(filled["contact_count"], 0)
        self.assertEqual(filled["contacts"], read["contacts"])
        self.assertGreater(run_json("suggest", cube, "--fill")["cell_size"], 0)
        self.assertEqual(run("collide", cube, self.one, "--fill-cell", 0.1).returncode, 2)
        # With tetrahedra it holds what a surface cannot.
        self.assertGreater(run_json("collide", out, self.one, "--scale", 0.5)["contact_count"], 4)

    def test_tetrahedra_to_expect(self):
        """Said before the work where they are many; here it ends at once, as there are too many cells along x."""
        strip = self.write("strip.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 0.15 0\n3 0 1 2\n3 0 2 1\n")
        arguments = "tetrahedralize", strip, "-o", self.path("strip.msh"), "--cell"
        self.assertEqual(run(*arguments, 0.0002).stderr.decode(), "vox: cells of 0.0002 make about 7.5 million tetrahedra\n"
                         "vox: a cell of 0.0002 makes 5000 cells along x, at most 4096 are possible\n")
        self.assertIn(b"at least 7.5 million", run(*arguments, 0.0002, "--max-distance", 1).stderr)
        self.assertIn(b"at most 7.5 million", run(*arguments, 0.0002, "--coarsen", 1).stderr)
        self.refused(1, "5000 cells along x", *arguments, 0.0002, "--max-tets", 5000000)
        self.refused(1, "10000 cells along x", *arguments, 0.0001, "--max-tets", 10000000)

    def test_output_is_checked_before_the_work(self):
        # There is no such surface, but that is not what is said: the output is looked at first.
        for out, words in (("out.stl", r"out.stl: expected a name that ends with .msh or .vtu"),
                           (os.path.join("no", "out.msh"), "out.msh: cannot be written: No such file"),
                           ("", "cannot be written|expected a name")):
            path = self.path(out)
            self.refused(1, words, "tetrahedralize", "missing.obj", "-o", path)
            self.assertNotIn(b".part", run("tetrahedralize", "missing.obj", "-o", path).stderr)
        kept = self.write("kept.msh", "kept")
        self.refused(1, "missing.obj", "tetrahedralize", "missing.obj", "-o", kept)
        self.refused(1, "missing.obj", "tetrahedralize", "missing.obj", "-o", kept + ".vtu")
        self.assertFalse(os.path.exists(kept + ".vtu"))
        link = self.path("link.msh")
        os.symlink("not_yet.msh", link)
        self.refused(1, "missing.obj", "tetrahedralize", "missing.obj", "-o", link)
        self.assertEqual((os.path.islink(link), os.path.exists(link)), (True, False))
        with open(kept, encoding="ascii") as file:
            self.assertEqual(file.read(), "kept")

    def test_surfaces_that_cannot_be_filled(self):
        out = self.path("out.msh")
        self.refused(1, "open|closed", "tetrahedralize", self.surface, "-o", out)
        self.assertFalse(os.path.exists(out))

    # ---- demo ----

    def test_demo(self):
        found = run_json("demo", "--tets", 1500, "--frames", 5)
        for key in SUGGEST_KEYS + COLLIDE_KEYS + ["frames", "comparison"]:
            self.assertIn(key, found)
        self.assertEqual([frame["frame"] for frame in found["frames"]], list(range(5)))
        most = max(frame["contacts"] for frame in found["frames"])
        self.assertGreater(most, 0)
        self.assertEqual(found["frames"][found["frame"]]["contacts"], most)
        self.assertEqual(found["contact_count"], most)
        self.assertEqual(len(found["contacts"]), most)
        sizes = {"suggested": found["cell_size"], "mean_edge": found["geometry"]["mean_edge"]}
        self.assertEqual([(c["engine"], c["rule"], c["cell_size"]) for c in found["comparison"]],
                         [(engine, *rule) for engine in ("fast", "reference") for rule in sizes.items()])
        again = run_json("demo", "--tets", 1500, "--frames", 5)
        self.assertEqual(found["hash"], again["hash"])

    def test_demo_as_text(self):
        done = run("demo", "--tets", 1000, "--frames", 3)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        self.assertTrue(done.stdout.isascii())
        self.assertEqual(len(re.findall(rb"^ +\d+ +\d+ +[0-9.]+ ms +[0-9.]+ ms", done.stdout, re.M)), 3)
        self.assertIn(b"mean edge", done.stdout)

    def test_table_2(self):
        """n_trad and n_a of Table 2: cells per axis of a world of edge 4, for unit spheres of these many tets."""
        for tets, n_trad, n_a in ((41937, 41.90, 28.73), (52326, 45.16, 30.94), (60688, 47.40, 32.49),
                                  (72631, 50.29, 34.48), (80927, 51.90, 35.65)):
            with self.subTest(tets=tets):
                found = run_json("demo", "--tets", tets, "--frames", 1)  # frame 0 has the shape at rest
                self.assertAlmostEqual(4 / found["geometry"]["mean_edge"] / n_trad, 1, delta=0.01)
                self.assertAlmostEqual(4 / found["cell_size"] / n_a, 1, delta=0.01)


if __name__ == "__main__":
    unittest.main()
