"""usage: macho.py FOLDER: checks the macOS libraries in FOLDER/lib and the programs in FOLDER/bin, which nothing but macOS can
load: those for Arm are signed, each asks for libraries of the system and for those that it finds beside it, and the libraries
export the functions of their headers and no others."""

import pathlib
import re
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from public_functions import public_functions  # noqa: E402

# Commands of a Mach-O file (mach-o/loader.h).
SYMTAB, LOAD_DYLIB, ID_DYLIB, CODE_SIGNATURE, RPATH, BUILD_VERSION = 0x2, 0xC, 0xD, 0x1D, 0x8000001C, 0x32
DEFINED, EXTERNAL, PRIVATE, STAB = 0xE, 0x1, 0x10, 0xE0
ARM = 0x0100000C  # which runs nothing unsigned
# The operators new and delete, which C++ lets any program replace: in the C++ library inside, which says so by making them weak.
REPLACEABLE = re.compile(r"__Z(n[aw]|d[al])")
OF_THE_LINKER = {"__mh_dylib_header", "___dso_handle"}


class MachO:
    def __init__(self, path):
        data = path.read_bytes()
        magic, self.machine, _, _, count, _, _, _ = struct.unpack_from("<8I", data)
        if magic != 0xFEEDFACF:
            sys.exit(f"{path}: no Mach-O file of 64 bits")
        self.name, self.loads, self.search, self.signed, self.oldest, self.exported = None, [], [], False, None, set()
        at = 32
        for _ in range(count):
            command, size = struct.unpack_from("<2I", data, at)
            if command in (LOAD_DYLIB, ID_DYLIB, RPATH):
                start = at + struct.unpack_from("<I", data, at + 8)[0]
                text = data[start:at + size].split(b"\0")[0].decode()
                if command == ID_DYLIB:
                    self.name = text
                else:
                    (self.search if command == RPATH else self.loads).append(text)
            elif command == CODE_SIGNATURE:
                self.signed = True
            elif command == BUILD_VERSION:
                version = struct.unpack_from("<I", data, at + 12)[0]
                self.oldest = f"{version >> 16}.{version >> 8 & 255}"
            elif command == SYMTAB:
                symbols, how_many, strings, _ = struct.unpack_from("<4I", data, at + 8)
                for i in range(how_many):
                    where, flags = struct.unpack_from("<IB", data, symbols + 16 * i)
                    if flags & EXTERNAL and not flags & (PRIVATE | STAB) and flags & DEFINED:
                        start = strings + where
                        self.exported.add(data[start:data.index(b"\0", start)].decode())
            at += size


def main():
    folder = pathlib.Path(sys.argv[1])
    functions = {library: {"_" + name for name in names} for library, names in public_functions().items()}
    libraries = sorted((folder / "lib").glob("*.dylib"))
    faults = [] if len(libraries) == len(functions) else [f"{len(libraries)} libraries, expected {len(functions)}"]
    for path in [*libraries, *sorted((folder / "bin").iterdir())]:
        file = MachO(path)
        is_library = path.parent.name == "lib"
        say = lambda text: faults.append(f"{path.name}: {text}")
        if file.machine == ARM and not file.signed:
            say("not signed")
        if is_library and file.name != f"@rpath/{path.name}":
            say(f"its install name is {file.name}")
        for name in file.loads:
            if name == "/usr/lib/libSystem.B.dylib":
                continue
            places = [place.replace("@loader_path", str(path.parent), 1) for place in file.search]
            if not name.startswith("@rpath/") or not any(pathlib.Path(name.replace("@rpath", place, 1)).is_file() for place in places):
                say(f"does not find {name} by {file.search}")
        if is_library:
            exported = {name for name in file.exported - OF_THE_LINKER if not REPLACEABLE.match(name)}
            wanted = functions[path.name.split(".")[0].removeprefix("lib")]
            if exported != wanted:
                say(f"exports too much: {sorted(exported - wanted)}, too little: {sorted(wanted - exported)}")
        print(f"{path.name}: macOS {file.oldest}, {path.stat().st_size} bytes, loads {' '.join(file.loads)}")
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
