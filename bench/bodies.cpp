// The body-centred cubic lattice: around every face between two cubes, four tetrahedra that share the edge
// between the cubes' centres (e.g. Labelle, Shewchuk, "Isosurface stuffing", SIGGRAPH 2007, Sect. 2). All
// of them are congruent and none is closer than 0.7 to being flat, so that jitter up to 0.1 inverts none.
#include "bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#if defined(BENCH_IO)
#include <vox/vox_io.h>
#endif

namespace bench {
namespace {

constexpr std::size_t inner_degree = 24; // tetrahedra around a vertex that is not on the boundary

// For every vertex the tetrahedra around it: those of vertex v are of[first[v]] .. of[first[v + 1] - 1].
struct Incidence {
    std::vector<std::size_t> first;
    std::vector<std::size_t> of;

    explicit Incidence(const Solid& solid) : first(solid.positions.size() + 1), of(solid.tets.size()) {
        for (std::uint32_t v : solid.tets) ++first[v + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<std::size_t> next(first.begin(), first.end() - 1);
        for (std::size_t i = 0; i < solid.tets.size(); ++i) of[next[solid.tets[i]]++] = i / 4;
    }
    std::size_t degree(std::size_t v) const { return first[v + 1] - first[v]; }
};

} // namespace

std::uint64_t Random::bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double Random::uniform() { return std::ldexp(static_cast<double>(bits() >> 11), -52) - 1; }

double signed_volume(const Solid& solid, std::size_t tet) {
    const auto corner = [&](std::size_t i) { return solid.positions[solid.tets[4 * tet + i]]; };
    const Vec3 a = corner(0), b = corner(1), c = corner(2), d = corner(3);
    const Vec3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z},
        w{d.x - a.x, d.y - a.y, d.z - a.z};
    return (u.x * (v.y * w.z - v.z * w.y) - u.y * (v.x * w.z - v.z * w.x) + u.z * (v.x * w.y - v.y * w.x)) /
           6;
}

Solid lattice_solid(int nx, int ny, int nz, const std::function<bool(const Vec3&)>& keep, double jitter,
                    std::uint64_t seed) {
    // Half-integer coordinates: corners have three even ones, centres three odd ones. Numbers go with the
    // scan.
    const int size[3] = {2 * nx + 1, 2 * ny + 1, 2 * nz + 1};
    using Point = std::array<int, 3>;
    const auto index = [&](const Point& p) {
        return (static_cast<std::size_t>(p[2]) * static_cast<std::size_t>(size[1]) +
                static_cast<std::size_t>(p[1])) *
                   static_cast<std::size_t>(size[0]) +
               static_cast<std::size_t>(p[0]);
    };
    std::vector<Point> corners; // four of each tetrahedron
    Point centre;
    for (centre[2] = 1; centre[2] < size[2]; centre[2] += 2)
        for (centre[1] = 1; centre[1] < size[1]; centre[1] += 2)
            for (centre[0] = 1; centre[0] < size[0]; centre[0] += 2)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    Point other = centre;
                    other[axis] += 2;
                    if (other[axis] >= size[axis]) continue;
                    constexpr int around[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
                    const auto face_corner = [&](int i) {
                        Point p = centre;
                        p[axis] += 1;
                        p[(axis + 1) % 3] += around[i % 4][0];
                        p[(axis + 2) % 3] += around[i % 4][1];
                        return p;
                    };
                    for (int i = 0; i < 4; ++i) {
                        const Point tet[4] = {centre, other, face_corner(i), face_corner(i + 1)};
                        double sum[3] = {0, 0, 0};
                        for (const Point& p : tet)
                            for (std::size_t k = 0; k < 3; ++k) sum[k] += p[k];
                        if (keep({sum[0] / 8, sum[1] / 8, sum[2] / 8}))
                            corners.insert(corners.end(), tet, tet + 4);
                    }
                }

    std::vector<std::uint32_t> number(index({size[0] - 1, size[1] - 1, size[2] - 1}) + 1, 0);
    for (const Point& p : corners) number[index(p)] = 1;
    Solid solid;
    Point p;
    for (p[2] = 0; p[2] < size[2]; ++p[2])
        for (p[1] = 0; p[1] < size[1]; ++p[1])
            for (p[0] = 0; p[0] < size[0]; ++p[0]) {
                std::uint32_t& n = number[index(p)];
                if (n == 0) continue;
                n = static_cast<std::uint32_t>(solid.positions.size());
                solid.positions.push_back({p[0] / 2.0, p[1] / 2.0, p[2] / 2.0});
            }
    solid.tets.reserve(corners.size());
    for (const Point& corner : corners) solid.tets.push_back(number[index(corner)]);

    Random random(seed);
    for (Vec3& x : solid.positions)
        x = {x.x + jitter * random.uniform(), x.y + jitter * random.uniform(),
             x.z + jitter * random.uniform()};
    return solid;
}

double ball_radius(double tets) { return std::cbrt(tets / 12 * 3 / (4 * std::numbers::pi)); }

Solid lattice_ball(double tets, std::uint64_t seed) {
    const double radius = ball_radius(tets);
    const int n = 2 * static_cast<int>(std::ceil(radius + 1));
    const double c = n / 2.0;
    const auto inside = [&](const Vec3& p) { return std::hypot(p.x - c, p.y - c, p.z - c) < radius; };
    Solid ball = lattice_solid(n, n, n, inside, 0.1, seed);
    for (Vec3& p : ball.positions) p = {p.x - c, p.y - c, p.z - c};

    // Move boundary vertices onto the sphere as far as no tetrahedron around them gets too flat.
    constexpr double least_volume = 0.25 / 12;
    const Incidence incidence(ball);
    for (std::size_t v = 0; v < ball.positions.size(); ++v) {
        if (incidence.degree(v) == inner_degree) continue;
        const Vec3 start = ball.positions[v];
        const double factor = radius / std::hypot(start.x, start.y, start.z) - 1;
        for (double part : {1.0, 0.75, 0.5, 0.25, 0.0}) {
            const double s = 1 + part * factor;
            ball.positions[v] = {s * start.x, s * start.y, s * start.z};
            const auto* first = incidence.of.data() + incidence.first[v];
            if (std::all_of(first, first + incidence.degree(v),
                            [&](std::size_t tet) { return signed_volume(ball, tet) > least_volume; }))
                break;
        }
    }
    return ball;
}

#if defined(BENCH_IO)
Solid read_solid(const std::string& path) {
    vox_io_mesh* mesh = nullptr;
    vox_io_mesh_view view;
    if (vox_io_load(path.c_str(), nullptr, &mesh) != VOX_OK || vox_io_mesh_get(mesh, &view) != VOX_OK)
        throw std::runtime_error(vox_last_error());
    Solid solid;
    for (std::uint64_t v = 0; v < view.vertex_count; ++v)
        solid.positions.push_back(
            {view.positions[3 * v], view.positions[3 * v + 1], view.positions[3 * v + 2]});
    solid.tets.assign(view.tets, view.tets + 4 * view.tet_count);
    vox_io_mesh_destroy(mesh);
    return solid;
}
#else
Solid read_solid(const std::string& path) {
    throw std::runtime_error("this build has no mesh readers (VOX_BUILD_IO=OFF): cannot read " + path);
}
#endif

void shuffle(Solid& solid, std::uint64_t seed) {
    Random random(seed);
    const auto permutation = [&](std::size_t count) {
        std::vector<std::uint32_t> order(count);
        std::iota(order.begin(), order.end(), 0u);
        for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.bits() % i]);
        return order;
    };
    const std::vector<std::uint32_t> vertex = permutation(solid.positions.size());
    const std::vector<std::uint32_t> tet = permutation(solid.tets.size() / 4);
    Solid shuffled = solid;
    for (std::size_t v = 0; v < vertex.size(); ++v) shuffled.positions[vertex[v]] = solid.positions[v];
    for (std::size_t t = 0; t < tet.size(); ++t)
        for (std::size_t k = 0; k < 4; ++k) shuffled.tets[4 * tet[t] + k] = vertex[solid.tets[4 * t + k]];
    solid = std::move(shuffled);
}

} // namespace bench
