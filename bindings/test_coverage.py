"""Every stable function of the public headers is used by each language's own layer, or coverage.txt says why not:
`language function reason`, one a line, where vox_sim_* stands for all functions that begin so. No line is stale."""

import fnmatch
import glob
import os
import re
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
sys.path.append(os.path.join(HERE, "generator"))
import header  # noqa: E402

# The files of a language that are written by hand.
LANGUAGES = {
    "cpp": ["include/vox/*.hpp"],
    "csharp": ["bindings/csharp/Runtime/[!N]*.cs"],  # all but Native.g.cs
    "rust": ["bindings/rust/voxtet/src/*.rs"],
    "js": ["bindings/js/voxtet.js", "bindings/js/lib/*.js"],
    "python": ["bindings/python/src/voxtet/[!_]*.py", "bindings/python/src/voxtet/__init__.py",
               "bindings/python/src/voxtet/_library.py"],  # all but _c.py
}
HEADERS = ["vox.h", "vox_query.h", "vox_cell_size.h", "vox_surface.h", "vox_io.h", "vox_sim.h"]


def words_of(text):
    """The names in source code, without those in comments."""
    return set(re.findall(r"\bvox_\w+", re.sub(r"/\*.*?\*/|//[^\n]*|^[ \t]*#[^\n]*", " ", text, flags=re.S | re.M)))


def faults(language, functions, used, exceptions):
    """What is wrong, a line each. `exceptions`: (language, function, reason)."""
    lines = {name: set(fnmatch.filter(functions, name)) for of, name, _ in exceptions if of == language}
    listed = set().union(*lines.values())
    found = [f"{language}: {name} is neither used nor listed" for name in sorted(functions - used - listed)]
    found += [f"{language}: {name} is listed and used" for name in sorted(listed & used)]
    found += [f"{language}: {name} is listed and no function" for name in sorted(lines) if not lines[name]]
    found += [f"{of}: {name}: no reason" for of, name, reason in exceptions if of == language and not reason]
    return found


def exceptions_in(text):
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return [tuple((line.split(None, 2) + ["", "", ""])[:3]) for line in lines]


def read(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


class Coverage(unittest.TestCase):
    def test_each_language(self):
        exceptions = exceptions_in(read("bindings", "coverage.txt"))
        self.assertLessEqual({of for of, *_ in exceptions}, set(LANGUAGES))
        self.assertEqual(len(exceptions), len({e[:2] for e in exceptions}), "a function is listed twice")
        functions, found = set(), []
        for name in HEADERS:
            parsed = header.read(os.path.join(ROOT, "include", "vox", name))
            functions |= {f.name for f in parsed.of_kind("function") if f.stable}
        for language, patterns in LANGUAGES.items():
            used = set()
            for pattern in patterns:
                paths = glob.glob(os.path.join(ROOT, pattern))
                self.assertTrue(paths, f"{language}: no file is {pattern}")
                for path in paths:
                    used |= words_of(read(path))
            found += faults(language, functions, used, exceptions)
        self.assertFalse(found, "\n" + "\n".join(found))

    def test_each_fault_is_noticed(self):
        functions = {"vox_a", "vox_b"}
        for name in ("vox_b", "vox_b*"):
            self.assertEqual(faults("x", functions, {"vox_a"}, [("x", name, "why")]), [])
        for used, exceptions, words in [({"vox_a"}, [], "vox_b is neither"), ({"vox_a"}, [("y", "vox_b", "why")], "neither"),
                                        (functions, [("x", "vox_b", "why")], "listed and used"),
                                        (functions, [("x", "vox_c", "why")], "no function"),
                                        (functions, [("x", "vox_c*", "why")], "no function"),
                                        ({"vox_a"}, [("x", "vox_*", "why")], "vox_a is listed and used"),
                                        ({"vox_a"}, [("x", "vox_b", "")], "no reason")]:
            with self.subTest(words=words):
                self.assertIn(words, "\n".join(faults("x", functions, used, exceptions)))
        self.assertEqual(words_of("vox_a(); // vox_b\n/* vox_c */ # vox_d\n  # vox_e\nvox_fg"), {"vox_a", "vox_d", "vox_fg"})
        self.assertEqual(exceptions_in("# note\n\ncpp vox_a it is not needed\ncpp vox_b\n"),
                         [("cpp", "vox_a", "it is not needed"), ("cpp", "vox_b", "")])


if __name__ == "__main__":
    unittest.main()
