#!/usr/bin/env python3
"""The C# binding as it is given away, with the native libraries in it: a Unity package and a NuGet package.

usage: assemble.py OUT RUNTIME=FOLDER...    RUNTIME: linux-x64 linux-arm64 win-x64 osx-x64 osx-arm64; FOLDER: where that one's
                                            libraries lie (vox, and vox_io where it was built)

OUT/upm/ is the Unity package (Package Manager, "Add package from disk"): bindings/csharp, and the libraries in
Runtime/Plugins/RUNTIME, each with the .meta that says for which system and processor it is. OUT/Voxtet.VERSION.nupkg has
the same sources, which the compiler of a project that refers to the package compiles with it (so it is compiled for whatever
framework that is), and the libraries in runtimes/RUNTIME/native. The same input gives the same bytes.
"""
import hashlib
import json
import pathlib
import re
import shutil
import sys
import zipfile
from xml.sax.saxutils import escape

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CSHARP = ROOT / "bindings/csharp"
sys.path.insert(0, str(HERE.parent))
import version  # noqa: E402

# What a library is called there, and what Unity calls the system and the processor: in the editor, and in players.
RUNTIMES = {
    "linux-x64": ("lib{}.so", "Linux", "Linux64", "x86_64"),
    "linux-arm64": ("lib{}.so", "Linux", None, "ARM64"),
    "win-x64": ("{}.dll", "Windows", "Win64", "x86_64"),
    "osx-x64": ("lib{}.dylib", "OSX", "OSXUniversal", "x86_64"),
    "osx-arm64": ("lib{}.dylib", "OSX", "OSXUniversal", "ARM64"),
}
REQUIRED, OPTIONAL = ["vox"], ["vox_io"]


def natives(runtime, folder):
    """Each library of that folder: the name under which it is loaded, and its bytes."""
    found = {}
    for library in REQUIRED + OPTIONAL:
        name = RUNTIMES[runtime][0].format(library)
        path = next(iter(sorted(folder.rglob(name))), None)
        if path:
            found[name] = path.read_bytes()
        elif library in REQUIRED:
            sys.exit(f"assemble.py: there is no {name} in {folder}")
    return found


def plugin_meta(runtime, path):
    """Unity's settings of a native library: loaded on that system and processor, in the editor and in players, nowhere else."""
    _, system, player, processor = RUNTIMES[runtime]
    number = hashlib.md5(("org.voxtet/" + path).encode()).hexdigest()
    lines = ["fileFormatVersion: 2", f"guid: {number}", "PluginImporter:", "  serializedVersion: 2", "  isPreloaded: 0",
             "  platformData:", "  - first:", "      Any: ", "    second:", "      enabled: 0", "      settings: {}",
             "  - first:", "      Editor: Editor", "    second:", "      enabled: 1", "      settings:",
             f"        CPU: {processor}", f"        OS: {system}"]
    if player:
        lines += ["  - first:", f"      Standalone: {player}", "    second:", "      enabled: 1", "      settings:",
                  f"        CPU: {processor}"]
    return "\n".join(lines) + "\n"


def folder_meta(path):
    number = hashlib.md5(("org.voxtet/" + path).encode()).hexdigest()
    return f"fileFormatVersion: 2\nguid: {number}\nfolderAsset: yes\n"


def write_upm(out, libraries):
    shutil.copytree(CSHARP, out, ignore=shutil.ignore_patterns("check", "meta.py", "Tests~", "__pycache__"))
    shutil.copy(ROOT / "LICENSE", out / "LICENSE.md")
    (out / "LICENSE.md.meta").write_text(folder_meta("LICENSE.md").replace("folderAsset: yes\n", ""), encoding="ascii")
    for runtime, files in {"": {}, **libraries}.items():
        folder = f"Runtime/Plugins/{runtime}".rstrip("/")
        (out / folder).mkdir()
        (out / f"{folder}.meta").write_text(folder_meta(folder), encoding="ascii")
        for name, data in files.items():
            (out / folder / name).write_bytes(data)
            (out / folder / f"{name}.meta").write_text(plugin_meta(runtime, f"{folder}/{name}"), encoding="ascii")


NUSPEC = """<?xml version="1.0" encoding="utf-8"?>
<package xmlns="http://schemas.microsoft.com/packaging/2013/05/nuspec.xsd">
  <metadata minClientVersion="3.3">
    <id>Voxtet</id>
    <version>{version}</version>
    <authors>the vox authors</authors>
    <license type="expression">MIT</license>
    <readme>README.md</readme>
    <description>{description}</description>
    <tags>{tags}</tags>
    <dependencies>
      <group targetFramework=".NETStandard2.1" />
    </dependencies>
    <contentFiles>
      <files include="cs/any/Voxtet/*.cs" buildAction="Compile" copyToOutput="false" />
    </contentFiles>
  </metadata>
</package>
"""
# The sources use pointers, and fields that only the library writes.
PROPS = """<Project>
  <PropertyGroup>
    <AllowUnsafeBlocks>true</AllowUnsafeBlocks>
    <NoWarn>$(NoWarn);0649;0169;0414</NoWarn>
  </PropertyGroup>
</Project>
"""
CONTENT_TYPES = """<?xml version="1.0" encoding="utf-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
  <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml" />
  {types}
  <Override PartName="/LICENSE" ContentType="application/octet" />
</Types>
"""
RELATIONSHIPS = """<?xml version="1.0" encoding="utf-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
  <Relationship Type="http://schemas.microsoft.com/packaging/2010/07/manifest" Target="/Voxtet.nuspec" Id="R1" />
</Relationships>
"""


def write_nupkg(path, libraries):
    description = json.loads((CSHARP / "package.json").read_text(encoding="utf-8"))
    files = {"README.md": (CSHARP / "README.md").read_bytes(), "LICENSE": (ROOT / "LICENSE").read_bytes(),
             "build/Voxtet.props": PROPS.encode(), "lib/netstandard2.1/_._": b"", "_rels/.rels": RELATIONSHIPS.encode()}
    for source in sorted((CSHARP / "Runtime").glob("*.cs")):
        files[f"contentFiles/cs/any/Voxtet/{source.name}"] = source.read_bytes()
    for runtime, native in libraries.items():
        for name, data in native.items():
            files[f"runtimes/{runtime}/native/{name}"] = data
    files["Voxtet.nuspec"] = NUSPEC.format(version=version.version(), description=escape(description["description"]),
                                           tags=escape(" ".join(word.replace(" ", "-") for word in description["keywords"]))).encode()
    extensions = sorted({re.sub(r".*\.", "", name) for name in files if "." in name.rsplit("/", 1)[-1]} - {"rels"})
    types = "\n  ".join(f'<Default Extension="{e}" ContentType="application/octet" />' for e in extensions)
    files["[Content_Types].xml"] = CONTENT_TYPES.format(types=types).encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:
        for name in sorted(files):
            package.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), files[name], zipfile.ZIP_DEFLATED)


def main():
    pairs = [argument.partition("=") for argument in sys.argv[2:]]
    if not pairs or any(runtime not in RUNTIMES or not folder for runtime, _, folder in pairs):
        sys.exit(__doc__)
    libraries = {runtime: natives(runtime, pathlib.Path(folder)) for runtime, _, folder in pairs}
    out = pathlib.Path(sys.argv[1])
    if (out / "upm").exists():
        sys.exit(f"assemble.py: {out / 'upm'} exists already")
    out.mkdir(parents=True, exist_ok=True)
    write_upm(out / "upm", libraries)
    write_nupkg(out / f"Voxtet.{version.version()}.nupkg", libraries)


if __name__ == "__main__":
    main()
