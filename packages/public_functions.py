"""The public functions of each shared library, by the description of the bindings and, for vox_dist, which no binding is generated
of, by its header."""
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bindings/generator"))
import header  # noqa: E402


def description():
    return json.loads((ROOT / "bindings/api.json").read_text(encoding="utf-8"))


def public_functions():
    """Names of functions by the name of their library, which may have several headers."""
    functions = {}
    for part in description()["headers"]:
        functions.setdefault(part["library"], []).extend(f["name"] for f in part["functions"])
    parsed = header.parse((ROOT / "include/vox/vox_dist.h").read_text(encoding="utf-8"))
    functions["vox_dist"] = [f.name for f in parsed.of_kind("function")]
    return functions
