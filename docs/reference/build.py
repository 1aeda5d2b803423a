#!/usr/bin/env python3
"""Makes the reference pages from the public headers with Doxygen; any warning is an error.

usage: build.py --out FOLDER [--doxygen PROGRAM]     writes FOLDER/html
       build.py --self-test [--doxygen PROGRAM]      a function whose comment was removed must be an error
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def build(doxygen, root, out):
    """The exit status of Doxygen and what it said."""
    os.makedirs(out, exist_ok=True)
    with open(os.path.join(root, "Doxyfile"), encoding="utf-8") as file:
        settings = file.read().replace("python3 docs/", f"{sys.executable} -B docs/")
    run = subprocess.run([doxygen, "-"], input=f"{settings}\nOUTPUT_DIRECTORY = \"{os.path.abspath(out)}\"\n", text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=root, check=False)
    return run.returncode, run.stdout


def self_test(doxygen):
    """Whether a missing comment, and a comment that names a parameter that is not there, are errors."""
    with tempfile.TemporaryDirectory() as root:
        for name in ("include", "docs/reference"):
            shutil.copytree(os.path.join(ROOT, name), os.path.join(root, name))
        for name in ("Doxyfile", "README.md"):
            shutil.copy(os.path.join(ROOT, name), root)
        for picture in os.listdir(os.path.join(ROOT, "docs")):
            if picture.endswith((".svg", ".png", ".gif")):
                shutil.copy(os.path.join(ROOT, "docs", picture), os.path.join(root, "docs"))
        header = os.path.join(root, "include", "vox", "vox.h")
        with open(header, encoding="utf-8") as file:
            text = file.read()
        broken, count = re.subn(r"/\*(?:(?!\*/).)*\*/\n(VOX_API vox_result vox_grid_step\()", r"\1", text, flags=re.S)
        assert count == 1, "vox.h has no comment above vox_grid_step"
        with open(header, "w", encoding="utf-8") as file:
            file.write(broken)
        status, said = build(doxygen, root, os.path.join(root, "out"))
        return status != 0 and "vox_grid_step" in said, said


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out")
    parser.add_argument("--doxygen", default="doxygen")
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    if options.self_test:
        noticed, said = self_test(options.doxygen)
        if not noticed:
            sys.exit("a public function without a comment was not noticed:\n" + said)
        return
    if not options.out:
        parser.error("--out is needed")
    status, said = build(options.doxygen, ROOT, options.out)
    sys.stdout.write(said)
    if status != 0:
        sys.exit(f"Doxygen failed with status {status}")
    print("written:", os.path.join(options.out, "html", "index.html"))


if __name__ == "__main__":
    main()
