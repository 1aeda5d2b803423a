#!/usr/bin/env python3
"""What share of a step's instructions is serial, with constraints, that is outside the tasks that its workers share, with 1, 2, 4
and 8 workers.

usage: workers.py PROGRAM SCENE TETS, e.g. workers.py build/release/bench/bench_workers overlap-50 1000000

PROGRAM is workers.cpp. It runs tasks one by one under valgrind's callgrind, which counts the instructions of a step and of
its tasks. Counts do not depend on the machine's cores or load. Valgrind has no AVX-512: what is counted is the AVX2 code.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

WORKERS = (1, 2, 4, 8)


def callgrind(command, folder):
    """Runs the program; returns what it prints, and the dump of each step that was counted."""
    out = pathlib.Path(folder) / "out"
    run = subprocess.run(["valgrind", "--tool=callgrind", "--toggle-collect=bench_step", "--dump-after=bench_step",
                          f"--callgrind-out-file={out}", *command], capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(run.stderr)
    return run.stdout.strip(), [pathlib.Path(f"{out}.{i + 1}") for i in range(len(WORKERS))]


def instructions(dump):
    """Of the step, and of all calls of bench_task with what these call."""
    names, in_tasks, task_called = {}, 0, False
    text = dump.read_text()
    for line in text.splitlines():
        if line.startswith("cfn="):  # (number) name; the name is there only the first time
            number, name = re.match(r"cfn=\((\d+)\) ?(.*)", line).groups()
            name = names.setdefault(number, name)
            task_called = name == "bench_task"
        elif line.startswith("fn="):
            number, name = re.match(r"fn=\((\d+)\) ?(.*)", line).groups()
            names.setdefault(number, name)
        elif task_called and not line.startswith("calls="):
            in_tasks += int(line.split()[1])  # position, cost of the call
            task_called = False
    return int(re.search(r"^(?:totals|summary): (\d+)", text, re.MULTILINE)[1]), in_tasks


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("program", "scene", "tets"):
        parser.add_argument(name)
    arguments = parser.parse_args()
    command = [arguments.program, arguments.scene, arguments.tets]
    with tempfile.TemporaryDirectory() as folder:
        what, dumps = callgrind(command, folder)
        print(what)
        print("| workers | instructions, millions | serial, millions | serial share |\n|---:|---:|---:|---:|")
        for workers, dump in zip(WORKERS, dumps):
            total, in_tasks = instructions(dump)
            serial = total - in_tasks
            print(f"| {workers} | {total / 1e6:.2f} | {serial / 1e6:.2f} | {100 * serial / total:.1f} % |")


if __name__ == "__main__":
    main()
