"""Scenes on the ranks of MPI: mpiexec -n 3 python -m mpi4py.futures with_mpi4py.py (one rank gives out the others' work)"""

import scenes
from mpi4py.futures import MPIPoolExecutor


def main():
    with MPIPoolExecutor() as pool:
        scenes.show(pool.map(scenes.step, scenes.make(8)))


if __name__ == "__main__":
    main()
