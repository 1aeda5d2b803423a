"""Times a step in C, C++, C# and Rust: the same bodies, the same positions, the same library. Every language's program runs at the
same time as the others, and they take turns; each frame counts with the least of its times. C runs twice: what the two differ by
is the noise. The programs have to agree on the hash of all contacts of all frames.

usage: run.py BUILD_FOLDER [--rounds N] [--passes N] [--instructions]
--instructions counts those of a frame (positions written, a step, contacts read, their hash) by valgrind, for the languages that
are compiled to machine code."""

import argparse
import glob
import os
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


def run(*command, **variables):
    subprocess.run(command, check=True, env={**os.environ, **variables})


def build(folder, out):
    """{language: command} of what can be built here, and the file of the scene."""
    libraries = [os.path.join(folder, part) for part in ("src", "src/io", "src/sim")]
    flags = ["-O2", "-DNDEBUG", f"-I{ROOT}/include", f"-I{ROOT}"]
    link = [f"-L{libraries[0]}", "-lvox", "-lm"]
    path = os.path.join(out, "scene.bin")
    run("cc", "-std=c99", *flags, f"{HERE}/scene.c", "-o", f"{out}/scene", *link)
    run(f"{out}/scene", path)
    run("cc", "-std=gnu99", *flags, f"{HERE}/step.c", "-o", f"{out}/step_c", *link)
    run("c++", "-std=c++20", *flags, f"{HERE}/step.cpp", "-o", f"{out}/step_cpp", *link)
    programs = {"C": [f"{out}/step_c"], "C again": [f"{out}/step_c"], "C++": [f"{out}/step_cpp"]}
    if shutil.which("mcs") and shutil.which("mono"):
        sources = sorted(glob.glob(f"{HERE}/../csharp/Runtime/*.cs"))
        options = ["mcs", f"@{HERE}/../csharp/Tests~/mcs.rsp", "-optimize+"]
        run(*options, "-target:library", f"-out:{out}/Voxtet.dll", *sources)
        run(*options, f"-r:{out}/Voxtet.dll", f"-out:{out}/Step.exe", f"{HERE}/Step.cs")
        programs["C#"] = ["mono", f"{out}/Step.exe"]
    else:
        print("SKIPPED: there is no mcs or mono: C# is not timed")
    manifest = f"--manifest-path={HERE}/rust/Cargo.toml"
    if not shutil.which("cargo"):
        print("SKIPPED: there is no cargo: Rust is not timed")
    elif subprocess.run(["cargo", "fetch", "--quiet", manifest]).returncode:
        print("SKIPPED: crates cannot be fetched: Rust is not timed")
    else:
        run("cargo", "build", "--release", "--quiet", "--offline", manifest,
            CARGO_TARGET_DIR=f"{folder}/rust", VOXTET_LIBRARY_DIR=folder)
        programs["Rust"] = [f"{folder}/rust/release/step"]
    os.environ["LD_LIBRARY_PATH"] = os.pathsep.join([*libraries, os.environ.get("LD_LIBRARY_PATH", "")])
    return programs, path


def times(programs, path, rounds, passes):
    """{language: least times, alternately of a step and of reading the contacts, frame by frame}; ends where hashes differ."""
    running = {name: subprocess.Popen([*command, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
               for name, command in programs.items()}
    least, hashes = {}, set()
    for i in range(rounds):
        names = list(running)
        for name in names[i % len(names):] + names[:i % len(names)]:
            running[name].stdin.write(f"{passes}\n")
            running[name].stdin.flush()
            found, *nanoseconds = running[name].stdout.readline().split()
            hashes.add(found)
            if len(hashes) > 1:
                sys.exit(f"{name}: the hash of all frames is {found}, others have another: {hashes}")
            nanoseconds = [int(n) for n in nanoseconds]
            least[name] = [min(pair) for pair in zip(least.get(name, nanoseconds), nanoseconds)]
    for process in running.values():
        process.communicate(timeout=60)
    return least, hashes.pop()


def instructions(command, path, passes):
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *command, path],
                          input=f"{passes}\n", text=True, capture_output=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1))


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("build")
    arguments.add_argument("--rounds", type=int, default=300)
    arguments.add_argument("--passes", type=int, default=5)
    arguments.add_argument("--instructions", action="store_true")
    given = arguments.parse_args()
    if given.instructions and not shutil.which("valgrind"):
        print("SKIPPED: there is no valgrind: instructions are not counted")
        given.instructions = False
    folder = os.path.abspath(given.build)
    out = os.path.join(folder, "bindings_bench")
    os.makedirs(out, exist_ok=True)
    programs, path = build(folder, out)
    least, found = times(programs, path, given.rounds, given.passes)
    frames = len(least["C"]) // 2
    print(f"{given.rounds} rounds of {given.passes} passes of {frames} frames; hash {found} in all languages\n")
    print("| | a step | over C | reading all contacts | instructions a frame | over C |\n|---|---|---|---|---|---|")
    counts = {}
    for name, numbers in least.items():
        step, read = (sum(numbers[i::2]) / frames / 1000 for i in (0, 1))
        base = sum(least["C"][0::2]) / frames / 1000
        counted = over = ""
        if given.instructions and name in ("C", "C++", "Rust"):
            # What comes before the first pass is in both.
            counts[name] = (instructions(programs[name], path, 3) - instructions(programs[name], path, 1)) / 2 / frames
            counted, over = f"{counts[name]:,.0f}", f"{100 * (counts[name] / counts['C'] - 1):+.3f} %"
        print(f"| {name} | {step:.1f} µs | {100 * (step / base - 1):+.1f} % | {read:.2f} µs | {counted} | {over} |")


if __name__ == "__main__":
    main()
