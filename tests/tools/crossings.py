"""vox check and vox collide --edges: surfaces that pass through themselves, bars laid across each other."""

import fractions
import json
import math
import os
import random
import unittest
import xml.etree.ElementTree

from command_line import TETS, TWO_TETS, msh
from vox import Files, run, run_json

FACES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5),
         (3, 7, 5)]
CUBE = [(2, 3, 5, 8), (1, 2, 3, 5), (4, 3, 2, 8), (6, 5, 8, 2), (7, 8, 5, 3)]  # five tetrahedra, counted from 1


def corners(low, high):
    return [tuple((high if i >> axis & 1 else low)[axis] for axis in range(3)) for i in range(8)]


def obj(*boxes):
    points = [p for box in boxes for p in corners(*box)]
    faces = [[8 * b + v + 1 for v in face] for b in range(len(boxes)) for face in FACES]
    return "".join(f"v {x} {y} {z}\n" for x, y, z in points) + "".join(f"f {a} {b} {c}\n" for a, b, c in faces)


ALONG_X = ((-4, -1, -1), (4, 1, 1))
ALONG_Y = ((-1, -4, 0.5), (1, 4, 2.5))


class Crossings(Files):
    def test_free(self):
        bar, far = obj(ALONG_X), obj(ALONG_X, ((-1, -4, 3), (1, 4, 5)))
        for name, text in ("bar.obj", bar), ("far.obj", far):
            path = self.write(name, text)
            found = run_json("check", path)
            self.assertEqual(list(found), ["free", "meshes"])
            self.assertIs(found["free"], True)
            self.assertEqual(found["meshes"][0]["crossings"], [])
            self.assertIn(b"free of self-intersection\n", run("check", path).stdout)
        found = run_json("check", self.write("two.msh", msh(TWO_TETS, TETS)))
        self.assertEqual((found["meshes"][0]["triangles"], found["meshes"][0]["edges"]), (6, 9))

    def check_crossed(self, *arguments):
        """The one mesh that is not free; the exit code says so, with JSON or without."""
        done = run("check", *arguments, "--json")
        self.assertEqual((done.returncode, done.stderr), (3, b""))
        found = json.loads(done.stdout)
        self.assertIs(found["free"], False)
        done = run("check", *arguments)
        self.assertEqual((done.returncode, done.stderr), (3, b""))
        self.assertIn(b" edges meet triangles (", done.stdout)
        return found["meshes"]

    def test_crossed_bars(self):
        path = self.write("crossed.obj", obj(ALONG_X, ALONG_Y))
        mesh, = self.check_crossed(path)
        self.assertEqual((mesh["triangles"], mesh["edges"]), (24, 36))
        self.assertEqual(len(mesh["crossings"]), mesh["through"] + mesh["touching"] + mesh["coplanar"])
        self.assertGreater(mesh["through"], 3)
        for crossing in mesh["crossings"]:
            self.assertEqual(crossing["edge"][0] < 8, crossing["triangle"][0] >= 8)  # of the other bar
            x, y, z = crossing["position"]
            self.assertTrue(0.5 <= z <= 1 and abs(x) <= 1 and abs(y) <= 1)
            self.assertIn(crossing["kind"], ("through", "touching", "coplanar"))
        many = run("check", path, "--limit", 2).stdout
        self.assertEqual(many.count(b"\n"), 4)
        self.assertIn(b"and %d more" % (len(mesh["crossings"]) - 2), many)
        # Several meshes: one that crosses is enough.
        self.assertEqual(len(self.check_crossed(self.write("bar.obj", obj(ALONG_X)), path)), 2)
        self.assertEqual(run("check", path, "--threads", 3).stdout, run("check", path).stdout)

    def test_drawing(self):
        path, out = self.write("crossed.obj", obj(ALONG_X, ALONG_Y)), self.path("out.vtu")
        mesh, = self.check_crossed(path, "-o", out)
        root = xml.etree.ElementTree.parse(out).getroot()
        arrays = {(section.tag, array.get("Name")): [float(x) for x in array.text.split()]
                  for section in root.find("UnstructuredGrid/Piece") for array in section}
        points = [0] * 16
        for crossing in mesh["crossings"]:
            for v in crossing["edge"]:
                points[v] += 1
        self.assertEqual(arrays["PointData", "crossings"], points)
        self.assertEqual(len(arrays["CellData", "crossings"]), 24)
        # Each crossing is one of its triangle, and one of each triangle with its edge.
        self.assertEqual(sum(arrays["CellData", "crossings"]), 3 * len(mesh["crossings"]))

    def test_repeated_vertices(self):
        """A file with three vertices of its own for each triangle is as one in which they are shared."""
        text, at = "", corners(*ALONG_X)
        for face in FACES:
            text += "".join("v {} {} {}\n".format(*at[v]) for v in face)
        text += "".join(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}\n" for i in range(len(FACES)))
        found = run_json("check", self.write("soup.obj", text))
        self.assertIs(found["free"], True)
        self.assertEqual(found["meshes"][0]["edges"], 18)

    def check_overlaps(self, text, folded, doubled, opposite, kind="off"):
        path = self.write("overlaps." + kind, text)
        done = run("check", path, "--json")
        self.assertEqual(done.returncode, 3 if folded or doubled or opposite else 0, done.stderr)
        mesh, = json.loads(done.stdout)["meshes"]
        self.assertEqual((mesh["folded"], mesh["doubled"], mesh["opposite"]), (folded, doubled, opposite))
        self.assertEqual([len(mesh["overlaps"]), mesh["crossings"]], [folded + doubled + opposite, []])
        return mesh["overlaps"], run("check", path).stdout.decode()

    def test_overlaps(self):
        """Triangles that share an edge, or all three vertices, and lie on each other."""
        def off(points, *faces):
            return f"OFF {len(points)} {len(faces)} 0\n" + "".join("{!r} {!r} {!r}\n".format(*p) for p in points) + "".join(
                "3 {} {} {}\n".format(*f) for f in faces)

        points = [(0, 0, 0), (2, 0, 0), (0.5, 1, 0), (1.5, 1.5, 0), (1, -1, 0), (1, 0, 1)]
        overlaps, text = self.check_overlaps(off(points, (0, 1, 2), (1, 0, 3)), 1, 0, 0)
        self.assertEqual(overlaps, [{"triangles": [[0, 1, 2], [1, 0, 3]], "kind": "folded"}])
        self.assertIn("1 pair of triangles lies on each other (1 folded, 0 doubled, 0 opposite)\n"
                      "  triangles 0 1 2 and 1 0 3, folded\n", text)
        self.check_overlaps(off(points, (0, 1, 2), (1, 0, 4), (0, 1, 5)), 0, 0, 0)  # flat, and a fin
        self.check_overlaps(off(points, (0, 1, 2), (1, 2, 0), (2, 1, 0)), 0, 1, 1)
        self.check_overlaps(off(points, (0, 1, 2), (1, 2, 0), (1, 0, 3)), 1, 1, 0)
        # Exactly: a plane that rounds, and the same with the last bit of one number changed; in every order of the fin's angle.
        for far in (0, 1e6):
            a, b, c, d = ((far + x, 3 * x, y) for x, y in ((0.1, 0.3), (0.7, 0.3), (0.2, 0.9), (0.6, 0.8)))
            for turn in range(3):
                points = [tuple(p[(i + turn) % 3] for i in range(3)) for p in (a, b, c, d)]
                exact = self.volume(points) == 0
                self.check_overlaps(off(points, (0, 1, 2), (0, 1, 3)), int(exact), 0, 0)
        points = [(0, 0, 0), (1, 1, 0), (0, 1, 0.25), (0.5, 2, 0.375)]
        self.assertEqual(self.volume(points), 0)
        self.check_overlaps(off(points, (0, 1, 2), (0, 1, 3)), 1, 0, 0)
        points[3] = (0.5, 2, math.nextafter(0.375, 1))
        self.check_overlaps(off(points, (0, 1, 2), (0, 1, 3)), 0, 0, 0)
        # A fan of many pages about one edge, every other page twice as high.
        count = 60
        points = [(0, 0, 0), (0, 0, 1)] + [(s * x, s * y, 0.5) for s in (1, 2) for x, y in
                                           ((random.Random(i).randint(-9, 9) * 64 + i, 64 * 9 + i) for i in range(count))]
        self.check_overlaps(off(points, *((0, 1, 2 + i) for i in range(2 * count))), self.folds(points), 0, 0)

    @staticmethod
    def volume(points):
        a, b, c, d = ([fractions.Fraction(x) for x in p] for p in points)
        u, v, w = ([y - x for x, y in zip(a, p)] for p in (b, c, d))
        return sum(u[i] * (v[(i + 1) % 3] * w[(i + 2) % 3] - v[(i + 2) % 3] * w[(i + 1) % 3]) for i in range(3))

    @staticmethod
    def folds(points):
        """How many pages have the direction of one before, about the z axis."""
        return len(points) - 2 - len({fractions.Fraction(x, y) for x, y, _ in points[2:]})

    def test_rounding(self):
        """Doubles that are apart, and as floats are not."""
        near = (1, 1, 1 + 1e-12)
        text = "v 0 0 1\nv 2 0 1\nv 0 2 1\nf 1 2 3\nv {} {} {!r}\nv 3 3 5\nv 3 2 5\nf 4 5 6\n".format(0.5, 0.5, near[2])
        path = self.write("near.obj", text)
        self.assertIs(run_json("check", path)["free"], True)
        mesh, = self.check_crossed(path, "--float")
        self.assertEqual((mesh["through"], mesh["touching"]), (0, 2))

    def test_wrong(self):
        path = self.write("bar.obj", obj(ALONG_X))
        for arguments, code, words in (
                ((), 2, b"MESH"), ((path, path, "-o", "x.vtu"), 2, b"-o takes one mesh"),
                ((path, "-o", self.path("x.obj")), 1, b".vtu"), ((self.path("none.obj"),), 1, b"none.obj"),
                ((self.write("points.obj", "v 0 0 0\nv 1 1 1\n"),), 1, b"")):
            done = run("check", *arguments)
            self.assertEqual(done.returncode, code, arguments)
            self.assertIn(words, done.stderr)

    def test_collide(self):
        first = self.write("x.msh", msh(corners(*ALONG_X), CUBE))
        second = self.write("y.msh", msh(corners(*ALONG_Y), CUBE))
        without = run_json("collide", first, second)
        self.assertEqual(without["contact_count"], 0)
        self.assertEqual(without["constraints"], [])
        found = run_json("collide", first, second, "--edges")
        self.assertEqual(found["contact_count"], 0)
        edges = found["constraints"]
        self.assertEqual(found["counters"]["edge_contacts"], len(edges))
        self.assertGreater(len(edges), 3)
        up = 0
        for e in edges:
            self.assertEqual((e["kind"], e["count_a"], len(e["vertices"])), ("edge", 2, 5))
            self.assertEqual(sorted((e["body_a"], e["body_b"])), [0, 1])
            self.assertTrue(0.5 <= e["position"][2] <= 1)
            if e["state"] == "closest" and e["gap"] == -0.5:
                self.assertAlmostEqual(e["normal"][2], 1 if e["body_a"] == 1 else -1)
                up += 1
        self.assertGreater(up, 1)
        text = run("collide", first, second, "--edges", "--limit", 1, "--no-depth").stdout
        self.assertIn(b"\n%d constraints: %d edge\n" % (len(edges), len(edges)), text)
        self.assertIn(b"  and %d more" % (len(edges) - 1), text)
        # A saved grid has the flag.
        saved = self.path("saved.vox")
        self.assertEqual(run("collide", first, second, "--edges", "--save", saved).returncode, 0)
        self.assertEqual(run_json("replay", saved)["counters"]["edge_contacts"], len(edges))


class Resolve(Files):
    """vox resolve"""

    def setUp(self):
        super().setUp()
        self.along = self.write("along.obj", obj(ALONG_X))
        self.across = self.write("across.obj", obj(ALONG_Y))

    def test_bars(self):
        out = self.path(os.path.join("out", "new"))
        found = run_json("resolve", self.along, self.across, "-o", out, "--gap", "0.01", "--fixed", "along")
        self.assertEqual((found["resolved"], found["crossings"], found["close_pairs"], found["places"]), (True, 0, 0, []))
        self.assertGreater(found["crossings_before"], 0)
        self.assertEqual([mesh["fixed"] for mesh in found["meshes"]], [True, False])
        self.assertEqual([mesh["largest_move"] > 0 for mesh in found["meshes"]], [False, True])
        both = "".join(open(mesh["output"], encoding="ascii").read() for mesh in found["meshes"])
        faces = [line for line in both.splitlines() if line[0] == "f"]
        moved = [" ".join(["f", *(str(int(v) + 8) for v in line.split()[1:])]) for line in faces[12:]]
        points = [line for line in both.splitlines() if line[0] == "v"]
        self.assertTrue(run_json("check", self.write("both.obj", "\n".join(points + faces[:12] + moved) + "\n"))["free"])
        with open(found["meshes"][0]["output"], encoding="ascii") as file:
            self.assertEqual(sorted([float(x) for x in line.split()[1:]] for line in file if line[0] == "v"),
                             sorted(list(map(float, corner)) for corner in corners(*ALONG_X)))

    def test_what_is_left(self):
        for options in (["--max-move", "0.01"], ["--fixed", "along", "--fixed", self.across]):
            done = run("resolve", self.along, self.across, *options, "--limit", "2", "--json")
            self.assertEqual((done.returncode, done.stderr), (3, b""))
            found = json.loads(done.stdout)
            self.assertEqual((found["resolved"], len(found["places"])), (False, 2))
            self.assertEqual(sorted(found["places"][0]["meshes"]), [0, 1])
            self.assertLess(max(map(abs, found["places"][0]["position"])), 2)
            done = run("resolve", self.along, self.across, *options, "--limit", "2")
            self.assertEqual(done.returncode, 3)
            self.assertEqual(done.stdout.count(b"  left: "), 2)

    def test_wrong_usage(self):
        done = run("resolve", self.along, "--fixed", "other")
        self.assertEqual((done.returncode, b"--fixed other names none" in done.stderr), (2, True))
        done = run("resolve", self.along, self.along, "-o", self.path("out"))
        self.assertEqual((done.returncode, b"two meshes would be written" in done.stderr), (1, True))
        self.assertEqual(run("resolve", self.along, "--gap", "-1").returncode, 2)


if __name__ == "__main__":
    unittest.main()
