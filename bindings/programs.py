"""usage: programs.py PAGE LANGUAGE BUILD_FOLDER [WORDS]: runs the program in that language on a page (docs/get-started.md,
docs/go.md, docs/java.md) against the libraries in a build folder; C, C++, Python, C#, Rust and JavaScript by the commands that
docs/get-started.md gives. It has to print these words: without any, the hash of its contacts, the same in every language.
Ends with 77, and says why, if the language's tools or package are missing."""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

HASH = "20dfe036a1d1bec0"
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
START = os.path.join(ROOT, "docs", "get-started.md")


def skip(why):
    print(f"SKIPPED: {why}")
    sys.exit(77)


def need(*tools):
    for tool in tools:
        if not shutil.which(tool):
            skip(f"there is no {tool}: the program is not run")


def block(page, language, words="", tab=""):
    """The only block of a language on a page, or in one of its tabs, among the blocks with these words."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    if tab:
        text = text.split(f"<summary><b>{tab}</b></summary>", 1)[1].split("</details>", 1)[0]
    found = [text for text in re.findall(rf"^```{language}\n(.*?)^```$", text, flags=re.S | re.M) if words in text]
    if len(found) != 1:
        sys.exit(f"{page} has {len(found)} blocks of {language} with {words!r}, not one")
    return found[0]


def write(folder, name, text):
    path = os.path.join(folder, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


class Program:
    def __init__(self, page, build, folder):
        self.page, self.build, self.folder = page, build, folder
        self.library = os.path.join(build, "src")
        # As in a clone, with the build folder where ./dev demo has it.
        os.makedirs(os.path.join(folder, "build"))
        os.symlink(build, os.path.join(folder, "build", "release"))
        for name in ("bindings", "include"):
            os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))

    def run(self, *command, **variables):
        """Runs a command in the folder; what it printed."""
        done = subprocess.run(command, cwd=self.folder, env={**os.environ, "PWD": self.folder, **variables}, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode:
            sys.exit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stdout}")
        return done.stdout

    def commands(self, tab, leave_out=None, **variables):
        """Runs the commands of a tab of docs/get-started.md, which a binding's README repeats; what they printed."""
        lines = block(START, "sh", "program", tab).splitlines()
        kept = "\n".join(line for line in lines if not leave_out or not line.startswith(leave_out))
        return self.run("sh", "-ec", kept, **variables)

    def write(self, name, language):
        return write(self.folder, name, block(self.page, language))

    def go(self):
        need("go", "cc")
        self.write("main.go", "go")
        write(self.folder, "go.mod", "module program\n\ngo 1.21\n")
        self.run("go", "build", "-o", "program", ".", CGO_ENABLED="1", CGO_CFLAGS=f"-I{ROOT}/include",
                 CGO_LDFLAGS=f"-L{self.library}", GOFLAGS="-mod=mod -buildvcs=false", GOTOOLCHAIN="local")
        return self.run("./program", GODEBUG="cgocheck=1", LD_LIBRARY_PATH=self.library)

    def java(self):
        need("java", "javac", "cc")
        home = os.path.dirname(os.path.dirname(os.path.realpath(shutil.which("javac"))))
        headers = glob.glob(os.path.join(home, "include", "**", "jni*.h"), recursive=True)
        if not headers:
            skip(f"there is no jni.h in {home}: the program is not run")
        self.write("Vox.java", "java")
        self.write("voxjni.c", "c")
        includes = [f"-I{folder}" for folder in sorted({os.path.dirname(path) for path in headers})]
        self.run("cc", "-shared", "-fPIC", "-Wall", "-Werror", *includes, f"-I{ROOT}/include", "-o", "libvoxjni.so",
                 "voxjni.c", f"-L{self.library}", "-lvox")
        self.run("javac", "-Xlint:all", "-Werror", "Vox.java")
        return self.run("java", "-Xcheck:jni", "-Djava.library.path=.", "Vox", LD_LIBRARY_PATH=self.library)

    def c(self):
        need("cc")
        self.write("program.c", "c")
        return self.commands("C")

    def cpp(self):
        need("c++")
        self.write("program.cpp", "cpp")
        return self.commands("C++")

    def python(self):
        if not os.path.exists(os.path.join(HERE, "python", "src", "voxtet", "__init__.py")):
            skip("the Python package is not here")
        self.write("program.py", "python")
        for python in (sys.executable, "/usr/bin/python3"):
            if os.path.exists(python) and not subprocess.run([python, "-c", "import numpy"], capture_output=True).returncode:
                path = os.pathsep.join([os.path.dirname(python), os.environ["PATH"]])
                return self.commands("Python", PATH=path, PYTHONDONTWRITEBYTECODE="1")
        return skip("there is no numpy: the program is not run")

    def csharp(self):
        need("mcs", "mono")
        self.write("program.cs", "csharp")
        return self.commands("C#")

    def rust(self):
        need("cargo")
        self.write("src/main.rs", "rust")
        dependency = block(START, "toml")
        write(self.folder, "Cargo.toml", f'[package]\nname = "program"\nversion = "0.0.0"\nedition = "2021"\n\n{dependency}')
        if subprocess.run(["cargo", "fetch", "--quiet"], cwd=self.folder, capture_output=True).returncode:
            skip("crates cannot be fetched: the program is not run")
        return self.commands("Rust", CARGO_TARGET_DIR=os.path.join(self.build, "rust"), CARGO_PROFILE_DEV_DEBUG="0",
                             CARGO_INCREMENTAL="0", CARGO_NET_OFFLINE="true", CARGO_TERM_QUIET="true")

    def javascript(self):
        need("node", "npm")
        if not glob.glob(os.path.join(HERE, "js", "*.wasm")):
            skip("the module is not built")
        self.write("program.mjs", "js")
        return self.commands("JavaScript", leave_out="bindings/js/build") # which the binding's own test runs


def main():
    page, language, build = sys.argv[1], sys.argv[2], os.path.abspath(sys.argv[3])
    words = sys.argv[4:] or [HASH]
    with tempfile.TemporaryDirectory() as folder:
        printed = getattr(Program(page, build, folder), language)()
    print(printed, end="")
    if not set(words) <= set(printed.split()):
        sys.exit(f"the program in {language} on {page} did not print {' '.join(words)}")


if __name__ == "__main__":
    main()
