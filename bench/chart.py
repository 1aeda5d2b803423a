"""Charts as small SVG: text stays text, one element to a line, only what can be seen, readable in light and in dark. Nothing but
Python is needed, and the same figures give the same file."""

import math
import re
from html import escape

# Class, in light, in dark.
COLOURS = [("paper", "#ffffff", "#14171c"), ("ink", "#222222", "#dddddd"), ("axis", "#777777", "#8a8f98"), ("grid", "#e2e2e2", "#333842"),
           ("vox", "#c2185b", "#f06292"), ("dark", "#333333", "#cfcfcf"), ("grey", "#8c8c8c", "#9aa0a8"), ("blue", "#1f6fb2", "#64a8e0"),
           ("sky", "#6baed6", "#8ec9ec"), ("orange", "#d9730d", "#f2a04e"), ("green", "#2c8a3c", "#6cc47a"), ("violet", "#7b5ea7", "#b59ae0"),
           ("brown", "#8c564b", "#c49c94"), ("olive", "#98981c", "#d0d05a"), ("teal", "#128c98", "#4fc3cf")]
SHAPES = {"square": "m-{r} -{r}h{d}v{d}h-{d}z", "diamond": "m0 -{d}l{d} {d}l-{d} {d}l-{d} -{d}z", "left": "m-{d} 0l{w} -{d}v{t}z",
          "right": "m{d} 0l-{w} -{d}v{t}z", "up": "m0 -{d}l{d} {w}h-{t}z", "down": "m0 {d}l{d} -{w}h-{t}z", "tick": "m0 -{t}v{f}",
          "circle": "m-{r} 0a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0z"}


def number(value):
    return f"{value:.1f}".removesuffix(".0").replace("-0.", "-.") if value else "0"


def path_of(points):
    return "M" + "L".join(f"{number(x)} {number(y)}" for x, y in points)


def thinned(points, most=0.2):
    """Without the points that lie within `most` pixels of the line through those that are left (Douglas and Peucker 1973)."""
    kept, waiting = {0, len(points) - 1}, [(0, len(points) - 1)]
    while waiting:
        a, b = waiting.pop()
        (ax, ay), (bx, by) = points[a], points[b]
        length = math.hypot(bx - ax, by - ay) or 1e-9
        far, i = max(((abs((bx - ax) * (ay - y) - (ax - x) * (by - ay)) / length, i)
                      for i, (x, y) in enumerate(points[a + 1:b], a + 1)), default=(0, 0))
        if far > most:
            kept.add(i)
            waiting += [(a, i), (i, b)]
    return [points[i] for i in sorted(kept)]


class Axis:
    """From `low` to `high`; ticks are values, or values with their labels."""

    def __init__(self, low, high, ticks, log=False, name=""):
        self.low, self.high, self.log, self.name = low, high, log, name
        self.ticks = ticks if isinstance(ticks, dict) else {tick: f"{tick:g}" for tick in ticks}

    def share(self, value):
        if self.log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


def decades(low, high):
    """Ticks of a logarithmic axis."""
    return {10.0 ** k: f"{10.0 ** k:,.12g}" for k in range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1)}


def round_ticks(low, high, count=5):
    step = 10 ** math.floor(math.log10((high - low) / count))
    step *= next(m for m in (1, 2, 5, 10) if (high - low) / (step * m) <= count)
    return [round(k * step, 10) for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


class Chart:
    FONT = 11  # size of words that name none

    def __init__(self, width, height, title):
        self.width, self.height, self.title, self.lines = width, height, title, []

    def add(self, line):
        self.lines.append(line)

    def text(self, x, y, words, anchor="start", size=0, turned=False):
        """One _subscript is possible; what follows is set apart by a space that is not dropped."""
        size = size or self.FONT
        words = re.sub(r"_(\w+) ?(.*)", rf'<tspan dy="3" font-size="{size - 3}">\1</tspan><tspan dy="-3">&#160;\2</tspan>', escape(words))
        place = f'transform="translate({number(x)} {number(y)})rotate(-90)"' if turned else f'x="{number(x)}" y="{number(y)}"'
        self.add(f'<text {place}' + (f' text-anchor="{anchor}"' if anchor != "start" else "")
                 + (f' font-size="{size}"' if size != self.FONT else "") + f'>{words}</text>')

    def marks(self, points, colour, shape="dot", size=3.0, hollow=False):
        """Marks at points in pixels. size: half of it."""
        if shape == "dot" and not hollow:
            self.add(f'<path class="d {colour}" stroke-width="{number(2 * size)}" d="'
                     + "".join(f"M{number(x)} {number(y)}h0" for x, y in points) + '"/>')
            return
        sizes = {"r": size, "d": 2 * size, "w": 3 * size, "t": 4 * size, "f": 8 * size}
        if shape not in ("square", "dot", "circle"):
            sizes = {name: value / 2 for name, value in sizes.items()}
        form = SHAPES["circle" if shape == "dot" else shape].format(**{name: number(value) for name, value in sizes.items()})
        kind = "l" if shape == "tick" else "h" if hollow else "f"
        self.add(f'<path class="{kind} {colour}" d="' + "".join(f"M{number(x)} {number(y)}{form}" for x, y in points) + '"/>')

    def stroke(self, path, colour, width=1.5, dash=""):
        self.add(f'<path class="l {colour}"' + (f' stroke-width="{width}"' if width != 1.5 else "")
                 + (f' stroke-dasharray="{dash}"' if dash else "") + f' d="{path}"/>')

    def area(self, left, top, width, height, colour):
        self.add(f'<rect class="f {colour}" fill-opacity=".22" x="{number(left)}" y="{number(top)}" width="{number(width)}" '
                 f'height="{number(height)}"/>')

    def legend(self, x, y, entries, columns, width):
        """Entries are (words, draw): draw(x, y) makes the mark there."""
        for i, (words, draw) in enumerate(entries):
            left, top = x + i % columns * width, y + i // columns * 17
            draw(left + 12, top - 4)
            self.text(left + 28, top, words)

    def line_key(self, colour, width=1.5, dash=""):
        return lambda x, y: self.stroke(f"M{number(x - 11)} {number(y)}h22", colour, width, dash)

    def mark_key(self, colour, shape="dot", size=3.0, hollow=False):
        return lambda x, y: self.marks([(x, y)], colour, shape, size, hollow)

    def area_key(self, colour):
        return lambda x, y: self.area(x - 11, y - 5, 22, 10, colour)

    def style(self):
        light, dark = ("".join(f".{row[0]}{{color:{row[scheme]}}}" for row in COLOURS) for scheme in (1, 2))
        return ("text{fill:currentColor}.l,.d{fill:none;stroke:currentColor}.d{stroke-linecap:round}"
                f".f{{fill:currentColor}}.h{{fill:{COLOURS[0][1]};stroke:currentColor}}{light}"
                f"@media (prefers-color-scheme:dark){{.h{{fill:{COLOURS[0][2]}}}{dark}}}")

    def svg(self):
        return "\n".join([f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" '
                          f'height="{self.height}" class="ink" stroke-width="1.5" '
                          f'font-family="Helvetica, Arial, sans-serif" font-size="{self.FONT}">',
                          f"<title>{escape(self.title)}</title>", f"<style>{self.style()}</style>",
                          f'<rect class="f paper" width="{self.width}" height="{self.height}"/>', *self.lines, "</svg>\n"])

    def write(self, path):
        with open(path, "w", encoding="utf-8", newline="\n") as file:
            file.write(self.svg())


class Panel:
    """Axes of a chart; what lies outside of them is not drawn."""

    def __init__(self, chart, left, top, width, height, x, y, title="", grid=False):
        self.chart, self.left, self.top, self.width, self.height, self.x, self.y = chart, left, top, width, height, x, y
        right, bottom = left + width, top + height
        across, up = [self.at(tick, y.low)[0] for tick in x.ticks], [self.at(x.low, tick)[1] for tick in y.ticks]
        if grid:
            chart.stroke("".join([f"M{number(at)} {top}V{bottom}" for at in across] + [f"M{left} {number(at)}H{right}" for at in up]),
                         "grid", 1)
        chart.stroke(f"M{left} {top}V{bottom}H{right}" + "".join(f"M{number(at)} {bottom}v4" for at in across)
                     + "".join(f"M{left} {number(at)}h-4" for at in up), "axis", 1)
        self.labels("middle", [(at, bottom + 15, label) for at, label in zip(across, x.ticks.values())])
        self.labels("end", [(left - 7, at + 4, label) for at, label in zip(up, y.ticks.values())])
        if title:
            chart.text(left + width / 2, top - 7, title, "middle", 12)
        if x.name:
            chart.text(left + width / 2, bottom + 30, x.name, "middle")
        if y.name:
            chart.text(left - 34, top + height / 2, y.name, "middle", turned=True)

    def labels(self, anchor, labels):
        labels = [label for label in labels if label[2]]
        if labels:
            self.chart.add(f'<text text-anchor="{anchor}">' + "".join(
                f'<tspan x="{number(x)}" y="{number(y)}">{escape(label)}</tspan>' for x, y, label in labels) + "</text>")

    def at(self, x, y):
        return self.left + self.x.share(x) * self.width, self.top + (1 - self.y.share(y)) * self.height

    def inside(self, x, y):
        return self.left - 0.1 <= x <= self.left + self.width + 0.1 and self.top - 0.1 <= y <= self.top + self.height + 0.1

    def dots(self, points, colour, shape="dot", size=3.0, hollow=False):
        points = [point for point in (self.at(*point) for point in points) if self.inside(*point)]
        if points:
            self.chart.marks(points, colour, shape, size, hollow)

    def line(self, points, colour, width=1.5, dash=""):
        """Through points from left to right."""
        parts, part = [], []
        points = [self.at(*point) for point in points]
        for i, (x, y) in enumerate(points):
            if self.inside(x, y):
                if not part and i > 0:
                    part = [self.cut((x, y), points[i - 1])]
                part.append((x, y))
            elif part:
                parts.append(part + [self.cut(part[-1], (x, y))])
                part = []
        parts += [part] if part else []
        self.chart.stroke("".join(path_of(thinned(part)) for part in parts), colour, width, dash)

    def cut(self, within, beyond):
        """Where a line leaves the panel."""
        share = 1.0
        for axis, low, high in ((0, self.left, self.left + self.width), (1, self.top, self.top + self.height)):
            for limit in (low, high):
                if (within[axis] - limit) * (beyond[axis] - limit) < 0:
                    share = min(share, (limit - within[axis]) / (beyond[axis] - within[axis]))
        return tuple(w + share * (b - w) for w, b in zip(within, beyond))

    def upright(self, x, colour, width=1.5, dash=""):
        self.chart.stroke(f"M{number(self.at(x, self.y.low)[0])} {number(self.top)}v{number(self.height)}", colour, width, dash)

    def level(self, y, colour, width=1.5, dash=""):
        self.chart.stroke(f"M{number(self.left)} {number(self.at(self.x.low, y)[1])}h{number(self.width)}", colour, width, dash)

    def bar(self, low, high, y, colour, width=4):
        a, b = self.at(low, y), self.at(high, y)
        self.chart.stroke(f"M{number(a[0])} {number(a[1])}H{number(b[0])}", colour, width)

    def band(self, low, high, colour):
        a, b = (max(self.left, min(self.at(x, self.y.low)[0], self.left + self.width)) for x in (low, high))
        self.chart.area(a, self.top, b - a, self.height, colour)
