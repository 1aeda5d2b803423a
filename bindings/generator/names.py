"""Names in the style of a language, from those of C."""

import os
import re
import textwrap

GENERATED = "Written by bindings/generate.py from bindings/api.json. Do not edit."


def words(name):
    """Without the prefix of the library: vox_io_mesh_view gives io mesh view."""
    return [w for w in re.sub(r"^vox_", "", name.lower()).split("_") if w]


def pascal(name):
    return "".join(w.capitalize() for w in words(name))


def short_values(enum):
    """(name without what all enumerators begin with, number, comment): VOX_LOG_INFO gives INFO."""
    names = [v["name"] for v in enum["values"]]
    prefix = os.path.commonprefix(names) if len(names) > 1 else ""
    if len(names) > 1:
        prefix = prefix[: prefix.rfind("_") + 1]
    else:
        prefix = "VOX_"
    for value in enum["values"]:
        yield value["name"][len(prefix):], value["value"], value["doc"]


def sections(api, kind):
    """All declarations of a kind, in the order of the headers."""
    return [d for part in api["headers"] for d in part[kind]]


def first_sentence(doc):
    """Of a comment, for languages whose users read the rest in the header."""
    match = re.match(r".*?[.](?= [A-Z`*]|$)", doc)
    return match[0] if match else doc


def wrapped(doc, prefix, width=120):
    return [prefix + line for line in textwrap.wrap(doc, width - len(prefix), break_long_words=False)]


def whole_structs(api):
    """Structs that lie the same in memory on every machine: no pointers and no size_t, neither directly nor inside."""
    found = set()
    for struct in sections(api, "structs"):
        if all(f["kind"] != "function" and "pointers" not in f and f["base"] != "size_t"
               and (f["kind"] != "struct" or f["base"] in found) for f in struct["fields"]):
            found.add(struct["name"])
    return found

