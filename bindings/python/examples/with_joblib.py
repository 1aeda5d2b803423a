"""Scenes on the cores of this machine with joblib (processes by loky): python with_joblib.py [PROCESSES]"""

import sys

import joblib
import scenes


def main(processes):
    with joblib.Parallel(n_jobs=processes, backend="loky") as parallel:
        scenes.show(parallel(joblib.delayed(scenes.step)(grid) for grid in scenes.make(8)))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 2)
