"""The command line: `vox` and `python -m voxtet` run the native tool of the package."""

from __future__ import annotations

import os
import sys

from ._library import tool
from .errors import MissingFileError


def main() -> None:
    """Runs the tool with the arguments of this process, and ends with its status."""
    try:
        arguments = [tool(), *sys.argv[1:]]
    except MissingFileError as error:
        sys.exit(f"voxtet: {error}")
    if sys.platform == "win32":
        import subprocess
        sys.exit(subprocess.call(arguments))
    os.execv(arguments[0], arguments)


if __name__ == "__main__":
    main()
