import { fields, bodyId, positions } from "./check.js";
import { structs } from "../layout.js";
import { guarded, memoryOf, Owned, pointerOf, pointerOfKind, setPointer } from "./owned.js";
import { records } from "./records.js";

const DESC = ["flags", "mask", "excluded", "maxDistance"];

/** The meshes of a grid at one moment, to be asked at any later time. */
export class Locator extends Owned {
  constructor(grid) {
    const memory = memoryOf(grid);
    super(memory, "locator", 0, memory.call.vox_locator_release);
    this.#take(grid, 0);
  }

  #take(grid, before) {
    const memory = memoryOf(this);
    const from = pointerOfKind(grid, "grid", memory, "grid");
    memory.frame((frame) => {
      const at = frame.take(4);
      memory.data.setUint32(at, before, true);
      try {
        guarded([this], () => memory.call.vox_grid_update_locator(from, at));
      } finally {
        if (!memory.stopped) setPointer(this, memory.data.getUint32(at, true)); // also if a log has thrown
      }
    });
  }

  update(grid) {
    this.#take(grid, pointerOf(this));
  }

  get epoch() {
    return memoryOf(this).number("count", (out) => memoryOf(this).call.vox_locator_get_epoch(pointerOf(this), out));
  }

  userData(mesh) {
    const id = bodyId(mesh, "mesh");
    return memoryOf(this).number("u64", (out) => memoryOf(this).call.vox_locator_get_user_data(pointerOf(this), id, out));
  }

  /** `answer` gets a frame, how many questions there are, and what calls the function `name` about these arrays. */
  #ask(name, arrays, settings, answer) {
    const memory = memoryOf(this);
    const given = fields(settings, "options", "vox_query_desc", DESC);
    const checked = Object.entries(arrays).map(([what, array]) => array && positions(array, what, memory));
    return memory.frame((frame) => {
      const asked = checked.map((array) => array && frame.struct("vox_positions", frame.positions(array)));
      const desc = frame.struct("vox_query_desc", given);
      return answer(frame, checked[0].length / 3, (...out) => memory.call[name](pointerOf(this), ...asked, desc, ...out));
    });
  }

  /** All hits: asked again where there was no room for them. */
  #find(name, struct, arrays, settings) {
    const memory = memoryOf(this);
    const { size } = structs[struct];
    return this.#ask(name, arrays, settings, (frame, questions, ask) => {
      const count = frame.take(8);
      for (let capacity = questions + 64; ; ) {
        const hits = frame.take(capacity * size);
        ask(hits, capacity, count);
        const found = Number(memory.data.getBigUint64(count, true));
        if (found <= capacity) return records(memory, struct, hits, found);
        capacity = found;
      }
    });
  }

  findPointHits(points, settings) {
    return this.#find("vox_locator_find_point_hits", "vox_point_hit", { points }, settings);
  }

  /** One record for each question. */
  #each(name, struct, arrays, settings) {
    return this.#ask(name, arrays, settings, (frame, questions, ask) => {
      const out = frame.take(questions * structs[struct].size);
      ask(out);
      return records(memoryOf(this), struct, out, questions);
    });
  }

  locate(points, settings) {
    return this.#each("vox_locator_locate", "vox_location", { points }, settings);
  }

  findClosest(points, settings) {
    return this.#each("vox_locator_find_closest", "vox_closest_hit", { points }, settings);
  }

  findBoxHits(min, max, settings) {
    return this.#find("vox_locator_find_box_hits", "vox_box_hit", { min, max }, settings);
  }

  findRayHits(from, to, settings) {
    return this.#find("vox_locator_find_ray_hits", "vox_ray_hit", { from, to }, settings);
  }

  findTracks(from, to, settings) {
    return this.#find("vox_locator_find_tracks", "vox_track_piece", { from, to }, settings);
  }

  findClosestToSegments(from, to, settings) {
    return this.#each("vox_locator_find_closest_to_segments", "vox_closest_hit", { from, to }, settings);
  }

  findTriangleHits(from, to, settings) {
    return this.#find("vox_locator_find_triangle_hits", "vox_triangle_hit", { from, to: to ?? 0 }, settings);
  }

  testRays(from, to, settings) {
    return this.#ask("vox_locator_test_rays", { from, to }, settings, (frame, questions, ask) => {
      const blocked = frame.take(questions);
      ask(blocked);
      return memoryOf(this).copy("u8", blocked, questions);
    });
  }
}
