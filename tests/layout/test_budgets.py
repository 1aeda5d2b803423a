"""What has a budget of lines, as wc counts them: the benchmarks, and the pictures and figures of the pages. A higher number here is
said, with its reason, in the message of the commit."""

import os
import tempfile
import unittest

from repository import ROOT, files

BUDGETS = [
    ("the benchmarks", "bench", ("",), 10000),
    ("pictures and figures of the pages", "docs", (".svg", ".gif", ".png", ".webp", ".csv"), 3000),
]


def lines_of(path):
    with open(path, "rb") as file:
        return file.read().count(b"\n")


def faults(root, budgets):
    found = []
    for what, folder, endings, most in budgets:
        count = sum(lines_of(os.path.join(root, path)) for path in files(*endings, under=folder, root=root))
        if count > most:
            found.append(f"{what}, {folder}/: {count} lines, at most {most} are allowed")
        if count < most // 10:
            found.append(f"{what}, {folder}/: {count} lines of at most {most}: is this budget of anything?")
    return found


class Budgets(unittest.TestCase):
    def test_repository(self):
        self.assertEqual(faults(ROOT, BUDGETS), [])

    def test_each_fault_is_noticed(self):
        with tempfile.TemporaryDirectory() as root:
            os.mkdir(os.path.join(root, "bench"))
            with open(os.path.join(root, "bench", "a.c"), "wb") as file:
                file.write(b"int a;\n" * 30)
            for most, words in ((30, ""), (29, "30 lines, at most 29"), (400, "of anything")):
                self.assertIn(words, "".join(faults(root, [("x", "bench", ("",), most)])))


if __name__ == "__main__":
    unittest.main()
