"""The paper's experiment as measured again (docs/evidence/paper.csv, docs/evidence/paper-models.csv) and as printed in the paper
(bench/paper), for the live figures."""

import csv
import json
import os

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def rows(path):
    with open(os.path.join(ROOT, path), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def models():
    found = []
    for model in rows("docs/evidence/paper-models.csv"):
        times = [
            {
                "rule": row["rule"],
                "cellSize": float(row["cell_size"]),
                "time": float(row["time_ms"]),
                "cost": float(row["cost"]),
            }
            for row in rows("docs/evidence/paper.csv")
            if row["model"] == model["model"]
        ]
        found.append(
            {
                "name": model["model"],
                "tets": int(model["tets"]),
                "meanEdge": float(model["mean_edge"]),
                "cellsPerAxis": float(model["n_a"]),
                "best": float(model["n_opt"]),
                "times": times,
            }
        )
    return found


def module():
    return "export const models = " + json.dumps(models(), separators=(",", ":")) + ";\n"
