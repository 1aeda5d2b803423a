// Tiles by recursive median splits along the longest side of the centroids' box (J. L. Bentley,
// Multidimensional binary search trees used for associative searching, CACM 18, 1975), cut so that the parts
// come out nearly full.
#include "mesh/tiles.hpp"

#include "base/bits.hpp"

#include <array>
#include <bit>
#include <cmath>

namespace vox {

namespace {

// A vertex as seen from the first one where positions are rounded: far from zero they might all look the
// same.
Vec3f seen_from_first(const Positions& positions, std::size_t vertex) {
    if (!positions.rounded()) return positions.floats(vertex);
    const Vec3d p = positions.exact(vertex), first = positions.exact(0);
    return {static_cast<float>(p.x - first.x), static_cast<float>(p.y - first.y),
            static_cast<float>(p.z - first.z)};
}

struct Item {
    float centroid[3]; // times four
    std::uint32_t tet;
};

// The longest side of the centroids' box.
struct LongestSide {
    explicit LongestSide(std::span<const Item> items) {
        Box box = empty_box, other = empty_box;
        std::size_t i = 0;
        for (; i + 1 < items.size(); i += 2) { // two minima wait for each other less than one does
            add(box, items[i]);
            add(other, items[i + 1]);
        }
        if (i < items.size()) add(box, items[i]);
        vox::add(box, other);
        const float *lo = box.lo, *hi = box.hi;
        for (int a = 1; a < 3; ++a)
            if (hi[a] - lo[a] > hi[axis] - lo[axis]) axis = a;
        low = lo[axis];
        length = hi[axis] - low;
    }

    int axis = 0;
    float low, length;

private:
    static void add(Box& box, const Item& item) noexcept {
        for (int a = 0; a < 3; ++a) {
            const float c = item.centroid[a];
            box.lo[a] = c < box.lo[a] ? c : box.lo[a];
            box.hi[a] = c > box.hi[a] ? c : box.hi[a];
        }
    }
};

// Puts the `middle` items that are lowest along the longest side before the others, in `items` or, where it
// returns true, in `other`. The items are counted in slabs across that side, and then go to one end of
// `other` or the other without a branch, which would be mispredicted for every other item. Only those in the
// slab of the middle one have to be compared with each other.
bool divide(std::span<Item> items, std::uint32_t middle, Item* other) {
    const LongestSide side(items);
    // Ties by index: the same tiles from every standard library.
    const auto before = [axis = side.axis](const Item& a, const Item& b) {
        return a.centroid[axis] != b.centroid[axis] ? a.centroid[axis] < b.centroid[axis] : a.tet < b.tet;
    };
    constexpr std::uint32_t most_slabs = 1024;
    const std::uint32_t slabs =
        std::clamp(std::bit_ceil(static_cast<std::uint32_t>(items.size()) / 4), 64u, most_slabs);
    const float last = static_cast<float>(slabs - 1), per_length = static_cast<float>(slabs) / side.length;
    if (!(per_length > 0 && per_length < float_infinity)) {
        std::nth_element(items.begin(), items.begin() + middle, items.end(), before);
        return false;
    }
    const auto slab_of = [&](const Item& item) { // monotone as rounded
        const float t = (item.centroid[side.axis] - side.low) * per_length;
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(t < last ? t : last));
    };
    std::uint32_t in_slab[most_slabs];
    std::fill_n(in_slab, slabs, 0u);
    for (const Item& item : items) ++in_slab[slab_of(item)];
    std::uint32_t slab = 0, below = 0; // that of the middle one, and how many items are in lower ones
    while (below + in_slab[slab] <= middle) below += in_slab[slab++];

    // Where the next lower item goes, and after which place the next upper one; between them is room for at
    // least one, those in the slab, which are kept at the front of `items` until the end.
    Item *low = other, *high = other + items.size(), *within = items.data();
    for (const Item& item : items) {
        const std::uint32_t s = slab_of(item);
        if (s == slab) {
            *within++ = item;
            continue;
        }
        *low = high[-1] = item;
        low += (s - slab) >> 31; // s < slab: compilers would branch
        high -= (slab - s) >> 31;
    }
    std::nth_element(items.data(), items.data() + (middle - below), within, before);
    std::copy(items.data(), within, low);
    return true;
}

class Splitter {
public:
    Splitter(std::span<const Tet> tets, std::uint32_t vertex_count, Tiles& out)
        : tets_(tets), vertex_count_(vertex_count), out_(out), seen_(vertex_count, 0, out.tiles.memory()) {}

    // Changes the order of the items. `other` is as long as they are.
    void split(Item* items, Item* other, std::uint32_t count, bool in_super_tile = false) {
        const bool is_super_tile = !in_super_tile && count <= super_tile_size * target_tets;
        if (!(count <= tile_size && emit(items, count)))
            cut(items, other, count, in_super_tile || is_super_tile);
        if (is_super_tile) out_.super_first.push_back(static_cast<std::uint32_t>(out_.tiles.size()));
    }

private:
    void cut(Item* items, Item* other, std::uint32_t count, bool in_super_tile) {
        const std::uint32_t middle = lower_part(count);
        if (divide({items, count}, middle, other)) std::swap(items, other);
        split(items, other, middle, in_super_tile);
        split(items + middle, other + middle, count - middle, in_super_tile);
    }

    // Makes one tile of the items, or returns false when they have too many vertices.
    bool emit(const Item* items, std::uint32_t count) {
        // seen_[v] is (stamp | local index) once v has its place in this tile.
        if (++stamp_ == 1u << 26) {
            std::fill(seen_.begin(), seen_.end(), 0);
            stamp_ = 1;
        }
        std::uint32_t list[tile_size];
        std::uint64_t own[tile_size] = {};
        std::uint8_t corner[4 * tile_size] = {};
        std::uint32_t found = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const Tet& tet = tets_[items[i].tet];
            for (std::uint32_t c = 0; c < 4; ++c) {
                const std::uint32_t v = tet.v[c];
                if (seen_[v] >> 6 != stamp_) {
                    if (found == tile_size) return false;
                    seen_[v] = stamp_ << 6 | found;
                    list[found++] = v;
                }
                const std::uint32_t local = seen_[v] & 63;
                corner[c * tile_size + i] = static_cast<std::uint8_t>(local);
                own[local] |= std::uint64_t{1} << i;
            }
        }
        Tile tile{};
        tile.first_tet = static_cast<std::uint32_t>(out_.tets.size());
        tile.first_vertex = static_cast<std::uint32_t>(out_.vertices.size());
        tile.tet_count = static_cast<std::uint8_t>(count);
        tile.vertex_count = static_cast<std::uint8_t>(found);
        for (std::uint32_t i = 0; i < found; ++i) tile.holds_last_vertex |= list[i] == vertex_count_ - 1;
        for (std::uint32_t i = 0; i < count; ++i) out_.tets.push_back(items[i].tet);
        out_.vertices.insert(out_.vertices.end(), list, list + found);
        out_.own.insert(out_.own.end(), own, own + found);
        while (out_.vertices.size() % 4) {
            out_.vertices.push_back(list[found - 1]);
            out_.own.push_back(own[found - 1]);
        }
        out_.corners.insert(out_.corners.end(), corner, corner + 4 * tile_size);
        out_.tiles.push_back(tile);
        return true;
    }

    std::span<const Tet> tets_;
    std::uint32_t vertex_count_;
    Tiles& out_;
    Array<std::uint32_t> seen_;
    std::uint32_t stamp_ = 0;
};

void list_blocks(std::uint32_t vertex_count, Tiles& out) {
    std::pmr::memory_resource* memory = out.tiles.memory();
    Array<std::uint32_t> seen(out.block_count(), 0, memory), block_of(vertex_count, memory);
    for (std::uint32_t b = 0; b < out.block_count(); ++b)
        std::fill(block_of.begin() + out.block_first[b], block_of.begin() + out.block_first[b + 1], b);
    const std::uint32_t super_tiles = out.super_tile_count();
    out.blocks.reserve(super_tiles);
    for (std::uint32_t s = 0; s < super_tiles; ++s) {
        out.blocks.begin_list();
        for (std::uint32_t t = out.super_first[s]; t < out.super_first[s + 1]; ++t) {
            const Tile& tile = out.tiles[t];
            for (std::uint32_t i = 0; i < tile.vertex_count; ++i) {
                const std::uint32_t block = block_of[out.vertices[tile.first_vertex + i]];
                if (seen[block] == s + 1) continue;
                seen[block] = s + 1;
                out.blocks.push(block);
            }
        }
        const std::span<std::uint32_t> blocks = out.blocks[s];
        std::sort(blocks.begin(), blocks.end());
    }
}

} // namespace

namespace {

// Cuts the vertices into blocks: at eight, and earlier where the numbering jumps (from the end of a row of a
// lattice to the start of the next, say), so that the box of a block is no larger than it must be.
// at(v) is the position of a vertex.
template <class At>
void cut_blocks(std::uint32_t vertex_count, Tiles& out, At&& at) {
    const auto distance = [&](std::uint32_t v) { // squared, from the vertex before
        const Vec3f p = at(v - 1), q = at(v);
        const float x = p.x - q.x, y = p.y - q.y, z = p.z - q.z;
        return x * x + y * y + z * z;
    };
    std::array<float, 256> sample{};
    const std::uint32_t samples = std::min(vertex_count - 1, 256u);
    for (std::uint32_t i = 0; i < samples; ++i) {
        const float d =
            distance(1 + static_cast<std::uint32_t>(std::uint64_t{vertex_count - 1} * i / samples));
        sample[i] = d < float_infinity ? d : float_infinity;
    }
    std::nth_element(sample.begin(), sample.begin() + samples / 2, sample.begin() + samples);
    const float far = 25 * sample[samples / 2]; // five times the median distance
    out.block_first.reserve(vertex_count / (block_size - 4) + 2);
    for (std::uint32_t first = 0; first < vertex_count; first = out.block_first.back()) {
        std::uint32_t end = std::min(first + block_size, vertex_count), is_far = 0;
        for (std::uint32_t v = first + 1; v < end; ++v)
            is_far |= distance(v) > far; // seldom: without a branch
        if (is_far) {
            std::uint32_t v = first + 1;
            while (!(distance(v) > far)) ++v;
            end = v;
        }
        out.block_first.push_back(end);
    }
    out.block_first.shrink_to_fit();
}

} // namespace

void cut_blocks(std::uint32_t vertex_count, Positions positions, Tiles& out) {
    out.block_first.assign(1, 0);
    if (vertex_count <= block_size) return out.block_first.push_back(vertex_count);
    if (positions.rounded())
        cut_blocks(vertex_count, out, [&](std::size_t v) { return seen_from_first(positions, v); });
    else
        cut_blocks(vertex_count, out, [&](std::size_t v) { return positions.floats(v); });
}

void make_tiles(std::span<const Tet> tets, std::uint32_t vertex_count, Positions positions, Tiles& out,
                std::span<const std::uint64_t> off) {
    std::pmr::memory_resource* memory = out.tiles.memory();
    Tiles made(memory);
    if (vertex_count == 0) { // and so no tets: nothing to allocate for
        out = std::move(made);
        return;
    }
    made.super_first.push_back(0);
    if (!tets.empty()) {
        Array<Item> items(memory);
        items.reserve(2 * tets.size());
        for (std::size_t t = 0; t < tets.size(); ++t) {
            if (has_bit(off, t)) continue;
            float sum[3] = {0, 0, 0};
            for (const std::uint32_t v : tets[t].v) {
                const Vec3f p = seen_from_first(positions, v);
                sum[0] += p.x;
                sum[1] += p.y;
                sum[2] += p.z;
            }
            Item& item = items.emplace_back();
            for (int a = 0; a < 3; ++a) item.centroid[a] = std::isfinite(sum[a]) ? sum[a] : 0.0f;
            item.tet = static_cast<std::uint32_t>(t);
        }
        const std::size_t tiles = items.size() / 56 + 2;
        made.tiles.reserve(tiles);
        made.corners.reserve(tiles * 4 * tile_size);
        made.tets.reserve(items.size());
        made.vertices.reserve(tiles * 36);
        made.own.reserve(tiles * 36);
        if (!items.empty()) {
            const std::size_t count = items.size();
            items.resize(2 * count);
            Splitter(tets, vertex_count, made)
                .split(items.data(), items.data() + count, static_cast<std::uint32_t>(count));
        }
    }
    cut_blocks(vertex_count, positions, made);
    list_blocks(vertex_count, made);
    made.tiles.shrink_to_fit();
    made.corners.shrink_to_fit();
    made.vertices.shrink_to_fit();
    made.own.shrink_to_fit();
    made.blocks.shrink_to_fit();
    out = std::move(made);
}

} // namespace vox
