"""The programs of the README and the examples in the documentation of modules run as they stand. Every public name is documented."""

import doctest
import importlib
import inspect
import os
import re
import unittest

import voxtet

HERE = os.path.dirname(os.path.abspath(__file__))
OPTIONAL = {"matplotlib", "meshio", "pyvista", "trimesh"}


def modules():
    for name in ("errors", "grid", "mesh", "results", "suggest", "foreign", "locate", "transfer", "cells", "skfem", "io", "sim", "experiment", "mpi"):
        try:
            module = importlib.import_module("voxtet." + name)
            if name == "experiment":
                module.tool()
        except (ImportError, voxtet.FileError) as missing:
            if name not in ("io", "sim", "experiment", "mpi"):
                raise
            print(f"SKIPPED: {missing}")
        else:
            yield module


class Docs(unittest.TestCase):
    def test_examples_of_modules(self):
        tried = 0
        for module in modules():
            failed, attempted = doctest.testmod(module)
            self.assertEqual(failed, 0, module.__name__)
            tried += attempted
        self.assertGreater(tried, 20)

    def test_readme(self):
        with open(os.path.join(HERE, "..", "README.md"), encoding="utf-8") as file:
            text = file.read()
        blocks = re.findall(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```\n)?", text, flags=re.S | re.M)
        self.assertGreater(len(blocks), 4)
        for code, expected in blocks:
            with self.subTest(code.splitlines()[-1]):
                printed = []
                names = {"print": lambda *parts: printed.append(" ".join(map(str, parts)) + "\n"), "__name__": "readme"}
                try:
                    import matplotlib
                    matplotlib.use("Agg")
                except ImportError:
                    code = re.sub(r"^axes = .*\n", "", code, flags=re.M)
                try:
                    exec(compile(code, "README.md", "exec"), names)
                except ImportError as missing:
                    if not isinstance(missing, ModuleNotFoundError) and "VOXTET_LIBRARY_DIR" not in str(missing):
                        raise
                    self.skipTest(str(missing))
                if expected:
                    self.assertEqual("".join(printed), expected)

    def test_every_public_name_is_documented(self):
        missing = []
        for module in modules():
            self.assertTrue(module.__doc__)
            for name, item in vars(module).items():
                if name.startswith("_") or getattr(item, "__module__", None) != module.__name__:
                    continue
                if inspect.isclass(item) or inspect.isfunction(item):
                    if not (item.__doc__ or "").strip():
                        missing.append(f"{module.__name__}.{name}")
                    if inspect.isclass(item):
                        missing += [f"{module.__name__}.{name}.{key}" for key, member in vars(item).items()
                                    if not key.startswith("_") and (inspect.isfunction(member) or isinstance(member, property))
                                    and not member.__doc__]
        self.assertEqual(missing, [])

    def test_names_of_the_package(self):
        public = [name for name in vars(voxtet) if not name.startswith("_")]
        self.assertIn("Grid", public)
        self.assertEqual(voxtet.__version__.count("."), 2)
        with self.assertRaises(AttributeError):
            voxtet.nothing


if __name__ == "__main__":
    unittest.main()
