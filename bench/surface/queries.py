#!/usr/bin/env python3
"""True contacts that vox must not lose: every query of Sample-Queries
(https://github.com/Continuous-Collision-Detection/Sample-Queries, MIT), a vertex and a face or two edges that move, with the truth in
rational numbers. Checks that each true one is among the pairs, also with VOX_MOTION_CULL, and has a time of contact.

usage: queries.py LIBVOX FOLDER    FOLDER holds the folders of the data, SCENE/vertex-face/*.csv and SCENE/edge-edge/*.csv"""

import argparse
import ctypes
import glob
import os
from fractions import Fraction

import numpy as np

import pairs
import safe_step

KINDS = {"vertex-face": (pairs.FACE, pairs.VERTEX), "edge-edge": (pairs.EDGE, pairs.EDGE)}


def read(path):
    """Positions at the beginning and at the end, [query, 4, 3], the truth, and which queries are doubles throughout."""
    numbers, truth, exact = [], [], []
    with open(path, encoding="ascii") as file:
        for line in file:
            row = [int(field) for field in line.split(",")]
            fractions = [Fraction(row[i], row[i + 1]) for i in (0, 2, 4)]
            numbers.append([float(f) for f in fractions])
            exact.append(all(Fraction(d) == f for d, f in zip(numbers[-1], fractions)))
            truth.append(row[6])
    positions = np.array(numbers).reshape(-1, 2, 4, 3)
    return positions[:, 0], positions[:, 1], np.array(truth).reshape(-1, 8)[:, 0], np.array(exact).reshape(-1, 8).all(axis=1)


def surface_of(vox, kind, vertices):
    """All queries of a file in one surface: query i has vertices 4 i to 4 i + 3, and edges 2 i, 2 i + 1 or face i."""
    ids = np.arange(len(vertices), dtype=np.uint32).reshape(-1, 4)
    edges = ids.reshape(-1, 2) if kind == "edge-edge" else np.zeros((0, 2), np.uint32)
    faces = ids[:, 1:] if kind == "vertex-face" else np.zeros((0, 3), np.uint32)
    return pairs.Surface(vox, vertices, np.ascontiguousarray(edges), np.ascontiguousarray(faces))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("library")
    parser.add_argument("folder")
    options = parser.parse_args()
    vox = ctypes.CDLL(options.library)
    vox.vox_last_error.restype = ctypes.c_char_p
    print("| scene | kind | queries | true | lost by pairs | by culling | by times | false with a time | not doubles |\n" + "|---" * 9 + "|")
    lost_in_all = 0
    for folder in sorted(glob.glob(os.path.join(options.folder, "*", "*-*", ""))):
        scene, kind = folder.rstrip("/").split("/")[-2:]
        counts = np.zeros(7, int)
        for path in sorted(glob.glob(folder + "*.csv")):
            start, end, truth, exact = read(path)
            start, end = (np.asfortranarray(p.reshape(-1, 3)) for p in (start, end))
            surface = surface_of(vox, kind, start)
            own = np.arange(len(truth), dtype=np.int64)
            # The pair of each query, as first feature and second.
            first, second = (2 * own, 2 * own + 1) if kind == "edge-edge" else (own, 4 * own)
            found = []
            for cull in (False, True):
                surface.move(start, end, 0, cull)
                offsets, partners = surface.arrays(*KINDS[kind])
                found.append(np.array([second[i] in partners[offsets[first[i]]:offsets[first[i] + 1]] for i in own]))
            times = safe_step.timed(surface, *KINDS[kind])
            found.append(np.isin(first * 2**32 + second, times["a"].astype(np.int64) * 2**32 + times["b"]))
            true = (truth == 1) & exact
            counts += [len(truth), true.sum(), *((true & ~f).sum() for f in found), ((truth == 0) & exact & found[2]).sum(),
                       (~exact).sum()]
        print(f"| {scene} | {kind} | " + " | ".join(map(str, counts)) + " |", flush=True)
        lost_in_all += counts[2:5].sum()
    if lost_in_all:
        raise SystemExit("true contacts are lost")


if __name__ == "__main__":
    main()
