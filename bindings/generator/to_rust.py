"""Rust: extern "C" functions, repr(C) structs, enumerators as constants, sizes and offsets asserted."""

from names import GENERATED, sections, whole_structs, wrapped

NUMBERS = {"uint8_t": "u8", "char": "c_char", "int32_t": "i32", "uint32_t": "u32", "int64_t": "i64", "uint64_t": "u64",
           "float": "f32", "double": "f64", "size_t": "usize", "void": "c_void"}
KEYWORDS = {"type", "move", "in", "ref", "where", "box", "priv", "match", "loop", "use"}

# What asserts sizes and offsets: a table, and a macro over it.
LAYOUTS = """
// Of each struct size, alignment, and offsets of its fields: [on 64-bit machines, in WebAssembly and on other 32-bit
// machines that align everything to its own size].
macro_rules! layouts {
    ($($name:ident: size $size:tt, alignment $alignment:tt, { $($field:ident: $offset:tt),* })*) => {
        #[cfg(any(target_pointer_width = "64", all(target_pointer_width = "32", not(target_arch = "x86"))))]
        const _: () = {
            use core::mem::{align_of, offset_of, size_of};
            const MODEL: usize = if cfg!(target_pointer_width = "64") { 0 } else { 1 };
            $(
                assert!(size_of::<$name>() == $size[MODEL], concat!("size of ", stringify!($name)));
                assert!(align_of::<$name>() == $alignment[MODEL], concat!("alignment of ", stringify!($name)));
                $(assert!(
                    offset_of!($name, $field) == $offset[MODEL],
                    concat!("offset of ", stringify!($name), ".", stringify!($field))
                );)*
            )*
        };
    };
}
layouts! {""".split("\n")


class Rust:
    def __init__(self, api):
        self.api = api

    def type(self, t):
        if t["kind"] == "function":
            return f"Option<{self.function(t)}>"
        if t["kind"] == "callback":
            return t["base"]  # an Option: a pointer to a function
        text = NUMBERS.get(t["base"], t["base"])
        mutability = "*const " if t.get("const") else "*mut "
        if "array" in t:
            for count in reversed(t["array"]):
                text = f"[{text}; {count}]"
            return mutability + text if t.get("parameter") else text
        pointers = t.get("pointers", 0)
        if "* const*" in t["type"]:  # a pointer to constant pointers
            return f"*const {mutability}{text}"
        return mutability * pointers + text

    def parameters(self, call):
        return ", ".join(f"{self.name(p)}: {self.type({**p, 'parameter': True})}" for p in call["parameters"])

    def result(self, call):
        nothing = call["result"]["kind"] == "void" and "pointers" not in call["result"]
        return "" if nothing else f" -> {self.type(call['result'])}"

    def declaration(self, f):
        """On one line if it fits."""
        line = f"    pub fn {f['name']}({self.parameters(f)}){self.result(f)};"
        if len(line) <= 100:
            return [line]
        parameters = [f"        {p}," for p in self.parameters(f).split(", ")]
        return [f"    pub fn {f['name']}(", *parameters, f"    ){self.result(f)};"]

    def function(self, call):
        return f'unsafe extern "C" fn({self.parameters(call)}){self.result(call)}'

    @staticmethod
    def name(member):
        return "r#" + member["name"] if member["name"] in KEYWORDS else member["name"]

    def layout(self, s):
        """An entry of the table of sizes and offsets. No line ends within a field."""
        def models(numbers):
            return f"[{numbers['lp64']}, {numbers['wasm32']}]"
        stay = "\N{NO-BREAK SPACE}"
        fields = ", ".join(f"{self.name(f)}: {models(f['offset'])}".replace(" ", stay) for f in s["fields"])
        entry = f"{s['name']}: size {models(s['size'])}, alignment {models(s['alignment'])}, {{ {fields}{stay}}}"
        return [line.replace(stay, " ") for line in wrapped(entry, "    ", further=" " * 8)]

    def text(self):
        lines = [f"// {GENERATED}", "#![allow(non_camel_case_types, rustdoc::all, clippy::all)]", "",
                 "use core::ffi::{c_char, c_void};", "use core::marker::{PhantomData, PhantomPinned};", ""]
        for c in sections(self.api, "constants"):
            lines += wrapped(c["doc"], "/// ") + [f"pub const {c['name']}: u32 = {c['value']};"]
        for e in sections(self.api, "enums"):
            number = "u32" if e["flags"] else "i32"
            lines += ["", *wrapped(e["doc"], "/// "), f"pub type {e['name']} = {number};"]
            for v in e["values"]:
                lines += wrapped(v["doc"], "/// ") + [f"pub const {v['name']}: {e['name']} = {v['value']};"]
        for a in sections(self.api, "aliases"):
            lines += ["", *wrapped(a["doc"], "/// "), f"pub type {a['name']} = {NUMBERS[a['base']]};"]
        for o in sections(self.api, "opaque"):
            lines += ["", *wrapped(o["doc"], "/// "), "#[repr(C)]", f"pub struct {o['name']} {{", "    _data: [u8; 0],",
                      "    _marker: PhantomData<(*mut u8, PhantomPinned)>,", "}"]
        for c in sections(self.api, "callbacks"):
            lines += ["", *wrapped(c["doc"], "/// "), "#[rustfmt::skip]"]
            lines.append(f"pub type {c['name']} = Option<{self.function(c)}>;")
        whole = whole_structs(self.api)
        for s in sections(self.api, "structs"):
            traits = "Clone, Copy, Debug, PartialEq" if s["name"] in whole else "Clone, Copy, Debug"
            lines += ["", *wrapped(s["doc"], "/// "), "#[repr(C)]", f"#[derive({traits})]", f"pub struct {s['name']} {{"]
            for f in s["fields"]:
                if f["kind"] == "function":
                    lines.append("    #[rustfmt::skip]")
                lines += wrapped(f.get("doc", ""), "    /// ") + [f"    pub {self.name(f)}: {self.type(f)},"]
            lines.append("}")
        for part in self.api["headers"]:
            lines.append("")
            if part["library"] != "vox":
                lines.append(f'#[cfg(feature = "{part["library"][4:]}")]')
            lines += ["#[rustfmt::skip]", 'extern "C" {']
            for f in part["functions"]:
                lines += wrapped(f["doc"], "    /// ") + self.declaration(f)
            lines.append("}")
        lines += LAYOUTS
        for s in sections(self.api, "structs"):
            lines += self.layout(s)
        lines.append("}")
        return "\n".join(lines) + "\n"


def generate(api):
    return {"rust/voxtet-sys/src/generated.rs": Rust(api).text()}
