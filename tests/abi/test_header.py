"""What the public headers promise in their comments, and the rules of their C: each function says, or its header's
conventions say, who owns what, how long it lives, on which threads it may run and how it fails. What comments and pages name
exists."""

import os
import re
import sys
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.append(os.path.join(ROOT, "bindings", "generator"))
import header  # noqa: E402
sys.path.append(os.path.join(ROOT, "tests", "layout"))
import plain_words  # noqa: E402
INCLUDE = os.path.join(ROOT, "include", "vox")
HEADERS = ["vox.h", "vox_query.h", "vox_cell_size.h", "vox_surface.h", "vox_io.h", "vox_sim.h", "vox_dist.h"]

# Functions, structs and fields of each header, which are not to grow unseen: a new function has two users outside of tests.
BUDGETS = {"vox.h": (51, 21, 141), "vox_query.h": (14, 8, 52), "vox_cell_size.h": (9, 14, 111), "vox_surface.h": (13, 12, 61),
           "vox_io.h": (19, 9, 82), "vox_sim.h": (11, 8, 79), "vox_dist.h": (13, 7, 36)}
LIBRARIES = {name[:-2] for name in BUDGETS} | {"vox_mpi", "vox_gpu", "vox_cuda", "vox_gpu_host"}

# Everything that a foreign-function interface can carry.
NUMBERS = {"uint8_t", "int32_t", "uint32_t", "int64_t", "uint64_t", "size_t", "float", "double", "char", "void"}

# What the conventions of vox.h must tell, for all the headers: what functions need not repeat.
CONVENTIONS = {
    "Errors": ["vox_result", "vox_last_error", "INVALID_ARGUMENT for a null pointer", "INVALID_HANDLE"],
    "Structs": ["struct_size", "vox_default_X", "before the call"],
    "Ownership": ["borrows", "copied", "lives"],
    "Threads": ["One thread at a time may change a grid", "any number of threads may read", "take a const grid", "per thread"],
    "Units": ["caller's unit"],
}

# Functions with such a verb change what they are called for; no other does.
CHANGES = re.compile(r"_(append|bind|clear|destroy|insert|map|mark|prepare|release|remove|replace|reserve|retain|"
                     r"set|step|take|update)(_|$)|^vox_grid_find_")


def base(type_text):
    """The type without const, pointers and array bounds."""
    return re.sub(r"\bconst\b|\*|\[\w+\]", " ", type_text).strip()


def pointers(type_text):
    return type_text.count("*")


class Rules:
    """The faults of one header, as lines of text."""

    def __init__(self, text, others=()):
        self.header = header.parse(text)
        headers = (self.header, *others)
        self.types = {d.name: d for h in headers for d in h.declarations
                      if d.kind in ("struct", "enum", "opaque", "callback", "alias")}
        self.names = {name for h in headers for name in names_in(h)}
        # INVALID_ARGUMENT, SURFACE: enumerators and constants without what they begin with.
        self.ends = {name.split("_", n)[-1] for name in self.names if name.startswith("VOX_") for n in range(1, 6)}
        self.errors = {name[len("VOX_ERROR_"):] for name in self.names if name.startswith("VOX_ERROR_")}
        self.faults = []

    def fault(self, declaration, words):
        self.faults.append(f"line {declaration.line}: {declaration.name}: {words}")

    def check(self):
        for name, comment in self.header.constants.items():
            if not comment:
                self.faults.append(f"{name}: no comment")
        for section, comment in [("conventions", header.words_of(self.header.conventions)), *self.header.sections.items()]:
            self.faults += [f"{section}: {words}" for words in self.unknown_names(comment)]
        for declaration in self.header.declarations:
            for words in self.unknown_names(declaration.comment + " " + declaration.inside):
                self.fault(declaration, words)
            if declaration.kind in ("function", "callback"):
                self.check_types(declaration)
            if declaration.kind == "function":
                self.check_function(declaration)
            elif declaration.kind == "struct":
                self.check_struct(declaration)
            elif declaration.kind == "callback" and not re.search(r"thread|at the same time", declaration.comment):
                self.fault(declaration, "on which thread is it called?")
            if declaration.kind in ("struct", "enum", "opaque", "alias", "callback") and not declaration.comment:
                if not declaration.inside:
                    self.fault(declaration, "no comment")
        return self.faults

    def unknown_names(self, comment):
        """What a comment names and no header declares; codes that are none, after the word Errors."""
        for name in re.findall(r"\b(?:vox|VOX)_\w+", comment):
            # `vox_` and a library's own name, and the patterns of the conventions, are no names.
            if name not in self.names and name not in LIBRARIES | {"vox_default_X", "vox_X_get_Y", "vox_X_set_Y"}:
                yield f"there is no {name}"
        for name, field in re.findall(r"\b(vox_\w+)\.([a-z]\w*)", comment):
            struct = self.types.get(name)
            if struct and struct.kind == "struct" and field not in (n for _, n in struct.fields):
                yield f"{name} has no {field}"
        for errors in re.findall(r"Errors(.*)", comment):
            for code in re.findall(r"\b[A-Z][A-Z_]{4,}\b", errors):
                if not code.startswith("VOX_") and code not in self.ends:
                    yield f"there is no error {code}"

    # ---- comments ----

    def check_function(self, f):
        comment = f.comment
        if not comment:
            self.fault(f, "no comment right above it")
            return
        if not re.search(r"[.)]$", comment):
            self.fault(f, "its comment does not end as a sentence")
        if f.parameters:
            type_text = f.parameters[0][0]
            object_type = self.types.get(base(type_text))
            if object_type and object_type.kind == "opaque" and pointers(type_text) == 1:
                # What one thread at a time may use, even to read, may keep its answers in itself.
                noun = object_type.name.rsplit("_", 1)[-1]
                one_thread = re.search(rf"One thread at a time may use [^.]*\b{noun}\b", header.words_of(self.header.conventions))
                answers = one_thread and not type_text.startswith("const")
                if bool(CHANGES.search(f.name)) == type_text.startswith("const") and not answers:
                    self.fault(f, f"takes {type_text}, which says that it {'reads' if 'const' in type_text else 'changes'}")
        if f.result == "vox_result":
            of_all = re.search(r"Errors of all .*", header.words_of(self.header.conventions))
            told = comment + f.inherited + self.header.sections.get(f.section, "") + (of_all[0] if of_all else "")
            if self.may_fail_in_its_own_way(f):
                if not re.search(r"\berrors?\b|cannot fail", told, flags=re.I):
                    self.fault(f, "which errors?")
                elif not any(error in told for error in self.errors) and not re.search(r"vox_\w+|cannot fail", told):
                    self.fault(f, "which errors, by name?")
        elif not re.search(r"[Cc]annot fail|[Nn]ever null|Null does nothing|gives 0|returns `result`", comment):
            self.fault(f, "it gives no vox_result, and does not say that it cannot fail")
        if self.hands_out_memory(f) and not self.says(f, r"\blives?\b|\bvalid\b|static text|\buntil\b"):
            self.fault(f, "how long does what it hands out live?")
        for type_text, name in f.parameters:
            opaque = self.types.get(base(type_text))
            if pointers(type_text) == 2 and opaque and opaque.kind == "opaque":
                if not re.search(r"\bowns?\b|_destroy", comment + self.header.conventions + opaque.comment):
                    self.fault(f, f"who owns *{name}?")

    def may_fail_in_its_own_way(self, f):
        """Beyond null pointers, ids and struct_size, which the conventions cover."""
        for type_text, name in f.parameters:
            kind = self.types.get(base(type_text))
            if name.startswith("out") or name == "struct_size" or base(type_text) == "vox_body":
                continue
            if not (kind and kind.kind == "opaque"):
                return True
        return False

    def hands_out_memory(self, f):
        if pointers(f.result):
            return True
        for type_text, name in f.parameters:
            struct = self.types.get(base(type_text))
            is_out = name.startswith("out") and "const" not in type_text
            if is_out and pointers(type_text) == 2 and not (struct and struct.kind == "opaque"):
                return True
            if is_out and struct and struct.kind == "struct" and any(pointers(t) for t, _ in struct.fields):
                return True
        return False

    def says(self, f, pattern):
        """In the function's comment, in those of the types that it fills, or for all lists of the header."""
        texts = [f.comment + f.inherited, *re.findall(r"Lifetime .*", header.words_of(self.header.conventions)),
                 *(self.types[base(t)].comment for t, _ in f.parameters if base(t) in self.types)]
        return any(re.search(pattern, text, flags=re.I) for text in texts)

    # ---- C ----

    def check_types(self, f):
        for type_text, name in [(f.result, "result"), *f.parameters]:
            kind = self.types.get(base(type_text))
            if not kind and base(type_text) not in NUMBERS:
                self.fault(f, f"{name} has type {type_text}, which not every language can pass")
            if kind and kind.kind in ("struct", "opaque") and pointers(type_text) == 0:
                self.fault(f, f"{name} is a struct by value")
        names = [n for _, n in f.parameters]
        outs = [i for i, n in enumerate(names) if n.startswith("out")]
        if outs and outs != list(range(outs[0], len(names))):
            self.fault(f, "an out-parameter is not last")

    def check_struct(self, s):
        names = [n for _, n in s.fields]
        if "struct_size" in names and s.fields[0] != ("uint32_t", "struct_size"):
            self.fault(s, "struct_size is not its first field")
        if s.name.endswith("_desc"):
            if names[0] != "struct_size":
                self.fault(s, "a desc that cannot grow")
            default = s.name.replace("vox_", "vox_default_", 1)
            if default not in {d.name for d in self.header.declarations}:
                self.fault(s, f"there is no {default}")
        if any("(*)" in t for t, _ in s.fields) and "thread" not in s.comment + s.inside:
            self.fault(s, "on which thread are its functions called?")
        for type_text, name in s.fields:
            kind = self.types.get(base(type_text))
            if "(*)" not in type_text and not kind and base(type_text) not in NUMBERS:
                self.fault(s, f"{name} has type {type_text}")


def names_in(parsed):
    """Whatever a comment may name."""
    for d in parsed.declarations:
        yield d.name
        if d.kind == "enum":
            yield from d.fields
    yield from parsed.constants
    yield from ("VOX_API", "VOX_EXPERIMENTAL", "VOX_OPTIONAL", "VOX_VERSION_MAJOR", "VOX_VERSION_MINOR", "VOX_VERSION_PATCH")


def text_of(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


TEXTS = {name: text_of("include", "vox", name) for name in HEADERS}
CORE = header.parse(TEXTS["vox.h"])
ALL = [header.parse(text) for text in TEXTS.values()]
NAMES = {name for parsed in ALL for name in names_in(parsed)}


def number_of(constant):
    text = "".join(TEXTS.values())
    return int(re.search(rf"#define {constant} \(?(-?\w+?)u?\)?(\s|$)", text)[1], 0)


class Headers(unittest.TestCase):
    def test_every_rule_holds(self):
        for name in HEADERS:
            faults = Rules(TEXTS[name], ALL).check()
            self.assertEqual(faults, [], f"{name}:\n" + "\n".join(faults))

    def test_conventions(self):
        for topic, phrases in CONVENTIONS.items():
            part = re.search(rf"^ \*   {topic} (.*?)(?=^ \*   \w|\*/)", CORE.conventions, flags=re.S | re.M)
            self.assertIsNotNone(part, f"vox.h's conventions say nothing of {topic}")
            words = " ".join(part[1].replace("\n *", " ").split())
            for phrase in phrases:
                self.assertIn(phrase, words, topic)
        for name in HEADERS[1:]:
            self.assertRegex(header.words_of(header.parse(TEXTS[name]).conventions), r"onventions\b.*vox\.h")
            self.assertRegex(header.parse(TEXTS[name]).conventions, r"\n \*\s+Threads[ :]")

    def test_every_section_has_an_example(self):
        for section in CORE.sections: # "pairs: which bodies touch" has pairs.c
            name = re.sub(r"\W+", "_", section.split(":")[0]) + ".c"
            folders = os.listdir(os.path.join(ROOT, "examples"))
            self.assertTrue(any(os.path.exists(os.path.join(ROOT, "examples", folder, name)) for folder in folders),
                            f"examples/*/{name}")

    def test_plain_english(self):
        for name in HEADERS:
            found = [f"line {line}: \"{phrase}\": say \"{say}\"" for line, phrase, say in plain_words.found_in(TEXTS[name])]
            self.assertEqual(found, [], f"{name}:\n" + "\n".join(found))


class Pages(unittest.TestCase):
    """docs/limits.md and docs/abi.md say what is so."""

    def test_names_exist(self):
        for page in ("limits.md", "abi.md"):
            for name in re.findall(r"\b(?:vox|VOX)_\w+", text_of("docs", page)):
                self.assertTrue(name in NAMES or name in LIBRARIES, f"docs/{page}: {name}")

    def test_every_old_name_has_a_new_one(self):
        old = set(text_of("tests", "abi", "old_names.txt").split())
        rows = dict(re.findall(r"^\| `(vox_\w+)` \| (.+) \|$", text_of("docs", "renamed.md"), flags=re.M))
        functions = {f.name for parsed in [*ALL, header.parse(text_of("include", "vox", "vox_mpi.h"))] for f in parsed.of_kind("function")}
        self.assertEqual(set(rows), old - functions)
        for name in old - functions:
            told = set(re.findall(r"`(vox_\w+)", rows[name]))
            self.assertLessEqual(told, NAMES, name)
            self.assertTrue(told or re.match("none: |zero it", rows[name]), name)

    def test_every_limit_is_listed_with_its_number(self):
        page = text_of("docs", "limits.md")
        for parsed in ALL:
            for name in parsed.constants:
                if re.search(r"_MAX_|_CAPACITY$", name):
                    told = re.search(rf"`{name}` = ([0-9^ -]+?) *\|", page)
                    self.assertIsNotNone(told, f"docs/limits.md: {name}")
                    base_number, power, less = re.fullmatch(r"(\d+)(?:\^(\d+))?(?: - (\d+))?", told[1]).groups()
                    self.assertEqual(int(base_number) ** int(power or 1) - int(less or 0), number_of(name), name)

    def test_every_limit_has_its_test(self):
        table = text_of("docs", "limits.md").split("\n## ")[0]
        limits = [row.split(" | ")[0] for row in table.splitlines() if row.startswith("| ")][1:]
        rows = [row for row in text_of("docs", "evidence", "limits.md").splitlines() if row.startswith("| ")][1:]
        self.assertGreater(len(rows), 20)
        self.assertEqual([row.split(" | ")[0] for row in rows], limits)
        for row in rows:
            tests = re.findall(r"`(tests/[\w/.]+)`: (\w+)", row)
            self.assertTrue(tests, row)
            for path, name in tests:
                self.assertIn(f"START_TEST({name})", text_of(*path.split("/")), path)

    def test_budgets(self):
        for name, parsed in zip(HEADERS, ALL):
            structs = parsed.of_kind("struct")
            self.assertEqual((len(parsed.of_kind("function")), len(structs), sum(len(s.fields) for s in structs)), BUDGETS[name],
                             f"{name}: if it is smaller now, so is its budget")

    def test_experimental_functions_are_listed(self):
        listed = re.search(r"Experimental at present: .*?\n\n", text_of("docs", "abi.md"), flags=re.S)[0]
        experimental = {d.name for parsed in ALL for d in parsed.of_kind("function") if not d.stable}
        self.assertEqual(set(re.findall(r"`(vox_\w+)`", listed)), experimental)

    def test_version(self):
        self.assertIn(f"`VOX_ABI_VERSION` is {number_of('VOX_ABI_VERSION')}.", text_of("docs", "abi.md"))
        for name in ("libvox", "libvox_io", "libvox_sim", "libvox_dist"):
            self.assertIn(f"`{name}.so.{number_of('VOX_ABI_VERSION')}`", text_of("docs", "abi.md"))


class Faults(unittest.TestCase):
    """The rules notice what they are for: a sound header with one thing changed."""

    SOUND = """/* Conventions: those of vox.h. */

/* A number. */
#define VOX_MAX_THINGS 3u
/* A thing. */
typedef struct vox_thing vox_thing;
/* Its listener. */
typedef struct vox_thing_ear {
    void (*hear)(void* user); /* on the thread that calls */
} vox_thing_ear;
/* Called on the thread that asks. */
typedef double vox_thing_function(void* user);
/* How to make it. */
typedef struct vox_thing_desc {
    uint32_t struct_size;
    uint32_t flags;
} vox_thing_desc;
static inline vox_thing_desc vox_default_thing_desc(void) {
    vox_thing_desc desc = VOX_ZERO;
    desc.struct_size = (uint32_t)sizeof desc;
    return desc;
}
/* Lives until the next call. */
typedef struct vox_thing_view {
    const float* data;
} vox_thing_view;
/* Makes one. The caller owns *out_thing. Errors: OUT_OF_MEMORY. */
VOX_API vox_result vox_thing_create(const vox_thing_desc* desc, vox_thing** out_thing);
/* Its numbers. */
VOX_API vox_result vox_thing_get(const vox_thing* thing, vox_thing_view* out_view);
/* Its name. Never null; static text. */
VOX_API const char* vox_thing_name(const vox_thing* thing);
/* Another number; see vox_thing_get. Errors: INVALID_ARGUMENT above VOX_MAX_THINGS. */
VOX_API vox_result vox_thing_set_number(vox_thing* thing, uint32_t number);
"""

    def faults(self, old="", new=""):
        self.assertIn(old, self.SOUND)
        return "\n".join(Rules(self.SOUND.replace(old, new, 1), [CORE]).check())

    def test_each_fault_is_noticed(self):
        self.assertEqual(self.faults(), "")
        for old, new, words in [
            ("/* Its numbers. */\n", "", "vox_thing_get: no comment right above"),
            ("/* Its numbers. */\n", "/* Its numbers. */\n\n", "vox_thing_get: no comment right above"),
            ("Its numbers.", "Its numbers and", "does not end as a sentence"),
            (" Errors: OUT_OF_MEMORY.", "", "vox_thing_create: which errors?"),
            ("The caller owns *out_thing. ", "", "vox_thing_create: who owns *out_thing?"),
            ("Lives until the next call.", "Numbers.", "vox_thing_get: how long"),
            ("; static text", "", "vox_thing_name: how long"),
            ("Never null; s", "S", "does not say that it cannot fail"),
            ("uint32_t flags;", "bool flags;", "flags has type bool"),
            ("vox_thing* thing, vox_thing_view* out", "vox_thing thing, vox_thing_view* out", "struct by value"),
            ("const vox_thing* thing, vox_thing_view* out_view", "vox_thing_view* out_view, int32_t thing",
             "an out-parameter is not last"),
            ("uint32_t struct_size;\n    uint32_t flags;", "uint32_t flags;\n    uint32_t struct_size;",
             "struct_size is not its first field"),
            ("vox_default_thing_desc", "vox_default_things", "there is no vox_default_thing_desc"),
            ("/* A thing. */\n", "", "vox_thing: no comment"),
            ("/* A number. */\n", "", "VOX_MAX_THINGS: no comment"),
            ("see vox_thing_get", "see vox_thing_gets", "vox_thing_set_number: there is no vox_thing_gets"),
            ("see vox_thing_get", "see vox_thing_desc.flag", "vox_thing_set_number: vox_thing_desc has no flag"),
            ("above VOX_MAX_THINGS", "above VOX_MAX_THING", "vox_thing_set_number: there is no VOX_MAX_THING"),
            ("INVALID_ARGUMENT above", "INVALID_ARGUMENTS above", "there is no error INVALID_ARGUMENTS"),
            ("see vox_thing_get. Errors: INVALID_ARGUMENT above VOX_MAX_THINGS", "errors there are",
             "vox_thing_set_number: which errors, by name?"),
            ("vox_result vox_thing_set_number(vox_thing*", "vox_result vox_thing_set_number(const vox_thing*",
             "vox_thing_set_number: takes const vox_thing*, which says that it reads"),
            ("const char* vox_thing_name(const vox_thing*", "const char* vox_thing_name(vox_thing*",
             "vox_thing_name: takes vox_thing*, which says that it changes"),
            ("on the thread that calls", "now and then", "vox_thing_ear: on which thread"),
            ("Called on the thread that asks", "A function", "vox_thing_function: on which thread"),
        ]:
            with self.subTest(old=old, new=new):
                self.assertIn(words, self.faults(old, new))


if __name__ == "__main__":
    unittest.main()
