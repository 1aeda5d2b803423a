"""Checks a site that was built: every link leads to a file and an anchor that are there, nothing is loaded from elsewhere, the
search knows every function, the versions are listed, and in a browser, where there is one, figures and search work without an error.

usage: check.py FOLDER VERSION"""

import functools
import html.parser
import http.server
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import urllib.parse

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))

# Attributes that make a browser load something; <a href> only leads somewhere.
LOADS = {
    ("img", "src"),
    ("script", "src"),
    ("link", "href"),
    ("iframe", "src"),
    ("source", "src"),
    ("source", "srcset"),
    ("video", "src"),
    ("video", "poster"),
    ("audio", "src"),
    ("embed", "src"),
    ("object", "data"),
    ("image", "href"),
    ("use", "href"),
    ("form", "action"),
}
ELSEWHERE = re.compile(r"^(?:[a-z]+:)?//", re.I)


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loads, self.policy = {"", "top"}, [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.anchors.update(found[key] for key in ("id", "name") if found.get(key))
        if tag == "meta" and found.get("http-equiv", "").lower() == "content-security-policy":
            self.policy = True
        for key, value in found.items():
            if value is None:
                continue
            key = key.removeprefix("xlink:")
            if (tag, key) == ("a", "href"):
                self.links.append(value)
            elif (tag, key) in LOADS:
                self.loads.append(value)
            elif key == "style":
                self.loads += urls_of(value)


def urls_of(css):
    css = re.sub(r"/\*.*?\*/", "", css, flags=re.S)
    found = re.findall(r"url\(\s*['\"]?([^'\")]+)['\"]?\s*\)|@import\s+['\"]([^'\"]+)", css)
    return [a or b for a, b in found if not (a or b).startswith(("data:", "#"))]


def files_of(folder):
    for at, _, names in os.walk(folder):
        for name in sorted(names):
            yield os.path.relpath(os.path.join(at, name), folder).replace(os.sep, "/")


def text_of(folder, path):
    with open(os.path.join(folder, path), encoding="utf-8") as file:
        return file.read()


def faults_of_links(folder):
    """Also of what pages and style sheets load. The playground's own files are its own tests' affair, but for their requests."""
    files = set(files_of(folder))
    pages = {path: Page(text_of(folder, path)) for path in sorted(files) if path.endswith(".html")}
    for path, page in pages.items():
        if not page.policy and not path.startswith("playground/"):
            yield f"{path}: no content security policy"
        for link in page.loads:
            if ELSEWHERE.match(link):
                yield f"{path}: loads {link}"
        for link in page.links + [load for load in page.loads if not ELSEWHERE.match(load)]:
            yield from fault_of_link(path, link, files, pages)
    for path in files:
        if path.endswith(".css"):
            for link in urls_of(text_of(folder, path)):
                if ELSEWHERE.match(link):
                    yield f"{path}: loads {link}"
                else:
                    yield from fault_of_link(path, link, files, pages)
        elif path.endswith((".js", ".mjs")) and path.startswith("assets/vox/"):
            for link in re.findall(r"https?://[^\s\"'`)]+", text_of(folder, path)):
                if link != "http://www.w3.org/2000/svg":
                    yield f"{path}: names {link}"


def fault_of_link(path, link, files, pages):
    if re.match(r"(?:https?|mailto|data|javascript):", link):
        return
    if link.startswith("/"):
        yield f"{path}: {link} holds at the root of a server alone"
        return
    name, _, anchor = link.partition("#")
    name = urllib.parse.unquote(name.partition("?")[0])
    target = os.path.normpath(os.path.join(os.path.dirname(path), name)).replace(os.sep, "/") if name else path
    if target.startswith(".."):
        return  # the list of versions
    if target not in files and target + "/index.html" in files:
        target += "/index.html"
    if target == ".":
        target = "index.html"
    if target not in files:
        yield f"{path}: {link}: there is no {target}"
    elif anchor and target in pages and urllib.parse.unquote(anchor) not in pages[target].anchors:
        yield f"{path}: {link}: {target} has no such anchor"


# What people type, and the page that should come first: the words are in its title or its first lines.
SEARCHED = {
    "faq": "docs/faq.html",
    "tutorial": "docs/get-started.html",
    "self-collision": "docs/filters.html",
    "how deep": "docs/depth.html",
    "gpu": "docs/faq.html",
    "best size": "docs/cell-size.html",
}


def faults_of_search(folder):
    entries = json.loads(text_of(folder, "search/search_index.json"))["docs"]
    found = {entry["location"].rpartition("#")[2] for entry in entries}
    for words, page in SEARCHED.items():
        texts = [entry["title"] + " " + entry["text"] for entry in entries if entry["location"].partition("#")[0] == page]
        if not any(words in text.lower() for text in texts):
            yield f"search: {page} does not contain {words!r}"
    with open(os.path.join(ROOT, "bindings", "api.json"), encoding="utf-8") as file:
        api = json.load(file)
    for parsed in api["headers"]:
        for kind in ("functions", "structs", "enums", "callbacks", "opaque", "aliases", "inline", "constants"):
            for thing in parsed[kind]:
                if thing["name"] not in found:
                    yield f"search: no entry for {thing['name']}"


def faults_of_versions(out, version):
    listed = json.loads(text_of(out, "versions.json"))
    if [v["version"] for v in listed if "latest" in v["aliases"]] != [version]:
        yield f"versions.json: {version} is not the latest"
    for name in [v["version"] for v in listed] + ["latest"]:
        if not os.path.exists(os.path.join(out, name, "index.html")):
            yield f"versions.json: there is no {name}/index.html"
    if text_of(out, f"{version}/index.html") != text_of(out, "latest/index.html"):
        yield f"latest/ is not {version}/"
    if "latest/index.html" not in text_of(out, "index.html"):
        yield "index.html does not lead to latest/"


# ---- in a browser ----

# A page that shows a page of the site in a frame, clicks on something on it if there is something to click on, and reports the page's
# address and text, and the text of frames in it, when all that is wanted is there, or after a while.
PROBE = """<!doctype html><iframe id="frame" src="PAGE" style="width:1200px;height:900px"></iframe><script>
const wanted = WANTED.map((words) => new RegExp(words));
const until = Date.now() + 30000;
let link = LINK;
(function look() {
    const shown = document.getElementById("frame").contentWindow;
    const frames = Array.from(shown.frames);
    const loaded = frames.every((page) => page.location.href !== "about:blank" && page.document.readyState === "complete");
    const pages = [shown, ...frames].map((page) => page.document.documentElement?.outerHTML ?? "");
    const text = [shown.location.href, ...pages].join("\\n");
    const found = link && loaded && shown.document.querySelector(link);
    if (found) {
        link = "";
        found.click();
    }
    if (Date.now() < until && !wanted.every((words) => words.test(text))) return setTimeout(look, 50);
    fetch("/report", { method: "POST", body: text });
})();
</script>"""


class Server(http.server.ThreadingHTTPServer):
    """Serves a folder, and probes."""

    daemon_threads = True

    def __init__(self, folder):
        super().__init__(("127.0.0.1", 0), functools.partial(Handler, directory=folder))
        self.missing, self.probe, self.report, self.reported = [], "", "", threading.Event()
        threading.Thread(target=self.serve_forever, daemon=True).start()


class Handler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass

    def send_error(self, code, *rest):
        if self.path != "/favicon.ico":  # of the probe
            self.server.missing.append(f"{code} {self.path}")
        super().send_error(code, *rest)

    def answer(self, text):
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.end_headers()
        self.wfile.write(text.encode())

    def do_GET(self):
        if self.path == "/probe":
            self.answer(self.server.probe)
        else:
            super().do_GET()

    def do_POST(self):
        self.server.report = self.rfile.read(int(self.headers["Content-Length"])).decode()
        self.answer("")
        self.server.reported.set()


# A switch of the page, once the theme listens to it.
def switch(number):
    return f"body:has(.md-version) #__palette_{number}"


def faults_in_browser(out):
    """The site lies in a folder of the server, as it may on any. Everything but that server is unreachable."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not chromium:
        print("SKIPPED: there is no Chromium: figures and search are not tried in a browser")
        return
    with tempfile.TemporaryDirectory() as folder:
        site_folder = os.path.join(folder, "some folder")
        os.mkdir(site_folder)
        for name in ("latest", "0.0.0"):  # the same once more, as another version to change to
            os.symlink(os.path.join(os.path.abspath(out), "latest"), os.path.join(site_folder, name))
        with open(os.path.join(site_folder, "versions.json"), "w", encoding="utf-8") as file:
            json.dump([{"version": name, "title": name, "aliases": []} for name in ("latest", "0.0.0")], file)
        server = Server(folder)
        for page, link, wanted in [
            (
                "docs/paper-explained.html",
                "",
                [
                    'class="vox-plane"',
                    r"At 1 mean edge a tetrahedron costs 35 visits of a cell, \+10 % over the least",
                    r"\+17 % on average",
                    'class="md-version"',
                ],
            ),
            (
                "docs/depth.html#how-it-is-found",
                '.md-version__link[href*="0.0.0"]',
                [r"^http://[^/]*/some%20folder/0\.0\.0/docs/depth\.html#how-it-is-found\n"],
            ),
            (
                "index.html?q=vox_grid_step",
                "",
                [
                    r'<a href="[^"]*#vox_grid_step" class="md-search-result__link"',
                    r'md-search-result__list"[^>]*>\s*<li[^>]*><a href="[^"]*reference/vox/step\.html',
                ],
            ),
            ("docs/faq.html", switch(2), [r'<body[^>]* data-md-color-scheme="slate"']),
            *[
                (
                    "playground.html",
                    switch(number),
                    [f'<body[^>]* data-md-color-scheme="{name}"', f'<html[^>]* data-scheme="{scheme}"'],
                )
                for number, name, scheme in ((2, "slate", "dark"), (1, "default", "light"))
                if os.path.exists(os.path.join(out, "latest", "playground.html"))
            ],
        ]:
            server.probe = (
                PROBE.replace("PAGE", f"/some%20folder/latest/{page}")
                .replace("WANTED", json.dumps(wanted))
                .replace("LINK", json.dumps(link))
            )
            server.reported.clear()
            with open(os.path.join(folder, "said"), "w+", encoding="utf-8") as said:
                browser = subprocess.Popen(
                    [
                        chromium,
                        "--headless",
                        "--no-sandbox",
                        "--disable-gpu",
                        "--enable-logging=stderr",
                        "--remote-debugging-port=0",
                        f"--user-data-dir={folder}/profile",
                        "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
                        f"http://127.0.0.1:{server.server_port}/probe",
                    ],
                    stdout=subprocess.DEVNULL,
                    stderr=said,
                )
                reported = server.reported.wait(60)
                browser.terminate()
                browser.wait()
                said.seek(0)
                for line in said:
                    if "CONSOLE" in line and re.search(r"Uncaught|Refused|violates|Failed|rror", line):
                        yield f"{page}: {line.strip()}"
            for words in wanted:
                if not reported or not re.search(words, server.report):
                    yield f"{page}: in a browser there is no {words}"
        server.shutdown()
        yield from server.missing


def site(out, version):
    folder = os.path.join(out, version)
    found = [
        *faults_of_links(folder),
        *faults_of_search(folder),
        *faults_of_versions(out, version),
        *faults_in_browser(out),
    ]
    if found:
        sys.exit("\n".join(found) + f"\n{len(found)} faults")
    print(f"checked: links, requests, search, versions of {folder}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    site(sys.argv[1], sys.argv[2])
