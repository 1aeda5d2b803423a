"""The binary interface as text: every function, and every number of the headers as a C compiler sees it (sizes, offsets,
enumerators, limits), one a line, compared with the checked-in NAME.txt of each header.
usage: layout.py COMPILER [--renew]"""

import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(HERE, "..", "..", "bindings", "generator"))
import header  # noqa: E402

INCLUDE = os.path.join(HERE, "..", "..", "include")
HEADERS = ["vox", "vox_query", "vox_cell_size", "vox_surface", "vox_io", "vox_sim", "vox_dist"]


def numbers(parsed):
    """C expressions under the names they have in the text."""
    for name in parsed.constants:
        yield f"constant {name}", name
    for declaration in parsed.of_kind("enum"):
        yield f"sizeof {declaration.name}", f"sizeof({declaration.name})"
        for enumerator in declaration.fields:
            yield f"enumerator {enumerator}", enumerator
    for declaration in parsed.of_kind("alias"):
        yield f"sizeof {declaration.name}", f"sizeof({declaration.name})"
    for declaration in parsed.of_kind("struct"):
        yield f"sizeof {declaration.name}", f"sizeof({declaration.name})"
        for type_text, name in declaration.fields:
            place = f"({declaration.name}, {name})"
            yield f"field {declaration.name}.{name}: {type_text}, at", f"offsetof{place}"


def functions(parsed):
    for f in parsed.of_kind("function", "callback"):
        promise = "callback" if f.kind == "callback" else "stable" if f.stable else "experimental"
        parameters = ", ".join(t for t, _ in f.parameters) or "void"
        yield f"{promise} {f.result} {f.name}({parameters})"


def layout(name, compiler):
    parsed = header.read(os.path.join(INCLUDE, "vox", name + ".h"))
    lines = ["#include <stdio.h>", f"#include <vox/{name}.h>", "int main(void) {"]
    lines += [f'    printf("{text} %lld\\n", (long long)({number}));' for text, number in numbers(parsed)]
    with tempfile.TemporaryDirectory() as folder:
        source, program = os.path.join(folder, "layout.c"), os.path.join(folder, "layout")
        with open(source, "w", encoding="ascii") as file:
            file.write("\n".join(lines + ["    return 0;", "}", ""]))
        # The inline functions name functions of the library, which is not linked: they are optimised away.
        subprocess.run([compiler, "-std=c99", "-O1", "-I", INCLUDE, source, "-o", program], check=True)
        printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    return "".join(f + "\n" for f in functions(parsed)) + printed


def key_and_number(line):
    """A function is all key."""
    return (line, "") if line.endswith(")") else tuple(line.rsplit(" ", 1))


def differences(expected, found):
    """Lines that break programs built with the old headers, and lines that are merely new. A struct that begins with
    struct_size may become larger."""
    was, now = (dict(map(key_and_number, lines)) for lines in (expected, found))
    broken = []
    for key, number in was.items():
        grown = (key.startswith("sizeof ") and f"field {key.split()[1]}.struct_size: uint32_t, at" in was
                 and int(now.get(key, 0)) > int(number))
        if now.get(key) != number and not grown:
            broken.append(f"{key} {number} -> {now.get(key, 'gone')}")
    return broken, [f"{key} {number}" for key, number in now.items() if key not in was or key.startswith("sizeof ")
                    and now[key] != was[key] and f"{key} {was[key]} -> {number}" not in broken]


def breaks_promises(name, broken):
    """Experimental functions promise nothing, nor does a header that says so of all that it declares."""
    with open(os.path.join(INCLUDE, "vox", name + ".h"), encoding="utf-8") as file:
        if re.search("Everything (here|that this header declares) is experimental", file.read()):
            return False
    return any(not line.startswith("experimental ") for line in broken)


def abi_version_was_raised():
    with open(os.path.join(HERE, "vox.txt"), encoding="ascii") as file:
        was = re.search(r"^constant VOX_ABI_VERSION (\d+)$", file.read(), flags=re.M)
    with open(os.path.join(INCLUDE, "vox", "vox.h"), encoding="utf-8") as file:
        now = re.search(r"^#define VOX_ABI_VERSION (\d+)$", file.read(), flags=re.M)
    return was is not None and int(now[1]) > int(was[1])


def main():
    compiler, renew = sys.argv[1], "--renew" in sys.argv[2:]
    differ, raised = False, abi_version_was_raised()
    for name in HEADERS:
        path = os.path.join(HERE, name + ".txt")
        found = layout(name, compiler)
        with open(path, encoding="ascii") as file:
            expected = file.read()
        broken, added = differences(expected.splitlines(), found.splitlines())
        if renew:
            if breaks_promises(name, broken) and not raised:
                print(f"vox/{name}.h breaks programs; raise VOX_ABI_VERSION if it has to be:\n  " + "\n  ".join(broken))
                return 1
            with open(path, "w", encoding="ascii") as file:
                file.write(found)
            continue
        differ = differ or bool(broken or added)
        print(f"vox/{name}.h: {len(found.splitlines())} lines, {len(broken)} break programs, {len(added)} are new")
        for line in broken + added:
            print("  " + line)
    if differ:
        print("If this is meant to be so: ./dev abi --renew")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
