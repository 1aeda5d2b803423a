#!/usr/bin/env python3
"""Does vox choose good cell sizes for grids that are not its own? Times them, and says what each way of choosing loses.

usage: foreign.py LIBVOX [--docs] [--seconds 150] [--meshes FOLDER] [--grids sorted,warp,...] [--out build/foreign] [--known]

    python3 -m venv build/foreign/venv
    build/foreign/venv/bin/pip install -r bench/foreign/requirements.txt
    build/foreign/venv/bin/python bench/foreign/foreign.py build/release/src/libvox.so --docs

LIBVOX is the shared library of vox. The tables are printed, and the picture is written beside the curves; with --docs they
go to docs/evidence/foreign-grids.md and docs/evidence/foreign-grids.svg. --meshes takes the bodies of a folder (.msh) instead of generated ones:
a check. --known also prints the weights that are shipped, fitted anew (a few minutes more). c++, or what $CXX names,
compiles the plain grids."""

import argparse
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


# What a run frees stays with the process, so that no run pays for the pages that another one gave back.
KEEP_PAGES = {"MALLOC_MMAP_MAX_": "0", "MALLOC_TRIM_THRESHOLD_": str(1 << 40)}


def program(name, *arguments):
    subprocess.run([sys.executable, "-B", os.path.join(HERE, name), *arguments], check=True, env={**os.environ, **KEEP_PAGES})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("libvox")
    parser.add_argument("--docs", action="store_true")
    parser.add_argument("--known", action="store_true")
    parser.add_argument("--seconds", default="150", help="of all timed runs")
    parser.add_argument("--out", default=os.path.join(ROOT, "build", "foreign"))
    for name in ("--meshes", "--grids", "--scale"):
        parser.add_argument(name)
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    plain, curves, primitives = (os.path.join(options.out, name) for name in ("libplain_grids.so", "curves.json", "primitives"))
    subprocess.run([os.environ.get("CXX", "c++"), "-std=c++20", "-O3", "-shared", "-fPIC", os.path.join(HERE, "plain_grids.cpp"),
                    "-o", plain], check=True)
    given = [text for name in ("meshes", "grids", "scale") if getattr(options, name) for text in ("--" + name, getattr(options, name))]
    program("measure.py", plain, curves, "--seconds", options.seconds, "--primitives", primitives, *given)
    picture = os.path.join(ROOT, "docs", "evidence", "foreign-grids.svg") if options.docs else os.path.join(options.out, "foreign-grids.svg")
    page = ["--page", os.path.join(ROOT, "docs", "evidence", "foreign-grids.md")] if options.docs else []
    program("evaluate.py", curves, options.libvox, "--primitives", primitives, "--picture", picture,
            "--report", os.path.join(options.out, "report.json"), *page)
    if options.known:
        program("fit_known.py", curves)


if __name__ == "__main__":
    main()
