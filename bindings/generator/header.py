"""Reads a public header: its functions, types and constants, each with the comment right above or beside it. Knows the C
that these headers use, and fails on any other."""

import re
from dataclasses import dataclass, field

class Member(tuple):
    """(type, name) of a parameter, a field or a result, which has no name."""

    def __new__(cls, type_text, name, optional=False, comment=""):
        member = super().__new__(cls, (type_text, name))
        member.optional, member.comment = optional, comment  # optional: VOX_OPTIONAL
        return member


@dataclass
class Declaration:
    kind: str  # function, struct, enum, opaque, callback, alias, inline
    name: str
    comment: str
    line: int
    section: str
    stable: bool = True  # VOX_API, not VOX_EXPERIMENTAL
    result: str = ""  # of a function or callback; what an alias stands for
    parameters: list = field(default_factory=list)  # Members
    fields: list = field(default_factory=list)  # Members of a struct; names alone, of an enum
    values: list = field(default_factory=list)  # (name, number, comment) of an enum
    optional: bool = False  # its result
    inside: str = ""  # the comments of its fields or enumerators
    inherited: str = ""  # comments of those before it, where its own says "The same ..."


@dataclass
class Header:
    conventions: str  # the comment that the file begins with
    sections: dict  # name: the comments that stand by themselves in it
    declarations: list
    constants: dict  # numbers that are #defined, by name: the comment above or beside
    numbers: dict = field(default_factory=dict)  # the same: (number, section)

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


def split_parameter(text, comment=""):
    """The name of a function pointer is inside its type."""
    text = text.strip()
    optional = text.startswith("VOX_OPTIONAL ")
    text = text.removeprefix("VOX_OPTIONAL ").replace("const struct vox_", "const vox_")
    pointer = re.fullmatch(r"(.*\(\*)(\w+)(\)\s*\(.*\))", text)
    if pointer:
        return Member(pointer[1] + pointer[3], pointer[2], optional, comment)
    match = re.fullmatch(r"(.*?[\s*])(\w+)((?:\[\w+\])*)", text)
    if not match or "VOX_" in match[1]:
        raise ValueError(f"cannot read the declaration '{text}'")
    return Member(match[1].strip() + match[3], match[2], optional, comment)


def split_list(text):
    """At the commas that are in no parentheses."""
    parts, depth = [""], 0
    for letter in text:
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return parts


def parameters_of(text):
    return [] if text.strip() in ("", "void") else [split_parameter(p) for p in split_list(text)]


def members_of(body, separator):
    """(text, comment) of each field or enumerator: the comment above it, or beside it on its line."""
    members, text, above = [], "", ""
    at, last_end = 0, 0
    for token in re.finditer(rf"/\*.*?\*/|{separator}", body, flags=re.S):
        text += body[at:token.start()]
        at = token.end()
        if token[0] == separator:
            members.append([text, above])
            text, above, last_end = "", "", token.end()
        elif text.strip():  # behind the last enumerator, which has no comma
            above = (above + " " + words_of(token[0])).strip()
        elif members and "\n" not in body[last_end:token.start()]:
            members[-1][1] = (members[-1][1] + " " + words_of(token[0])).strip()
        else:
            above = words_of(token[0])
    text += body[at:]
    if text.strip():
        members.append([text, above])
    return [(" ".join(text.split()), comment) for text, comment in members if text.strip()]


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
        constant = re.match(r"#define (VOX_\w+) \(?(-?[0-9.x]\w*)\)?", code)
        if constant and not constant[1].startswith("VOX_VERSION"):
            header.constants[constant[1]] = comments_in(statement) or (words_of(above) if above else "")
            header.numbers[constant[1]] = (int(constant[2].rstrip("u"), 0), section)
        if code.startswith("#"):
            continue
        comment = words_of(above) if above else ""
        optional = re.match(r"(VOX_API|VOX_EXPERIMENTAL) VOX_OPTIONAL ", code)
        if optional:
            code = optional[1] + code[optional.end() - 1:]
        new = None
        function = re.fullmatch(r"(VOX_API|VOX_EXPERIMENTAL) (.+?[ *])(\w+)\((.*)\);", code)
        struct = re.fullmatch(r"typedef (struct|enum) (\w+) \{(.*)\} (\w+);", code)
        callback = re.fullmatch(r"typedef (.+?[ *])(vox_\w+)\((.*)\);", code)
        body = statement[statement.find("{") + 1: statement.rfind("}")]
        if function:
            new = Declaration("function", function[3], comment, line, section, function[1] == "VOX_API",
                              function[2].strip(), parameters_of(function[4]),
                              optional=optional is not None)
        elif struct and struct[1] == "struct":
            fields = [split_parameter(*member) for member in members_of(body, ";")]
            new = Declaration("struct", struct[2], comment, line, section, fields=fields)
        elif struct:
            values = [(*(part.strip() for part in text.split("=")), words) for text, words in members_of(body, ",")]
            values = [(name, int(number, 0), words) for name, number, words in values]
            new = Declaration("enum", struct[2], comment, line, section, fields=[v[0] for v in values], values=values)
        elif re.fullmatch(r"typedef struct (\w+) \1;", code):
            new = Declaration("opaque", code.split()[2], comment, line, section)
        elif callback:
            new = Declaration("callback", callback[2], comment, line, section, result=callback[1].strip(),
                              parameters=parameters_of(callback[3]))
        elif re.fullmatch(r"typedef \w+ \w+;", code):
            new = Declaration("alias", code[:-1].split()[2], comment, line, section, result=code.split()[1])
        elif code.startswith("static inline"):
            # Of vox_default_X the fields that it sets, beside struct_size: "substeps" or "gravity[2]".
            sets = re.findall(r"\b\w+\.(\w+(?:\[\d\])?) = ([^;]+);", body)
            new = Declaration("inline", re.search(r"(\w+)\(", code)[1], comment, line, section,
                              fields=[s for s in sets if s[0] != "struct_size"])
        elif re.fullmatch(r"typedef char \w+\[.+\];", code):
            continue  # checked by the compiler, of no use to anyone
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
