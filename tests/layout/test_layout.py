"""The folders of src/ are the data flow: an include goes down the list below or stays in its folder, never up."""

import os
import re
import tempfile
import unittest

from repository import ROOT, files, text_of

# Low to high. Folders of one level do not include each other.
LEVELS = [
    ["base"],
    ["exact"],
    ["mesh"],
    ["reference", "fast", "depth"],
    ["query", "shape"],
    ["cell_size"],
    ["surface"],
    ["grid"],
    ["api"],
]
# Edges allowed inside one level: none.
SIDEWAYS = set()
# Libraries of their own, over the public headers, each with the core's folders that it may include.
BESIDE = {"io": {"base", "exact"}, "sim": {"base"}, "dist": {"base", "exact"}, "mpi": {"base"},
          "gpu": {"base", "exact", "mesh"}}

TOP_OF_SRC = {"CMakeLists.txt", "README.md", "vox.map"}
MOST_LINES_OF_README = 80
MOST_HEADERS_OF_MESH = 13
# A line that clang-format cannot break may be longer than it wants; not here.
MOST_COLUMNS = 110

EIGEN = "src/base/eigen.hpp"

LEVEL = {folder: number for number, level in enumerate(LEVELS) for folder in level}
INCLUDE = re.compile(r'^\s*#\s*(?:include|define\s+VOX_SOURCE)\s+"([^"]+)"', re.M)


def allowed(folder, other):
    if folder == other or (folder, other) in SIDEWAYS:
        return True
    if folder in BESIDE:
        return other in BESIDE[folder]
    return other in LEVEL and LEVEL[other] < LEVEL[folder]


def includes(path, root):
    """(line, included name) of the project's headers in a file."""
    text = text_of(path, root)
    return [(text.count("\n", 0, match.start(1)) + 1, match[1]) for match in INCLUDE.finditer(text)]


def reached(header, root):
    """All project headers that a header includes, directly or not."""
    seen, waiting = set(), [header]
    while waiting:
        path = waiting.pop()
        if not os.path.exists(os.path.join(root, "src", path)):
            continue
        for _, name in includes("src/" + path, root):
            if name not in seen:
                seen.add(name)
                waiting.append(name)
    return seen - {header}


def faults(root):
    """Everything that is wrong with the layout under `root`, a line each."""
    found = []
    for name in sorted(os.listdir(os.path.join(root, "src"))):
        if os.path.isdir(os.path.join(root, "src", name)):
            if name not in LEVEL and name not in BESIDE:
                found.append(f"src/{name}/: a folder that tests/layout/test_layout.py does not list")
        elif name not in TOP_OF_SRC:
            found.append(f"src/{name}: only {', '.join(sorted(TOP_OF_SRC))} are at the top of src/")
    for path in files(".cpp", ".cu", ".hpp", ".h", ".c", under="src", root=root):
        if path.count("/") < 2:
            continue
        text = text_of(path, root).splitlines()
        found += [f"{path}:{number}: {len(line)} columns, at most {MOST_COLUMNS} are allowed"
                  for number, line in enumerate(text, 1) if len(line) > MOST_COLUMNS]
        folder = path.split("/")[1]
        for line, name in includes(path, root):
            place = f'{path}:{line}: "{name}"'
            if name.startswith(("../", "./")) or "/" not in name:
                found.append(f"{place}: name the file from src/, e.g. \"base/error.hpp\"")
            elif not os.path.exists(os.path.join(root, "src", name)):
                found.append(f"{place}: there is no such file in src/")
            elif not allowed(folder, name.split("/")[0]):
                found.append(f"{place}: {folder}/ must not include {name.split('/')[0]}/")
        if path != EIGEN and "#include <Eigen/" in text_of(path, root):
            found.append(f"{path}: include Eigen by base/eigen.hpp, or bodies move by other bits")
    if os.path.exists(os.path.join(root, "src/mesh/mesh.hpp")):
        headers = reached("mesh/mesh.hpp", root)
        if len(headers) > MOST_HEADERS_OF_MESH:
            found.append(f"src/mesh/mesh.hpp reaches {len(headers)} project headers, at most {MOST_HEADERS_OF_MESH} "
                         "are allowed: " + " ".join(sorted(headers)))
    lines = text_of("src/README.md", root).count("\n")
    if lines > MOST_LINES_OF_README:
        found.append(f"src/README.md has {lines} lines, at most {MOST_LINES_OF_README} are allowed")
    return found


class Layout(unittest.TestCase):
    def test_repository(self):
        found = faults(ROOT)
        if found:
            self.fail("\n" + "\n".join(found))

    def test_folders_stand_in_the_readme_in_order(self):
        readme = text_of("src/README.md")
        rows = re.findall(r"^\| `(\w+)/` \|", readme, flags=re.M)
        listed = [folder for level in LEVELS for folder in level] + list(BESIDE)
        self.assertEqual(rows, listed)


class Faults(unittest.TestCase):
    """Each rule notices the fault that it is for, in a small tree."""

    SOUND = {
        "README.md": "# How\n",
        "CMakeLists.txt": "",
        "base/error.hpp": "#include <string>\n",
        "exact/predicates.hpp": '#include "base/error.hpp"\n',
        "mesh/mesh.hpp": '#include "exact/predicates.hpp"\n',
        "fast/engine.hpp": '#include "mesh/mesh.hpp"\n',
        "depth/stage.hpp": '#include "mesh/mesh.hpp"\n',
        "grid/grid.hpp": '#include "fast/engine.hpp"\n',
        "api/grid.cpp": '#include "grid/grid.hpp"\n#include "base/error.hpp"\n#include <vox/vox.h>\n',
        "io/formats/scan.cpp": '#include "io/formats/scan.hpp"\n#include "base/error.hpp"\n',
        "io/formats/scan.hpp": "",
    }

    def faults_of(self, **changes):
        tree = dict(self.SOUND)
        for name, text in changes.items():
            tree[name] = text
        with tempfile.TemporaryDirectory() as root:
            for name, text in tree.items():
                path = os.path.join(root, "src", name)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)
            return "\n".join(faults(root))

    def test_sound_tree(self):
        self.assertEqual(self.faults_of(), "")

    def test_each_fault_is_noticed(self):
        many = "".join(f'#include "base/h{i}.hpp"\n' for i in range(14))
        headers = {f"base/h{i}.hpp": "" for i in range(14)}
        for changes, words in [
            ({"mesh/mesh.hpp": '\n#include "fast/engine.hpp"\n'},
             'src/mesh/mesh.hpp:2: "fast/engine.hpp": mesh/ must not include fast/'),
            ({"depth/stage.hpp": '#include "fast/engine.hpp"\n'}, "depth/ must not include fast/"),
            ({"io/formats/scan.hpp": '#include "mesh/mesh.hpp"\n'}, "io/ must not include mesh/"),
            ({"sim/body.cpp": '#include "exact/predicates.hpp"\n'}, "sim/ must not include exact/"),
            ({"grid/grid.hpp": '#include "io/formats/scan.hpp"\n'}, "grid/ must not include io/"),
            ({"api/grid.cpp": '#include "../base/error.hpp"\n'}, "name the file from src/"),
            ({"api/grid.cpp": '#include "error.hpp"\n'}, "name the file from src/"),
            ({"api/grid.cpp": '#include "base/missing.hpp"\n'}, "there is no such file"),
            ({"fast/engine.hpp": '#define VOX_SOURCE "grid/grid.hpp"\n'}, "fast/ must not include grid/"),
            ({"sim/body.hpp": "#include <Eigen/Core>\n"}, "include Eigen by base/eigen.hpp"),
            ({"helpers.hpp": ""}, "src/helpers.hpp: only CMakeLists.txt"),
            ({"util/bits.hpp": ""}, "src/util/: a folder that"),
            ({"mesh/mesh.hpp": many, **headers}, "reaches 14 project headers"),
            ({"README.md": "line\n" * 81}, "has 81 lines"),
            ({"mesh/mesh.hpp": "//\n" + "/" * 111}, "src/mesh/mesh.hpp:2: 111 columns"),
        ]:
            with self.subTest(words=words):
                self.assertIn(words, self.faults_of(**changes))


if __name__ == "__main__":
    unittest.main()
