"""What the public headers promise in their comments, and the rules of their C: each function says, or its header's
conventions say, who owns what, how long it lives, on which threads it may run and how it fails."""

import os
import re
import unittest

import header

INCLUDE = os.path.join(os.path.dirname(__file__), "..", "..", "include", "vox")
HEADERS = ["vox.h", "vox_io.h", "vox_sim.h"]

# Everything that a foreign-function interface can carry.
NUMBERS = {"int32_t", "uint32_t", "int64_t", "uint64_t", "size_t", "float", "double", "char", "void"}

# What the conventions of vox.h must tell, for all the headers: what functions need not repeat.
CONVENTIONS = {
    "Errors": ["vox_result", "vox_last_error", "INVALID_ARGUMENT for a null pointer", "INVALID_HANDLE"],
    "Structs": ["struct_size", "vox_X_init"],
    "Ownership": ["copies", "borrowed", "live"],
    "Threads": ["One thread at a time", "any number of threads may read", "per thread"],
    "Units": ["caller's own unit"],
}


def base(type_text):
    """The type without const, pointers and array bounds."""
    return re.sub(r"\bconst\b|\*|\[\w+\]", " ", type_text).strip()


def pointers(type_text):
    return type_text.count("*")


class Rules:
    """The faults of one header, as lines of text."""

    def __init__(self, text, others=()):
        self.header = header.parse(text)
        self.types = {d.name: d for h in (self.header, *others) for d in h.declarations
                      if d.kind in ("struct", "enum", "opaque", "callback", "alias")}
        self.faults = []

    def fault(self, declaration, words):
        self.faults.append(f"line {declaration.line}: {declaration.name}: {words}")

    def check(self):
        for declaration in self.header.declarations:
            if declaration.kind in ("function", "callback"):
                self.check_types(declaration)
            if declaration.kind == "function":
                self.check_function(declaration)
            elif declaration.kind == "struct":
                self.check_struct(declaration)
            elif declaration.kind == "enum" and not declaration.fields[-1].endswith("FORCE_32_BITS"):
                self.fault(declaration, "its last enumerator does not force 32 bits")
            elif declaration.kind == "callback" and not re.search(r"[Cc]all|thread|Receives", declaration.comment):
                self.fault(declaration, "who calls it, and on which thread?")
            if declaration.kind in ("struct", "enum", "opaque", "alias", "callback") and not declaration.comment:
                if not declaration.comments_inside:
                    self.fault(declaration, "no comment")
        return self.faults

    # ---- comments ----

    def check_function(self, f):
        comment = f.comment
        if not comment:
            self.fault(f, "no comment right above it")
            return
        if not re.search(r"[.)]$", comment):
            self.fault(f, "its comment does not end as a sentence")
        if f.result == "vox_result":
            told = comment + f.inherited + self.header.sections.get(f.section, "")
            if self.may_fail_in_its_own_way(f) and not re.search(r"\berrors?\b|cannot fail", told, flags=re.I):
                self.fault(f, "which errors?")
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
            if name.startswith("out") or name == "struct_size" or base(type_text) == "vox_mesh":
                continue
            if f.name.endswith("_init") and kind and kind.kind == "struct":
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
        """In the function's comment, or in those of the types that it fills."""
        texts = [f.comment + f.inherited] + [self.types[base(t)].comment for t, _ in f.parameters if base(t) in self.types]
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
            if s.name + "_init" not in {d.name for d in self.header.declarations}:
                self.fault(s, f"there is no {s.name}_init")
        for type_text, name in s.fields:
            kind = self.types.get(base(type_text))
            if "(*)" not in type_text and not kind and base(type_text) not in NUMBERS:
                self.fault(s, f"{name} has type {type_text}")


def text_of(name):
    with open(os.path.join(INCLUDE, name), encoding="utf-8") as file:
        return file.read()


CORE = header.parse(text_of("vox.h"))


class Headers(unittest.TestCase):
    def test_every_rule_holds(self):
        for name in HEADERS:
            faults = Rules(text_of(name), [CORE]).check()
            self.assertEqual(faults, [], f"{name}:\n" + "\n".join(faults))

    def test_conventions(self):
        for topic, phrases in CONVENTIONS.items():
            part = re.search(rf"^ \*   {topic} (.*?)(?=^ \*   \w|\*/)", CORE.conventions, flags=re.S | re.M)
            self.assertIsNotNone(part, f"vox.h's conventions say nothing of {topic}")
            words = " ".join(part[1].replace("\n *", " ").split())
            for phrase in phrases:
                self.assertIn(phrase, words, topic)
        for name in HEADERS[1:]:
            self.assertRegex(header.words_of(header.parse(text_of(name)).conventions), r"onventions .*vox\.h")

    def test_every_section_has_an_example(self):
        folder = os.path.join(os.path.dirname(__file__), "..", "..", "examples")
        for section in CORE.sections:
            name = re.sub(r"\W+", "_", section) + ".c"
            self.assertTrue(os.path.exists(os.path.join(folder, name)), f"examples/{name}")


class Faults(unittest.TestCase):
    """The rules notice what they are for: a sound header with one thing changed."""

    SOUND = """/* Conventions: those of vox.h. */

/* A thing. */
typedef struct vox_thing vox_thing;
/* How to make it. */
typedef struct vox_thing_desc {
    uint32_t struct_size;
    uint32_t flags;
} vox_thing_desc;
/* Defaults. */
VOX_API vox_result vox_thing_desc_init(vox_thing_desc* desc, uint32_t struct_size);
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
            ("VOX_API vox_result vox_thing_desc_init(vox_thing_desc* desc, uint32_t struct_size);",
             "VOX_API vox_result vox_thing_wipe(vox_thing_desc* out);", "there is no vox_thing_desc_init"),
            ("/* A thing. */\n", "", "vox_thing: no comment"),
        ]:
            with self.subTest(old=old, new=new):
                self.assertIn(words, self.faults(old, new))


if __name__ == "__main__":
    unittest.main()
