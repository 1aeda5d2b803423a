#!/usr/bin/env python3
"""Speed guard: counts the instructions of vox_grid_step in small scenes and compares with a baseline.

    guard.py PROGRAM          fails when a scene takes over 5 % more instructions than the baseline
    guard.py --renew PROGRAM  writes the baseline of this compiler

PROGRAM is guard.c, built optimised. Counts do not depend on how busy the machine is, so that they show small changes
which times would hide. They say nothing about caches, so a change that trades instructions for misses is misjudged.
Valgrind has no AVX-512: what is counted is the AVX2 code. The counts belong to a compiler's major version (the key in
baseline.json); exit status 77 says that there is no baseline to compare with.
"""

import argparse
import json
import pathlib
import platform
import re
import subprocess
import sys
import tempfile

# Contacts alone, then with constraints.
SCENES = ("pair", "self", "many", "tangled", "constraints-pair", "constraints-many", "constraints-tangled")
TOLERANCE = 0.05
BASELINE = pathlib.Path(__file__).resolve().parent / "baseline.json"
SKIPPED = 77


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def compiler(program):
    """Name and major version of the compiler that built the library, e.g. "gcc 12"."""
    info = subprocess.run([program, "--build"], check=True, capture_output=True, text=True).stdout
    found = re.search(r", (gcc|clang) (\d+)", info)
    if not found:
        skip(f"this compiler is not known to the guard: {info.strip()}")
    return f"{found[1]} {found[2]}"


def instructions(program, scene):
    """Instructions read by vox_grid_step and all it calls."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "callgrind.out"
        run = subprocess.run(
            ["valgrind", "--tool=callgrind", "--toggle-collect=vox_grid_step", f"--callgrind-out-file={out}",
             program, scene], capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"{scene}: exit status {run.returncode}\n{run.stdout}{run.stderr}")
        total = re.search(r"^(?:totals|summary): (\d+)", out.read_text(), re.MULTILINE)
    if not total or int(total[1]) == 0:
        sys.exit(f"{scene}: callgrind counted nothing in vox_grid_step")
    return int(total[1]), run.stdout.strip()


def check_machine():
    if platform.machine() != "x86_64":
        skip(f"the baseline is of x86-64, this is {platform.machine()}")
    cpu = pathlib.Path("/proc/cpuinfo")
    if not cpu.exists() or not re.search(r"^flags\b.*\bavx2\b", cpu.read_text(), re.MULTILINE):
        skip("the baseline is of the AVX2 code, and this processor has no AVX2")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--renew", action="store_true", help="write the baseline of this compiler")
    parser.add_argument("program")
    arguments = parser.parse_args()

    check_machine()
    name = compiler(arguments.program)
    baseline = json.loads(BASELINE.read_text()) if BASELINE.exists() else {}
    if not arguments.renew and name not in baseline:
        known = ", ".join(sorted(baseline)) or "none"
        skip(f"no baseline for {name} (there is: {known}); guard.py --renew makes one")

    counted, failed = {}, False
    for scene in SCENES:
        counted[scene], what = instructions(arguments.program, scene)
        before = baseline.get(name, {}).get(scene)
        line = f"{scene}: {counted[scene]:,} instructions in 4 steps ({what})"
        if before:
            change = counted[scene] / before - 1
            line += f", {change:+.2%} of the baseline's {before:,}"
            if change > TOLERANCE and not arguments.renew:
                line += ": SLOWER"
                failed = True
            elif change < -TOLERANCE and not arguments.renew:
                line += ": faster, renew the baseline (./dev guard --renew)"
        elif not arguments.renew:
            line += ": NOT IN THE BASELINE, renew it (./dev guard --renew)"
            failed = True
        print(line, flush=True)
    if arguments.renew:
        baseline[name] = counted
        BASELINE.write_text(json.dumps(baseline, indent=2, sort_keys=True) + "\n")
        print(f"written: baseline of {name}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
