"""Scenes on a Dask cluster, here of processes of this machine: python with_dask.py [PROCESSES]"""

import sys

import scenes
from dask.distributed import Client, LocalCluster


def main(processes):
    with LocalCluster(processes, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        scenes.show(client.gather(client.map(scenes.step, scenes.make(8), pure=False)))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 2)
