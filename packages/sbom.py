#!/usr/bin/env python3
"""The software bill of materials of a release, as SPDX 2.3 in JSON: the packages, and what of others is compiled into them.

usage: sbom.py OUT FILE...    FILE: what is released; OUT: voxtet-X.Y.Z.spdx.json

The same files from the same commit on the same system give the same bytes.
"""
import datetime
import hashlib
import json
import pathlib
import re
import subprocess
import sys

import version

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Debian's package of each, licence, where it comes from, and what it is compiled into.
THIRD_PARTY = {
    "Highway": ("libhwy-dev", "Apache-2.0", "https://github.com/google/highway", "headers, in every library"),
    "Eigen": ("libeigen3-dev", "MPL-2.0", "https://gitlab.com/libeigen/eigen", "headers, in vox_io and vox_sim"),
    "pugixml": ("libpugixml-dev", "MIT", "https://pugixml.org", "in vox_io of builds with VOX_IO_XML that are linked statically"),
    "zlib": ("zlib1g-dev", "Zlib", "https://zlib.net", "in vox_io of builds with VOX_IO_XML that are linked statically"),
    "CLI11": ("libcli11-dev", "BSD-3-Clause", "https://github.com/CLIUtils/CLI11", "headers, in the tool"),
    "JSON for Modern C++": ("nlohmann-json3-dev", "MIT", "https://github.com/nlohmann/json", "headers, in vox_io and the tool"),
}


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout.strip()


def debian_version(package):
    """Without epoch and Debian's revision: "1:1.2.13.dfsg-1" is 1.2.13."""
    return re.sub(r"^\d+:|[-+].*|\.dfsg.*", "", output("dpkg-query", "-W", "-f", "${Version}", package))


def identifier(name):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]+", "-", name)


def document(files):
    number, commit = version.version(), output("git", "rev-parse", "HEAD")
    made = datetime.datetime.fromtimestamp(int(output("git", "log", "-1", "--format=%ct")), datetime.timezone.utc)
    vox = {"name": "vox", "SPDXID": "SPDXRef-vox", "versionInfo": number, "downloadLocation": "NOASSERTION",
           "filesAnalyzed": False, "licenseConcluded": "MIT", "licenseDeclared": "MIT", "copyrightText": "NOASSERTION",
           "sourceInfo": f"commit {commit}"}
    packages, relations = [vox], [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-vox")]
    for name, (package, licence, home, where) in THIRD_PARTY.items():
        packages.append({"name": name, "SPDXID": identifier(name), "versionInfo": debian_version(package), "homepage": home,
                         "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": licence,
                         "licenseDeclared": licence, "copyrightText": "NOASSERTION", "comment": where})
        relations.append(("SPDXRef-vox", "DEPENDS_ON", identifier(name)))
    entries = []
    for path in sorted(files, key=lambda file: file.name):
        data = path.read_bytes()
        entries.append({"fileName": "./" + path.name, "SPDXID": identifier("file-" + path.name),
                        "checksums": [{"algorithm": kind.upper(), "checksumValue": hashlib.new(kind, data).hexdigest()}
                                      for kind in ("sha1", "sha256")],
                        "licenseConcluded": "NOASSERTION", "licenseInfoInFiles": ["NOASSERTION"],
                        "copyrightText": "NOASSERTION"})
        relations.append((identifier("file-" + path.name), "GENERATED_FROM", "SPDXRef-vox"))
    # Names the content, so that no two documents share it.
    content = hashlib.sha256(json.dumps([packages, entries]).encode()).hexdigest()[:32]
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"voxtet-{number}",
            "documentNamespace": f"https://spdx.org/spdxdocs/voxtet-{number}-{content}",
            "creationInfo": {"created": made.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: vox-sbom"]},
            "packages": packages, "files": entries,
            "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b}
                              for a, kind, b in relations]}


def write(out, files):
    out.write_text(json.dumps(document(files), indent=2) + "\n", encoding="utf-8")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    write(pathlib.Path(sys.argv[1]), [pathlib.Path(name) for name in sys.argv[2:]])


if __name__ == "__main__":
    main()
