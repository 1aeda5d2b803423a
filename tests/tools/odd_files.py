"""What the commands say about odd files: warnings on standard error and in JSON, reasons for refusals, names."""

import os
import unittest

from vox import Files, run, run_json

# A tet, a prism, and vertex 7, of the geometry, which is inside of `other`.
MIXED = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
8
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 2 0 1
6 0 2 1
7 9 9 9
8 3 3 3
$EndNodes
$Elements
3
1 15 2 0 1 7
2 6 2 5 1 1 2 3 4 5 6
3 4 2 5 1 1 2 3 4
$EndElements
"""
OTHER = """MeshVersionFormatted 2
Dimension 3
Vertices
4
8 8 8 0
12 8 8 0
8 12 8 0
8 8 12 0
Tetrahedra
1
1 2 3 4 0
End
"""
OPEN = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 4 3\n"
CUBE = ("OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n"
        "4 2 3 7 6\n4 3 0 4 7\n")


class OddFiles(Files):
    def setUp(self):
        super().setUp()
        self.mixed = self.write("mixed.msh", MIXED)
        self.other = self.write("other.mesh", OTHER)
        self.cube = self.write("cube.off", CUBE)

    def line(self, path, *words):
        return (f"vox: warning: {path}: " + "; ".join(words) + "\n").encode()

    def test_a_line_on_standard_error(self):
        words = ("1 volume element of another kind was left out: prisms", "4 vertices belong to no tet and were left out")
        expected = self.line(self.mixed, *words)
        out = self.path("out.msh")
        for arguments in (["collide", self.mixed, self.other], ["collide", self.mixed, "--self"],
                          ["suggest", self.mixed, self.other], ["suggest", self.mixed, "--points"], ["check", self.mixed],
                          ["sweep", self.mixed, self.other, "--count", "5", "--rounds", "1", "--frames", "1", "--share", ".5"]):
            for json in [], ["--json"]:
                done = run(*arguments, *json, warnings=True)
                with self.subTest(arguments=arguments, json=json):
                    self.assertTrue(done.stderr.startswith(expected), done.stderr)
        for quiet in ["collide", self.other, "--self"], ["info", self.mixed], ["tetrahedralize", self.cube, "-o", out, "--cell", ".3"]:
            self.assertEqual(run(*quiet, warnings=True).stderr, b"")
        surface = self.write("open.obj", OPEN)
        done = run("tetrahedralize", surface, "-o", out, "--kind", "cubes", warnings=True)
        self.assertEqual(done.stderr, self.line(surface, "4 edges have only one triangle: the surface is open"))

    def test_report_in_json(self):
        report = run_json("collide", self.mixed, self.other)["meshes"][0]["report"]
        self.assertEqual((report["vertices"], report["left_out_vertices"], report["skipped_elements"]), (4, 4, 2))
        self.assertEqual(len(report["warnings"]), 2)
        self.assertEqual(run_json("suggest", self.mixed, self.other, "--model", "fast")["meshes"][0]["report"], report)
        self.assertEqual(run_json("suggest", self.mixed, "--points")["meshes"][0]["report"], report)
        self.assertEqual(run_json("check", self.mixed)["meshes"][0]["report"], report)
        filled = run_json("tetrahedralize", self.cube, "-o", self.path("out.msh"), "--cell", .3)
        self.assertEqual((filled["report"]["surface_triangles"], filled["report"]["warnings"]), (12, []))
        # Of a surface that is filled, what was in the file.
        filled = run_json("collide", self.cube, "--self", "--fill", "--fill-cell", .3)["meshes"][0]
        self.assertEqual((filled["report"]["tets"], filled["report"]["triangles"]), (0, 12))
        self.assertGreater(filled["tets"], 0)

    def test_keep_unused(self):
        self.assertEqual(run_json("collide", self.mixed, self.other)["contact_count"], 0)
        kept = run_json("collide", self.mixed, self.other, "--keep-unused")
        self.assertEqual((kept["contact_count"], kept["contacts"][0]["vertex"]), (1, 6))
        info = run_json("info", self.mixed, "--keep-unused")["meshes"][0]
        self.assertEqual((info["vertices"], info["unused_vertices"], info["left_out_vertices"]), (8, 4, 0))
        info = run_json("info", self.mixed)["meshes"][0]
        self.assertEqual((info["vertices"], info["unused_vertices"], info["left_out_vertices"]), (4, 0, 4))

    def test_split_cells(self):
        info = run("info", self.mixed, "--split-cells").stdout
        self.assertIn(b"  tetrahedra         4\n  split cells        1\n", info)
        self.assertIn(b"  warning: 1 cell was split into 3 tets: prisms\n", info)
        self.assertNotIn(b"left out: prisms", info)
        mesh = run_json("info", self.mixed, "--split-cells")["meshes"][0]
        self.assertEqual((mesh["vertices"], mesh["tets"], mesh["split_cells"], mesh["left_out_tets"]), (6, 4, 1, 0))
        self.assertEqual(run_json("info", self.mixed)["meshes"][0]["split_cells"], 0)
        report = run_json("collide", self.mixed, self.other, "--split-cells")["meshes"][0]["report"]
        self.assertEqual((report["tets"], report["skipped_elements"]), (4, 1))
        flat = self.write("flat.mesh", OTHER.replace("End", "TetrahedraP2\n1\n1 2 3 1 4 4 4 4 4 4 0\nEnd"))
        self.assertEqual((run_json("info", flat)["meshes"][0]["left_out_tets"]), 1)

    def test_regions(self):
        self.assertEqual(run_json("info", self.mixed)["meshes"][0]["regions"], 1)
        self.assertEqual(run_json("info", self.other)["meshes"][0]["regions"], 0)
        self.assertNotIn(b"regions", run("info", self.mixed).stdout)
        two = self.write("two.mesh", OTHER.replace("Tetrahedra\n1\n1 2 3 4 0", "Tetrahedra\n2\n1 2 3 4 5\n1 2 4 3 -1"))
        self.assertIn(b"  regions            2\n", run("info", two).stdout)

    def test_the_reason_alone(self):
        """Where a reader of the library's own refuses a file, it is not followed by what assimp thinks of it."""
        for name, text, reason in (("a.msh", "$MeshFormat\n9.9 0 8\n$EndMeshFormat\n", "version 9.9"),
                                   ("a.gltf", '{"asset":{"version":"1.0"}}', "version"),
                                   ("a.off", "5OFF\n1 1 0\n", "OFF"), ("b.vtk", "# vtk DataFile Version 9.0\n", "version 9")):
            done = run("info", self.write(name, text))
            self.assertEqual(done.returncode, 1)
            self.assertIn(reason, done.stderr.decode())
            self.assertNotIn(b"assimp", done.stderr)

    def test_archives(self):
        for start, kind in ((b"\x1f\x8b", "a gzip"), (b"\xfd7zXZ\0", "an xz"), (b"BZh91AY", "a bzip2"),
                            (b"\x28\xb5\x2f\xfd", "a zstd"), (b"7z\xbc\xaf\x27\x1c", "a 7z")):
            with open(self.path("a.msh.xz"), "wb") as file:
                file.write(start + b"...")
            self.assertIn(f"found {kind} archive: unpack it first", run("info", self.path("a.msh.xz")).stderr.decode())

    @unittest.skipIf(os.name == "nt", "such names cannot be there")
    def test_control_characters_in_names(self):
        strange = "a\x1b[31m\x07\n\x7f\u009bb\u00e4.msh"
        words = r"a\x1b[31m\x07\x0a\x7f\x9bb" + "\u00e4.msh"
        path = self.path(strange)
        with open(path, "w", encoding="ascii") as file:
            file.write(MIXED)
        for arguments in (["info", path], ["check", path], ["collide", path, "--self"], ["sweep", path, "--count", "5", "--rounds",
                          "1", "--frames", "1", "--share", ".5"], ["info", "--progress", path], ["info", path + "?"],
                          ["tetrahedralize", self.cube, "-o", path.replace("msh", "vtu"), "--cell", ".3"]):
            done = run(*arguments, warnings=True)
            for text in done.stdout, done.stderr:
                for c in b"\x1b\x07\x7f\xc2\x9b":
                    self.assertNotIn(bytes([c]) if c != 0xc2 else b"\xc2\x9b", text, arguments)
            self.assertIn(words.removesuffix(".msh"), (done.stdout + done.stderr).decode())
        self.assertEqual(run_json("info", path)["meshes"][0]["file"], path)

    def test_no_arguments(self):
        done = run()
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        self.assertEqual(done.stdout, run("--help").stdout)


if __name__ == "__main__":
    unittest.main()
