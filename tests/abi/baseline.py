"""Compares the libraries' binary interface with the checked-in descriptions, NAME.abi, by libabigail's abidiff; or writes these
anew. More functions and enumerators are no difference; a struct that grew is one, to be looked at: it may if it begins with
struct_size and grew at its end.
What is compared is compiled here: the sources that define what is exported, with debug information and without optimisation,
linked without the code below them, which is most of a library and none of its interface.
usage: baseline.py COMPILER [--renew]"""

import glob
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
sys.path.append(os.path.join(ROOT, "bindings", "generator"))
import header  # noqa: E402

INCLUDE = os.path.join(ROOT, "include", "vox")
# Folders of src/, and headers.
LIBRARIES = {"vox": (["api", "base"], ["vox", "vox_query", "vox_cell_size", "vox_surface"]), "vox_io": (["io"], ["vox_io"]), "vox_sim": (["sim"], ["vox_sim"]),
             "vox_dist": (["dist"], ["vox_dist"])}


def sources(name):
    """Those that define a function of the headers."""
    folders, headers = LIBRARIES[name]
    functions = [f.name for h in headers for f in header.read(os.path.join(INCLUDE, h + ".h")).of_kind("function")]
    defines = re.compile(rf"^\w[\w *]*\b(?:{'|'.join(functions)})\(", re.M)
    for folder in folders:
        for path in sorted(glob.glob(os.path.join(ROOT, "src", folder, "**", "*.cpp"), recursive=True)):
            with open(path, encoding="utf-8") as file:
                if defines.search(file.read()):
                    yield path


def build(name, compiler, folder):
    """The interface as a shared library."""
    with open(os.path.join(INCLUDE, "vox.h"), encoding="utf-8") as file:
        version = re.search(r"^#define VOX_ABI_VERSION (\d+)$", file.read(), flags=re.M)[1]
    eigen = subprocess.run(["pkg-config", "--cflags-only-I", "eigen3"], check=True, capture_output=True, text=True).stdout
    together = os.path.join(folder, name + ".cpp")
    with open(together, "w", encoding="utf-8") as file:
        file.write("".join(f'#include "{path}"\n' for path in sources(name)))
    library = os.path.join(folder, f"lib{name}.so")
    export_map = glob.glob(os.path.join(ROOT, "src", "**", name + ".map"), recursive=True)[0]
    subprocess.run([compiler, "-std=c++20", "-O0", "-g", "-fPIC", "-fvisibility=hidden", "-fvisibility-inlines-hidden", "-DVOX_BUILD",
                    f"-I{ROOT}/src", f"-I{ROOT}/include", *eigen.replace("-I", "-isystem").split(), together, "-shared",
                    f"-Wl,-soname,lib{name}.so.{version},--version-script,{export_map}", "-o", library], check=True)
    return library


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
    compiler, renew = sys.argv[1], "--renew" in sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as threads:
        libraries = dict(zip(LIBRARIES, threads.map(lambda name: build(name, compiler, folder), LIBRARIES)))
        if not renew:
            return 0 if all([compare(*library) for library in libraries.items()]) else 1
        for name, library in libraries.items():
            with open(os.path.join(HERE, name + ".abi"), "w", encoding="utf-8") as file:
                file.write(describe(library))
        return 0


if __name__ == "__main__":
    sys.exit(main())
