#!/usr/bin/env python3
"""The version of vox, and every file that has to name it.

usage: version.py              prints the version; fails where a file names another
       version.py --set X.Y.Z  writes it into include/vox/vox.h and all others

include/vox/vox.h is where it is written; CMake, the Python package and the source drop read it there. The tools that read
the files below want it written down.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEADER = "include/vox/vox.h"
# File, and the expressions whose one group each is the version.
NAMED = {
    "bindings/csharp/package.json": [r'"version": "(.*)"'],
    "bindings/js/package.json": [r'"version": "(.*)"'],
    "bindings/rust/Cargo.toml": [r'^version = "(.*)"'],
    "bindings/rust/voxtet/Cargo.toml": [r'"../voxtet-sys", version = "(.*)"'],
}


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


def version():
    """As include/vox/vox.h says it: "X.Y.Z"."""
    header = read(HEADER)
    return ".".join(re.search(rf"#define VOX_VERSION_{part} (\d+)", header)[1] for part in ("MAJOR", "MINOR", "PATCH"))


def mistakes():
    """Of each file that does not name this version once for every expression: what it names."""
    right, wrong = version(), []
    for path, expressions in NAMED.items():
        for expression in expressions:
            found = re.findall(expression, read(path), flags=re.MULTILINE)
            if found != [right]:
                wrong.append(f"{path}: {expression} is {found}, not {right}")
    return wrong


def write(path, text):
    with open(ROOT / path, "w", encoding="utf-8", newline="\n") as file:
        file.write(text)


def set_version(new):
    header = read(HEADER)
    for part, number in zip(("MAJOR", "MINOR", "PATCH"), new.split(".")):
        header = re.sub(rf"(#define VOX_VERSION_{part} )\d+", rf"\g<1>{number}", header)
    write(HEADER, header)
    for path, expressions in NAMED.items():
        text = read(path)
        for expression in expressions:
            text = re.sub(expression, lambda m: m[0].replace(m[1], new), text, flags=re.MULTILINE)
        write(path, text)


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "--set" and re.fullmatch(r"\d+\.\d+\.\d+", sys.argv[2]):
        set_version(sys.argv[2])
        print("next: ./dev generate, and the heading of CHANGELOG.md")
    elif len(sys.argv) != 1:
        sys.exit(__doc__)
    wrong = mistakes()
    if wrong:
        sys.exit("\n".join(wrong))
    print(version())


if __name__ == "__main__":
    main()
