"""Python: ctypes structures and prototypes, enums, numpy dtypes."""

from names import GENERATED, pascal, sections, short_values, whole_structs, wrapped

NUMBERS = {"uint8_t": "c_uint8", "char": "c_char", "int32_t": "c_int32", "uint32_t": "c_uint32", "int64_t": "c_int64",
           "uint64_t": "c_uint64", "float": "c_float", "double": "c_double", "size_t": "c_size_t"}
FORMATS = {"uint8_t": "u1", "int32_t": "i4", "uint32_t": "u4", "int64_t": "i8", "uint64_t": "u8", "float": "f4",
           "double": "f8"}

BEGIN = """
import enum
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t,
                    c_uint8, c_uint32, c_uint64, c_void_p)
from typing import Any

from numpy import dtype
""".split("\n")
END = '''

def declare(library: Any, name: str, check: Any = None) -> None:
    """Gives the functions of the header `name` (vox, vox_query, vox_cell_size, vox_surface, vox_io, vox_sim) in a ctypes library their types. `check` becomes the errcheck
    of those whose result is a vox_result: a failure unless it is 0."""
    for function, (result, parameters) in FUNCTIONS[name].items():
        found = getattr(library, function)
        found.restype, found.argtypes = result, parameters
        if result is vox_result:
            found.restype = c_int32  # so that ctypes gives a plain number
            if check:
                found.errcheck = check
'''.split("\n")


class Python:
    def __init__(self, api):
        self.api = api
        self.aliases = {a["name"]: a["base"] for a in sections(api, "aliases")}
        self.callbacks = {c["name"] for c in sections(api, "callbacks")}

    def value(self, t):
        """The ctypes type of a value."""
        if t["kind"] == "enum":
            return "c_int32"
        return t["base"] if t["kind"] == "struct" else NUMBERS[self.aliases.get(t["base"], t["base"])]

    def text_pointer(self, t):
        return t.get("base") == "char" and t.get("pointers") == 1

    def parameter(self, t):
        """Arrays, opaque handles and memory without a type are addresses."""
        if t["kind"] == "callback":
            return t["base"]
        if "pointers" not in t:
            return "c_void_p" if "array" in t else self.value(t)
        if self.text_pointer(t) and "const" in t:
            return "c_char_p"
        if t["length"] != 1:
            return "c_void_p"
        if t["pointers"] == 2:
            return "POINTER(c_void_p)"
        if t["kind"] == "struct":
            return f"POINTER({t['base']})"
        if t["direction"] == "out":
            return f"POINTER({self.value(t)})"
        return "c_void_p"

    def result(self, t):
        if t["kind"] == "void":
            return "c_void_p" if "pointers" in t else "None"
        return "c_char_p" if self.text_pointer(t) else self.value(t)

    def function_type(self, call):
        types = [self.result(call["result"]), *(self.parameter(p) for p in call["parameters"])]
        return f"CFUNCTYPE({', '.join(types)})"

    def field(self, f):
        if f["kind"] == "function":
            return f["callback"]
        if self.text_pointer(f):
            return "c_char_p"
        if "pointers" in f:
            return f"POINTER({f['base']})" if f["kind"] == "struct" and f["length"] == 1 else "c_void_p"
        text = self.value(f)
        for count in reversed(f.get("array", [])):
            text = f"{text} * {count}"
        return text

    def dtype(self, f):
        if f["base"] == "char":
            return f'"S{f["array"][0]}"'
        text = "dtypes[\"" + f["base"] + '"]' if f["kind"] == "struct" else \
            '"' + ("i4" if f["kind"] == "enum" else FORMATS[self.aliases.get(f["base"], f["base"])]) + '"'
        return f"({text}, {tuple(f['array'])})" if "array" in f else text

    def struct(self, s, whole):
        for f in s["fields"]:
            if f["kind"] == "function":
                yield f"{f['callback']} = {self.function_type(f)}"
        yield f"class {s['name']}(Structure):"
        yield "    _fields_ = ["
        for f in s["fields"]:
            yield f'        ("{f["name"]}", {self.field(f)}),'
        yield "    ]"
        yield ""
        if s["name"] in whole:
            yield f'dtypes["{s["name"]}"] = dtype({{'
            for key, values in (("names", [f'"{f["name"]}"' for f in s["fields"]]),
                                ("formats", [self.dtype(f) for f in s["fields"]]),
                                ("offsets", [str(f["offset"]["lp64"]) for f in s["fields"]])):
                yield from wrapped(f'"{key}": [{", ".join(values)}],', "    ", further=" " * 8)
            yield f'    "itemsize": {s["size"]["lp64"]}}})'
            yield ""
        yield ""

    def in_order(self):
        """The structs, each after those that its fields name."""
        structs = {s["name"]: s for s in sections(self.api, "structs")}
        found = {}

        def add(s):
            for f in s["fields"]:
                if f.get("kind") == "struct" and f["base"] != s["name"] and f["base"] not in found:
                    add(structs[f["base"]])
            found[s["name"]] = s

        for s in structs.values():
            if s["name"] not in found:
                add(s)
        return found.values()

    def text(self):
        lines = [f'"""{GENERATED}"""', *BEGIN]
        for c in sections(self.api, "constants"):
            lines.append(f"{c['name']} = {c['value']}")
        for e in sections(self.api, "enums"):
            lines += ["", "", f"class {pascal(e['name'])}(enum.{'IntFlag' if e['flags'] else 'IntEnum'}):"]
            lines += [f"    {name} = {value}" for name, value, _ in short_values(e)]
        lines += ["", "", "class vox_result(c_int32):", '    """Marks the functions that can fail."""']
        lines += ["", "", "# Of structs without pointers: for arrays over the library's memory.",
                  "dtypes: dict[str, Any] = {}", "", ""]
        for c in sections(self.api, "callbacks"):
            lines.append(f"{c['name']} = {self.function_type(c)}")
        lines.append("")
        whole = whole_structs(self.api)
        for s in self.in_order():
            lines += self.struct(s, whole)
        lines += ["# What vox_default_X sets in a struct, beside struct_size, where that is not all 0.",
                  "DEFAULTS: dict[str, dict[str, Any]] = {"]
        lines += [f'    "{s["name"]}": {s["defaults"]},' for s in sections(self.api, "structs") if s["defaults"]]
        lines += ["}", "", ""]
        lines += ["# Of each header: name, type of the result, types of the parameters.",
                  "FUNCTIONS: dict[str, dict[str, tuple[Any, Any]]] = {"]
        for part in self.api["headers"]:
            lines.append(f'    "{part["name"]}": {{')
            for f in part["functions"]:
                types = [self.parameter(p) for p in f["parameters"]]
                types = f"({', '.join(types)}{',' if len(types) == 1 else ''})"
                result = "vox_result" if f["result"]["base"] == "vox_result" else self.result(f["result"])
                lines += wrapped(f'"{f["name"]}": ({result}, {types}),', " " * 8, further=" " * 12)
            lines.append("    },")
        lines += ["}", *END]
        return "\n".join(lines)


def generate(api):
    return {"python/src/voxtet/_c.py": Python(api).text()}
