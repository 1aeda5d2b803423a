"""Compares built libraries with the checked-in descriptions of their binary interface, NAME.abi, by libabigail's abidiff;
or writes these anew. More functions and enumerators are no difference; a struct that grew is one, to be looked at: it may
if it begins with struct_size and grew at its end. The libraries need debug information.
usage: baseline.py FOLDER [--renew], the folder with libvox.so and the others somewhere in it"""

import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
INCLUDE = os.path.join(HERE, "..", "..", "include", "vox")
LIBRARIES = ["vox", "vox_io", "vox_sim", "vox_dist"]


def find(folder, name):
    for path, _, files in os.walk(folder):
        if name in files:
            return os.path.join(path, name)
    sys.exit(f"baseline.py: no {name} in {folder}")


def describe(library):
    done = subprocess.run(["abidw", "--drop-private-types", "--exported-interfaces-only", "--no-show-locs",
                           "--headers-dir", INCLUDE, "--no-corpus-path", "--no-comp-dir-path",
                           "--no-elf-needed", "--no-write-default-sizes",
                           "--no-parameter-names", library], check=True, capture_output=True, text=True)
    return re.sub(r" path='[^']*/", " path='", done.stdout)  # file names alone: where they lie does not matter


def compare(name, library):
    # Not told which types are private: then it would overlook changes of public ones. What vox_grid is inside is in
    # the library but not in the baseline, which is no difference.
    done = subprocess.run(["abidiff", "--no-show-locs", "--no-added-syms", os.path.join(HERE, name + ".abi"), library])
    if done.returncode == 0:
        print(f"lib{name}: as in the baseline, new functions aside")
    return done.returncode == 0


def main():
    folder, renew = sys.argv[1], "--renew" in sys.argv[2:]
    if renew:
        for name in LIBRARIES:
            with open(os.path.join(HERE, name + ".abi"), "w", encoding="utf-8") as file:
                file.write(describe(find(folder, f"lib{name}.so")))
        return 0
    return 0 if all([compare(name, find(folder, f"lib{name}.so")) for name in LIBRARIES]) else 1


if __name__ == "__main__":
    sys.exit(main())
