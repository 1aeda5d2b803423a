"""Runs the program `hashes` in many configurations, none of which may change a letter of what it prints, and compares
that with the checked-in hashes.txt.
usage: matrix.py PROGRAM [--few] [--renew] [--emulator COMMAND]
--few: those that compiler and optimisation can matter to; else one of every kind, and all of them where the environment asks for
volume (VOX_TEST_VOLUME=2 and more). --renew: writes hashes.txt anew, if all are the same.
--emulator: the command that runs the program on this machine."""

import os
import subprocess
import sys

CHECKED_IN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "hashes.txt")
FEW = ["", "--engine reference", "--doubles --workers 3", "--level 0", "--level 1", "--level 2"]
SOME = FEW + [
    "--level 3",
    "--workers 8",
    "--doubles --moved --workers 8",
    "--engine reference --doubles",
    "--engine reference --workers 4",
    "--cell-size 0.5",
    "--engine reference --cell-size 2",
]
MANY = FEW + [
    "",  # a second time: other addresses
    *[f"--workers {n}" for n in range(2, 9)],
    "--engine reference --workers 4",
    "--doubles",
    "--moved",
    "--doubles --moved --workers 8",
    "--engine reference --doubles",
    "--engine reference --moved",
    "--level 3",
    *[f"--level {level} --workers 5" for level in range(4)],
    "--level 0 --doubles",
    "--cell-size 0.5",
    "--cell-size 3 --workers 2",
    "--engine reference --cell-size 0.7",
    "--engine reference --cell-size 2",
]


def hashes(program, arguments):
    done = subprocess.run([*program, *arguments.split()], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"hashes {arguments}: ends with {done.returncode}\n{done.stderr}")
    return done.stdout.splitlines(), done.stderr.strip()


def differences(expected, found):
    """The parts that differ, line by line."""
    if len(expected) != len(found):
        yield f"{len(found)} lines, expected {len(expected)}"
    for was, now in zip(expected, found):
        if was == now:
            continue
        parts = [n for w, n in zip(was.split(", "), now.split(", ")) if w != n]
        yield f"{was.split(': ')[0]}: {', '.join(parts) or now}"


def main():
    program, options = sys.argv[1:2], sys.argv[2:]
    if "--emulator" in options:
        program = [*options[options.index("--emulator") + 1].split(), *program]
    first, _ = hashes(program, "")
    expected = first
    if "--renew" not in options:
        with open(CHECKED_IN, encoding="ascii") as file:
            expected = file.read().splitlines()
    same = True
    many = MANY if int(os.environ.get("VOX_TEST_VOLUME", "1")) > 1 else SOME
    for arguments in FEW if "--few" in options else many:
        found, level = hashes(program, arguments)
        wrong = list(differences(expected, found))
        same = same and not wrong
        print(f"{'differs' if wrong else 'the same'}: hashes {arguments}" + (f" ({level})" if level else ""))
        for line in wrong:
            print("  " + line)
    if same and "--renew" in options:
        with open(CHECKED_IN, "w", encoding="ascii") as file:
            file.write("\n".join(first) + "\n")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
