#!/usr/bin/env python3
"""The source drop: all that the libraries are compiled from, without a build system and without dependencies.

usage: source_drop.py OUT [--core]    OUT: a folder that does not exist yet, or FILE.tar.xz. --core: without vox_io, vox_sim

It holds include/, src/, CMakeLists.txt and cmake/ of this repository, LICENSE, and in third_party/ the headers that the sources
include: Highway's and, for vox_io and vox_sim, Eigen's, with their licences. One line compiles the core:

    c++ -std=c++20 -O3 -DNDEBUG -DVOX_STATIC -ffp-contract=off -Iinclude -Isrc -Ithird_party -c $(cat core.txt)

`core.txt`, `io.txt` and `sim.txt` list the sources; vox_io is the one without pugixml, zlib and assimp. The same commit gives
the same bytes wherever the same versions of Highway and Eigen are installed.
"""
import argparse
import io
import pathlib
import re
import subprocess
import sys
import tarfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)
# What is taken along: the folder of the headers below an include folder, and where its licence lies.
THIRD_PARTY = {
    "hwy": ("/usr/include", ["/usr/share/doc/libhwy-dev/copyright"]),
    "Eigen": ("/usr/include/eigen3", ["/usr/share/doc/libeigen3-dev/copyright"]),
}
# Sources of vox_io that need libraries which are not headers alone; no_xml.cpp and no_assimp.cpp stand in for them.
NEED_LIBRARIES = {"src/io/formats/vtu.cpp", "src/io/formats/assimp.cpp"}
# Highway's headers include these by name, one for each set of instructions; a computed include names some of them.
ALWAYS = {"hwy": ["hwy/foreach_target.h", "hwy/highway.h"]}


def includes(text):
    return [quoted or angled for quoted, angled in INCLUDE.findall(text)]


def headers_of(folder, include_dir, sources):
    """The headers below include_dir/folder that the sources include, and those that these include in turn."""
    base = pathlib.Path(include_dir)
    wanted = [name for text in sources for name in includes(text) if name.startswith(folder + "/")]
    found, queue = {}, sorted({*wanted, *ALWAYS.get(folder, [])} if wanted else set())
    while queue:
        name = queue.pop()
        path = base / name
        if name in found or not path.is_file():
            continue
        text = path.read_text(errors="surrogateescape")
        found[name] = path.read_bytes()
        here = pathlib.PurePosixPath(name).parent
        for included in includes(text):
            for candidate in (included, str(here / included)):  # as a compiler looks it up: also beside the file
                resolved = re.sub(r"(^|/)(?!\.\.)[^/]+/\.\./", r"\1", candidate)
                if resolved.startswith(folder + "/") and resolved not in found:
                    queue.append(resolved)
    return found


def tracked(*paths):
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z", "--", *paths], check=True, capture_output=True)
    return [name for name in listed.stdout.decode().split("\0") if name]


def contents(core_only):
    """Every file of the drop: its name, and its bytes."""
    names = tracked("include/vox", "src", "cmake", "CMakeLists.txt", "LICENSE")
    if core_only:
        names = [name for name in names if not re.match(r"src/(io|sim)/|include/vox/vox_(io|sim)", name)]
    files = {name: (ROOT / name).read_bytes() for name in names}
    sources = {part: [] for part in ("core", "io", "sim")}
    for name in sorted(files):
        if name.endswith(".cpp") and name not in NEED_LIBRARIES:
            part = name.split("/")[1]
            sources[part if part in ("io", "sim") else "core"].append(name)
    texts = [data.decode() for name, data in files.items() if name.startswith("src/")]
    for folder, (include_dir, licences) in THIRD_PARTY.items():
        headers = headers_of(folder, include_dir, texts)
        if not headers:
            if any(include.startswith(folder + "/") for text in texts for include in includes(text)):
                sys.exit(f"source_drop.py: no headers of {folder} in {include_dir}")
            continue
        files.update({f"third_party/{name}": data for name, data in headers.items()})
        for licence in licences:
            files[f"third_party/{folder}/LICENSE"] = pathlib.Path(licence).read_bytes()
    for part, listed in sources.items():
        if listed:
            files[f"{part}.txt"] = "".join(f"{name}\n" for name in listed).encode()
    return files


def write_tar(path, files):
    made = int(subprocess.run(["git", "-C", str(ROOT), "log", "-1", "--format=%ct"], check=True, capture_output=True).stdout)
    stem = path.name.removesuffix(".tar.xz")
    with tarfile.open(path, "w:xz", format=tarfile.PAX_FORMAT) as tar:
        for name in sorted(files):
            entry = tarfile.TarInfo(f"{stem}/{name}")
            entry.size, entry.mtime, entry.mode = len(files[name]), made, 0o644
            tar.addfile(entry, io.BytesIO(files[name]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--core", action="store_true")
    options = parser.parse_args()
    if options.out.exists():
        sys.exit(f"source_drop.py: {options.out} exists already")
    files = contents(options.core)
    if options.out.name.endswith(".tar.xz"):
        write_tar(options.out, files)
    else:
        for name, data in files.items():
            path = options.out / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
    print(f"{options.out}: {len(files)} files, {sum(map(len, files.values())) / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
