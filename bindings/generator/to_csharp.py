"""C#: blittable structs, enums, P/Invoke, and a table that compares the layout at run time."""

from xml.sax.saxutils import escape

from names import GENERATED, first_sentence, pascal, sections, short_values, whole_structs, wrapped

NUMBERS = {"uint8_t": "byte", "char": "byte", "int32_t": "int", "uint32_t": "uint", "int64_t": "long", "uint64_t": "ulong",
           "float": "float", "double": "double", "size_t": "UIntPtr", "void": "void"}
KEYWORDS = {"in", "out", "ref", "params", "object", "string", "lock", "base", "event", "fixed", "checked", "is", "as"}


class CSharp:
    def __init__(self, api):
        self.api = api
        self.aliases = {a["name"]: a["base"] for a in sections(api, "aliases")}
        self.whole = whole_structs(api)
        self.arrays = {}  # name: (type of an element, count)

    def value(self, t):
        if t["kind"] in ("enum", "struct"):
            return pascal(t["base"])
        return NUMBERS[self.aliases.get(t["base"], t["base"])]

    def array(self, element, count):
        """The name of a struct of `count` elements: what C has inside a struct, and C# has not."""
        letters = element[0].upper() + element[1:]
        name = f"{letters}{count}"
        self.arrays[name] = (element, count)
        return name

    def parameter_type(self, t):
        if t["kind"] in ("callback", "opaque", "void") or t["base"] == "char":
            return "IntPtr" + "*" * (t.get("pointers", 0) - 1)
        if "array" in t:
            return self.value(t) + "*"
        if "flags" in t:
            return pascal(t["flags"]) + "*" * t.get("pointers", 0)
        return self.value(t) + "*" * t.get("pointers", 0)

    def field_type(self, f):
        if f["kind"] == "function" or f["kind"] in ("void", "opaque") or (f["base"] == "char" and "pointers" in f):
            return "IntPtr"
        if "flags" in f:
            return pascal(f["flags"])
        text = self.value(f) + "*" * f.get("pointers", 0)
        for count in f.get("array", []):
            text = self.array(text, count)
        return text

    @staticmethod
    def name(member):
        return "@" + member["name"] if member["name"] in KEYWORDS else member["name"]

    @staticmethod
    def summary(doc, indent="    "):
        return wrapped(f"<summary>{escape(first_sentence(doc))}</summary>", indent + "/// ") if doc else []

    def result(self, t):
        if t["kind"] == "void":
            return "IntPtr" if "pointers" in t else "void"
        return "IntPtr" if "pointers" in t else self.value(t)

    def parameters(self, call):
        return ", ".join(f"{self.parameter_type(p)} {self.name(p)}" for p in call["parameters"])

    def enum(self, e):
        yield ""
        yield from self.summary(e["doc"])
        if e["flags"]:
            yield "    [Flags]"
        yield f"    public enum {pascal(e['name'])} : {'uint' if e['flags'] else 'int'}"
        yield "    {"
        for name, value, doc in short_values(e):
            yield from self.summary(doc, "        ")
            yield f"        {pascal(name)} = {value},"
        yield "    }"

    def struct(self, s):
        whole = s["name"] in self.whole
        yield ""
        yield from self.summary(s["doc"])
        size = f", Size = {s['size']['lp64']}" if whole else ""
        yield f"    [StructLayout(LayoutKind.Sequential{size})]"
        yield f"    {'public' if whole else 'internal unsafe'} struct {pascal(s['name'])}"
        yield "    {"
        for f in s["fields"]:
            yield from self.summary(f.get("doc", ""), "        ")
            yield f"        public {self.field_type(f)} {self.name(f)};"
        yield "    }"

    def array_struct(self, name, element, count):
        fields = ["x", "y", "z", "w"][:count] if count <= 4 and element != "byte" else [f"e{i}" for i in range(count)]
        yield ""
        yield "    [StructLayout(LayoutKind.Sequential)]"
        internal = {pascal(s["name"]) for s in sections(self.api, "structs") if s["name"] not in self.whole}
        yield f"    {'internal' if element in internal else 'public'} unsafe struct {name}"
        yield "    {"
        yield from wrapped(f"public {element} {', '.join(fields)};", "        ", further=" " * 12)
        yield f"        public const int Length = {count};"
        yield f"        public {element} this[int i]"
        yield "        {"
        yield f"            get {{ Check(i); fixed ({element}* p = &{fields[0]}) return p[i]; }}"
        yield f"            set {{ Check(i); fixed ({element}* p = &{fields[0]}) p[i] = value; }}"
        yield "        }"
        yield "        static void Check(int i) { if ((uint)i >= Length) throw new IndexOutOfRangeException(); }"
        if element == "byte":
            yield "        public override string ToString()"
            yield "        {"
            yield f"            fixed (byte* p = &{fields[0]})"
            yield "            {"
            yield "                int end = 0;"
            yield f"                while (end < {count} && p[end] != 0) ++end;"
            yield "                return System.Text.Encoding.UTF8.GetString(p, end);"
            yield "            }"
            yield "        }"
        yield "    }"

    def layouts(self):
        yield ""
        yield "    /// <summary>A size or an offset here, and what it is for the library.</summary>"
        yield "    internal struct LayoutEntry"
        yield "    {"
        yield "        public string Name;"
        yield "        public long Here, In64Bits, In32Bits;"
        yield "        public long Expected { get { return IntPtr.Size == 8 ? In64Bits : In32Bits; } }"
        yield "    }"
        yield ""
        yield "    internal static unsafe class Layout"
        yield "    {"
        yield "        static LayoutEntry Entry(string name, long here, long in64Bits, long in32Bits)"
        yield "        {"
        yield ("            return new LayoutEntry { Name = name, Here = here, In64Bits = in64Bits, "
               "In32Bits = in32Bits };")
        yield "        }"
        structs = sections(self.api, "structs")
        for s in structs:
            name = pascal(s["name"])
            yield ""
            yield f"        static void Add{name}(List<LayoutEntry> entries)"
            yield "        {"
            yield f"            {name} s;"
            yield "            byte* begin = (byte*)&s;"
            yield (f"            entries.Add(Entry(\"{s['name']}\", sizeof({name}), {s['size']['lp64']}, "
                   f"{s['size']['wasm32']}));")
            for f in s["fields"]:
                yield (f"            entries.Add(Entry(\"{s['name']}.{f['name']}\", (byte*)&s.{self.name(f)} - begin, "
                       f"{f['offset']['lp64']}, {f['offset']['wasm32']}));")
            yield "        }"
        yield ""
        yield "        /// <summary>All structs and fields. A program whose entries differ must not call the library.</summary>"
        yield "        internal static List<LayoutEntry> Entries()"
        yield "        {"
        yield "            var entries = new List<LayoutEntry>();"
        for s in structs:
            yield f"            Add{pascal(s['name'])}(entries);"
        yield "            return entries;"
        yield "        }"
        yield "    }"

    def delegates(self):
        for owner in sections(self.api, "callbacks"):
            yield from self.delegate(owner["name"], owner)
        for s in sections(self.api, "structs"):
            for f in s["fields"]:
                if f["kind"] == "function":
                    yield from self.delegate(f["callback"], f)

    def delegate(self, name, call):
        yield ""
        yield "    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]"
        parameters = self.parameters(call)
        unsafe = "unsafe " if "*" in parameters else ""
        yield f"    internal {unsafe}delegate {self.result(call['result'])} {pascal(name)}({parameters});"

    def functions(self):
        yield ""
        yield "    internal static unsafe class Native"
        yield "    {"
        for c in sections(self.api, "constants"):
            yield from self.summary(c["doc"], "        ")
            yield f"        internal const uint {c['name']} = {c['value']};"
        yield ""
        yield "#if (UNITY_IOS || UNITY_WEBGL) && !UNITY_EDITOR"
        libraries = list(dict.fromkeys(part["library"] for part in self.api["headers"]))
        for library in libraries:
            yield f"        const string {library} = \"__Internal\";"
        yield "#else"
        for library in libraries:
            yield f"        const string {library} = \"{library}\";"
        yield "#endif"
        for part in self.api["headers"]:
            for f in part["functions"]:
                yield ""
                yield from self.summary(f["doc"], "        ")
                yield (f"        [DllImport({part['library']}, CallingConvention = CallingConvention.Cdecl, "
                       "ExactSpelling = true)]")
                prototype = f"{self.result(f['result'])} {f['name']}({self.parameters(f)})"
                yield from wrapped(f"internal static extern {prototype};", "        ", further=" " * 12)
        yield "    }"

    def text(self):
        lines = [f"// {GENERATED}", "using System;", "using System.Collections.Generic;",
                 "using System.Runtime.InteropServices;", "", "namespace Voxtet", "{"]
        lines.append("    // Names and layouts are those of vox.h, vox_query.h, vox_cell_size.h, vox_surface.h, vox_io.h and vox_sim.h.")
        for e in sections(self.api, "enums"):
            lines += self.enum(e)
        structs = [line for s in sections(self.api, "structs") for line in self.struct(s)]
        for name, (element, count) in self.arrays.items():
            lines += self.array_struct(name, element, count)
        lines += structs
        lines += self.delegates()
        lines += self.functions()
        lines += self.layouts()
        return "\n".join(lines + ["}", ""])


def generate(api):
    return {"csharp/Runtime/Native.g.cs": CSharp(api).text()}
