#!/usr/bin/env python3
"""Writes bindings/api.json from the public headers, and from that the low layer of each language. All are checked in.

usage: generate.py            writes them
       generate.py --check    fails, and names the files, if one is not what it would write"""

import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "generator"))
import describe  # noqa: E402
import to_csharp  # noqa: E402
import to_javascript  # noqa: E402
import to_python  # noqa: E402
import to_rust  # noqa: E402

LANGUAGES = [to_python, to_csharp, to_rust, to_javascript]


def files(texts=None):
    """Path under bindings/: text, of all files that are written."""
    text = describe.as_text(describe.describe(texts)) + "\n"
    found = {"api.json": text}
    for language in LANGUAGES:
        found.update(language.generate(json.loads(text)))
    return found


def differences(folder, texts=None):
    for path, text in files(texts).items():
        whole = os.path.join(folder, path)
        if not os.path.exists(whole):
            yield f"bindings/{path} is missing"
            continue
        with open(whole, encoding="utf-8") as file:
            if file.read() != text:
                yield f"bindings/{path} does not fit the headers"


def main():
    if sys.argv[1:] == ["--check"]:
        found = list(differences(HERE))
        if found:
            sys.exit("\n".join(found) + "\nTo write them again: ./dev generate")
        return
    if sys.argv[1:]:
        sys.exit(__doc__)
    for path, text in files().items():
        whole = os.path.join(HERE, path)
        os.makedirs(os.path.dirname(whole), exist_ok=True)
        with open(whole, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)


if __name__ == "__main__":
    try:
        main()
    except describe.Unclear as error:
        sys.exit(str(error))
