#!/usr/bin/env python3
"""Doxygen's view of the public headers and of README.md: turns plain C comments into its own kind, so that the headers
stay plain to read. A comment right above a declaration, or behind a field, belongs to it; a line of the form
/* ---- name ---- */ begins a group, and a comment with a blank line under it describes the group. Fields that share a comment
refer to it. Nothing is made up for functions, types and constants: without a comment they stay undocumented, which is
an error (Doxyfile).

usage: filter.py FILE > what Doxygen reads
"""

import os
import re
import sys

COMMENT = re.compile(r"/\*(.*?)\*/", re.S)
FIELD = re.compile(r"^ {4}(?:VOX_OPTIONAL )?(?:const )?(\w+)(?: const)?[ *]+(?:(\w+)(?:\[\w+\])*|\(\*(\w+)\)\(.*\));$")

# What a field's name alone says: the same in all structs.
BY_NAME = {
    "struct_size": "sizeof of this struct, as the program was compiled with it: see the conventions.",
    "reserved": "0.",
    "user": "Handed back to the functions.",
}


def escaped(text):
    for plain, html in [("\\", "\\\\"), ("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ("@", "\\@"), ("#", "\\#"), ("$", "\\$"),
                        ("%", "\\%"), ('"', '\\"'), ("*", "\\*")]:
        text = text.replace(plain, html)
    return re.sub(r"::", "\\::", text)


def words_of(comment):
    """The text of a comment, without the stars at the beginnings of lines, in paragraphs."""
    lines = [re.sub(r"^\s*\*? ?", "", line).rstrip() for line in comment.strip("\n").split("\n")]
    return "\n".join(lines).strip()


def paragraphs(comment):
    """Escaped text without hanging indents, which Doxygen would take for code."""
    return "\n".join(escaped(line.strip()) for line in words_of(comment).split("\n"))


def conventions(comment, name):
    """The comment that a header begins with: topics of it become a list."""
    lines = []
    for line in words_of(comment).split("\n"):
        topic = re.match(r"^ *([A-Z]\w+)(?: {2,}| (?=[A-Z]))(.*)", line) if line.startswith("  ") else None
        if topic and topic[1] in ("Errors", "Structs", "Ownership", "Threads", "Units"):
            lines.append(f"- **{topic[1]}.** {escaped(topic[2])}")
        else:
            lines.append(("  " if lines and lines[-1].startswith(("- ", "  ")) else "") + escaped(line.strip()))
    return f"/** \\file {name}\n" + "\n".join(lines) + "\n*/"


def header(text, name):
    out, place, group = [], 0, None
    for match in COMMENT.finditer(text):
        code = text[place:match.start()]
        out.append(code)
        place = match.end()
        before = text[text.rfind("\n", 0, match.start()) + 1:match.start()].strip()
        after = text[match.end():text.find("\n", match.end())].strip()
        below = text[match.end() + 1:].split("\n", 1)[0].strip() if not after else after
        heading = re.fullmatch(r" -{4} (.+?) -+ ", match[1])
        if match.start() == 0:
            out.append(conventions(match[1], name))
        elif heading:
            stem = re.sub(r"\W+", "_", f"{name[:-2]}_{heading[1]}")
            out.append(("/** \\} */\n" if group else "") + f"/** \\defgroup {stem} {name}: {heading[1]}\n\\{{ */")
            group = stem
        elif before and not before.endswith("{") and not after:
            out.append(f"/**< {paragraphs(match[1])} */")
        elif not before and below:
            out.append(f"/** {paragraphs(match[1])} */")
        elif not before and group:
            out.append(f"/** \\}} */\n/** \\addtogroup {group}\n{paragraphs(match[1])}\n\\{{ */")
        else:
            out.append(match[0])
    out.append(text[place:])
    text = "".join(out)
    if group:
        end = text.rfind("#ifdef __cplusplus")
        text = text[:end] + "/** \\} */\n" + text[end:]
    return fields(text)


def fields(text):
    """Says of a field without a comment what its name or its type says everywhere, or that its struct's comment speaks of
    it; of a struct or an enum whose fields alone have comments, what it is for."""
    lines = text.split("\n")
    struct, has_comment = "", False
    for i, line in enumerate(lines):
        begins = re.match(r"^typedef (struct|enum) (\w+) \{", line)
        before = lines[max(0, i - 40):i]
        above = re.search(r"/\*\*(?!<)(?:(?!\*/).)*\*/\Z", "\n".join(before), flags=re.S) is not None
        if begins:
            struct, has_comment = begins[2], above
            body = "\n".join(lines[i:]).split("\n}", 1)[0]
            if not above and "/**" in body:
                lines[i] = f"/** {kind_of(*begins.groups())} */\n{line}"
        elif line.startswith("#define VOX_VERSION_"):
            lines[i] = line + " /**< Of the version that the header belongs to. */"
        # The parameters of a function may go on in a second line.
        field = FIELD.match(line) or line.startswith(8 * " ") and FIELD.match(lines[i - 1] + line.strip())
        if not field or above:
            continue
        kind, name = field[1], field[2] or field[3]
        if name in BY_NAME:
            lines[i] = f"{line} /**< {BY_NAME[name]} */"
        elif kind.startswith("vox_"):
            lines[i] = f"{line} /**< See {kind}. */"
        else:
            lines[i] = f"{line} /**< See the comment of {struct if has_comment else 'the fields beside it'}. */"
    return "\n".join(lines)


def kind_of(kind, name):
    if kind == "enum":
        return "Flags, combined with | in one number." if name.endswith("_flags") else "One of the values below."
    return f"Settings; begin with {name.replace('vox_', 'vox_default_', 1)}." if name.endswith("_desc") else "Its fields are described below."


def readme(text):
    """Links into the repository become their texts: the pages stand alone. Pictures are found by IMAGE_PATH."""
    text = re.sub(r"!\[([^\]]*)\]\((?:[\w-]+/)*([\w.-]+)\)", r"![\1](\2)", text)
    return re.sub(r"(?<!!)\[([^\]]*)\]\((?![a-z]+:)[^)]*\)", r"\1", text)


def filtered(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    return readme(text) if path.endswith(".md") else header(text, os.path.basename(path))


if __name__ == "__main__":
    sys.stdout.write(filtered(sys.argv[1]))
