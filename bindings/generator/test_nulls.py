"""Null pointers are refused where bindings/api.json says so, with the name of the parameter, and only there: what it says
of them was not guessed. usage: test_nulls.py NAME=LIBRARY... for each header, in the order vox, vox_query, vox_cell_size, vox_surface,
vox_io, vox_sim."""

import ctypes
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
BINDINGS = os.path.dirname(HERE)
sys.path.insert(0, HERE)
from python_layer import _c  # noqa: E402

with open(os.path.join(BINDINGS, "api.json"), encoding="utf-8") as file:
    API = json.load(file)

SKIPPED = {
    "vox_fail": "it fails with the text that it is given",
    "vox_io_write_to": "null for desc is refused as what it stands for, defaults that need a file's name",
}
ROOM = 1 << 16
POSITIONS = (ctypes.c_double * 12)(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
TETS = (ctypes.c_uint32 * 4)(0, 1, 2, 3)


class Nulls:
    def __init__(self, libraries):
        self.libraries = libraries
        self.core = libraries["vox"]
        self.core.vox_last_error.restype = ctypes.c_char_p
        self.structs = {s["name"]: s for part in API["headers"] for s in part["structs"]}
        self.keep = []
        self.calls = self.refused = 0
        self.faults = []

    def check(self, result):
        if result != 0:
            raise RuntimeError(self.text())

    def text(self):
        return self.core.vox_last_error().decode()

    def struct(self, name, is_empty=False):
        """One with its defaults, and what no default can give."""
        value = getattr(_c, name)()
        described = self.structs[name]
        if described["grows"]:
            value.struct_size = ctypes.sizeof(value)
        for field, default in (described["defaults"] or {}).items():
            if isinstance(default, list):
                getattr(value, field)[:] = default
            else:
                setattr(value, field, default)
        for f in described["fields"]:
            if f.get("base") == "vox_positions":
                setattr(value, f["name"], _c.vox_positions(ctypes.addressof(POSITIONS), 4, _c.Format.DOUBLE))
            elif f["name"] in ("positions", "tets") and "in" in f.get("direction", ""):
                setattr(value, f["name"], ctypes.addressof(POSITIONS if f["name"] == "positions" else TETS))
            elif f["name"] in ("vertex_count", "tet_count"):
                setattr(value, f["name"], 4 if f["name"] == "vertex_count" else 1)
        if name == "vox_positions":
            value.data, value.count, value.format = ctypes.addressof(POSITIONS), 0 if is_empty else 4, _c.Format.DOUBLE
        elif name == "vox_primitives":
            value.count = 4
        elif name == "vox_foreign_grid":
            value.stored = ctypes.pointer(self.struct("vox_primitives"))
        elif name == "vox_surface_desc":
            value.faces, value.face_count = ctypes.addressof(TETS), 1
        elif name == "vox_io_write_desc":
            value.format = _c.IoWriteFormat.VTU
        elif name == "vox_io_sink":
            value.write = _c.vox_io_sink_write(lambda data, size, user: 0)
        self.keep.append(value)
        return value

    def objects(self, is_mesh_empty):
        """One object of each opaque type that a library gives, with a mesh; new ones for each call."""
        found = {}

        def create(type_name, library, function, *arguments):
            out = ctypes.c_void_p()
            self.check(getattr(library, function)(*arguments, ctypes.byref(out)))
            found[type_name] = out.value

        create("vox_grid", self.core, "vox_grid_create", None)
        mesh = ctypes.c_uint32()
        desc = self.struct("vox_mesh_desc")
        if is_mesh_empty:
            desc.positions.count = desc.tet_count = 0
        self.check(self.core.vox_mesh_insert(found["vox_grid"], ctypes.byref(desc), ctypes.byref(mesh)))
        found["vox_body"] = mesh.value
        self.check(self.core.vox_grid_step(found["vox_grid"]))
        create("vox_locator", self.core, "vox_grid_update_locator", found["vox_grid"])
        if "vox_surface" in self.libraries:
            create("vox_surface", self.core, "vox_surface_create", ctypes.byref(self.struct("vox_surface_desc")))
            self.check(self.core.vox_surface_move(found["vox_surface"], ctypes.byref(self.struct("vox_motion"))))
        if "vox_io" in self.libraries:
            create("vox_io_mesh", self.libraries["vox_io"], "vox_io_make_box", 1.0, 1.0, 1.0, 1.0)
        if "vox_sim" in self.libraries:
            create("vox_sim", self.libraries["vox_sim"], "vox_sim_create", None)
            desc = self.struct("vox_sim_body_desc")
            self.check(self.libraries["vox_sim"].vox_sim_body_insert(found["vox_sim"], ctypes.byref(desc),
                                                                     ctypes.byref(mesh)))
            found["vox_body"] = mesh.value
        return found

    def destroy(self, objects):
        for type_name, release in (("vox_locator", "vox_locator_release"), ("vox_grid", "vox_grid_destroy"),
                                   ("vox_io_mesh", "vox_io_mesh_destroy"),
                                   ("vox_surface", "vox_surface_destroy"), ("vox_sim", "vox_sim_destroy")):
            for library in self.libraries.values():
                if type_name in objects and hasattr(library, release):
                    getattr(library, release)(objects[type_name])
                    break

    def argument(self, p, objects, is_empty):
        """A value that is sound, or is refused for another reason than that it is null."""
        if "length" not in p and p["kind"] != "callback":
            if p["name"] == "struct_size":
                return 64
            if p["kind"] == "alias":
                return objects.get("vox_" + p["name"], objects["vox_body"])
            number = p["base"] in ("float", "double")
            counts = p["name"] in ("count", "capacity") or p["name"].endswith(("count", "size"))
            return 1.0 if number else (0 if is_empty else 1) if counts else 0
        if p["kind"] == "callback":
            return getattr(_c, p["base"])(lambda *arguments: 1.0)
        if p["kind"] == "opaque" and "target" not in p:
            if p["pointers"] == 2:
                grids = (ctypes.c_void_p * 1)(objects["vox_grid"])
                self.keep.append(grids)
                return ctypes.addressof(grids)
            return objects[p["base"]]
        if p["length"] == "text":
            return b"/nonexistent/mesh.vtu"
        if p["kind"] == "struct" and p["direction"] != "out":
            value = self.struct(p["base"], is_empty)
            return ctypes.byref(value) if p["length"] == 1 else ctypes.addressof(value)
        room = ctypes.create_string_buffer(ROOM)
        self.keep.append(room)
        return ctypes.c_void_p(ctypes.addressof(room))

    def call(self, library, f, null, is_empty=False):
        """The text of the failure with `null` as the only null pointer, or "" if the call succeeds."""
        objects = self.objects(is_empty and any("body." in str(p.get("length")) for p in f["parameters"]))
        types_of = _c.FUNCTIONS[library][f["name"]][1]
        arguments = []
        for p, type_of in zip(f["parameters"], types_of):
            if p is not null:
                value = self.argument(p, objects, is_empty)
            else:
                value = type_of() if p["kind"] == "callback" else None
            if isinstance(value, ctypes.c_void_p) and type_of is not ctypes.c_void_p:
                value = ctypes.cast(value, type_of)
            arguments.append(value)
        function = getattr(self.libraries[library], f["name"])
        failed = function(*arguments) != 0
        text = self.text() if failed else ""
        self.destroy(objects)
        self.keep.clear()
        self.calls += 1
        return text

    def ask(self, library, f):
        for p in f["parameters"]:
            if "nullable" not in p or p.get("length") == "opaque":
                continue
            words = f"{p['name']} is null"
            text = self.call(library, f, p)
            is_refused = "null" in text
            self.refused += is_refused
            if p["nullable"] is True and is_refused:
                self.faults.append(f"{f['name']}: {p['name']} may be null, and was refused: {text}")
            if p["nullable"] is not True and words not in text:
                self.faults.append(f"{f['name']}: null for {p['name']} gave \"{text}\", expected \"{words}\"")
            if p["nullable"] == "if empty" and not p.get("asked"):  # an object says how long the others are
                text = self.call(library, f, p, is_empty=True)
                if words in text and not self.call(library, f, None, is_empty=True):
                    self.faults.append(f"{f['name']}: no {p['name']}, given as null, were refused: {text}")


def main():
    libraries, loaded = {}, {}
    for argument in sys.argv[1:]:
        name, path = argument.split("=", 1)
        libraries[name] = loaded.get(path) or ctypes.CDLL(path)
        loaded[path] = libraries[name]  # one object, which knows the types of all headers of that library
        _c.declare(libraries[name], name)
    nulls = Nulls(libraries)
    for part in API["headers"]:
        for f in part["functions"] if part["name"] in libraries else []:
            if f["result"].get("base") == "vox_result" and f["name"] not in SKIPPED:
                nulls.ask(part["name"], f)
    print(f"{nulls.calls} calls, {nulls.refused} refused for a null pointer")
    if nulls.faults:
        sys.exit("\n".join(nulls.faults))
    if nulls.refused < 50:
        sys.exit("too few calls were refused: they did not reach the library")


if __name__ == "__main__":
    main()
