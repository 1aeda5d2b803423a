"""JavaScript: layouts of wasm32, enums as objects, the functions to export; types of enums and structs for TypeScript."""

import json

from names import GENERATED, camel, pascal, short_values, whole_structs, wrapped
from names import sections as all_sections

HEADERS = ("vox", "vox_query", "vox_cell_size")  # of what the WebAssembly module holds
NUMBERS = {"uint8_t": "u8", "char": "char", "int32_t": "i32", "uint32_t": "u32", "int64_t": "i64", "uint64_t": "u64",
           "float": "f32", "double": "f64", "size_t": "u32"}


COLUMNS = {"u8": "Uint8Array", "i32": "Int32Array", "u32": "Uint32Array", "f32": "Float32Array", "f64": "Float64Array",
           "count": "Float64Array", "u64": "BigUint64Array"}


def sections(api, kind):
    return all_sections({"headers": [part for part in api["headers"] if part["name"] in HEADERS]}, kind)


class JavaScript:
    def __init__(self, api):
        self.api = api
        self.aliases = {a["name"]: a["base"] for a in sections(api, "aliases")}
        self.callbacks = {s["name"] for s in sections(api, "structs")
                          if all(f["kind"] == "function" or "pointers" in f for f in s["fields"])}

    def type(self, t):
        """u8, i32, u32, f32, f64, pointer, char, count (a u64 that a number can hold), u64 (a bigint), or the name of a
        struct."""
        if t["kind"] == "function" or "pointers" in t:
            return "pointer"
        if t["kind"] == "enum":
            return "i32"
        if t["kind"] == "struct":
            return t["base"]
        number = NUMBERS[self.aliases.get(t["base"], t["base"])]
        return "count" if number == "u64" and t.get("number") == "count" else number

    def parameter(self, p):
        return "pointer" if "array" in p else self.type(p)

    def enums(self):
        lines = [f"// {GENERATED}", ""]
        lines += [f"export const {c['name'][4:]} = {c['value']};" for c in sections(self.api, "constants")]
        for e in sections(self.api, "enums"):
            lines += ["", f"export const {pascal(e['name'])} = Object.freeze({{"]
            lines += [f"  {name}: {value}," for name, value, _ in short_values(e)] + ["});"]
        return "\n".join(lines) + "\n"

    def layout(self):
        lines = [f"// {GENERATED}", "", "// Of each struct: size, what vox_default_X sets in it, and [offset, type, elements] of each field.",
                 "export const structs = {"]
        for s in sections(self.api, "structs"):
            defaults = ", ".join(f"{camel(name)}: {json.dumps(value)}" for name, value in (s["defaults"] or {}).items())
            lines.append(f"  {s['name']}: {{ size: {s['size']['wasm32']}, defaults: {{ {defaults} }}, fields: {{")
            for f in s["fields"]:
                count = 1
                for n in f.get("array", []):
                    count *= n
                lines.append(f"    {f['name']}: [{f['offset']['wasm32']}, \"{self.type(f)}\", {count}],")
            lines.append("  } },")
        lines += ["};", "", "// Of each function: the type of its result, those of its parameters.",
                  "export const functions = {"]
        for f in sections(self.api, "functions"):
            result = "void" if f["result"]["kind"] == "void" else self.type(f["result"])
            if f["result"]["base"] == "vox_result":
                result = "result"
            parameters = ", ".join(f'"{self.parameter(p)}"' for p in f["parameters"])
            lines.append(f"  {f['name']}: [\"{result}\", [{parameters}]],")
        lines += ["};", ""]
        return "\n".join(lines)

    def comment(self, doc, indent=""):
        if not doc:
            return []
        doc = doc.replace("*/", "* /")
        if len(indent) + len(doc) + 7 <= 120:
            return [f"{indent}/** {doc} */"]
        return [indent + "/**", *wrapped(doc, indent + " * "), indent + " */"]

    def enum_types(self):
        lines = [f"// {GENERATED}", ""]
        for e in sections(self.api, "enums"):
            name = pascal(e["name"])
            lines += [*self.comment(e["doc"]), f"export declare const {name}: Readonly<{{"]
            for short, value, doc in short_values(e):
                lines += [*self.comment(doc, "  "), f"  {short}: {value};"]
            kind = "number" if e["flags"] else f"(typeof {name})[keyof typeof {name}]"
            lines += ["}>;", f"export type {name} = {kind};", ""]
        for c in sections(self.api, "constants"):
            lines += [*self.comment(c["doc"]), f"export declare const {c['name'][4:]}: {c['value']};"]
        return "\n".join(lines) + "\n"

    def shown(self, struct):
        """The fields that a program sees. Positions are arrays of the language's own."""
        return [f for f in struct["fields"] if self.type(f) not in ("pointer", "vox_positions") and not f["name"].endswith("_stride")
                and f["name"] not in ("struct_size", "reserved") and f["base"] not in self.callbacks]

    def value(self, field):
        """Type of a field in TypeScript."""
        kind = self.type(field)
        if kind == "char":
            return "string"
        if kind == "u64":
            one = "bigint"
        elif field["kind"] == "enum":
            one = pascal(field["base"])
        else:
            one = pascal(field["base"]) if kind.startswith("vox_") else "number"
        if "array" not in field:
            return one
        count = field["array"][0]
        return f"{one}[]" if count > 4 or kind.startswith("vox_") else f"[{', '.join([one] * count)}]"

    def struct_types(self):
        """An interface for each struct, and for those that come in numbers one of their columns. Not for views, and not
        for descriptions of arrays: these look otherwise in JavaScript."""
        whole = whole_structs(self.api)
        used = sorted({pascal(f["base"]) for s in sections(self.api, "structs") for f in self.shown(s)
                       if f["kind"] == "enum"})
        lines = [f"// {GENERATED}", "", *wrapped(f"import type {{ {', '.join(used)} }} from \"./enums.js\";", "")]
        for s in sections(self.api, "structs"):
            arrays = any("length" in f and f["direction"] != "out" and f["base"] not in self.callbacks | {"vox_reference_desc", "vox_cost_weights"}
                         for f in s["fields"])
            if s["name"].endswith("_view") or s["name"] in self.callbacks or arrays:
                continue
            lines += ["", *self.comment(s["doc"]), f"export interface {pascal(s['name'])} {{"]
            for f in self.shown(s):
                lines += [*self.comment(f.get("doc"), "  "), f"  {camel(f['name'])}: {self.value(f)};"]
            lines.append("}")
            kinds = [self.type(f) for f in s["fields"]]
            if s["grows"] or s["name"] not in whole or any(kind not in COLUMNS for kind in kinds):
                continue
            lines += ["", f"/** Columns of {pascal(s['name'])}: of an array field, its elements one after the other. */",
                      f"export interface {pascal(s['name'])}Columns {{"]
            lines += [f"  readonly {camel(f['name'])}: {COLUMNS[self.type(f)]};" for f in self.shown(s)] + ["}"]
        return "\n".join(lines) + "\n"

    def exports(self):
        """For the linker: what the WebAssembly module exports."""
        return "".join(f["name"] + "\n" for f in sections(self.api, "functions"))


def generate(api):
    js = JavaScript(api)
    return {"js/layout.js": js.layout(), "js/enums.js": js.enums(), "js/enums.d.ts": js.enum_types(),
            "js/structs.d.ts": js.struct_types(), "js/exports.txt": js.exports()}
