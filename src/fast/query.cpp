// A tile at a time: fetch the points in its box from the rows of cells the box meets; quantise points and
// vertices to 8 bits within the box (monotone, so a point in a tet's box is in its quantised box); test each
// point against the 64 boxes at once; decide the pairs that are left in single precision (narrow-inl.hpp).
#include "fast/query.hpp"
#include "base/simd.hpp"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/query.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "fast/narrow-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace vox::fast {
namespace HWY_NAMESPACE {

using Bytes = hn::CappedTag<std::uint8_t, 64>;

// How coordinates of a box along one axis go to 0 .. 255: (c - origin) * scale, cut. Both 0 where that could
// not be computed: everything is 0 then, which is monotone too.
struct Scale {
    float origin, scale;
};

HWY_INLINE Scale MakeScale(float lo, float hi) {
    const float side = hi - lo;
    if (side > 0x1p-100f && side < 0x1p+120f) return {lo, 255.0f / side};
    return {0, 0};
}

HWY_INLINE void Quantise(const float* HWY_RESTRICT values, std::uint32_t count, Scale scale,
                         std::uint8_t* HWY_RESTRICT out) {
    const Floats d;
    const hn::RebindToSigned<Floats> di;
    const hn::Rebind<std::uint8_t, Floats> db;
    const auto origin = hn::Set(d, scale.origin), factor = hn::Set(d, scale.scale);
    for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
        const auto q = hn::ConvertTo(di, hn::Mul(hn::Sub(hn::LoadU(d, values + i), origin), factor));
        hn::StoreU(hn::DemoteTo(db, q), db, out + i);
    }
}

// Indices below 16 stay, others get their top bit set: a lookup gives 0 for them.
HWY_INLINE hn::Vec<Bytes> QuarterIndex(hn::Vec<Bytes> index) {
    const Bytes d;
    const auto biased = hn::Add(index, hn::Set(d, 0x70));
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128
    return biased; // pshufb looks at the top bit and the low four alone
#else
    return hn::And(biased, hn::Set(d, 0x8f));
#endif
}

constexpr std::uint32_t few_vertices = 48; // most tiles have no more

// A table of bytes looked up 16 at a time, a lookup giving 0 where an index is not in that quarter (its top
// bit is set by the sum then).
template <std::uint32_t kQuarters>
struct ByteTable {
    hn::Vec<Bytes> quarter[kQuarters];

    HWY_INLINE explicit ByteTable(const std::uint8_t* values) {
        for (std::uint32_t q = 0; q < kQuarters; ++q)
            quarter[q] = hn::LoadDup128(Bytes(), values + std::size_t{16} * q);
    }
    HWY_INLINE hn::Vec<Bytes> operator()(hn::Vec<Bytes> index) const {
        const Bytes d;
        auto found = hn::TableLookupBytesOr0(quarter[0], QuarterIndex(index));
        for (std::uint32_t q = 1; q < kQuarters; ++q) {
            const auto in_quarter = hn::Xor(index, hn::Set(d, static_cast<std::uint8_t>(16 * q)));
            found = hn::Or(found, hn::TableLookupBytesOr0(quarter[q], QuarterIndex(in_quarter)));
        }
        return found;
    }
};

// Local indices of the corners, and the quantised boxes of the tets; of at most 16 kQuarters vertices.
template <std::uint32_t kQuarters>
HWY_INLINE void QuantiseTets(const std::uint8_t* HWY_RESTRICT corners, QueryScratch& s) {
    const Bytes d;
    for (std::size_t j = 0; j < tile_size; j += hn::Lanes(d)) {
        const auto c0 = hn::LoadU(d, corners + j), c1 = hn::LoadU(d, corners + tile_size + j);
        const auto c2 = hn::LoadU(d, corners + 2 * tile_size + j),
                   c3 = hn::LoadU(d, corners + 3 * tile_size + j);
        hn::StoreInterleaved4(c0, c1, c2, c3, d, reinterpret_cast<std::uint8_t*>(s.corners) + 4 * j);
        for (std::size_t a = 0; a < 3; ++a) {
            const ByteTable<kQuarters> table(s.quantised[a]);
            const auto v0 = table(c0), v1 = table(c1), v2 = table(c2), v3 = table(c3);
            const auto lo = hn::Min(hn::Min(v0, v1), hn::Min(v2, v3)),
                       hi = hn::Max(hn::Max(v0, v1), hn::Max(v2, v3));
            hn::Store(lo, d, s.lo[a] + j);
            hn::Store(hn::Sub(hi, lo), d, s.side[a] + j);
        }
    }
}

HWY_INLINE void QuantiseTile(const std::uint8_t* HWY_RESTRICT corners, const Scale* scales,
                             std::uint32_t vertex_count, QueryScratch& s) {
    Quantise(s.x, vertex_count, scales[0], s.quantised[0]);
    Quantise(s.y, vertex_count, scales[1], s.quantised[1]);
    Quantise(s.z, vertex_count, scales[2], s.quantised[2]);
    if (vertex_count <= few_vertices)
        QuantiseTets<few_vertices / 16>(corners, s);
    else
        QuantiseTets<4>(corners, s);
}

// For each candidate the set of tets whose quantised box it meets, less those that `own` it. Candidates that
// meet none are dropped; returns how many are left. Nothing branches: what a candidate meets is hard to
// predict.
template <class Own>
HWY_INLINE std::uint32_t TestBoxes(QueryScratch& s, std::uint32_t begin, std::uint32_t end,
                                   std::uint32_t left, std::uint64_t valid, Own own) {
    const Bytes d;
    constexpr std::size_t lanes = hn::MaxLanes(Bytes());
    const std::uint8_t *HWY_RESTRICT qx = s.candidate_quantised[0],
                                     *HWY_RESTRICT qy = s.candidate_quantised[1],
                                     *HWY_RESTRICT qz = s.candidate_quantised[2];
    std::uint64_t* HWY_RESTRICT masks = s.masks;
    std::uint32_t* HWY_RESTRICT meeting = s.meeting;
    constexpr std::size_t parts = tile_size / lanes;
    hn::Vec<Bytes> lo[3][parts], side[3][parts]; // in registers, as far as there are so many
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t j = 0; j < parts; ++j) {
            lo[a][j] = hn::Load(d, s.lo[a] + j * lanes);
            side[a][j] = hn::Load(d, s.side[a] + j * lanes);
        }
    for (std::uint32_t i = begin; i < end; ++i) {
        const auto x = hn::Set(d, qx[i]), y = hn::Set(d, qy[i]), z = hn::Set(d, qz[i]);
        std::uint64_t mask = 0;
        for (std::size_t j = 0; j < parts; ++j) {
            // Where it is below lo, x - lo wraps round to more than the side, as no side is longer than 255.
            const auto beyond_x = hn::SaturatedSub(hn::Sub(x, lo[0][j]), side[0][j]);
            const auto beyond_y = hn::SaturatedSub(hn::Sub(y, lo[1][j]), side[1][j]);
            const auto beyond_z = hn::SaturatedSub(hn::Sub(z, lo[2][j]), side[2][j]);
            const auto inside = hn::Eq(hn::Or(hn::Or(beyond_x, beyond_y), beyond_z), hn::Zero(d));
            std::uint64_t part = 0;
            alignas(8) std::uint8_t bits[8];
            hn::StoreMaskBits(d, inside, bits);
            std::memcpy(&part, bits, lanes / 8);
            mask |= part << (j * lanes);
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

// Index of the lowest bit that is set; some number when none is.
HWY_INLINE std::uint32_t LowestBit(std::uint64_t mask) {
#if defined(__GNUC__) && HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
    return static_cast<std::uint32_t>(_tzcnt_u64(mask));
#else
    return static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(mask | std::uint64_t{1} << 63));
#endif
}

// One tile and how far it is prepared.
struct TileWork {
    const Query& query;
    QueryScratch& s;
    Findings& out;
    const Tile& tile;
    Box box;
    bool ready;  // the tile is in scratch, with its boxes
    bool loaded; // its vertices are
    bool stamped;
    Scale scales[3];
    FilterConstants constants;

    void narrow(const std::uint32_t* tets, std::uint32_t count) {
        const bool few = tile.vertex_count <= few_vertices;
        if (query.rounded)
            few ? Narrow<true, FewCorners>(tets, s, count, constants, out)
                : Narrow<true, ManyCorners>(tets, s, count, constants, out);
        else
            few ? Narrow<false, FewCorners>(tets, s, count, constants, out)
                : Narrow<false, ManyCorners>(tets, s, count, constants, out);
    }
};

// All candidates in scratch against the tile; the first own_count are vertices of the same body.
HWY_NOINLINE void Process(TileWork& w, std::uint32_t count, std::uint32_t own_count) {
    QueryScratch& s = w.s;
    const Tile& tile = w.tile;
    if (!w.ready) {
        if (!w.loaded) LoadTile<false>(*w.query.tiles, w.query.positions, tile, s, w.box);
        for (int a = 0; a < 3; ++a) w.scales[a] = MakeScale(w.box.lo[a], w.box.hi[a]);
        const std::size_t index = static_cast<std::size_t>(&tile - w.query.tiles->tiles.data());
        QuantiseTile(w.query.tiles->corners.data() + index * 4 * tile_size, w.scales, tile.vertex_count, s);
        ManyCorners::Prepare(s, tile.vertex_count);
        w.constants = MakeConstants(w.box, w.query.rounded);
        w.ready = true;
    }
    if (own_count && !w.stamped) {
        w.stamped = true;
        s.tag += 1u << 6;
        const std::uint32_t* vertices = w.query.tiles->vertices.data() + tile.first_vertex;
        const std::uint64_t* own = w.query.tiles->own.data() + tile.first_vertex;
        for (std::uint32_t i = 0; i < tile.vertex_count; ++i) {
            w.query.stamps[vertices[i]] = s.tag | i;
            s.own[i] = own[i];
        }
    }
    Quantise(s.candidate_x, count, w.scales[0], s.candidate_quantised[0]);
    Quantise(s.candidate_y, count, w.scales[1], s.candidate_quantised[1]);
    Quantise(s.candidate_z, count, w.scales[2], s.candidate_quantised[2]);
    const std::uint32_t* tets = w.query.tiles->tets.data() + tile.first_tet;
    const std::uint32_t* stamps = w.query.stamps;
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
            // Four at a time; of those past the last bit the next candidate's take the place.
            for (int j = 0; j < 4; ++j) {
                to[j] = candidate | (LowestBit(mask) & 63);
                mask &= mask - 1;
            }
            to += 4;
        } while (mask);
        if (pairs > QueryScratch::most_pairs - 64) {
            w.narrow(tets, pairs);
            pairs = 0;
        }
    }
    if (pairs) w.narrow(tets, pairs);
}

// Runs of points of a window, of a register each: first[i] and those that follow it below end[i].
struct Runs {
    static constexpr std::uint32_t most = 64, at_once = 4; // are added
    alignas(16) std::uint32_t first[most + at_once], end[most + at_once];
    std::uint32_t count = 0;
};

// Appends the points of the runs that lie in `box` to the candidates.
HWY_NOINLINE std::uint32_t Filter(TileWork& w, const Source& source, const Box& box, const Runs& runs,
                                  bool own, std::uint32_t n, std::uint32_t& own_count) {
    const Floats d;
    const Words du;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    QueryScratch& s = w.s;
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
        // Also when there is none: a branch would be mispredicted too often.
        const Compressor compress(inside);
        hn::StoreU(compress(vx), d, s.candidate_x + n);
        hn::StoreU(compress(vy), d, s.candidate_y + n);
        hn::StoreU(compress(vz), d, s.candidate_z + n);
        hn::StoreU(compress(hn::LoadU(du, ids + i)), du, s.candidate_id + n);
        n += compress.count();
        if (n > QueryScratch::most_candidates - 16) {
            label();
            Process(w, n, own ? n : own_count);
            n = labelled = own_count = 0;
        }
    }
    label();
    if (own) own_count = n;
    return n;
}

// Appends the points of a source that lie in the tile's box to the candidates. Rows of cells are first listed
// as runs: how many registers a row takes is hard to predict, and a loop over them would wait for memory
// whenever it was predicted wrongly.
HWY_INLINE std::uint32_t Fetch(TileWork& w, const Source& source, bool own, std::uint32_t n,
                               std::uint32_t& own_count) {
    const hn::FixedTag<std::uint32_t, Runs::at_once> d4;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(Floats()));
    const auto steps = hn::Mul(hn::Iota(d4, 0), hn::Set(d4, lanes));
    Box box = w.box; // no further than the source matters
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
    for (std::size_t i = 0; i < bytes; i += 64) hwy::Prefetch(line + i);
}

// What is made of the tile when it has candidates; it comes while those are fetched.
HWY_INLINE void PrefetchTile(const Tiles& tiles, const Tile& tile, bool own) {
    const auto index = static_cast<std::size_t>(&tile - tiles.tiles.data());
    PrefetchRange(tiles.vertices.data() + tile.first_vertex, tile.vertex_count * sizeof(std::uint32_t));
    PrefetchRange(tiles.corners.data() + index * 4 * tile_size, 4 * tile_size);
    PrefetchRange(tiles.tets.data() + tile.first_tet, tile.tet_count * sizeof(std::uint32_t));
    if (own) PrefetchRange(tiles.own.data() + tile.first_vertex, tile.vertex_count * sizeof(std::uint64_t));
}

// Of a window of few points the tiles of a super-tile together read more or less all.
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

void QueryTiles(const Query& query, const Source* sources, std::size_t source_count, std::uint32_t first,
                std::uint32_t last, QueryScratch& s, Findings& out) {
    for (std::size_t i = 0; i < source_count; ++i) PrefetchWindow(sources[i].window);
    for (std::uint32_t t = first; t < last; ++t) {
        TileWork w{query, s, out, query.tiles->tiles.data()[t], query.boxes[t], false, false, false, {}, {}};
        if (!query.known[t]) {
            LoadTile(*query.tiles, query.positions, w.tile, s, w.box);
            w.loaded = true;
            query.boxes[t] = w.box;
            query.known[t] = 1;
        }
        std::uint32_t n = 0, own_count = 0;
        bool met = false;
        for (std::size_t i = 0; i < source_count; ++i) {
            if (!overlap(w.box, sources[i].region)) continue;
            if (!met) PrefetchTile(*query.tiles, w.tile, query.stamps);
            met = true;
            n = Fetch(w, sources[i], query.stamps && sources[i].body == sources[0].body, n, own_count);
        }
        if (n) Process(w, n, own_count);
    }
}

} // namespace HWY_NAMESPACE
} // namespace vox::fast
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::fast {

// Barycentric coordinates of the findings: the points are at hand here, and anywhere in memory later.
void weigh(QueryScratch& s) {
    for (std::uint32_t first = 0; first < s.finding_count; first += barycentric_block) {
        Finding* findings = s.findings + first;
        const std::uint32_t count = std::min<std::uint32_t>(s.finding_count - first, barycentric_block);
        if (std::none_of(findings, findings + count, [](const Finding& f) { return f.weights.known(); }))
            continue;
        Weights weights[barycentric_block];
        const std::uint64_t uncertain =
            barycentric(s.points[first / barycentric_block], count, weights[0].of);
        for (std::uint32_t i = 0; i < count; ++i)
            if (findings[i].weights.known())
                findings[i].weights = uncertain >> i & 1 ? Weights::unknown() : weights[i];
    }
}

void hand_over(QueryScratch& scratch, Findings& out) {
    weigh(scratch);
    out.take(std::span<const Finding>(scratch.findings, scratch.finding_count));
    scratch.finding_count = 0;
}

void flush(QueryScratch& scratch, Findings& out) {
    if (scratch.finding_count) hand_over(scratch, out);
}

void query_tiles(const Query& query, std::span<const Source> sources, std::uint32_t first, std::uint32_t last,
                 QueryScratch& scratch, Findings& out) {
    VOX_SIMD_DISPATCH(QueryTiles)(query, sources.data(), sources.size(), first, last, scratch, out);
}

namespace {

// The windows that the tiles in `box` may find points in, those of the body itself first.
void list_sources(const BroadPhase& broad, const Windows& windows, std::uint32_t body, const Box& box,
                  std::pmr::vector<Source>& sources) {
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

// One stamp a vertex. The stamps of a tile must not be mistaken for another's, also not after the tag has run over.
void prepare_stamps(std::size_t vertices, std::size_t tiles, std::pmr::vector<std::uint32_t>& stamps,
                    QueryScratch& scratch) {
    if (stamps.size() < vertices) stamps.resize(vertices, 0);
    if ((scratch.tag >> 6) + tiles < 1u << 26) return;
    std::fill(stamps.begin(), stamps.end(), 0u);
    scratch.tag = 0;
}

} // namespace

void query(const Step& step, const BroadPhase& broad, const Windows& windows, const Piece& piece, StepBoxes& boxes,
           QueryBuffers& buffers, Findings& out) {
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
    Query tile_query{};
    tile_query.tiles = &tiles;
    tile_query.positions = body.positions;
    tile_query.boxes = boxes.tiles.data() + body.first_tile;
    tile_query.known = boxes.tile_known.data() + body.first_tile;
    tile_query.rounded = body.rounded;
    for (const Source& source : buffers.sources) tile_query.rounded |= step.of[source.body].rounded;
    if (buffers.scratch.empty()) buffers.scratch.resize(1);
    QueryScratch& scratch = buffers.scratch[0];
    scratch.finding_count = 0; // another piece may have failed and left some
    if (self) prepare_stamps(step.bodies[b].vertex_count, tiles.tiles.size(), buffers.stamps, scratch);
    std::pmr::vector<Source>& near = buffers.near;
    for (std::uint32_t s = piece.first; s < piece.last; ++s) {
        near.clear();
        for (const Source& source : buffers.sources) {
            if (!overlap(super_boxes[s], source.region)) continue;
            if (source.body == b) { // where most of a body is certified, few meet what is left
                Box met = super_boxes[s];
                intersect(met, source.region);
                if (!holds_point(source.window, met)) continue;
            }
            near.push_back(source);
        }
        if (near.empty()) continue;
        tile_query.stamps = near[0].body == b ? buffers.stamps.data() : nullptr;
        query_tiles(tile_query, near, tiles.super_first[s], tiles.super_first[s + 1], scratch, out);
    }
    flush(scratch, out);
}

} // namespace vox::fast
#endif
