"""The report of the benchmark says which figures are of a step with constraints and which of contacts alone."""

import csv
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
REPORT = os.path.join(ROOT, "bench", "report.py")
DOCS = os.path.join(ROOT, "docs", "evidence")
FIELDS = ("date cpu build command scene title tets vertices bodies contacts mean_edge entrant kind steps median_ns fastest_ns "
          "setup_ns bytes cell_size agrees").split()
# Milliseconds of a step, bytes a tetrahedron.
TIMES = {"vox": (2.0, 70), "vox contacts": (1.0, 35), "vox AVX2": (2.5, 70), "vox reference": (150.0, 50), "Embree refit": (30.0, 100),
         "Embree rebuild": (24.0, 100), "F1 positions": (0.05, 0), "F2 tet boxes": (1.0, 0)}


def kind(entrant):
    return "vox" if entrant.startswith("vox") else "floor" if entrant.startswith("F") else "peer"


def rows(scene, tets, entrants):
    return [dict(zip(FIELDS, ["2026-01-01", "a processor", "a build", "./dev bench --meshes /a/b", scene, "two bodies", tets,
                              tets // 5, 2, 10, 1, name, kind(name), 9, 1e6 * TIMES[name][0] * tets / 1e6,
                              1e6 * TIMES[name][0] * tets / 1e6, 1e8 * tets / 1e6, TIMES[name][1] * tets, 0, 1]))
            for name in entrants]


class Report(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.results = os.path.join(self.folder.name, "results.csv")
        self.write(list(TIMES))

    def write(self, entrants):
        with open(self.results, "w", newline="", encoding="utf-8") as file:
            out = csv.DictWriter(file, FIELDS)
            out.writeheader()
            out.writerows(rows("contact-1", 1000000, entrants) + rows("tangled", 1000000, entrants))
            for tets in (10000, 100000, 1000000):
                out.writerows(rows("self", tets, [e for e in entrants if kind(e) == "floor" or e in ("vox", "vox contacts")]))

    def report(self, *arguments):
        run = subprocess.run([sys.executable, "-B", REPORT, self.results, *arguments], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def page(self, text, option):
        path = os.path.join(self.folder.name, "page.md")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        self.report(option, path)
        with open(path, encoding="utf-8") as file:
            return file.read()

    def test_the_step_with_constraints_comes_first(self):
        text = self.report()
        self.assertIn("| scene | tets | with constraints, ms | contacts alone, ms | constraints / contacts alone | constraints with AVX2 / with AVX-512 |", text)
        self.assertIn("| two bodies | 1000000 | 2.00 | 1.00 | 2.00 | 1.25 | 12.0 | 24.0 | Embree rebuild | 150 | 1.00 |", text)
        self.assertIn("Memory of a grid with constraints: at most 70.0 bytes", text)
        self.assertIn("Memory of a default grid: at most 35.0 bytes", text)
        self.assertIn("Growth, self, with constraints: time grows with the 1.00th power", text)
        self.assertIn("Growth, self, contacts alone: time grows with the 1.00th power", text)
        self.assertIn("--meshes FOLDER", text)

    def test_aims(self):
        text = self.page("before\n<!-- bench/aims -->\nold\n<!-- /bench/aims -->\nafter\n", "--aims")
        self.assertTrue(text.startswith("before\n<!-- bench/aims -->\n") and text.endswith("<!-- /bench/aims -->\nafter\n"))
        self.assertNotIn("old", text)
        full, alone = text.split("Contacts alone, the default:")
        self.assertIn("| two bodies | 1000000 | 2.00 (≤ 1.5): **missed** | 12.0 (≥ 12): met |", full)
        self.assertIn("| two bodies | 1000000 | 2.00 (≤ 5): met | - |", full)  # the tangled body
        self.assertIn("| two bodies | 1000000 | 150 (≥ 60): met | 24.0 (≥ 12): met | 1.00 (≤ 1.2): met (F2) |", alone)
        self.assertIn("Memory of a grid with constraints, bytes a tetrahedron beyond the caller's arrays, the worst scene but for the "
                      "hard ones (contact-1", alone)
        self.assertIn("70.0 (≤ 40): **missed**", alone)
        self.assertIn("with AVX2 beside AVX-512, the worst scene (contact-1, 1000000 tets): 1.25 (≤ 1.3): met", alone)

    def test_headlines(self):
        text = self.page("* **Fast.** <!-- bench/fast -->old<!-- /bench/fast --> More.\n", "--headlines")
        self.assertNotIn("old", text)
        self.assertIn("1.0 ms on one thread; with constraints, depths included, 2.0 ms.", text)
        self.assertIn("24 times as long to find the same contacts.<!--", text)

    def test_results_without_constraints(self):
        self.write([name for name in TIMES if name != "vox"])
        self.assertIn("| two bodies | 1000000 | - | 1.00 | - | - | - | 24.0 | Embree rebuild | 150 | 1.00 |", self.report())
        run = subprocess.run([sys.executable, "-B", REPORT, self.results, "--headlines", self.results], capture_output=True)
        self.assertNotEqual(run.returncode, 0)


class Charts(unittest.TestCase):
    def setUp(self):
        sys.path.insert(0, os.path.join(ROOT, "bench"))
        import chart
        self.chart = chart

    def test_only_what_can_be_seen(self):
        line = [(x, 0.001 * (x % 2)) for x in range(100)] + [(100, 50), (101, 0)]
        self.assertEqual(self.chart.thinned(line), [(0, 0), (99, 0.001), (100, 50), (101, 0)])
        chart = self.chart.Chart(100, 100, "a chart")
        panel = self.chart.Panel(chart, 0, 0, 100, 100, self.chart.Axis(0, 10, []), self.chart.Axis(0, 10, []))
        del chart.lines[:]
        panel.line([(0, 5), (5, 5), (6, 15), (7, 15), (8, 5)], "blue")
        panel.dots([(5, 5), (5, 11)], "blue")
        self.assertEqual(chart.lines, ['<path class="l blue" d="M0 50L50 50L55 0M75 0L80 50"/>',
                                       '<path class="d blue" stroke-width="6" d="M50 50h0"/>'])

    def test_ticks(self):
        self.assertEqual(self.chart.round_ticks(0, 24.7), [0, 5, 10, 15, 20])
        self.assertEqual(self.chart.decades(0.03, 1500), {0.1: "0.1", 1: "1", 10: "10", 100: "100", 1000: "1,000"})


class Pages(unittest.TestCase):
    """What is checked in is what the programs make of the results beside it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def same(self, name, text=None):
        if text is None:
            with open(os.path.join(self.folder, name), encoding="utf-8") as file:
                text = file.read()
        with open(os.path.join(DOCS, name), encoding="utf-8") as file:
            self.assertTrue(text == file.read(), f"docs/evidence/{name} is not what its program makes of docs/evidence/*.csv")

    def test_performance(self):
        results = os.path.join(DOCS, "performance.csv")
        pictures = [os.path.join(self.folder, name) for name in ("performance.svg", "performance-short.svg")]
        self.same("performance.md", subprocess.run([sys.executable, "-B", REPORT, results, "performance.svg"], capture_output=True,
                                                   encoding="utf-8", check=True).stdout)
        subprocess.run([sys.executable, "-B", os.path.join(ROOT, "bench", "plot.py"), results, *pictures], check=True)
        for picture in pictures:
            self.same(os.path.basename(picture))

    def test_paper(self):
        try:
            import numpy  # noqa: F401
        except ImportError:
            self.skipTest("there is no numpy")
        sys.path.insert(0, os.path.join(ROOT, "bench", "paper"))
        import paper_page
        for name in ("paper.csv", "paper-models.csv"):
            shutil.copy(os.path.join(DOCS, name), self.folder)
        paper_page.write(self.folder)
        for name in ("paper.md", "paper-times.svg", "paper-cost.svg", "paper-figure-3.svg"):
            self.same(name)


if __name__ == "__main__":
    unittest.main()
