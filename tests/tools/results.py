"""Files of results: collide -o, --csv and --no-depth, and the series of replay -o."""

import base64
import csv
import html.parser
import json
import os
import struct
import unittest
import xml.etree.ElementTree
import zlib

from command_line import TETS, TWO_TETS, msh
from vox import Files, run, run_json

KINDS = ["inside", "edge", "proximity", "impact"]
STATES = ["surface", "propagated", "closest", "ambiguous", "touching", "unknown", "plane"]


class Page(html.parser.HTMLParser):
    """What `collide -o x.html` writes: its title, its data, and whatever a browser would load."""

    def __init__(self, path):
        super().__init__()
        self.inside, self.texts, self.loads = "", {}, []
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())
        self.data = json.loads(self.texts["application/json"])

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.inside = found.get("type", tag)
        self.loads += [value for key, value in found.items() if key in ("src", "href") and value != "data:,"]

    def handle_data(self, data):
        self.texts[self.inside] = self.texts.get(self.inside, "") + data

    def numbers(self, text, kind):
        data = base64.b64decode(text, validate=True)
        return struct.unpack(f"<{len(data) // 4}{kind}", data)


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
        """The file has the contacts and constraints that the JSON has."""
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
        kind, state, gap, normal = [-1] * len(mesh), [-1] * len(mesh), [0] * len(mesh), [0] * 3 * len(mesh)
        for c in found["constraints"]:
            for v in c["vertices"][:c["count_a"]]:
                i = at[c["body_a"], v]
                if state[i] < 0 or c["gap"] < gap[i]:
                    kind[i], state[i], gap[i] = KINDS.index(c["kind"]), STATES.index(c["state"]), c["gap"]
                    normal[3 * i:3 * i + 3] = c["normal"]
        self.assertEqual(arrays["PointData", "kind"], kind)
        self.assertEqual(arrays["PointData", "state"], state)
        for name, expected in ("gap", gap), ("normal", normal):
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
        self.check_drawing(out, run_json("collide", self.two, self.two, "--self", "--edges", "-o", out))
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

    def test_page(self):
        out = self.path("out.html")
        odd = self.write("<!--script> &amp;.msh", msh(TWO_TETS[:4], TETS[:1]))
        for arguments, triangles in ((self.placed, (6, 4)), (["collide", odd, self.two, "--offset", 1e7, 0, 0, "--double"], (4, 6)),
                                     (["collide", self.two, "--self"], (6,)), ([*self.placed, "--no-depth"], (6, 4)),
                                     (["collide", self.one, self.surface, "--offset", 0.1, 0.1, 0.1], (4, 2))):
            found = run_json(*arguments, "-o", out)
            page = Page(out)
            self.assertEqual(page.loads, [])
            self.assertNotIn("{{", page.texts["title"] + page.texts["module"])
            self.assertEqual([body["name"] for body in page.data["bodies"]], [os.path.basename(mesh["file"]) for mesh in found["meshes"]])
            self.assertIn(page.data["bodies"][0]["name"], page.texts["title"])
            for body, count in zip(page.data["bodies"], triangles):
                corners = page.numbers(body["triangles"], "I")
                self.assertEqual(len(corners), 3 * count)
                self.assertEqual(set(corners), set(range(len(page.numbers(body["positions"], "f")) // 3)))
            contacts = page.numbers(page.data["contacts"], "f")
            self.assertEqual([page.data["contact_count"], len(contacts)], [found["contact_count"], 6 * found["contact_count"]])
            gaps = {(c["body_a"], c["vertices"][0], c["body_b"]): c["gap"] for c in found["constraints"]}
            for i, contact in enumerate(found["contacts"]):
                x, y, z = contacts[6 * i + 3:6 * i + 6]
                self.assertAlmostEqual((x * x + y * y + z * z) ** .5, -gaps[contact["body_a"], contact["vertex"], contact["body_b"]], 6)
        middle = page.data["middle"]  # of the last run: corners from 0 to 1, and from 0.1 to 1.1
        for x in middle:
            self.assertAlmostEqual(x, 0.55, 6)
        positions = page.numbers(page.data["bodies"][1]["positions"], "f")
        self.assertAlmostEqual(min(positions) + middle[0], 0.1, 6)

    def test_gmsh(self):
        out = self.path("out.msh")
        run_json(*self.placed, "-o", out)
        with open(out, encoding="ascii") as file:
            text = file.read()
        self.assertEqual((text.count("$NodeData"), text.count("$ElementData")), (7, 3))
        self.assertEqual(run_json("info", out)["meshes"][0]["tets"], 3)

    def test_table(self):
        out = self.path("out.csv")
        # Where the two tetrahedra overlap, a vertex has two contacts and one constraint.
        folded = self.write("folded.msh", msh(TWO_TETS[:4] + [(0.1, 0.1, 0.1)], TETS))
        found = run_json("collide", self.two, folded, "--offset", -0.2, -0.21, -0.22, "--self", "--margin", 1, "--csv", out)
        self.assertGreater(found["contact_count"], len([c for c in found["constraints"] if c["kind"] == "inside"]))
        self.assertEqual({c["kind"] for c in found["constraints"]}, {"inside", "proximity"})
        with open(out, encoding="ascii", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(found["constraints"]))
        for row, c in zip(rows, found["constraints"]):
            self.assertEqual([row["kind"], row["state"]], [c["kind"], c["state"]])
            self.assertEqual([int(row[key]) for key in ("body_a", "body_b")], [c["body_a"], c["body_b"]])
            for name, key in ("vertex", "vertices"), ("weight", "weights"):
                self.assertEqual([float(row[f"{name}_{i}"]) for i in range(len(c[key]))], c[key])
                self.assertEqual([row[f"{name}_{i}"] for i in range(len(c[key]), 5)], [""] * (5 - len(c[key])))
            self.assertEqual([float(row[key]) for key in ("gap", "time")], [c["gap"], c["time"]])
            for key in "normal", "position":
                self.assertEqual([float(row[f"{key}_{axis}"]) for axis in "xyz"], c[key])

    def test_no_depth(self):
        snapshot, drawing = self.path("bare.vox"), self.path("out.vtu")
        found, deep = run_json(*self.placed, "--no-depth", "--save", snapshot), run_json(*self.placed)
        self.assertEqual(found["profile"]["depth_ns"], 0)
        self.assertEqual(found["contacts"], deep["contacts"])
        (c,), (with_depth,) = found["constraints"], deep["constraints"]
        self.assertEqual(c, {**with_depth, "state": "unknown", "gap": 0, "normal": [0, 0, 0]})
        self.assertNotEqual(with_depth["gap"], 0)
        run_json("replay", snapshot, "-o", drawing)  # which finds them in any case
        self.check_drawing(drawing, deep)

    def test_margin(self):
        out = self.path("out.vtu")
        above = ["collide", self.one, self.one, "--offset", 0, 0, 1.125]
        found = run_json(*above, "--margin", 0.25, "-o", out)
        self.assertEqual(found["contacts"], [])
        self.assertEqual([(c["kind"], c["body_a"], c["vertices"][0], c["body_b"], c["gap"], c["normal"])
                          for c in found["constraints"]],
                         [("proximity", 0, 3, 1, 0.125, [0, 0, -1]), ("proximity", 1, 0, 0, 0.125, [0, 0, 1])])
        self.assertEqual(found["counters"]["proximities"], 2)
        arrays = self.check_drawing(out, found)
        self.assertEqual(arrays["PointData", "gap"], [0, 0, 0, 0.125, 0.125, 0, 0, 0])
        self.assertEqual(arrays["PointData", "normal"][9:15], [0, 0, -1, 0, 0, 1])
        self.assertIn("2 constraints: 2 proximity", run(*above, "--margin", 0.25).stdout.decode())
        self.assertEqual(run_json(*above)["constraints"], [])
        self.assertEqual(run(*above, "--margin", -1).returncode, 2)

    def test_moving(self):
        """A falls through B, and is outside of it before and after."""
        out = self.path("out.vtu")
        now, before = (self.write(name, msh([(x, y, z + to) for x, y, z in TWO_TETS[:4]], TETS[:1]))
                       for name, to in (("now.msh", -3), ("before.msh", 3)))
        falling = ["collide", now, self.one, "--offset", -0.25, -0.25, 0]
        found = run_json(*falling, "--moving", before, "-o", out)
        self.assertEqual(found["contacts"], [])
        self.assertEqual([(c["kind"], c["body_a"], c["vertices"], c["body_b"]) for c in found["constraints"]],
                         [("impact", 0, [0, 1, 2, 3], 1), ("impact", 0, [3, 1, 2, 3], 1)])
        for impact, time in zip(found["constraints"], (2.5 / 6, 3.5 / 6)):
            self.assertLessEqual(impact["time"], time)
            self.assertAlmostEqual(impact["time"], time, 12)
            self.assertLess(impact["gap"], 0)
        self.check_drawing(out, found)
        self.assertRegex(run(*falling, "--moving", before).stdout.decode(),
                         r"2 constraints: 2 impact\n(.*\n)+.* plane +A 3 in B 1 2 3, at 0.583333333 of the way\n")
        self.assertEqual(run_json(*falling)["constraints"], [])
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
            (1, "out.stl: expected a name that ends with .vtu or .msh or .html", *self.placed, "-o", self.path("out.stl")),
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
