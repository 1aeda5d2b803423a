#!/usr/bin/env python3
"""Draws docs/rounds.svg: what three ranks send each other in a step of vox_dist, round by round.

usage: draw_rounds.py [--check]    --check fails when the picture is not what this draws"""

import os
import sys

PICTURE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rounds.svg")
WIDTH, LEFT, TOP, ROUND = 760, 170, 56, 74
RANKS = {0: "rank 0", 1: "rank 1", 2: "rank 2, far away"}
# Title, what is sent, and arrows between neighbours; "all": from each to all.
ROUNDS = [
    ("1  all", "the boxes of what each has, and whether it is well: 64 bytes a rank", "all"),
    ("2  neighbours", "finer boxes, of 64 tetrahedra that lie together", [(0, 1), (1, 0)]),
    ("3  neighbours", "owned vertices inside these boxes: number and position", [(0, 1), (1, 0)]),
    ("    each alone", "one step of the grid: vertices here and received, tetrahedra here", "work"),
    ("4  neighbours", "hits go back to the vertex's owner, who applies the rule of contacts", [(0, 1), (1, 0)]),
    ("    all", "whether all is well: one code for all", "all"),
    ("5  neighbours", "only where a vertex is exactly on a boundary in a split body: which hits are contacts", [(0, 1), (1, 0)]),
]


def x_of(rank):
    return LEFT + 90 + rank * 215


def arrow(x0, x1, y):
    sign = 1 if x1 > x0 else -1
    head = x1 - 9 * sign
    return (f'<path d="M{x0} {y}H{head}" stroke="#1f6fb2" stroke-width="2"/>'
            f'<path d="M{x1} {y}l{-10 * sign} -5v10z" fill="#1f6fb2"/>')


def drawn():
    height = TOP + ROUND * len(ROUNDS) + 10
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
             'font-family="Helvetica, Arial, sans-serif" font-size="14">',
             "<title>A step of vox_dist, round by round</title>",
             "<style>@media (prefers-color-scheme:dark){svg{filter:invert(.92)hue-rotate(180deg)}}</style>",
             f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>']
    for rank, name in RANKS.items():
        x = x_of(rank)
        parts.append(f'<path d="M{x} {TOP - 12}V{height - 10}" stroke="#9aa3ab" stroke-width="2"/>')
        parts.append(f'<text x="{x}" y="{TOP - 22}" text-anchor="middle" font-weight="bold">{name}</text>')
    for i, (title, what, arrows) in enumerate(ROUNDS):
        y = TOP + ROUND * i
        if i % 2 == 0:
            parts.append(f'<rect x="0" y="{y}" width="{WIDTH}" height="{ROUND}" fill="#1f6fb2" fill-opacity="0.06"/>')
        parts.append(f'<text x="14" y="{y + 22}" font-weight="bold" xml:space="preserve">{title}</text>')
        parts.append(f'<text x="{LEFT - 20}" y="{y + 22}" fill="#333" stroke="#fff" stroke-width="5" '
                     f'paint-order="stroke">{what}</text>')
        low = y + 48
        if arrows == "all":
            parts.append(f'<path d="M{x_of(0)} {low}H{x_of(2)}" stroke="#b3480a" stroke-width="6"/>')
            parts += [f'<circle cx="{x_of(rank)}" cy="{low}" r="7" fill="#b3480a"/>' for rank in RANKS]
        elif arrows == "work":
            parts += [f'<rect x="{x_of(rank) - 34}" y="{low - 12}" width="68" height="24" rx="4" fill="#d8e6f2" stroke="#1f6fb2"/>'
                      for rank in RANKS]
        else:
            parts += [arrow(x_of(a), x_of(b), low + (6 if a > b else -6)) for a, b in arrows]
    return "\n".join(parts) + "\n</svg>\n"


def main():
    if "--check" not in sys.argv[1:]:
        with open(PICTURE, "w", encoding="utf-8") as file:
            file.write(drawn())
        return
    with open(PICTURE, encoding="utf-8") as file:
        if file.read() != drawn():
            sys.exit("docs/rounds.svg is not what docs/draw_rounds.py draws")


if __name__ == "__main__":
    main()
