#!/usr/bin/env python3
"""Fails unless OUT holds a Unity package and a NuGet package as Unity and NuGet want them.

usage: test_layout.py OUT RUNTIME...    OUT as assemble.py wrote it, with these runtimes
"""
import json
import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "packages"))
import version  # noqa: E402

OUT, TARGETS = pathlib.Path(sys.argv[1]), sys.argv[2:]
UPM, NUPKG = OUT / "upm", OUT / f"Voxtet.{version.version()}.nupkg"
LIBRARY = re.compile(r"(lib)?vox(_io)?\.(so|dll|dylib)")


class Unity(unittest.TestCase):
    def assets(self):
        for path in UPM.rglob("*"):
            inner = path.relative_to(UPM)
            if path.suffix != ".meta" and not any(part.endswith("~") or part.startswith(".") for part in inner.parts):
                yield path

    def test_manifest(self):
        manifest = json.loads((UPM / "package.json").read_text(encoding="utf-8"))
        self.assertEqual(manifest["version"], version.version())
        self.assertRegex(manifest["name"], r"^[a-z0-9-]+(\.[a-z0-9-]+)+$")
        for sample in manifest["samples"]:
            self.assertTrue(list((UPM / sample["path"]).glob("*.cs")), sample["path"])
        assembly = json.loads((UPM / "Runtime/Voxtet.asmdef").read_text(encoding="utf-8"))
        self.assertTrue(assembly["allowUnsafeCode"])

    def test_every_asset_has_a_number_of_its_own(self):
        numbers = {}
        for path in self.assets():
            meta = path.with_name(path.name + ".meta")
            self.assertTrue(meta.is_file(), f"{path} has no .meta: Unity would ignore it")
            number = re.search(r"^guid: ([0-9a-f]{32})$", meta.read_text(encoding="ascii"), re.MULTILINE)[1]
            self.assertNotIn(number, numbers, f"{path} and {numbers.get(number)}")
            numbers[number] = path
        for meta in UPM.rglob("*.meta"):
            self.assertTrue(meta.with_suffix("").exists(), f"{meta} is of nothing")

    def test_libraries(self):
        for runtime in TARGETS:
            found = [path for path in (UPM / "Runtime/Plugins" / runtime).iterdir() if path.suffix != ".meta"]
            self.assertTrue(any(path.stem in ("vox", "libvox") for path in found), runtime)
            for path in found:
                self.assertRegex(path.name, LIBRARY)
                meta = path.with_name(path.name + ".meta").read_text(encoding="ascii")
                self.assertIn("\nPluginImporter:\n", meta)
                self.assertIn("      Any: \n    second:\n      enabled: 0\n", meta, "it would be loaded on every system")
                self.assertRegex(meta, r"CPU: (x86_64|ARM64)\n        OS: (Linux|Windows|OSX)\n")


class NuGet(unittest.TestCase):
    def setUp(self):
        self.package = zipfile.ZipFile(NUPKG)
        self.addCleanup(self.package.close)
        self.names = set(self.package.namelist())

    def test_parts(self):
        self.assertIsNone(self.package.testzip())
        types = xml.etree.ElementTree.fromstring(self.package.read("[Content_Types].xml"))
        extensions = {child.get("Extension") for child in types}
        overrides = {child.get("PartName") for child in types}
        for name in self.names - {"[Content_Types].xml"}:
            extension = name.rsplit("/", 1)[-1].rpartition(".")[2] if "." in name.rsplit("/", 1)[-1] else None
            self.assertTrue(extension in extensions or "/" + name in overrides, f"{name} has no content type")
        relations = xml.etree.ElementTree.fromstring(self.package.read("_rels/.rels"))
        self.assertEqual([child.get("Target") for child in relations], ["/Voxtet.nuspec"])

    def test_manifest(self):
        space = "{http://schemas.microsoft.com/packaging/2013/05/nuspec.xsd}"
        metadata = xml.etree.ElementTree.fromstring(self.package.read("Voxtet.nuspec")).find(space + "metadata")
        for field in ("id", "version", "authors", "description"):
            self.assertTrue(metadata.find(space + field).text, field)
        self.assertEqual(metadata.find(space + "version").text, version.version())
        self.assertIn(metadata.find(space + "readme").text, self.names)

    def test_sources_and_libraries(self):
        sources = {name.rsplit("/", 1)[1] for name in self.names if name.startswith("contentFiles/cs/any/Voxtet/")}
        self.assertEqual(sources, {path.name for path in (ROOT / "bindings/csharp/Runtime").glob("*.cs")})
        self.assertIn("build/Voxtet.props", self.names)
        runtimes = {name.split("/")[1] for name in self.names if name.startswith("runtimes/")}
        self.assertEqual(runtimes, set(TARGETS))
        for name in self.names:
            if name.startswith("runtimes/"):
                self.assertRegex(name, r"^runtimes/[a-z0-9-]+/native/[^/]+$")
                self.assertRegex(name.rsplit("/", 1)[1], LIBRARY)
                self.assertEqual(self.package.read(name), (UPM / name.replace("runtimes", "Runtime/Plugins", 1).replace("native/", "")).read_bytes())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
