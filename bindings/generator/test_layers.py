"""The generated layer of one language, read by that language: it compiles, and its sizes and offsets are those of
bindings/api.json. usage: test_layers.py LANGUAGE [PROGRAM...]; without a program for it, says so and is skipped (77)."""

import ctypes
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
BINDINGS = os.path.dirname(HERE)
sys.path.insert(0, HERE)
from names import sections, whole_structs  # noqa: E402

with open(os.path.join(BINDINGS, "api.json"), encoding="utf-8") as file:
    API = json.load(file)
STRUCTS = sections(API, "structs")


def run(*command, **options):
    subprocess.run(command, check=True, **options)


def python():
    from python_layer import _c
    model = {8: "lp64", 4: "wasm32"}[ctypes.sizeof(ctypes.c_void_p)]
    for s in STRUCTS:
        here = getattr(_c, s["name"])
        assert ctypes.sizeof(here) == s["size"][model], s["name"]
        offsets = [getattr(here, f["name"]).offset for f in s["fields"]]
        assert offsets == [f["offset"][model] for f in s["fields"]], s["name"]
    assert set(_c.dtypes) == whole_structs(API)
    for name, dtype in _c.dtypes.items():
        fields = next(s for s in STRUCTS if s["name"] == name)["fields"]
        if _c.dtype is dict:
            found = list(zip(dtype["names"], dtype["offsets"]))
        else:
            found = [(f, dtype.fields[f][1]) for f in dtype.names]
            assert dtype.itemsize == ctypes.sizeof(getattr(_c, name))
        assert found == [(f["name"], f["offset"]["lp64"]) for f in fields], name
    for part in API["headers"]:
        for f in part["functions"]:
            assert len(_c.FUNCTIONS[part["name"]][f["name"]][1]) == len(f["parameters"]), f["name"]


def rust(compiler):
    """Sizes and offsets are assertions in the file itself."""
    with tempfile.TemporaryDirectory() as folder:
        run(compiler, "--edition", "2021", "--crate-type", "lib", "--emit", "metadata", "-D", "warnings", "--cfg",
            'feature="io"', "--cfg", 'feature="sim"', "--out-dir", folder,
            os.path.join(BINDINGS, "rust", "voxtet-sys", "src", "generated.rs"))


def csharp(compiler, runtime):
    program = """using System;
using Voxtet;
static class Program
{
    static int Main()
    {
        int differ = 0;
        foreach (var e in Layout.Entries())
        {
            if (e.Here == e.Expected) continue;
            ++differ;
            Console.WriteLine(e.Name + " is " + e.Here + ", expected " + e.Expected);
        }
        Console.WriteLine(Layout.Entries().Count + " entries");
        return differ;
    }
}
"""
    with tempfile.TemporaryDirectory() as folder:
        source, built = os.path.join(folder, "program.cs"), os.path.join(folder, "program.exe")
        with open(source, "w", encoding="ascii") as file:
            file.write(program)
        csharp = os.path.join(BINDINGS, "csharp")
        run(compiler, "@" + os.path.join(csharp, "Tests~", "mcs.rsp"), "-warnaserror", "-out:" + built, source,
            os.path.join(csharp, "Runtime", "Native.g.cs"))
        printed = subprocess.run([runtime, built], check=True, stdout=subprocess.PIPE, text=True).stdout
        entries = len(STRUCTS) + sum(len(s["fields"]) for s in STRUCTS)
        assert printed == f"{entries} entries\n", printed


def javascript(node):
    script = """import { structs, functions } from "./layout.mjs";
const sizes = { u8: 1, char: 1, i32: 4, u32: 4, i64: 8, u64: 8, count: 8, f32: 4, f64: 8, pointer: 4 };
const size = type => sizes[type] ?? structs[type].size;
for (const [name, { size: whole, fields }] of Object.entries(structs)) {
  let end = 0;
  for (const [field, [offset, type, elements]] of Object.entries(fields)) {
    if (offset < end || offset >= end + 8) throw new Error(`${name}.${field} begins at ${offset}, after ${end}`);
    end = offset + size(type) * elements;
  }
  if (whole < end || whole >= end + 8) throw new Error(`${name} has ${whole} bytes, its fields end at ${end}`);
}
for (const [name, [, parameters]] of Object.entries(functions))
  for (const type of parameters) if (!(type in sizes)) throw new Error(`${name}: ${type}`);
"""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(BINDINGS, "js", "layout.js"), encoding="utf-8") as file:
            layout = file.read()
        for name, text in (("layout.mjs", layout), ("test.mjs", script)):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        run(node, os.path.join(folder, "test.mjs"))


def main():
    language, *programs = sys.argv[1:]
    if any(p.endswith("NOTFOUND") for p in programs):
        print(f"SKIPPED: no program for {language} was found, so nobody has read its layer")
        sys.exit(77)
    {"python": python, "rust": rust, "csharp": csharp, "javascript": javascript}[language](*programs)


if __name__ == "__main__":
    main()
