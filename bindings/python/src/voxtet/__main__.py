"""The command line: `vox` and `python -m voxtet` run the native tool of the package."""

from __future__ import annotations

import os
import sys


def main() -> None:
    """Runs the tool with the arguments of this process, and ends with its status."""
    name = "vox.exe" if sys.platform == "win32" else "vox"
    tool = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", name)
    if not os.path.exists(tool):
        sys.exit(f"voxtet: there is no {tool}; the wheels have it")
    arguments = [tool, *sys.argv[1:]]
    if sys.platform == "win32":
        import subprocess
        sys.exit(subprocess.call(arguments))
    os.execv(tool, arguments)


if __name__ == "__main__":
    main()
