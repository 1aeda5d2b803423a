"""Names in the style of a language, from those of C."""

import re
import textwrap

GENERATED = "Written by bindings/generate.py from bindings/api.json. Do not edit."


def words(name):
    """Without the prefix of the library: vox_io_mesh_view gives io mesh view."""
    return [w for w in re.sub(r"^vox_", "", name.lower()).split("_") if w]


def pascal(name):
    return "".join(w.capitalize() for w in words(name))


def camel(name):
    first, *others = name.split("_")
    return first + "".join(w.capitalize() for w in others)


def short_values(enum):
    """(name without the words that it shares with all others and with the enum, number, comment): VOX_LOG_INFO of
    vox_log_level gives INFO."""
    split = [v["name"].split("_") for v in enum["values"]]
    common, known = 1, words(enum["name"])  # after VOX
    while all(len(s) > common + 1 and s[common] == split[0][common] for s in split) and split[0][common].lower() in known:
        common += 1
    for value, parts in zip(enum["values"], split):
        name = "_".join(parts[common:])
        yield f"{parts[common - 1]}_{name}" if name[0].isdigit() else name, value["value"], value["doc"]


def sections(api, kind):
    """All declarations of a kind, in the order of the headers."""
    return [d for part in api["headers"] for d in part[kind]]


def first_sentence(doc):
    """Of a comment, for languages whose users read the rest in the header."""
    match = re.match(r".*?[.](?= [A-Z`*]|$)", doc)
    return match[0] if match else doc


def wrapped(doc, prefix, width=120, further=None):
    """Lines that begin with `prefix`, those after the first with `further`, if it is given."""
    return textwrap.wrap(doc, width, initial_indent=prefix, subsequent_indent=prefix if further is None else further,
                         break_long_words=False, break_on_hyphens=False)


def whole_structs(api):
    """Structs that lie the same in memory on every machine: no pointers and no size_t, neither directly nor inside."""
    found = set()
    for struct in sections(api, "structs"):
        if all(f["kind"] != "function" and "pointers" not in f and f["base"] != "size_t"
               and (f["kind"] != "struct" or f["base"] in found) for f in struct["fields"]):
            found.add(struct["name"])
    return found

