#!/usr/bin/env python3
"""The source drop: all that the libraries are compiled from, without a build system and without dependencies.

usage: source_drop.py OUT [--core | --all]    OUT: a folder that does not exist yet, or FILE.tar.xz
vox_mpi is not in it, vox_dist only with --all. --core: without vox_io and vox_sim. --all: also the tool, the reader of .vtu and the Python package; what pip takes.

It holds include/, adapters/, src/, CMakeLists.txt and cmake/ of this repository, LICENSE, and in third_party/ what the sources include:
Highway's headers; for vox_io and vox_sim Eigen's; for vox_io those of nlohmann-json; for --all those of CLI11, and the sources of pugixml and
zlib (from Debian's source packages, build/third_party), each with its licence. One line compiles the core, and another links a
program with it:

    c++ -std=c++20 -O2 -DVOX_STATIC -ffp-contract=off -Iinclude -Isrc -Ithird_party -c all/core/*.cpp
    cc -DVOX_STATIC -Iinclude program.c *.o -lstdc++ -lm -pthread

The files of all/core, all/io and all/sim include the sources: those of a folder together, which takes half the time, and in one
file those that are compiled for each instruction set. CMake takes the drop too, and needs nothing else. The same commit gives the
same bytes wherever the same versions of the others' are installed.
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
    "hwy": ("/usr/include", "/usr/share/doc/libhwy-dev/copyright"),
    "Eigen": ("/usr/include/eigen3", "/usr/share/doc/libeigen3-dev/copyright"),
    "CLI": ("/usr/include", "/usr/share/doc/libcli11-dev/copyright"),
    "nlohmann": ("/usr/include", "/usr/share/doc/nlohmann-json3-dev/copyright"),
}
# Of other libraries, what the reader of .vtu needs: the Debian source package, its files and its licence.
SOURCES = {
    "pugixml": (["src/pugiconfig.hpp", "src/pugixml.hpp", "src/pugixml.cpp"], "LICENSE.md"),
    "zlib": (["adler32.c", "crc32.c", "crc32.h", "gzguts.h", "inffast.c", "inffast.h", "inffixed.h", "inflate.c", "inflate.h", "inftrees.c",
              "inftrees.h", "uncompr.c", "zconf.h", "zlib.h", "zutil.c", "zutil.h"], "LICENSE"),
}
# Sources of vox_io that need libraries which are not headers alone; no_xml.cpp and no_assimp.cpp stand in for them.
NEED_LIBRARIES = {"src/io/formats/unpack.cpp", "src/io/formats/vtu.cpp", "src/io/formats/assimp.cpp"}
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


def debian_sources(name):
    """The folder of a Debian source package, as its authors gave it out: in build/third_party, fetched once, as any user."""
    base = ROOT / "build" / "third_party"
    found = sorted(path for path in base.glob(f"{name}-*") if path.is_dir())
    if found:
        return found[-1]
    for folder in ("lists/partial", "cache/archives/partial", "parts"):
        (base / "apt" / folder).mkdir(parents=True, exist_ok=True)
    for listed in pathlib.Path("/etc/apt").glob("sources.list*/**/*.sources"):
        text = re.sub(r"^Types:.*$", "Types: deb-src", listed.read_text(), flags=re.MULTILINE)
        (base / "apt/parts" / listed.name).write_text(text)
    for listed in [pathlib.Path("/etc/apt/sources.list"), *pathlib.Path("/etc/apt/sources.list.d").glob("*.list")]:
        if listed.is_file():
            text = re.sub(r"^deb ", "deb-src ", listed.read_text(), flags=re.MULTILINE)
            (base / "apt/parts" / f"{listed.stem}.list").write_text(text)
    apt = base / "apt"
    options = [f"-oDir::State::lists={apt}/lists", f"-oDir::Cache={apt}/cache", f"-oDir::Etc::sourceparts={apt}/parts",
               "-oDir::Etc::sourcelist=/dev/null"]
    log = subprocess.DEVNULL
    subprocess.run(["apt-get", "-qq", *options, "update"], cwd=base, check=True, stdout=log)
    subprocess.run(["apt-get", "-qq", *options, "--download-only", "source", name], cwd=base, check=True, stdout=log)
    (archive,) = base.glob(f"{name}_*.orig.tar.*")
    subprocess.run(["tar", "-xf", archive.name], cwd=base, check=True)
    (folder,) = (path for path in base.glob(f"{name}-*") if path.is_dir())
    return folder


def compiled_together(part, sources):
    """Files that include the sources: those of a folder in one, and in one those that are compiled for each instruction set."""
    groups = {}
    for name, text in sources.items():
        path = pathlib.PurePosixPath(name.removeprefix("src/"))
        group = "each_target" if '#include "base/each_target.hpp"' in text else "_".join(path.parent.parts)
        groups.setdefault(f"all/{part}/{group}.cpp", []).append(f'#include "{path}"\n')
    each_target = f"all/{part}/each_target.cpp"
    if each_target in groups: # as vox_unity in cmake/vox_target.cmake; its path from any folder that headers are looked for in
        groups[each_target].insert(0, f"""#include "base/simd.hpp"
#define HWY_TARGET_INCLUDE "../{each_target}"
#include <hwy/foreach_target.h>
""")
    return {name: "".join(lines).encode() for name, lines in groups.items()}


def replaced(text, old, new):
    assert text.count(old) == 1, old
    return text.replace(old, new)


def contents(core_only, everything):
    """Every file of the drop: its name, and its bytes."""
    paths = ["include/vox", "adapters", "src", "cmake", "CMakeLists.txt", "LICENSE"]
    if everything:
        paths += ["tools", "web/viewer", "pyproject.toml", "bindings/python/CMakeLists.txt", "bindings/python/README.md", "bindings/python/src"]
    left_out = "mpi" if everything else "dist|mpi" # the Python package has vox_dist
    names = [name for name in tracked(*paths) if not re.match(rf"src/({left_out})/|include/vox/vox_({left_out})", name)]
    if core_only:
        names = [name for name in names if not re.match(r"src/(io|sim)/|include/vox/vox_(io|sim)", name)]
    files = {name: (ROOT / name).read_bytes() for name in names}
    if everything: # a pattern without a file is refused, so in a clone, which has no third_party/, it does not stand
        files["pyproject.toml"] = replaced(files["pyproject.toml"], b'license-files = ["LICENSE"]',
                                           b'license-files = ["LICENSE", "third_party/*/LICENSE"]')
    texts = {name: data.decode() for name, data in files.items() if name.startswith(("src/", "tools/"))}
    for folder, (include_dir, licence) in THIRD_PARTY.items():
        headers = headers_of(folder, include_dir, texts.values())
        if not headers:
            if any(include.startswith(folder + "/") for text in texts.values() for include in includes(text)):
                sys.exit(f"source_drop.py: no headers of {folder} in {include_dir}")
            continue
        files.update({f"third_party/{name}": data for name, data in headers.items()})
        files[f"third_party/{folder}/LICENSE"] = pathlib.Path(licence).read_bytes()
    for package, (wanted, licence) in SOURCES.items() if everything else ():
        folder = debian_sources(package)
        for name in wanted:
            files[f"third_party/{package}/{pathlib.PurePosixPath(name).name}"] = (folder / name).read_bytes()
        files[f"third_party/{package}/LICENSE"] = (folder / licence).read_bytes()
    parts = {"core": {}, "io": {}, "sim": {}}
    for name in sorted(texts):
        if name.startswith("src/") and name.endswith(".cpp") and name not in NEED_LIBRARIES and not name.startswith("src/dist/"):
            part = name.split("/")[1]
            parts[part if part in parts else "core"][name] = texts[name]
    for part, sources in parts.items():
        files.update(compiled_together(part, sources))
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
    parser.add_argument("--all", action="store_true")
    options = parser.parse_args()
    if options.out.exists():
        sys.exit(f"source_drop.py: {options.out} exists already")
    files = contents(options.core, options.all)
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
