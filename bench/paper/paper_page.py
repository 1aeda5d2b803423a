"""docs/evidence/paper.md and its plots, from the CSV files of paper.py."""
import csv
import math
import os
import sys
from dataclasses import dataclass

import numpy

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from chart import Axis, Chart, Panel, round_ticks  # noqa: E402


@dataclass
class Published:
    """A model's row in the paper's Tables 1 to 5. n: cells per axis of a world of edge 4."""

    name: str
    tets: int
    n_a: float
    n_min: float
    n_opt: float
    n_max: float
    n_trad: float
    eps_a: float
    eps_trad: float


PAPER = [
    Published("Sphere01", 41937, 28.73, 20, 28.33, 39, 41.90, 0.038, 1.272),
    Published("Sphere02", 52326, 30.94, 22, 28.16, 38, 45.16, 0.283, 1.727),
    Published("Sphere03", 60688, 32.49, 16, 34.04, 54, 47.40, 0.086, 0.669),
    Published("Sphere04", 72631, 34.48, 8, 26.63, 47, 50.29, 0.385, 1.162),
    Published("Sphere05", 80927, 35.65, 20, 37.87, 57, 51.90, 0.124, 0.734),
    Published("Bunny", 20462, 31.35, 16, 22.97, 34, 44.94, 0.759, 1.992),
    Published("Cow", 50380, 48.80, 13, 31.15, 54, 70.93, 0.772, 1.741),
    Published("Armadillo", 16377, 31.55, 13, 20.49, 37, 45.48, 0.669, 1.516),
]

RULES = {
    "suggestion": "**the paper's cost function**",
    "traditional": "mean edge (Teschner et al. 2003)",
    "mean_edge_multiple": "twice the mean edge (after Gregory et al. 2000)",
    "object_512": "512 cells an object (García-Alonso et al. 1994)",
    "mean_volume": "cube root of the mean volume",
    "median_box_side": "median box side (IPC Toolkit)",
}

OURS, TRADITIONAL, MEASURED, COST, PAPERS, NEAR, NEARER = "vox", "orange", "dark", "blue", "violet", "sky", "green"


class Model:
    """What was measured on one model: its row, its samples, and the paper's row."""

    def __init__(self, row, samples):
        self.row = row
        self.samples = samples
        self.paper = next(paper for paper in PAPER if paper.name == row["model"])
        self.name = self.paper.name

    def __getitem__(self, key):
        return float(self.row[key])

    def get(self, key):
        return float(self.row[key]) if self.row[key] else None

    def column(self, key):
        return numpy.array([float(sample[key]) for sample in self.samples])

    def in_fit(self):
        """Which samples the fit was made of."""
        sizes = self.column("cell_size")
        return (sizes >= self["range_min"]) & (sizes <= self["range_max"])

    def fitted(self, n):
        """Fitted milliseconds at n cells per axis: the power series of the fit of vox sweep."""
        low, high = math.log(self["range_min"]), math.log(self["range_max"])
        u = 2 * (numpy.log(4 / n) - low) / (high - low) - 1
        powers = [float(word) for word in self.row["coefficients"].split()]
        return numpy.exp(sum(c * u ** k for k, c in enumerate(powers))) / 1e6

    def fitted_range(self):
        return numpy.geomspace(4 / self["range_max"] * (1 + 1e-9), 4 / self["range_min"] * (1 - 1e-9), 300)

    def weights(self):
        """Nanoseconds of a cell visited, of a particle met there, and of a step beside them, by least squares relative
        to the times: (cell, particle, rest, root mean square relative error)."""
        frames = self["frames"]
        times = self.column("time_ms") * 1e6
        terms = numpy.stack([self.column("visited_cells") / frames, self.column("visited_entries") / frames,
                             numpy.ones(len(times))], axis=1) / times[:, None]
        found, *_ = numpy.linalg.lstsq(terms, numpy.ones(len(times)), rcond=None)
        error = math.sqrt(float(numpy.mean((terms @ found - 1) ** 2)))
        return (*found, error)


def read(folder):
    def rows(name):
        with open(os.path.join(folder, name), newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    samples = rows("paper.csv")
    return [Model(row, [s for s in samples if s["model"] == row["model"]]) for row in rows("paper-models.csv")]


# ---- plots -------------------------------------------------------------------------------------------


def draw_times(panel, model):
    """Time over cells per axis with the fit, the zone, both rules, and the paper's zone and optimum below."""
    panel.band(model["n_min"], model["n_max"], NEAR)
    panel.band(model["n_min_5"], model["n_max_5"], NEARER)
    line = model.fitted_range()
    panel.line(list(zip(line, model.fitted(line))), MEASURED, 1)
    panel.dots(zip(model.column("n"), model.column("time_ms")), MEASURED, size=2)
    panel.upright(model["n_a"], OURS)
    panel.upright(model["n_trad"], TRADITIONAL, dash="5 3")
    panel.dots([(model["n_opt"], model["optimum_ms"])], MEASURED, "circle", 4, hollow=True)
    paper, low = model.paper, 0.1 * panel.y.high
    panel.bar(paper.n_min, paper.n_max, low, PAPERS)
    panel.dots([(paper.n_opt, low)], PAPERS, "diamond", 6)


def keys_of_times(chart):
    return [("at most 1 ms above the optimum", chart.area_key(NEAR)), ("measured", chart.mark_key(MEASURED, size=2)),
            ("mean edge, n_trad", chart.line_key(TRADITIONAL, dash="5 3")), ("at most 5 % above it", chart.area_key(NEARER)),
            ("cost function, n_a", chart.line_key(OURS)), ("the paper's zone and optimum", chart.line_key(PAPERS, 4)),
            ("fit and its optimum", chart.line_key(MEASURED, 1))]


def draw_cost(panel, model):
    """The cost function and the measured time, both over their least."""
    n = model.column("n")
    order = numpy.argsort(n)
    cost = model.column("cost")
    panel.line(list(zip(n[order], (cost / cost.min())[order])), COST)
    panel.dots(zip(n, model.column("time_ms") / model["optimum_ms"]), MEASURED, size=2)
    panel.upright(model["n_a"], OURS)


def keys_of_cost(chart):
    return [("cost function z over its least", chart.line_key(COST)), ("measured time over the fit's least", chart.mark_key(MEASURED, size=2)),
            ("least of the cost function, n_a", chart.line_key(OURS))]


def axis_of_times(model):
    top = 2.6 * model["optimum_ms"]
    return Axis(0, top, round_ticks(0, top), name="ms a frame")


def axis_of_cost(_):
    return Axis(0.9, 3.6, [1, 1.5, 2, 2.5, 3, 3.5], name="over the least")


def plot(path, title, models, y_axis, draw, keys, columns, height):
    """A panel for each model."""
    width = (760 - 50 * columns) // columns
    rows = -(-len(models) // columns)
    legend = keys(Chart(0, 0, ""))
    chart = Chart(760, rows * (height + 70) + 20 + 17 * -(-len(legend) // 3), title)
    for i, model in enumerate(models):
        right = 1.7 * model["n_trad"]
        draw(Panel(chart, 44 + i % columns * (width + 50), 24 + i // columns * (height + 70), width, height,
                   Axis(0, right, round_ticks(0, right, 8), name="voxels per axis, n"), y_axis(model),
                   f"{model.name}: n_a = {model['n_a']:.1f}, measured optimum {model['n_opt']:.1f}"), model)
    chart.legend(44, rows * (height + 70) + 16, keys(chart), 3, 240)
    chart.write(path)


def plots(models, folder):
    times = "Time of detection against voxels per axis", axis_of_times, draw_times, keys_of_times
    for name, shown, (title, axis, draw, keys), columns, height in (
            ("paper-figure-3.svg", models[:1], times, 1, 240), ("paper-times.svg", models, times, 2, 110),
            ("paper-cost.svg", models, ("The cost function and the measured times", axis_of_cost, draw_cost, keys_of_cost), 2, 110)):
        plot(os.path.join(folder, name), title, shown, axis, draw, keys, columns, height)


# ---- tables ------------------------------------------------------------------------------------------


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def tables_2_and_4(models):
    head = ["model"] + [word for key in ("n_a", "n_min", "n_opt", "n_max", "n_trad") for word in (key, "ours")]
    rows = []
    for model in models:
        row = [model.name]
        for key in "n_a", "n_min", "n_opt", "n_max", "n_trad":
            row += [f"{getattr(model.paper, key):g}", f"**{model[key]:.2f}**"]
        rows.append(row)
    return table(head, rows)


def judged(value):
    return f"**{value:.3f}**" if value <= 1 else f"{value:.3f}"


def tables_3_and_5(models):
    rows = []
    for model in models:
        rows.append([model.name, judged(model.paper.eps_a), judged(model["epsilon:suggestion"]),
                     judged(model["epsilon_5_percent:suggestion"]), judged(model.paper.eps_trad),
                     judged(model["epsilon:traditional"]), judged(model["epsilon_5_percent:traditional"])])
    return table(["model", "ε(n_a), paper", "ours, 1 ms", "ours, 5 %", "ε(n_trad), paper", "ours, 1 ms", "ours, 5 %"],
                 rows)


def percent(value):
    return "-" if value is None else f"{100 * value:+.1f} %"


def mean(values):
    values = [value for value in values if value is not None]
    return sum(values) / len(values) if values else None


def regrets(models):
    rows = []
    for rule, words in RULES.items():
        found = [model.get(f"regret:{rule}") for model in models]
        fitted = [model.get(f"regret_fitted:{rule}") for model in models]
        rows.append([words, *map(percent, found), f"**{percent(mean(found))}**", percent(mean(fitted))])
    return table(["rule", *(model.name for model in models), "mean", "mean, by the fits"], rows)


def weights(models):
    rows = []
    for model in models:
        cell, particle, rest, error = model.weights()
        rows.append([model.name, f"{cell:.1f} ns", f"{particle:.2f} ns", f"{particle / cell:.2f}", f"{rest / 1e6:.2f} ms",
                     f"{100 * error:.1f} %"])
    return table(["model", "a cell visited", "a particle met there", "their ratio (the paper: 5)", "the rest of a step",
                  "error of the sum"], rows)


def terms(models):
    """The two terms of the cost function at n_a, as its formulas have them and as counted there."""
    rows = []
    for model in models:
        sample = next(s for s in model.samples if s["rule"] == "suggestion")
        edges = float(sample["mean_edges"])
        steps = model["frames"] * 2 * model["tets"]
        cells, entries = float(sample["visited_cells"]), float(sample["visited_entries"])
        v_o = (1 / edges + 2) ** 3
        p_v = (float(sample["cost"]) / v_o - 0.99) / (0.01 * 5)
        rows.append([model.name, f"{v_o:.1f}", f"{cells / steps:.2f}", f"{p_v:.1f}", f"{entries / cells:.2f}"])
    return table(["model", "v_o, cells a tetrahedron visits", "counted", "p_v, particles in a cell",
                  "counted, in a cell visited"], rows)


def fit_in_n(model):
    """The same fit by a polynomial in n, as in the paper's Fig. 3: (relative leave-one-out error, degree, n_opt)."""
    inside = model.in_fit()
    n, times = model.column("n")[inside], model.column("time_ms")[inside]
    u = 2 * (n - n.min()) / (n.max() - n.min()) - 1
    fits = []
    for degree in range(2, 9):
        basis, _ = numpy.linalg.qr(numpy.polynomial.legendre.legvander(u, degree))
        residual = times - basis @ (basis.T @ times)
        unseen = residual / (1 - (basis ** 2).sum(axis=1))
        # In logarithms as the other fit's; a prediction below 0, which has none, counts as 1 % of the time.
        error = numpy.log(numpy.maximum(1 - unseen / times, 0.01))
        fits.append((math.sqrt(float(numpy.mean(error ** 2))), degree))
    error, degree = min(fits)
    series = numpy.polynomial.Legendre.fit(n, times, degree)
    line = numpy.linspace(n.min(), n.max(), 4001)
    return error, degree, float(line[numpy.argmin(series(line))])


def fits(models):
    rows = []
    for model in models:
        error, degree, n_opt = fit_in_n(model)
        rows.append([model.name, f"{100 * error:.1f} %", str(degree), f"{n_opt:.1f}", f"{model['n_trad'] / n_opt:.2f}",
                     f"{100 * model['prediction_error']:.1f} %", f"{model['degree']:.0f}", f"{model['n_opt']:.1f}",
                     f"{model['n_trad'] / model['n_opt']:.2f}"])
    return table(["model", "in n: error", "degree", "n_opt", "in mean edges", "in logarithms: error", "degree", "n_opt",
                  "in mean edges"], rows)


def in_short(models):
    eps_a = [model["epsilon:suggestion"] for model in models]
    inside = sum(eps <= 1 for eps in eps_a)
    better = sum(model["epsilon:suggestion"] < model["epsilon:traditional"] for model in models)
    regret = mean([model.get("regret:suggestion") for model in models])
    return "\n".join([
        f"* The cost function's value lies inside the measured zone (ε at most 1) on {inside} of {len(models)} models; the "
        f"largest ε is {max(eps_a):.3f}.",
        f"* It is closer to the measured optimum than the mean edge is on {better} of {len(models)}.",
        f"* It costs {100 * regret:.1f} % more than the best cell size measured, on average; the mean edge costs "
        f"{100 * mean([model.get('regret:traditional') for model in models]):.1f} % more.", ""])


def numbers(models):
    """What the text below the tables quotes."""
    first = models[0]
    return {
        "models": len(models), "count": int((first.column("n") > 0).sum()), "rounds": int(first["rounds"]),
        "frames": int(first["frames"]), "date": first.row["date"], "cpu": first.row["cpu"],
        "build": first.row["build"], "load_min": min(m["load"] for m in models),
        "load_max": max(m["load"] for m in models),
        "first_share": 100 * mean([m["first_share"] for m in models]),
        "last_share": 100 * mean([m["last_share"] for m in models]),
        "share_min": 100 * min(m["share"] for m in models), "share_max": 100 * max(m["share"] for m in models),
        "degree_min": int(min(m["degree"] for m in models)), "degree_max": int(max(m["degree"] for m in models)),
        "error_min": 100 * min(m["prediction_error"] for m in models),
        "error_max": 100 * max(m["prediction_error"] for m in models),
        "millisecond_min": 100 / max(m["optimum_ms"] for m in models),
        "millisecond_max": 100 / min(m["optimum_ms"] for m in models),
        "ratio_min": min(m.weights()[1] / m.weights()[0] for m in models),
        "ratio_max": max(m.weights()[1] / m.weights()[0] for m in models),
        "opt_edges_min": min(m["n_trad"] / m["n_opt"] for m in models),
        "opt_edges_max": max(m["n_trad"] / m["n_opt"] for m in models),
        "paper_edges_min": min(m.paper.n_trad / m.paper.n_opt for m in models),
        "paper_edges_max": max(m.paper.n_trad / m.paper.n_opt for m in models),
    }


def write(folder):
    models = read(folder)
    plots(models, folder)
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "paper.md.in"), encoding="utf-8") as file:
        text = file.read()
    parts = {"table_1": table(["model", "tetrahedra, paper", "ours"],
                              [[m.name, str(m.paper.tets), f"{m['tets']:.0f}"] for m in models]),
             "tables_2_and_4": tables_2_and_4(models), "tables_3_and_5": tables_3_and_5(models),
             "regrets": regrets(models), "weights": weights(models), "terms": terms(models), "fits": fits(models),
             "figures": in_short(models)}
    with open(os.path.join(folder, "paper.md"), "w", encoding="utf-8") as file:
        file.write(text.format(**parts, **numbers(models)))
