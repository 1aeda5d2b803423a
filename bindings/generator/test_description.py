"""bindings/api.json says what the headers say, and what a compiler sees; nothing in it is guessed; the low layers of the
languages are made from it. With clang, an independent reader confirms names, types, values, sizes and offsets."""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
BINDINGS = os.path.dirname(HERE)
ROOT = os.path.dirname(BINDINGS)
sys.path[:0] = [HERE, BINDINGS, os.path.join(ROOT, "packages")]
import describe  # noqa: E402
import generate  # noqa: E402
import version  # noqa: E402
from names import sections  # noqa: E402

TEXTS = {name: describe.text_of(name) for name in describe.HEADERS}
with open(os.path.join(BINDINGS, "api.json"), encoding="utf-8") as api_file:
    API = json.load(api_file)
CLANG = next((c for c in (os.environ.get("VOX_CLANG"), shutil.which("clang"), shutil.which("clang-14")) if c), None)
CLANG_ON_HEADERS = [CLANG, "-ffreestanding", "-nostdlibinc", "-std=c11", "-fsyntax-only", "-I",
                    os.path.join(ROOT, "include"), "-x", "c", "-"]


def type_texts(call):
    return ", ".join(p["type"] for p in call["parameters"]) or "void"


def lines_of(part):
    """What tests/abi/layout.py writes of a header, from the description."""
    for f in part["functions"]:
        yield f"{'stable' if f['stable'] else 'experimental'} {f['result']['type']} {f['name']}({type_texts(f)})"
    for c in part["callbacks"]:
        yield f"callback {c['result']['type']} {c['name']}({type_texts(c)})"
    for c in part["constants"]:
        yield f"constant {c['name']} {c['value']}"
    for e in part["enums"]:
        yield f"sizeof {e['name']} 4"
        for v in e["values"]:
            yield f"enumerator {v['name']} {v['value']}"
    for a in part["aliases"]:
        yield f"sizeof {a['name']} {describe.NUMBERS[a['base']]}"
    for s in part["structs"]:
        yield f"sizeof {s['name']} {s['size']['lp64']}"
        for f in s["fields"]:
            yield f"field {s['name']}.{f['name']}: {f['type']}, at {f['offset']['lp64']}"


def pointers(value, place=""):
    """(place, description) of every parameter, field and result that is a pointer."""
    if isinstance(value, list):
        for item in value:
            yield from pointers(item, place)
    elif isinstance(value, dict):
        place = f"{place}/{value['name']}" if "name" in value else place
        if "pointers" in value or value.get("kind") == "function" or "array" in value and "offset" not in value:
            yield place, value
        for key, item in value.items():
            yield from pointers(item, place if key != "result" else place + "/result")


class Description(unittest.TestCase):
    def test_headers_description_and_layers_agree(self):
        self.assertEqual(list(generate.differences(BINDINGS)), [], "to write them again: ./dev generate")

    def test_same_numbers_as_the_compiler(self):
        for part in API["headers"]:
            with open(os.path.join(ROOT, "tests", "abi", part["name"] + ".txt"), encoding="ascii") as file:
                expected = {line for line in file.read().splitlines() if "FORCE_32_BITS" not in line}
            self.assertEqual(expected ^ set(lines_of(part)), set(), part["name"])

    def test_every_pointer_is_described(self):
        found = list(pointers(API["headers"]))
        self.assertGreater(len(found), 300)
        for place, pointer in found:
            with self.subTest(place=place):
                self.assertIn(pointer["direction"], ("in", "out", "inout"))
                for target in [pointer, pointer["target"]] if "target" in pointer else [pointer]:
                    self.assertIn(target["nullable"], (True, False, "if empty"))
                    if pointer["kind"] not in ("function", "callback"):
                        self.assertTrue(isinstance(target["length"], int) or target["length"])
                    if isinstance(target["lifetime"], list):
                        self.assertTrue(target["lifetime"])
                    else:
                        self.assertIn(target["lifetime"], ("call", "object", "static", "owned"))
                    self.assertEqual(target["lifetime"] == "owned", "release" in target)

    def test_every_object_is_released_and_says_its_threads(self):
        for o in sections(API, "opaque"):
            self.assertIn(o["release"], {f["name"] for f in sections(API, "functions")})
            self.assertIn(o["threads"], ("readers or one", "one", "any"))
        self.assertEqual({o["name"]: o["threads"] for o in sections(API, "opaque")},
                         {"vox_grid": "readers or one", "vox_locator": "any", "vox_io_mesh": "readers or one",
                          "vox_sim": "one", "vox_surface": "one"})

    def test_events_are_functions_of_the_header(self):
        names = {f["name"] for f in sections(API, "functions")}
        for event, functions in API["events"].items():
            if isinstance(functions, list):
                self.assertLessEqual(set(functions), names, event)
        self.assertEqual(set(API["events"]), {"return", "failure", "unload", "epoch", "rebind"})

    def test_packages_have_the_version_of_the_library(self):
        self.assertEqual(version.version(), API["version"])
        self.assertEqual(version.mistakes(), [])

    def test_everything_has_words(self):
        for kind in ("functions", "constants", "opaque", "aliases", "callbacks", "inline"):
            for d in sections(API, kind):
                if not d["name"].startswith(("vox_default_",)):
                    self.assertTrue(d["doc"], d["name"])


@unittest.skipUnless(CLANG, "no clang")
class Clang(unittest.TestCase):
    """What clang makes of the headers."""

    def test_layouts(self):
        for target, model in (("wasm32", "wasm32"), ("x86_64-linux-gnu", "lp64")):
            if subprocess.run([CLANG, "--target=" + target, "-fsyntax-only", "-x", "c", "-"], input="", text=True,
                              stderr=subprocess.DEVNULL, check=False).returncode != 0:
                self.skipTest(f"this clang does not know {target}")
            lines = [f"#include <vox/{name}.h>" for name in describe.HEADERS]
            for s in sections(API, "structs"):
                lines.append(f"_Static_assert(sizeof({s['name']}) == {s['size'][model]}, \"\");")
                lines.append(f"_Static_assert(_Alignof({s['name']}) == {s['alignment'][model]}, \"\");")
                lines += [f"_Static_assert(__builtin_offsetof({s['name']}, {f['name']}) == {f['offset'][model]}, \"\");"
                          for f in s["fields"]]
            run = subprocess.run([*CLANG_ON_HEADERS, "--target=" + target], input="\n".join(lines) + "\n", text=True,
                                 stderr=subprocess.PIPE, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)

    def test_names_types_and_values(self):
        source = "".join(f"#include <vox/{name}.h>\n" for name in describe.HEADERS)
        run = subprocess.run([*CLANG_ON_HEADERS, "-Xclang", "-ast-dump=json"], input=source, text=True,
                             stdout=subprocess.PIPE, check=True)
        seen = set(clang_lines(json.loads(run.stdout)))
        self.assertEqual(seen ^ set(own_lines()), set())


def plain_type(text):
    """Clang's words for a type, and the header's: without struct and enum, names of parameters and blanks. An array that
    is a parameter is a pointer."""
    text = re.sub(r"\b(struct|enum) ", "", text)
    return re.sub(r"\s+", "", text)


def clang_lines(tree):
    for node in tree["inner"]:
        name = node.get("name", "")
        inner = node.get("inner", [])
        if node["kind"] == "FunctionDecl" and name.startswith("vox_") and not node.get("inline"):
            yield f"function {name}: {plain_type(node['type']['qualType'])}"
            for p in (n for n in inner if n["kind"] == "ParmVarDecl"):
                yield f"parameter {name}: {p['name']}"
        elif node["kind"] == "FunctionDecl" and name.startswith("vox_"):
            yield f"inline {name}"
        elif node["kind"] == "RecordDecl" and name.startswith("vox_") and node.get("completeDefinition"):
            for f in (n for n in inner if n["kind"] == "FieldDecl"):
                yield f"field {name}.{f['name']}: {plain_type(f['type']['qualType'])}"
        elif node["kind"] == "RecordDecl" and name.startswith("vox_"):
            yield f"opaque {name}"
        elif node["kind"] == "EnumDecl" and name.startswith("vox_"):
            for e in inner:
                value = "0"
                for constant in e.get("inner", []):
                    value = constant.get("value", value)
                if not e["name"].endswith("FORCE_32_BITS"):
                    yield f"enumerator {e['name']} {value}"


def prototype(call):
    decayed = [re.sub(r"\[\w+\]", "*", p["type"]) for p in call["parameters"]]
    return plain_type(call["result"]["type"] + "(" + ", ".join(decayed or ["void"]) + ")")


def own_lines():
    for f in sections(API, "functions"):
        yield f"function {f['name']}: {prototype(f)}"
        for p in f["parameters"]:
            yield f"parameter {f['name']}: {p['name']}"
    for d in sections(API, "inline"):
        yield f"inline {d['name']}"
    for s in sections(API, "structs"):
        for f in s["fields"]:
            if f["kind"] == "function":
                text = prototype(f).replace("(", "(*)(", 1)
            else:
                text = re.sub(r"\[\w+\]", "", f["type"]) + "".join(f"[{n}]" for n in f.get("array", []))
            yield f"field {s['name']}.{f['name']}: {plain_type(text)}"
    for o in sections(API, "opaque"):
        yield f"opaque {o['name']}"
    for e in sections(API, "enums"):
        for v in e["values"]:
            yield f"enumerator {v['name']} {v['value']}"


class Faults(unittest.TestCase):
    """The description, and this test, notice a header that changed or says too little."""

    def changed(self, old, new, name="vox"):
        self.assertEqual(TEXTS[name].count(old), 1, old)
        return {**TEXTS, name: TEXTS[name].replace(old, new)}

    def test_a_header_that_says_too_little(self):
        for old, new, words in [
            ("const void* bytes, uint64_t size", "const void* bytes", "bytes: what does it point to"),
            ("const void* bytes, uint64_t size", "const void* stuff, uint64_t size", "stuff: what does this void*"),
            ("vox_grid_destroy(VOX_OPTIONAL vox_grid* grid)", "vox_grid_end(vox_grid* grid)",
             "no function releases a vox_grid"),
            ("uint64_t step_ns; ", "uint64_t fullness; ", "fullness: a count, or bits?"),
            ("uint32_t flags; /* vox_mesh_flags, combined", "uint32_t flags; /* of several kinds, combined", "which flags?"),
        ]:
            with self.subTest(old=old, new=new), self.assertRaises(describe.Unclear) as raised:
                describe.describe(self.changed(old, new))
            self.assertIn(words, str(raised.exception))

    def test_marks_that_say_too_little(self):
        for path, value, words in [
            ("mesh_remove_vertices.vertices", None, "vertices: how many elements?"),
            ("mesh_append_tets.corners.length", "4 * counts", "there is no counts"),
            ("pair_view.contacts.length", "grid.contact", "there is no grid.contact"),
            ("pair_view.until", None, "data: how long is it valid?"),
            ("pair_view.until", ["grid_stop"], "no function and no event"),
            ("last_error", None, "vox_last_error: how long is the result"),
            ("mesh_descs.tets", {"length": "tet_count"}, "mesh_descs.tets: there is no such thing"),
            ("mesh_desc.tet", {"length": "tet_count"}, "mesh_desc.tet: there is no such thing"),
            ("mesh_desc.tets.lengths", "tet_count", "mesh_desc.tets: there is no such thing"),
        ]:
            marks = describe.own_marks()
            *owners, last = path.split(".")
            inner = marks["vox"]
            for owner in owners:
                inner = inner.setdefault(owner, {})
            if value is None:
                del inner[last]
            else:
                inner[last] = value
            with self.subTest(path=path, value=value), self.assertRaises(describe.Unclear) as raised:
                describe.describe(marks=marks)
            self.assertIn(words, str(raised.exception))

    def test_a_wrong_mark(self):
        for old, new in [("VOX_OPTIONAL const char* text", "VOX_OPTIONAL(1) const char* text"),
                         ("VOX_OPTIONAL const char* text", "VOX_OPTIONNAL const char* text"),
                         ("VOX_OPTIONAL const char* text", "const VOX_OPTIONAL char* text")]:
            with self.subTest(new=new), self.assertRaises(ValueError):
                describe.describe(self.changed(old, new))

    def test_a_changed_header_is_noticed_in_every_file(self):
        everything = {"bindings/" + path for path in generate.files()}
        for old, new, without in [
            ("    double offset;\n    double position[3];", "    double offset;\n    float position[3];",
             {"enums.js", "enums.d.ts", "exports.txt"}),
            ("vox_grid_clear(vox_grid* grid);", "vox_grid_clear(vox_grid* grid, double rest);",
             {"enums.js", "enums.d.ts", "structs.d.ts", "exports.txt"}),
            ("VOX_LOG_WARNING = 1", "VOX_LOG_WARNING = 3", {"layout.js", "structs.d.ts", "exports.txt"}),
        ]:
            with self.subTest(new=new):
                found = " ".join(generate.differences(BINDINGS, self.changed(old, new)))
                for path in everything:
                    self.assertEqual(path in found, os.path.basename(path) not in without, path)

    def test_a_changed_comment_is_noticed(self):
        found = list(generate.differences(BINDINGS, self.changed("Removes all bodies and results", "Removes bodies")))
        self.assertIn("bindings/api.json does not fit the headers", found)

    def test_a_changed_or_missing_file_is_noticed(self):
        with tempfile.TemporaryDirectory() as folder:
            for path, text in generate.files().items():
                os.makedirs(os.path.dirname(os.path.join(folder, path)), exist_ok=True)
                with open(os.path.join(folder, path), "w", encoding="utf-8") as file:
                    file.write(text)
            self.assertEqual(list(generate.differences(folder)), [])
            with open(os.path.join(folder, "js", "layout.js"), "a", encoding="utf-8") as file:
                file.write("\n")
            os.remove(os.path.join(folder, "js", "exports.txt"))
            self.assertEqual(list(generate.differences(folder)), ["bindings/js/layout.js does not fit the headers",
                                                                  "bindings/js/exports.txt is missing"])


if __name__ == "__main__":
    unittest.main()
