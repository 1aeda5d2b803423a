#!/usr/bin/env python3
"""Builds vox_cuda for every architecture, without a GPU, and looks at what the compiler made of the kernels.

usage: cuda.py [--arch N...]     e.g. --arch 90 for one architecture alone

Takes nvcc from the pinned Python packages below, which it installs into build/cuda (270 MB). Fails for a fused operation in the
PTX (it rounds once where the error bounds count two), a spill, a stack or more registers than the limits below, and a library
that is too large."""

import argparse
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "cuda"
TOOLKIT = FOLDER / "nvidia" / "cu13"
PACKAGES = ["nvidia-cuda-nvcc==13.0.88", "nvidia-nvvm==13.0.88", "nvidia-cuda-crt==13.0.88", "nvidia-cuda-runtime==13.0.96",
            "nvidia-cuda-cccl==13.0.85"]
MOST_BYTES = 4_000_000
MOST_STACK = 64
# A lane's registers: of groups, whose speed depends on how many run at a time, and of the short exact kernels.
MOST_REGISTERS = {"run_groups": 80, "run_counted": 96, "run_items": 40}
KERNELS = {"Clear", "Gather", "MarkTiles", "FindRisk", "PlacePoints", "LookUp", "Decide", "PlaceHits", "KeepHits", "WriteContacts"}
FUSED = re.compile(r"\bfma\.(?:rn|rz|rm|rp)")


def install():
    mark = FOLDER / "packages.txt"
    if not mark.exists() or mark.read_text(encoding="utf-8") != "\n".join(PACKAGES):
        subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--upgrade", "--target", FOLDER, *PACKAGES], check=True)
        mark.write_text("\n".join(PACKAGES), encoding="utf-8")
    for link, target in ((TOOLKIT / "lib64", "lib"), (TOOLKIT / "lib" / "libcudart.so", "libcudart.so.13")):
        if not link.is_symlink():
            link.symlink_to(target)


def build(architectures):
    """What was printed for cuda_backend.cu, and the command that compiled it."""
    tree = FOLDER / "tree"
    options = [f"-DVOX_BUILD_{part}=OFF" for part in ("IO", "SIM", "TOOLS", "TESTS", "EXAMPLES")]
    launcher = os.environ.get("CMAKE_CXX_COMPILER_LAUNCHER")
    options += [f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"] if launcher else []
    subprocess.run(["cmake", "-S", ROOT, "-B", tree, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DVOX_CUDA=ON", *options,
                    f"-DCMAKE_CUDA_COMPILER={TOOLKIT}/bin/nvcc", f"-DCMAKE_CUDA_ARCHITECTURES={architectures}",
                    "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"], check=True, stdout=subprocess.DEVNULL)
    for made in tree.glob("src/gpu/CMakeFiles/vox_cuda.dir/cuda_backend.cu.o"):
        made.unlink()  # so that the compiler speaks
    done = subprocess.run(["cmake", "--build", tree, "--target", "vox_cuda", "--verbose"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        sys.exit(done.stdout[-8000:])
    commands = json.loads((tree / "compile_commands.json").read_text(encoding="utf-8"))
    command, = (c["command"] for c in commands if c["file"].endswith("cuda_backend.cu"))
    return done.stdout, shlex.split(command), tree


def ptx_of(command):
    """For one architecture: operations are fused, or not, before ptxas sees them, and ptxas obeys."""
    out = FOLDER / "kernels.ptx"
    plain = [c for c in command if not c.startswith("--generate-code") and "--generate-code" not in c and c not in ("-x", "cu", "-c")]
    at = plain.index("-o")
    del plain[at:at + 2]
    source = next(c for c in plain if c.endswith(".cu"))
    plain.remove(source)
    subprocess.run([*plain, "-arch=compute_90", "-ptx", source, "-o", out], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return out.read_text(encoding="utf-8")


def kernels_of(log):
    """(launch, kernel, architecture, registers, stack, bytes spilled) of ours, from what ptxas says."""
    entry = re.compile(r"Compiling entry function '\w*?(run_\w+?)I\w*?\d(" + "|".join(KERNELS) + r")E\w*' for '(\w+)'\n"
                       r".*?(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads\n.*?Used (\d+) registers", re.S)
    for launch, kernel, architecture, stack, stores, loads, registers in entry.findall(log):
        yield launch, kernel, architecture, int(registers), int(stack), int(stores) + int(loads)


def faults_of(kernels, ptx, size):
    architectures = {k[2] for k in kernels}
    for architecture in sorted(architectures):
        missing = KERNELS - {k[1] for k in kernels if k[2] == architecture}
        if missing:
            yield f"{architecture}: ptxas says nothing of {', '.join(sorted(missing))}"
    if not architectures:
        yield "ptxas says nothing of any kernel"
    for launch, kernel, architecture, registers, stack, spilled in kernels:
        if spilled:
            yield f"{kernel} spills {spilled} bytes on {architecture}"
        if stack > MOST_STACK:
            yield f"{kernel} has a stack of {stack} bytes on {architecture}, at most {MOST_STACK} are allowed"
        if registers > MOST_REGISTERS[launch]:
            yield f"{kernel} takes {registers} registers on {architecture}, at most {MOST_REGISTERS[launch]} are allowed"
    if "LookUp" not in ptx:
        yield "the PTX has no kernels"
    if FUSED.search(ptx):
        yield f"{len(FUSED.findall(ptx))} fused operations in the PTX"
    if size > MOST_BYTES:
        yield f"the library has {size} bytes, at most {MOST_BYTES} are allowed"


def self_test():
    """Each fault is noticed."""
    sound = [(launch, kernel, "sm_90", 30, 0, 0) for launch, kernel in (("run_items", k) for k in KERNELS)]
    assert not list(faults_of(sound, "LookUp", 1))
    for kernels, ptx, size in ((sound[1:], "LookUp", 1), ([], "LookUp", 1), ([*sound, ("run_groups", "LookUp", "sm_90", 81, 0, 0)], "LookUp", 1),
                               ([*sound, ("run_groups", "LookUp", "sm_90", 8, 72, 0)], "LookUp", 1), (sound, "", 1), (sound, "LookUp", 5_000_000),
                               ([*sound, ("run_groups", "LookUp", "sm_90", 8, 0, 4)], "LookUp", 1), (sound, "LookUp fma.rn.f64 %f", 1)):
        assert len(list(faults_of(kernels, ptx, size))) == 1, (ptx, size)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arch", nargs="+", default=["75", "80", "86", "89", "90", "100", "120"])
    arguments = parser.parse_args()
    self_test()
    install()
    log, command, tree = build(";".join(f"{a}-real" for a in arguments.arch))
    kernels = list(kernels_of(log))
    size = os.path.getsize(os.path.realpath(tree / "src" / "gpu" / "libvox_cuda.so"))
    for launch, kernel, architecture, registers, stack, spilled in kernels:
        print(f"{architecture:7} {kernel:14} {registers:3} registers, stack {stack}, spilled {spilled}")
    print(f"libvox_cuda.so: {size} bytes")
    faults = list(faults_of(kernels, ptx_of(command), size))
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
