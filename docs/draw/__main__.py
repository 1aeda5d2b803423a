#!/usr/bin/env python3
"""Draws docs/drawings/NAME.svg, each by the module of its name, in light and in dark.

usage: VOXTET_LIBRARY_DIR=BUILD_FOLDER python3 docs/draw [--check] [NAME...]

--check fails where a picture is not what its module draws; it ends with 77 where numpy, the libraries or the tool are missing."""

import argparse
import importlib
import os
import re
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
PICTURES = os.path.join(os.path.dirname(FOLDER), "drawings")
NAMES = sorted(name[:-3].replace("_", "-") for name in os.listdir(FOLDER)
               if name.endswith(".py") and name not in ("__main__.py", "canvas.py"))
NUMBER = re.compile(r"-?\d*\.?\d+")
DEBIAN = "/usr/bin/python3"  # has numpy where another Python that comes first may have none


def drawn(name):
    return importlib.import_module(name.replace("-", "_")).drawn().svg()


def same(a, b):
    """Whether two pictures differ by no more than a last digit: another processor may round otherwise."""
    pairs = zip(NUMBER.findall(a), NUMBER.findall(b))
    return NUMBER.sub("#", a) == NUMBER.sub("#", b) and all(abs(float(x) - float(y)) < .11 for x, y in pairs)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(NAMES))
    options = parser.parse_args()
    stale = []
    for name in options.names or NAMES:
        path = os.path.join(PICTURES, name + ".svg")
        try:
            picture = drawn(name)
        except (ImportError, FileNotFoundError) as missing:
            if missing.args and "numpy" in str(missing) and sys.executable != DEBIAN and os.path.exists(DEBIAN):
                os.execv(DEBIAN, [DEBIAN, "-B", *sys.argv])
            print(f"{name} is not drawn:", missing)
            sys.exit(77 if options.check else 1)
        if not options.check:
            with open(path, "w", encoding="utf-8", newline="\n") as file:
                file.write(picture)
            continue
        with open(path, encoding="utf-8") as file:
            stale += [] if same(file.read(), picture) else [name]
    if stale:
        sys.exit(f"docs/draw draws another picture of {', '.join(stale)}: ./dev picture draws them again")


if __name__ == "__main__":
    main()
