"""usage: programs.py PAGE LANGUAGE BUILD_FOLDER [WORDS]: runs the program in that language that stands on a page (README.md,
docs/other-languages.md), against the libraries in a build folder. It has to print these words: where none are given, the hash
of its contacts, the same in every language. Ends with 77, and says why, where the language's tools or package are missing."""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

HASH = "2812279c886bc8d6"
HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)


def skip(why):
    print(f"SKIPPED: {why}")
    sys.exit(77)


def need(*tools):
    for tool in tools:
        if not shutil.which(tool):
            skip(f"there is no {tool}: the program is not run")


def block(page, language):
    """The only block of a language on a page."""
    with open(page, encoding="utf-8") as file:
        found = re.findall(rf"^```{language}\n(.*?)^```$", file.read(), flags=re.S | re.M)
    if len(found) != 1:
        sys.exit(f"{page} has {len(found)} blocks of {language}, not one")
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
        self.libraries = [os.path.join(build, part) for part in ("src", "src/io", "src/sim")]
        path = os.pathsep.join([*self.libraries, os.environ.get("LD_LIBRARY_PATH", "")]).rstrip(os.pathsep)
        self.environment = dict(os.environ, LD_LIBRARY_PATH=path)

    def run(self, *command, **variables):
        """Runs a command in the folder; what it printed."""
        done = subprocess.run(command, cwd=self.folder, env={**self.environment, **variables}, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode:
            sys.exit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stdout}")
        return done.stdout

    def write(self, name, language):
        return write(self.folder, name, block(self.page, language))

    def go(self):
        need("go", "cc")
        self.write("main.go", "go")
        write(self.folder, "go.mod", "module program\n\ngo 1.21\n")
        self.run("go", "build", "-o", "program", ".", CGO_ENABLED="1", CGO_CFLAGS=f"-I{ROOT}/include",
                 CGO_LDFLAGS=f"-L{self.libraries[0]}", GOFLAGS="-mod=mod -buildvcs=false", GOTOOLCHAIN="local")
        return self.run("./program", GODEBUG="cgocheck=1")

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
                 "voxjni.c", f"-L{self.libraries[0]}", "-lvox")
        self.run("javac", "-Xlint:all", "-Werror", "Vox.java")
        return self.run("java", "-Xcheck:jni", "-Djava.library.path=.", "Vox")

    def python(self):
        if not os.path.exists(os.path.join(HERE, "python", "src", "voxtet", "__init__.py")):
            skip("the Python package is not here")
        program = self.write("program.py", "python")
        for python in (sys.executable, "/usr/bin/python3"):
            if os.path.exists(python) and not subprocess.run([python, "-c", "import numpy"], capture_output=True).returncode:
                return self.run(python, program, PYTHONPATH=os.path.join(HERE, "python", "src"),
                                VOXTET_LIBRARY_DIR=os.pathsep.join(self.libraries), PYTHONDONTWRITEBYTECODE="1")
        return skip("there is no numpy: the program is not run")

    def csharp(self):
        need("mcs", "mono")
        self.write("program.cs", "csharp")
        sources = sorted(glob.glob(os.path.join(HERE, "csharp", "Runtime", "*.cs")))
        options = ["mcs", f"@{HERE}/csharp/Tests~/mcs.rsp"]
        self.run(*options, "-target:library", "-out:Voxtet.dll", *sources)
        self.run(*options, "-r:Voxtet.dll", "-out:program.exe", "program.cs")
        return self.run("mono", "program.exe")

    def rust(self):
        need("cargo")
        self.write("src/main.rs", "rust")
        write(self.folder, "Cargo.toml", '[package]\nname = "program"\nversion = "0.0.0"\nedition = "2021"\n\n'
                                         f'[dependencies]\nvoxtet = {{ path = "{HERE}/rust/voxtet" }}\n')
        target = os.path.join(self.build, "rust")
        variables = dict(VOXTET_LIBRARY_DIR=os.pathsep.join(self.libraries), CARGO_TARGET_DIR=target)
        fetch = subprocess.run(["cargo", "fetch", "--quiet"], cwd=self.folder, capture_output=True, text=True)
        if fetch.returncode:
            skip("crates cannot be fetched: the program is not run")
        return self.run("cargo", "run", "--quiet", "--offline", **variables)

    def javascript(self):
        need("node")
        package = os.path.join(HERE, "js")
        if not os.path.exists(os.path.join(package, "voxtet.js")) or not glob.glob(os.path.join(package, "*.wasm")):
            skip("the JavaScript package is not built")
        os.makedirs(os.path.join(self.folder, "node_modules"))
        os.symlink(package, os.path.join(self.folder, "node_modules", "voxtet"))
        self.write("program.mjs", "js")
        return self.run("node", "program.mjs")


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
