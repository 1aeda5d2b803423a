import { bits, float, floats, meshId, options, positions } from "./check.js";
import { structs } from "../layout.js";
import { memoryOf, Owned, pointerOf } from "./owned.js";
import { records } from "./records.js";

const ALL = (1n << 64n) - 1n;

/** The functions of a grid, and of a view. */
export const GRID_QUERIES = {
  point: "vox_grid_query_point",
  points: "vox_grid_query_points",
  box: "vox_grid_query_box",
  closest: "vox_grid_query_closest",
  closestPoints: "vox_grid_query_closest_points",
  ray: "vox_grid_query_ray",
  rayHits: "vox_grid_query_ray_hits",
  rayAny: "vox_grid_query_ray_any",
};
const VIEW_QUERIES = {
  point: "vox_query_view_point",
  points: "vox_query_view_points",
  box: "vox_query_view_box",
  closest: "vox_query_view_closest",
  closestPoints: "vox_query_view_closest_points",
  ray: "vox_query_view_ray",
  rayHits: "vox_query_view_ray_hits",
  rayAny: "vox_query_view_ray_any",
};

/** What can be asked of a grid (as it was at prepareQueries) and of a query view. */
export class Queries extends Owned {
  #names;

  constructor(memory, kind, pointer, release, names) {
    super(memory, kind, pointer, release);
    this.#names = names;
  }

  #ask(name, ...given) {
    return memoryOf(this).call[this.#names[name]](pointerOf(this), ...given);
  }

  /** `ask(hits, capacity, count)` until there was room for all. */
  #hits(struct, frame, guess, ask) {
    const memory = memoryOf(this);
    const { size } = structs[struct];
    const count = frame.take(8);
    for (let capacity = guess; ; ) {
      const hits = frame.take(capacity * size);
      ask(hits, capacity, count);
      const found = Number(memory.data.getBigUint64(count, true));
      if (found <= capacity) return records(struct, memory.items(hits, found, size), found);
      capacity = found;
    }
  }

  queryPoint(point, settings) {
    const at = floats(point, "point", 3);
    const { mask = ALL } = checked(settings, ["mask"]);
    return memoryOf(this).frame((frame) => {
      const where = frame.numbers(at);
      return this.#hits("vox_point_hit", frame, 16, (...room) => this.#ask("point", where, mask, ...room));
    });
  }

  queryPoints(points, settings) {
    const memory = memoryOf(this);
    const array = positions(points, "points", memory);
    const { mask = ALL } = checked(settings, ["mask"]);
    const count = array.length / 3;
    const format = Number(array.BYTES_PER_ELEMENT === 8);
    return memory.frame((frame) => {
      const where = frame.array(array);
      return this.#hits("vox_point_hit", frame, count + 16, (...room) =>
        this.#ask("points", where, format, 0, count, mask, ...room),
      );
    });
  }

  queryBox(min, max, settings) {
    const corners = [floats(min, "min", 3), floats(max, "max", 3)];
    const { mask = ALL } = checked(settings, ["mask"]);
    return memoryOf(this).frame((frame) => {
      const [from, to] = corners.map((corner) => frame.numbers(corner));
      return this.#hits("vox_tet_hit", frame, 256, (...room) => this.#ask("box", from, to, mask, ...room));
    });
  }

  queryClosest(point, settings) {
    const at = floats(point, "point", 3);
    const { mask = ALL, radius = Infinity } = checked(settings, ["mask", "radius"]);
    const memory = memoryOf(this);
    return memory.frame((frame) => {
      const where = frame.numbers(at);
      const hit = memory.get("vox_surface_hit", (out) => this.#ask("closest", where, radius, mask, out));
      return hit.mesh === 0 ? null : hit;
    });
  }

  queryClosestPoints(points, settings) {
    const memory = memoryOf(this);
    const array = positions(points, "points", memory);
    const given = checked(settings, ["mask", "maxDistance", "excluded"]);
    const count = array.length / 3;
    return memory.frame((frame) => {
      const desc = frame.struct("vox_closest_desc", {
        ...given,
        points: frame.array(array),
        format: Number(array.BYTES_PER_ELEMENT === 8),
        pointCount: count,
      });
      const { size } = structs.vox_closest_hit;
      const hits = frame.take(count * size);
      this.#ask("closestPoints", desc, hits);
      return records("vox_closest_hit", memory.items(hits, count, size), count);
    });
  }

  queryRay(from, to, settings) {
    const ends = [floats(from, "from", 3), floats(to, "to", 3)];
    const { mask = ALL } = checked(settings, ["mask"]);
    const memory = memoryOf(this);
    return memory.frame((frame) => {
      const [a, b] = ends.map((end) => frame.numbers(end));
      return memory.get("vox_ray_hit", (out) => this.#ask("ray", a, b, mask, out));
    });
  }

  queryRayHits(from, to, settings) {
    const ends = [floats(from, "from", 3), floats(to, "to", 3)];
    const { mask = ALL, excluded = 0 } = checked(settings, ["mask", "excluded"]);
    return memoryOf(this).frame((frame) => {
      const [a, b] = ends.map((end) => frame.numbers(end));
      return this.#hits("vox_facet_hit", frame, 16, (...room) => this.#ask("rayHits", a, b, mask, excluded, ...room));
    });
  }

  queryRayAny(from, to, settings) {
    const ends = [floats(from, "from", 3), floats(to, "to", 3)];
    const { mask = ALL, excluded = 0 } = checked(settings, ["mask", "excluded"]);
    const memory = memoryOf(this);
    return memory.frame((frame) => {
      const [a, b] = ends.map((end) => frame.numbers(end));
      return memory.number("u32", (out) => this.#ask("rayAny", a, b, mask, excluded, out)) !== 0;
    });
  }
}

/** The meshes of a grid at one moment, to be asked at any later time. */
export class QueryView extends Queries {
  constructor(memory, pointer) {
    super(memory, "query view", pointer, memory.call.vox_query_view_release, VIEW_QUERIES);
  }

  get epoch() {
    return memoryOf(this).number("count", (out) => memoryOf(this).call.vox_query_view_epoch(pointerOf(this), out));
  }

  userData(mesh) {
    const id = meshId(mesh, "mesh");
    return memoryOf(this).number("u64", (out) => memoryOf(this).call.vox_query_view_user_data(pointerOf(this), id, out));
  }
}

const kinds = { mask: bits, radius: float, maxDistance: float, excluded: meshId };

function checked(settings, known) {
  const found = options(settings, "options", known);
  for (const key of Object.keys(found)) found[key] = kinds[key](found[key], `options.${key}`);
  return found;
}
