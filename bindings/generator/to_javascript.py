"""JavaScript: layouts of wasm32, enums as objects, the functions to export; their types for TypeScript."""

from names import GENERATED, pascal, sections, short_values, wrapped

NUMBERS = {"uint8_t": "u8", "char": "u8", "int32_t": "i32", "uint32_t": "u32", "int64_t": "i64", "uint64_t": "u64",
           "float": "f32", "double": "f64", "size_t": "u32"}


class JavaScript:
    def __init__(self, api):
        self.api = api
        self.aliases = {a["name"]: a["base"] for a in sections(api, "aliases")}

    def type(self, t):
        """u8, i32, u32, f32, f64, pointer, count (a u64 that a number can hold), u64 (a bigint), or the name of a struct."""
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

    def layout(self):
        lines = [f"// {GENERATED}", ""]
        lines += [f"export const {c['name'][4:]} = {c['value']};" for c in sections(self.api, "constants")]
        for e in sections(self.api, "enums"):
            lines += ["", f"export const {pascal(e['name'])} = Object.freeze({{"]
            lines += [f"  {name}: {value}," for name, value, _ in short_values(e)] + ["});"]
        lines += ["", "// Of each struct: size, and [offset, type, elements] of each field.", "export const structs = {"]
        for s in sections(self.api, "structs"):
            lines.append(f"  {s['name']}: {{ size: {s['size']['wasm32']}, fields: {{")
            for f in s["fields"]:
                count = 1
                for n in f.get("array", []):
                    count *= n
                lines.append(f"    {f['name']}: [{f['offset']['wasm32']}, \"{self.type(f)}\", {count}],")
            lines.append("  } },")
        lines += ["};", "", "// Of each function: its library, the type of its result, those of its parameters.",
                  "export const functions = {"]
        for part in self.api["headers"]:
            for f in part["functions"]:
                result = "void" if f["result"]["kind"] == "void" else self.type(f["result"])
                parameters = ", ".join(f'"{self.parameter(p)}"' for p in f["parameters"])
                lines.append(f"  {f['name']}: [\"{part['name']}\", \"{result}\", [{parameters}]],")
        lines += ["};", ""]
        return "\n".join(lines)

    def comment(self, doc, indent=""):
        if not doc:
            return []
        doc = doc.replace("*/", "* /")
        if len(indent) + len(doc) + 7 <= 120:
            return [f"{indent}/** {doc} */"]
        return [indent + "/**", *wrapped(doc, indent + " * "), indent + " */"]

    def types(self):
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

    def exports(self):
        """For the linker: what the WebAssembly module exports."""
        return "".join(f["name"] + "\n" for f in sections(self.api, "functions"))


def generate(api):
    js = JavaScript(api)
    return {"js/layout.js": js.layout(), "js/enums.d.ts": js.types(), "js/exports.txt": js.exports()}
