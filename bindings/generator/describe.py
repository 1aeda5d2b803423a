"""The description of the interface: what the public headers and marks.toml say, as one structure that programs can read.
bindings/README.md explains its parts. Nothing is guessed: a pointer of which they do not say enough is an error."""

import json
import os
import re
import tomllib

import header

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
HEADERS = ["vox", "vox_query", "vox_cell_size", "vox_surface", "vox_io", "vox_sim"]
LIBRARY_OF = {"vox_query": "vox", "vox_cell_size": "vox", "vox_surface": "vox"}  # of the others: the library of the same name

MODELS = {"lp64": 8, "wasm32": 4}  # bytes of a pointer; everything is aligned to its own size
NUMBERS = {"uint8_t": 1, "char": 1, "int32_t": 4, "uint32_t": 4, "int64_t": 8, "uint64_t": 8, "float": 4, "double": 8}

# 64-bit numbers all of whose bits may be in use, and those that are counts, sizes, indices or times, below 2^53.
BITS = re.compile(r"(^|_)(hash|mask|reserved|category|user_data(_[ab])?|seed)$")
COUNT = re.compile(r"([^s]s|(^|_)(left_out|began|begin|budget|capacity|cell|compared|contact|count|culled|end|ended|epoch|filtered|first|order|"
                   r"persisted|range|round|size|softened|stride|value)|_in_[ab])$")
# Pointers that are handed back and that nobody looks behind.
OPAQUE = re.compile(r"(^|_)(user|context|handle)$")
# What a void* with a length points to.
ELEMENTS = {"positions": "position", "from": "position", "to": "position", "points": "position", "bytes": "byte", "radii": "number",
            "data": "byte", "memory": "byte"}
SINGULAR_OF = {"indices": "index", "radii": "radius"}  # of the others, without the s
# Names that end in s and stand for one thing: a task system, a struct of arrays, vox_positions.
SINGULAR = {"flags", "ns", "tasks", "arrays", "points"}

WIDTH = 260  # of api.json, where a parameter is on one line


class Unclear(ValueError):
    """The headers and marks.toml do not say enough; a line for each place."""


def last_word(name):
    return name.rsplit("_", 1)[-1]


class Describer:
    def __init__(self, headers, marks):
        self.headers = headers  # name: header.Header
        self.all = [d for parsed in headers.values() for d in parsed.declarations]
        self.types = {d.name: d for d in self.all if d.kind in ("struct", "enum", "opaque", "callback", "alias")}
        self.numbers = {name: number for parsed in headers.values() for name, (number, *_) in parsed.numbers.items()}
        self.faults = []
        self.marks = marks["vox"]
        self.events = {name: words if isinstance(words, str) else ["vox_" + f for f in words]
                       for name, words in marks["events"].items()}
        self.functions = {d.name: d for d in self.all if d.kind == "function"}
        self.read, self.written = set(), set()  # structs that functions are given, that functions fill
        for function in self.functions.values():
            for parameter in function.parameters:
                t = self.type_of(parameter[0])
                if t["kind"] == "struct":
                    self.note_use(self.read if t.get("const") else self.written, t["base"])

    def note_use(self, uses, struct):
        """Also of the structs inside it, and of those that it points to."""
        if struct in uses:
            return
        uses.add(struct)
        for type_text, _ in self.types[struct].fields:
            t = self.type_of(type_text) if "(*)" not in type_text else {"kind": "function"}
            if t["kind"] == "struct":
                self.note_use(uses, t["base"])

    # ---- marks ----

    def mark(self, owner, name, what):
        """What marks.toml says of a parameter or field, or of the owner itself if `name` is empty."""
        of_owner = self.marks.get(owner.name.removeprefix("vox_"), {})
        return (of_owner.get(name, {}) if name else of_owner).get(what)

    def check_marks(self):
        """Each line of marks.toml is about something that exists."""
        calls = (self.call_of(d, m) for d in self.all if d.kind == "struct" for m in d.fields)
        owners = {d.name.removeprefix("vox_"): d for d in (*self.all, *filter(None, calls))}
        for name, marks in self.marks.items():
            members = [m[1] for m in owners[name].fields + owners[name].parameters] if name in owners else []
            for key, value in marks.items():
                known = isinstance(value, dict) and key in members and set(value) <= {"length", "until", "element"}
                if name not in owners or not known and key not in ("until", "threads"):
                    self.faults.append(f"marks.toml: {name}.{key}: there is no such thing")

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
        call = self.call_of(owner, member)
        if not call:
            return self.type_of(member[0])
        return {"type": member[0], "kind": "function", "callback": call.name, **self.signature(call)}

    @staticmethod
    def call_of(owner, member):
        """What a field that points to a function points to."""
        pointer = re.fullmatch(r"(.*)\(\*\)\s*\((.*)\)", member[0])
        return pointer and header.Declaration("callback", f"{owner.name}_{member[1]}", "", owner.line, owner.section,
                                              result=pointer[1].strip(), parameters=header.parameters_of(pointer[2]))

    def signature(self, call):
        result = self.type_of(call.result)
        if "pointers" in result:
            result.update(self.pointer(call, header.Member(call.result, "", call.optional), result, call.parameters))
        return {"result": result, "parameters": [self.member(call, p, call.parameters) for p in call.parameters]}

    # ---- pointers ----

    def fault(self, owner, member, words):
        place = f"{owner.name}: {member[1]}" if member[1] else owner.name
        self.faults.append(f"line {owner.line}: {place}: {words}")

    def pointer(self, owner, member, t, siblings):
        """Direction, nullability, length and lifetime of a pointer."""
        facts = {"direction": self.direction(owner, member, t)}
        length = self.length(owner, member, t, siblings)
        target = {"nullable": self.nullable(owner, member, length)}
        if length is not None:
            target["length"] = length
        target.update(self.elements(owner, member, t, length, siblings))
        lifetime = self.lifetime(owner, member, t)
        if isinstance(lifetime, list) and not (set(lifetime) - set(self.functions)) <= set(self.events):
            self.fault(owner, member, f"until {', '.join(lifetime)}: one of these is no function and no event")
        target["lifetime"] = lifetime
        if lifetime == "owned":
            target["release"] = self.release_of(t["base"])
        # Marks of an out-parameter speak of the pointer that the library writes there.
        if t.get("pointers") == 2 and facts["direction"] == "out":
            if t["kind"] == "opaque":
                target["length"] = 1
            return {**facts, "nullable": False, "length": 1, "lifetime": "call", "target": target}
        return {**facts, **target}

    def release_of(self, opaque):
        found = [name for name in (opaque + "_destroy", opaque + "_release") if name in self.functions]
        return found[0] if found else None

    def direction(self, owner, member, t):
        name = member[1]
        if owner.kind == "struct":
            roles = [role for role, uses in (("in", self.read), ("out", self.written)) if owner.name in uses]
            if not roles:
                self.fault(owner, member, "no function reads or writes the struct")
            return "".join(roles)
        if not name:
            return "out"
        if t.get("const") or "* const*" in t["type"] or OPAQUE.search(name) or t["kind"] == "callback":
            return "in"
        if t["kind"] == "opaque" and t.get("pointers") == 1 or owner.kind == "callback":
            return "in"
        if t["kind"] == "struct" and self.grows(t["base"]):
            return "inout"
        return "out"

    def grows(self, struct):
        return self.types[struct].fields[0][1] == "struct_size"

    def length(self, owner, member, t, siblings):
        """1, "text", an expression, "opaque", or None for a function."""
        name = member[1]
        names = [s[1] for s in siblings]
        following = names[names.index(name) + 1: names.index(name) + 2] if name in names else []
        following = following[0] if following else ""
        if t["kind"] in ("function", "callback"):
            return None
        if self.mark(owner, name, "length"):
            return self.mark(owner, name, "length")
        if "array" in t:
            return t["array"][0]
        if t["kind"] == "void" and (OPAQUE.search(name) or not name and "size" not in names):
            return "opaque"
        if t["base"] == "char":
            return "text"
        if following == "capacity":
            return "capacity"
        if name == "data" and {"byte_stride", "count"} <= set(names):
            return "count"
        if t["kind"] == "void" and (following == "size" or owner.kind == "callback" and not name):
            return "size"
        if t["kind"] == "void":
            self.fault(owner, member, "what does it point to, and how many?")
            return 1
        if t["kind"] == "opaque" and (t["pointers"] == 1 or "* const*" not in t["type"]):
            return 1
        counted = following == "count" or following.endswith("_count") and name.startswith(following[:-6])
        number = t["kind"] not in ("struct", "opaque", "enum")
        if counted and not number:
            return following
        plural = name.endswith("s") and last_word(name) not in SINGULAR | {last_word(t["base"])}
        if plural or counted or number and not name.startswith("out_"):
            self.fault(owner, member, "how many elements? marks.toml says it")
        return 1

    def elements(self, owner, member, t, length, siblings):
        """Of an array: what a void* points to, how far apart, and what functions give counts that are not beside it."""
        found, names = {}, [s[1] for s in siblings]
        if length in (None, "opaque", "text") or isinstance(length, int):
            return found
        stem = re.sub(r"^out_", "", member[1])
        if t["kind"] == "void":
            element = self.mark(owner, member[1], "element") or ELEMENTS.get(last_word(stem) if stem else "memory")
            if element is None:
                self.fault(owner, member, "what does this void* point to?")
            found["element"] = element
        one = SINGULAR_OF.get(stem, stem[:-1])
        strides = [n for n in (one + "_byte_stride", "byte_stride", "out_byte_stride") if n in names]
        if strides and (found.get("element") in ("position", "number") or stem in ("data", "indices")):
            found["stride"] = strides[0]
        asked = {}
        for word in re.findall(r"[a-z]\w*(?:(?:\.|->)\w+)*", length):
            if word == "or" or word in names:
                continue
            if "->" in word and word.split("->")[0] in names:
                base = self.type_of(siblings[names.index(word.split("->")[0])][0])["base"]
                if word.split("->")[1] in (f[1] for f in self.types[base].fields):
                    continue
            elif "." in word and self.who_tells(owner, *word.split(".")[:2]):
                asked[word] = self.who_tells(owner, *word.split(".")[:2])
                continue
            self.fault(owner, member, f"there is no {word} to count its elements")
        if asked:
            found["asked"] = asked
        return found

    def who_tells(self, owner, name, field):
        """The function that gives `field` of what the parameter `name` stands for, of the owner's header first; or else the one that
        creates such an object from a desc with that field."""
        found = []
        for function in self.functions.values():
            names = [p[1] for p in function.parameters]
            out = self.type_of(function.parameters[-1][0]) if function.parameters else {}
            if name in names and out.get("kind") == "struct" and not out.get("const"):
                if field in (f[1] for f in self.types[out["base"]].fields):
                    found.append((self.header_of(function) != self.header_of(owner), len(names), function.name))
        create = self.functions.get(f"vox_{name}_create")
        if not found and create and field in (f[1] for f in self.types[self.type_of(create.parameters[0][0])["base"]].fields):
            return create.name
        return min(found)[-1] if found else None

    def header_of(self, declaration):
        return next((n for n, parsed in self.headers.items() if parsed.named(declaration.name)), None)

    def nullable(self, owner, member, length):
        if member.optional or length == "opaque" or owner.kind == "callback" and not member[1]:
            return True
        if isinstance(length, str) and length != "text" and "+ 1" not in length:
            return "if empty"
        return False

    def lifetime(self, owner, member, t):
        """call, object (as long as what the call creates), static, owned by the caller, or a list of what ends it."""
        until = self.mark(owner, member[1], "until")
        if not until and owner.kind == "struct":
            until = self.mark(owner, "", "until")
        if until:
            return [w if w in self.events else "vox_" + w for w in until]
        if owner.kind == "struct" and (t["kind"] == "function" or OPAQUE.search(member[1])):
            return "object"
        if owner.kind == "struct" and owner.name not in self.read:
            self.fault(owner, member, "how long is it valid? marks.toml says it")
        if owner.kind == "callback":
            return "object" if not member[1] else "call"
        if t["kind"] == "opaque" and t.get("pointers") == 2 and "* const*" not in t["type"]:
            if not self.release_of(t["base"]):
                self.fault(owner, member, f"no function releases a {t['base']}")
            return "owned"
        if not member[1]:
            if "Static text" not in owner.comment:
                self.fault(owner, member, "how long is the result valid? marks.toml says it")
            return "static"
        return "call"

    def flags_of(self, owner, member):
        """The enum of flags that a number is combined from: named by a field's comment, or that of the object."""
        named = re.match(r"(vox_\w+_(?:flags|warnings))(?:[,:]|$)", member.comment)
        if named:
            return named[1]
        if re.fullmatch(r"(out_)?flags", member[1]):
            object_type = self.type_of(owner.parameters[0][0])["base"] if owner.kind == "function" else ""
            if object_type + "_flags" not in self.types:
                self.fault(owner, member, "which flags?")
            return object_type + "_flags"
        return None

    # ---- declarations ----

    def member(self, owner, member, siblings):
        name = member[1]
        found = {"name": name, **self.member_type(owner, member)}
        if found.get("base") == "uint64_t":
            if bool(BITS.search(name)) == bool(COUNT.search(name)):
                self.fault(owner, member, "a count, or bits? describe.py has a list of each")
            found["number"] = "bits" if BITS.search(name) else "count"
        flags = self.flags_of(owner, member)
        if flags:
            found["flags"] = flags
        if found["kind"] == "function" or "pointers" in found or "array" in found and owner.kind != "struct":
            found.update(self.pointer(owner, member, found, siblings))
        elif self.mark(owner, name, "until"):
            found["lifetime"] = self.lifetime(owner, member, found)
        if found["kind"] == "opaque":
            if "target" in found:
                found["access"] = "create" if found["target"]["lifetime"] == "owned" else "get"
            else:
                found["access"] = "read" if found.get("const") else "change"
        if member.comment:
            found["doc"] = member.comment
        return found

    def constants(self, parsed):
        for name, (number, section) in parsed.numbers.items():
            limit = re.search(r"_MAX_|_CAPACITY$", name) is not None
            yield {"name": name, "value": number, "limit": limit, "section": section, "doc": parsed.constants[name]}

    def enum(self, d):
        return {"name": d.name, "section": d.section, "flags": d.name.endswith(("_flags", "_warnings")), "doc": d.comment,
                "values": [{"name": name, "value": number, "doc": comment} for name, number, comment in d.values
                           if not name.endswith("FORCE_32_BITS")]}

    def struct(self, d):
        layouts = {model: self.layout(d, pointer) for model, pointer in MODELS.items()}
        fields = []
        for i, member in enumerate(d.fields):
            fields.append({**self.member(d, member, d.fields), "offset": {m: layouts[m][2][i] for m in MODELS}})
        return {"name": d.name, "section": d.section, "doc": d.comment,
                "size": {m: layouts[m][0] for m in MODELS}, "alignment": {m: layouts[m][1] for m in MODELS},
                "grows": d.fields[0][1] == "struct_size",
                "defaults": self.defaults(d),
                "fields": fields}

    def defaults(self, d):
        """What vox_default_X sets, beside struct_size; None where there is no such function."""
        inline = [f for f in self.all if f.name == d.name.replace("vox_", "vox_default_", 1)]
        if not inline:
            return None
        found = {}
        for target, text in inline[0].fields:
            name, _, at = target.rstrip("]").partition("[")
            if not at:
                found[name] = self.value(text)
                continue
            length = next(int(re.search(r"\[(\d+)\]", t)[1]) for t, n in d.fields if n == name)
            found.setdefault(name, [0] * length)[int(at)] = self.value(text)
        return found

    def value(self, text):
        """A number or an enumerator, as C has it."""
        values = {name: number for d in self.all if d.kind == "enum" for name, number, _ in d.values}
        if text in values:
            return values[text]
        number = float(eval(text, {"__builtins__": {}}))  # of the project's own headers: "1.0 / 30"
        return int(number) if number == int(number) else number

    def opaque(self, d):
        threads = self.mark(d, "", "threads") or "readers or one"
        return {"name": d.name, "section": d.section, "doc": d.comment, "release": self.release_of(d.name),
                "threads": threads}

    def function(self, d):
        return {"name": d.name, "section": d.section, "stable": d.stable, "doc": d.comment, **self.signature(d)}

    def describe(self, version):
        found = {"version": version, "abi_version": self.numbers["VOX_ABI_VERSION"], "events": self.events, "headers": []}
        for name, parsed in self.headers.items():
            of = parsed.of_kind
            found["headers"].append({
                "name": name, "library": LIBRARY_OF.get(name, name), "doc": header.words_of(parsed.conventions),
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
        self.check_marks()
        if self.faults:
            raise Unclear("\n".join(self.faults))
        return found


def text_of(name):
    with open(os.path.join(ROOT, "include", "vox", name + ".h"), encoding="utf-8") as file:
        return file.read()


def own_marks():
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "marks.toml"), "rb") as file:
        return tomllib.load(file)


def describe(texts=None, marks=None):
    """The description of the headers with these texts by name and of these marks; of the repository's own if there are
    none."""
    texts = texts or {name: text_of(name) for name in HEADERS}
    version = ".".join(re.search(rf"#define VOX_VERSION_{part} (\d+)", texts["vox"])[1] for part in
                       ("MAJOR", "MINOR", "PATCH"))
    parsed = {name: header.parse(text) for name, text in texts.items()}
    return Describer(parsed, marks or own_marks()).describe(version)


def as_text(value, indent=""):
    """JSON in which everything that fits is on one line, so that a changed function is a changed line or few."""
    line = json.dumps(value, ensure_ascii=False)
    if not isinstance(value, (dict, list)) or not value or len(indent) + len(line) <= WIDTH:
        return line
    inner = indent + " "
    if isinstance(value, list):
        parts = [as_text(v, inner) for v in value]
    else:
        parts = [f"{json.dumps(k)}: {as_text(v, inner)}" for k, v in value.items()]
    opening, closing = ("[", "]") if isinstance(value, list) else ("{", "}")
    return f"{opening}\n{inner}" + f",\n{inner}".join(parts) + f"\n{indent}{closing}"
