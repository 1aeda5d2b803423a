"""How much there may be: lines of a folder, a file and a function, types of a folder. Raising a number is a line in the commit
message. And one meaning for each type name in src/, and no branch above the engines on whether there is one. The budgets of
the public headers are in tests/abi/test_header.py."""

import re
import unittest

from repository import ROOT, files, text_of

# Of C and C++ in src/, of all files elsewhere.
LINES_OF_FOLDER = {
    "src": 57640, "src/base": 3590, "src/exact": 3185, "src/shape": 1140, "src/mesh": 3895, "src/reference": 680,
    "src/fast": 5415, "src/depth": 3045, "src/query": 2280, "src/cell_size": 5470, "src/surface": 3325,
    "src/grid": 7850, "src/api": 1220, "src/io": 9715, "src/sim": 2225, "src/dist": 2460, "src/mpi": 180, "src/gpu": 2035,
    "tools": 7390, "bench": 11080,
}
LINES_OF_DATA = {"docs": 1600}  # drawings and figures of the pages
LINES_OF_FILE = 600  # of a source file in SOURCES
LINES_OF_FUNCTION = 80
LINES_OF_STEP = 50  # of vox_grid::step, which reads as a story
MEMBERS_OF_GRID = 30  # of vox_grid, data alone
TYPES_OF_FOLDER = {"src/cell_size": 42}

# What is still to be done, since 2026-11-28; nothing is to be added. A line that is no longer needed is a fault, too.
LONG_FUNCTIONS = {}
TYPES_OF_ONE_NAME = set()
ENGINE_BRANCHES = {}

SOURCES = ("src", "tools", "bench")
ENDINGS = (".cpp", ".cu", ".hpp", ".h", ".c")
ABOVE_THE_ENGINES = ("src/depth", "src/query", "src/cell_size", "src/surface", "src/grid", "src/api")

NO_CODE = re.compile(r"//[^\n]*|/\*.*?\*/|R\"\(.*?\)\"|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])'|^[ \t]*#(?:[^\n\\]|\\.)*",
                     re.S | re.M)
LABELS = re.compile(r"\s*(?:(?:public|private|protected):\s*)*")
SCOPE = re.compile(r"(?:template\s*<.*>\s*)?(?:(?:typedef|static|inline|const|constexpr) )*"
                   r"(namespace|struct|class|union|enum|extern)\b(?: class| struct)?(?: alignas\([^)]*\)| \[\[[^\]]*\]\])*"
                   r"\s*([\w:]*)[^()=]*$", re.S)
BRANCH = re.compile(r"\bif \([\w.>-]*\bengine_?\)|![\w.>-]*\bengine_?\b(?!->|\.|\()|\bengine_? (?:\?|&&|\|\||[!=]= nullptr)|"
                    r"(?:&&|\|\|) [\w.>-]*\bengine_?\b(?!->|\.|\(| [=<>])")


def code_of(text):
    """The text with everything blank that is no code, so that lines keep their numbers."""
    return NO_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def definitions(code):
    """(kind, name, first line, last line, scopes around it) of each function and scope, from code that clang-format laid out:
    a body's brace follows a space, an initializer's does not, or follows a '='. Lambdas belong to their function."""
    scopes, begin, depth, is_body = [], 0, 0, False
    for brace in re.finditer(r"[{};]", code):
        if depth:
            depth += {"{": 1, "}": -1}.get(brace[0], 0)
            if not depth and is_body:
                name = re.search(r"([\w:~]+)\(", code[first:])
                yield "function", name[1], line_of(code, first), line_of(code, brace.start()), scopes
                begin = brace.end()
        elif brace[0] == "{":
            first = LABELS.match(code, begin).end()
            words = code[first:brace.start()].strip()
            scope = SCOPE.match(words)
            if scope:
                scopes.append((scope[1], scope[2], first))
                begin = brace.end()
            else:
                depth = 1
                is_body = "(" in words and not words.endswith("=") and code[brace.start() - 1].isspace()
        else:
            begin = brace.end()
            if brace[0] == "}":
                kind, name, first = scopes.pop()
                yield kind, name, line_of(code, first), line_of(code, brace.start()), scopes
    assert not scopes and not depth, "braces that do not match"


def line_of(code, place):
    return code.count("\n", 0, place) + 1


def lines_of_function(text, name):
    return [last - first + 1 for kind, found, first, last, _ in definitions(code_of(text)) if kind == "function" and found == name]


def data_members(text, name):
    """How many data members a struct declares, from code as above."""
    code = code_of(text)
    body, depth = "", 1
    for char in code[re.search(rf"\bstruct {name} {{", code).end():]:
        depth += {"{": 1, "}": -1}.get(char, 0)
        if not depth:
            break
        if depth == 1:
            body += ";" if char == "}" else char
    body = re.sub(r"\b(?:public|private|protected):|\[[^\]]*\]", "", body)
    while "<" in body:
        body, before = re.sub(r"<[^<>]*>", "", body), body
        assert body != before
    return sum(1 + statement.count(",") for statement in map(str.strip, body.split(";"))
               if statement and "(" not in statement and not re.match(r"(?:friend|using|static|struct|class|enum)\b", statement))


def count_lines(names):
    count = 0
    for name in names:
        with open(f"{ROOT}/{name}", "rb") as file:
            count += file.read().count(b"\n")
    return count


class Code:
    """What the rules want to know of some sources, a {path: text}."""

    def __init__(self, texts):
        self.types, self.places, self.long_functions, self.branches = {}, {}, {}, {}
        for path, text in texts.items():
            code = code_of(text)
            if path.startswith(ABOVE_THE_ENGINES):
                self.branches[path] = [line_of(code, match.start()) for match in BRANCH.finditer(code)]
            for kind, name, first, last, around in definitions(code):
                if kind == "function" and last - first >= LINES_OF_FUNCTION:
                    self.long_functions.setdefault(path, []).append(name)
                elif kind in ("struct", "class", "union", "enum"):
                    folder = "/".join(path.split("/")[:2])
                    self.types[folder] = self.types.get(folder, 0) + 1
                    if path.startswith("src/") and name and not any(scope[:2] == ("namespace", "") for scope in around):
                        nested = [scope[1] for scope in around if scope[0] != "namespace"]
                        self.places.setdefault("::".join([*nested, name]), set()).add(path)  # #if may have two in one file
        self.of_one_name = {name: sorted(paths) for name, paths in self.places.items() if len(paths) > 1}


class Budgets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.code = Code({path: text_of(path) for under in SOURCES for path in files(*ENDINGS, under=under)})

    def test_lines_of_folders(self):
        counts = {folder: count_lines(files(*(ENDINGS if folder.startswith("src") else [""]), under=folder))
                  for folder in LINES_OF_FOLDER}
        counts |= {folder: count_lines(files(".svg", ".csv", under=folder)) for folder in LINES_OF_DATA}
        budgets = LINES_OF_FOLDER | LINES_OF_DATA
        self.assertEqual({folder: f"{n} of {budgets[folder]}" for folder, n in counts.items() if n > budgets[folder]}, {})

    def test_lines_of_files(self):
        counts = {path: count_lines([path]) for under in SOURCES for path in files(*ENDINGS, ".py", ".mjs", under=under)}
        self.assertEqual({path: n for path, n in counts.items() if n > LINES_OF_FILE}, {})

    def test_lines_of_functions(self):
        counts = {path: len(names) for path, names in self.code.long_functions.items()}
        self.assertEqual(counts, LONG_FUNCTIONS, self.code.long_functions)

    def test_grid(self):
        self.assertLessEqual(data_members(text_of("src/grid/grid.hpp"), "vox_grid"), MEMBERS_OF_GRID)
        lines, = lines_of_function(text_of("src/grid/step.cpp"), "vox_grid::step")
        self.assertLessEqual(lines, LINES_OF_STEP)

    def test_types(self):
        for folder, most in TYPES_OF_FOLDER.items():
            self.assertLessEqual(self.code.types[folder], most, folder)

    def test_one_name_one_meaning(self):
        self.assertEqual(set(self.code.of_one_name), TYPES_OF_ONE_NAME, self.code.of_one_name)

    def test_no_branch_on_an_engine(self):
        self.assertEqual({path: len(lines) for path, lines in self.code.branches.items() if lines}, ENGINE_BRANCHES)


class Faults(unittest.TestCase):
    def test_grid(self):
        text = "struct G {\npublic:\n    G() {}\n    void f(int a, int b);\n    G& operator=(const G&) = delete;\nprivate:\n    friend class H;\n" \
               "    int a_ = 0, b_{};\n    pair<int, set<int>> c_; // d_;\n    int list_[size(x) + 1];\n    struct I {\n        int e_;\n    };\n"
        self.assertEqual(data_members(text + "};\n", "G"), 4)
        self.assertEqual(data_members(text + "    bool more_ = false;\n};\n", "G"), 5)
        self.assertEqual(lines_of_function("void G::f() {\n    if (x) {\n    }\n}\nvoid G::g() {\n}\n", "G::f"), [4])

    def test_long_function(self):
        body = "    x += 1; // {\n" * (LINES_OF_FUNCTION - 2)
        text = "namespace a {\nstruct B {\n    int c{1};\n    B() : c{2} {\n" + body + "    }\n};\n} // namespace a\n"
        self.assertEqual(Code({"src/a/b.cpp": text}).long_functions, {})
        self.assertEqual(Code({"src/a/b.cpp": text.replace("    }", "\n    }")}).long_functions, {"src/a/b.cpp": ["B"]})

    def test_types(self):
        code = Code({"src/a/a.hpp": "struct A {\n    struct N {};\n};\nnamespace {\nclass C {};\n}\n",
                     "src/a/b.hpp": "namespace b {\ntemplate <class T> class A final : T {};\nstruct B {\n    struct N {};\n};\nclass C {};\n}\n"})
        self.assertEqual(code.of_one_name, {"A": ["src/a/a.hpp", "src/a/b.hpp"]})
        self.assertEqual(code.types, {"src/a": 7})

    def test_branches(self):
        for text in ["if (scene.engine)", "if (!s->engine_)", "x = engine ? 1 : 2", "if (a && scene.engine)", "engine != nullptr"]:
            self.assertEqual(Code({"src/grid/a.cpp": text + " // engine ?"}).branches, {"src/grid/a.cpp": [1]}, text)
        for text in ["if (!engine.moved(b))", "if (!engine->moved(b))", "if (a && engine == 2)", "f(engine)", "// if (engine)"]:
            self.assertEqual(Code({"src/grid/a.cpp": text}).branches, {"src/grid/a.cpp": []}, text)


if __name__ == "__main__":
    unittest.main()
