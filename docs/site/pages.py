"""The repository's Markdown as pages of the site. Every page keeps its path, and so do the files that pages link to: a
text file becomes a page that shows it, a folder the page of its README or a list, a C header its reference. In the
pages themselves

  [examples/x.c](../examples/x.c)   alone in a paragraph, the name as its text: the program itself, read from the file;
  <!-- prints x --> ```text ...     what that program prints (test_outputs.py compares);
  [cell-size.md](cell-size.md)      the title of that page, as the text of the link;
  `vox_grid_step`                   a link into the reference, also inside longer code of one word;
  <details><summary>...             one after the other: tabs;
  <!-- playground: WORDS -->        a link to the playground, where it was built;
  <!-- live: NAME -->               a live figure of live/figures.js; readers without scripts see the picture after it.

Python with the standard library only."""

import os
import posixpath
import re

import github_slugs

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))

# Beginnings: everything that they link to, and so on, is on the site.
FIRST = ["docs/README.md", "README.md", "CHANGELOG.md", "tests/README.md", "scenes/README.md", "examples/README.md"]
PICTURES = (".svg", ".webp", ".csv")
MOST_SHOWN = 100000  # bytes of a description for programs; a longer one is a file to download
MOST_NUMBERED = 500  # lines: numbers beside the lines of longer files would make their pages slow
LANGUAGES = {
    ".c": "c",
    ".h": "c",
    ".cpp": "cpp",
    ".hpp": "cpp",
    ".py": "python",
    ".js": "js",
    ".mjs": "js",
    ".rs": "rust",
    ".cs": "csharp",
    ".sh": "sh",
    ".json": "json",
    ".cmake": "cmake",
    ".yml": "yaml",
    ".dot": "dot",
}
# Pages that lie elsewhere on the site. The README is not the first page there: docs/site/home.md is.
PLACES = {"docs/site/home.md": "index.md", "README.md": "overview.md"}
REFERENCE = {
    f"include/vox/{name}.h": f"reference/{name}/README.md" for name in ("vox", "vox_query", "vox_cell_size", "vox_surface", "vox_io", "vox_sim")
}

LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\])\(([^()\s]+)\)")
FENCE = re.compile(r"^( *)(```+|~~~+)")


def language_of(path):
    if os.path.basename(path) == "CMakeLists.txt":
        return "cmake"
    return LANGUAGES.get(os.path.splitext(path)[1], "text")


def fenced(text, language, options=""):
    """A block of code, whatever it contains."""
    longest = max((len(run) for run in re.findall(r"^ *(`{3,})", text, flags=re.M)), default=2)
    fence = "`" * (longest + 1)
    return f"{fence}{{ .{language} {options}}}\n{text.rstrip()}\n{fence}"


def outside_code(text, change):
    """`text` with change(part) for each part outside of fenced blocks. Indented blocks are left alone, too."""
    out, part, fence = [], [], None

    def flush():
        if part:
            out.append(change("\n".join(part)))
            part.clear()

    for line in text.split("\n"):
        match = FENCE.match(line)
        if fence:
            out.append(line)
            if match and match[2].startswith(fence) and line.strip() == match[2]:
                fence = None
        elif match:
            flush()
            fence = match[2]
            out.append(line)
        elif line.startswith("    "):
            flush()
            out.append(line)
        else:
            part.append(line)
    flush()
    return "\n".join(out)


def without_remarks(text):
    """Remarks to the scripts that write parts of a page, <!-- bench/fast -->, are for the source alone, and so is what stands
    between <!-- repository --> and <!-- /repository -->."""
    text = re.sub(r"(?<!`)<!-- repository -->.*?<!-- /repository -->", "", text, flags=re.S)
    return outside_code(
        text, lambda part: re.sub(r"(?<!`)<!--(?! (?:live|prints|playground)[: ]).*?-->", "", part, flags=re.S)
    )


def items_indented(text):
    """Paragraphs of a list's item that are indented by two blanks, as GitHub takes them, get the four that Python's
    Markdown wants."""
    lines, in_item = [], False
    for line in text.split("\n"):
        if re.match(r"(?:[*-]|\d+\.) ", line):
            in_item = True
        elif line and not line.startswith(" "):
            in_item = False
        elif in_item and re.match(r" {2,3}\S", line) and lines and not lines[-1].strip():
            line = "    " + line.lstrip()
        lines.append(line)
    return "\n".join(lines)


def bars_in_tables(line):
    """In a row of a table GitHub wants a bar in code escaped; Python's Markdown shows the backslash."""
    return re.sub(r"`[^`]+`", lambda m: m[0].replace("\\|", "|"), line) if line.startswith("|") else line


def tabs(text):
    """<details> that follow each other become tabs."""
    one = r"<details[^>]*><summary><b>([^<]+)</b></summary>\n(.*?)\n</details>\n?"

    def tab(match):
        body = "\n".join("    " + line if line else line for line in match[2].strip("\n").split("\n"))
        return f'=== "{match[1]}"\n\n{body}\n\n'

    return re.sub(one, tab, text, flags=re.S)


class Pages:
    """`names` says where the reference describes a name: {name: (page, anchor)}."""

    def __init__(self, names, root=ROOT, playground=False):
        self.names, self.root, self.playground = names, root, playground
        self.texts = {}  # path of a page on the site: its Markdown
        self.files = set()  # paths that are copied as they are
        self.faults = []

    def exists(self, path):
        return os.path.exists(os.path.join(self.root, path))

    def read(self, path):
        with open(os.path.join(self.root, path), encoding="utf-8") as file:
            return file.read()

    # ---- what a path of the repository is on the site ----

    def place_of(self, target):
        """The path on the site of a file or folder, which comes along."""
        if os.path.isdir(os.path.join(self.root, target)):
            readme = posixpath.join(target, "README.md")
            if self.exists(readme):
                return self.place_of(readme)
            return self.add(posixpath.join(target, "index.md"), lambda: self.list_of(target))
        if target in REFERENCE:
            return REFERENCE[target]
        if target.endswith(".md"):
            place = PLACES.get(target, target)
            return self.add(place, lambda: self.page(target, self.read(target), place))
        if (
            target.endswith(PICTURES)
            or os.path.getsize(os.path.join(self.root, target)) > MOST_SHOWN
            and target.endswith(".json")
        ):
            self.files.add(target)
            return target
        return self.add(target.lstrip(".") + ".md", lambda: self.source(target))  # MkDocs passes over .github

    def add(self, place, make):
        if place not in self.texts:
            self.texts[place] = ""  # pages link to each other in circles
            self.texts[place] = make()
        return place

    def source(self, path):
        text = self.read(path)
        numbers = 'linenums="1" ' if text.count("\n") < MOST_NUMBERED else ""
        searched = "" if path.startswith("examples/") else "search:\n  exclude: true\n"
        return (
            f"---\ntitle: {posixpath.basename(path)}\nhide: [toc]\n{searched}---\n\n# {posixpath.basename(path)}\n\n`{path}`\n\n"
            + fenced(text, language_of(path), numbers)
            + "\n"
        )

    def list_of(self, folder):
        names = sorted(n for n in os.listdir(os.path.join(self.root, folder)) if not n.startswith((".", "__")))
        rows = [
            f"* [{name}]({self.link(posixpath.join(folder, 'index.md'), posixpath.join(folder, name))})"
            for name in names
            if "." in name
        ]
        return f"---\ntitle: {folder}\nsearch:\n  exclude: true\n---\n\n# {folder}\n\n" + "\n".join(rows) + "\n"

    def link(self, page, target, anchor=""):
        """From a page of the site to what a path of the repository is there."""
        return self.link_to(page, self.place_of(target), anchor)

    @staticmethod
    def link_to(page, place, anchor=""):
        path = posixpath.relpath(place, posixpath.dirname(page) or ".")
        return path + ("#" + anchor if anchor else "")

    def title_of(self, path, anchor=""):
        """What a link says that has a file's name as its text: the title of the page, or of the part of it."""
        headings = re.findall(r"^#+ +(.+?) *$", self.read(path), flags=re.M)
        for heading in headings:
            if not anchor or github_slugs.slug(heading, "-") == anchor:
                return re.sub(r"[\[\]]", "", heading)
        return path

    # ---- Markdown ----

    def page(self, path, text, at):
        """The page of the site, to lie at `at`, for the Markdown file `path`."""
        text = tabs(items_indented(without_remarks(text)))
        text = self.with_programs(path, text)
        text = self.with_figures(text)
        text = outside_code(text, lambda part: self.with_links(path, at, part))
        invitation = rf"[\1]({self.link_to(at, 'playground.md')})" if self.playground else ""
        return outside_code(text, lambda part: re.sub(r"^<!-- playground: (.+?) -->", invitation, part, flags=re.M))

    def with_programs(self, path, text):
        def program(match):
            target = posixpath.normpath(posixpath.join(posixpath.dirname(path), match[2]))
            if match[1] != target or not self.exists(target) or language_of(target) == "text":
                return match[0]
            shown = fenced(self.read(target), language_of(target), f'title="{target}" ')
            return f"\n{shown}\n"

        text = re.sub(r"(?<=\n)\n\[`?([^\]`]+)`?\]\(([^)\s]+)\)(?=\n\n|\n?\Z)", program, text)
        return re.sub(r"<!-- prints [^\n]+ -->\n```text", '```{ .text title="prints" }', text)

    @staticmethod
    def with_figures(text):
        """The picture that follows is what a reader without scripts sees."""
        return re.sub(
            r"^<!-- live: (\w+) -->\n(!\[[^\]]*\]\([^)]+\))?",
            lambda m: f'<div class="vox-live" data-figure="{m[1]}" markdown="1">\n\n{m[2] or ""}\n\n</div>',
            text,
            flags=re.M,
        )

    def with_links(self, path, at, part):
        part = self.moved_links(path, at, part)
        lines = [
            line if line.startswith("#") else self.with_names(at, bars_in_tables(line)) for line in part.split("\n")
        ]
        return "\n".join(lines)

    def moved_links(self, path, at, part):
        def moved(match):
            label, target = match[1], match[2]
            label = label[:1] + LINK.sub(moved, label[1:])  # a picture that is a link
            if re.match(r"[a-z]+:", target) or target.startswith("#"):
                return match[0]
            name, _, anchor = target.partition("#")
            where = posixpath.normpath(posixpath.join(posixpath.dirname(path), name))
            if where.startswith("..") or not self.exists(where):
                self.faults.append(f"{path}: {target}: there is no {where}")
                return match[0]
            place = self.place_of(where)
            if where.endswith(".md") and where.endswith(label[1:-1].strip("`")):
                label = f"[{self.title_of(where, anchor)}]"
            return f"{label}({self.link_to(at, place, anchor)})"

        # A link's text may hold code, so links are looked for in whole lines; those inside of code are put back.
        kept = []

        def keep(match):
            kept.append(match[0])
            return f"\0{len(kept) - 1}\0"

        hidden = re.sub(r"`+[^`\n]+`+", keep, part)
        return re.sub(r"\0(\d+)\0", lambda m: kept[int(m[1])], LINK.sub(moved, hidden))

    def with_names(self, at, line):
        """`vox_grid_step` leads to its description, except inside a link."""

        def name(match):
            word = re.match(r"(?:const )?(\w+)", match[1])
            found = word and self.names.get(word[1])
            if not found or found[0] == at:
                return match[0]
            return f"[`{match[1]}`]({self.link_to(at, *found)})"

        pieces = re.split(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\]\([^()\s]+\))", line)
        return "".join(
            p if i % 2 else re.sub(r"(?<!`)`(vox_[\w.()]*|VOX_\w+)`(?!`)", name, p) for i, p in enumerate(pieces)
        )


def collect(names, first=None, root=ROOT, playground=False):
    pages = Pages(names, root, playground)
    for path in first or FIRST:
        pages.place_of(path)
    return pages
