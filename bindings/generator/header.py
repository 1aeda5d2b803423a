"""Reads a public header: its functions, types and constants, each with the comment right above it. Knows the C that
these headers use, and fails on any other."""

import re
from dataclasses import dataclass, field


@dataclass
class Declaration:
    kind: str  # function, struct, enum, opaque, callback, alias, inline
    name: str
    comment: str
    line: int
    section: str
    stable: bool = True  # VOX_API, not VOX_EXPERIMENTAL
    result: str = ""  # of a function or callback
    parameters: list = field(default_factory=list)  # (type, name)
    fields: list = field(default_factory=list)  # (type, name), of a struct; names alone, of an enum
    inside: str = ""  # the comments of its fields or enumerators
    inherited: str = ""  # comments of those before it, where its own says "The same ..."


@dataclass
class Header:
    conventions: str  # the comment that the file begins with
    sections: dict  # name: the comments that stand by themselves in it
    declarations: list
    constants: dict  # numbers that are #defined, by name: the comment above or beside

    def of_kind(self, *kinds):
        return [d for d in self.declarations if d.kind in kinds]

    def named(self, name):
        return next((d for d in self.declarations if d.name == name), None)


def plain(text):
    """Without comments, and with single blanks."""
    return " ".join(re.sub(r"/\*.*?\*/", " ", text, flags=re.S).split())


def comments_in(text):
    return " ".join(words_of(c) for c in re.findall(r"/\*.*?\*/", text, flags=re.S))


def words_of(comment):
    return " ".join(re.sub(r"^\s*\* ?", "", comment[2:-2], flags=re.M).split())


def split_parameter(text):
    """(type, name) of a parameter or field; the name of a function pointer is inside its type."""
    text = text.strip()
    pointer = re.fullmatch(r"(.*\(\*)(\w+)(\)\s*\(.*\))", text)
    if pointer:
        return (pointer[1] + pointer[3], pointer[2])
    match = re.fullmatch(r"(.*?[\s*])(\w+)((?:\[\w+\])*)", text)
    if not match:
        raise ValueError(f"cannot read the declaration '{text}'")
    return (match[1].strip() + match[3], match[2])


def parameters_of(text):
    return [] if text.strip() in ("", "void") else [split_parameter(p) for p in text.split(",")]


def statements(text):
    """(text, comment above, line) of each top-level statement, and of comments that stand by themselves ('', comment,
    line)."""
    at, comment, comment_end = 0, "", 0
    while at < len(text):
        if text[at].isspace():
            at += 1
            continue
        line = text.count("\n", 0, at) + 1
        if text.startswith("/*", at):
            end = text.index("*/", at) + 2
            if re.match(r"[ \t]*\n[ \t]*\n", text[end:]):
                yield "", text[at:end], line
            else:
                comment, comment_end = text[at:end], end
            at = end
            continue
        if text[at] == "#":
            end = text.index("\n", at)
            while text[end - 1] == "\\":
                end = text.index("\n", end + 1)
        else:
            end, depth = at, 0
            while True:
                if text.startswith("/*", end):
                    end = text.index("*/", end) + 2
                    continue
                depth += {"{": 1, "}": -1}.get(text[end], 0)
                end += 1
                if depth == 0 and text[end - 1] == ";":
                    break
                if depth == 0 and text[end - 1] == "}" and text.startswith("static inline", at):
                    break
        above = comment if text[comment_end:at].strip() == "" and text.count("\n", comment_end, at) == 1 else ""
        yield text[at:end], above, line
        comment, at = "", end


def parse(text):
    # Line counts stay right: blocks for C++ become blank lines.
    text = re.sub(r"#ifdef __cplusplus.*?#endif", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
    header = Header(text[: text.index("*/") + 2], {}, [], {})
    section = ""
    for statement, above, line in statements(text):
        if not statement:
            title = re.fullmatch(r"/\* -{4} (.+?) -{4,} \*/", above)
            if title:
                section = title[1]
                header.sections[section] = ""
            elif section:
                header.sections[section] += " " + words_of(above)
            continue
        code = plain(statement)
        constant = re.match(r"#define (VOX_\w+) \(?-?[0-9.x]+\w*\)?", code)
        if constant and not constant[1].startswith("VOX_VERSION"):
            header.constants[constant[1]] = (words_of(above) if above else "") + comments_in(statement)
        if code.startswith("#"):
            continue
        comment = words_of(above) if above else ""
        new = None
        function = re.fullmatch(r"(VOX_API|VOX_EXPERIMENTAL) (.+?[ *])(\w+)\((.*)\);", code)
        struct = re.fullmatch(r"typedef (struct|enum) (\w+) \{(.*)\} (\w+);", code)
        callback = re.fullmatch(r"typedef (.+?[ *])(vox_\w+)\((.*)\);", code)
        if function:
            new = Declaration("function", function[3], comment, line, section, function[1] == "VOX_API",
                              function[2].strip(), parameters_of(function[4]))
        elif struct and struct[1] == "struct":
            fields = [split_parameter(f) for f in struct[3].split(";") if f.strip()]
            new = Declaration("struct", struct[2], comment, line, section, fields=fields)
        elif struct:
            names = [e.split("=")[0].strip() for e in struct[3].split(",") if e.strip()]
            new = Declaration("enum", struct[2], comment, line, section, fields=names)
        elif re.fullmatch(r"typedef struct (\w+) \1;", code):
            new = Declaration("opaque", code.split()[2], comment, line, section)
        elif callback:
            new = Declaration("callback", callback[2], comment, line, section, result=callback[1].strip(),
                              parameters=parameters_of(callback[3]))
        elif re.fullmatch(r"typedef \w+ \w+;", code):
            new = Declaration("alias", code[:-1].split()[2], comment, line, section)
        elif code.startswith("static inline"):
            new = Declaration("inline", re.search(r"(\w+)\(", code)[1], comment, line, section)
        else:
            raise ValueError(f"line {line}: cannot read '{code[:80]}'")
        if comment.startswith("The same") and header.declarations:
            new.inherited = header.declarations[-1].comment + header.declarations[-1].inherited
        new.inside = comments_in(statement)
        header.declarations.append(new)
    return header


def read(path):
    with open(path, encoding="utf-8") as file:
        return parse(file.read())
