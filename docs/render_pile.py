#!/usr/bin/env python3
"""The moving picture of the example examples/sim/pile.c.

usage: render_pile.py FOLDER ANIMATION.webp

FOLDER holds the example's pile_*.vtu. Needs numpy and PIL (Debian: python3-numpy, python3-pil). Triangles are
rasterised into a depth buffer, the same way from the eye and from the light (whose buffer tells what lies in
shadow), and each pixel is shaded once."""
import glob
import os
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
from PIL import Image

LIGHT = np.array([-0.45, -0.35, 0.82]) / np.linalg.norm([-0.45, -0.35, 0.82])
EYE, TARGET = np.array([5.6, -7.6, 5.0]), np.array([0.0, 0.0, 0.75])
COLOURS = np.array([[226, 87, 76], [243, 156, 72], [246, 205, 97], [124, 184, 110], [72, 166, 167], [86, 130, 199],
                    [143, 108, 189], [214, 120, 162]]) / 255
WIDTH, HEIGHT, STRIDE, QUALITY = 416, 320, 2, 20  # of 30 frames a second
RING, FLOOR, SKY = np.array([0.62, 0.60, 0.58]), np.array([0.93, 0.92, 0.90]), np.array([0.985, 0.98, 0.975])


def read_vtu(path):
    """Positions, tets and body numbers of a file as vox_io writes it: raw appended arrays."""
    data = open(path, "rb").read()
    begin = data.index(b'<AppendedData encoding="raw">')
    start = data.index(b"_", begin + 20) + 1
    tree = ElementTree.fromstring(data[:begin] + b"</VTKFile>")
    types = {"Float64": "<f8", "Int64": "<i8", "UInt8": "u1"}
    arrays = {}
    for array in tree.iter("DataArray"):
        at = start + int(array.get("offset"))
        size = int(np.frombuffer(data, "<u8", 1, at)[0])
        kind = np.dtype(types[array.get("type")])
        arrays[array.get("Name")] = np.frombuffer(data, kind, size // kind.itemsize, at + 8)
    return arrays["Points"].reshape(-1, 3), arrays["connectivity"].reshape(-1, 4), arrays["body"].astype(int)


def boundary(positions, tets):
    """Triangles that belong to one tet only, with their corners anticlockwise from outside."""
    corners = np.array([[1, 2, 3, 0], [0, 3, 2, 1], [0, 1, 3, 2], [0, 2, 1, 3]])
    faces = tets[:, corners].reshape(-1, 4)  # three corners, and the one opposite
    _, first, count = np.unique(np.sort(faces[:, :3], axis=1), axis=0, return_index=True, return_counts=True)
    faces = faces[first[count == 1]]
    a, b, c, opposite = (positions[faces[:, i]] for i in range(4))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), opposite - a) > 0
    faces[inward, 1], faces[inward, 2] = faces[inward, 2], faces[inward, 1].copy()
    return faces[:, :3]


def camera(eye, target, up=(0, 0, 1)):
    """Rows: right, up, towards the eye."""
    back = (eye - target) / np.linalg.norm(eye - target)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(back, right), back])


def rasterise(points, triangles, width, height):
    """Of each pixel the triangle in front (-1: none) and its depth. Points are x, y in pixels and depth, near is
    large. Triangles of like size are done together, all pixels of their boxes at once."""
    depth = np.full(width * height, -np.inf)
    owner = np.full(width * height, -1)
    p = points[triangles]
    low = np.clip(np.floor(p[:, :, :2].min(1)), 0, [width, height]).astype(int)
    high = np.clip(np.ceil(p[:, :, :2].max(1)) + 1, 0, [width, height]).astype(int)
    size = (high - low).max(1)
    area = (p[:, 1, 0] - p[:, 0, 0]) * (p[:, 2, 1] - p[:, 0, 1]) - (p[:, 1, 1] - p[:, 0, 1]) * (p[:, 2, 0] - p[:, 0, 0])
    drawn = (area > 1e-9) & ((high - low).min(1) > 0)
    for step in 4, 8, 16, 32, 64, 128, 256:
        chosen = np.flatnonzero(drawn & (size <= step) & (size > (step // 2 if step > 4 else 0)))
        dy, dx = np.divmod(np.arange(step * step), step)
        for part in np.array_split(chosen, max(1, len(chosen) * step * step // 2000000)):
            x, y = low[part, 0, None] + dx, low[part, 1, None] + dy
            a, b, c = (p[part, i, :, None] for i in range(3))
            u, v = x + 0.5, y + 0.5
            w1 = ((u - a[:, 0]) * (c[:, 1] - a[:, 1]) - (v - a[:, 1]) * (c[:, 0] - a[:, 0])) / area[part, None]
            w2 = ((b[:, 0] - a[:, 0]) * (v - a[:, 1]) - (b[:, 1] - a[:, 1]) * (u - a[:, 0])) / area[part, None]
            inside = (w1 >= 0) & (w2 >= 0) & (w1 + w2 <= 1) & (x < width) & (y < height)
            z = a[:, 2] + w1 * (b[:, 2] - a[:, 2]) + w2 * (c[:, 2] - a[:, 2])
            pixel, z = (y * width + x)[inside], z[inside]
            triangle = np.broadcast_to(part[:, None], inside.shape)[inside]
            order = np.argsort(z, kind="stable")  # the nearest is written last
            pixel, z, triangle = pixel[order], z[order], triangle[order]
            nearer = z > depth[pixel]
            depth[pixel[nearer]], owner[pixel[nearer]] = z[nearer], triangle[nearer]
    return owner.reshape(height, width), depth.reshape(height, width)


class Shadow:
    """What the light sees, in a square of 12 units."""

    def __init__(self, positions, triangles, size=1200):
        self.axes, self.size = camera(LIGHT, np.zeros(3)), size
        _, self.depth = rasterise(self.project(positions), triangles, size, size)

    def project(self, points):
        seen = points @ self.axes.T
        return np.column_stack([(seen[:, :2] / 12 + 0.5) * self.size, seen[:, 2]])

    def lit(self, points):
        """Share of the light that arrives, smoothed over a few of its pixels."""
        p = self.project(points)
        share = np.zeros(len(p))
        offsets = [(i, j) for i in (-2, 0, 2) for j in (-2, 0, 2)]
        for i, j in offsets:
            x = np.clip(p[:, 0] + i, 0, self.size - 1).astype(int)
            y = np.clip(p[:, 1] + j, 0, self.size - 1).astype(int)
            share += self.depth[y, x] < p[:, 2] + 0.04
        return share / len(offsets)


def render(positions, triangles, bodies, width, height, zoom):
    """One frame as an array of width x height RGB bytes; everything is computed twice as fine and averaged."""
    w, h = 2 * width, 2 * height
    axes = camera(EYE, TARGET)
    focal = zoom * w
    seen = (positions - EYE) @ axes.T  # z is negative in front
    screen = np.column_stack([w / 2 + focal * seen[:, 0] / -seen[:, 2], h / 2 - focal * seen[:, 1] / -seen[:, 2],
                              1 / -seen[:, 2]])
    # y points down on the screen, so that corners run the other way round there.
    owner, near = rasterise(screen, triangles[:, [0, 2, 1]], w, h)
    shadow = Shadow(positions, triangles)

    face = np.cross(positions[triangles[:, 1]] - positions[triangles[:, 0]],
                    positions[triangles[:, 2]] - positions[triangles[:, 0]])
    normals = np.zeros_like(positions)
    for k in range(3):
        np.add.at(normals, triangles[:, k], face)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    face /= np.maximum(np.linalg.norm(face, axis=1), 1e-12)[:, None]

    y, x = np.mgrid[0:h, 0:w]
    rays = np.column_stack([((x + 0.5 - w / 2) / focal).ravel(), ((h / 2 - y - 0.5) / focal).ravel(),
                            np.full(w * h, -1.0)]) @ axes
    owner, near = owner.ravel(), near.ravel()
    image = np.tile(SKY, (w * h, 1))

    # The floor z = 0 where no body is before it, fading into the background.
    floor = np.flatnonzero((owner < 0) & (rays[:, 2] < -1e-3))
    at = EYE + rays[floor] * (-EYE[2] / rays[floor, 2])[:, None]
    fade = np.clip((np.hypot(at[:, 0], at[:, 1]) - 4) / 5, 0, 1)[:, None]
    light = 0.55 + 0.45 * shadow.lit(at)
    image[floor] = (1 - fade) * FLOOR * light[:, None] + fade * SKY

    drawn = np.flatnonzero(owner >= 0)
    t = triangles[owner[drawn]]
    at = EYE + rays[drawn] / near[drawn, None]
    a, b, c = (positions[t[:, i]] for i in range(3))
    whole = np.maximum(np.linalg.norm(np.cross(b - a, c - a), axis=1), 1e-12)
    wb = np.linalg.norm(np.cross(at - a, c - a), axis=1) / whole
    wc = np.linalg.norm(np.cross(b - a, at - a), axis=1) / whole
    smooth = (1 - wb - wc)[:, None] * normals[t[:, 0]] + wb[:, None] * normals[t[:, 1]] + wc[:, None] * normals[t[:, 2]]
    # Smooth on round parts, flat where the normals of a triangle's corners disagree with its own, as at edges.
    flat = face[owner[drawn]]
    smooth /= np.maximum(np.linalg.norm(smooth, axis=1), 1e-12)[:, None]
    bent = np.clip((0.97 - np.einsum("ij,ij->i", smooth, flat)) / 0.1, 0, 1)[:, None]
    n = (1 - bent) * smooth + bent * flat
    n /= np.maximum(np.linalg.norm(n, axis=1), 1e-12)[:, None]
    view = -rays[drawn] / np.linalg.norm(rays[drawn], axis=1)[:, None]
    facing = np.clip(n @ LIGHT, 0, 1) * shadow.lit(at + 0.03 * n)
    half = view + LIGHT
    half /= np.linalg.norm(half, axis=1)[:, None]
    shine = 0.25 * np.clip(np.einsum("ij,ij->i", n, half), 0, 1) ** 40 * (facing > 0)
    sky = 0.5 + 0.5 * n[:, 2]  # light from all around, more from above
    body = bodies[t[:, 0]]
    colour = np.where((body == 0)[:, None], RING, COLOURS[(body - 1) * 5 % len(COLOURS)])
    image[drawn] = colour * (0.32 + 0.22 * sky + 0.52 * facing)[:, None] + shine[:, None]

    image = np.clip(image, 0, 1).reshape(height, 2, width, 2, 3).mean((1, 3))
    return (255 * image ** (1 / 1.1) + 0.5).astype(np.uint8)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folder, animation = sys.argv[1:]
    paths = sorted(glob.glob(os.path.join(folder, "pile_*.vtu")))
    if not paths:
        sys.exit(f"{folder}: no files pile_*.vtu")
    positions, tets, bodies = read_vtu(paths[0])
    triangles = boundary(positions, tets)
    frames = [Image.fromarray(render(read_vtu(path)[0], triangles, bodies, WIDTH, HEIGHT, 1.15)) for path in paths[::STRIDE]]
    frames[0].save(animation, save_all=True, append_images=frames[1:], quality=QUALITY, method=6, loop=0,
                   duration=[STRIDE * 1000 // 30] * (len(frames) - 1) + [1500])
    print(animation, os.path.getsize(animation))


if __name__ == "__main__":
    main()
