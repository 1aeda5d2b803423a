"""The description of the interface: what the public headers say, as one structure that programs can read. bindings/README.md
explains its parts."""

import json
import os
import re

import header

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
HEADERS = ["vox", "vox_io", "vox_sim"]

MODELS = {"lp64": 8, "wasm32": 4}  # bytes of a pointer; everything is aligned to its own size
NUMBERS = {"uint8_t": 1, "char": 1, "int32_t": 4, "uint32_t": 4, "int64_t": 8, "uint64_t": 8, "float": 4, "double": 8}

# 64-bit numbers that are not counts, sizes or times: all their bits may be in use.
BITS = re.compile(r"(^|_)(hash|mask|category|user_data|seed)(_|$)")
# Pointers of the caller's that the library hands back and never looks behind.
OPAQUE = re.compile(r"(^|_)(user|context|handle)$")


class Describer:
    def __init__(self, headers):
        self.headers = headers  # name: header.Header
        self.all = [d for parsed in headers.values() for d in parsed.declarations]
        self.types = {d.name: d for d in self.all if d.kind in ("struct", "enum", "opaque", "callback", "alias")}
        self.numbers = {name: number for parsed in headers.values() for name, (number, *_) in parsed.numbers.items()}
        self.written, self.read = {}, {}
        for function in (d for d in self.all if d.kind == "function"):
            for type_text, _ in function.parameters:
                base = self.type_of(type_text)
                if base["kind"] == "struct":
                    (self.read if base.get("const") else self.written).setdefault(base["base"], []).append(function.name)

    # ---- types ----

    def type_of(self, text):
        """The parts of a C type, function pointers apart."""
        array = [self.numbers[n] if n in self.numbers else int(n) for n in re.findall(r"\[(\w+)\]", text)]
        words = re.sub(r"\[\w+\]", "", text)
        base = re.sub(r"\bconst\b|\*", " ", words).split()
        if len(base) != 1:
            raise ValueError(f"cannot read the type '{text}'")
        found = {"type": text, "base": base[0]}
        if base[0] in self.types:
            found["kind"] = self.types[base[0]].kind
        elif base[0] in NUMBERS or base[0] == "size_t":
            found["kind"] = "number"
        elif base[0] == "void":
            found["kind"] = "void"
        else:
            raise ValueError(f"unknown type '{text}'")
        if "*" in words:
            found["pointers"] = words.count("*")
        if words.startswith("const "):
            found["const"] = True
        if array:
            found["array"] = array
        return found

    def size_and_alignment(self, described, pointer):
        """Of a type, where a pointer has so many bytes."""
        if described["kind"] == "function" or "pointers" in described or described["base"] == "size_t":
            size = alignment = pointer
        elif described["kind"] == "number":
            size = alignment = NUMBERS[described["base"]]
        elif described["kind"] == "enum":
            size = alignment = 4
        elif described["kind"] == "alias":
            size, alignment = self.size_and_alignment(self.type_of(self.types[described["base"]].result), pointer)
        elif described["kind"] == "struct":
            size, alignment, _ = self.layout(self.types[described["base"]], pointer)
        else:
            raise ValueError(f"no value has the type {described['type']}")
        for count in described.get("array", []):
            size *= count
        return size, alignment

    def layout(self, struct, pointer):
        """(size, alignment, offsets)."""
        end, largest, offsets = 0, 1, []
        for member in struct.fields:
            size, alignment = self.size_and_alignment(self.member_type(struct, member), pointer)
            end = -(-end // alignment) * alignment
            offsets.append(end)
            end += size
            largest = max(largest, alignment)
        return -(-end // largest) * largest, largest, offsets

    def member_type(self, owner, member):
        """The type of a parameter or field."""
        type_text, name = member
        pointer = re.fullmatch(r"(.*)\(\*\)\s*\((.*)\)", type_text)
        if not pointer:
            return self.type_of(type_text)
        call = header.Declaration("callback", f"{owner.name}_{name}", "", owner.line, owner.section,
                                  result=pointer[1].strip(), parameters=header.parameters_of(pointer[2]))
        return {"type": type_text, "kind": "function", "callback": call.name, **self.signature(call)}

    def signature(self, call):
        return {"result": self.type_of(call.result), "parameters": [self.member(call, p) for p in call.parameters]}

    # ---- declarations ----

    def member(self, owner, member):
        name = member[1]
        found = {"name": name, **self.member_type(owner, member)}
        if found.get("base") == "uint64_t" and "pointers" not in found:
            found["number"] = "bits" if BITS.search(name) else "count"
        if member.comment:
            found["doc"] = member.comment
        return found

    def constants(self, parsed):
        for name, (number, _, section) in parsed.numbers.items():
            yield {"name": name, "value": number, "section": section, "doc": parsed.constants[name]}

    def enum(self, d):
        return {"name": d.name, "section": d.section, "flags": d.name.endswith("_flags"), "doc": d.comment,
                "values": [{"name": name, "value": number, "doc": comment} for name, number, comment in d.values
                           if not name.endswith("FORCE_32_BITS")]}

    def struct(self, d):
        layouts = {model: self.layout(d, pointer) for model, pointer in MODELS.items()}
        fields = []
        for i, member in enumerate(d.fields):
            fields.append({**self.member(d, member), "offset": {m: layouts[m][2][i] for m in MODELS}})
        init = d.name + "_init"
        return {"name": d.name, "section": d.section, "doc": d.comment,
                "size": {m: layouts[m][0] for m in MODELS}, "alignment": {m: layouts[m][1] for m in MODELS},
                "grows": d.fields[0][1] == "struct_size",
                "init": init if any(f.name == init for f in self.all) else None,
                "read_by": self.read.get(d.name, []), "written_by": self.written.get(d.name, []), "fields": fields}

    def opaque(self, d):
        ends = [f.name for f in self.all if f.name in (d.name + "_destroy", d.name + "_release")]
        return {"name": d.name, "section": d.section, "doc": d.comment, "destroy": ends[0]}

    def function(self, d):
        return {"name": d.name, "section": d.section, "stable": d.stable, "doc": d.comment, **self.signature(d)}

    def describe(self, version):
        found = {"version": version, "abi_version": self.numbers["VOX_ABI_VERSION"], "headers": []}
        for name, parsed in self.headers.items():
            of = parsed.of_kind
            found["headers"].append({
                "name": name, "doc": header.words_of(parsed.conventions),
                "sections": [{"name": s, "doc": words.strip()} for s, words in parsed.sections.items()],
                "constants": list(self.constants(parsed)),
                "enums": [self.enum(d) for d in of("enum")],
                "aliases": [{"name": d.name, "section": d.section, "doc": d.comment, **self.type_of(d.result)}
                            for d in of("alias")],
                "opaque": [self.opaque(d) for d in of("opaque")],
                "callbacks": [{"name": d.name, "section": d.section, "doc": d.comment, **self.signature(d)}
                              for d in of("callback")],
                "structs": [self.struct(d) for d in of("struct")],
                "functions": [self.function(d) for d in of("function")],
                "inline": [{"name": d.name, "section": d.section, "doc": d.comment} for d in of("inline")]})
        return found


def text_of(name):
    with open(os.path.join(ROOT, "include", "vox", name + ".h"), encoding="utf-8") as file:
        return file.read()


def describe(texts=None):
    """The description of the headers with these texts by name; of the repository's own if there are none."""
    texts = texts or {name: text_of(name) for name in HEADERS}
    version = ".".join(re.search(rf"#define VOX_VERSION_{part} (\d+)", texts["vox"])[1] for part in
                       ("MAJOR", "MINOR", "PATCH"))
    return Describer({name: header.parse(text) for name, text in texts.items()}).describe(version)


def as_text(value, indent=""):
    """JSON in which everything that fits is on one line, so that a changed function is a changed line or few."""
    line = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, (dict, list)) or not value or len(indent) + len(line) <= 120:
        return line
    inner = indent + " "
    if isinstance(value, list):
        parts = [as_text(v, inner) for v in value]
    else:
        parts = [f"{json.dumps(k)}: {as_text(v, inner)}" for k, v in value.items()]
    opening, closing = ("[", "]") if isinstance(value, list) else ("{", "}")
    return f"{opening}\n{inner}" + f",\n{inner}".join(parts) + f"\n{indent}{closing}"
