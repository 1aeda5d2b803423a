// Bodies of cubes on a lattice, so that many vertices lie exactly on facets, edges and corners of others, and
// their partition among ranks.
#pragma once

#include <vox/vox_dist.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

namespace scenes {

using Random = std::mt19937_64;
inline std::uint32_t below(Random& random, std::uint32_t count) {
    return static_cast<std::uint32_t>(random() % count);
}

struct Body {
    std::uint64_t number = 0;
    bool doubles = false;
    vox_filter filter{};
    std::vector<double> xyz;
    std::vector<std::uint32_t> tets;
    std::size_t vertices() const { return xyz.size() / 3; }
    std::size_t tet_count() const { return tets.size() / 4; }
};
using Scene = std::vector<Body>;

// n[0] * n[1] * n[2] cubes of 6 tets each.
inline Body block(const std::uint32_t n[3], const double origin[3], double size) {
    Body body;
    const auto at = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return (z * (n[1] + 1) + y) * (n[0] + 1) + x;
    };
    for (std::uint32_t z = 0; z <= n[2]; ++z)
        for (std::uint32_t y = 0; y <= n[1]; ++y)
            for (std::uint32_t x = 0; x <= n[0]; ++x)
                body.xyz.insert(body.xyz.end(),
                                {origin[0] + size * x, origin[1] + size * y, origin[2] + size * z});
    static constexpr int paths[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};
    for (std::uint32_t z = 0; z < n[2]; ++z)
        for (std::uint32_t y = 0; y < n[1]; ++y)
            for (std::uint32_t x = 0; x < n[0]; ++x)
                for (const auto& path : paths) {
                    std::uint32_t c[3] = {x, y, z};
                    body.tets.push_back(at(c[0], c[1], c[2]));
                    for (const int axis : path) {
                        ++c[axis];
                        body.tets.push_back(at(c[0], c[1], c[2]));
                    }
                    body.tets.push_back(at(x + 1, y + 1, z + 1));
                }
    return body;
}

// A few bodies on multiples of 1/2: all kinds of touching, some folded into themselves, some of points alone.
inline Scene lattice(std::uint64_t seed) {
    Random random(seed);
    Scene scene;
    const std::uint32_t count = 1 + below(random, 4);
    for (std::uint32_t b = 0; b < count; ++b) {
        const std::uint32_t n[3] = {1 + below(random, 3), 1 + below(random, 3), 1 + below(random, 2)};
        const double origin[3] = {below(random, 5) / 2.0, below(random, 5) / 2.0, below(random, 5) / 2.0};
        Body body = block(n, origin, below(random, 3) ? 1 : 0.5);
        body.number = std::uint64_t{1} << 40 | (count - b) * 7u;
        body.doubles = below(random, 2) != 0;
        body.filter.flags = below(random, 2) ? std::uint32_t{VOX_FILTER_SELF_COLLISION} : 0u;
        body.filter.world = below(random, 8) == 0;
        if (below(random, 4) == 0) body.filter.group = static_cast<std::int32_t>(below(random, 3)) - 1;
        if (below(random, 6) == 0) body.filter.category = 2, body.filter.mask = below(random, 2) ? 1 : 3;
        if (below(random, 3) == 0) // folded
            for (int swaps = 0; swaps < 3; ++swaps) {
                const auto v = below(random, static_cast<std::uint32_t>(body.vertices()));
                for (unsigned axis = 0; axis < 3; ++axis)
                    body.xyz[3 * v + axis] += below(random, 5) / 2.0 - 1;
            }
        if (below(random, 4) == 0) // nothing exact
            for (double& number : body.xyz)
                number = static_cast<float>(number + static_cast<double>(below(random, 1000)) / 9973);
        if (below(random, 8) == 0) body.tets.clear();
        if (below(random, 4) == 0 && !body.tets.empty()) { // the first one twice, and one more across a facet
            const auto last = static_cast<std::uint32_t>(body.vertices() - 1);
            const auto v = std::to_array({body.tets[0], body.tets[1], body.tets[2], body.tets[3]});
            body.tets.insert(body.tets.end(), v.begin(), v.end());
            if (v[3] != last) body.tets.insert(body.tets.end(), {v[0], v[2], v[1], last});
        }
        scene.push_back(std::move(body));
    }
    return scene;
}

enum class Cut { rcb, stripes, random, one, empty_ranks, count };

// The rank of each tetrahedron of a body.
inline std::vector<std::uint32_t> cut(const Body& body, std::uint32_t size, Cut how, Random& random) {
    std::vector<std::uint32_t> ranks(body.tet_count());
    std::vector<std::uint32_t> order(ranks.size());
    for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = t;
    const auto middle = [&](std::uint32_t t, unsigned axis) {
        double sum = 0;
        for (unsigned c = 0; c < 4; ++c) sum += body.xyz[3 * body.tets[4 * t + c] + axis];
        return sum;
    };
    const auto bisect = [&](auto&& self, std::size_t begin, std::size_t end, std::uint32_t first,
                            std::uint32_t last, unsigned axis) -> void {
        if (last - first <= 1) {
            for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = first;
            return;
        }
        const std::size_t half = begin + (end - begin) / 2;
        std::nth_element(order.data() + begin, order.data() + half, order.data() + end,
                         [&](std::uint32_t a, std::uint32_t b) { return middle(a, axis) < middle(b, axis); });
        const std::uint32_t mid = first + (last - first) / 2;
        self(self, begin, half, first, mid, (axis + 1) % 3);
        self(self, half, end, mid, last, (axis + 1) % 3);
    };
    const std::uint32_t only = below(random, size);
    for (std::uint32_t t = 0; t < ranks.size(); ++t) switch (how) {
        case Cut::stripes:
            ranks[t] = t % size;
            break;
        case Cut::random:
            ranks[t] = below(random, size);
            break;
        case Cut::empty_ranks:
            ranks[t] = below(random, size) / 2 * 2;
            break;
        default:
            ranks[t] = only;
        }
    if (how == Cut::rcb && !ranks.empty()) bisect(bisect, 0, ranks.size(), 0, size, 0);
    return ranks;
}

// What one rank has of a body.
struct Share {
    std::vector<std::uint64_t> vertex_ids, tet_ids;
    std::vector<std::uint8_t> owned;
    std::vector<std::uint32_t> tets;
    std::vector<double> xyz;
    std::vector<float> floats;
};

// One share a rank. The owner of a vertex is a random rank of those that have it; of one in no tetrahedron
// any rank.
inline std::vector<Share> shares(const Body& body, const std::vector<std::uint32_t>& ranks,
                                 std::uint32_t size, Random& random) {
    std::vector<Share> all(size);
    std::vector<std::vector<std::uint32_t>> on(body.vertices());
    for (std::size_t t = 0; t < ranks.size(); ++t)
        for (unsigned c = 0; c < 4; ++c) on[body.tets[4 * t + c]].push_back(ranks[t]);
    for (std::uint32_t i = static_cast<std::uint32_t>(body.vertices()); i-- > 0;) {
        auto& of = on[i];
        std::sort(of.begin(), of.end());
        of.erase(std::unique(of.begin(), of.end()), of.end());
        if (of.empty()) of.push_back(below(random, size));
        const std::uint32_t owner = of[below(random, static_cast<std::uint32_t>(of.size()))];
        for (const std::uint32_t rank : of) {
            Share& share = all[rank];
            share.vertex_ids.push_back(i);
            share.owned.push_back(rank == owner);
            for (unsigned axis = 0; axis < 3; ++axis) {
                share.xyz.push_back(body.xyz[3 * i + axis]);
                share.floats.push_back(static_cast<float>(body.xyz[3 * i + axis]));
            }
        }
    }
    std::vector<std::uint32_t> order(ranks.size());
    for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = t;
    std::shuffle(order.begin(), order.end(), random);
    for (const std::uint32_t t : order) {
        Share& share = all[ranks[t]];
        share.tet_ids.push_back(t);
        for (unsigned c = 0; c < 4; ++c) { // vertex_ids descend
            const auto place = std::lower_bound(share.vertex_ids.begin(), share.vertex_ids.end(),
                                                std::uint64_t{body.tets[4 * t + c]}, std::greater<>());
            share.tets.push_back(static_cast<std::uint32_t>(place - share.vertex_ids.begin()));
        }
    }
    return all;
}

} // namespace scenes
