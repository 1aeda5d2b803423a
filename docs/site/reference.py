"""The reference: a page for each section of the public headers, in their order, with the comments as they stand there and
what the marks say about each pointer (bindings/generator). Also says where each name is described.

Python with the standard library only."""

import html
import os
import posixpath
import re
import sys

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "bindings", "generator"))
import describe  # noqa: E402
import header  # noqa: E402

KINDS = ("constants", "enums", "aliases", "opaque", "callbacks", "structs", "functions", "inline")
WIDTH = 100  # of a declaration, before each parameter gets a line


def file_of(section):
    return re.sub(r"\W+", "-", section) + ".md"


def escaped(text):
    """Plain words as Markdown: nothing in a comment is meant as markup, except for its `code`."""
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(
        p if i % 2 else re.sub(r"([\\*_#<>\[\]|~])", lambda m: html.escape(m[1]) if m[1] in "<>" else "\\" + m[1], p)
        for i, p in enumerate(parts)
    )


def lines_of(comment):
    """The lines of a comment without its stars; what is indented stays so."""
    lines = [re.sub(r"^\s*\* ?", "", line).rstrip() for line in comment[2:-2].split("\n")]
    return [lines[0].strip()] + lines[1:]


class Reference:
    def __init__(self):
        self.api = describe.describe()
        self.comments = {}  # of a name, or a section: its lines
        self.shared = {}  # of a name without a comment: the one before it, whose comment is about both
        self.statements = {}  # of a name: the C that declares it
        for parsed in self.api["headers"]:
            self.read(parsed["name"])
        for parsed in self.api["headers"]:
            first = next(thing["section"] for thing in things_of(parsed) if thing["section"])
            for thing in things_of(parsed):
                thing["section"] = thing["section"] or first  # what stands above the first heading
        self.places = {}  # name: (page, anchor)
        for parsed in self.api["headers"]:
            for thing in things_of(parsed):
                place = (f"reference/{parsed['name']}/{file_of(thing['section'])}", thing["name"])
                self.places[thing["name"]] = place
                for value in thing.get("values", []):
                    self.places[value["name"]] = (place[0], value["name"])

    def read(self, name):
        with open(os.path.join(ROOT, "include", "vox", name + ".h"), encoding="utf-8") as file:
            text = file.read()
        self.comments[name] = lines_of(text[: text.index("*/") + 2])
        text = re.sub(r"#ifdef __cplusplus.*?#endif", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
        section, last, end = "", "", 0
        for statement, above, line in header.statements(text):
            if not statement:
                title = re.fullmatch(r"/\* -{4} (.+?) -{4,} \*/", above)
                if title:
                    section = title[1]
                elif section:
                    self.comments.setdefault((name, section), []).extend(["", *lines_of(above)])
                continue
            code = header.plain(statement)
            found = (
                re.match(r"#define (VOX_\w+) ", code)
                or re.match(r"typedef (?:VOX_\w+ )?(?:struct|enum) (\w+)", code)
                or re.match(r"typedef \w+ (\w+);", code)
                or re.search(r"\b(vox_\w+)\((?!\*)", code)
            )
            if found:
                self.statements[found[1]] = code
                if above:
                    self.comments[found[1]] = lines_of(above)
                    last = found[1]
                elif code.startswith("static inline") and line == end + 1:
                    self.shared[found[1]] = last
                end = line + statement.count("\n")

    # ---- text ----

    def words(self, text, page):
        """Escaped, with names as links."""
        parts = re.split(r"(`[^`]+`|\bdocs/[\w-]+\.md|\bvox_\w+(?:\(\)|\.[a-z]\w*)?|\bVOX_\w+)", text)
        return "".join(self.name(p.strip("`"), page) if i % 2 else escaped(p) for i, p in enumerate(parts))

    def name(self, text, page):
        if text.startswith("docs/"):
            return f"[{text}]({posixpath.relpath(text, posixpath.dirname(page))})"
        place = self.places.get(re.sub(r"\(\)$|\..*", "", text))
        if not place:
            return f"`{text}`"
        where = "" if place[0] == page else posixpath.relpath(place[0], posixpath.dirname(page))
        return f"[`{text}`]({where}#{place[1]})"

    def paragraphs(self, lines, page):
        """A comment as Markdown. Indented lines are formulas and tables, or terms with their explanations."""
        out, i = [], 0
        while i < len(lines):
            term = re.match(
                r"^  ([A-Z][a-z]+|VOX_\w+(?:\([^)]*\))?|vox_\w+|[a-z]+)(?: {2,}| (?=[A-Z]))(\S.*)", lines[i]
            )
            if term:
                text = [term[2]]
                while i + 1 < len(lines) and re.match(r"^ {9,}\S", lines[i + 1]):
                    i += 1
                    text.append(lines[i].strip())
                if out and out[-1].strip() and not out[-1].startswith("* "):
                    out.append("")
                title = self.words(term[1], page)
                out.append(f"* {title if '`' in title else f'**{title}.**'} {self.words(' '.join(text), page)}")
            elif re.match(r"^ {4,}\S", lines[i]):
                block = []
                while i < len(lines) and re.match(r"^ {4,}\S", lines[i]):
                    block.append(lines[i])
                    i += 1
                out += ["", "```text", *[line[4:] for line in block], "```", ""]
                continue
            else:
                line = self.words(lines[i].strip(), page)
                if out and out[-1].startswith("* ") and line:
                    out.append("")
                out.append(line)
            i += 1
        return re.sub(r"(^|[.)\"]\s)\s*(Errors(?: of all)?:)", r"\1\n\n**\2**", "\n".join(out)).strip()

    def described(self, name, page):
        if name in self.comments:
            return self.paragraphs(self.comments[name], page)
        if name in self.shared:
            return f"Described with {self.name(self.shared[name], page)}."
        if name.endswith("_flags"):
            return "Flags, combined with | in one number."
        if name.startswith("vox_default_"):
            return "The defaults."
        default = name.replace("vox_", "vox_default_", 1)
        return f"Settings; begin with {self.name(default, page)}()." if name.endswith("_desc") else ""

    # ---- declarations ----

    def function(self, function, page):
        stable = "" if function.get("stable", True) else ' <span class="vox-mark">experimental</span>'
        parts = [
            f"## `{function['name']}`{stable} {{ #{function['name']} }}",
            declaration(function),
            self.described(function["name"], page),
        ]
        rows = [(p["name"], said) for p in function["parameters"] if (said := self.pointer(p, page))]
        said = self.pointer(function["result"], page)
        if said:
            rows.append(("returns", said))
        if rows:
            parts.append(
                "\n".join(
                    [
                        "| parameter | what its type does not say |",
                        "|---|---|",
                        *[f"| `{name}` | {said} |" for name, said in rows],
                    ]
                )
            )
        return parts

    def pointer(self, member, page):
        """What the types of C do not say about a parameter, a field or a result."""
        if "pointers" not in member or member.get("kind") == "callback":
            return ""
        words = []
        length = member.get("length", 1)
        if length == "text":
            words.append("text that ends with a zero")
        elif length == "opaque":
            words.append("handed back, never looked at")
        elif length != 1:
            words.append(f"`{length}` elements")
        if member.get("nullable") is True:
            words.append("may be null")
        elif member.get("nullable") == "if empty":
            words.append("may be null if there are none")
        lifetime = member.get("lifetime")
        target = member.get("target", {})
        if isinstance(lifetime, list):
            words.append(self.until(lifetime, page, "valid" if member.get("direction") == "out" else "in use"))
        elif lifetime == "object":
            words.append("in use as long as what the call creates")
        if target.get("lifetime") == "owned":
            words.append("yours, until " + self.words(target["release"], page))
        elif isinstance(target.get("lifetime"), list):
            words.append(self.until(target["lifetime"], page, "what it points to is valid"))
        return "; ".join(words)

    def until(self, lifetime, page, verb):
        """Events that end it; the words for several are those of vox.h."""
        said = {
            "epoch": "the next step or change of the grid ([events](../README.md#events))",
            "rebind": "the mesh gets other positions ([events](../README.md#events))",
            "return": "the call that it was given to returns",
            "failure": "the next call that fails on the same thread",
        }
        return f"{verb} until " + " or ".join(said.get(event) or self.words(event, page) for event in lifetime)

    def struct(self, struct, page):
        parts = [f"## `{struct['name']}` {{ #{struct['name']} }}", self.described(struct["name"], page)]
        rows = []
        for field in struct["fields"]:
            text = self.words(field.get("doc", ""), page)
            if not text and field["name"] == "struct_size":
                text = "`sizeof` of this struct, as the program was compiled"
            said = self.pointer(field, page)
            text = (
                "; ".join(t for t in (said, text) if t) if said and not text else f"{text} ({said})" if said else text
            )
            array = "".join(f"[{n}]" for n in field.get("array", []))
            kind = re.sub(r"\[.*", "", field["type"]) + array
            rows.append((f"`{field['name']}`", self.type_link(kind, field, page), text))
        columns = 3 if any(row[2] for row in rows) else 2
        lines = [row[:columns] for row in [("field", "type", "meaning"), ("---",) * 3, *rows]]
        return parts + ["\n".join("| " + " | ".join(line) + " |" for line in lines)]

    def type_link(self, text, member, page):
        place = self.places.get(member.get("base", ""))
        name = self.name(member["base"], page) if place else ""
        return f"[`{text}`]({name.rsplit('(', 1)[1][:-1]})" if name else f"`{text}`"

    def enum(self, enum, page):
        rows = ["| name | value | meaning |", "|---|---|---|"]
        for value in enum["values"]:
            number = f"{value['value']:#x}" if enum["flags"] and value["value"] > 8 else value["value"]
            rows.append(
                f'| <span id="{value["name"]}"></span>`{value["name"]}` | {number} | {self.words(value["doc"], page)} |'
            )
        return [f"## `{enum['name']}` {{ #{enum['name']} }}", self.described(enum["name"], page), "\n".join(rows)]

    def callback(self, call, page):
        return [f"## `{call['name']}` {{ #{call['name']} }}", declaration(call), self.described(call["name"], page)]

    def other(self, thing, page):
        """An alias, an opaque type, an inline function, a constant."""
        code = self.statements.get(thing["name"], "")
        if "value" in thing:
            code = f"#define {thing['name']} {thing['value']}"
        elif code.startswith("static inline"):
            code = re.sub(r"^static inline ", "", code[: code.index("{")]).strip() + ";"
        text = self.described(thing["name"], page)
        beside = self.words(thing.get("doc", ""), page)
        if "value" in thing and beside and beside != " ".join(text.split()):
            text = f"{text}\n\n{beside}"
        return [f"## `{thing['name']}` {{ #{thing['name']} }}", f"```c\n{code}\n```" if code else "", text]

    # ---- pages ----

    def in_order(self, parsed):
        """(kind, declaration) of all that a header declares, as it stands there."""
        found = [(kind, thing) for kind in KINDS for thing in parsed[kind]]
        order = {name: i for i, name in enumerate(self.statements)}
        return sorted(found, key=lambda pair: order[pair[1]["name"]])

    def section(self, parsed, section, examples):
        page = f"reference/{parsed['name']}/{file_of(section)}"
        parts = [
            f'---\ntitle: "{section.capitalize()}"\n---',
            f"# {section.capitalize()}",
            f"`#include <vox/{parsed['name']}.h>`" + (" · Examples: " + ", ".join(examples) if examples else ""),
        ]
        if (parsed["name"], section) in self.comments:
            parts.append(self.paragraphs(self.comments[parsed["name"], section], page))
        for kind, thing in self.in_order(parsed):
            if thing["section"] == section:
                make = {
                    "functions": self.function,
                    "structs": self.struct,
                    "enums": self.enum,
                    "callbacks": self.callback,
                }.get(kind, self.other)
                parts += make(thing, page)
        return page, "\n\n".join(p for p in parts if p) + "\n"

    def header_page(self, parsed):
        page = f"reference/{parsed['name']}/README.md"
        parts = [
            f"---\ntitle: {parsed['name']}.h\n---",
            f"# {parsed['name']}.h",
            self.paragraphs(self.comments[parsed["name"]], page),
            f"The header itself: [`include/vox/{parsed['name']}.h`](../../include/vox/{parsed['name']}.h.md). Library: `{parsed['library']}`.",
            "## Sections",
        ]
        for section in parsed["sections"]:
            functions = [f for f in parsed["functions"] + parsed["inline"] if f["section"] == section["name"]]
            names = " ".join(self.name(f["name"], page) for f in functions)
            parts.append(f"**[{section['name'].capitalize()}]({file_of(section['name'])})** {names}")
        return page, "\n\n".join(parts) + "\n"

    def index(self):
        page = "reference/README.md"
        parts = [
            "---\ntitle: Reference\n---",
            "# Reference",
            "Everything that a program can call, from the comments of the public headers. Each header begins with the conventions "
            "that hold for all its functions: errors, structs, ownership, threads, units.",
            "| header | what it is | functions |\n|---|---|---|\n"
            + "\n".join(
                f"| [{h['name']}.h]({h['name']}/README.md) | {self.words(first_sentence(h['doc']), page)} | {len(h['functions'])} |"
                for h in self.api["headers"]
            ),
            "## Events { #events }",
            "A pointer that vox hands out lives until something ends it. Two words stand for lists of functions:",
            "\n".join(
                f"* **{word}**: " + ", ".join(self.name(n, page) for n in names)
                for word, names in self.api["events"].items()
                if isinstance(names, list)
            ),
            "## All names",
            "*In order of the alphabet.*",
        ]
        names = sorted(name for name in self.places if not name.isupper())
        parts.append(" · ".join(self.name(n, page) for n in names))
        return page, "\n\n".join(parts) + "\n"

    def pages(self, examples=None):
        """{path: Markdown}. `examples` are links for sections of vox.h."""
        found = dict([self.index()])
        for parsed in self.api["headers"]:
            found.update([self.header_page(parsed)])
            for section in parsed["sections"]:
                found.update([self.section(parsed, section["name"], (examples or {}).get(section["name"].split(":")[0], []))])
        return found

    def navigation(self):
        tree = ["reference/README.md"]
        for parsed in self.api["headers"]:
            pages = [f"reference/{parsed['name']}/{file_of(s['name'])}" for s in parsed["sections"]]
            tree.append({parsed["name"] + ".h": [f"reference/{parsed['name']}/README.md", *pages]})
        return {"Reference": tree}


def first_sentence(text):
    text = re.sub(r"^\w+: ", "", text)
    return text.split(". ")[0].rstrip(".") + "."


def things_of(parsed):
    for kind in KINDS:
        yield from parsed[kind]


def declaration(function):
    result = function["result"]["type"]
    parameters = []
    for p in function["parameters"]:
        name = p["name"]
        kind = re.sub(r"(\[\w+\])+$", "", p["type"])
        array = p["type"][len(kind) :]
        parameters.append(f"{kind} {name}{array}" if "(*)" not in kind else kind.replace("(*)", f"(*{name})"))
    line = f"{result} {function['name']}({', '.join(parameters) or 'void'});"
    if len(line) > WIDTH:
        line = f"{result} {function['name']}(\n    " + ",\n    ".join(parameters) + ");"
    return f"```c\n{line}\n```"
