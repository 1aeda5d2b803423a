#!/usr/bin/env python3
"""The table of docs/evidence/README.md: what each rule for the cell size costs on a real pair of bodies.

usage: rules.py VOX MESH [X Y Z]   MESH against itself, the second one moved by X Y Z (default: half of its longest
side along that axis). Prints markdown. Rounds are interleaved over all rules, figures are medians; the best cell size is
the best of a sweep, measured in the same rounds.
"""
import json
import statistics
import subprocess
import sys

ROUNDS, STEPS = 9, 5

def vox(*arguments):
    return json.loads(subprocess.run([*arguments, "--json"], check=True, capture_output=True).stdout)


def main():
    if len(sys.argv) not in (3, 6):
        sys.exit(__doc__)
    program, mesh, *offset = sys.argv[1:]
    suggestion = vox(program, "suggest", mesh)
    mean_edge = suggestion["geometry"]["mean_edge"]
    if not offset:
        low, high = (suggestion["geometry"]["bounds"][end] for end in ("min", "max"))
        sides = [b - a for a, b in zip(low, high)]
        offset = [0.5 * s if s == max(sides) else 0 for s in sides]

    sizes = {"**suggested**": suggestion["cell_size"]}
    sizes.update((rule["name"], rule["cell_size"]) for rule in suggestion["rules"] if rule["cell_size"])
    sweep = {f"sweep {k}": mean_edge * 0.25 * 40 ** (k / 23) for k in range(24)}  # 0.25 to 10 mean edges

    times = {name: [] for name in [*sizes, *sweep]}
    contacts = set()
    for _ in range(ROUNDS):
        for name, size in [*sizes.items(), *sweep.items()]:
            result = vox(program, "collide", mesh, mesh, "--engine", "reference", "--repeat", str(STEPS),
                         "--cell-size", repr(size), "--offset", *map(str, offset))
            times[name].append(result["profile"]["step_ns"])
            contacts.add((result["contact_count"], result["hash"]))
    assert len(contacts) == 1, "the contacts depend on the cell size"

    median = {name: statistics.median(t) for name, t in times.items()}
    best = min(sweep, key=lambda name: median[name])
    print(f"{contacts.pop()[0]} contacts at every cell size.\n")
    print("| rule | cell size in mean edges | time of a step | over the best |")
    print("|---|---|---|---|")
    for name, size in [*sizes.items(), ("best of a sweep of 24", sweep[best])]:
        time = median[best if name.startswith("best") else name]
        print(f"| {name} | {size / mean_edge:.2f} | {time / 1e6:.2f} ms | {100 * (time / median[best] - 1):+.0f} % |")


if __name__ == "__main__":
    main()
