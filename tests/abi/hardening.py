"""usage: hardening.py READELF FILE FLAG...: what the flags, and those of the linker, have done to a library or
program: read-only relocations, a stack that is not executable, calls of the stack protector and of fortified functions,
landing pads at functions, a program that exports nothing, and a library that is never unloaded."""
import re
import subprocess
import sys

READELF, FILE, *FLAGS = sys.argv[1:]


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main():
    segments = output(READELF, "-lW", FILE)
    dynamic = output(READELF, "-dW", FILE)
    symbols = [line.split() for line in output(READELF, "--dyn-syms", "-W", FILE).splitlines()]
    symbols = [fields for fields in symbols if len(fields) >= 8 and fields[0].rstrip(":").isdigit()]
    imported = {fields[7].split("@")[0] for fields in symbols if fields[6] == "UND"}
    exported = {fields[7].split("@")[0] for fields in symbols if fields[6] != "UND"}
    functions = [(fields[7], int(fields[1], 16)) for fields in symbols if fields[3] == "FUNC" and fields[6] != "UND"]
    is_program = "INTERP" in segments

    failures = []

    def check(holds, text):
        if not holds:
            failures.append(text)

    check(re.search(r"Elf file type is DYN", segments), "it cannot be loaded anywhere: no PIC or PIE")
    check(re.search(r"GNU_RELRO", segments), "relocations stay writable: no GNU_RELRO")
    check(re.search(r"FLAGS_1.*\bNOW\b", dynamic), "functions are bound lazily: no NOW")
    check(re.search(r"GNU_STACK.*\bRW\b", segments), "the stack is executable, or nothing says that it is not")
    if "-fstack-protector-strong" in FLAGS:
        check("__stack_chk_fail" in imported, "no function has a stack protector: __stack_chk_fail is not called")
    if "-D_FORTIFY_SOURCE=2" in FLAGS:
        check(any(re.fullmatch(r"__\w+_chk", name) for name in imported),
              "no C function is fortified: none of __*_chk is called")
    if not is_program:
        check(re.search(r"FLAGS_1.*\bNODELETE\b", dynamic), "it can be unloaded under its threads: no NODELETE")
    if is_program:
        # An instantiation of the C++ runtime's templates that a shared library has as well is one for both.
        own = {name for name in exported if not re.match(r"_ZN?K?St", name)}
        check(not own, f"it exports {len(own)} symbols: {' '.join(sorted(own)[:5])} ...")
    # endbr64; bti c or paciasp
    pads = {"-fcf-protection=full": ["f30f1efa"], "-mbranch-protection=standard": ["5f2403d5", "3f2303d5"]}
    text = re.search(r" \.text +PROGBITS +(\w+) (\w+)", output(READELF, "-SW", FILE))
    start, offset = (int(number, 16) for number in text.groups())
    with open(FILE, "rb") as file:
        code = file.read()
    for flag, instructions in pads.items():
        if flag not in FLAGS or is_program:
            continue
        check(functions, "it exports no function")
        for name, address in functions:
            first = code[address - start + offset:][:4].hex()
            check(first in instructions, f"{name} begins with {first}, no landing pad")
    for failure in failures:
        print(f"{FILE}: {failure}")
    return 1 if failures else 0


sys.exit(main())
