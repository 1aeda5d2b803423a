#!/usr/bin/env python3
"""Debian's source of this package: OUT/voxtet_VERSION.orig.tar.xz, and beside it OUT/voxtet-VERSION/ with debian/ in it.

usage: source.py OUT

The version is vox.h's and the date that of the last commit, so debian/changelog is written here. The same commit gives the same
bytes.
"""
import email.utils
import io
import pathlib
import re
import subprocess
import sys
import tarfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))
import version  # noqa: E402


def git(*arguments):
    return subprocess.run(["git", "-C", str(ROOT), *arguments], check=True, capture_output=True, text=True).stdout


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    out, stem = pathlib.Path(sys.argv[1]).resolve(), f"voxtet-{version.version()}"
    made = int(git("log", "-1", "--format=%ct"))
    out.mkdir(parents=True, exist_ok=True)
    tarball = out / f"voxtet_{version.version()}.orig.tar.xz"
    with tarfile.open(tarball, "w:xz", format=tarfile.PAX_FORMAT) as tar:
        for name in sorted(git("ls-files", "-z").split("\0")[:-1]):
            if (ROOT / name).is_file() and not name.startswith("packages/deb/debian/"):
                data = (ROOT / name).read_bytes()
                entry = tarfile.TarInfo(f"{stem}/{name}")
                entry.size, entry.mtime = len(data), made
                entry.mode = 0o755 if (ROOT / name).stat().st_mode & 0o100 else 0o644
                tar.addfile(entry, io.BytesIO(data))
    with tarfile.open(tarball) as tar:
        tar.extractall(out)
    debian = out / stem / "debian"
    subprocess.run(["cp", "-r", str(HERE / "debian"), str(debian)], check=True)
    maintainer = re.search(r"^Maintainer: (.*)", (debian / "control").read_text(encoding="utf-8"), re.MULTILINE)[1]
    (debian / "changelog").write_text(f"voxtet ({version.version()}-1) unstable; urgency=medium\n\n"
                                      "  * Packaged from upstream's sources, by upstream.\n\n"
                                      f" -- {maintainer}  {email.utils.formatdate(made)}\n", encoding="utf-8")
    print(debian.parent)


if __name__ == "__main__":
    main()
