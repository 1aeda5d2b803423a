"""What the report and the chart share: the rows of a results file, by scene and size."""

import csv
from collections import OrderedDict
from dataclasses import dataclass, field

SUBJECT = "vox"  # a grid with constraints, with all that its step does
CONTACTS = "vox contacts"  # the default grid: contacts alone, as the peers find them
AVX2 = "vox AVX2"  # the subject with no more than AVX2
REFERENCE = "vox reference"  # the paper's algorithm, contacts alone
F1 = "F1 positions"
F2 = "F2 tet boxes"


@dataclass
class Scene:
    """One scene at one size: a row of the file for each entrant."""

    name: str
    title: str
    tets: int
    contacts: int
    bodies: int
    mean_edge: float
    rows: dict = field(default_factory=OrderedDict)

    def label(self):
        return f"{self.bodies} {self.title}" if self.title.startswith("bodies") else self.title

    def ms(self, entrant):
        return float(self.rows[entrant]["median_ns"]) / 1e6 if entrant in self.rows else None

    def ns_per_tet(self, entrant):
        return 1e6 * self.ms(entrant) / self.tets if entrant in self.rows else None

    def bytes_per_tet(self, entrant):
        return int(self.rows[entrant]["bytes"]) / self.tets if entrant in self.rows else None

    def best_peer(self):
        """Name of the fastest peer, or None."""
        names = [name for name, row in self.rows.items() if row["kind"] == "peer"]
        return min(names, key=self.ms) if names else None

    def times_faster(self, entrant, other):
        """How many times as fast as `other` the entrant is, or None."""
        if other not in self.rows or entrant not in self.rows:
            return None
        return self.ms(other) / self.ms(entrant)

    def is_comparison(self):
        """Not one of the runs of vox alone, which show how time grows."""
        return REFERENCE in self.rows or self.best_peer() is not None


def read(path):
    """The rows of a file, and its scenes in the order of the file."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        raise SystemExit(f"{path} has no results")
    for row in rows:  # what is empty is that of the first row
        row.update({column: row[column] or rows[0][column] for column in ("date", "cpu", "build", "command")})
    scenes = []
    for row in rows:
        # The runs of vox alone may repeat a scene and size: a repeated entrant starts another run.
        last = scenes[-1] if scenes else None
        if (last is None or (last.name, last.tets) != (row["scene"], int(row["tets"]))
                or row["entrant"] in last.rows):
            last = Scene(row["scene"], row["title"], int(row["tets"]), int(row["contacts"]),
                         int(row["bodies"]), float(row["mean_edge"]))
            scenes.append(last)
        last.rows[row["entrant"]] = row
    return rows, scenes
