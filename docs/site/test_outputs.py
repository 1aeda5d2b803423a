"""usage: test_outputs.py BUILD_FOLDER: a block on a page that says what a program prints, <!-- prints NAME ARGUMENTS --> before it, is
what it prints: an example, the tool vox, or a Python file. Ends with 77, and says why, where nothing could be run."""

import os
import pathlib
import re
import subprocess
import sys

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def blocks():
    """(page, command, text)."""
    for page in sorted(p.relative_to(ROOT).as_posix() for p in pathlib.Path(ROOT, "docs").rglob("*.md")):
        with open(os.path.join(ROOT, page), encoding="utf-8") as file:
            for match in re.finditer(r"^<!-- prints ([^\n]+) -->\n```text\n(.*?)^```$", file.read(), flags=re.S | re.M):
                yield page, match[1].split(), match[2]


def python_with_numpy():
    for python in (sys.executable, "/usr/bin/python3"):
        if subprocess.run([python, "-c", "import numpy"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
            return python
    return None


def program_of(name, build):
    """The command for it and its environment, or why it cannot be run."""
    if name.endswith(".py"):
        python = python_with_numpy()
        libraries = [os.path.join(build, part) for part in ("src", "src/io", "src/sim")]
        built = [os.path.join(folder, f"libvox{part}.so") for folder, part in zip(libraries, ("", "_io", "_sim"))]
        if not python or not all(map(os.path.exists, built)):
            return None, "no Python has numpy, or libraries are missing"
        return [python, "-B", os.path.join(ROOT, name)], {
            "VOXTET_LIBRARY_DIR": os.pathsep.join(libraries),
            "PYTHONPATH": os.path.join(ROOT, "bindings", "python", "src"),
        }
    path = os.path.join(build, "tools", "vox") if name == "vox" else os.path.join(build, "examples", "example_" + name)
    return ([path], {}) if os.path.exists(path) else (None, f"there is no {path}")


def main(build):
    compared, faults = 0, []
    for page, (name, *arguments), text in blocks():
        command, environment = program_of(name, build)
        if not command:
            print(f"SKIPPED: {page}: {name}: {environment}")
            continue
        run = subprocess.run(
            command + arguments,
            cwd=ROOT,
            env={**os.environ, "LC_ALL": "C.UTF-8", **environment},
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=120,
            check=False,
        )
        compared += 1
        if run.stdout != text:
            faults.append(f"{page}: {name} prints\n{run.stdout}and not\n{text}")
    if faults:
        sys.exit("\n".join(faults))
    if not compared:
        sys.exit(77)
    print(f"{compared} outputs on pages are right")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
