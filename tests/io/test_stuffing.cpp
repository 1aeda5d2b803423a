// Isosurface stuffing of lattices whose nodes are inside or outside at random and whose edges are cut
// anywhere: the bounds on the angles hold for all of them, whatever body they may belong to. Coarsening among
// them.
#include "io/solids/stuff.hpp"

#include "support/suite.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>

using namespace vox::io;

namespace {

using Vector = std::array<double, 3>;

Vector minus(const double* a, const double* b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Facts {
    double least = 180, most = 0, volume = 0;
};

Facts check(const MeshData& mesh) {
    Facts facts;
    std::map<std::array<std::uint32_t, 3>, int> facets;
    for (std::size_t t = 0; t < mesh.tets.size(); t += 4) {
        std::array<const double*, 4> p{};
        for (std::size_t k = 0; k < 4; ++k) p[k] = &mesh.positions[3 * std::size_t{mesh.tets[t + k]}];
        const double volume = dot(minus(p[1], p[0]), cross(minus(p[2], p[0]), minus(p[3], p[0]))) / 6;
        ck_assert_msg(volume > 0, "tet %zu has volume %g", t / 4, volume);
        facts.volume += volume;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i + 1; j < 4; ++j) {
                std::size_t k = 0;
                while (k == i || k == j) ++k;
                const std::size_t l = 6 - i - j - k;
                const Vector edge = minus(p[j], p[i]);
                const Vector m = cross(edge, minus(p[k], p[i])), n = cross(edge, minus(p[l], p[i]));
                const double cosine = std::clamp(dot(m, n) / std::sqrt(dot(m, m) * dot(n, n)), -1.0, 1.0);
                const double angle = std::acos(cosine) * 180 / 3.14159265358979323846;
                facts.least = std::min(facts.least, angle);
                facts.most = std::max(facts.most, angle);
            }
        for (std::size_t k = 0; k < 4; ++k) {
            std::array<std::uint32_t, 3> facet{};
            for (std::size_t i = 0, n = 0; i < 4; ++i)
                if (i != k) facet[n++] = mesh.tets[t + i];
            std::sort(facet.begin(), facet.end());
            ++facets[facet];
        }
    }
    std::map<std::array<std::uint32_t, 2>, int> edges; // of the boundary
    for (const auto& [facet, tets] : facets) {
        ck_assert_int_le(tets, 2);
        if (tets == 2) continue;
        ++edges[{facet[0], facet[1]}];
        ++edges[{facet[1], facet[2]}];
        ++edges[{facet[0], facet[2]}];
    }
    for (const auto& [edge, count] : edges) ck_assert_int_eq(count % 2, 0);
    return facts;
}

// Numbers in [0, 1) that are the same with every standard library.
struct Random {
    std::mt19937 bits;
    double operator()() { return static_cast<double>(bits()) / 4294967296.0; }
};

// The distances in solid_stuff.cpp: cuts just on either side of them give the extreme shapes.
double extreme(Random& random, unsigned neighbour) {
    const double alpha = neighbour < long_neighbours ? 0.26 : 0.38;
    const double kind = random(), aside = random() < 0.5 ? 1e-9 : -1e-9;
    if (kind < 0.2) return random();
    return kind < 0.6 ? alpha + aside : 1 - alpha - aside;
}

SolidShape random_body(Random& random, std::int32_t size, double share) {
    SolidShape body;
    const double s = size;
    body.frame = make_frame({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(s, s, s)}, 1);
    std::vector<Run> runs;
    for (std::int32_t parity = 0; parity < 2; ++parity)
        for (std::int32_t z = 2; z < size + 2; ++z)
            for (std::int32_t y = 2; y < size + 2; ++y)
                for (std::int32_t x = 2; x < size + 2; ++x)
                    if (random() < share) runs.push_back({2 * y + parity, 2 * z + parity, x, x});
    body.inside = NodeSet(body.frame, runs);
    body.leaves = [&random](const Node&, unsigned neighbour) { return extreme(random, neighbour); };
    return body;
}

START_TEST(random_lattices) {
    Random random{std::mt19937(static_cast<std::mt19937::result_type>(_i + 1))};
    const std::array<double, 4> shares = {0.1, 0.3, 0.5, 0.8};
    const SolidShape body = random_body(random, 10, shares[static_cast<std::size_t>(_i % 4)]);
    const MeshData mesh = stuff(body, 0, VOX_MAX_TETS, vox::io::Progress());
    ck_assert(!mesh.tets.empty());
    const Facts facts = check(mesh);
    // What a search over the extreme configurations gave, tighter than the paper's 10.78 and 164.74.
    ck_assert_double_ge(facts.least, 11.59);
    ck_assert_double_le(facts.most, 159.25);
}
END_TEST

// A solid block with a few nodes knocked out: the octree's levels end around them.
START_TEST(coarse_inside) {
    Random random{std::mt19937(static_cast<std::mt19937::result_type>(_i + 1))};
    SolidShape body = random_body(random, 22, _i == 0 ? 1 : 0.9995);
    body.leaves = [](const Node&, unsigned) { return 0.5; };
    const Facts fine = check(stuff(body, 0, VOX_MAX_TETS, Progress()));
    std::size_t before = SIZE_MAX;
    for (const std::uint32_t levels : {0u, 1u, 2u, 8u}) {
        const MeshData mesh = stuff(body, levels, VOX_MAX_TETS, Progress());
        const Facts facts = check(mesh);
        ck_assert_double_eq_tol(facts.volume, fine.volume, 1e-9 * fine.volume);
        ck_assert_double_ge(facts.least, fine.least < 45 ? fine.least - 1e-9 : 45 - 1e-9);
        ck_assert_double_le(facts.most, fine.most > 120 ? fine.most + 1e-9 : 120 + 1e-9);
        ck_assert_uint_le(mesh.tets.size(), before);
        if (levels <= 1) ck_assert_uint_lt(mesh.tets.size(), before);
        before = mesh.tets.size();
        // The outermost cells stay as they are.
        if (_i == 0 && levels == 2)
            ck_assert_double_lt(3.0 * static_cast<double>(mesh.tets.size()), 2.9 * 12 * 4 * 22 * 22 * 22);
    }
}
END_TEST

} // namespace

SUITE(stuffing) {
    TCase* tests = add_case(suite, "stuffing");
    tcase_add_loop_test(tests, random_lattices, 0, 24);
    tcase_add_loop_test(tests, coarse_inside, 0, 4);
}
