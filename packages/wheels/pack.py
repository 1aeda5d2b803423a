"""usage: pack.py TARGET BUILT DROP OUT: packs a wheel for a target of zig into the folder OUT, from the build folder of
tests/portability and the source drop that it was built from."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

MACHINES = {"aarch64-macos": "arm64", "x86_64-windows": "amd64"}


def platform_tag(target):
    """What the names of wheels call a target: x86_64-linux-gnu.2.17 is manylinux_2_17_x86_64."""
    machine, system, *rest = re.split(r"[-.]", target)
    name = MACHINES.get(f"{machine}-{system}", machine)
    if system == "macos":
        return f"macosx_{'_'.join((rest + ['11', '0'])[:2])}_{name}"
    if system == "windows":
        return f"win_{name}"
    if rest[0] == "musl":
        return f"musllinux_1_2_{name}"
    return f"manylinux_{'_'.join(rest[1:])}_{name}"


def main():
    target, built, drop, out = sys.argv[1], *map(pathlib.Path, sys.argv[2:])
    out.mkdir(parents=True, exist_ok=True)
    out = out.resolve()
    with tempfile.TemporaryDirectory() as scratch:
        wheel = pathlib.Path(scratch, "wheel")
        shutil.copytree(drop / "bindings/python/src", wheel)
        subprocess.run(["cmake", "--install", str(built), "--component", "voxtet", "--prefix", str(wheel)], check=True)
        # The standard hook of the build backend writes the metadata; only the name of the platform is not that of this machine.
        hook = "import sys, scikit_build_core.build as b; b.prepare_metadata_for_build_wheel(sys.argv[1])"
        subprocess.run([sys.executable, "-c", hook, str(wheel)], cwd=drop, check=True)
        (info,) = wheel.glob("*.dist-info")
        (info / "WHEEL").write_text("Wheel-Version: 1.0\nGenerator: voxtet\nRoot-Is-Purelib: false\n"
                                    f"Tag: py3-none-{platform_tag(target)}\n")
        missing = [path.name for path in (drop / "third_party").iterdir()
                   if not (info / "licenses/third_party" / path.name / "LICENSE").is_file()]
        if missing:
            sys.exit(f"pack.py: the wheel lacks the licences of {missing}")
        made = 315532800 + 86400  # the same bytes whenever it is packed
        environment = dict(os.environ, SOURCE_DATE_EPOCH=str(made))
        subprocess.run([sys.executable, "-m", "wheel", "pack", "-d", str(out), str(wheel)], check=True, env=environment)


if __name__ == "__main__":
    main()
