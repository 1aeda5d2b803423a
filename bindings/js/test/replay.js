// Replays bindings/vectors, in Node and in a browser.
import { GridFlags, VoxError } from "../voxtet.js";

function hashWords(bytes) {
  const whole = new Uint8Array(Math.ceil(bytes.length / 4) * 4);
  whole.set(bytes);
  const words = new Uint32Array(whole.buffer);
  let hash = 0xcbf29ce484222325n;
  for (const word of words) hash = BigInt.asUintN(64, (hash ^ BigInt(word === 0x80000000 ? 0 : word)) * 0x100000001b3n);
  return hash.toString(16).padStart(16, "0");
}

function summary(records) {
  return [records.length, hashWords(records.bytes)];
}

function filterOf(filter) {
  const big = Object.fromEntries(["category", "mask"].map((key) => [key, BigInt(filter[key])]));
  return {
    ...big,
    group: filter.group,
    flags: filter.flags,
    world: filter.world,
    selfRings: filter.self_rings,
    selfRestDistance: filter.self_rest_distance,
  };
}

/** Replays all calls and compares what they give; returns their number. `script` is vectors.json, `arrays` the bytes of
 * vectors.bin, `assert` as of node:assert. */
export function replay(vox, script, arrays, assert) {
  const array = (Type, offset, length) => new Type(arrays.slice(offset, offset + length * Type.BYTES_PER_ELEMENT).buffer);
  const positionsOf = (call) => array(call.format === 1 ? Float64Array : Float32Array, call.positions, 3 * call.vertices);
  let grid;
  let locator;
  const indices = (call, name) => array(Uint32Array, call[name], call.count);
  const points = (call, name) => array(Float64Array, call[name], 3 * call.count);
  const corners = (call) => array(Uint32Array, call.corners, 4 * call.count);
  /** Within one part in a million. */
  const near = (found, call) => {
    for (const [name, value] of Object.entries(found))
      assert.ok(Math.abs(value - call[name]) <= 1e-6 * Math.abs(call[name]), `${name}: ${value}, expected ${call[name]}`);
  };
  const primitivesOf = (given) => ({
    type: given.type,
    positions: positionsOf(given),
    indices: given.indices === undefined ? undefined : array(Uint32Array, given.indices, given.count),
    radii: given.radii === undefined ? undefined : array(Float64Array, given.radii, given.vertices),
    radius: given.radius,
  });
  const foreignGridOf = (call) => {
    const [run, store, visit, found, read, occupied, cell] = call.weights;
    return {
      stored: primitivesOf(call.stored),
      querying: call.querying && primitivesOf(call.querying),
      known: call.known,
      cellsStored: call.cells_stored,
      cellsQueried: call.cells_queried,
      cellsKept: call.cells_kept,
      weights: { run, store, visit, found, read, occupied, cell },
      radius: call.radius,
      minCellSize: call.min_cell_size,
      zoneLoss: call.zone_loss,
    };
  };
  const sizes = (items) => items.map((item) => item.cellSize);
  /** A CellSizeResult. */
  const result = (found, call) => {
    const { cellSize, zoneMin, zoneMax, cost, minCellSize } = found;
    near({ cell_size: cellSize, zone_min: zoneMin, zone_max: zoneMax, cost, result_min_cell_size: minCellSize }, call);
    near(sizes(found.rules), call.rules);
    near(sizes(found.timings), call.runs);
    assert.deepEqual([found.rules.length, found.timings.length], [call.rules.length, call.runs.length]);
    return { warnings: found.warnings, note: found.note, curve_count: found.curve.length, term_count: found.terms.length };
  };
  const constraints = () => {
    const found = grid.constraints;
    const offsets = BigUint64Array.from(found.pairOffsets, BigInt);
    return { constraints: summary(found), pair_offsets: [offsets.length, hashWords(new Uint8Array(offsets.buffer))] };
  };
  const calls = {
    create(call) {
      grid?.dispose();
      grid = new vox.Grid({ flags: call.flags, cellSize: call.cell_size });
    },
    insert(call) {
      const mesh = grid.add({
        positions: positionsOf(call),
        tets: array(Uint32Array, call.tets, 4 * call.tet_count),
        userData: BigInt(call.user_data),
        filter: call.filter && filterOf(call.filter),
      });
      return { mesh: mesh.id };
    },
    move(call) {
      grid.body(call.mesh).positions = positionsOf(call);
    },
    step: () => grid.step(),
    results(call) {
      const pairs = grid.pairs;
      const found = {
        hash: grid.hash.toString(16).padStart(16, "0"),
        epoch: grid.epoch,
        contacts: summary(grid.contacts),
        interior: grid.contactInteriors.reduce((sum, one) => sum + one, 0),
        pairs: summary(pairs),
        pair_contacts: [pairs.contacts.length, hashWords(new Uint8Array(pairs.contacts.buffer))],
      };
      assert.equal("constraints" in call, (grid.flags & GridFlags.CONSTRAINTS) !== 0);
      if ("constraints" in call) Object.assign(found, constraints());
      else assert.throws(() => grid.constraints, VoxError);
      return found;
    },
    find_constraints({ method }) {
      grid.findConstraints({ method });
      return constraints();
    },
    update_locator() {
      if (locator) locator.update(grid);
      else locator = grid.locator();
    },
    find_point_hits: (call) => ({ hits: summary(locator.findPointHits(points(call, "points"))) }),
    find_closest: (call) => ({ hits: summary(locator.findClosest(points(call, "points"))) }),
    find_box_hits: (call) => ({ hits: summary(locator.findBoxHits(points(call, "min"), points(call, "max"))) }),
    find_ray_hits: (call) => ({
      hits: summary(locator.findRayHits(points(call, "from"), points(call, "to"), { flags: call.flags })),
    }),
    test_rays(call) {
      const blocked = locator.testRays(points(call, "from"), points(call, "to"));
      return { blocked: blocked.reduce((sum, one) => sum + one, 0) };
    },
    meshes: () => ({
      meshes: grid.bodies.map((mesh) => {
        const info = mesh.info;
        return {
          mesh: mesh.id,
          user_data: String(info.userData),
          vertices: info.vertexCount,
          tet_count: info.tetCount,
          enabled_tets: info.enabledTetCount,
          enabled: info.enabled,
          flags: info.flags,
          format: info.positionFormat,
          tets: hashWords(new Uint8Array(mesh.tets.buffer)),
        };
      }),
    }),
    set_transform: (call) => grid.body(call.mesh).setTransform(array(Float64Array, call.matrix, 12)),
    set_filter(call) {
      grid.body(call.mesh).filter = filterOf(call.filter);
    },
    set_enabled(call) {
      grid.body(call.mesh).enabled = call.enabled;
    },
    set_pair_enabled: (call) => grid.setPairEnabled(call.body_a, call.body_b, call.enabled),
    set_flags(call) {
      grid.flags = call.flags;
    },
    remove: (call) => grid.body(call.mesh).remove(),
    clear: () => grid.clear(),
    set_tets_enabled: (call) => grid.body(call.mesh).setTetsEnabled(indices(call, "indices"), call.enabled),
    remove_tets: (call) => grid.body(call.mesh).removeTets(indices(call, "indices")),
    append_copies: (call) => ({ first: grid.body(call.mesh).appendVertices({ copiesOf: indices(call, "copies_of") }) }),
    replace_tets: (call) => grid.body(call.mesh).replaceTets(indices(call, "indices"), corners(call)),
    append_tets: (call) => ({ first: grid.body(call.mesh).appendTets(corners(call)) }),
    save() {
      const bytes = grid.save();
      return { size: bytes.length, hash: hashWords(bytes) };
    },
    load(call) {
      const loaded = vox.Grid.load(arrays.subarray(call.bytes, call.bytes + call.size));
      grid?.dispose();
      grid = loaded;
    },
    suggest(call) {
      const meshes = call.meshes.map((mesh) => ({
        positions: array(Float32Array, mesh.positions, 3 * mesh.vertices),
        tets: array(Uint32Array, mesh.tets, 4 * mesh.tet_count),
      }));
      return result(vox.suggestCellSize(meshes, { model: call.model }), call);
    },
    foreign_suggest: (call) => result(vox.foreignGridSuggest(foreignGridOf(call)), call),
    foreign_count(call) {
      const { stored, visits, empty, reads, occupied, cells } = vox.foreignGridCount(foreignGridOf(call), call.at);
      near([stored, visits, empty, reads, occupied, cells], call.counts);
    },
    foreign_fit(call) {
      const timings = call.timings.map(([cellSize, seconds]) => ({ cellSize, seconds }));
      return result(vox.foreignGridFit(foreignGridOf(call), timings), call);
    },
    foreign_tune(call) {
      let count = 0;
      const run = (d) => {
        if (call.stops_after && ++count > call.stops_after) return -1;
        return d < call.fails_below ? Infinity : call.run[0] + call.run[1] / (d * d) + call.run[2] * (d * d);
      };
      const grid = call.stored && foreignGridOf(call);
      return result(vox.foreignGridTune(run, { grid, first: call.first, maxRuns: call.max_runs }), call);
    },
  };
  let count = 0;
  for (const scene of script.scenes)
    for (const call of scene.calls) {
      const place = `${scene.name}: ${JSON.stringify(call)}`;
      assert.ok(call.call in calls, `a call that is not known: ${place}`);
      ++count;
      if ("fails" in call) {
        assert.throws(() => calls[call.call](call), (error) => {
          assert.ok(error instanceof VoxError, `${place}: ${error.stack}`);
          assert.deepEqual({ fails: error.code, text: error.message }, { fails: call.fails, text: call.text }, place);
          return true;
        });
        continue;
      }
      const found = calls[call.call](call) ?? {};
      for (const [name, value] of Object.entries(found)) assert.deepEqual(value, call[name], `${name} of ${place}`);
    }
  locator.dispose();
  grid.dispose();
  return count;
}
