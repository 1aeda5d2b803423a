"""vox sweep: keys and what must hold between them, going on with a file that was cut off, and what is refused."""

import csv
import os
import re
import signal
import subprocess
import time
import unittest

from vox import TOOL, Files, run, run_json

BALL = ["--ball", 1500, "--count", 6, "--frames", 3]  # small: times are the machine's and not tested
RULES = {"suggestion", "traditional", "mean_edge_multiple", "object_512", "mean_volume", "median_box_side"}


class Sweep(Files):
    def lines(self, path):
        with open(path, encoding="ascii") as file:
            return file.read().splitlines()

    def refused(self, code, pattern, *arguments):
        for json in [], ["--json"]:
            done = run("sweep", *arguments, *json)
            self.assertEqual(done.returncode, code, (arguments, done.stderr))
            self.assertEqual(done.stdout, b"", arguments)
            self.assertRegex(done.stderr.decode(), r"\Avox: .*" + pattern)

    # ---- what it says ----

    def check_size(self, found, size):
        self.assertAlmostEqual(size["cells_per_axis"], found["world"] / size["cell_size"], 9)

    def test_keys(self):
        found = run_json("sweep", *BALL, "--rounds", 2, "--world", 4)
        self.assertEqual((found["engine"], found["frames"], found["rounds"], found["world"]), ("reference", 3, 2, 4))
        self.assertEqual(found["tets"], sum(mesh["tets"] for mesh in found["meshes"]))
        self.assertEqual(found["meshes"][0], found["meshes"][1])
        self.assertEqual(found["clock"], "processor")
        share = found["contact_share"]
        self.assertEqual(share["wanted"], 0.01)
        self.assertAlmostEqual(share["mean"], 0.01, delta=0.003)
        self.assertAlmostEqual(sum(share["frames"]) / 3, share["mean"], 12)

        samples = found["samples"]
        sizes = [sample["cell_size"] for sample in samples]
        self.assertEqual(sizes, sorted(sizes))
        self.assertEqual({sample["rule"] for sample in samples}, RULES | {None})
        self.assertEqual(sum(sample["rule"] is None for sample in samples), 6)
        for sample in samples:
            self.check_size(found, sample)
            self.assertEqual(sample["contacts"], found["contacts"])
            self.assertEqual(len(sample["rounds_ns"]), 2)
            self.assertGreater(sample["time_ns"], 0)
            # The median of two is their mean.
            self.assertAlmostEqual(sample["time_ns"] / sum(sample["rounds_ns"]), 0.5, 9)
        cells = [sample["visited_cells"] for sample in samples]
        self.assertEqual(cells, sorted(cells, reverse=True))

        fit, optimum = found["fit"], found["optimum"]
        self.assertEqual(len(fit["coefficients"]), fit["degree"] + 1)
        self.check_size(found, optimum)
        self.assertTrue(fit["range"]["min"] <= optimum["cell_size"] <= fit["range"]["max"])
        for sample in samples:
            inside = fit["range"]["min"] <= sample["cell_size"] <= fit["range"]["max"]
            self.assertEqual(sample["fitted_ns"] is not None, inside)
            if inside:
                self.assertGreaterEqual(sample["fitted_ns"], optimum["time_ns"] * (1 - 1e-6))
        for name, limit in ("zone", optimum["time_ns"] + 1e6), ("zone_5_percent", optimum["time_ns"] * 1.05):
            zone = found[name]
            self.assertAlmostEqual(zone["limit_ns"] / limit, 1, 9)
            self.assertTrue(zone["min"] <= optimum["cell_size"] <= zone["max"])
            self.assertTrue(zone["n_min"] <= optimum["cells_per_axis"] <= zone["n_max"])
            self.assertAlmostEqual(zone["n_min"], found["world"] / zone["max"], 9)

        self.assertEqual(set(found["rules"]), RULES)
        self.assertEqual(found["suggestion"], found["rules"]["suggestion"])
        self.assertEqual(found["traditional"], found["rules"]["traditional"])
        best = min(sample["time_ns"] for sample in samples)
        by_rule = {sample["rule"]: sample for sample in samples}
        n_opt = optimum["cells_per_axis"]
        for rule in RULES:
            sample = by_rule[rule]
            self.assertEqual(sample["cell_size"], found["rules"][rule]["cell_size"])
            self.assertAlmostEqual(found["regret"][rule], sample["time_ns"] / best - 1, 9)
            if sample["fitted_ns"] is None:
                self.assertIsNone(found["regret_fitted"][rule])
            else:
                self.assertAlmostEqual(found["regret_fitted"][rule], sample["fitted_ns"] / optimum["time_ns"] - 1, 9)
            for name, zone in ("epsilon", found["zone"]), ("epsilon_5_percent", found["zone_5_percent"]):
                n = sample["cells_per_axis"]  # Eq. 9: the distance in widths of the zone on that side
                width = n_opt - zone["n_min"] if n < n_opt else zone["n_max"] - n_opt
                if width > 0:
                    self.assertAlmostEqual(found[name][rule] / (abs(n_opt - n) / width), 1, 6)
                else:  # the optimum at the end of the range: no width there
                    self.assertIsNone(found[name][rule])

    def test_range_and_rules(self):
        found = run_json("sweep", *BALL, "--rounds", 1, "--cells-per-axis", 4, 16, "--world", 2)
        swept = [sample["cells_per_axis"] for sample in found["samples"] if sample["rule"] is None]
        self.assertAlmostEqual(max(swept), 16, 9)
        self.assertAlmostEqual(min(swept), 4, 9)
        suggested = run_json("sweep", *BALL, "--rounds", 1, "--cell-sizes", 0.1, 0.4)
        swept = [sample["cell_size"] for sample in suggested["samples"] if sample["rule"] is None]
        self.assertAlmostEqual(swept[0], 0.1, 12)
        self.assertEqual(swept[-1], 0.4)
        ratios = [b / a for a, b in zip(swept, swept[1:])]
        self.assertAlmostEqual(max(ratios), min(ratios), 9)
        self.assertEqual(suggested["hash"], found["hash"])
        self.assertEqual(suggested["suggestion"]["cell_size"], found["suggestion"]["cell_size"])

    def test_engines_find_the_same(self):
        found = [run_json("sweep", *BALL, "--rounds", 1, "--engine", engine) for engine in ("reference", "fast")]
        self.assertEqual(found[0]["hash"], found[1]["hash"])
        self.assertEqual(found[0]["contacts"], found[1]["contacts"])
        self.assertEqual(found[1]["engine"], "fast")
        self.assertEqual(run_json("sweep", *BALL, "--rounds", 1, "--threads", 2)["clock"], "wall")

    def test_share_and_axis(self):
        near = run_json("sweep", *BALL, "--rounds", 1, "--share", 0.04)
        far = run_json("sweep", *BALL, "--rounds", 1, "--share", 0.01)
        other = run_json("sweep", *BALL, "--rounds", 1, "--share", 0.01, "--axis", 0, -1, 2)
        self.assertLess(near["distance"], far["distance"])
        self.assertAlmostEqual(near["contact_share"]["mean"], 0.04, delta=0.01)
        self.assertNotEqual(other["hash"], far["hash"])
        self.assertAlmostEqual(other["distance"], far["distance"], delta=0.3)

    def test_text(self):
        done = run("sweep", *BALL, "--rounds", 1, "--svg", self.path("sweep.svg"))
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        text = done.stdout.decode()
        with open(self.path("sweep.svg"), encoding="utf-8") as file:
            picture = file.read()
        for words in "Time of detection over cell size", "mean edge", "suggested", "nearly as good", ">time of detection in a step, ms<":
            self.assertIn(words, picture)
        # The numbers along that axis are milliseconds: from them, the best size's dot is at the time that the text says.
        ticks = [(float(y) - 4, float(ms)) for y, ms in re.findall(r'y="([\d.]+)" text-anchor="end">([\d.]+)<', picture)]
        self.assertTrue(4 <= len(ticks) <= 9, ticks)
        (low, first), (high, last) = ticks[0], ticks[-1]
        dot = float(re.search(r'cy="([\d.]+)" r="6" class="best"', picture)[1])
        best = float(re.search(r"best ([\d.e+-]+) ms at n", picture)[1])
        self.assertAlmostEqual(first + (dot - low) / (high - low) * (last - first), best, delta=0.01 * best)
        for words in "in contact", "Best cell size", "At most 1 ms above it", "suggestion", "epsilon":
            self.assertIn(words, text)

    # ---- files ----

    def test_goes_on_where_it_was(self):
        path = self.path("samples.csv")
        run_json("sweep", *BALL, "--rounds", 2, "--csv", path)
        whole = self.lines(path)
        self.assertEqual(len(whole), 1 + 2 * (6 + len(RULES)))
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["name"] for row in rows}, RULES | {""})
        self.assertEqual(len({(row["round"], row["cell_size"]) for row in rows}), len(rows))
        first, second = ([row["cell_size"] for row in rows if row["round"] == r] for r in "01")
        self.assertEqual(sorted(first), sorted(second))
        self.assertNotEqual(first, second)   # another order in each round
        self.assertNotEqual(first, sorted(first, key=float))

        # Cut off in the middle of a line: what was whole stays, the rest is measured, in the same order.
        cut = self.path("cut.csv")
        with open(cut, "w") as file:
            file.write("\n".join(whole[:9]) + "\n" + whole[9][:-20])
        found = run_json("sweep", *BALL, "--rounds", 2, "--resume", cut)
        again = self.lines(cut)
        self.assertEqual(again[:9], whole[:9])
        self.assertEqual([line.rsplit(",", 1)[0] for line in again], [line.rsplit(",", 1)[0] for line in whole])
        self.assertEqual(len(found["samples"]), 6 + len(RULES))

        # A whole file is not measured again: two runs say the same. More rounds only add lines.
        self.assertEqual(run_json("sweep", *BALL, "--rounds", 2, "--resume", cut), found)
        self.assertEqual(self.lines(cut), again)
        # Nor is it said that the machine was busy meanwhile.
        done = subprocess.run([TOOL, "sweep", *map(str, BALL), "--rounds", "2", "--resume", cut], capture_output=True)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        run_json("sweep", *BALL, "--rounds", 3, "--resume", cut)
        self.assertEqual(self.lines(cut)[:len(again)], again)
        self.assertEqual(len(self.lines(cut)), 1 + 3 * (6 + len(RULES)))

        # --csv starts again, but only if it is forced to; --resume of no file, and of an empty one, starts.
        kept = self.lines(cut)
        self.refused(1, "cut.csv: there is such a file; --resume continues it, --force", *BALL, "--csv", cut)
        self.assertEqual(self.lines(cut), kept)
        run_json("sweep", *BALL, "--rounds", 1, "--csv", cut, "--force")
        self.assertEqual(len(self.lines(cut)), 1 + 6 + len(RULES))
        for name in self.path("new.csv"), self.write("empty.csv", ""):
            run_json("sweep", *BALL, "--rounds", 1, "--resume", name)
            self.assertEqual(len(self.lines(name)), 1 + 6 + len(RULES))

    def test_files_that_do_not_fit(self):
        path = self.path("samples.csv")
        run_json("sweep", *BALL, "--rounds", 1, "--csv", path)
        lines = self.lines(path)
        self.refused(1, "line 2 belongs to another experiment", *BALL, "--rounds", 1, "--share", 0.05, "--resume", path)
        self.refused(1, "line 2 belongs to another experiment", *BALL, "--rounds", 1, "--engine", "fast", "--resume", path)
        self.assertEqual(self.lines(path), lines)
        for number, (bad, pattern) in enumerate((
            ("name,cell_size", "line 1 is not the header"),
            ("garbage", "line 1 is not the header"),
            (lines[0] + "\n" + "1,2,3", "line 2 is not a sample"),
            (lines[0] + "\n" + lines[1].replace(",0,", ",zero,", 1), "line 2 is not a sample"),
            (lines[0] + "\n" + lines[1] + "x", "line 2 is not a sample"),
            (lines[0] + "\n" + lines[1].rsplit(" ", 1)[0], "line 2 has 2 frames, this experiment has 3"),
        )):
            with self.subTest(bad=bad):
                self.refused(1, pattern, *BALL, "--rounds", 1, "--resume", self.write(f"bad{number}.csv", bad + "\n"))
        self.refused(1, "line 1 is not the header", *BALL, "--rounds", 1, "--resume", self.write("no.csv", "garbage"))
        self.refused(1, "cannot be written", *BALL, "--rounds", 1, "--csv", self.path("no/x.csv"))
        self.refused(1, "cannot be written", *BALL, "--rounds", 1, "--resume", self.folder.name)

    @unittest.skipUnless(hasattr(signal, "SIGSTOP"), "no signals here")
    def test_waiting_is_not_measured(self):
        """A process that is stopped for seconds says so, and no time of a frame has these seconds."""
        path = self.path("samples.csv")
        sweep = subprocess.Popen([TOOL, "sweep", "--ball", "30000", "--count", "8", "--frames", "3", "--rounds", "2",
                                  "--csv", path], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        while sweep.poll() is None and not (os.path.exists(path) and len(self.lines(path)) > 3):
            time.sleep(0.002)
        self.assertIsNone(sweep.poll(), "the sweep ended before it could be stopped")
        sweep.send_signal(signal.SIGSTOP)
        time.sleep(6)
        sweep.send_signal(signal.SIGCONT)
        _, words = sweep.communicate(timeout=600)
        self.assertEqual(sweep.returncode, 0)
        self.assertRegex(words.decode(), r"\Avox: warning: the machine is busy: of [0-9.]+ s of measuring, this process "
                                         r"had a processor for [0-9.]+ s")
        with open(path, newline="") as file:
            times = [int(ns) for row in csv.DictReader(file) for ns in row["frames_ns"].split()]
        self.assertLess(max(times), 5e9)

    # ---- refused ----

    def test_wrong_usage(self):
        for arguments in (
            [], ["a.msh", "--ball", 1000], [*BALL, "--count", 4], [*BALL, "--rounds", 0], [*BALL, "--frames", 0],
            [*BALL, "--share", 0], [*BALL, "--share", 1], [*BALL, "--share", "nan"], [*BALL, "--axis", 0, 0, 0],
            [*BALL, "--axis", 1, 0], [*BALL, "--time-step", 0], [*BALL, "--cell-sizes", 2, 1],
            [*BALL, "--cell-sizes", 1, 1], [*BALL, "--cell-sizes", 0, 1], [*BALL, "--cells-per-axis", 9, 3],
            [*BALL, "--cells-per-axis", 3, 9, "--cell-sizes", 1, 2], [*BALL, "--engine", "warp"],
            [*BALL, "--csv", "a", "--resume", "b"], [*BALL, "--world", -1], ["--ball", 0], ["--ball", "many"],
        ):
            with self.subTest(arguments=arguments):
                self.refused(2, "", *arguments)

    def test_bad_input(self):
        missing = self.path("missing.msh")
        self.refused(1, "missing.msh", missing)
        surface = self.write("surface.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 3 4\n")
        self.refused(1, "0 tets", surface)
        self.refused(1, "expected 0.95", "--ball", 1500, "--share", 0.95)


if __name__ == "__main__":
    unittest.main()
