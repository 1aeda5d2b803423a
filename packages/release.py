#!/usr/bin/env python3
"""Makes a release of the last commit: checks, every package, checksums, bill of materials, provenance, and the tag.

usage: release.py [--dry-run] [--once] [NAME...]

Everything is built in two fresh clones at different places, and what comes out must be equal byte for byte; files of which
a tool does not allow that are listed by name in VARYING. What is released then lies in build/release-X.Y.Z/. --dry-run: an
undated heading of CHANGELOG.md, a version that is tagged already and a changed working tree are said, no error, and there is
no tag. --once: one clone, so nothing is compared. NAME: these folders of packages/ alone.
"""
import argparse
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys

import sbom
import version

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Patterns of files that differ from build to build, and why.
VARYING = {}
# Programs whose versions decide what comes out.
TOOLS = [["g++", "--version"], ["cmake", "--version"], ["python3", "--version"], ["rustc", "--version"], ["node", "--version"],
         ["emcc", "--version"], ["dpkg-buildpackage", "--version"]]


def run(*command, cwd=ROOT):
    print("$", " ".join(map(str, command)), flush=True)
    subprocess.run([str(part) for part in command], check=True, cwd=cwd)


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout.strip()


def complaints(number):
    """What forbids to tag this commit."""
    found = version.mistakes()
    heading = re.search(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    if not heading or not re.fullmatch(rf"{re.escape(number)}, \d{{4}}-\d\d-\d\d", heading[1]):
        found.append(f"CHANGELOG.md begins with \"{heading and heading[1]}\", not with \"{number}, YYYY-MM-DD\"")
    if output("git", "tag", "--list", f"v{number}"):
        found.append(f"v{number} is tagged already")
    changed = output("git", "status", "--porcelain")
    if changed:
        found.append("the working tree is not the last commit:\n" + changed)
    return found


def build(place, names):
    """All packages of the last commit, in a fresh clone at place: path of each file by its name."""
    if place.exists():
        shutil.rmtree(place)
    run("git", "clone", "--quiet", "--local", ROOT, place)
    if not names or "csharp" in names:
        wheels = subprocess.run(["packages/cross", "--wheels"], check=True, capture_output=True, text=True, cwd=ROOT).stdout
        # The C# package takes their libraries, too; those of the wheels run what was built.
        run("packages/cross", "--build-only", *wheels.split(), cwd=place)
    run("./dev", "packages", "--required", *names, cwd=place)
    files = {}
    for path in sorted(place.glob("build/packages/*/dist/*")):
        if path.name in files:
            sys.exit(f"release.py: both {files[path.name]} and {path} are to be released")
        files[path.name] = path
    return files


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def differences(first, second):
    """Names that are not in both, or whose bytes differ though they need not."""
    found = sorted(first.keys() ^ second.keys())
    for name in first.keys() & second.keys():
        if digest(first[name]) != digest(second[name]) and not any(re.fullmatch(pattern, name) for pattern in VARYING):
            found.append(name)
    return found


def provenance(number, compared):
    lines = [f"vox {number}", "", f"Commit     {output('git', 'rev-parse', 'HEAD')}",
             f"Tree       {output('git', 'rev-parse', 'HEAD^{tree}')}",
             f"Committed  {output('git', 'log', '-1', '--format=%cI')}",
             "Command    ./dev release, which runs ./dev packages in fresh clones", ""]
    lines.append("Built twice, at two places; every file of SHA256SUMS came out the same, byte for byte"
                 + (", but for:" if VARYING else ".") if compared else "Built once, so nothing says that it is reproducible.")
    lines += [f"    {pattern}: {why}" for pattern, why in VARYING.items()] if compared else []
    lines += ["", "Tools"]
    for command in TOOLS:
        found = shutil.which(command[0])
        said = subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines() if found else []
        lines.append(f"    {command[0]}: {said[0] if said else 'none'}")
    release = pathlib.Path("/etc/os-release").read_text(encoding="utf-8") if os.path.exists("/etc/os-release") else ""
    system = re.search(r'^PRETTY_NAME="(.*)"$', release, re.MULTILINE)
    lines.append(f"    system: {system[1] if system else sys.platform}")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--dry-run", action="store_true")
    parser.add_argument("--once", action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME")
    options = parser.parse_args()
    number = version.version()
    for complaint in complaints(number):
        if not options.dry_run:
            sys.exit(f"release.py: {complaint}")
        print("would stop the release:", complaint)
    run("./dev", "abi")
    places = [ROOT / "build/release-clones" / name for name in ("first", "at-another-place")]
    built = [build(place, options.names) for place in places[:1 if options.once else 2]]
    if len(built) == 2 and differences(*built):
        sys.exit("release.py: not the same from both builds: " + ", ".join(differences(*built)))
    out = ROOT / f"build/release-{number}"
    if out.exists():
        shutil.rmtree(out)
    out.mkdir(parents=True)
    files = [pathlib.Path(shutil.copy2(path, out)) for path in built[0].values()]
    sbom.write(out / f"voxtet-{number}.spdx.json", files)
    (out / "PROVENANCE.txt").write_text(provenance(number, len(built) == 2), encoding="utf-8")
    listed = sorted(path for path in out.iterdir())
    (out / "SHA256SUMS").write_text("".join(f"{digest(path)}  {path.name}\n" for path in listed), encoding="utf-8")
    for path in listed:
        print(f"{path.stat().st_size / 1e6:8.2f} MB  {path.name}")
    if options.dry_run:
        print(f"dry run: {out.relative_to(ROOT)} holds what would be released as v{number}; no tag")
    else:
        run("git", "tag", "-a", f"v{number}", "-m", f"vox {number}")
        print(f"next: git push origin HEAD v{number}, and {out.relative_to(ROOT)} to where each package is published")


if __name__ == "__main__":
    main()
