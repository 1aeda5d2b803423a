// Windows of the fast engine and what is asked of them, by themselves, over plain arrays, against loops over
// everything.
#include "internal/stage_checks.hpp"

#include <cfloat>
#include <memory>

#include "support/suite.h" // last: it defines macros with common names

using namespace vox;
using namespace stages;

namespace {

// ---- window ---------------------------------------------------------------------------------------

// Points of `region`, collected range by range as the engine does.
fast::Points collected(const Mesh& mesh, const Box& region) {
    fast::Points points(std::pmr::get_default_resource());
    points.reserve(mesh.positions.size());
    for (std::uint32_t first = 0; first < mesh.positions.size();) {
        const std::uint32_t last = std::min(vertex_count(mesh), first + 1 + first % 70);
        fast::collect(packed(mesh), first, last, vertex_count(mesh), region, points);
        first = last;
    }
    return points;
}

Box random_box(Random& r, double extent) {
    Box box =
        box_around({r.uniform(-extent, extent), r.uniform(-extent, extent), r.uniform(-extent, extent)});
    add(box,
        box_around({r.uniform(-extent, extent), r.uniform(-extent, extent), r.uniform(-extent, extent)}));
    return box;
}

bool inside(const Vec3f& p, const Box& box) { return overlap(box_around(p), box); }

START_TEST(window_collects_and_bins) {
    Random r{4};
    for (int round = 0; round < 60; ++round) {
        Mesh mesh = soup(r, 1 + r.below(3000), 0, 5, round % 3 == 0);
        for (int i = 0; i < round % 4; ++i) // far away, each somewhere else
            mesh.positions[r.below(vertex_count(mesh))].x = r.any_finite();
        const Box region = round % 2 ? random_box(r, 6) : box_of(mesh);
        const double cell_size = r.uniform(0.05, 3);
        const std::size_t most_cells = 1 + r.below(20000);
        at_each_level([&](const char* level) {
            const fast::Points points = collected(mesh, region);
            std::vector<std::uint32_t> expected;
            Box expected_box = empty_box;
            for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
                if (inside(mesh.positions[v], region)) {
                    expected.push_back(v);
                    add(expected_box, box_around(mesh.positions[v]));
                }
            ck_assert_msg(std::equal(expected.begin(), expected.end(), points.id.begin(),
                                     points.id.begin() + std::ptrdiff_t(points.count)),
                          "%s: %u points collected, expected %zu", level, points.count, expected.size());
            if (expected.empty()) return;
            const Box box = fast::bounds(points);
            ck_assert_msg(same(box, expected_box), "%s: bounds", level);

            // Two windows in the same buffers: the second must leave the first alone.
            fast::Bins bins(std::pmr::get_default_resource());
            const fast::WindowLattice lattices[2] = {
                fast::make_lattice(box, cell_size, most_cells),
                fast::make_lattice(points, box, cell_size / 3, most_cells)};
            const fast::Window windows[2] = {fast::bin(points, lattices[0], box, bins),
                                             fast::bin(points, lattices[1], box, bins)};
            std::uint64_t occupied = 0, fullest = 0;
            for (const fast::Window& window : windows) {
                const fast::WindowLattice& l = window.lattice;
                ck_assert_uint_le(l.count(), most_cells);
                ck_assert_uint_eq(window.count, points.count);
                const std::uint32_t* begin = bins.begin.data() + window.first_cell;
                ck_assert_uint_eq(begin[0], 0);
                ck_assert_uint_eq(begin[l.count()], points.count);
                std::vector<int> met(mesh.positions.size());
                for (std::size_t c = 0; c < l.count(); ++c) {
                    ck_assert_uint_le(begin[c], begin[c + 1]);
                    occupied += begin[c] < begin[c + 1];
                    fullest = std::max<std::uint64_t>(fullest, begin[c + 1] - begin[c]);
                    for (std::uint32_t i = begin[c]; i < begin[c + 1]; ++i) {
                        const std::size_t at = window.first_point + i;
                        const std::uint32_t v = bins.points.id[at];
                        const Vec3f p = mesh.positions[v];
                        ck_assert(bins.points.x[at] == p.x && bins.points.y[at] == p.y &&
                                  bins.points.z[at] == p.z);
                        const std::size_t cell =
                            (std::size_t{l.cell(p.z, 2)} * l.cells[1] + l.cell(p.y, 1)) * l.cells[0] +
                            l.cell(p.x, 0);
                        ck_assert_msg(cell == c, "%s: vertex %u is in cell %zu, binned to %zu", level, v,
                                      cell, c);
                        ck_assert_msg(i == begin[c] || bins.points.id[at - 1] < v, "%s: order in cell %zu",
                                      level, c);
                        ++met[v];
                    }
                }
                for (const std::uint32_t v : expected) ck_assert_int_eq(met[v], 1);
            }
            ck_assert_uint_eq(bins.occupied_cells, occupied);
            ck_assert_uint_eq(bins.fullest_cell, fullest);
        });
    }
}
END_TEST

// Whatever is asked for: cells are in range, and no point between two others gets a cell beyond theirs.
START_TEST(lattice_is_monotone) {
    Random r{5};
    for (int round = 0; round < 3000; ++round) {
        Box box = random_box(r, 10);
        if (round % 4 == 0) {
            box = box_around({r.any_finite(), r.any_finite(), r.any_finite()});
            add(box, box_around({r.any_finite(), r.any_finite(), r.any_finite()}));
        }
        const double sizes[] = {r.uniform(1e-3, 5), 1e-300, 1e300, std::abs(double(r.any_finite()))};
        const std::size_t most_cells = 1 + r.below(5000);
        const fast::WindowLattice l = fast::make_lattice(box, sizes[r.below(4)], most_cells);
        ck_assert_uint_le(l.count(), most_cells);
        ck_assert(l.inverse > 0 && std::isfinite(l.inverse));
        for (int a = 0; a < 3; ++a) {
            std::vector<float> values{-FLT_MAX, FLT_MAX, 0.0f, box.lo[a], box.hi[a]};
            for (int i = 0; i < 20; ++i) values.push_back(r.any_finite());
            for (int i = 0; i < 20; ++i) {
                const float v = box.lo[a] + float(r.unit()) * (box.hi[a] - box.lo[a]);
                if (!std::isfinite(v)) continue;
                values.push_back(v);
                values.push_back(std::nextafter(v, FLT_MAX));
            }
            std::sort(values.begin(), values.end());
            std::uint32_t last = 0;
            for (const float v : values) {
                const std::uint32_t cell = l.cell(v, a);
                ck_assert_msg(cell >= last && cell < l.cells[a], "%g is in cell %u of %u, after %u",
                              double(v), cell, l.cells[a], last);
                last = cell;
            }
            ck_assert_uint_eq(l.cell(box.lo[a], a), 0);
        }
    }
}
END_TEST

// A few points far away do not make the cells of the others large, and stay in the lattice.
START_TEST(lattice_covers_the_bulk) {
    Random r{6};
    Mesh mesh = soup(r, 4000, 0, 5, false);
    for (int i = 0; i < 5; ++i) mesh.positions[r.below(4000)] = {r.uniform(-1e6, 1e6), 1e7f, -1e5f};
    const fast::Points points = collected(mesh, box_of(mesh));
    const fast::WindowLattice l = fast::make_lattice(points, box_of(mesh), 0.5, 64000);
    ck_assert_msg(1 / double(l.inverse) < 1, "cells of %g", 1 / double(l.inverse));
    ck_assert_uint_le(l.count(), 64000);
}
END_TEST

// ---- lookup ---------------------------------------------------------------------------------------

using Found = std::array<std::uint32_t, 4>; // body, vertex, tet, certain

class Collect final : public fast::Findings {
public:
    std::vector<Found> found;
    void take(std::span<const fast::Finding> findings) override {
        for (const fast::Finding& f : findings) found.push_back({f.body, f.vertex, f.tet, f.certain});
    }
};

// Clumps far apart, one in another's shadow at every scale, or one body: every point is in one window, no
// cell is crowded, and the windows that a box does not meet hold no point of it.
START_TEST(windows_of_sparse_space) {
    Random r{31};
    for (int kind = 0; kind < 4; ++kind) {
        Mesh mesh;
        for (int clump = 0; clump < 40; ++clump) {
            Mesh one = block(4, 4, 4);
            jitter(one, 0.2, r);
            const double far = kind == 0 ? 1e6 : kind == 1 ? std::ldexp(4.0, clump) : kind == 2 ? 1e30 : 0;
            const double x = r.uniform(-far, far), y = kind == 2 ? 0 : r.uniform(-far, far),
                         z = r.uniform(-far, far);
            move(one, 1, x, y, z);
            append(mesh, one);
        }
        const std::size_t count = mesh.positions.size();
        fast::Points points = collected(mesh, box_of(mesh));
        ck_assert_uint_eq(points.count, count);
        fast::Bins bins(std::pmr::get_default_resource());
        (void)fast::bin(points, fast::make_lattice(box_of(mesh), 1, 10), box_of(mesh), bins);
        const std::uint64_t before = bins.points.count, cells = bins.cells;
        const std::uint32_t root = fast::bin_tree(points, 1, bins);
        ck_assert_uint_eq(bins.points.count, before + count);
        ck_assert_uint_lt(bins.cells - cells, 5 * count);
        ck_assert_msg(kind == 3 ? bins.windows.size() == 1 : bins.windows.size() > 20, "kind %d: %zu windows",
                      kind, bins.windows.size());

        std::vector<int> met(count);
        std::uint64_t together = 0;
        fast::for_windows(bins, root, box_of(mesh), [&](const fast::Window& window) {
            Box box = empty_box;
            for (std::uint32_t i = 0; i < window.count; ++i) {
                const std::uint32_t v = bins.points.id[window.first_point + i];
                add(box, box_around(mesh.positions[v]));
                ++met[v];
            }
            ck_assert(same(box, window.box));
            const std::uint32_t* begin = bins.begin.data() + window.first_cell;
            for (std::size_t c = 0; c < window.lattice.count(); ++c)
                together += std::uint64_t{begin[c + 1] - begin[c]} * (begin[c + 1] - begin[c]);
        });
        for (const int times : met) ck_assert_int_eq(times, 1);
        if (kind != 3)
            ck_assert_msg(together < 130 * count, "kind %d: %g", kind, double(together) / double(count));

        for (int k = 0; k < 50; ++k) {
            Box box = box_around(mesh.positions[r.below(std::uint32_t(count))]);
            add(box, box_around(mesh.positions[r.below(std::uint32_t(count))]));
            std::vector<int> found(count);
            fast::for_windows(bins, root, box, [&](const fast::Window& window) {
                for (std::uint32_t i = 0; i < window.count; ++i)
                    found[bins.points.id[window.first_point + i]] = 1;
            });
            for (std::size_t v = 0; v < count; ++v)
                if (inside(mesh.positions[v], box)) ck_assert_int_eq(found[v], 1);
        }
    }
}
END_TEST

// All points in one place, or in two next to each other: nothing to halve.
START_TEST(windows_of_one_place) {
    for (int places = 1; places <= 2; ++places) {
        Mesh mesh;
        for (int i = 0; i < 1000; ++i)
            mesh.positions.push_back({i % places ? std::nextafter(1e6f, 2e6f) : 1e6f, 0, -1e-20f});
        mesh.positions.push_back({-1e30f, 1e30f, 0});
        fast::Points points = collected(mesh, box_of(mesh));
        fast::Bins bins(std::pmr::get_default_resource());
        (void)fast::bin_tree(points, 1e-3, bins);
        ck_assert_uint_eq(bins.points.count, 1001);
        ck_assert_uint_lt(bins.windows.size(), 10);
    }
}
END_TEST

// Vertices of `meshes` against the tets of `meshes[0]`, its own vertices first where `self`; each mesh's
// within its region.
std::vector<Found> look_up(const std::vector<Mesh>& meshes, const std::vector<Box>& regions, bool self,
                           double cell_size) {
    const Mesh& mesh = meshes[0];
    const Tiles tiles = tiles_of(mesh);
    const auto tile_count = std::uint32_t(tiles.tiles.size());
    fast::Bins bins(std::pmr::get_default_resource());
    std::vector<fast::Source> sources;
    for (std::size_t a = self ? 0 : 1; a < meshes.size(); ++a) {
        const fast::Points points = collected(meshes[a], regions[a]);
        if (points.count == 0) continue;
        const Box box = fast::bounds(points);
        const fast::WindowLattice lattice = fast::make_lattice(points, box, cell_size, 100000);
        sources.push_back({fast::bin(points, lattice, box, bins), regions[a], std::uint32_t(a)});
    }
    std::vector<Box> boxes(tile_count);
    std::vector<std::uint8_t> known(tile_count);
    fast::make_tile_boxes(tiles, packed(mesh), 0, tile_count / 2, boxes.data(), known.data());
    std::vector<std::uint32_t> stamps(mesh.positions.size());
    const bool stamped = self && !sources.empty() && sources[0].body == 0;
    fast::TiledBody q{};
    q.tiles = &tiles;
    q.positions = packed(mesh);
    q.boxes = q.made = boxes.data();
    q.known = known.data();
    q.stamps = stamped ? stamps.data() : nullptr;
    const auto scratch = std::make_unique<fast::LookupScratch>();
    Collect out;
    for (std::uint32_t t = 0; t < tile_count; t += 5) // in pieces
        fast::look_up_tiles(q, sources, t, std::min(tile_count, t + 5), *scratch, out);
    fast::flush(*scratch, out);
    for (std::uint32_t t = 0; t < tile_count; ++t) {
        Box box = empty_box;
        for (std::uint32_t i = 0; i < tiles.tiles[t].vertex_count; ++i)
            add(box, box_around(mesh.positions[tiles.vertices[tiles.tiles[t].first_vertex + i]]));
        ck_assert_msg(known[t] && same(boxes[t], box), "box of tile %u", t);
    }
    std::sort(out.found.begin(), out.found.end());
    return out.found;
}

// Returns how many findings are uncertain.
std::size_t check_query(const std::vector<Mesh>& meshes, const std::vector<Box>& regions, bool self,
                        double cell_size, const char* name) {
    std::vector<Found> first;
    std::size_t uncertain = 0;
    at_each_level([&](const char* level) {
        const std::vector<Found> found = look_up(meshes, regions, self, cell_size);
        if (first.empty()) first = found;
        ck_assert_msg(found == first, "%s: other findings on %s", name, level);
    });
    std::set<std::array<std::uint32_t, 3>> pairs;
    for (const Found& f : first) {
        ck_assert_msg(pairs.insert({f[0], f[1], f[2]}).second, "%s: vertex %u in tet %u found twice", name,
                      f[1], f[2]);
        const Tet& tet = meshes[0].tets[f[2]];
        const Vec3f p = meshes[f[0]].positions[f[1]];
        ck_assert_msg(inside(p, regions[f[0]]), "%s: vertex %u is not in the region", name, f[1]);
        ck_assert_msg(f[0] != 0 || (self && !owns(tet, f[1])), "%s: vertex %u in its own tet %u", name, f[1],
                      f[2]);
        ck_assert_msg(!f[3] || locate_in(meshes[0], tet, p) == Containment::interior,
                      "%s: vertex %u is not inside tet %u", name, f[1], f[2]);
        uncertain += !f[3];
    }
    for (std::size_t a = self ? 0 : 1; a < meshes.size(); ++a)
        for (std::uint32_t v = 0; v < meshes[a].positions.size(); ++v) {
            const Vec3f p = meshes[a].positions[v];
            if (!inside(p, regions[a])) continue;
            for (std::uint32_t t = 0; t < meshes[0].tets.size(); ++t) {
                const Tet& tet = meshes[0].tets[t];
                if ((a == 0 && owns(tet, v)) || !holds(locate_in(meshes[0], tet, p))) continue;
                ck_assert_msg(pairs.count({std::uint32_t(a), v, t}),
                              "%s: vertex %u of body %zu in tet %u is missing", name, v, a, t);
            }
        }
    return uncertain;
}

START_TEST(lookup_misses_nothing) {
    Random r{7};
    std::size_t uncertain = 0;
    for (int round = 0; round < 40; ++round) {
        std::vector<Mesh> meshes;
        for (int i = 0; i < 3; ++i) {
            const bool snapped = round % 4 == 3;
            const std::uint32_t vertices = 40 + r.below(120), tets = 30 + r.below(150);
            Mesh mesh = round % 2 ? soup(r, vertices, tets, 3, snapped) : block(4, 4, 4);
            if (round % 2 == 0) {
                jitter(mesh, round % 4 == 0 ? 0.2 : 0, r);
                move(mesh, 1, i * 1.5 - 2, i * 0.5 - 2, -2);
                renumber(mesh, r);
            }
            meshes.push_back(std::move(mesh));
        }
        for (const double scale : {1.0, 0x1p-60, 0x1p-140, 0x1p60, 0x1p120}) {
            std::vector<Mesh> scaled = meshes;
            std::vector<Box> whole, parts;
            for (Mesh& mesh : scaled) {
                move(mesh, scale, 0, 0, 0);
                whole.push_back(box_of(mesh));
                Box part = random_box(r, 3 * scale);
                intersect(part, whole.back());
                parts.push_back(part);
            }
            const double cell_size = r.uniform(0.2, 3) * scale;
            uncertain += check_query(scaled, whole, round % 3 == 0, cell_size, "everything");
            check_query(scaled, parts, round % 3 == 1, cell_size, "a region");
            if (round > 8) break;
        }
    }
    ck_assert_uint_gt(uncertain, 1000);
}
END_TEST

// More vertices in one tile, and more pairs, than the buffers hold at a time.
START_TEST(lookup_of_crowds) {
    Random r{8};
    Mesh tets = block(2, 2, 2), crowd;
    move(tets, 1, -1, -1, -1);
    for (int i = 0; i < 5000; ++i)
        crowd.positions.push_back({r.uniform(-1.1, 1.1), r.uniform(-1.1, 1.1), r.uniform(-1.1, 1.1)});
    const std::vector<Mesh> meshes{tets, crowd, crowd};
    for (const double cell_size : {0.1, 1.0, 10.0})
        check_query(meshes, {box_of(tets), box_of(crowd), box_of(crowd)}, true, cell_size, "a crowd");
}
END_TEST

} // namespace

SUITE(windows) {
    TCase* tests = add_case(suite, "windows");
    tcase_add_each(tests, window_collects_and_bins, lattice_is_monotone, lattice_covers_the_bulk,
                   windows_of_sparse_space, windows_of_one_place, lookup_misses_nothing, lookup_of_crowds);
}
