// The lookup takes a tile at a time. It fetches the points in the tile's box from the rows of cells that the
// box meets; quantises points and vertices to 8 bits within the box (monotone, so a point in a tet's box is
// in its quantised box); tests each point against the 64 boxes of the tets at once; and decides the pairs
// that are left in single precision (narrow-inl.hpp).
#include "fast/lookup.hpp"
#include "base/prefetch.hpp"
#include "base/simd.hpp"

#include <algorithm>

#undef VOX_SOURCE
#define VOX_SOURCE "fast/lookup.cpp"
#include "base/each_target.hpp"

#include "base/lanes-inl.hpp"
#include "fast/narrow-inl.hpp"
#include "fast/quantise-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

// Finds for each candidate the set of tets whose quantised box it is in, without those that `own` it. Drops
// candidates whose set is empty, and returns how many are left. Nothing branches, as these sets are hard to
// predict.
template <class Own>
HWY_INLINE std::uint32_t TestBoxes(LookupScratch& s, std::uint32_t begin, std::uint32_t end,
                                   std::uint32_t left, std::uint64_t valid, Own own) {
    const Bytes d;
    constexpr std::size_t lanes = hn::MaxLanes(Bytes());
    const std::uint8_t *HWY_RESTRICT qx = s.candidate_quantised[0],
                                     *HWY_RESTRICT qy = s.candidate_quantised[1],
                                     *HWY_RESTRICT qz = s.candidate_quantised[2];
    std::uint64_t* HWY_RESTRICT masks = s.masks;
    std::uint32_t* HWY_RESTRICT meeting = s.meeting;
    constexpr std::size_t parts = tile_size / lanes;
    hn::Vec<Bytes> lo[3][parts], side[3][parts]; // in registers, as far as there are enough
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t j = 0; j < parts; ++j) {
            lo[a][j] = hn::Load(d, s.lo[a] + j * lanes);
            side[a][j] = hn::Load(d, s.side[a] + j * lanes);
        }
    for (std::uint32_t i = begin; i < end; ++i) {
        const auto x = hn::Set(d, qx[i]), y = hn::Set(d, qy[i]), z = hn::Set(d, qz[i]);
        std::uint64_t mask = 0;
        for (std::size_t j = 0; j < parts; ++j) {
            // For x below lo, x - lo wraps round to more than the side, as lo + side is no more than 255.
            const auto beyond_x = hn::SaturatedSub(hn::Sub(x, lo[0][j]), side[0][j]);
            const auto beyond_y = hn::SaturatedSub(hn::Sub(y, lo[1][j]), side[1][j]);
            const auto beyond_z = hn::SaturatedSub(hn::Sub(z, lo[2][j]), side[2][j]);
            const auto inside = hn::Eq(hn::Or(hn::Or(beyond_x, beyond_y), beyond_z), hn::Zero(d));
            mask |= vox::HWY_NAMESPACE::BitsOfMask(d, inside) << (j * lanes);
        }
        mask &= valid & ~own(i);
        masks[left] = mask;
        meeting[left] = i;
        s.candidate_x[left] = s.candidate_x[i];
        s.candidate_y[left] = s.candidate_y[i];
        s.candidate_z[left] = s.candidate_z[i];
        left += mask != 0;
    }
    return left;
}

// Index of the lowest bit that is set; any number when none is.
HWY_INLINE std::uint32_t LowestBit(std::uint64_t mask) {
#if defined(__GNUC__) && HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
    return static_cast<std::uint32_t>(_tzcnt_u64(mask));
#else
    return static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(mask | std::uint64_t{1} << 63));
#endif
}

// For each vertex of a tile, its tets that have the vertex as a corner.
HWY_INLINE void FindOwners(const Tiles& tiles, const Tile& tile, std::uint64_t* HWY_RESTRICT own) {
    if (!tiles.own.empty()) {
        const std::uint64_t* known = tiles.own.data() + tile.first_vertex;
        for (std::uint32_t i = 0; i < tile.vertex_count; ++i) own[i] = known[i];
        return;
    }
    for (std::uint32_t i = 0; i < tile.vertex_count; ++i) own[i] = 0;
    const std::uint8_t* corners = tiles.corners_of(static_cast<std::size_t>(&tile - tiles.tiles.data()));
    for (std::uint32_t c = 0; c < 4; ++c)
        for (std::uint32_t i = 0; i < tile.tet_count; ++i)
            own[corners[c * tile_size + i]] |= std::uint64_t{1} << i;
}

// One tile and how far it is prepared.
struct TileWork {
    const TiledBody& body;
    LookupScratch& s;
    Findings& out;
    const Tile& tile;
    Box box;
    bool ready;  // whether the tile is in scratch, with the boxes of its tets
    bool loaded; // whether its vertices are
    bool stamped;
    Scale scales[3];
    FilterConstants constants;

    void narrow(const TetNames& tets, std::uint32_t count) {
        if (body.rounded)
            Narrow<true>(tets, s, count, constants, out);
        else
            Narrow<false>(tets, s, count, constants, out);
    }
};

// All candidates in scratch against the tile; the first own_count are vertices of the same body.
HWY_NOINLINE void Process(TileWork& w, std::uint32_t count, std::uint32_t own_count) {
    LookupScratch& s = w.s;
    const Tile& tile = w.tile;
    if (!w.ready) {
        if (!w.loaded) LoadTile<false>(*w.body.tiles, w.body.positions, tile, s, w.box);
        for (int a = 0; a < 3; ++a) w.scales[a] = MakeScale(w.box.lo[a], w.box.hi[a]);
        const std::size_t index = static_cast<std::size_t>(&tile - w.body.tiles->tiles.data());
        QuantiseTile(w.body.tiles->corners_of(index), w.scales, tile.vertex_count, s);
        Corners::Prepare(s, tile.vertex_count);
        w.constants = MakeConstants(w.box, w.body.rounded);
        w.ready = true;
    }
    if (own_count && !w.stamped) {
        w.stamped = true;
        s.tag += 1u << 6;
        const std::uint32_t* vertices = w.body.tiles->vertices.data() + tile.first_vertex;
        for (std::uint32_t i = 0; i < tile.vertex_count; ++i) w.body.stamps[vertices[i]] = s.tag | i;
        FindOwners(*w.body.tiles, tile, s.own);
    }
    Quantise(s.candidate_x, count, w.scales[0], s.candidate_quantised[0]);
    Quantise(s.candidate_y, count, w.scales[1], s.candidate_quantised[1]);
    Quantise(s.candidate_z, count, w.scales[2], s.candidate_quantised[2]);
    const TetNames tets{w.body.by_place ? nullptr : w.body.tiles->tets.data() + tile.first_tet,
                        tile.first_tet};
    const std::uint32_t* stamps = w.body.stamps;
    const std::uint32_t left_of_own =
        TestBoxes(s, 0, own_count, 0, tile.all_tets(), [&](std::uint32_t i) -> std::uint64_t {
            const std::uint32_t stamp = stamps[s.candidate_id[i]];
            const std::uint64_t is_of_tile = stamp >> 6 == s.tag >> 6;
            return s.own[stamp & 63] & (0 - is_of_tile); // a branch would be mispredicted too often
        });
    const std::uint32_t left = TestBoxes(s, own_count, count, left_of_own, tile.all_tets(),
                                         [](std::uint32_t) { return std::uint64_t{0}; });
    std::uint32_t pairs = 0;
    for (std::uint32_t k = 0; k < left; ++k) {
        std::uint64_t mask = s.masks[k];
        const std::uint32_t candidate = k << 6;
        std::uint32_t* to = s.pairs + pairs;
        pairs += static_cast<std::uint32_t>(hwy::PopCount(mask));
        do {
            // Four at a time. Those past the last bit are overwritten by the pairs of the next candidate.
            for (int j = 0; j < 4; ++j) {
                to[j] = candidate | (LowestBit(mask) & 63);
                mask &= mask - 1;
            }
            to += 4;
        } while (mask);
        if (pairs > LookupScratch::most_pairs - 64) {
            w.narrow(tets, pairs);
            pairs = 0;
        }
    }
    if (pairs) w.narrow(tets, pairs);
}

// Runs of points of a window, each at most a register long: from first[i], below end[i].
struct Runs {
    static constexpr std::uint32_t most = 64, at_once = 4; // are added
    alignas(16) std::uint32_t first[most + at_once], end[most + at_once];
    std::uint32_t count = 0;
};

// Appends the points of the runs that are in `box` to the candidates.
HWY_NOINLINE std::uint32_t Filter(TileWork& w, const Source& source, const Box& box, const Runs& runs,
                                  bool own, std::uint32_t n, std::uint32_t& own_count) {
    const Floats d;
    const Words du;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    LookupScratch& s = w.s;
    const auto lx = hn::Set(d, box.lo[0]), ly = hn::Set(d, box.lo[1]), lz = hn::Set(d, box.lo[2]);
    const auto hx = hn::Set(d, box.hi[0]), hy = hn::Set(d, box.hi[1]), hz = hn::Set(d, box.hi[2]);
    const Window& window = source.window;
    const Points& points = window.bins->points;
    const float* HWY_RESTRICT px = points.x.data() + window.first_point;
    const float* HWY_RESTRICT py = points.y.data() + window.first_point;
    const float* HWY_RESTRICT pz = points.z.data() + window.first_point;
    const std::uint32_t* HWY_RESTRICT ids = points.id.data() + window.first_point;
    std::uint32_t labelled = n;
    const auto label = [&]() HWY_ATTR {
        for (; labelled < n; labelled += lanes)
            hn::StoreU(hn::Set(du, source.body), du, s.candidate_body + labelled);
    };
    for (std::uint32_t r = 0; r < runs.count; ++r) {
        const std::uint32_t i = runs.first[r];
        const auto vx = hn::LoadU(d, px + i), vy = hn::LoadU(d, py + i), vz = hn::LoadU(d, pz + i);
        const auto inside_x = hn::And(hn::Ge(vx, lx), hn::Le(vx, hx));
        const auto inside_y = hn::And(hn::Ge(vy, ly), hn::Le(vy, hy));
        const auto inside_z = hn::And(hn::Ge(vz, lz), hn::Le(vz, hz));
        const auto inside =
            hn::And(hn::And(inside_x, inside_y), hn::And(inside_z, hn::FirstN(d, runs.end[r] - i)));
        // Stored also when none is inside: a branch would be mispredicted too often.
        const Compressor compress(inside);
        hn::StoreU(compress(vx), d, s.candidate_x + n);
        hn::StoreU(compress(vy), d, s.candidate_y + n);
        hn::StoreU(compress(vz), d, s.candidate_z + n);
        hn::StoreU(compress(hn::LoadU(du, ids + i)), du, s.candidate_id + n);
        n += compress.count();
        if (n > LookupScratch::most_candidates - 16) {
            label();
            Process(w, n, own ? n : own_count);
            n = labelled = own_count = 0;
        }
    }
    label();
    if (own) own_count = n;
    return n;
}

// Appends the points of a source that are in the tile's box to the candidates. Rows of cells are first listed
// as runs: the number of registers in a row is hard to predict, and a loop over them would wait for memory
// at each misprediction.
HWY_INLINE std::uint32_t Fetch(TileWork& w, const Source& source, bool own, std::uint32_t n,
                               std::uint32_t& own_count) {
    const hn::FixedTag<std::uint32_t, Runs::at_once> d4;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(Floats()));
    const auto steps = hn::Mul(hn::Iota(d4, 0), hn::Set(d4, lanes));
    Box box = w.box; // the part of it in the region of the source
    intersect(box, source.region);
    const Window& window = source.window;
    const WindowLattice& lattice = window.lattice;
    const std::uint32_t x0 = lattice.cell(box.lo[0], 0), x1 = lattice.cell(box.hi[0], 0);
    const std::uint32_t y0 = lattice.cell(box.lo[1], 1), y1 = lattice.cell(box.hi[1], 1);
    const std::uint32_t z0 = lattice.cell(box.lo[2], 2), z1 = lattice.cell(box.hi[2], 2);
    const std::uint32_t width = x1 - x0 + 1, height = y1 - y0 + 1;
    std::size_t rows = std::size_t{height} * (z1 - z0 + 1);
    w.s.counters.visited_cells += rows * width;
    const std::uint32_t* row = window.bins->begin.data() + window.first_cell +
                               (std::size_t{z0} * lattice.cells[1] + y0) * lattice.cells[0] + x0;
    const std::size_t next_row = lattice.cells[0],
                      next_layer = std::size_t{lattice.cells[1] - height + 1} * lattice.cells[0];
    Runs runs;
    std::uint64_t visited = 0;
    std::uint32_t left = height; // rows of the layer
    for (; rows; --rows) {
        std::uint32_t i = row[0];
        const std::uint32_t end = row[width];
        --left;
        row += left ? next_row : next_layer;
        left = left ? left : height;
        visited += end - i;
        for (;;) {
            hn::StoreU(hn::Add(hn::Set(d4, i), steps), d4, runs.first + runs.count);
            hn::StoreU(hn::Set(d4, end), d4, runs.end + runs.count);
            const std::uint32_t needed = (end - i + lanes - 1) / lanes;
            runs.count += needed < Runs::at_once ? needed : Runs::at_once;
            if (runs.count > Runs::most - Runs::at_once) {
                n = Filter(w, source, box, runs, own, n, own_count);
                runs.count = 0;
            }
            if (needed <= Runs::at_once) break;
            i += Runs::at_once * lanes;
        }
    }
    w.s.counters.visited_points += visited;
    return Filter(w, source, box, runs, own, n, own_count);
}

HWY_INLINE void PrefetchRange(const void* from, std::size_t bytes) {
    const char* line = static_cast<const char*>(from);
    for (std::size_t i = 0; i < bytes; i += 64) prefetch(line + i);
}

// Fetches what a tile with candidates reads into the cache, while the candidates are found.
HWY_INLINE void PrefetchTile(const Tiles& tiles, const Tile& tile, bool own) {
    const auto index = static_cast<std::size_t>(&tile - tiles.tiles.data());
    PrefetchRange(tiles.vertices.data() + tile.first_vertex, tile.vertex_count * sizeof(std::uint32_t));
    PrefetchRange(tiles.corners_of(index), 4 * tile_size);
    PrefetchRange(tiles.tets.data() + tile.first_tet, tile.tet_count * sizeof(std::uint32_t));
    if (own && !tiles.own.empty())
        PrefetchRange(tiles.own.data() + tile.first_vertex, tile.vertex_count * sizeof(std::uint64_t));
}

// The tiles of a super-tile together read nearly all of a window with few points: 8 KiB at most.
HWY_INLINE void PrefetchWindow(const Window& window) {
    constexpr std::uint32_t few = 512;
    if (window.count > few) return;
    const Bins& bins = *window.bins;
    const std::size_t bytes = window.count * sizeof(float), cells = window.lattice.count() + 1;
    PrefetchRange(bins.begin.data() + window.first_cell, cells * sizeof(std::uint32_t));
    PrefetchRange(bins.points.x.data() + window.first_point, bytes);
    PrefetchRange(bins.points.y.data() + window.first_point, bytes);
    PrefetchRange(bins.points.z.data() + window.first_point, bytes);
    PrefetchRange(bins.points.id.data() + window.first_point, bytes);
}

void LookUpTiles(const TiledBody& body, const Source* sources, std::size_t source_count, std::uint32_t first,
                 std::uint32_t last, LookupScratch& s, Findings& out) {
    for (std::size_t i = 0; i < source_count; ++i) PrefetchWindow(sources[i].window);
    for (std::uint32_t t = first; t < last; ++t) {
        TileWork w{body, s, out, body.tiles->tiles.data()[t], body.boxes[t], false, false, false, {}, {}};
        if (body.known && !body.known[t]) {
            LoadTile(*body.tiles, body.positions, w.tile, s, w.box);
            w.loaded = true;
            body.made[t] = w.box;
            body.known[t] = 1;
        }
        std::uint32_t n = 0, own_count = 0;
        bool met = false;
        for (std::size_t i = 0; i < source_count; ++i) {
            if (!overlap(w.box, sources[i].region)) continue;
            if (!met) PrefetchTile(*body.tiles, w.tile, body.stamps);
            met = true;
            n = Fetch(w, sources[i], body.stamps && sources[i].body == sources[0].body, n, own_count);
        }
        if (n) Process(w, n, own_count);
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

void hand_over(LookupScratch& scratch, Findings& out) {
    out.take(std::span<const Finding>(scratch.findings, scratch.finding_count));
    scratch.finding_count = 0;
}

void flush(LookupScratch& scratch, Findings& out) {
    if (scratch.finding_count) hand_over(scratch, out);
}

void look_up_tiles(const TiledBody& body, std::span<const Source> sources, std::uint32_t first,
                   std::uint32_t last, LookupScratch& scratch, Findings& out) {
    VOX_SIMD_DISPATCH(LookUpTiles)(body, sources.data(), sources.size(), first, last, scratch, out);
}

namespace {

// The windows that the tiles in `box` may find points in, those of the body itself first.
void list_sources(const BroadPhase& broad, const Windows& windows, std::uint32_t body, const Box& box,
                  Array<Source>& sources) {
    sources.clear();
    const auto add = [&](std::uint32_t a, const Box& region) {
        const BodyWindow& body_window = windows.of[a];
        Box both = box;
        intersect(both, region);
        if (!body_window.bins || is_empty(both)) return;
        for_windows(*body_window.bins, body_window.root, both, [&](const Window& window) {
            Source source{window, region, a};
            intersect(source.region, window.box);
            sources.push_back(source);
        });
    };
    add(body, windows.of[body].own);
    for (const std::uint32_t r : broad.of_b(body)) add(broad.regions[r].a, broad.regions[r].region);
}

// Makes room for one stamp for each vertex. No tile may mistake the stamps of another for its own, also when
// the tag wraps round.
void prepare_stamps(std::size_t vertices, std::size_t tiles, Array<std::uint32_t>& stamps,
                    LookupScratch& scratch) {
    if (stamps.size() < vertices) stamps.resize(vertices, 0);
    if ((scratch.tag >> 6) + tiles < 1u << 26) return;
    std::fill(stamps.begin(), stamps.end(), 0u);
    scratch.tag = 0;
}

} // namespace

void look_up(const Step& step, const BroadPhase& broad, const Windows& windows, const Piece& piece,
             StepBoxes& boxes, LookupBuffers& buffers, Findings& out) {
    const std::uint32_t b = piece.body;
    const StepBody& body = step.of[b];
    const bool self = !is_empty(windows.of[b].own), reached = broad.is_reached(b);
    if (!self && !reached) return;
    if (!reached && !body.has_super_boxes) make_super_tile_boxes(step, broad, piece, boxes);
    const Box* super_boxes = boxes.super_tiles.data() + body.first_super;
    Box box = empty_box;
    for (std::uint32_t s = piece.first; s < piece.last; ++s) add(box, super_boxes[s]);
    list_sources(broad, windows, b, box, buffers.sources);
    if (buffers.sources.empty()) return;

    const Tiles& tiles = *body.tiles;
    TiledBody tiled{};
    tiled.tiles = &tiles;
    tiled.positions = body.positions;
    tiled.boxes = tiled.made = boxes.tiles.data() + body.first_tile;
    tiled.known = boxes.tile_known.data() + body.first_tile;
    tiled.rounded = body.rounded;
    for (const Source& source : buffers.sources) tiled.rounded |= step.of[source.body].rounded;
    if (buffers.scratch.empty()) buffers.scratch.resize(1);
    LookupScratch& scratch = buffers.scratch[0];
    scratch.finding_count = 0; // another piece may have failed and left some
    if (self) prepare_stamps(step.bodies[b].vertex_count, tiles.tiles.size(), buffers.stamps, scratch);
    Array<Source>& near = buffers.near;
    for (std::uint32_t s = piece.first; s < piece.last; ++s) {
        near.clear();
        for (const Source& source : buffers.sources) {
            if (!overlap(super_boxes[s], source.region)) continue;
            if (source.body ==
                b) { // where most of a body is certified, few super-tiles meet the other vertices
                Box met = super_boxes[s];
                intersect(met, source.region);
                if (!holds_point(source.window, met)) continue;
            }
            near.push_back(source);
        }
        if (near.empty()) continue;
        tiled.stamps = near[0].body == b ? buffers.stamps.data() : nullptr;
        look_up_tiles(tiled, near, tiles.super_first[s], tiles.super_first[s + 1], scratch, out);
    }
    flush(scratch, out);
}

} // namespace vox::fast
#endif
