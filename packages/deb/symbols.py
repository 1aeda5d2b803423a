#!/usr/bin/env python3
"""debian/PACKAGE.symbols: the symbols of each library, and the version in which each of them came.

usage: symbols.py --check    fails where a function of the public headers is missing, or one is listed that is none
       symbols.py --renew    writes new functions with the present version, and keeps the versions of the others

The functions are those of bindings/api.json and of vox_dist.h, which no binding is generated of. Whether the libraries have
them, dpkg-gensymbols checks when they are packaged.
"""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "packages"))
from public_functions import description, public_functions  # noqa: E402


def symbols(text):
    """Each symbol with its version, of the text of a symbols file."""
    return dict(line.removeprefix(" ").split("@Base ") for line in text.splitlines() if line.startswith(" "))


def main():
    if sys.argv[1:] not in (["--check"], ["--renew"]):
        sys.exit(__doc__)
    api = description()
    wrong = []
    for name_of_library, names in public_functions().items():
        library, package = f"lib{name_of_library}", f"lib{name_of_library}{api['abi_version']}".replace("_", "-")
        path = HERE / "debian" / f"{package}.symbols"
        had = path.read_text(encoding="ascii") if path.exists() else ""
        since = symbols(had)
        text = f"{library}.so.{api['abi_version']} {package} #MINVER#\n* Build-Depends-Package: libvox-dev\n" + "".join(
            f" {name}@Base {since.get(name, api['version'])}\n" for name in sorted(names))
        if text == had:
            continue
        if sys.argv[1] == "--renew":
            path.write_text(text, encoding="ascii")
        else:
            wrong.append(f"{path.relative_to(ROOT)}: " + ", ".join(sorted(since.keys() ^ symbols(text).keys()) or ["another ABI"]))
    if wrong:
        sys.exit("\n".join(wrong) + "\nTo write them again: packages/deb/symbols.py --renew")


if __name__ == "__main__":
    main()
