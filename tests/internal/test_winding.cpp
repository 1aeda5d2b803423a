// The stages of the fast engine that cull self-collision: the surface of a mesh against its definition, and
// the certificate by winding numbers against every vertex in every tet, on bodies folded at random.
#include "internal/stage_checks.hpp"

#include <map>
#include <numeric>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;
using namespace stages;

namespace {

Boundary surface_of(const Mesh& mesh, const Tiles& tiles) {
    Boundary surface(std::pmr::get_default_resource());
    make_boundary(mesh.tets, vertex_count(mesh), view(mesh), tiles, surface);
    return surface;
}

Boundary surface_of(const Mesh& mesh) { return surface_of(mesh, tiles_of(mesh)); }

// ---- components -----------------------------------------------------------------------------------

// Against a flood from each cell that has no number yet.
START_TEST(components_are_what_is_connected) {
    Random r{5};
    fast::Components components(std::pmr::get_default_resource());
    for (int round = 0; round < 400; ++round) {
        const std::uint32_t cells[3] = {1 + r.below(9), 1 + r.below(9), 1 + r.below(9)};
        const std::uint32_t nx = cells[0], ny = cells[1], count = nx * ny * cells[2];
        const std::uint32_t share = r.below(101); // per cent of cells that are wanted
        std::vector<std::uint32_t> values(count);
        for (std::uint32_t& value : values) value = r.below(100) < share ? 7 : r.below(7);
        constexpr std::uint32_t none = ~0u;
        std::vector<std::uint32_t> expected(count, none);
        std::uint32_t expected_count = 0;
        for (std::uint32_t from = 0; from < count; ++from) {
            if (values[from] != 7 || expected[from] != none) continue;
            std::vector<std::uint32_t> stack{from};
            expected[from] = expected_count;
            while (!stack.empty()) {
                const std::uint32_t c = stack.back(), x = c % nx, y = c / nx % ny, z = c / nx / ny;
                stack.pop_back();
                const auto visit = [&](bool is_there, std::uint32_t next) {
                    if (!is_there || values[next] != 7 || expected[next] != none) return;
                    expected[next] = expected_count;
                    stack.push_back(next);
                };
                visit(x > 0, c - 1);
                visit(x + 1 < nx, c + 1);
                visit(y > 0, c - nx);
                visit(y + 1 < ny, c + nx);
                visit(z > 0, c - nx * ny);
                visit(z + 1 < cells[2], c + nx * ny);
            }
            ++expected_count;
        }
        components.find(values.data(), 7, cells);
        ck_assert_uint_eq(components.count, expected_count);
        std::vector<std::uint32_t> found(count, none);
        for (const fast::Components::Run& run : components.runs)
            for (std::uint32_t c = run.first; c < run.end; ++c) found[c] = run.component;
        ck_assert(found == expected);
    }
}
END_TEST

// ---- surface --------------------------------------------------------------------------------------

using Facet = std::array<std::uint32_t, 3>;

// Starting with the lowest vertex, the orientation kept.
Facet turned(Facet f) {
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    return f;
}

int sign_of(const Mesh& mesh, const Tet& tet) {
    std::uint64_t exact_tests = 0;
    return orientation(mesh.positions[tet.v[0]], mesh.positions[tet.v[1]], mesh.positions[tet.v[2]],
                       mesh.positions[tet.v[3]], exact_tests);
}

bool names_a_corner_twice(const Tet& tet) { return std::set<std::uint32_t>(tet.v, tet.v + 4).size() < 4; }

// How often each facet is there, with the tets called negative swapped.
std::map<Facet, int> count_facets(const Mesh& mesh, const std::vector<bool>& negative) {
    static constexpr int facets[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    std::map<Facet, int> count;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const Tet& tet = mesh.tets[t];
        for (const auto& f : facets) {
            if (names_a_corner_twice(tet)) continue;
            Facet facet{tet.v[f[0]], tet.v[f[1]], tet.v[f[2]]};
            if (negative[t]) std::swap(facet[1], facet[2]);
            ++count[turned(facet)];
        }
    }
    return count;
}

// The surface by its definition: the boundary of all tets, where facets of tets on different sides cancel. A
// manifold mesh must be closed; a mesh that has a facet left twice on one side must not be. Tets are on the
// side where they are, or else on the one that was meant. Flat tets are not for this test: a negative one is
// not known exactly.
void check_surface(const Mesh& mesh, const char* name, bool manifold) {
    std::vector<bool> negative, used(mesh.positions.size());
    for (const Tet& tet : mesh.tets) {
        negative.push_back(!names_a_corner_twice(tet) && sign_of(mesh, tet) < 0);
        for (const std::uint32_t v : tet.v) used[v] = used[v] || !names_a_corner_twice(tet);
    }
    bool is_manifold = true;
    for (const auto& [facet, tets] : count_facets(mesh, negative)) is_manifold = is_manifold && tets == 1;
    ck_assert_msg(manifold == is_manifold, "%s: manifold %d", name, is_manifold);

    const Tiles tiles = tiles_of(mesh);
    const Boundary surface = surface_of(mesh, tiles);
    ck_assert_msg(surface.is_closed || !manifold, "%s: not closed", name);
    std::vector<bool> meant(mesh.tets.size());
    for (std::size_t t = 0; surface.is_closed && t < tiles.tiles.size(); ++t)
        for (std::uint32_t i = 0; i < tiles.tiles[t].tet_count; ++i)
            meant[tiles.tets[tiles.tiles[t].first_tet + i]] = surface.mirrored[t] >> i & 1;
    if (manifold) ck_assert(meant == negative);
    const std::map<Facet, int> count = count_facets(mesh, meant);
    std::set<Facet> expected;
    bool left_twice = false;
    for (const auto& [facet, tets] : count) {
        const auto opposite = count.find(turned({facet[0], facet[2], facet[1]}));
        const int left = tets - (opposite == count.end() ? 0 : opposite->second);
        left_twice = left_twice || left > 1;
        if (left > 0) expected.insert(facet);
    }
    ck_assert_msg(!surface.is_closed || !left_twice, "%s: closed, with a facet left twice", name);
    if (!surface.is_closed) {
        ck_assert(surface.triangles.empty() && surface.loose.empty());
        ck_assert(surface.mirrored.empty() && surface.ignored.empty());
        return;
    }
    std::set<Facet> found;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges; // there minus back
    for (const Facet& facet : surface.triangles) {
        ck_assert_msg(found.insert(turned(facet)).second, "%s: a triangle twice", name);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = facet[i], b = facet[(i + 1) % 3];
            edges[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    }
    ck_assert_msg(found == expected, "%s: %zu triangles, expected %zu", name, found.size(), expected.size());
    for (const auto& [edge, sum] : edges)
        ck_assert_msg(sum == 0, "%s: edge %u-%u is open", name, edge.first, edge.second);
    std::vector<std::uint32_t> loose;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
        if (!used[v]) loose.push_back(v);
    ck_assert_msg(std::equal(loose.begin(), loose.end(), surface.loose.begin(), surface.loose.end()),
                  "%s: %zu loose vertices, expected %zu", name, surface.loose.size(), loose.size());
    for (std::size_t t = 0; t < tiles.tiles.size(); ++t)
        for (std::uint32_t i = 0; i < tiles.tiles[t].tet_count; ++i) {
            const Tet& tet = mesh.tets[tiles.tets[tiles.tiles[t].first_tet + i]];
            const bool ignored = names_a_corner_twice(tet);
            ck_assert_int_eq(surface.ignored[t] >> i & 1, ignored);
            ck_assert(!ignored || !(surface.mirrored[t] >> i & 1));
        }
}

START_TEST(surface_of_good_meshes) {
    Random r{1};
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.tets = {{{0, 1, 2, 3}}};
    check_surface(mesh, "one tet", true);
    std::swap(mesh.tets[0].v[0], mesh.tets[0].v[1]);
    check_surface(mesh, "one negative tet", true);
    for (const int n : {1, 3, 9}) {
        mesh = block(n, n, n);
        const Boundary surface = surface_of(mesh);
        ck_assert_uint_eq(surface.triangles.size(), 12u * std::uint32_t(n) * std::uint32_t(n));
        double volume = 0; // six times it
        for (const Facet& f : surface.triangles) {
            const Vec3f a = mesh.positions[f[0]], b = mesh.positions[f[1]], c = mesh.positions[f[2]];
            volume += double(a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                             a.z * (b.x * c.y - b.y * c.x));
        }
        ck_assert_double_eq(volume, 6.0 * n * n * n);
        check_surface(mesh, "a block", true);
        jitter(mesh, 0.1, r);
        for (Tet& tet : mesh.tets)
            if (r.below(2)) {
                const std::uint32_t one = r.below(2), other = 2 + r.below(2);
                std::swap(tet.v[one], tet.v[other]);
            }
        renumber(mesh, r);
        check_surface(mesh, "a block of both windings", true);
        for (int i = 0; i < 7; ++i) mesh.positions.push_back({1, 1, 1});
        shuffle(mesh.tets, r);
        mesh.tets.resize(mesh.tets.size() * 2 / 3); // full of holes
        check_surface(mesh, "a sponge", true);
    }
    check_surface(Mesh{}, "nothing", true);
    check_surface(ball(3000), "a ball", true);
}
END_TEST

START_TEST(surface_of_bad_meshes) {
    Random r{2};
    for (int round = 0; round < 40; ++round) {
        Mesh mesh = block(5, 5, 5);
        jitter(mesh, 0.1, r);
        const Tet tet = mesh.tets[r.below(std::uint32_t(mesh.tets.size()))];
        Mesh twice = mesh;
        twice.tets.push_back(tet);
        if (round % 2) std::swap(twice.tets.back().v[1], twice.tets.back().v[2]);
        shuffle(twice.tets, r);
        check_surface(twice, "the same tet twice", false);
        Mesh fin = mesh; // a facet inside gets a third tet
        fin.positions.push_back({r.uniform(-9, -3), r.uniform(-9, 9), r.uniform(-9, 9)});
        Tet more = tet;
        more.v[r.below(4)] = vertex_count(fin) - 1;
        fin.tets.push_back(more);
        int standing_on = 0;
        for (const Tet& other : mesh.tets)
            standing_on +=
                std::count_if(other.v, other.v + 4, [&](std::uint32_t v) { return owns(more, v); }) == 3;
        if (standing_on == 2) check_surface(fin, "three tets at a facet", false);
        Mesh flat = mesh;
        flat.tets.push_back(tet);
        flat.tets.back().v[3] = flat.tets.back().v[r.below(3)];
        check_surface(flat, "a tet with a corner named twice", true);
    }
    for (int round = 0; round < 300; ++round) { // whatever comes
        const std::uint32_t vertices = 5 + r.below(12), tets = 1 + r.below(12);
        const Mesh mesh = soup(r, vertices, tets, 2, false);
        bool closed = true;
        std::map<std::set<std::uint32_t>, std::vector<int>> sides;
        for (const Tet& tet : mesh.tets)
            for (std::uint32_t c = 0; c < 4 && !names_a_corner_twice(tet); ++c) {
                std::set<std::uint32_t> facet(tet.v, tet.v + 4);
                facet.erase(tet.v[c]);
                const auto v = std::vector<std::uint32_t>(facet.begin(), facet.end());
                sides[facet].push_back(sign_of(mesh, {{v[0], v[1], v[2], tet.v[c]}}));
            }
        for (const auto& [facet, s] : sides)
            closed = closed && (s.size() < 2 || (s.size() == 2 && s[0] != s[1]));
        check_surface(mesh, "a soup", closed);
    }
}
END_TEST

// Tets that turned over before the mesh was prepared: the surface is that of the mesh at rest.
START_TEST(surface_of_inverted_tets) {
    Random r{9};
    for (int round = 0; round < 20; ++round) {
        Mesh mesh = block(6, 6, 6);
        jitter(mesh, 0.1, r);
        if (round % 2)
            for (Tet& tet : mesh.tets)
                if (r.below(2)) std::swap(tet.v[1], tet.v[2]);
        if (round % 3 == 1) append(mesh, Mesh(mesh)); // two parts
        if (round % 3 == 2) mesh.tets.resize(mesh.tets.size() - 9);
        const Tiles tiles = tiles_of(mesh);
        const Boundary rest = surface_of(mesh, tiles);
        for (int i = 0; i < 12; ++i) // two edges, through other tets
            mesh.positions[r.below(vertex_count(mesh))].y += 2;
        std::size_t inverted = 0;
        for (std::size_t t = 0; t < tiles.tiles.size(); ++t)
            for (std::uint32_t i = 0; i < tiles.tiles[t].tet_count; ++i)
                inverted += (sign_of(mesh, mesh.tets[tiles.tets[tiles.tiles[t].first_tet + i]]) < 0) !=
                            bool(rest.mirrored[t] >> i & 1);
        ck_assert_uint_gt(inverted, 0);
        const Boundary surface = surface_of(mesh, tiles);
        ck_assert(rest.is_closed && surface.is_closed);
        ck_assert(surface.mirrored == rest.mirrored && surface.ignored == rest.ignored);
        ck_assert(surface.triangles == rest.triangles && surface.loose == rest.loose);
        check_surface(mesh, "a block with inverted tets", false);
    }
}
END_TEST

// ---- winding numbers ------------------------------------------------------------------------------

struct Checked {
    bool certified = false, complete = false;
    std::size_t inside = 0, vertices = 0; // in tets that do not own them; in certified cells
};

// No vertex in a certified cell is in a tet that does not own it. `prepared` is the mesh as it was when its
// tiles and surface were made.
std::vector<Box> super_boxes_of(const Mesh& mesh, const Tiles& tiles) {
    std::vector<Box> boxes(tiles.super_tile_count(), empty_box);
    for (std::uint32_t s = 0; s < boxes.size(); ++s)
        for (const std::uint32_t b : tiles.blocks[s])
            for (std::uint32_t v = tiles.block_first[b]; v < tiles.block_first[b + 1]; ++v)
                add(boxes[s], box_around(mesh.positions[v]));
    return boxes;
}

Checked check_certificate(const Mesh& prepared, const Mesh& mesh, double cell_size, const char* name) {
    const Tiles tiles = tiles_of(prepared);
    const Boundary surface = surface_of(prepared, tiles);
    if (!surface.is_closed) return {};
    const std::set<std::uint32_t> loose(surface.loose.begin(), surface.loose.end());
    std::vector<bool> in_foreign(mesh.positions.size());
    std::vector<std::uint32_t> by_x(mesh.positions.size());
    std::iota(by_x.begin(), by_x.end(), 0u);
    std::sort(by_x.begin(), by_x.end(),
              [&](std::uint32_t a, std::uint32_t b) { return mesh.positions[a].x < mesh.positions[b].x; });
    Checked checked;
    for (const Tet& tet : mesh.tets) {
        Box box = empty_box;
        for (const std::uint32_t v : tet.v) add(box, box_around(mesh.positions[v]));
        auto next = std::lower_bound(by_x.begin(), by_x.end(), box.lo[0],
                                     [&](std::uint32_t v, float x) { return mesh.positions[v].x < x; });
        for (; next != by_x.end() && mesh.positions[*next].x <= box.hi[0]; ++next)
            if (!in_foreign[*next] && overlap(box, box_around(mesh.positions[*next])) && !owns(tet, *next) &&
                holds(locate_in(mesh, tet, mesh.positions[*next])))
                in_foreign[*next] = true;
    }
    checked.inside = std::size_t(std::count(in_foreign.begin(), in_foreign.end(), true));
    std::vector<std::uint8_t> first_cells;
    at_each_level([&](const char* level) {
        std::vector<Box> boxes(tiles.tiles.size());
        std::vector<std::uint8_t> known(tiles.tiles.size());
        fast::Certificate certificate(std::pmr::get_default_resource());
        fast::OrientationCache turning(std::pmr::get_default_resource());
        std::uint64_t exact_tests = 0;
        const std::vector<Box> supers = super_boxes_of(mesh, tiles);
        const std::vector<std::uint8_t> upright(supers.size());
        const std::vector<float> unknown(supers.size(), float_infinity);
        const fast::WindingBody body{{tiles, surface, packed(mesh), vertex_count(mesh), false, 0,
                                      unknown.data(), upright.data(), boxes.data(), known.data()},
                                     box_of(mesh),
                                     cell_size,
                                     supers.data(),
                                     turning,
                                     nullptr};
        checked.certified = fast::certify(body, certificate, exact_tests);
        if (!checked.certified) return;
        const std::vector<std::uint8_t> cells(certificate.certified.begin(), certificate.certified.end());
        if (first_cells.empty()) first_cells = cells;
        ck_assert_msg(cells == first_cells, "%s: another certificate on %s", name, level);
        checked.complete = certificate.complete;
        checked.vertices = 0;
        for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
            const bool held = certificate.holds(&mesh.positions[v].x);
            checked.vertices += held;
            ck_assert_msg(!(held && in_foreign[v] && !loose.count(v)),
                          "%s, cells of %g, %s: vertex %u is in a tet that does not own it", name, cell_size,
                          level, v);
            ck_assert_msg(held || !certificate.complete, "%s: a complete certificate without vertex %u", name,
                          v);
            ck_assert_msg(held || !certificate.holds(box_around(mesh.positions[v])),
                          "%s: the box of vertex %u is certified, the vertex is not", name, v);
        }
        for (const Box& box : supers) { // as its cells one by one
            const fast::WindowCell lo = certificate.lattice.cell(box.lo),
                                   hi = certificate.lattice.cell(box.hi);
            bool all = true;
            fast::WindowCell c = lo;
            for (c.index[2] = lo.index[2]; c.index[2] <= hi.index[2]; ++c.index[2])
                for (c.index[1] = lo.index[1]; c.index[1] <= hi.index[1]; ++c.index[1])
                    for (c.index[0] = lo.index[0]; c.index[0] <= hi.index[0]; ++c.index[0])
                        all = all && certificate.certified[certificate.lattice.offset(c)];
            ck_assert_msg(all || !certificate.holds(box), "%s: a box of uncertified cells is certified",
                          name);
        }
        ck_assert(turning.is_used);
    });
    return checked;
}

START_TEST(certificate_of_compact_bodies) {
    Random r{3};
    for (int round = 0; round < 6; ++round) {
        Mesh mesh = block(14, 14, 14);
        jitter(mesh, 0.1, r);
        if (round % 2) renumber(mesh, r);
        if (round % 3 == 1)
            for (Tet& tet : mesh.tets)
                if (r.below(2)) std::swap(tet.v[0], tet.v[3]);
        const Checked checked = check_certificate(mesh, mesh, r.uniform(1.2, 2.2), "a block");
        ck_assert_uint_eq(checked.inside, 0);
        ck_assert_msg(checked.certified && checked.complete, "a compact body is not certified");
    }
}
END_TEST

// Blocks bent, twisted, dented, pulled through themselves, some tets inverted: what is certified must be
// right, and something must be.
START_TEST(certificate_is_sound) {
    Random r{4};
    std::size_t certified = 0, with_contacts = 0, kept = 0;
    for (int round = 0; round < 100; ++round) {
        Mesh rest = round % 3 == 2 ? block(30, 8, 8) : block(12, 12, 12);
        jitter(rest, 0.05, r);
        if (round % 5 == 0) rest.positions.push_back({6, 6, 6}); // loose
        if (round % 5 == 1) rest.tets.push_back(rest.tets[r.below(std::uint32_t(rest.tets.size()))]);
        if (round % 5 == 2) { // a fin: where it stands on a facet inside, that has three tets
            Tet tet = rest.tets[r.below(std::uint32_t(rest.tets.size()))];
            tet.v[r.below(4)] = vertex_count(rest);
            rest.positions.push_back({r.uniform(-3, 15), r.uniform(-3, 15), r.uniform(-3, 15)});
            rest.tets.push_back(tet);
        }
        Mesh mesh = rest;
        const float half = round % 3 == 2 ? 15 : 6;
        if (round % 3 == 2) { // the ends of a bar come together, or through each other
            const double turn = r.uniform(4.5, 7), radius = r.uniform(3, 6);
            for (Vec3f& p : mesh.positions) {
                const double angle = turn * (p.x / 30.0 - 0.5), around = radius + p.y;
                p = {float(around * std::cos(angle)), float(around * std::sin(angle)), p.z};
            }
        } else if (round % 3 == 1) { // a vertex and what is around it pulled to somewhere else
            const Vec3f from = mesh.positions[r.below(vertex_count(mesh))];
            const Vec3f by{r.uniform(-9, 9), r.uniform(-9, 9), r.uniform(-9, 9)};
            const double reach = r.uniform(0.5, 6);
            for (Vec3f& p : mesh.positions) {
                const double d = std::hypot(p.x - from.x, p.y - from.y, p.z - from.z) / reach;
                if (d >= 1) continue;
                const auto w = float((1 - d) * (1 - d));
                p = {p.x + w * by.x, p.y + w * by.y, p.z + w * by.z};
            }
        } else { // a few vertices anywhere, and onto others
            for (std::uint32_t i = r.below(6); i < 6; ++i) {
                Vec3f& p = mesh.positions[r.below(vertex_count(mesh))];
                p = i % 2
                        ? mesh.positions[r.below(vertex_count(mesh))]
                        : Vec3f{p.x + r.uniform(-3, 3), p.y + r.uniform(-3, 3), p.z + r.uniform(-half, half)};
            }
        }
        if (round % 7 == 0)
            for (Vec3f& p : mesh.positions) p = {std::round(p.x), std::round(p.y), std::round(p.z)};
        const Checked checked = check_certificate(rest, mesh, r.uniform(0.7, 2), "a folded body");
        certified += checked.certified;
        with_contacts += checked.certified && checked.inside > 0;
        kept += checked.certified && !checked.complete && checked.vertices > 0;
    }
    ck_assert_msg(certified > 30 && with_contacts > 15 && kept > 15,
                  "certified %zu, with contacts %zu, in part %zu", certified, with_contacts, kept);
}
END_TEST

// All of a body on the wrong side: nothing of its inside may be certified.
START_TEST(certificate_of_an_inverted_body) {
    const Mesh rest = block(12, 12, 12);
    Mesh mesh = rest;
    for (Vec3f& p : mesh.positions) p.x = -p.x;
    const Checked checked = check_certificate(rest, mesh, 1.3, "a mirrored block");
    ck_assert(!checked.certified || !checked.complete);
}
END_TEST

} // namespace

SUITE(winding) {
    TCase* tests = add_case(suite, "winding");
    tcase_add_each(tests, components_are_what_is_connected, surface_of_good_meshes, surface_of_bad_meshes,
                   surface_of_inverted_tets, certificate_of_compact_bodies, certificate_is_sound,
                   certificate_of_an_inverted_body);
}
