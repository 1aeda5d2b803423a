//! Replays bindings/vectors: the same results as in every other language.

use serde_json::Value;
use std::path::PathBuf;
use voxtet::{
    suggest_cell_size, Body, CellSizeOptions, CellSizeResult, CellsKept, CellsQueried, CellsStored, ConstraintOptions,
    CostModel, DepthMethod, Filter, ForeignGrid, ForeignWeights, Grid, GridOptions, KnownGrid, Locator, MeshArrays,
    MeshOptions, Primitives, QueryOptions, Timing, TuneOptions,
};

fn bytes_of<T: Copy>(items: &[T]) -> &[u8] {
    // Plain C structs without gaps: all of their bytes are set.
    unsafe { std::slice::from_raw_parts(items.as_ptr().cast(), std::mem::size_of_val(items)) }
}

fn hash_words(bytes: &[u8]) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    for chunk in bytes.chunks(4) {
        let mut word = [0; 4];
        word[..chunk.len()].copy_from_slice(chunk);
        let word = match u32::from_le_bytes(word) {
            0x8000_0000 => 0,
            word => word,
        };
        hash = (hash ^ u64::from(word)).wrapping_mul(0x100_0000_01b3);
    }
    format!("{hash:016x}")
}

fn summary<T: Copy>(items: &[T]) -> Value {
    serde_json::json!([items.len(), hash_words(bytes_of(items))])
}

struct Replay {
    arrays: Vec<u8>,
    grid: Grid,
    locator: Locator,
    scene: String,
}

impl Replay {
    fn array<const N: usize, T: Copy>(
        &self,
        call: &Value,
        name: &str,
        count: &str,
        read: fn(&[u8]) -> T,
    ) -> Vec<[T; N]> {
        let count = call[count].as_u64().unwrap() as usize;
        self.array_at(call[name].as_u64().unwrap() as usize, count, read)
    }

    fn array_at<const N: usize, T: Copy>(&self, offset: usize, count: usize, read: fn(&[u8]) -> T) -> Vec<[T; N]> {
        let size = std::mem::size_of::<T>();
        self.arrays[offset..offset + N * size * count]
            .chunks(N * size)
            .map(|record| std::array::from_fn(|i| read(&record[i * size..(i + 1) * size])))
            .collect()
    }

    fn indices(&self, call: &Value, name: &str) -> Vec<u32> {
        self.array::<1, u32>(call, name, "count", u32_of).into_iter().flatten().collect()
    }

    fn run(&mut self, call: &Value) {
        let name = call["call"].as_str().unwrap();
        let result = self.make(name, call);
        let place = format!("{}: {call}", self.scene);
        match call.get("fails") {
            Some(code) => {
                let error = result.expect_err(&place);
                assert_eq!(i64::from(error.code().number()), code.as_i64().unwrap(), "{place}");
                assert_eq!(error.to_string(), call["text"], "{place}");
            }
            None => result.unwrap_or_else(|error| panic!("{place}: {error}")),
        }
    }

    fn check(&self, call: &Value, name: &str, found: Value) {
        assert_eq!(found, call[name], "{}: {name} of {call}", self.scene);
    }

    fn make(&mut self, name: &str, call: &Value) -> voxtet::Result<()> {
        let mesh = Body::from_id(call["mesh"].as_u64().unwrap_or(0) as u32);
        let positions = |name: &str| self.array::<3, f64>(call, name, "count", f64_of);
        let all = QueryOptions::default();
        match name {
            "create" => {
                let flags = call["flags"].as_u64().unwrap();
                self.grid = Grid::with_options(GridOptions {
                    cell_size: call["cell_size"].as_f64().unwrap(),
                    constraints: flags & 1 != 0,
                    edges: flags & 2 != 0,
                    ..GridOptions::default()
                })?;
            }
            "insert" => {
                let tets = self.array(call, "tets", "tet_count", u32_of);
                let user_data = number(&call["user_data"]);
                let filter = call.get("filter").map_or(Filter::default(), filter_of);
                let found = if call["format"] == 1 {
                    let positions = self.array(call, "positions", "vertices", f64_of);
                    self.grid.add_with(&positions, &tets, MeshOptions { user_data, filter, rest_positions: None })?
                } else {
                    let positions = self.array(call, "positions", "vertices", f32_of);
                    self.grid.add_with(&positions, &tets, MeshOptions { user_data, filter, rest_positions: None })?
                };
                assert_eq!(found, mesh, "{call}");
            }
            "move" => {
                if call["format"] == 1 {
                    let positions = self.array(call, "positions", "vertices", f64_of);
                    self.grid.positions_mut(mesh)?.copy_from_slice(&positions);
                } else {
                    let positions = self.array(call, "positions", "vertices", f32_of);
                    self.grid.positions_mut(mesh)?.copy_from_slice(&positions);
                }
            }
            "step" => self.grid.step()?,
            "results" => self.results(call),
            "find_constraints" => {
                let methods = [DepthMethod::Consistent, DepthMethod::Closest, DepthMethod::None];
                let method = methods[call["method"].as_u64().unwrap() as usize];
                self.grid.find_constraints(ConstraintOptions { method, ..ConstraintOptions::default() })?;
                self.constraints(call);
            }
            "update_locator" => self.locator.update(&mut self.grid)?,
            "find_point_hits" => {
                self.check(call, "hits", summary(&self.locator.find_point_hits(&positions("points"), all)?));
            }
            "find_closest" => {
                self.check(call, "hits", summary(&self.locator.find_closest(&positions("points"), all)?));
            }
            "find_box_hits" => {
                let hits = self.locator.find_box_hits(&positions("min"), &positions("max"), all)?;
                self.check(call, "hits", summary(&hits));
            }
            "find_ray_hits" => {
                let options = QueryOptions { first_hit: call["flags"] == 1, ..all };
                let hits = self.locator.find_ray_hits(&positions("from"), &positions("to"), options)?;
                self.check(call, "hits", summary(&hits));
            }
            "test_rays" => {
                let blocked = self.locator.test_rays(&positions("from"), &positions("to"), all)?;
                self.check(call, "blocked", blocked.iter().filter(|&&is| is).count().into());
            }
            "meshes" => self.meshes(call),
            "set_transform" => {
                let offset = call["matrix"].as_u64().unwrap() as usize;
                let matrix: [f64; 12] = self.array_at(offset, 1, f64_of)[0];
                self.grid.set_transform(mesh, Some(&matrix))?;
            }
            "set_filter" => self.grid.set_filter(mesh, filter_of(&call["filter"]))?,
            "set_enabled" => self.grid.set_enabled(mesh, call["enabled"] == 1)?,
            "set_pair_enabled" => {
                let pair = ["body_a", "body_b"].map(|name| Body::from_id(call[name].as_u64().unwrap() as u32));
                self.grid.set_pair_enabled(pair[0], pair[1], call["enabled"] == 1)?;
            }
            "set_flags" => {
                let flags = call["flags"].as_u64().unwrap();
                self.grid.set_flags(flags & 1 != 0, flags & 2 != 0, flags & 4 != 0)?;
            }
            "remove" => self.grid.remove(mesh)?,
            "clear" => self.grid.clear()?,
            "set_tets_enabled" => {
                self.grid.set_tets_enabled(mesh, &self.indices(call, "indices"), call["enabled"] == 1)?;
            }
            "remove_tets" => self.grid.remove_tets(mesh, &self.indices(call, "indices"))?,
            "append_copies" => {
                let first = self.grid.append_copies(mesh, &self.indices(call, "copies_of"))?;
                self.check(call, "first", first.into());
            }
            "replace_tets" => {
                let corners: Vec<[u32; 4]> = self.array(call, "corners", "count", u32_of);
                self.grid.replace_tets(mesh, &self.indices(call, "indices"), &corners)?;
            }
            "append_tets" => {
                let corners: Vec<[u32; 4]> = self.array(call, "corners", "count", u32_of);
                let first = self.grid.append_tets(mesh, &corners)?;
                self.check(call, "first", first.into());
            }
            "save" => {
                let bytes = self.grid.save()?;
                self.check(call, "size", bytes.len().into());
                self.check(call, "hash", hash_words(&bytes).into());
            }
            "load" => {
                let offset = call["bytes"].as_u64().unwrap() as usize;
                let bytes = &self.arrays[offset..offset + call["size"].as_u64().unwrap() as usize];
                self.grid = Grid::load(bytes, GridOptions::default())?;
            }
            "suggest" => self.suggest(call)?,
            "foreign_suggest" | "foreign_count" | "foreign_fit" | "foreign_tune" => self.foreign(name, call)?,
            other => panic!("a call that is not known: {other}"),
        }
        Ok(())
    }

    fn results(&self, call: &Value) {
        let grid = &self.grid;
        self.check(call, "hash", format!("{:016x}", grid.hash()).into());
        self.check(call, "epoch", grid.epoch().into());
        self.check(call, "contacts", summary(grid.contacts()));
        self.check(call, "interior", grid.interiors().iter().map(|&i| u64::from(i)).sum::<u64>().into());
        self.check(call, "pairs", summary(grid.pairs()));
        self.check(call, "pair_contacts", summary(grid.pair_contacts()));
        if call.get("constraints").is_some() {
            self.constraints(call);
        } else {
            assert!(grid.constraints().is_err());
        }
    }

    fn constraints(&self, call: &Value) {
        self.check(call, "constraints", summary(self.grid.constraints().unwrap()));
        self.check(call, "pair_offsets", summary(self.grid.pair_offsets().unwrap()));
    }

    fn meshes(&self, call: &Value) {
        let found: Vec<Value> = self
            .grid
            .bodies()
            .into_iter()
            .map(|mesh| {
                let info = self.grid.info(mesh).unwrap();
                serde_json::json!({
                    "mesh": mesh.id(), "user_data": info.user_data.to_string(), "vertices": info.vertex_count,
                    "tet_count": info.tet_count, "enabled_tets": info.enabled_tet_count,
                    "enabled": u32::from(info.enabled), "flags": 1, // COPY_POSITIONS
                    "format": u32::from(info.doubles), "tets": hash_words(bytes_of(&self.grid.tets(mesh).unwrap())),
                })
            })
            .collect();
        self.check(call, "meshes", found.into());
    }

    fn suggest(&self, call: &Value) -> voxtet::Result<()> {
        let model = [CostModel::Paper, CostModel::Reference, CostModel::Fast][call["model"].as_u64().unwrap() as usize];
        type Arrays = (Vec<[f32; 3]>, Vec<[u32; 4]>);
        let arrays: Vec<Arrays> = call["meshes"]
            .as_array()
            .unwrap()
            .iter()
            .map(|mesh| {
                (self.array(mesh, "positions", "vertices", f32_of), self.array(mesh, "tets", "tet_count", u32_of))
            })
            .collect();
        let meshes: Vec<MeshArrays> = arrays.iter().map(|(p, t)| MeshArrays::new(p, t)).collect();
        self.check_result(call, &suggest_cell_size(&meshes, CellSizeOptions { model, ..CellSizeOptions::default() })?);
        Ok(())
    }

    /// The arrays of primitives: positions as singles and doubles, of which one is empty, indices, radii.
    fn primitive_arrays(&self, value: &Value) -> PrimitiveArrays {
        let mut arrays = PrimitiveArrays::default();
        if value.is_null() {
            return arrays;
        }
        if value["format"] == 1 {
            arrays.doubles = self.array(value, "positions", "vertices", f64_of);
        } else {
            arrays.singles = self.array(value, "positions", "vertices", f32_of);
        }
        if let Some(offset) = value["indices"].as_u64() {
            assert_eq!(value["type"], 3, "only tetrahedra have indices");
            arrays.tets = self.array_at(offset as usize, value["count"].as_u64().unwrap() as usize / 4, u32_of);
        }
        if let Some(offset) = value["radii"].as_u64() {
            let radii: Vec<[f64; 1]> = self.array_at(offset as usize, arrays.doubles.len(), f64_of);
            arrays.radii = radii.into_iter().flatten().collect();
        }
        arrays
    }

    fn foreign(&self, name: &str, call: &Value) -> voxtet::Result<()> {
        let [stored, querying] = ["stored", "querying"].map(|name| self.primitive_arrays(&call[name]));
        let known = [
            KnownGrid::None,
            KnownGrid::Sorted,
            KnownGrid::Hashed,
            KnownGrid::Warp,
            KnownGrid::Ipc,
            KnownGrid::IpcPairs,
            KnownGrid::Vtk,
            KnownGrid::Pbat,
        ];
        let (cells_stored, cells_kept) = (
            [CellsStored::Default, CellsStored::Box, CellsStored::Centre],
            [CellsKept::Default, CellsKept::Occupied, CellsKept::Dense],
        );
        let cells_queried = [CellsQueried::Default, CellsQueried::Box, CellsQueried::Queried27, CellsQueried::Pairs];
        let number = |name: &str| call[name].as_f64().unwrap();
        let index = |name: &str| call[name].as_u64().unwrap() as usize;
        let grid = call.get("stored").map(|value| {
            let [run, store, visit, found, read, occupied, cell] =
                std::array::from_fn(|i| call["weights"][i].as_f64().unwrap());
            ForeignGrid {
                cells_stored: cells_stored[index("cells_stored")],
                cells_queried: cells_queried[index("cells_queried")],
                cells_kept: cells_kept[index("cells_kept")],
                querying: call.get("querying").map(|value| querying.primitives(value)),
                radius: number("radius"),
                min_cell_size: number("min_cell_size"),
                zone_loss: number("zone_loss"),
                weights: ForeignWeights { run, store, visit, found, read, occupied, cell },
                ..ForeignGrid::new(known[index("known")], stored.primitives(value))
            }
        });
        match name {
            "foreign_suggest" => self.check_result(call, &grid.unwrap().suggest()?),
            "foreign_count" => {
                let counts = grid.unwrap().count(number("at"))?;
                let found = [counts.stored, counts.visits, counts.empty, counts.reads, counts.occupied, counts.cells];
                check_numbers(call, "counts", &found);
            }
            "foreign_fit" => {
                let timings: Vec<_> = call["timings"].as_array().unwrap().iter().map(timing_of).collect();
                self.check_result(call, &grid.unwrap().fit(&timings)?);
            }
            _ => {
                let [first, below] = ["first", "fails_below"].map(number);
                let [fixed, falls, grows]: [f64; 3] = std::array::from_fn(|i| call["run"][i].as_f64().unwrap());
                let [max_runs, most] = ["max_runs", "stops_after"].map(index);
                let options = TuneOptions { first, max_runs: max_runs as u32, ..TuneOptions::default() };
                let mut runs = 0;
                let run = |d: f64| {
                    runs += 1;
                    if most != 0 && runs > most {
                        -1.0
                    } else if d < below {
                        f64::INFINITY
                    } else {
                        fixed + falls / (d * d) + grows * (d * d)
                    }
                };
                self.check_result(call, &voxtet::tune(grid.as_ref(), run, options)?);
            }
        }
        Ok(())
    }

    fn check_result(&self, call: &Value, found: &CellSizeResult) {
        self.check(call, "curve_count", found.curve.len().into());
        self.check(call, "term_count", found.terms.len().into());
        self.check(call, "warnings", found.warnings.into());
        self.check(call, "note", found.note.as_str().into());
        for (name, value) in [
            ("cell_size", found.cell_size),
            ("zone_min", found.zone_min),
            ("zone_max", found.zone_max),
            ("cost", found.cost),
            ("result_min_cell_size", found.min_cell_size),
        ] {
            check_number(&call[name], value, call);
        }
        check_numbers(call, "rules", &found.rules.iter().map(|rule| rule.cell_size).collect::<Vec<_>>());
        check_numbers(call, "runs", &found.timings.iter().map(|timing| timing.cell_size).collect::<Vec<_>>());
    }
}

#[derive(Default)]
struct PrimitiveArrays {
    singles: Vec<[f32; 3]>,
    doubles: Vec<[f64; 3]>,
    tets: Vec<[u32; 4]>,
    radii: Vec<f64>,
}

impl PrimitiveArrays {
    fn primitives(&self, value: &Value) -> Primitives<'_> {
        let primitives = match (value["type"].as_u64().unwrap(), self.doubles.is_empty()) {
            (0, true) => Primitives::points(&self.singles),
            (0, false) => Primitives::points(&self.doubles),
            (3, true) => Primitives::tets(&self.singles, &self.tets),
            (type_of, _) => panic!("primitives of type {type_of}"),
        };
        let primitives = primitives.with_radius(value["radius"].as_f64().unwrap());
        if self.radii.is_empty() {
            primitives
        } else {
            primitives.with_radii(&self.radii).unwrap()
        }
    }
}

fn check_number(expected: &Value, found: f64, call: &Value) {
    let expected = expected.as_f64().unwrap();
    assert!((found - expected).abs() <= 1e-6 * expected.abs(), "{found}, expected {expected}: {call}");
}

fn check_numbers(call: &Value, name: &str, found: &[f64]) {
    assert_eq!(found.len(), call[name].as_array().unwrap().len(), "{name} of {call}");
    found.iter().enumerate().for_each(|(i, &value)| check_number(&call[name][i], value, call));
}

fn timing_of(value: &Value) -> Timing {
    Timing { cell_size: value[0].as_f64().unwrap(), seconds: value[1].as_f64().unwrap() }
}

fn u32_of(bytes: &[u8]) -> u32 {
    u32::from_le_bytes(bytes.try_into().unwrap())
}

fn f32_of(bytes: &[u8]) -> f32 {
    f32::from_le_bytes(bytes.try_into().unwrap())
}

fn f64_of(bytes: &[u8]) -> f64 {
    f64::from_le_bytes(bytes.try_into().unwrap())
}

fn number(value: &Value) -> u64 {
    value.as_str().unwrap().parse().unwrap()
}

fn filter_of(value: &Value) -> Filter {
    let flags = value["flags"].as_u64().unwrap();
    Filter {
        self_collision: flags & 1 != 0,
        sensor: flags & 2 != 0,
        group: value["group"].as_i64().unwrap() as i32,
        category: number(&value["category"]),
        mask: number(&value["mask"]),
        world: value["world"].as_u64().unwrap() as u32,
        self_rings: value["self_rings"].as_u64().unwrap() as u32,
        self_rest_distance: value["self_rest_distance"].as_f64().unwrap(),
    }
}

/// Arguments that Rust's types rule out.
fn cannot_be_written(call: &Value) -> bool {
    let number = |name: &str| call[name].as_u64().unwrap_or(0);
    number("enabled") > 1 || (call["call"] == "set_flags" && number("flags") > 7)
}

#[test]
fn vectors() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../vectors");
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let script: Value = serde_json::from_slice(&read("vectors.json")).unwrap();
    let mut grid = Grid::new().unwrap();
    let locator = grid.locator().unwrap();
    let mut replay = Replay { arrays: read("vectors.bin"), grid, locator, scene: String::new() };
    let mut calls = 0;
    for scene in script["scenes"].as_array().unwrap() {
        replay.scene = scene["name"].as_str().unwrap().to_owned();
        for call in scene["calls"].as_array().unwrap().iter().filter(|call| !cannot_be_written(call)) {
            replay.run(call);
            calls += 1;
        }
    }
    assert!(calls > 250, "{calls} calls");
}
