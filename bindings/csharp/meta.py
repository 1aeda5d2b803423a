#!/usr/bin/env python3
"""Writes NAME.meta beside every file and folder that Unity imports from this package: without them it ignores what is in a
package that cannot be written to. Unity finds assets again by the number in it, which is therefore made of the path.

usage: meta.py            writes them
       meta.py --check    fails, and names the files, if one is missing or too many"""

import hashlib
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
NOT_ASSETS = {"check", "meta.py"}  # programs of the repository; Unity skips names that end with ~ or begin with a dot


def assets(folder=""):
    for name in sorted(os.listdir(os.path.join(HERE, folder))):
        path = os.path.join(folder, name)
        if name.startswith(".") or name.endswith(("~", ".meta")) or path in NOT_ASSETS:
            continue
        yield path
        if os.path.isdir(os.path.join(HERE, path)):
            yield from assets(path)


def text_of(path):
    number = hashlib.md5(("org.voxtet/" + path.replace(os.sep, "/")).encode()).hexdigest()
    folder = "folderAsset: yes\n" if os.path.isdir(os.path.join(HERE, path)) else ""
    return f"fileFormatVersion: 2\nguid: {number}\n{folder}"


def main():
    wanted = {path + ".meta": text_of(path) for path in assets()}
    found = {}
    for folder, _, names in os.walk(HERE):
        for name in names:
            if name.endswith(".meta"):
                with open(os.path.join(folder, name), encoding="ascii") as file:
                    found[os.path.relpath(os.path.join(folder, name), HERE)] = file.read()
    if sys.argv[1:] == ["--check"]:
        wrong = sorted(path for path in wanted.keys() | found.keys() if wanted.get(path) != found.get(path))
        if wrong:
            sys.exit("not as Unity wants them: " + ", ".join(wrong) + "\nTo write them again: bindings/csharp/meta.py")
        return
    if sys.argv[1:]:
        sys.exit(__doc__)
    for path in found.keys() - wanted.keys():
        os.remove(os.path.join(HERE, path))
    for path, text in wanted.items():
        with open(os.path.join(HERE, path), "w", encoding="ascii", newline="\n") as file:
            file.write(text)


if __name__ == "__main__":
    main()
