// Surgery: a blunt instrument presses on tissue, a hand feels it through a proxy, a needle goes through it,
// and a blade cuts it along a plane. Lengths are millimetres, and masses and stiffnesses 1, to keep it short.
#include "scenes/bodies.h"
#include "scenes/solids.h"

#include <algorithm>
#include <cstdio>
#include <vox/vox_query.hpp>

namespace {

using vec = std::array<double, 3>;
using tet = std::array<std::uint32_t, 4>;

vec operator+(const vec& a, const vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
vec operator-(const vec& a, const vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
vec operator*(double s, const vec& a) { return {s * a[0], s * a[1], s * a[2]}; }
double length(const vec& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

constexpr std::size_t edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr double wide = 16, deep = 8, high = 4; // of the tissue
constexpr double tip_radius = 2;

// Tetrahedra whose edges are springs. Both ends are held, and it is stretched, as skin is.
struct tissue {
    std::vector<vec> x, v, force;
    std::vector<std::uint8_t> held;
    std::vector<tet> tets;
    std::vector<std::array<double, 6>> rest_lengths;

    tissue() {
        body block = make_block(&five_cut, std::uint32_t(wide), std::uint32_t(deep), std::uint32_t(high));
        for (std::uint32_t i = 0; i < block.vertex_count; ++i) {
            const float* p = block.positions + 3 * i;
            x.push_back({p[0], p[1], p[2]});
            held.push_back(p[0] == 0 || p[0] == wide);
        }
        for (std::uint32_t t = 0; t < block.tet_count; ++t) {
            const std::uint32_t* c = block.tets + 4 * t;
            tets.push_back({c[0], c[1], c[2], c[3]});
            rest_lengths.emplace_back();
            for (std::size_t e = 0; e < 6; ++e)
                rest_lengths[t][e] = 0.9 * length(x[c[edges[e][1]]] - x[c[edges[e][0]]]);
        }
        free_body(&block);
        v.resize(x.size());
        force.resize(x.size());
    }

    // Adds the springs' forces, moves the vertices, and forgets the forces.
    void move() {
        for (std::size_t t = 0; t < tets.size(); ++t)
            for (std::size_t e = 0; e < 6; ++e) {
                const std::uint32_t a = tets[t][edges[e][0]], b = tets[t][edges[e][1]];
                const vec along = x[b] - x[a];
                const vec pull = (1 - rest_lengths[t][e] / length(along)) * along;
                force[a] = force[a] + pull;
                force[b] = force[b] - pull;
            }
        constexpr double time_step = 0.1, kept = 0.9; // of the speed: it comes to rest soon
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (!held[i]) {
                v[i] = kept * (v[i] + time_step * force[i]);
                x[i] = x[i] + time_step * v[i];
            }
            force[i] = {};
        }
    }
};

// Contacts become forces: in proportion to the depth, by the constraints' weights. Returns what the hand that
// holds the instrument feels.
vec push(const vox::grid& grid, vox_body body, tissue& t) {
    constexpr double stiffness = 20;
    vec felt{};
    for (const vox_constraint& c : grid.constraints())
        for (std::uint32_t i = 0; i < c.count; ++i) {
            const vec f = -stiffness * c.gap * c.weights[i] * vec{c.normal[0], c.normal[1], c.normal[2]};
            vec& sum = (i < c.count_a ? c.body_a : c.body_b) == body ? t.force[c.vertices[i]] : felt;
            sum = sum + f;
        }
    return felt;
}

// A haptic device: the hand may be inside the tissue, the proxy stays on its surface, and a spring between
// them is felt. The proxy follows in small steps, so it leaves where it came in, however deep the hand is.
// Another thread may do this a thousand times a second: a locator never changes.
void follow(const vox::locator& locator, const vec& hand, vec& proxy) {
    constexpr double most = 0.2;
    const vec way = hand - proxy;
    proxy = proxy + std::min(1.0, most / std::max(length(way), most)) * way;
    const vox_closest_hit hit = locator.find_closest(std::array{proxy})[0];
    if (hit.distance < 0) proxy = {hit.position[0], hit.position[1], hit.position[2]};
}

// Cuts along x = plane, down to z = bottom. Facets between a tetrahedron on the left and one on the right
// open. Around each vertex, tetrahedra that still hang together by facets stay together; each further part
// gets a copy of the vertex. Returns the number of copies.
std::size_t cut(vox::grid& grid, vox_body body, tissue& t, double plane, double bottom) {
    const auto is_left = [&](const tet& c) {
        return t.x[c[0]][0] + t.x[c[1]][0] + t.x[c[2]][0] + t.x[c[3]][0] < 4 * plane;
    };
    const auto hang_together = [&](const tet& a, const tet& b) {
        int common = 0;
        double height = 0;
        for (std::uint32_t corner : a)
            if (std::find(b.begin(), b.end(), corner) != b.end()) ++common, height += t.x[corner][2] / 3;
        return common == 3 && (is_left(a) == is_left(b) || height < bottom);
    };
    std::vector<std::vector<std::uint32_t>> around(t.x.size());
    for (std::uint32_t i = 0; i < t.tets.size(); ++i)
        for (std::uint32_t corner : t.tets[i]) around[corner].push_back(i);

    std::vector<tet> after = t.tets;
    std::vector<std::uint32_t> copies_of;
    for (std::uint32_t vertex = 0; vertex < around.size(); ++vertex) {
        std::vector<std::uint32_t>& left_over = around[vertex];
        for (bool first = true; !left_over.empty(); first = false) {
            std::vector<std::uint32_t> part = {left_over.front()};
            left_over.erase(left_over.begin());
            for (std::size_t i = 0; i < part.size(); ++i)
                for (std::size_t k = left_over.size(); k-- > 0;)
                    if (hang_together(t.tets[part[i]], t.tets[left_over[k]])) {
                        part.push_back(left_over[k]);
                        left_over.erase(left_over.begin() + std::ptrdiff_t(k));
                    }
            if (first) continue; // it keeps the vertex
            const std::uint32_t copy = std::uint32_t(t.x.size() + copies_of.size());
            copies_of.push_back(vertex);
            for (std::uint32_t i : part) std::replace(after[i].begin(), after[i].end(), vertex, copy);
        }
    }
    std::vector<std::uint32_t> changed;
    std::vector<tet> corners;
    for (std::uint32_t i = 0; i < after.size(); ++i)
        if (after[i] != t.tets[i]) {
            changed.push_back(i);
            corners.push_back(after[i]);
        }
    for (std::uint32_t vertex : copies_of) {
        t.x.push_back(vec(t.x[vertex]));
        t.v.push_back(vec(t.v[vertex]));
        t.held.push_back(std::uint8_t(t.held[vertex]));
    }
    t.force.resize(t.x.size());
    t.tets = after;

    vox_vertices_desc copies = vox_default_vertices_desc();
    copies.count = copies_of.size();
    copies.copies_of = copies_of.data();
    copies.positions = vox::points(t.x); // the array has grown, and may be somewhere else
    grid.append_vertices(body, copies);
    grid.replace_tets(body, changed, corners);
    return copies_of.size();
}

} // namespace

int main() try {
    tissue t;
    solid tip = make_lattice_solid(6, 6, 6, tip_radius, 0, 1); // a ball around (3, 3, 3)
    for (std::uint32_t i = 0; i < 3 * tip.vertex_count; ++i) tip.positions[i] -= 3;
    round_solid(&tip, tip_radius);

    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags = VOX_GRID_CONSTRAINTS;
    vox::grid grid(desc);
    const vox_body body = grid.insert(t.x, t.tets);
    const vox_body instrument =
        grid.insert(vox_mesh_desc_doubles(tip.positions, tip.vertex_count, tip.tets, tip.tet_count));
    std::printf("tissue of %zu tets, an instrument of %u\n", t.tets.size(), tip.tet_count);

    // The instrument is rigid: a transform moves it. Positions of the tissue are borrowed.
    vec felt{};
    const auto run = [&](int frames, double tip_height) {
        grid.set_transform(instrument,
                           {1, 0, 0, wide / 4, 0, 1, 0, deep / 2, 0, 0, 1, tip_height + tip_radius});
        for (int frame = 0; frame < frames; ++frame) {
            grid.step();
            felt = push(grid, body, t);
            t.move();
        }
    };
    for (double depth : {-1.0, 0.5, 1.0, 1.5}) {
        run(150, high - depth);
        std::printf("tip %4.1f below the surface: %3zu contacts, force %.2f\n", depth, grid.contacts().size(),
                    felt[2]);
    }
    run(150, 2 * high); // away

    vox::locator locator(grid);
    vec proxy = {wide / 2, deep / 2, high + 1}, hand = proxy;
    for (int tick = 0; tick < 40; ++tick) {
        hand[2] -= 0.1;
        follow(locator, hand, proxy);
        if (tick % 10 == 9)
            std::printf("hand at %.2f, proxy at %.2f: force %.2f\n", hand[2], proxy[2], length(proxy - hand));
    }

    const vec above = {wide / 2, deep / 2, 2 * high}, below = {wide / 2 + 1, deep / 2, -high};
    for (const vox_ray_hit& hit : locator.find_ray_hits(std::array{above}, std::array{below}))
        std::printf("needle %s at height %.2f\n", hit.side == VOX_SIDE_ENTERS ? "enters" : "leaves",
                    above[2] + hit.t * (below[2] - above[2]));
    for (double bottom : {2.6, 1.9}) {
        const std::size_t copies = cut(grid, body, t, wide / 2, bottom);
        run(300, 2 * high);
        locator.update(grid);
        const vec from = {0, deep / 2, high - 0.5}, to = {wide, deep / 2, high - 0.5};
        std::vector<double> at; // where a line along the tissue leaves one lip, and enters the other
        for (const vox_ray_hit& hit : locator.find_ray_hits(std::array{from}, std::array{to}))
            if (hit.t > 0.25 && hit.t < 0.75) at.push_back(wide * hit.t);
        std::printf("cut: %zu vertices copied, the wound is %.2f wide\n", copies,
                    at.empty() ? 0 : at.back() - at.front());
    }
    free_solid(&tip);
} catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
}
