// The C border of queries between steps.

#include "base/array.hpp"
#include "base/border.hpp"
#include "base/scratch.hpp"
#include "base/structs.hpp"
#include "grid/grid.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory_resource>

using namespace vox;

namespace {

[[noreturn]] void refuse_point(const Vec3d& p, const char* name) {
    const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    throw Error(finite ? VOX_ERROR_LIMIT : VOX_ERROR_NON_FINITE,
                format("%s is (%g, %g, %g), expected finite coordinates below 2^128", name, p.x, p.y, p.z));
}

bool is_usable(const Vec3d& p) { // not with NaN
    return std::abs(p.x) < 0x1p128 && std::abs(p.y) < 0x1p128 && std::abs(p.z) < 0x1p128;
}

Vec3d read_point(const double* p, const char* name) {
    require(p, name);
    const Vec3d point{p[0], p[1], p[2]};
    if (!is_usable(point)) refuse_point(point, name);
    return point;
}

// As answer(), of hits that find(memory) writes itself: it returns how many there are.
template <class Find>
void answer_points(const vox_point_hit* hits, std::uint64_t capacity, std::uint64_t* out_count, Find&& find) {
    if (capacity > 0) require(hits, "hits");
    require(out_count, "out_count");
    Scratch<4096> memory;
    *out_count = find(&memory);
}

// Calls find(found) and copies as many hits as there is room for.
template <class Hit, class Find>
void answer(Hit* hits, std::uint64_t capacity, std::uint64_t* out_count, Find&& find) {
    if (capacity > 0) require(hits, "hits");
    require(out_count, "out_count");
    Scratch<4096> memory;
    Array<Hit> found(&memory);
    find(found);
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(capacity, found.size()));
    std::copy_n(found.begin(), count, hits);
    *out_count = found.size();
}

Array<Vec3d> read_points(const void* points, const vox_format& point_format, std::uint64_t byte_stride,
                         std::uint64_t component_byte_stride, std::uint64_t count) {
    if (count > 0) require(points, "points");
    if (count > UINT32_MAX)
        throw Error(VOX_ERROR_LIMIT, format("point_count is %llu, the limit is 2^32 - 1",
                                            static_cast<unsigned long long>(count)));
    vox_positions given{points, count, VOX_FORMAT_FLOAT, 0, byte_stride, component_byte_stride};
    std::memcpy(&given.format, &point_format, sizeof point_format); // may be no vox_format
    const Positions positions = check_positions(given, "points");
    Array<Vec3d> read(std::pmr::new_delete_resource());
    read.reserve(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < count; ++i) {
        read.push_back(positions.exact(i));
        if (!is_usable(read.back())) refuse_point(read.back(), format("point %zu", i).c_str());
    }
    return read;
}

// ---- each query, of whatever was prepared -----------------------------------------------------------

void ask_point(const Queries& queries, const double* point, QueryMeshes which, vox_point_hit* hits,
               std::uint64_t capacity, std::uint64_t* out_count) {
    const Vec3d p = read_point(point, "point");
    answer_points(hits, capacity, out_count, [&](std::pmr::memory_resource* memory) {
        return queries.points({&p, 1}, which, memory, hits, capacity);
    });
}

void ask_points(const Queries& queries, const void* points, const vox_format& point_format,
                std::uint64_t byte_stride, std::uint64_t point_count, QueryMeshes which, vox_point_hit* hits,
                std::uint64_t capacity, std::uint64_t* out_count) {
    const Array<Vec3d> asked = read_points(points, point_format, byte_stride, 0, point_count);
    answer_points(hits, capacity, out_count, [&](std::pmr::memory_resource* memory) {
        return queries.points(asked, which, memory, hits, capacity);
    });
}

void ask_box(const Queries& queries, const double* min, const double* max, QueryMeshes which,
             vox_tet_hit* hits, std::uint64_t capacity, std::uint64_t* out_count) {
    require(min, "min");
    require(max, "max");
    answer(hits, capacity, out_count, [&](Array<vox_tet_hit>& found) {
        for (int axis = 0; axis < 3; ++axis)
            if (!(min[axis] <= max[axis]))
                throw Error(VOX_ERROR_INVALID_ARGUMENT,
                            format("the box is [%g, %g] on axis %d, expected min <= max", min[axis],
                                   max[axis], axis));
        queries.box({min[0], min[1], min[2]}, {max[0], max[1], max[2]}, which, found);
    });
}

void ask_closest(const Queries& queries, const double* point, double radius, QueryMeshes which,
                 vox_surface_hit* out_hit) {
    const Vec3d p = read_point(point, "point");
    require(out_hit, "out_hit");
    if (!(radius >= 0))
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("radius is %g, expected a number >= 0", radius));
    *out_hit = queries.closest(p, radius, which);
}

void ask_closest_points(const Queries& queries, const vox_closest_desc* desc, vox_closest_hit* out_hits) {
    vox_closest_desc asked = read_struct(desc, "desc");
    set_default(asked.mask, UINT64_MAX);
    set_default(asked.max_distance, std::numeric_limits<double>::infinity());
    if (asked.point_count > 0) require(out_hits, "out_hits");
    if (!(asked.max_distance >= 0))
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("max_distance is %g, expected a number >= 0", asked.max_distance));
    if (asked.reserved != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("desc reserved is %u, expected 0", asked.reserved));
    const Array<Vec3d> points = read_points(asked.points, asked.format, asked.byte_stride,
                                            asked.component_byte_stride, asked.point_count);
    Scratch<4096> memory;
    queries.closest_points(points, asked.max_distance, {asked.mask, asked.excluded}, &memory, out_hits);
}

void ask_ray(const Queries& queries, const double* from, const double* to, QueryMeshes which,
             vox_ray_hit* out_hit) {
    const Vec3d begin = read_point(from, "from"), end = read_point(to, "to");
    require(out_hit, "out_hit");
    *out_hit = queries.ray(begin, end, which);
}

void ask_ray_hits(const Queries& queries, const double* from, const double* to, QueryMeshes which,
                  vox_facet_hit* hits, std::uint64_t capacity, std::uint64_t* out_count) {
    const Vec3d begin = read_point(from, "from"), end = read_point(to, "to");
    answer(hits, capacity, out_count,
           [&](Array<vox_facet_hit>& found) { queries.ray_hits(begin, end, which, found); });
}

void ask_ray_any(const Queries& queries, const double* from, const double* to, QueryMeshes which,
                 std::uint32_t* out_any) {
    const Vec3d begin = read_point(from, "from"), end = read_point(to, "to");
    require(out_any, "out_any");
    *out_any = queries.ray_any(begin, end, which);
}

// ask(queries, arguments...) of the object, which must not be null.
template <class Ask, class... Arguments>
vox_result of_grid(const vox_grid* grid, Ask&& ask, const Arguments&... arguments) {
    return border(grid, "grid", [&] { ask(grid->queries(), arguments...); });
}
template <class Ask, class... Arguments>
vox_result of_view(const vox_query_view* view, Ask&& ask, const Arguments&... arguments) {
    return border(view, "view", [&] { ask(view->queries, arguments...); });
}

} // namespace

// ---- of a grid --------------------------------------------------------------------------------------

vox_result vox_grid_prepare_queries(vox_grid* grid) {
    return border(grid, "grid", [&] { grid->prepare_queries(); });
}

vox_result vox_grid_query_point(const vox_grid* grid, const double point[3], uint64_t mask,
                                vox_point_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return of_grid(grid, ask_point, point, QueryMeshes{mask}, hits, capacity, out_count);
}

vox_result vox_grid_query_points(const vox_grid* grid, const void* points, vox_format format_of_points,
                                 uint64_t byte_stride, uint64_t point_count, uint64_t mask,
                                 vox_point_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return of_grid(grid, ask_points, points, format_of_points, byte_stride, point_count, QueryMeshes{mask},
                   hits, capacity, out_count);
}

vox_result vox_grid_query_box(const vox_grid* grid, const double min[3], const double max[3], uint64_t mask,
                              vox_tet_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return of_grid(grid, ask_box, min, max, QueryMeshes{mask}, hits, capacity, out_count);
}

vox_result vox_grid_query_closest(const vox_grid* grid, const double point[3], double radius, uint64_t mask,
                                  vox_surface_hit* out_hit) {
    return of_grid(grid, ask_closest, point, radius, QueryMeshes{mask}, out_hit);
}

vox_result vox_grid_query_closest_points(const vox_grid* grid, const vox_closest_desc* desc,
                                         vox_closest_hit* out_hits) {
    return of_grid(grid, ask_closest_points, desc, out_hits);
}

vox_result vox_grid_query_ray(const vox_grid* grid, const double from[3], const double to[3], uint64_t mask,
                              vox_ray_hit* out_hit) {
    return of_grid(grid, ask_ray, from, to, QueryMeshes{mask}, out_hit);
}

vox_result vox_grid_query_ray_hits(const vox_grid* grid, const double from[3], const double to[3],
                                   uint64_t mask, vox_body excluded, vox_facet_hit* hits, uint64_t capacity,
                                   uint64_t* out_count) {
    return of_grid(grid, ask_ray_hits, from, to, QueryMeshes{mask, excluded}, hits, capacity, out_count);
}

vox_result vox_grid_query_ray_any(const vox_grid* grid, const double from[3], const double to[3],
                                  uint64_t mask, vox_body excluded, uint32_t* out_any) {
    return of_grid(grid, ask_ray_any, from, to, QueryMeshes{mask, excluded}, out_any);
}

// ---- of a view --------------------------------------------------------------------------------------

vox_result vox_grid_take_query_view(vox_grid* grid, vox_query_view** out_view) {
    return border(grid, "grid", out_view, "out_view", [&] { return grid->take_query_view(); });
}

vox_result vox_query_view_retain(vox_query_view* view) {
    return border(view, "view", [&] { retain(*view); });
}

void vox_query_view_release(vox_query_view* view) {
    if (view) release(*view);
}

vox_result vox_query_view_epoch(const vox_query_view* view, uint64_t* out_epoch) {
    return border(view, "view", out_epoch, "out_epoch", [&] { return view->epoch; });
}

vox_result vox_query_view_user_data(const vox_query_view* view, vox_body body, uint64_t* out_user_data) {
    return border(view, "view", out_user_data, "out_user_data",
                  [&] { return view->queries.user_data(body); });
}

vox_result vox_query_view_point(const vox_query_view* view, const double point[3], uint64_t mask,
                                vox_point_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return of_view(view, ask_point, point, QueryMeshes{mask}, hits, capacity, out_count);
}

vox_result vox_query_view_points(const vox_query_view* view, const void* points, vox_format format_of_points,
                                 uint64_t byte_stride, uint64_t point_count, uint64_t mask,
                                 vox_point_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return of_view(view, ask_points, points, format_of_points, byte_stride, point_count, QueryMeshes{mask},
                   hits, capacity, out_count);
}

vox_result vox_query_view_box(const vox_query_view* view, const double min[3], const double max[3],
                              uint64_t mask, vox_tet_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return of_view(view, ask_box, min, max, QueryMeshes{mask}, hits, capacity, out_count);
}

vox_result vox_query_view_closest(const vox_query_view* view, const double point[3], double radius,
                                  uint64_t mask, vox_surface_hit* out_hit) {
    return of_view(view, ask_closest, point, radius, QueryMeshes{mask}, out_hit);
}

vox_result vox_query_view_closest_points(const vox_query_view* view, const vox_closest_desc* desc,
                                         vox_closest_hit* out_hits) {
    return of_view(view, ask_closest_points, desc, out_hits);
}

vox_result vox_query_view_ray(const vox_query_view* view, const double from[3], const double to[3],
                              uint64_t mask, vox_ray_hit* out_hit) {
    return of_view(view, ask_ray, from, to, QueryMeshes{mask}, out_hit);
}

vox_result vox_query_view_ray_hits(const vox_query_view* view, const double from[3], const double to[3],
                                   uint64_t mask, vox_body excluded, vox_facet_hit* hits, uint64_t capacity,
                                   uint64_t* out_count) {
    return of_view(view, ask_ray_hits, from, to, QueryMeshes{mask, excluded}, hits, capacity, out_count);
}

vox_result vox_query_view_ray_any(const vox_query_view* view, const double from[3], const double to[3],
                                  uint64_t mask, vox_body excluded, uint32_t* out_any) {
    return of_view(view, ask_ray_any, from, to, QueryMeshes{mask, excluded}, out_any);
}
