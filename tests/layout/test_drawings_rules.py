"""Each drawing of docs/drawings has a module in docs/draw, a page that shows it in words, too, both colour schemes, words that can be
read on a phone, and few bytes. That it is what its module draws is the test `drawings`, which needs the libraries."""

import os
import re
import unittest

from repository import files, text_of

BYTES = 40000
SMALLEST = 18  # font size, where the drawing is 700 wide
WORDS = 10  # of the text in place of a picture, at least


def faults_of(svg):
    found = []
    if len(svg) > BYTES:
        found.append(f"{len(svg)} bytes")
    schemes = svg.split("@media (prefers-color-scheme:dark)")
    if len(schemes) < 2:
        found.append("no dark scheme")
    elif set(re.findall(r"\.\w+(?=\{(?:fill|color):#)", schemes[0])) - set(re.findall(r"\.\w+(?=\{)", svg[len(schemes[0]):])):
        found.append("colours in light alone")
    found += [f"font size {size}" for size in re.findall(r'font-size="(\d+)"', svg) if int(size) < SMALLEST]
    return found


class Drawings(unittest.TestCase):
    def test_each_can_be_read(self):
        drawings = files(".svg", under="docs/drawings")
        self.assertGreater(len(drawings), 9)
        self.assertEqual({path: faults_of(text_of(path)) for path in drawings if faults_of(text_of(path))}, {})

    def test_each_has_a_module_and_a_page(self):
        shown = {}
        for path in files(".md", under="docs"):
            for words, target in re.findall(r"!\[([^\]]*)\]\(([^)\s]*drawings/[^)\s]+)\)", text_of(path)):
                shown[os.path.basename(target)] = words
        names = {os.path.basename(path) for path in files(".svg", under="docs/drawings")}
        modules = {os.path.basename(path)[:-3].replace("_", "-") + ".svg" for path in files(".py", under="docs/draw")}
        self.assertEqual(names, modules - {"--main--.svg", "canvas.svg"})
        self.assertEqual(names, set(shown))
        self.assertEqual([words for words in shown.values() if len(words.split()) < WORDS], [])


class Faults(unittest.TestCase):
    def test_noticed(self):
        good = "<style>.a{fill:#fff}@media (prefers-color-scheme:dark){.a{fill:#000}}</style>"
        self.assertEqual(faults_of(good), [])
        self.assertEqual(faults_of(good.replace("@media", "")), ["no dark scheme"])
        self.assertEqual(faults_of(good.replace("<style>", "<style>.b{color:#111}")), ["colours in light alone"])
        self.assertEqual(faults_of(good + '<text font-size="9">'), ["font size 9"])
        self.assertEqual(faults_of(good + " " * BYTES), [f"{BYTES + len(good)} bytes"])


if __name__ == "__main__":
    unittest.main()
