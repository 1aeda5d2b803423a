"""Files of results: collide -o, --csv and --no-depth, and the series of replay -o."""

import csv
import os
import struct
import unittest
import xml.etree.ElementTree
import zlib

from command_line import TETS, TWO_TETS, msh
from vox import Files, run, run_json

STATES = ["surface", "propagated", "enclosed", "crossing", "coincident", "unknown"]


class Results(Files):
    def setUp(self):
        super().setUp()
        self.two = self.write("two.msh", msh(TWO_TETS[:5], TETS))
        self.one = self.write("one.msh", msh(TWO_TETS[:4], TETS[:1]))
        self.surface = self.write("surface.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 3 4\n")
        self.placed = ["collide", self.two, self.one, "--offset", 0.1, 0.2, 0.3]

    def arrays(self, path):
        """The arrays of a .vtu file of text, by section and name."""
        root = xml.etree.ElementTree.parse(path).getroot()
        return {(section.tag, array.get("Name")): [float(x) for x in array.text.split()]
                for section in root.find("UnstructuredGrid/Piece") for array in section}

    def check_drawing(self, path, found):
        """The file has the contacts and penetrations that the JSON has."""
        arrays = self.arrays(path)
        mesh, vertex = arrays["PointData", "mesh"], arrays["PointData", "vertex"]
        at = {(int(m), int(v)): i for i, (m, v) in enumerate(zip(mesh, vertex))}
        cell_at = {(int(m), int(t)): i for i, (m, t) in
                   enumerate(zip(arrays["CellData", "mesh"], arrays["CellData", "tet"]))}
        points, cells = [0] * len(mesh), [0] * len(cell_at)
        for contact in found["contacts"]:
            points[at[contact["body_a"], contact["vertex"]]] += 1
            cells[cell_at[contact["body_b"], contact["tet"]]] += 1
        self.assertEqual(arrays["PointData", "contacts"], points)
        self.assertEqual(arrays["CellData", "contacts"], cells)
        depth, state, direction = [0] * len(mesh), [-1] * len(mesh), [0] * 3 * len(mesh)
        for p in found["penetrations"]:
            i = at[p["body_a"], p["vertex"]]
            if state[i] < 0 or p["depth"] > depth[i]:
                depth[i], state[i] = p["depth"], STATES.index(p["state"])
                direction[3 * i:3 * i + 3] = p["direction"]
        self.assertEqual(arrays["PointData", "state"], state)
        for name, expected in ("depth", depth), ("direction", direction):
            for x, y in zip(arrays["PointData", name], expected):
                self.assertAlmostEqual(x, y, 6)
        return arrays

    def test_drawing(self):
        out = self.path("out.vtu")
        found = run_json(*self.placed, "-o", out)
        self.assertEqual(found["contact_count"], 1)
        arrays = self.check_drawing(out, found)
        # The second body is where it was put.
        corner = arrays["PointData", "mesh"].index(1)
        for x, y in zip(arrays["Points", "Points"][3 * corner:3 * corner + 3], (0.1, 0.2, 0.3)):
            self.assertAlmostEqual(x, y, 6)
        self.check_drawing(out, run_json(*self.placed, "--repeat", 5, "--double", "-o", out))
        self.check_drawing(out, run_json("collide", self.two, self.two, "--self", "-o", out))
        written = run_json("info", out)["meshes"][0]
        self.assertEqual((written["vertices"], written["tets"]), (10, 4))

    def test_drawing_of_a_surface(self):
        out = self.path("out.vtu")
        found = run_json("collide", self.one, self.surface, "--offset", 0.1, 0.1, 0.1, "-o", out)
        self.assertEqual(found["contact_count"], 1)
        arrays = self.check_drawing_with_triangles(out)
        self.assertEqual(sum(arrays["PointData", "contacts"]), 1)
        self.assertEqual(arrays["CellData", "contacts"], [0, 0, 1])

    def check_drawing_with_triangles(self, path):
        arrays = self.arrays(path)
        self.assertEqual(arrays["CellData", "mesh"], [1, 1, 0])  # triangles come first
        self.assertEqual(arrays["CellData", "tet"], [-1, -1, 0])
        return arrays

    def test_gmsh(self):
        out = self.path("out.msh")
        run_json(*self.placed, "-o", out)
        with open(out, encoding="ascii") as file:
            text = file.read()
        self.assertEqual((text.count("$NodeData"), text.count("$ElementData")), (6, 3))
        self.assertEqual(run_json("info", out)["meshes"][0]["tets"], 3)

    def test_table(self):
        out = self.path("out.csv")
        # Where the two tetrahedra overlap, a vertex has two contacts and one penetration.
        folded = self.write("folded.msh", msh(TWO_TETS[:4] + [(0.1, 0.1, 0.1)], TETS))
        found = run_json("collide", self.two, folded, "--offset", -0.2, -0.21, -0.22, "--self", "--csv", out)
        self.assertGreater(found["contact_count"], len(found["penetrations"]))
        self.assertGreater(len({p["depth"] for p in found["penetrations"]}), 1)
        with open(out, encoding="ascii", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), found["contact_count"])
        depths = {(p["body_a"], p["vertex"], p["body_b"]): p for p in found["penetrations"]}
        for row, contact in zip(rows, found["contacts"]):
            for key in "body_a", "vertex", "body_b", "tet":
                self.assertEqual(int(row[key]), contact[key])
            for i in range(4):
                self.assertAlmostEqual(float(row[f"weight_{i}"]), contact["barycentric"][i], 8)
            p = depths[contact["body_a"], contact["vertex"], contact["body_b"]]
            self.assertAlmostEqual(float(row["depth"]), p["depth"], 6)
            self.assertEqual(row["state"], p["state"])

    def test_no_depth(self):
        table, drawing = self.path("out.csv"), self.path("out.vtu")
        found = run_json(*self.placed, "--no-depth", "--csv", table, "-o", drawing)
        self.assertIsNone(found["penetrations"])
        self.assertEqual(found["profile"]["depth_ns"], 0)
        self.assertEqual(found["contacts"], run_json(*self.placed)["contacts"])
        with open(table, encoding="ascii") as file:
            self.assertEqual(file.readline(), "body_a,vertex,body_b,tet,weight_0,weight_1,weight_2,weight_3\n")
        self.assertNotIn(("PointData", "depth"), self.arrays(drawing))
        self.assertNotIn("penetrating", run(*self.placed, "--no-depth").stdout.decode())

    def test_margin(self):
        out = self.path("out.vtu")
        above = ["collide", self.one, self.one, "--offset", 0, 0, 1.125]
        found = run_json(*above, "--margin", 0.25, "-o", out)
        self.assertEqual(found["contacts"], [])
        self.assertEqual([(c["body_a"], c["vertex"], c["body_b"], c["distance"], c["normal"])
                          for c in found["margin_contacts"]],
                         [(0, 3, 1, 0.125, [0, 0, -1]), (1, 0, 0, 0.125, [0, 0, 1])])
        self.assertEqual(found["counters"]["margin_contacts"], 2)
        arrays = self.arrays(out)
        self.assertEqual(arrays["PointData", "margin_distance"], [-1, -1, -1, 0.125, 0.125, -1, -1, -1])
        self.assertEqual(arrays["PointData", "margin_normal"][9:15], [0, 0, -1, 0, 0, 1])
        self.assertIn("2 vertices within the margin", run(*above, "--margin", 0.25).stdout.decode())
        without = run_json(*above, "-o", out)
        self.assertNotIn("margin_contacts", without)
        self.assertNotIn(("PointData", "margin_distance"), self.arrays(out))
        self.assertEqual(run(*above, "--margin", -1).returncode, 2)

    def test_moving(self):
        """A falls through B, and is outside of it before and after."""
        out = self.path("out.vtu")
        now, before = (self.write(name, msh([(x, y, z + to) for x, y, z in TWO_TETS[:4]], TETS[:1]))
                       for name, to in (("now.msh", -3), ("before.msh", 3)))
        falling = ["collide", now, self.one, "--offset", -0.25, -0.25, 0]
        found = run_json(*falling, "--moving", before, "-o", out)
        self.assertEqual(found["contacts"], [])
        self.assertEqual([(p["body_a"], p["vertex"], p["body_b"], p["face"]) for p in found["passages"]],
                         [(0, 0, 1, [1, 2, 3]), (0, 3, 1, [1, 2, 3])])
        for passage, time in zip(found["passages"], (2.5 / 6, 3.5 / 6)):
            self.assertLessEqual(passage["time"], time)
            self.assertAlmostEqual(passage["time"], time, 12)
        self.assertEqual([time >= 0 for time in self.arrays(out)["PointData", "passage_time"]],
                         [True, False, False, True] + 4 * [False])
        self.assertIn("2 vertices met a surface", run(*falling, "--moving", before).stdout.decode())
        self.assertNotIn("passages", run_json(*falling))
        done = run(*falling, "--moving", self.two)
        self.assertEqual((done.returncode, done.stdout), (1, b""))
        self.assertIn("two.msh has 5 vertices, but " + now + " has 4", done.stderr.decode())

    def test_series(self):
        snapshots = []
        for i, x in enumerate((0.1, 0.3, 5)):
            snapshots.append(self.path(f"{i}.vox"))
            found = run_json("collide", self.two, self.one, "--offset", x, 0.2, 0.3, "--repeat", i + 1, "--save",
                             snapshots[-1], "-o", self.path(f"{i}.vtu"))
        out = self.path("run.pvd")
        listed = run_json("replay", *snapshots, "-o", out)["snapshots"]
        self.assertEqual([s["file"] for s in listed], snapshots)
        files = xml.etree.ElementTree.parse(out).getroot().findall("Collection/DataSet")
        self.assertEqual([f.get("file") for f in files], ["run_0000.vtu", "run_0001.vtu", "run_0002.vtu"])
        self.assertEqual([int(f.get("timestep")) for f in files], [s["saved_epoch"] for s in listed])
        for i, file in enumerate(files):  # what the snapshot holds is what collide has drawn
            self.assertEqual(self.arrays(self.path(file.get("file"))), self.arrays(self.path(f"{i}.vtu")))
        run_json("replay", snapshots[0], snapshots[0], "-o", out)
        files = xml.etree.ElementTree.parse(out).getroot().findall("Collection/DataSet")
        self.assertEqual([f.get("timestep") for f in files], ["0", "1"])
        capitals = self.path("CAPITALS.PVD")
        run_json("replay", *snapshots, "-o", capitals)
        files = xml.etree.ElementTree.parse(capitals).getroot().findall("Collection/DataSet")
        self.assertEqual([f.get("file") for f in files], [f"CAPITALS_000{i}.vtu" for i in range(3)])
        single = self.path("single.vtu")
        run_json("replay", snapshots[1], "-o", single)
        self.assertEqual(self.arrays(single), self.arrays(self.path("1.vtu")))
        self.assertEqual(found["contact_count"], 0)

    def test_meshes_that_are_disabled_and_tets_that_are_off(self):
        snapshot, out = self.path("grid.vox"), self.path("out.vtu")
        run_json(*self.placed, "--save", snapshot)
        with open(snapshot, "rb") as file:
            data = file.read()
        first = data.index(b"MESH")
        second = data.index(b"MESH", first + 1)

        def changed(disabled, cut):
            """The snapshot with some meshes disabled and tet 1 of the first one off (docs/snapshot.md)."""
            text = bytearray(data)
            for at in disabled:
                text[at + 20] |= 2
            if cut:
                end = second + 16 + (int.from_bytes(text[second + 8:second + 16], "little") + 7) // 8 * 8
                text[end:end] = b"CUTS" + struct.pack("<IQ", 0, 32) + text[first + 16:first + 20] + \
                    struct.pack("<I3Q", 0, 2, 0, 0)
            text[16:24] = len(text).to_bytes(8, "little")
            text[12:16] = zlib.crc32(text[16:]).to_bytes(4, "little")
            with open(snapshot, "wb") as file:
                file.write(text)
            run_json("replay", snapshot, "-o", out)
            arrays = self.arrays(out)
            return [(int(m), int(t)) for m, t in zip(arrays["CellData", "mesh"], arrays["CellData", "tet"])]
        self.assertEqual(changed([], False), [(0, 0), (0, 1), (1, 0)])
        self.assertEqual(changed([second], False), [(0, 0), (0, 1)])
        self.assertEqual(changed([], True), [(0, 0), (1, 0)])
        self.assertEqual(changed([first], True), [(0, 0)])  # the other one

    def test_refused(self):
        for code, words, *arguments in (
            (1, "out.stl: expected a name that ends with .vtu or .msh", *self.placed, "-o", self.path("out.stl")),
            (1, "cannot be written: No such file", *self.placed, "-o", self.path("no/out.vtu")),
            (1, "cannot be written: No such file", *self.placed, "--csv", self.path("no/out.csv")),
            (1, "cannot be written: Is a directory", *self.placed, "--csv", self.folder.name),
            (2, "expected a name that ends with .pvd", "replay", self.one, self.one, "-o", self.path("out.vtu")),
        ):
            done = run(*arguments)
            self.assertEqual((done.returncode, done.stdout), (code, b""))
            self.assertIn(words, done.stderr.decode())
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["one.msh", "surface.obj", "two.msh"])


if __name__ == "__main__":
    unittest.main()
