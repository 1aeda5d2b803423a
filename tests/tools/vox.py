"""Runs the vox command line for the tests beside this file."""

import json
import math
import os
import subprocess
import tempfile
import unittest

TOOL = os.environ["VOX_TOOL"]


def run(*arguments, warnings=False, **variables):
    """Runs vox with more environment variables; a run of ten minutes counts as hung. Warnings, about odd files and a busy
    machine, are left out of standard error unless a test is about them."""
    environment = {**os.environ, "LC_ALL": "C", **variables}
    command = [TOOL, *(a if isinstance(a, bytes) else str(a) for a in arguments)]
    done = subprocess.run(command, capture_output=True, env=environment, timeout=600)
    dropped = b"vox: warning: the machine is busy" if warnings else b"vox: warning: "
    lines = done.stderr.splitlines(keepends=True)
    done.stderr = b"".join(line for line in lines if not line.startswith(dropped))
    return done


class Files(unittest.TestCase):
    """Tests with a folder of their own."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="ascii") as file:
            file.write(text)
        return self.path(name)


def _no_constant(name):
    raise ValueError(f"{name} is no JSON number")


def _no_duplicates(pairs):
    if len(dict(pairs)) < len(pairs):
        raise ValueError(f"a key stands twice: {[key for key, _ in pairs]}")
    return dict(pairs)


def run_json(*arguments):
    """The object that vox prints with --json; fails unless that is all it prints, in strict JSON with each key once."""
    done = run(*arguments, "--json")
    if done.returncode != 0:
        raise AssertionError(f"{arguments}: exit code {done.returncode}, {done.stderr.decode()!r}")
    if done.stderr:
        raise AssertionError(f"{arguments}: standard error has {done.stderr.decode()!r}")
    text = done.stdout.decode("utf-8")
    found = json.loads(text, parse_constant=_no_constant, object_pairs_hook=_no_duplicates)
    if not isinstance(found, dict) or not text.endswith("}\n"):
        raise AssertionError(f"{arguments}: standard output is not one object and a newline")
    for value in numbers(found):
        if not math.isfinite(value):
            raise AssertionError(f"{arguments}: a number overflows")
    return found


def numbers(value):
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for element in value:
            yield from numbers(element)
    elif isinstance(value, (int, float)):
        yield float(value)
