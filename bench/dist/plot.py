#!/usr/bin/env python3
"""Draws docs/distributed-scaling.svg from what bench_dist prints: work that grows with the ranks.

usage: build/release/bench/bench_dist > FILE; bench/dist/plot.py FILE"""

import os
import re
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

PICTURE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "distributed-scaling.svg")
ROW = re.compile(r"\| (\d+) \| in a (row|cube) \| (\d+) \| (\d+) \| \d+ \| ([\d.]+) \| ([\d.]+) \|")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = [(shape, *map(float, numbers)) for shape, numbers in
                ((m[2], (m[1], m[3], m[4], m[5], m[6])) for m in map(ROW.match, file) if m)]
    matplotlib.rcParams.update({"svg.hashsalt": "vox", "font.size": 10, "axes.spines.top": False, "axes.spines.right": False})
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.2))
    names = ["kB that the busiest rank sends", "messages of the busiest rank", "ms: work predicted, network modelled"]
    for shape, colour in (("row", "#1f6fb2"), ("cube", "#b3480a")):
        ranks, sent, messages, work, network = zip(*[row[1:] for row in rows if row[0] == shape])
        axes[0].plot(ranks, [b / 1000 for b in sent], "o-", color=colour, label=f"blocks in a {shape}")
        axes[1].plot(ranks, messages, "o-", color=colour)
        axes[2].plot(ranks, work, "o-", color=colour, label=f"work, {shape}")
        axes[2].plot(ranks, network, "s--", color=colour, label=f"network, {shape}")
    for axis, name in zip(axes, names):
        axis.set_title(name, fontsize=10)
        axis.set_xlabel("ranks, one block of 100,000 tets each")
        axis.set_ylim(bottom=0)
        axis.set_xticks([1, 8, 27, 64])
    axes[0].legend(frameon=False)
    axes[2].legend(frameon=False, fontsize=8, loc="center right")
    figure.tight_layout()
    figure.savefig(PICTURE, metadata={"Date": None})


if __name__ == "__main__":
    main()
