#!/usr/bin/env python3
"""The vcpkg port, the Homebrew formula and the Nix derivation of a release, from the texts beside this program.

usage: write.py OUT DROP URL HOMEPAGE    DROP: the source drop, FILE.tar.xz; URL: where that file will be had

The version is that of vox.h in the drop, and the checksums are the drop's.
"""
import hashlib
import pathlib
import re
import sys
import tarfile

HERE = pathlib.Path(__file__).resolve().parent
RECIPES = {"vcpkg/portfile.cmake", "vcpkg/vcpkg.json", "vcpkg/usage", "voxtet.rb", "default.nix"}


def version_of(drop):
    with tarfile.open(drop) as tar:
        name = next(name for name in tar.getnames() if name.endswith("/include/vox/vox.h"))
        header = tar.extractfile(name).read().decode()
    return ".".join(re.search(rf"#define VOX_VERSION_{part} (\d+)", header)[1] for part in ("MAJOR", "MINOR", "PATCH"))


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    out, drop = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    data = drop.read_bytes()
    values = {"VERSION": version_of(drop), "URL": sys.argv[3], "HOMEPAGE": sys.argv[4],
              "SHA256": hashlib.sha256(data).hexdigest(), "SHA512": hashlib.sha512(data).hexdigest()}
    for name in sorted(RECIPES):
        path = out / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(re.sub(r"@([A-Z0-9]+)@", lambda m: values[m[1]], (HERE / name).read_text(encoding="utf-8")),
                        encoding="utf-8")


if __name__ == "__main__":
    main()
