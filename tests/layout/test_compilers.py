"""What MSVC refuses, or 64-bit Windows takes for something else, stands only where the preprocessor asks for the compiler or
the system (the rules of CONTRIBUTING.md, "Compilers")."""

import re
import unittest

from repository import files, text_of

FOLDERS = ["include", "src", "tools", "examples", "scenes"]
# What an enclosing #if has to name.
ASKS = re.compile(r"__GNUC__|__clang__|_MSC_VER|_WIN32|__MINGW32__|__unix__|__linux__|__APPLE__|VOX_MSVC_X64|VOX_IO_POSIX|__SIZEOF_INT128__|__MINGW_PRINTF_FORMAT")
RULES = {
    "an attribute of gcc: [[...]], or a macro that is empty elsewhere": r"__attribute__",
    "a function built into gcc: <bit>, <cmath> or a fallback": r"__builtin_\w+",
    "assembly": r"\b(?:asm|__asm|__asm__)\b",
    "a statement expression of gcc: a lambda or a function": r"(?<![\w>\])])\(\s*\{",
    "a type of gcc: decltype, std::ptrdiff_t, fixed widths": r"\b(?:typeof|__typeof__|ssize_t|__int128)\b",
    "a type of 32 bits on Windows and of 64 elsewhere: fixed widths": r"(?<!long )\blong\b(?! (?:long|double)\b)",
    "an array without elements": r"^\s*(?!return\b)(?:[\w:<>]+[\s*&]+)+\w+\[0\]\s*;",
    "?: without its middle": r"\?\s*:(?!:)",
    "a range of cases": r"\bcase\b[^:;]*\.\.\.",
    "memory of the stack, of a size known at run time: Scratch, std::array": r"\balloca\s*\(",
    "a constant of POSIX: std::numbers": r"\bM_PI\b",
    "a header of POSIX": r"#\s*include\s*<(?:unistd\.h|poll\.h|fcntl\.h|pthread\.h|dlfcn\.h|sys/[\w.]+)>",
}


def code_of(text):
    """The text without what comments and literals say, line for line."""
    def blank(match):
        quote = match[0][0] if match[0][0] in "\"'" else ""
        return quote + "\n" * match[0].count("\n") + quote
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])\'', blank, text, flags=re.S)


def faults_of(path, text):
    found, conditions = [], []  # of each #if around the line: all that it and its #elif have asked
    for number, line in enumerate(code_of(text).split("\n"), 1):
        directive = re.match(r"\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b(.*)", line)
        if directive and directive[1].startswith("if"):
            conditions.append(directive[2])
        elif directive and directive[1] == "endif":
            conditions.pop()
        elif directive and directive[1] == "elif":
            conditions[-1] += directive[2]
        if any(ASKS.search(condition) for condition in conditions):
            continue
        for rule, pattern in RULES.items():
            if re.search(pattern, line):
                found.append(f"{path}:{number}: {rule}")
    return found


class Compilers(unittest.TestCase):
    def test_repository(self):
        found = []
        for folder in FOLDERS:
            for path in files(".h", ".hpp", ".c", ".cpp", under=folder):
                found += faults_of(path, text_of(path))
        self.assertEqual(found, [], "\n" + "\n".join(found))

    def test_each_fault_is_noticed(self):
        for line in ("__attribute__((packed)) int a;", "return __builtin_ctz(a);", 'asm volatile("nop");',
                     "int a = ({ int b = 1; b; });", "ssize_t a;", "unsigned long a;", "long a = 0;", "    float rest[0];",
                     "return a ?: b;", "case 1 ... 4:", "p = alloca(n);", "x = M_PI;", "#include <sys/mman.h>",
                     "#if defined(__GNUC__)\n#endif\nssize_t a;"):
            self.assertEqual(len(faults_of("a.cpp", line)), 1, line)

    def test_what_is_allowed(self):
        for line in ("unsigned long long a;", "long double a;", "// a long comment, ssize_t", 'f("long");', "max({a, b});",
                     "return a[0];", "x = a[0];", "a ? b : c;", "std::uint64_t a;", "allocate(n);",
                     "#if defined(__GNUC__)\n__attribute__((cold))\n#else\n#endif", "return f<int>({1});", "n = c[1] * c[0];"):
            self.assertEqual(faults_of("a.cpp", line), [], line)


if __name__ == "__main__":
    unittest.main()
