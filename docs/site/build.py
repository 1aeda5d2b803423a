#!/usr/bin/env python3
"""Builds the documentation as a site of static files.

usage: build.py [--out FOLDER] [--version NAME] [--check] [--serve PORT] [--offline]

FOLDER (build/site) gets a folder for this version, a copy of it as latest/, and an index.html that leads there. What it
holds of other versions stays, and all versions are in each other's list. The name of a version is that of the headers unless it is
given. The generator, MkDocs with Material's theme at the versions of requirements.txt, goes into build/docs/venv; once it
is there, nothing is downloaded. --offline fails instead of downloading. --check also checks what was built (check.py).
Status 77: the generator could not be installed."""

import argparse
import functools
import hashlib
import http.server
import json
import os
import re
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import pages  # noqa: E402
import paper_data  # noqa: E402
import reference  # noqa: E402

ROOT = pages.ROOT
BUILD = os.path.join(ROOT, "build", "docs")
PLAYGROUND = os.path.join(ROOT, "build", "web")
SKIPPED = 77

NAVIGATION = [
    {"Home": "docs/site/home.md"},
    {
        "Get started": [
            "docs/get-started.md",
            {"Games": "docs/for-games.md"},
            {"Simulation and surgery": "docs/for-simulation.md"},
            {"Research, in Python": "docs/for-research.md"},
            {"Tools and pipelines": "docs/for-tools.md"},
            {"Examples": "examples/README.md"},
            "docs/install.md",
            "docs/mistakes.md",
            "docs/faq.md",
            "docs/glossary.md",
            "docs/gallery.md",
            {"All pages": "docs/README.md"},
            {"The README": "README.md"},
        ]
    },
    {
        "Tasks": [
            "docs/contacts.md",
            "docs/push-apart.md",
            "docs/resolve.md",
            "docs/events.md",
            "docs/filters.md",
            "docs/edges.md",
            "docs/shapes.md",
            "docs/queries.md",
            "docs/locate.md",
            "docs/tracks.md",
            "docs/cutting.md",
            "docs/surface-pairs.md",
            "docs/jolt.md",
            "docs/ipc-broad-phase.md",
            "docs/files.md",
            "docs/file-formats.md",
            "docs/tetrahedralize.md",
            "docs/your-own-grid.md",
            "docs/agents.md",
            "docs/point-search.md",
            "docs/sim.md",
            "docs/threads.md",
            "docs/memory.md",
            "docs/snapshot.md",
            "docs/distributed.md",
            "docs/gpu.md",
        ]
    },
    {
        "Ideas": [
            {"The paper in five minutes": "docs/paper-explained.md"},
            "docs/cell-size.md",
            "docs/depth.md",
        ]
    },
    {
        "Languages": [
            {"C++": "docs/cpp.md"},
            {"Python": "bindings/python/README.md"},
            {"C#": "bindings/csharp/README.md"},
            {"Rust": "bindings/rust/voxtet/README.md"},
            {"JavaScript": "bindings/js/README.md"},
            {"MuJoCo": "bindings/mujoco/README.md"},
            {"Go, Java, Julia, yours": "docs/other-languages.md"},
            "docs/go.md",
            "docs/java.md",
            "docs/julia.md",
            "docs/command-line.md",
            "docs/limits.md",
        ]
    },
    "reference",
    {
        "Evidence": [
            "docs/evidence/README.md",
            "docs/evidence/performance.md",
            "docs/evidence/costs.md",
            "docs/evidence/hard-scenes.md",
            "docs/evidence/cell-size.md",
            "docs/evidence/regret.md",
            "docs/evidence/shapes.md",
            "docs/evidence/foreign-grids.md",
            "docs/evidence/paper.md",
            "docs/evidence/surface-pairs.md",
            "docs/evidence/jolt.md",
            "docs/evidence/locate.md",
            "docs/evidence/resolve.md",
            "docs/evidence/distributed.md",
            "docs/evidence/gpu.md",
            "docs/evidence/limits.md",
            {"Benchmarks": "bench/README.md"},
            {"Tried for speed": "bench/TRIED.md"},
            {"Tests": "tests/README.md"},
        ]
    },
    {
        "Inside": [
            {"Maintainers": "docs/for-maintainers.md"},
            {"How it works": "src/README.md"},
            "docs/engine.md",
            "docs/depth-method.md",
            "docs/cost-models.md",
            "docs/grid-counts.md",
            "docs/abi.md",
            "docs/renamed.md",
            "docs/style.md",
            {"Bindings": "bindings/README.md"},
            "CONTRIBUTING.md",
            "RELEASING.md",
            "SECURITY.md",
            "CHANGELOG.md",
        ]
    },
]

ROOT_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>vox</title><meta http-equiv="refresh" content="0; url=latest/index.html">
</head><body><p>The documentation: <a href="latest/index.html">latest</a></p></body></html>
"""

PLAYGROUND_PAGE = """---
title: Playground
hide: [navigation, toc]
---

# Playground

<iframe class="vox-playground" src="playground/index.html" title="Playground" loading="lazy"></iframe>

Bodies to drop, drag and cut, and the cost of a step at every cell size. It runs in your browser; nothing leaves it.
[On the whole window](playground/index.html)
"""


def environment(offline):
    """The generator's own Python, installed if need be; None if that fails."""
    folder = os.path.join(BUILD, "venv")
    python = os.path.join(folder, "bin", "python")
    wanted = os.path.join(HERE, "requirements.txt")
    with open(wanted, "rb") as file:
        state = hashlib.sha256(file.read()).hexdigest()
    stamp = os.path.join(folder, "installed")
    if os.path.exists(stamp) and open(stamp, encoding="utf-8").read() == state:
        return python
    if offline:
        print("docs: the generator is not installed, and --offline allows no download", file=sys.stderr)
        return None
    shutil.rmtree(folder, ignore_errors=True)
    for command in (
        [sys.executable, "-m", "venv", folder],
        [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--require-hashes", "-r", wanted],
    ):
        if subprocess.run(command, check=False).returncode != 0:
            shutil.rmtree(folder, ignore_errors=True)
            print("docs: skipped: the generator could not be installed (no pip, or no network)", file=sys.stderr)
            return None
    with open(stamp, "w", encoding="utf-8") as file:
        file.write(state)
    return python


def examples_of_sections(site):
    """Links to examples by section of the headers, as the table in examples/README.md lists them."""
    text = site.read("examples/README.md").split("## By section of the headers", 1)[1]
    return {
        name.strip("`"): [
            f"[{label}](../../{site.place_of('examples/' + target)})"
            for label, target in re.findall(r"\[([^\]]+)\]\(([^)]+)\)", links)
            if not target.startswith("..")
        ]
        for name, links in re.findall(r"^\| ([^|]+) \| (.*) \|$", text, flags=re.M)
    }


def write(path, text):
    path = os.path.join(BUILD, "pages", path)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def prepare(version):
    """Writes the Markdown that MkDocs reads, and its settings."""
    shutil.rmtree(os.path.join(BUILD, "pages"), ignore_errors=True)
    described = reference.Reference()
    playground = os.path.exists(os.path.join(PLAYGROUND, "index.html"))
    if not playground:
        print("docs: build/web is empty, so this site has no playground: ./dev web builds it")
    site = pages.collect(described.places, playground=playground)
    links = examples_of_sections(site)
    for name in pages.REFERENCE:
        site.add(name + ".md", functools.partial(site.source, name))
    navigation = [navigation_entry(entry, site, described) for entry in NAVIGATION]
    if playground:
        shutil.copytree(PLAYGROUND, os.path.join(BUILD, "pages", "playground"))
        write("playground.md", PLAYGROUND_PAGE)
        navigation.insert(1, {"Playground": "playground.md"})
    if site.faults:
        sys.exit("\n".join(site.faults))
    for path, text in {**site.texts, **described.pages(links)}.items():
        write(path, text)
    for path in site.files:
        target = os.path.join(BUILD, "pages", path)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        shutil.copyfile(os.path.join(ROOT, path), target)
    shutil.copytree(os.path.join(HERE, "live"), os.path.join(BUILD, "pages", "assets", "vox"))
    write("assets/vox/paper_data.js", paper_data.module())
    settings = {
        "INHERIT": os.path.join(HERE, "mkdocs.yml"),
        "docs_dir": os.path.join(BUILD, "pages"),
        "nav": navigation,
        "theme": {"custom_dir": os.path.join(HERE, "overrides")},
    }
    with open(os.path.join(BUILD, "mkdocs.yml"), "w", encoding="utf-8") as file:
        json.dump(settings, file, indent=1)  # JSON is YAML
    return version or described.api["version"]


def pages_of(entries):
    """The files of the repository that the navigation names."""
    for entry in entries:
        if isinstance(entry, dict):
            (inside,) = entry.values()
            yield from pages_of(inside if isinstance(inside, list) else [inside])
        elif entry != "reference":
            yield entry


def navigation_entry(entry, site, described):
    if entry == "reference":
        return described.navigation()
    if isinstance(entry, str):
        return site.place_of(entry)
    ((title, inside),) = entry.items()
    if isinstance(inside, list):
        return {title: [navigation_entry(e, site, described) for e in inside]}
    return {title: site.place_of(inside)}


def publish(python, out, version):
    """Builds the site of this version, and the list of all versions in `out`."""
    target = os.path.join(out, version)
    shutil.rmtree(target, ignore_errors=True)
    paths = {**os.environ, "PYTHONPATH": HERE, "PYTHONDONTWRITEBYTECODE": "1", "NO_MKDOCS_2_WARNING": "1"}
    run = subprocess.run(
        [python, "-m", "mkdocs", "--quiet", "build", "--clean", "-f", os.path.join(BUILD, "mkdocs.yml"), "-d", target],
        env=paths,
        check=False,
    )
    if run.returncode != 0:
        sys.exit(run.returncode)
    os.remove(os.path.join(target, "404.html"))  # its links would hold at the root of a server alone
    os.remove(os.path.join(target, "sitemap.xml.gz"))
    write_map(target)
    with open(os.path.join(target, "version.json"), "w", encoding="utf-8") as file:
        json.dump({"version": version}, file)
    list_versions(out, version)


def write_map(target):
    """The theme asks another version's map whether it has a page, so that a reader who changes the version stays on it. It goes
    by what is common to all addresses, so any server's name does."""
    pages_there = [""] + sorted(
        os.path.relpath(os.path.join(at, name), target).replace(os.sep, "/")
        for at, _, names in os.walk(target)
        for name in names
        if name.endswith(".html")
    )
    with open(os.path.join(target, "sitemap.xml"), "w", encoding="utf-8") as file:
        file.write(
            '<?xml version="1.0" encoding="UTF-8"?>\n<urlset xmlns="http://www.sitemaps.org/schemas/sitemap/0.9">\n'
        )
        file.writelines(f"<url><loc>http://localhost/{path}</loc></url>\n" for path in pages_there)
        file.write("</urlset>\n")


def order_of(version):
    """Numbers as numbers; other names first."""
    return [(1, int(part), "") if part.isdigit() else (2, 0, part) for part in version.split(".")]


def list_versions(out, latest):
    names = [
        name for name in os.listdir(out) if name != "latest" and os.path.exists(os.path.join(out, name, "version.json"))
    ]
    names.sort(key=order_of, reverse=True)
    shutil.rmtree(os.path.join(out, "latest"), ignore_errors=True)
    shutil.copytree(os.path.join(out, latest), os.path.join(out, "latest"))
    with open(os.path.join(out, "versions.json"), "w", encoding="utf-8") as file:
        json.dump(
            [{"version": name, "title": name, "aliases": ["latest"] if name == latest else []} for name in names],
            file,
            indent=1,
        )
    with open(os.path.join(out, "index.html"), "w", encoding="utf-8") as file:
        file.write(ROOT_PAGE)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default=os.path.join(ROOT, "build", "site"))
    parser.add_argument("--version")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--serve", type=int, metavar="PORT")
    parser.add_argument("--offline", action="store_true")
    options = parser.parse_args()
    os.makedirs(BUILD, exist_ok=True)
    os.makedirs(options.out, exist_ok=True)
    python = environment(options.offline)
    if not python:
        sys.exit(SKIPPED)
    version = prepare(options.version)
    publish(python, os.path.abspath(options.out), version)
    print("written:", os.path.join(options.out, version, "index.html"))
    if options.check:
        import check

        check.site(os.path.abspath(options.out), version)
    if options.serve is not None:
        handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=options.out)
        server = http.server.ThreadingHTTPServer(("127.0.0.1", options.serve), handler)
        print(f"http://127.0.0.1:{server.server_port}/ (Ctrl+C ends it)")
        server.serve_forever()


if __name__ == "__main__":
    main()
