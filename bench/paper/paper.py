#!/usr/bin/env python3
"""The paper's experiment again: Tables 1 to 5 and Fig. 3, on all eight models, with the reference engine.

    bench/paper/paper.py --vox build/release/tools/vox --meshes FOLDER

runs `vox sweep` on every model and writes docs/evidence/paper.csv, docs/evidence/paper-models.csv, docs/evidence/paper.md and docs/evidence/paper-*.svg. The
spheres are made by the library. FOLDER holds bunny.msh, cow.msh and armadillo.msh; instead, --surfaces names a folder with
bunny.obj, cow.obj and armadillo.obj, which are filled with as many tetrahedra as the paper's models have. Without either
these three are left out. A run that was cut off goes on where it was (the samples are kept in --work). --page writes the
page and the plots again from the CSV files, without measuring.

Needs numpy (Debian: /usr/bin/python3, python3-numpy).
"""
import argparse
import csv
import datetime
import json
import os
import re
import subprocess
import sys

import paper_page

WORLD = 4  # edge of the paper's cubic world


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vox", default="build/release/tools/vox", help="the command line")
    parser.add_argument("--meshes", help="folder with bunny.msh, cow.msh, armadillo.msh")
    parser.add_argument("--surfaces", help="folder with the surfaces of these three, .obj")
    parser.add_argument("--work", default="build/paper", help="folder for samples and filled surfaces")
    parser.add_argument("--out", default="docs/evidence", help="folder for the page")
    parser.add_argument("--count", type=int, default=24, help="cell sizes in the range")
    parser.add_argument("--rounds", type=int, default=7, help="samples of each cell size")
    parser.add_argument("--page", action="store_true", help="write the page from the CSV files alone")
    return parser.parse_args()


def vox(options, *words):
    """The object that a command prints; progress goes to the terminal."""
    done = subprocess.run([options.vox, *map(str, words), "--json"], stdout=subprocess.PIPE)
    if done.returncode != 0:
        raise SystemExit(f"vox {words[0]} failed")
    return json.loads(done.stdout)


def scaled_surface(source, target, factor):
    """A copy of an .obj file with all vertices times `factor`."""
    with open(source, encoding="utf-8") as file, open(target, "w", encoding="utf-8") as out:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                line = "v " + " ".join(repr(float(word) * factor) for word in words[1:4]) + "\n"
            out.write(line)


def fill(options, model, surface):
    """Fills a surface with the model's number of tetrahedra, at the size at which 4 / mean edge is its n_trad."""
    target = os.path.join(options.work, model.name.lower() + ".msh")
    if os.path.exists(target):
        return target
    found = vox(options, "info", surface)["meshes"][0]
    cell = (abs(found["volume"]) * 5.5 / model.tets) ** (1 / 3)
    for _ in range(12):
        tets = vox(options, "tetrahedralize", surface, "-o", target, "--cell", cell)["tets"]
        if abs(tets / model.tets - 1) < 0.005:
            break
        cell *= (tets / model.tets) ** (1 / 3)
    edge = vox(options, "info", target)["meshes"][0]["mean_edge"]
    factor = WORLD / model.n_trad / edge
    copy = os.path.join(options.work, model.name.lower() + ".obj")
    scaled_surface(surface, copy, factor)
    vox(options, "tetrahedralize", copy, "-o", target, "--cell", cell * factor)
    return target


def body(options, model):
    """The arguments that give `vox sweep` this model, or None."""
    if model.name.startswith("Sphere"):
        return ["--ball", model.tets]
    name = model.name.lower()
    if options.meshes:
        return [os.path.join(options.meshes, name + ".msh")]
    if options.surfaces:
        # The cow as it comes intersects itself; a wrapped one is preferred where there is one.
        for surface in name + "_wrapped.obj", name + ".obj":
            if os.path.exists(os.path.join(options.surfaces, surface)):
                return [fill(options, model, os.path.join(options.surfaces, surface))]
    return None


def cost(geometry, cell_size):
    """The paper's z, Eqs. 3 to 7, as vox_suggest_cell_size reads it."""
    p_nc, ratio = 0.99, 5
    k = (1 - p_nc) * ratio * 3 * 3 ** 0.5 / (2 * geometry["mean_facet_area"])
    return (geometry["mean_edge"] / cell_size + 2) ** 3 * (p_nc + k * cell_size ** 2)


def sample_rows(model, sweep):
    geometry = sweep["predicted"]["geometry"]
    for sample in sweep["samples"]:
        yield {"model": model.name, "rule": sample["rule"] or "", "cell_size": sample["cell_size"],
               "n": sample["cells_per_axis"], "mean_edges": sample["cell_size"] / geometry["mean_edge"],
               "time_ms": sample["time_ns"] / 1e6, "fitted_ms": (sample["fitted_ns"] or 0) / 1e6,
               "worst_round_ms": max(sample["rounds_ns"]) / 1e6, "cost": cost(geometry, sample["cell_size"]),
               "visited_cells": sample["visited_cells"], "visited_entries": sample["visited_entries"],
               "candidates": sample["candidates"]}


def model_row(model, sweep, run):
    row = {"model": model.name, "tets": sweep["meshes"][0]["tets"], "frames": sweep["frames"],
           "rounds": sweep["rounds"], "share": sweep["contact_share"]["mean"],
           "first_share": sweep["contact_share"]["frames"][0], "last_share": sweep["contact_share"]["frames"][-1],
           "distance": sweep["distance"], "hash": sweep["hash"],
           "mean_edge": sweep["predicted"]["geometry"]["mean_edge"],
           "n_a": sweep["suggestion"]["cells_per_axis"], "n_trad": sweep["traditional"]["cells_per_axis"],
           "n_opt": sweep["optimum"]["cells_per_axis"], "optimum_ms": sweep["optimum"]["time_ns"] / 1e6,
           "n_min": sweep["zone"]["n_min"], "n_max": sweep["zone"]["n_max"],
           "n_min_5": sweep["zone_5_percent"]["n_min"], "n_max_5": sweep["zone_5_percent"]["n_max"],
           "degree": sweep["fit"]["degree"], "prediction_error": sweep["fit"]["prediction_error"],
           "bracketed": int(sweep["fit"]["bracketed"]),
           "range_min": sweep["fit"]["range"]["min"], "range_max": sweep["fit"]["range"]["max"],
           "coefficients": " ".join(map(repr, sweep["fit"]["coefficients"]))}
    for key in "epsilon", "epsilon_5_percent", "regret", "regret_fitted":
        for rule in paper_page.RULES:
            row[f"{key}:{rule}"] = sweep[key].get(rule)
    return {**row, **run, "load": os.getloadavg()[1]}


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return re.search(r"model name\s*: (.*)", file.read()).group(1).strip()


def write_csv(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def measure(options):
    os.makedirs(options.work, exist_ok=True)
    run = {"date": datetime.date.today().isoformat(), "cpu": machine(),
           "build": subprocess.run([options.vox, "--version"], capture_output=True, text=True,
                                   check=True).stdout.split("library: ")[-1].strip()}
    samples, models = [], []
    for model in paper_page.PAPER:
        source = body(options, model)
        if source is None:
            print(f"{model.name}: no mesh, left out (--meshes or --surfaces)", file=sys.stderr)
            continue
        print(f"{model.name} ...", file=sys.stderr)
        sweep = vox(options, "sweep", *source, "--world", WORLD, "--count", options.count, "--rounds", options.rounds,
                    "--resume", os.path.join(options.work, model.name.lower() + ".csv"))
        samples += sample_rows(model, sweep)
        models.append(model_row(model, sweep, run))
    write_csv(os.path.join(options.out, "paper.csv"), samples)
    write_csv(os.path.join(options.out, "paper-models.csv"), models)


def main():
    options = arguments()
    if not options.page:
        measure(options)
    paper_page.write(options.out)


if __name__ == "__main__":
    main()
