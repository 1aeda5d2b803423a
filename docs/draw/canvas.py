"""What the drawings share: a chart (bench/chart.py) with larger words, shades of a colour, and a view of things in space. Needs
numpy and vox's Python binding: a depth that is drawn is one that the library computed."""

import os
import sys
from html import escape

import numpy as np

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path[:0] = [os.path.join(ROOT, "bench"), os.path.join(ROOT, "bindings", "python", "src")]
from chart import COLOURS, Axis, Chart, Panel, number, path_of  # noqa: E402,F401

RGB = {name: [np.array([int(row[i:i + 2], 16) for i in (1, 3, 5)]) for row in schemes] for name, *schemes in COLOURS}
THIN, LINE, BOLD = 1, 2, 3.5  # widths of lines: inside a body, its outline, what the drawing is about
A, B, MARK = "orange", "blue", "vox"  # colours: of the body that has the vertex, of the body that it is in, of what is found
WIDTH = 700


def steps_of(points):
    """A closed path, in steps from point to point: shorter than `path_of`."""
    tenths = np.round(np.asarray(points) * 10).astype(int)
    return (f"M{number(tenths[0][0] / 10)} {number(tenths[0][1] / 10)}l"
            + " ".join(f"{number(x / 10)} {number(y / 10)}" for x, y in np.diff(tenths, axis=0)).replace(" -", "-") + "z")


def circle(x, y, radius):
    x, y, r, d = (number(value) for value in (x - radius, y, radius, 2 * radius))
    return f"M{x} {y}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0-{d} 0z"


def mixed(colour, amount, scheme):
    """So much of a colour over the paper."""
    paper = RGB["paper"][scheme]
    return "#" + "".join(f"{round(v):02x}" for v in paper + (RGB[colour][scheme] - paper) * amount)


def arc(radius, half):
    """Points of the top of a circle in the plane of x and z, as far as x goes from -half to half."""
    widest = np.arcsin(half / radius)
    return radius * np.array([(np.sin(t), np.cos(t)) for t in np.linspace(-widest, widest, 25)])


def edges_of(elements, among=None):
    """Edges of triangles or tetrahedra, each once; those between two of some vertices alone, if these are given."""
    edges = {(int(a), int(b)) for element in elements for a in element for b in element if a < b}
    return sorted(e for e in edges if among is None or set(e) <= among)


class Drawing(Chart):
    FONT = 20

    def __init__(self, height, title, width=WIDTH):
        super().__init__(width, height, title)
        self.shades = {}

    def style(self):
        """With the shades in use: `shaded` says how much of a colour lies over the paper, in light and in dark."""
        light, dark = ("".join(f".{name}{{fill:{mixed(shade[0], shade[1 + scheme], scheme)}}}" for shade, name in self.shades.items())
                       for scheme in (0, 1))
        return super().style() + "text{stroke:none}" + light + f"@media (prefers-color-scheme:dark){{{dark}}}"

    def shaded(self, colour, light, dark):
        return self.shades.setdefault((colour, round(light, 2), round(dark, 2)), f"{colour[0]}{len(self.shades)}")

    def fill(self, path, colour, light, dark=None, edge="", width=THIN):
        """An opaque area of a shade, with an outline of the colour `edge`."""
        shade = self.shaded(colour, light, light if dark is None else dark)
        self.add(f'<path class="{edge} {shade}" stroke="currentColor" stroke-width="{width}" stroke-linejoin="round" d="{path}"/>'
                 if edge else f'<path class="{shade}" d="{path}"/>')

    def veil(self, path, colour, opacity):
        self.add(f'<path class="f {colour}" fill-opacity="{opacity}" d="{path}"/>')

    def line(self, points, colour, width=LINE, dash=""):
        self.stroke(path_of(points), colour, width, dash)

    def dots(self, points, colour, size=5.0):
        """Filled dots with a rim of paper, so that they stand out from lines."""
        self.marks(points, "paper", size=size + 1.5)
        self.marks(points, colour, size=size)

    def rings(self, points, colour, size=4.0, width=LINE):
        self.marks(points, colour, size=size + width / 2)
        self.marks(points, "paper", size=size - width / 2)

    def arrow(self, start, end, colour, width=BOLD):
        start, end = np.asarray(start, float), np.asarray(end, float)
        along = (end - start) / np.hypot(*(end - start))
        across, head = np.array([-along[1], along[0]]), 3.2 * width
        back = end - head * along
        self.line([start, back], colour, width)
        self.add(f'<path class="f {colour}" d="{path_of([end, back + head / 2 * across, back - head / 2 * across])}z"/>')

    def label(self, x, y, words, colour="ink", anchor="middle", size=0, bold=False):
        size = size or self.FONT
        self.add(f'<text class="{colour}" x="{number(x)}" y="{number(y)}" text-anchor="{anchor}"'
                 + (' font-weight="bold"' if bold else "")
                 + (f' font-size="{size}"' if size != self.FONT else "") + f">{escape(words)}</text>")

    def solids(self, view, faces, lamp=True):
        """Faces (points, colour, how much of it) that look at us, far ones first."""
        front = []
        for points, colour, amount, edge in faces:
            normal = np.cross(points[1] - points[0], points[2] - points[0])
            facing = view.towards(normal) / np.linalg.norm(normal)
            if facing > 1e-6:
                lit = view.lit(normal / np.linalg.norm(normal))
                front.append((round(view.towards(np.mean(points, axis=0)), 9), points, colour, amount, lit, edge))
        pen = ""
        for _, points, colour, amount, lit, edge in sorted(front, key=lambda face: face[0]):
            if pen != edge:
                self.add("</g>" if pen else "")
                self.add(f'<g class="{edge}" stroke="currentColor" stroke-width="{THIN}" stroke-linejoin="round">' if edge else "")
                pen = edge
            lit = round(lit * 8 + 1e-6) / 8
            tones = (1.35 - .85 * lit, .75 + .5 * lit) if lamp else (1, 1)
            shade = self.shaded(colour, *(amount * tone for tone in tones))
            self.add(f'<path class="{shade}" d="{steps_of(view.at(points))}"/>')
        self.add("</g>" if pen else "")

    def glass(self, view, corners, triangles, colour, inside, amount=.14):
        """A convex body that shows what `inside` draws in it: edges behind it are thin and dashed."""
        facing = [view.towards(np.cross(*(corners[[b, c]] - corners[a]))) > 0 for a, b, c in triangles]
        self.fill(self.union(view, corners, [t for t, front in zip(triangles, facing) if front]), colour, amount, amount + .04)
        sides = {}
        for triangle, front in zip(triangles, facing):
            for i in range(3):
                pair = tuple(sorted((triangle[i - 1], triangle[i])))
                sides[pair] = sides.get(pair, False) or front
        for visible in (False, True):
            if visible:
                inside()
                for triangle, front in zip(triangles, facing):
                    normal = np.cross(*(corners[list(triangle[1:])] - corners[triangle[0]]))
                    if front:
                        dim = .26 - .2 * view.lit(normal / np.linalg.norm(normal))
                        self.veil(self.union(view, corners, [triangle]), colour, f"{dim:.2f}")
            for pair, front in sorted(sides.items()):
                if front == visible:
                    self.line(view.at(corners[list(pair)]), colour, LINE if visible else THIN, "" if visible else "3 5")

    @staticmethod
    def union(view, corners, triangles):
        return "".join(path_of(view.at(corners[list(triangle)])) + "z" for triangle in triangles)

    def svg(self):
        """Few lines: what is drawn is one of them."""
        drawn, self.lines = self.lines, ["".join(self.lines)]
        try:
            return super().svg()
        finally:
            self.lines = drawn


class View:
    """Parallel projection: `turn` about the z axis and `tilt` from the horizon in degrees; `centre` is drawn at `place`."""

    def __init__(self, turn, tilt, scale, centre, place):
        turn, tilt = np.radians([turn, tilt])
        right = np.array([np.cos(turn), np.sin(turn), 0])
        self.eye = np.array([np.sin(turn) * np.cos(tilt), -np.cos(turn) * np.cos(tilt), np.sin(tilt)])
        self.axes = np.array([right, -np.cross(self.eye, right)])
        self.scale, self.centre, self.place = scale, np.asarray(centre, float), np.asarray(place, float)

    def at(self, points):
        return np.round((np.asarray(points, float) - self.centre) @ self.axes.T * self.scale + self.place, 6)

    def towards(self, point):
        return np.asarray(point) @ self.eye

    def lit(self, normal):
        """By a lamp that goes with the viewer: above, to the left."""
        lamp = self.eye * .5 - self.axes[0] * .45 - self.axes[1] * .75
        return max(0.0, float(normal @ lamp) / float(np.linalg.norm(lamp)))


TET = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))  # facets, counter-clockwise from outside where the volume is positive


def positive(corners, tet):
    """A tetrahedron in the order that makes its volume positive."""
    a, b, c, d = corners[list(tet)]
    return tuple(tet) if np.dot(np.cross(b - a, c - a), d - a) > 0 else (*tet[:2], tet[3], tet[2])


def triangles_of(tet):
    return [tuple(tet[i] for i in facet) for facet in TET]


def faces_of(corners, triangles, colour, amount, edge=""):
    """Triangles as `solids` takes them."""
    return [(corners[list(triangle)], colour, amount, edge) for triangle in triangles]
