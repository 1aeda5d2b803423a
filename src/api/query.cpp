// The C border of locators (vox_query.h).

#include "base/array.hpp"
#include "base/border.hpp"
#include "base/positions.hpp"
#include "base/scratch.hpp"
#include "base/structs.hpp"
#include "grid/grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory_resource>

using namespace vox;

namespace {

Positions check_questions(const vox_positions* given, const char* name) {
    require(given, name);
    const Positions positions = check_positions(*given, name);
    if (given->count > 0 && !given->data)
        refuse(format("%s.data is null, %s.count is %" PRIu64, name, name, given->count));
    if (given->count > UINT32_MAX)
        throw Error(VOX_ERROR_LIMIT,
                    format("%s.count is %" PRIu64 ", the limit is 2^32 - 1", name, given->count));
    return positions;
}

// Both arrays have one element for each question.
void check_same_count(const vox_positions& a, const char* name_a, const vox_positions& b,
                      const char* name_b) {
    if (a.count != b.count)
        refuse(format("%s.count is %" PRIu64 ", %s.count is %" PRIu64, name_a, a.count, name_b, b.count));
}

void check_point(const Vec3d& p, const char* name, std::size_t index) {
    if (std::abs(p.x) < 0x1p128 && std::abs(p.y) < 0x1p128 && std::abs(p.z) < 0x1p128) return; // no NaN
    const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    throw Error(finite ? VOX_ERROR_LIMIT : VOX_ERROR_NON_FINITE,
                format("%s: position %zu is (%g, %g, %g), expected finite coordinates below 2^128", name,
                       index, p.x, p.y, p.z));
}

// Memory for one call.
using CallMemory = Scratch<4096>;

Array<Vec3d> read_points(const vox_positions* given, const char* name, std::pmr::memory_resource* memory) {
    const Positions positions = check_questions(given, name);
    const auto count = static_cast<std::size_t>(given->count);
    Array<Vec3d> points(memory);
    points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back(positions.exact(i));
        check_point(points.back(), name, i);
    }
    return points;
}

struct Asked {
    QueryMeshes bodies;
    bool first_only, extrapolate;
    double max_distance;
};

Asked read_desc(const vox_query_desc* given) {
    vox_query_desc desc{};
    if (given) desc = read_struct(given, "desc");
    if (desc.flags & ~std::uint32_t{VOX_QUERY_FIRST_HIT | VOX_QUERY_EXTRAPOLATE})
        refuse(format("desc.flags is 0x%" PRIx32 ", expected vox_query_flags", desc.flags));
    if (desc.reserved != 0) refuse(format("desc.reserved is %" PRIu32 ", expected 0", desc.reserved));
    if (!(desc.max_distance >= 0))
        refuse(format("desc.max_distance is %g, expected a number >= 0", desc.max_distance));
    set_default(desc.mask, UINT64_MAX);
    set_default(desc.max_distance, std::numeric_limits<double>::infinity());
    return {{desc.mask, desc.excluded},
            (desc.flags & VOX_QUERY_FIRST_HIT) != 0,
            (desc.flags & VOX_QUERY_EXTRAPOLATE) != 0,
            desc.max_distance};
}

template <class Hit>
void check_list(const Hit* hits, std::uint64_t capacity, const std::uint64_t* out_count) {
    if (capacity > 0) require(hits, "hits");
    require(out_count, "out_count");
}

// Appends the hits of one question to the list.
template <class Hit>
void append(HitList<Hit>& list, const Array<Hit>& found, std::uint32_t Hit::*question, std::size_t index) {
    for (const Hit& hit : found)
        if (Hit* const out = list.add()) {
            *out = hit;
            out->*question = static_cast<std::uint32_t>(index);
        }
}

} // namespace

vox_result vox_grid_update_locator(vox_grid* grid, vox_locator** locator) {
    return border(grid, "grid", [&] {
        require(locator, "locator");
        vox_locator* const taken = grid->take_locator();
        if (*locator) release(**locator);
        *locator = taken;
    });
}

vox_result vox_locator_retain(vox_locator* locator) {
    return border(locator, "locator", [&] { retain(*locator); });
}

void vox_locator_release(vox_locator* locator) {
    if (locator) release(*locator);
}

vox_result vox_locator_get_epoch(const vox_locator* locator, uint64_t* out_epoch) {
    return border(locator, "locator", out_epoch, "out_epoch", [&] { return locator->epoch; });
}

vox_result vox_locator_get_user_data(const vox_locator* locator, vox_body body, uint64_t* out_user_data) {
    return border(locator, "locator", out_user_data, "out_user_data",
                  [&] { return locator->queries.user_data(body); });
}

vox_result vox_locator_find_point_hits(const vox_locator* locator, const vox_positions* points,
                                       const vox_query_desc* desc, vox_point_hit* hits, uint64_t capacity,
                                       uint64_t* out_count) {
    return border(locator, "locator", [&] {
        check_list(hits, capacity, out_count);
        const Asked asked = read_desc(desc);
        CallMemory memory;
        const Array<Vec3d> at = read_points(points, "points", &memory);
        HitList<vox_point_hit> list(hits, capacity);
        locator->queries.points(at, asked.bodies, &memory, list);
        *out_count = list.count();
    });
}

vox_result vox_locator_locate(const vox_locator* locator, const vox_positions* points,
                              const vox_query_desc* desc, vox_location* out_locations) {
    return border(locator, "locator", [&] {
        const Asked asked = read_desc(desc);
        CallMemory memory;
        const Array<Vec3d> at = read_points(points, "points", &memory);
        if (!at.empty()) require(out_locations, "out_locations");
        locator->queries.locations(at, asked.max_distance, asked.extrapolate, asked.bodies, &memory,
                                   out_locations);
    });
}

vox_result vox_locator_find_closest(const vox_locator* locator, const vox_positions* points,
                                    const vox_query_desc* desc, vox_closest_hit* out_hits) {
    return border(locator, "locator", [&] {
        const Asked asked = read_desc(desc);
        CallMemory memory;
        const Array<Vec3d> at = read_points(points, "points", &memory);
        if (!at.empty()) require(out_hits, "out_hits");
        locator->queries.closest_points(at, asked.max_distance, asked.bodies, &memory, out_hits);
    });
}

vox_result vox_locator_find_closest_to_segments(const vox_locator* locator, const vox_positions* from,
                                                const vox_positions* to, const vox_query_desc* desc,
                                                vox_closest_hit* out_hits) {
    return border(locator, "locator", [&] {
        const Asked asked = read_desc(desc);
        CallMemory memory;
        const Array<Vec3d> begins = read_points(from, "from", &memory), ends = read_points(to, "to", &memory);
        check_same_count(*from, "from", *to, "to");
        if (!begins.empty()) require(out_hits, "out_hits");
        locator->queries.closest_to_segments(begins, ends, asked.max_distance, asked.bodies, &memory,
                                             out_hits);
    });
}

vox_result vox_locator_find_box_hits(const vox_locator* locator, const vox_positions* min,
                                     const vox_positions* max, const vox_query_desc* desc, vox_box_hit* hits,
                                     uint64_t capacity, uint64_t* out_count) {
    return border(locator, "locator", [&] {
        check_list(hits, capacity, out_count);
        const Asked asked = read_desc(desc);
        const Positions lows = check_questions(min, "min"), highs = check_questions(max, "max");
        check_same_count(*min, "min", *max, "max");
        for (std::size_t i = 0; i < min->count; ++i) {
            const Vec3d low = lows.exact(i), high = highs.exact(i);
            if (!(low.x <= high.x && low.y <= high.y && low.z <= high.z))
                refuse(format("box %zu is from (%g, %g, %g) to (%g, %g, %g), expected min <= max", i, low.x,
                              low.y, low.z, high.x, high.y, high.z));
        }
        CallMemory memory;
        Array<vox_box_hit> found(&memory);
        HitList<vox_box_hit> list(hits, capacity);
        for (std::size_t i = 0; i < min->count; ++i) {
            found.clear();
            locator->queries.box(lows.exact(i), highs.exact(i), asked.bodies, found);
            append(list, found, &vox_box_hit::box, i);
        }
        *out_count = list.count();
    });
}

vox_result vox_locator_find_ray_hits(const vox_locator* locator, const vox_positions* from,
                                     const vox_positions* to, const vox_query_desc* desc, vox_ray_hit* hits,
                                     uint64_t capacity, uint64_t* out_count) {
    return border(locator, "locator", [&] {
        check_list(hits, capacity, out_count);
        const Asked asked = read_desc(desc);
        CallMemory memory;
        const Array<Vec3d> begins = read_points(from, "from", &memory), ends = read_points(to, "to", &memory);
        check_same_count(*from, "from", *to, "to");
        Array<vox_ray_hit> found(&memory);
        HitList<vox_ray_hit> list(hits, capacity);
        for (std::size_t i = 0; i < begins.size(); ++i) {
            found.clear();
            locator->queries.ray_hits(begins[i], ends[i], asked.bodies, asked.first_only, found);
            append(list, found, &vox_ray_hit::ray, i);
        }
        *out_count = list.count();
    });
}

vox_result vox_locator_find_tracks(const vox_locator* locator, const vox_positions* from,
                                   const vox_positions* to, const vox_query_desc* desc,
                                   vox_track_piece* pieces, uint64_t capacity, uint64_t* out_count) {
    return border(locator, "locator", [&] {
        if (capacity > 0) require(pieces, "pieces");
        require(out_count, "out_count");
        const Asked asked = read_desc(desc);
        CallMemory memory;
        const Array<Vec3d> begins = read_points(from, "from", &memory), ends = read_points(to, "to", &memory);
        check_same_count(*from, "from", *to, "to");
        HitList<vox_track_piece> list(pieces, capacity);
        locator->queries.tracks(begins, ends, asked.bodies, &memory, list);
        *out_count = list.count();
    });
}

vox_result vox_locator_test_rays(const vox_locator* locator, const vox_positions* from,
                                 const vox_positions* to, const vox_query_desc* desc, uint8_t* out_blocked) {
    return border(locator, "locator", [&] {
        const Asked asked = read_desc(desc);
        CallMemory memory;
        const Array<Vec3d> begins = read_points(from, "from", &memory), ends = read_points(to, "to", &memory);
        check_same_count(*from, "from", *to, "to");
        if (!begins.empty()) require(out_blocked, "out_blocked");
        for (std::size_t i = 0; i < begins.size(); ++i)
            out_blocked[i] = locator->queries.blocks(begins[i], ends[i], asked.bodies);
    });
}

vox_result vox_locator_find_triangle_hits(const vox_locator* locator, const vox_positions* from,
                                          const vox_positions* to, const vox_query_desc* desc,
                                          vox_triangle_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return border(locator, "locator", [&] {
        check_list(hits, capacity, out_count);
        const Asked asked = read_desc(desc);
        CallMemory memory;
        const Array<Vec3d> begins = read_points(from, "from", &memory);
        Array<Vec3d> ends(&memory);
        if (to) {
            ends = read_points(to, "to", &memory);
            check_same_count(*from, "from", *to, "to");
        }
        if (begins.size() % 3 != 0)
            refuse(format("from.count is %zu, expected a multiple of 3: three corners a triangle",
                          begins.size()));
        Array<vox_triangle_hit> found(&memory);
        HitList<vox_triangle_hit> list(hits, capacity);
        for (std::size_t i = 0; i < begins.size(); i += 3) {
            found.clear();
            locator->queries.triangle_hits(&begins[i], to ? &ends[i] : nullptr, asked.bodies, found);
            append(list, found, &vox_triangle_hit::triangle, i / 3);
        }
        *out_count = list.count();
    });
}
