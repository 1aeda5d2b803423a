"""Every link in the Markdown files leads to a file of the repository, and to a heading that is there; every path of the
repository that a document names exists. A program that a page quotes from a file, <!-- FILE --> before it, is that file."""

import os
import re
import unittest

from repository import ROOT, files, text_of

# Endings of what is drawn or measured for pages.
DATA = (".svg", ".gif", ".png", ".webp", ".csv")
# Folders of the repository that paths in documents begin with.
TREE = ("src", "tests", "bench", "docs", "examples", "include", "tools", "cmake", "scenes", "bindings")
# In src/README.md also those of src/.
TREE_OF_SRC = ("base", "exact", "mesh", "reference", "fast", "depth", "query", "cell_size", "grid", "api", "io", "sim")


def anchors_of(text):
    """The anchors that GitHub makes of the headings."""
    seen, anchors = {}, set()
    for heading in re.findall(r"^#+ +(.+?) *$", without_code(text), flags=re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        anchors.add(anchor if anchor not in seen else f"{anchor}-{seen[anchor]}")
        seen[anchor] = seen.get(anchor, 0) + 1
    return anchors


def without_code(text):
    """Also without <!-- remarks -->."""
    return re.sub(r"^```.*?^```|<!--.*?-->", lambda m: "\n" * m[0].count("\n"), text, flags=re.S | re.M)


def links_of(text):
    """(line, target) of inline links, pictures and reference definitions."""
    text = re.sub(r"`[^`\n]*`", lambda m: "`" + " " * (len(m[0]) - 2) + "`", without_code(text))
    for match in re.finditer(r"\]\(([^()\s]+)\)|^\[[^\]]+\]: *(\S+)", text, flags=re.M):
        yield text.count("\n", 0, match.start()) + 1, match[1] or match[2]


def faults_of(path, text, exists, text_at):
    found = []
    folder = os.path.dirname(path)
    for line, target in links_of(text):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        where = os.path.normpath(os.path.join(folder, name)).replace(os.sep, "/") if name else path
        if where.startswith(".."):
            found.append(f"{path}:{line}: {target} leads out of the repository")
        elif not exists(where):
            found.append(f"{path}:{line}: {target}: there is no {where}")
        elif anchor and where.endswith(".md") and anchor not in anchors_of(text_at(where)):
            found.append(f"{path}:{line}: {target}: {where} has no such heading")
    text = re.sub(r"<!--.*?-->", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
    tree = TREE + (TREE_OF_SRC if folder == "src" else ())
    for match in re.finditer(r"(?<![\w/.])(?:" + "|".join(tree) + r")/[\w./+~-]*[\w+]", text):
        name = match[0]
        line = text.count("\n", 0, match.start()) + 1
        ending = text[match.end():match.end() + 2]
        if "NAME" in name:  # stands for any
            continue
        if ending.startswith(".*") or ending.startswith("*"):  # x.*: a pair of files
            parent, stem = os.path.split(name)
            if not any(exists(at) and any(n.startswith(stem) for n in text_at(at)) for at in (parent, f"{folder}/{parent}")):
                found.append(f"{path}:{line}: {name}{ending}: there is no such file")
        elif not exists(name) and not exists(f"{folder}/{name}"):
            found.append(f"{path}:{line}: {name}: there is no such file")
    return found


def in_repository(where):
    return os.path.exists(os.path.join(ROOT, where))


def text_or_names(where):
    path = os.path.join(ROOT, where)
    return os.listdir(path) if os.path.isdir(path) else text_of(where)


def unknown_names(text, code):
    """`namespace::name`, or `Class::name`, of which the code has no such name."""
    for match in re.finditer(r"`(?:\w+::)+(\w+)", text):
        if not re.search(rf"\b{match[1]}\b", code):
            yield text.count("\n", 0, match.start()) + 1, match[0][1:]


def quotes_that_differ(path, text, text_at):
    for match in re.finditer(r"^<!-- (\S+\.\w+) -->\n```\w*\n(.*?)^```$", text, flags=re.S | re.M):
        if match[2] != text_at(match[1]):
            yield f"{path}:{text.count(chr(10), 0, match.start()) + 1}: what is quoted is not {match[1]}"


class Links(unittest.TestCase):
    def test_repository(self):
        found = [fault for path in files(".md") for fault in faults_of(path, text_of(path), in_repository, text_or_names)]
        # What docs/evidence/paper.md is made of: its links are those of that page.
        found += faults_of("docs/evidence/paper.md.in", text_of("bench/paper/paper.md.in"), in_repository, text_or_names)
        if found:
            self.fail("\n" + "\n".join(found))

    def test_pictures_are_shown(self):
        """Every picture and every table of figures in docs/ is on a page, or linked from one."""
        shown = {name.rsplit("/", 1)[-1] for path in files(".md") for _, name in links_of(text_of(path))}
        data = [path for path in files(*DATA, under="docs") if not path.startswith("docs/site/")]
        self.assertGreater(len(data), 5)
        self.assertEqual([path for path in data if os.path.basename(path) not in shown], [])

    def test_quotes(self):
        found = [fault for path in files(".md") for fault in quotes_that_differ(path, text_of(path), text_of)]
        self.assertEqual(found, [])
        page, tree = "x\n<!-- a/b.c -->\n```c\nint a;\n```\n", {"a/b.c": "int a;\n", "c.c": "int b;\n"}
        self.assertEqual(list(quotes_that_differ("d.md", page, tree.__getitem__)), [])
        self.assertEqual(list(quotes_that_differ("d.md", page.replace("a/b.c", "c.c"), tree.__getitem__)),
                         ["d.md:2: what is quoted is not c.c"])

    def test_names_of_code_exist(self):
        code = "".join(text_of(path) for folder in ("adapters", "src", "include") for path in files(".hpp", ".cpp", under=folder))
        found = [f"{path}:{line}: {name}: none of adapters, src and include has such a name" for path in files(".md")
                 for line, name in unknown_names(text_of(path), code)]
        if found:
            self.fail("\n" + "\n".join(found))
        self.assertEqual(list(unknown_names("see\n`fast::find_it` and `Grid::step`", "void step();")), [(2, "fast::find_it")])

    def test_each_fault_is_noticed(self):
        tree = {"docs/a.md": "# One thing\n## One, two `x`\n", "docs/b.md": "", "src/base/lists.hpp": "",
                "src/base": ["lists.hpp"]}

        def faults(text):
            return "\n".join(faults_of("docs/b.md", text, tree.__contains__, tree.__getitem__))

        for sound in ["[a](a.md)", "[a](a.md#one-two-x)", "![a](../docs/a.md)", "`[a](no.md)`", "```\n[a](no.md)\n```",
                      "[a](https://example.org/x.md)", "see `src/base/lists.hpp`", "see src/base/lists.*"]:
            with self.subTest(text=sound):
                self.assertEqual(faults(sound), "")
        for text, words in [("[a](no.md)", "there is no docs/no.md"), ("x\n[a](a.md#two)", "docs/b.md:2: a.md#two: docs/a.md"),
                            ("[a](#two)", "has no such heading"), ("[a](../../x.md)", "leads out"),
                            ("`src/lists.hpp`", "src/lists.hpp: there is no"), ("src/base/trees.*", "there is no such file")]:
            with self.subTest(text=text):
                self.assertIn(words, faults(text))


if __name__ == "__main__":
    unittest.main()
