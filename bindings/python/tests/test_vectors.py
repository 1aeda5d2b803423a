"""The vectors that every language replays (bindings/vectors): the same results, bit for bit."""

import json
import math
import os
import unittest

import numpy as np

import voxtet

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "vectors")


def hash_of(array):
    """Of the 32-bit words of an array, where -0 counts as 0."""
    content = np.ascontiguousarray(array).tobytes()
    words = np.frombuffer(content + b"\0" * (-len(content) % 4), "<u4")
    value = 0xcbf29ce484222325
    for word in words.tolist():
        value = ((value ^ (0 if word == 0x80000000 else word)) * 0x100000001b3) & (2**64 - 1)
    return f"{value:016x}"


def counted(array):
    return [len(array), hash_of(array)]


def flags_of(number):
    return {"constraints": bool(number & 1), "edges": bool(number & 2), "skip_bad_bodies": bool(number & 4)}


@unittest.skipUnless(os.path.exists(FOLDER), "the vectors are not beside the tests")
class Vectors(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        with open(os.path.join(FOLDER, "vectors.json"), encoding="utf-8") as file:
            cls.script = json.load(file)
        cls.bytes = np.fromfile(os.path.join(FOLDER, "vectors.bin"), np.uint8)

    def array(self, offset, dtype, count, width=1):
        found = np.frombuffer(self.bytes, dtype, count * width, offset)
        return found.reshape(count, width) if width > 1 else found

    def positions(self, call):
        return self.array(call["positions"], "<f8" if call["format"] else "<f4", call["vertices"], 3)

    def filter(self, call):
        numbers = {key: float(value) if key == "self_rest_distance" else int(value) for key, value in call["filter"].items()}
        flags = numbers.pop("flags")
        return voxtet.Filter(**numbers, self_collision=bool(flags & 1), sensor=bool(flags & 2))

    # ---- a method for each call; what it returns is compared ----

    def create(self, call):
        self.grid = voxtet.Grid(call["cell_size"], **flags_of(call["flags"]))

    def insert(self, call):
        tets = self.array(call["tets"], "<u4", call["tet_count"], 4)
        mesh = self.grid.add(self.positions(call), tets, copy=True, user_data=int(call["user_data"]),
                             filter=self.filter(call) if "filter" in call else None)
        return {"mesh": mesh.id}

    def move(self, call):
        self.grid[call["mesh"]].positions = self.positions(call)

    def step(self, call):
        self.grid.step()

    def results(self, call):
        grid = self.grid
        found = {"hash": f"{grid.hash:016x}", "epoch": grid.epoch, "contacts": counted(grid.contacts),
                 "interior": int(grid.interiors.sum()), "pairs": counted(grid.pairs), "pair_contacts": counted(grid.pair_contacts)}
        if grid.flags & voxtet.GridFlags.CONSTRAINTS:
            found.update(constraints=counted(grid.constraints), pair_offsets=counted(grid.pair_offsets))
        with grid.borrowed() as r:
            self.assertEqual((counted(r.contacts), counted(r.pair_contacts)), (found["contacts"], found["pair_contacts"]))
        return found

    def find_constraints(self, call):
        return {"constraints": counted(self.grid.find_constraints(voxtet.DepthMethod(call["method"]))),
                "pair_offsets": counted(self.grid.pair_offsets)}

    def update_locator(self, call):
        self.locator = self.grid.locator()

    def asked(self, call, *names):
        return [self.array(call[name], "<f8", call["count"], 3) for name in names]

    def find_point_hits(self, call):
        return {"hits": counted(self.locator.find_point_hits(*self.asked(call, "points")))}

    def find_closest(self, call):
        return {"hits": counted(self.locator.find_closest(*self.asked(call, "points")))}

    def find_box_hits(self, call):
        return {"hits": counted(self.locator.find_box_hits(*self.asked(call, "min", "max")))}

    def find_ray_hits(self, call):
        return {"hits": counted(self.locator.find_ray_hits(*self.asked(call, "from", "to"), first=bool(call["flags"])))}

    def rays(self, call):
        return {"blocked": int(self.locator.test_rays(*self.asked(call, "from", "to")).sum())}

    def meshes(self, call):
        found = []
        for mesh in self.grid:
            info = mesh.info
            flags = info.owns_positions | info.borrows_tets << 1
            found.append({"mesh": mesh.id, "user_data": str(mesh.user_data), "vertices": info.vertex_count,
                          "tet_count": info.tet_count, "enabled_tets": info.enabled_tet_count, "enabled": int(info.enabled),
                          "flags": flags, "format": int(mesh.positions.dtype == np.float64), "tets": hash_of(mesh.tets)})
        return {"meshes": found}

    def set_transform(self, call):
        self.grid[call["mesh"]].transform = self.array(call["matrix"], "<f8", 12).reshape(3, 4)

    def set_filter(self, call):
        self.grid[call["mesh"]].filter = self.filter(call)

    def set_enabled(self, call):
        self.grid[call["mesh"]].enabled = bool(call["enabled"]) if call["enabled"] < 2 else call["enabled"]

    def set_pair_enabled(self, call):
        self.grid.set_pair_enabled(call["body_a"], call["body_b"], bool(call["enabled"]))

    def set_flags(self, call):
        if call["flags"] > 7:
            raise TypeError("such flags have no name in Python")
        self.grid.set_flags(**flags_of(call["flags"]))

    def remove(self, call):
        self.grid.remove(call["mesh"])

    def clear(self, call):
        self.grid.clear()

    def append_copies(self, call):
        of = self.array(call["copies_of"], "<u4", call["count"])
        return {"first": self.grid[call["mesh"]].append_vertices(copies_of=of)}

    def replace_tets(self, call):
        self.grid[call["mesh"]].replace_tets(self.array(call["indices"], "<u4", call["count"]),
                                             self.array(call["corners"], "<u4", call["count"], 4))

    def append_tets(self, call):
        return {"first": self.grid[call["mesh"]].append_tets(self.array(call["corners"], "<u4", call["count"], 4))}

    def set_tets_enabled(self, call):
        self.grid[call["mesh"]].set_tets_enabled(self.array(call["indices"], "<u4", call["count"]), bool(call["enabled"]))

    def remove_tets(self, call):
        self.grid[call["mesh"]].remove_tets(self.array(call["indices"], "<u4", call["count"]))

    def save(self, call):
        snapshot = self.grid.snapshot()
        return {"size": len(snapshot), "hash": hash_of(np.frombuffer(snapshot, np.uint8))}

    def load(self, call):
        self.grid = voxtet.Grid.from_snapshot(self.array(call["bytes"], np.uint8, call["size"]))

    def suggest(self, call):
        meshes = [(self.positions({**m, "format": 0}), self.array(m["tets"], "<u4", m["tet_count"], 4)) for m in call["meshes"]]
        return self.result(voxtet.suggest_cell_size(meshes, model=voxtet.CostModel(call["model"])), call)

    def result(self, found, call):
        self.near({"cell_size": found.cell_size, "zone_min": found.zone[0], "zone_max": found.zone[1], "cost": found.cost,
                   "result_min_cell_size": found.min_cell_size, "rules": found.rules.cell_size, "runs": found.timings.cell_size}, call)
        return {"warnings": found.warnings, "note": found.note, "curve_count": len(found.curve), "term_count": len(found.terms)}

    def near(self, found, call):
        for name, value in found.items():
            np.testing.assert_allclose(value, call[name], rtol=1e-6, err_msg=name)

    # ---- grids of other programs ----

    def primitives(self, given):
        indices = self.array(given["indices"], "<u4", given["count"] // 4, 4) if "indices" in given else None
        radii = self.array(given["radii"], "<f8", given["vertices"]) if "radii" in given else None
        found = voxtet.Primitives(self.positions(given), indices, radii=radii, radius=given["radius"])
        self.assertEqual(found._struct.type, given["type"])
        return found

    def foreign_grid(self, call):
        return voxtet.ForeignGrid(
            self.primitives(call["stored"]), self.primitives(call["querying"]) if "querying" in call else None,
            known=voxtet.KnownGrid(call["known"]), cells_stored=voxtet.CellsStored(call["cells_stored"]),
            cells_queried=voxtet.CellsQueried(call["cells_queried"]), cells_kept=voxtet.CellsKept(call["cells_kept"]),
            weights=voxtet.ForeignWeights(*call["weights"]),
            **{name: call[name] for name in ("radius", "min_cell_size", "zone_loss")})

    def foreign_suggest(self, call):
        return self.result(self.foreign_grid(call).suggest(), call)

    def foreign_count(self, call):
        self.near({"counts": self.foreign_grid(call).count(call["at"])}, call)

    def foreign_fit(self, call):
        return self.result(self.foreign_grid(call).fit(call["timings"]), call)

    def foreign_tune(self, call):
        sizes = []

        def run(d):
            sizes.append(d)
            if call["stops_after"] and len(sizes) > call["stops_after"]:
                return -1
            fixed, falls, grows = call["run"]
            return math.inf if d < call["fails_below"] else fixed + falls / (d * d) + grows * (d * d)

        tune = self.foreign_grid(call).tune if "stored" in call else voxtet.tune
        return self.result(tune(run, first=call["first"], max_runs=call["max_runs"]), call)

    def replay(self, call):
        return getattr(self, call["call"].replace("test_rays", "rays"))(call)  # unittest takes test_... for tests

    def test_all(self):
        self.assertEqual(self.script["abi"], voxtet._c.VOX_ABI_VERSION)
        calls, refused = 0, 0
        for scene in self.script["scenes"]:
            for number, call in enumerate(scene["calls"]):
                with self.subTest(scene=scene["name"], number=number, call=call["call"]):
                    calls += 1
                    if "fails" not in call:
                        found = self.replay(call)
                        self.assertEqual(found or {}, {key: call[key] for key in found or {}})
                        continue
                    refused += 1
                    # What a bool or a name cannot say is refused before it reaches the library.
                    unsayable = call["call"] == "set_enabled" and call["enabled"] > 1 or call.get("flags", 0) > 7
                    with self.assertRaises(TypeError if unsayable else voxtet.VoxError) as caught:
                        self.replay(call)
                    if not unsayable:
                        self.assertEqual((caught.exception.code, str(caught.exception)), (call["fails"], call["text"]))
        self.assertGreater(calls, 200)
        self.assertGreater(refused, 5)


if __name__ == "__main__":
    unittest.main()
