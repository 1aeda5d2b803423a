"""The rules by which the repository's Markdown becomes pages, and what check.py notices; without the generator. Python with the
standard library only."""

import json
import os
import pathlib
import re
import tempfile
import unittest

import build
import check
import pages
import reference

TREE = {
    "README.md": "# A\n\n[text](docs/a.md#part)\n",
    "docs/a.md": "# Part\n",
    "docs/b.md": "# B\n",
    "bindings/x/README.md": "# X\n",
    "bindings/y/run.py": "print(1)\n",
    "examples/one.c": "int main(void) { return 0; } /* ``` */\n",
    "include/vox/vox.h": "/* */\n",
    "docs/p.svg": "<svg/>",
}
NAMES = {"vox_grid_step": ("reference/vox/step.md", "vox_grid_step")}


class Rules(unittest.TestCase):
    def made(self, text, path="docs/b.md"):
        with tempfile.TemporaryDirectory() as root:
            for name, content in TREE.items():
                os.makedirs(os.path.join(root, os.path.dirname(name)), exist_ok=True)
                with open(os.path.join(root, name), "w", encoding="utf-8") as file:
                    file.write(content)
            self.pages = pages.Pages(NAMES, root)
            return self.pages.page(path, text, path)

    def test_links(self):
        for text, wanted in [
            ("[a](a.md#part)", "[a](a.md#part)"),
            ("[a](../README.md)", "[a](../overview.md)"),
            ("[a](../bindings/x)", "[a](../bindings/x/README.md)"),
            ("[a](../bindings/y)", "[a](../bindings/y/index.md)"),
            ("see [`one`](../examples/one.c).", "see [`one`](../examples/one.c.md)."),
            ("[`vox.h`](../include/vox/vox.h)", "[`vox.h`](../reference/vox/README.md)"),
            ("[a.md](a.md), [docs/a.md](a.md#part)", "[Part](a.md), [Part](a.md#part)"),
            ("[![a](p.svg)](a.md)", "[![a](p.svg)](a.md)"),
            ("[a](#here) [b](https://example.org/a.md)", "[a](#here) [b](https://example.org/a.md)"),
            ("`[a](no.md)`", "`[a](no.md)`"),
            ("```\n[a](no.md)\n```", "```\n[a](no.md)\n```"),
            ("    [a](no.md)", "    [a](no.md)"),
        ]:
            with self.subTest(text=text):
                self.assertEqual(self.made(text), wanted)
                self.assertEqual(self.pages.faults, [])
        self.made("x [a](no.md) y")
        self.assertEqual(self.pages.faults, ["docs/b.md: no.md: there is no docs/no.md"])

    def test_what_is_linked_comes_along(self):
        self.made("[a](../bindings/y) ![p](p.svg) [r](../README.md)")
        self.assertEqual(
            sorted(self.pages.texts), ["bindings/y/index.md", "bindings/y/run.py.md", "docs/a.md", "overview.md"]
        )
        self.assertEqual(self.pages.files, {"docs/p.svg"})

    def test_names(self):
        link = "../reference/vox/step.md#vox_grid_step"
        for text, wanted in [
            ("call `vox_grid_step` now", f"call [`vox_grid_step`]({link}) now"),
            ("`vox_grid_step()`", f"[`vox_grid_step()`]({link})"),
            ("[`vox_grid_step`](a.md)", "[`vox_grid_step`](a.md)"),
            ("# `vox_grid_step`", "# `vox_grid_step`"),
            ("`vox_other`", "`vox_other`"),
            ("    vox_grid_step", "    vox_grid_step"),
        ]:
            with self.subTest(text=text):
                self.assertEqual(self.made(text), wanted)

    def test_programs(self):
        made = self.made("Look:\n\n[examples/one.c](../examples/one.c)\n\nand\n")
        self.assertIn('```{ .c title="examples/one.c" }\nint main', made)
        self.assertNotIn("one.c.md", made)
        self.assertIn("(../examples/one.c.md)", self.made("In [examples/one.c](../examples/one.c) and\n"))
        made = self.made("x\n\n<!-- prints one -->\n```text\n1\n```\n")
        self.assertIn('```{ .text title="prints" }\n1\n```', made)

    def test_tabs_figures_remarks_lists(self):
        made = self.made(
            "<details open><summary><b>C</b></summary>\n\n```c\nint a;\n\nint b;\n```\n\n</details>\n"
            "<details><summary><b>D</b></summary>\n\nx\n\n</details>\n"
        )
        self.assertIn('=== "C"\n\n    ```c\n    int a;\n\n    int b;\n    ```\n', made)
        self.assertIn('=== "D"\n\n    x\n', made)
        made = self.made("<!-- live: curve -->\n![c](p.svg)\n")
        self.assertIn('data-figure="curve" markdown="1">\n\n![c](p.svg)\n\n</div>', made)
        self.assertEqual(self.made("a<!-- repository --> b\nc<!-- /repository -->."), "a.")
        self.assertEqual(self.made("a\n\n<!-- playground: Try -->\n\nb"), "a\n\n\n\nb")
        self.pages.playground = True
        self.assertEqual(
            self.pages.page("docs/b.md", "<!-- playground: Try -->", "docs/b.md"), "[Try](../playground.md)"
        )
        self.assertEqual(self.made("a <!-- bench/x -->b<!-- /bench/x -->"), "a b")
        self.assertEqual(self.made("| `a\\|b` | c\\|d |"), "| `a|b` | c\\|d |")
        self.assertEqual(self.made("1. a\n\n   b\n\nc"), "1. a\n\n    b\n\nc")


class Repository(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.reference = reference.Reference()
        cls.pages = pages.collect(cls.reference.places, pages.FIRST + list(build.pages_of(build.NAVIGATION)))

    def test_every_link_leads_somewhere(self):
        self.assertEqual(self.pages.faults, [])

    def test_every_page_of_docs_is_in_the_navigation(self):
        listed = set(build.pages_of(build.NAVIGATION))
        self.assertEqual(
            [
                page
                for page in sorted(p.relative_to(pages.ROOT).as_posix() for p in pathlib.Path(pages.ROOT, "docs").rglob("*.md"))
                if page not in listed and not page.startswith("docs/site/")
            ],
            [],
        )

    def test_reference_has_every_name(self):
        texts = self.reference.pages()
        with open(os.path.join(pages.ROOT, "bindings", "api.json"), encoding="utf-8") as file:
            api = json.load(file)
        count = 0
        for parsed in api["headers"]:
            for thing in reference.things_of(parsed):
                page, anchor = self.reference.places[thing["name"]]
                self.assertIn(f"## `{thing['name']}`", texts[page])
                self.assertIn(f"{{ #{anchor} }}", texts[page])
                count += 1
                if thing in parsed["functions"]:
                    after = texts[page].split(f"{{ #{anchor} }}", 1)[1].split("\n## ", 1)[0].split("```")[2]
                    self.assertGreater(len(after.split()), 1, thing["name"])
                for value in thing.get("values", []):
                    self.assertIn(f'id="{value["name"]}"', texts[page])
        self.assertGreater(count, 250)

    def test_live_figures_exist(self):
        with open(os.path.join(build.HERE, "live", "figures.js"), encoding="utf-8") as file:
            known = set(re.findall(r"(\w+): \w+Figure", file.read()))
        used = {
            name
            for text in self.pages.texts.values()
            for name in re.findall(r'^<div class="vox-live" data-figure="(\w+)"', text, flags=re.M)
        }
        self.assertEqual(used, known)

    def test_requirements_have_checksums(self):
        with open(os.path.join(build.HERE, "requirements.txt"), encoding="utf-8") as file:
            packages = re.findall(r"^(\S+==\S+)(.*(?:\n    .*)*)", file.read(), flags=re.M)
        self.assertGreater(len(packages), 10)
        self.assertEqual([name for name, rest in packages if "--hash=sha256:" not in rest], [])


class Versions(unittest.TestCase):
    def test_list(self):
        with tempfile.TemporaryDirectory() as out:
            for name in ("0.9.0", "0.10.0", "main"):
                os.makedirs(os.path.join(out, name))
                for file, text in (("version.json", "{}"), ("index.html", name)):
                    with open(os.path.join(out, name, file), "w", encoding="utf-8") as written:
                        written.write(text)
            build.list_versions(out, "0.10.0")
            self.assertEqual(list(check.faults_of_versions(out, "0.10.0")), [])
            listed = json.loads(check.text_of(out, "versions.json"))
            self.assertEqual([v["version"] for v in listed], ["main", "0.10.0", "0.9.0"])
            self.assertEqual(check.text_of(out, "latest/index.html"), "0.10.0")
            self.assertIn("0.9.0 is not the latest", "".join(check.faults_of_versions(out, "0.9.0")))


class Checks(unittest.TestCase):
    POLICY = '<meta http-equiv="Content-Security-Policy" content="default-src \'self\'">'

    def faults(self, text, **others):
        with tempfile.TemporaryDirectory() as folder:
            for name, content in {
                "a.html": self.POLICY + text,
                "b.html": self.POLICY + '<h1 id="x">',
                "s.css": "",
                **others,
            }.items():
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(content)
            return "\n".join(check.faults_of_links(folder))

    def test_each_fault_is_noticed(self):
        for text in [
            '<a href="b.html#x">',
            '<a href="https://example.org">',
            '<img src="data:image/png;base64,">',
            '<a href="#">',
            '<a href="../0.1.0/index.html">',
            '<link rel="stylesheet" href="s.css">',
        ]:
            with self.subTest(text=text):
                self.assertEqual(self.faults(text), "")
        for text, words in [
            ('<a href="c.html">', "there is no c.html"),
            ('<a href="b.html#y">', "no such anchor"),
            ('<a href="/b.html">', "at the root"),
            ('<img src="p.png">', "there is no p.png"),
            ('<script src="https://example.org/a.js">', "loads https:"),
            ('<link rel="preconnect" href="//example.org">', "loads //example.org"),
            ('<p style="background: url(https://example.org/p.png)">', "loads https:"),
        ]:
            with self.subTest(text=text):
                self.assertIn(words, self.faults(text))
        self.assertIn(
            "loads https:", self.faults("", **{"t.css": "@font-face { src: url('https://example.org/f.woff') }"})
        )
        self.assertIn("no content security policy", self.faults("", **{"c.html": "<p>"}))


if __name__ == "__main__":
    unittest.main()
