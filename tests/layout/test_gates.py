"""The table of CONTRIBUTING.md lists what .ci/nightly.py runs, and every command of ./dev in either is one. What nightly.py
writes, it can read again."""

import importlib.util
import os
import re
import unittest

from repository import ROOT, text_of

SPEC = importlib.util.spec_from_file_location("nightly", os.path.join(ROOT, ".ci", "nightly.py"))
nightly = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(nightly)


def parts_of_table(text):
    """Names in the third column of the table under the heading "Gates"."""
    rows = re.findall(r"^\|(.*)\|$", text[text.index("\n## Gates\n"):], flags=re.M)
    return {name for row in rows[2:] for name in re.findall(r"`([\w-]+)`", row.split("|")[2])}


def commands_of(text):
    return set(re.findall(r"\./dev ([a-z]+)", re.sub(r"^#.*| # .*", "", text, flags=re.M)))


def branches_of(script):
    """The commands that ./dev knows."""
    return {name for names in re.findall(r"^([a-z][a-z |]*)\)(?: command=| *$)", script, flags=re.M) for name in names.split(" | ")}


class Gates(unittest.TestCase):
    def test_table_lists_the_parts(self):
        self.assertEqual(parts_of_table(text_of("CONTRIBUTING.md")), set(nightly.PARTS))

    def test_commands_exist(self):
        known = branches_of(text_of("dev"))
        self.assertIn("test", known)
        for place, text in [(name, part[0]) for name, part in nightly.PARTS.items()] + [
                (path, text_of(path)) for path in (".ci/run", "CONTRIBUTING.md", "RELEASING.md", "SECURITY.md", "tests/README.md")]:
            self.assertEqual(commands_of(text) - known, set(), place)

    def test_presets_exist(self):
        presets = re.findall(r'"name": "([\w-]+)"', text_of("CMakePresets.json"))
        for command, _ in nightly.PARTS.values():
            for preset in re.findall(r"\./dev test ([\w-]+)", command):
                self.assertEqual(presets.count(preset), 3, preset)  # to configure, build and test

    def test_rows_are_kept_and_replaced(self):
        row = dict(zip(nightly.COLUMNS, ("tsan", "`./dev test tsan`", "0123456789", "2026-01-31", "12", "passed, 1 skipped")))
        fuzz = {**row, "part": "fuzz", "result": "FAILED (8)"}
        rows = nightly.read_table(nightly.table({"tsan": row, "fuzz": fuzz, "gone": row}))
        self.assertEqual(rows, {"tsan": row, "fuzz": fuzz})

    def test_what_was_skipped_is_said(self):
        self.assertEqual(nightly.result_of(0, "all well"), "passed")
        self.assertEqual(nightly.result_of(0, "1/2 Test #1: web ....***Skipped 0.1 sec\nSKIPPED: deb\n"), "passed, 2 skipped")
        self.assertEqual(nightly.result_of(8, ""), "FAILED (8)")


if __name__ == "__main__":
    unittest.main()
