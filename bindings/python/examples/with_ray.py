"""Scenes as tasks of Ray: python with_ray.py [PROCESSES]"""

import sys

import ray
import scenes


def main(processes):
    ray.init(num_cpus=processes)
    step = ray.remote(scenes.step)
    scenes.show(ray.get([step.remote(grid) for grid in scenes.make(8)]))
    ray.shutdown()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 2)
