#!/usr/bin/env python3
"""Every check that .ci/run has no time for, in parts that run one by one; a part that fails does not stop the others.

usage: nightly.py [--list] [PART...]     without a part: all of them

What a part prints goes to build/nightly/PART.log. The table build/nightly/table.md, printed at the end, has a row for each part
that was ever run here: a part that runs again replaces its row. Ends with 1 if one of those that ran now failed."""

import argparse
import datetime
import os
import pathlib
import platform
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "build" / "nightly"

# Name: a shell command, and what it is for. Those that build in one tree stand together.
PARTS = {
    "debug": ("./dev test debug", "all tests by gcc without optimisation, each source by itself, threads without oneTBB"),
    "valgrind": ("./dev test valgrind", "tests labelled valgrind, under it"),
    "tidy": ("./dev tidy", "clang-tidy over the libraries and the tool"),
    "clang": ("./dev test clang", "all tests by clang, each source by itself, threads without oneTBB"),
    "asan": ("./dev test asan-full", "all tests under clang's address and undefined-behaviour sanitizers"),
    "gcc-asan": ("./dev test gcc-asan", "the libraries by gcc's sanitizers at -O1, tests of C border and readers"),
    "tsan": ("./dev test tsan", "tests of threads under the thread sanitizer"),
    "fuzz": ("./dev fuzz 60", "a minute of each fuzzer, guided by what the libraries do"),
    "tools": ("./dev bindings --tools && ./dev test", "the README's test command with the tools of all languages"),
    "long": ("./dev test long", "all tests with four times as many random scenes, and longer ones"),
    "soak": ("./dev soak", "a long random life of two grids against a model"),
    "guard": ("./dev guard", "instructions of a step"),
    "bench": ("./dev bench --build", "every benchmark compiles"),
    "csharp": ("./dev bindings csharp", "the C# binding in full"),
    "js": ("./dev bindings js --all", "the JavaScript binding in full: every module"),
    "mujoco": ("./dev bindings mujoco", "the MuJoCo plugin in full"),
    "python": ("./dev bindings python", "the Python binding in full, and its wheel"),
    "rust": ("./dev bindings rust --all", "the Rust binding in full, its style, and the example for Bevy"),
    "web": ("./dev web --test", "the playground in a browser"),
    "site": ("./dev docs --check", "the documentation's site: links, and its figures in a browser"),
    "reference": ("./dev reference && python3 -B docs/reference/build.py --self-test", "the reference pages"),
    "hashes": ("./dev hashes", "hashes of all scenes by gcc and clang at -O0 and -O2"),
    "cross": ("./dev cross", "the same on Arm and WebAssembly; packages builds for the other platforms of the wheels"),
    "cuda": ("./dev cuda", "the kernels of src/gpu compiled for NVIDIA's GPUs: no fused operation, no spill"),
    "windows-gcc": ("./dev windows gcc", "MinGW-w64's gcc, tests under Wine"),
    "windows-clang": ("./dev windows clang", "the same by clang"),
    "packages": ("./dev packages", "every package built, installed into a fresh place, and used"),
}
COLUMNS = ("part", "command", "commit", "on", "seconds", "result")


def git(*arguments):
    return subprocess.run(["git", *arguments], check=True, capture_output=True, text=True, cwd=ROOT).stdout.strip()


def processor():
    info = pathlib.Path("/proc/cpuinfo")
    found = re.search(r"^model name\s*: (.*)$", info.read_text(encoding="utf-8") if info.exists() else "", flags=re.M)
    return found[1] if found else platform.machine()


def result_of(status, log):
    """Also how much was skipped for want of a tool, so that a green row does not hide it."""
    skipped = len(re.findall(r"\*\*\*Skipped|^SKIPPED", log, flags=re.M))
    return ("passed" if status == 0 else f"FAILED ({status})") + (f", {skipped} skipped" if skipped else "")


def run(name):
    """The part's row."""
    command = PARTS[name][0]
    commit = git("rev-parse", "--short=10", "HEAD") + (" and changes" if git("status", "--porcelain") else "")
    began = time.monotonic()
    log = OUT / f"{name}.log"
    # ./dev installs what it needs without asking.
    environment = {**os.environ, "CI": "true"}
    if (ROOT / "../shared/meshes").is_dir():
        environment["VOX_REQUIRE_MESHES"] = "1"
    with open(log, "wb") as file:
        status = subprocess.run(command, shell=True, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, stdout=file,
                                stderr=subprocess.STDOUT, check=False).returncode
    text = log.read_text(encoding="utf-8", errors="replace")
    if status:
        print("\n".join(text.splitlines()[-40:]))
    seconds = round(time.monotonic() - began)
    today = datetime.date.today().isoformat()
    return dict(zip(COLUMNS, (name, f"`{command}`", commit, today, str(seconds), result_of(status, text))))


def read_table(text):
    """Rows by the names of their parts."""
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]
    return {row[0]: dict(zip(COLUMNS, row)) for row in cells[2:]}


def table(rows):
    """In the order of PARTS; a part that is no more has no row."""
    lines = [f"{os.cpu_count()} processors, {processor()}", "", "| " + " | ".join(COLUMNS) + " |", "|---" * len(COLUMNS) + "|"]
    lines += ["| " + " | ".join(rows[name][column] for column in COLUMNS) + " |" for name in PARTS if name in rows]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(prog="./dev nightly", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="the parts, and what they run")
    parser.add_argument("parts", nargs="*", metavar="PART")
    options = parser.parse_args()
    unknown = set(options.parts) - set(PARTS)
    if unknown:
        parser.error(f"there is no part {', '.join(sorted(unknown))}; --list names them")
    if options.list:
        for name in options.parts or PARTS:
            print(f"{name:14}{PARTS[name][1]}\n{'':14}{PARTS[name][0]}")
        return 0
    OUT.mkdir(parents=True, exist_ok=True)
    path = OUT / "table.md"
    rows = read_table(path.read_text(encoding="utf-8")) if path.exists() else {}
    failed = False
    for name in options.parts or PARTS:
        print(f"== {name}: {PARTS[name][0]} (build/nightly/{name}.log)", flush=True)
        rows[name] = run(name)
        failed = failed or not rows[name]["result"].startswith("passed")
        print(f"   {rows[name]['result']}, {rows[name]['seconds']} s", flush=True)
        path.write_text(table(rows), encoding="utf-8")  # now: what has run is kept when somebody stops the rest
    print("\n" + table(rows), end="")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
