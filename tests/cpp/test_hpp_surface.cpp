// vox_surface.hpp beside vox_surface.h.
#include <vox/vox_surface.hpp>

#include <array>
#include <type_traits>
#include <utility>
#include <vector>

#include "cpp/throws.hpp"

namespace {

// Two triangles that cross each other, as rows and as what rows are made of.
const std::vector<double> crossed = {0, 0, 0, 1, 0, 0, 0, 1, 0, .25, .25, -1, .25, .25, 1, 2, 2, 0};
const std::vector<std::uint32_t> faces = {0, 1, 2, 3, 4, 5};

START_TEST(what_c_answers) {
    vox::surface surface(6, faces);
    const auto edges = surface.features(VOX_FEATURE_EDGE);
    ck_assert_uint_eq(edges.size(), 12);
    surface.move(crossed);
    const vox::partner_lists lists = surface.find_pairs(VOX_FEATURE_EDGE, VOX_FEATURE_FACE);
    vox_partner_lists raw;
    const std::vector<std::uint32_t> partners(lists.partners().begin(), lists.partners().end());
    ck_ok(vox_surface_find_pairs(surface.get(), VOX_FEATURE_EDGE, VOX_FEATURE_FACE, 0, 6, &raw));
    ck_assert_uint_eq(lists.size(), 6);
    ck_assert_uint_eq(partners.size(), raw.offsets[6]);
    ck_assert_mem_eq(partners.data(), raw.partners, 4 * partners.size());
    const vox::partner_lists again = surface.find_pairs(VOX_FEATURE_EDGE, VOX_FEATURE_FACE, 1, 3);
    ck_assert_uint_eq(again.first(), 1);
    ck_assert_uint_eq(again.size(), 3);
    std::uint64_t pairs = 0;
    for (std::size_t i = 0; i < again.size(); ++i) pairs += again[i].size();
    ck_assert_uint_eq(pairs, again.partners().size());
    ck_assert_uint_eq(again.offsets()[3], pairs);
    const auto counters = surface.counters();
    ck_assert_uint_eq(counters.size(), 7);
    ck_assert_str_eq(counters[3].name, "overlaps");
    ck_assert_uint_ge(counters[3].value, pairs);

    const auto crossings = surface.find_crossings();
    const std::vector<vox_crossing> copied(crossings.begin(), crossings.end());
    vox_crossing_view raw_crossings;
    ck_ok(vox_surface_find_crossings(surface.get(), &raw_crossings));
    ck_assert_uint_gt(copied.size(), 0);
    ck_assert_uint_eq(copied.size(), raw_crossings.count);
    ck_assert_mem_eq(copied.data(), raw_crossings.data, sizeof copied[0] * copied.size());
    const auto close = surface.find_proximities(VOX_FEATURE_EDGE, VOX_FEATURE_EDGE, 0.5);
    ck_assert_uint_gt(close.size(), 0);
    for (const vox_proximity& pair : close) ck_assert_double_le(pair.distance, 0.5);
    std::vector<double> clearance(6);
    surface.find_clearances(10, clearance);
    ck_assert_double_gt(clearance[0], 0);
    ck_assert_double_gt(surface.suggest_cell_size(VOX_FEATURE_EDGE, VOX_FEATURE_EDGE).cell_size, 0);
    surface.set_cell_size(0.5);
    ck_assert_uint_eq(surface.find_pairs(VOX_FEATURE_EDGE, VOX_FEATURE_FACE).partners().size(),
                      partners.size());
}
END_TEST

START_TEST(motions) {
    // The second triangle falls onto the first one.
    std::vector<std::array<float, 3>> from = {{0, 0, 0},     {1, 0, 0},     {0, 1, 0},
                                              {.2f, .2f, 1}, {.4f, .2f, 1}, {.2f, .4f, 1}},
                                      to = from;
    for (std::size_t v = 3; v < 6; ++v) to[v][2] = -1;
    vox::surface surface(6, faces);
    throws([&] { surface.find_pairs(VOX_FEATURE_EDGE, VOX_FEATURE_FACE); }, VOX_ERROR_INVALID_STATE,
           "no positions");
    surface.move(from, to, 0.01, VOX_MOTION_CULL);
    const vox_safe_step step = surface.find_safe_step();
    ck_assert(step.step > 0.4 && step.step <= 0.5);
    const auto times = surface.find_impacts(VOX_FEATURE_FACE, VOX_FEATURE_VERTEX);
    ck_assert_uint_eq(times.size(), 3);
    ck_assert_double_eq(times[0].time, step.step);
    vox_impact_desc closer = vox_default_impact_desc();
    closer.slack = 1e-6;
    ck_assert_double_gt(surface.find_safe_step(closer).step, step.step);
    throws([&] { surface.move(from, crossed); }, VOX_ERROR_INVALID_ARGUMENT, "to.format is 1, from.format 0");
    throws([&] { surface.move(from, std::vector<std::array<float, 3>>(5)); }, VOX_ERROR_INVALID_ARGUMENT,
           "to.count is 5, expected 6");
    throws([&] { surface.move(std::vector<double>(17)); }, VOX_ERROR_INVALID_ARGUMENT, "17 numbers");
    throws([&] { surface.move(std::vector<double>(15)); }, VOX_ERROR_INVALID_ARGUMENT,
           "from.count is 5, expected 6");
    throws(
        [&] {
            vox::surface(6, std::vector<std::uint32_t>{0, 1});
        },
        VOX_ERROR_INVALID_ARGUMENT, "2 indices");
    throws([&] { vox::surface(5, faces); }, VOX_ERROR_INVALID_MESH, "vertex 5 of 5");
}
END_TEST

START_TEST(ownership) {
    static_assert(!std::is_copy_constructible_v<vox::surface> &&
                  std::is_nothrow_move_constructible_v<vox::surface>);
    vox_surface_desc desc = vox_default_surface_desc();
    desc.vertex_count = 6;
    desc.faces = faces.data();
    desc.face_count = 2;
    vox_surface* raw = nullptr;
    ck_ok(vox_surface_create(&desc, &raw));
    vox::surface surface = vox::surface::adopt(raw), moved = std::move(surface);
    ck_assert_ptr_eq(moved.get(), raw);
    throws([&] { surface.move(crossed); }, VOX_ERROR_INVALID_ARGUMENT, "surface is null");
    surface = vox::surface(desc);
    surface.move(crossed);
    ck_assert_uint_gt(surface.find_crossings().size(), 0);
}
END_TEST

} // namespace

SUITE(hpp_surface) {
    TCase* tests = add_case(suite, "surfaces");
    tcase_add_each(tests, what_c_answers, motions, ownership);
}
