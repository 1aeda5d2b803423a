"""What the tests of this folder share: the files of the repository, as a list of (path, text)."""

import os

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SKIPPED = {"build", ".git", ".cache", "__pycache__", "bindings", "node_modules"}


def files(*endings, under="", root=ROOT):
    """Paths relative to `root`, sorted, of files whose name has one of these endings."""
    found = []
    for folder, folders, names in os.walk(os.path.join(root, under)):
        folders[:] = sorted(f for f in folders if f not in SKIPPED)
        for name in names:
            if name.endswith(endings):
                found.append(os.path.relpath(os.path.join(folder, name), root).replace(os.sep, "/"))
    return sorted(found)


def text_of(path, root=ROOT):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()
