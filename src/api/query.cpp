// The C border of queries between steps.

#include "base/border.hpp"
#include "base/scratch.hpp"
#include "grid/grid.hpp"
#include "mesh/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory_resource>

using namespace vox;

namespace {

[[noreturn]] void refuse(const Vec3d& p, const char* name) {
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
    if (!is_usable(point)) refuse(point, name);
    return point;
}

// Calls find(found) and copies as many hits as there is room for.
template <class Hit, class Find>
void answer(Hit* hits, std::uint64_t capacity, std::uint64_t* out_count, Find&& find) {
    if (capacity > 0) require(hits, "hits");
    require(out_count, "out_count");
    Scratch<4096> memory;
    std::pmr::vector<Hit> found(&memory);
    find(found);
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(capacity, found.size()));
    std::copy_n(found.begin(), count, hits);
    *out_count = found.size();
}

} // namespace

vox_result vox_grid_prepare_queries(vox_grid* grid) {
    return border(grid, "grid", [&] { grid->prepare_queries(); });
}

vox_result vox_grid_query_point(const vox_grid* grid, const double point[3], uint64_t mask,
                                vox_point_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return border(grid, "grid", [&] {
        const Vec3d p = read_point(point, "point");
        answer(hits, capacity, out_count, [&](std::pmr::vector<vox_point_hit>& found) {
            grid->queries().points({&p, 1}, mask, found);
        });
    });
}

vox_result vox_grid_query_points(const vox_grid* grid, const void* points, vox_format format_of_points,
                                 uint64_t byte_stride, uint64_t point_count, uint64_t mask,
                                 vox_point_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return border(grid, "grid", [&] {
        if (point_count > 0) require(points, "points");
        answer(hits, capacity, out_count, [&](std::pmr::vector<vox_point_hit>& found) {
            check_format(format_of_points, "point ");
            if (point_count > UINT32_MAX)
                throw Error(VOX_ERROR_LIMIT, format("point_count is %llu, the limit is 2^32 - 1",
                                                    static_cast<unsigned long long>(point_count)));
            const Positions positions{.data = static_cast<const std::byte*>(points),
                                      .byte_stride =
                                          check_stride(byte_stride, format_of_points, point_count, "point "),
                                      .doubles = format_of_points == VOX_FORMAT_DOUBLE3};
            const Queries& queries = grid->queries();
            std::pmr::vector<Vec3d> asked(std::pmr::new_delete_resource());
            asked.reserve(static_cast<std::size_t>(point_count));
            for (std::size_t i = 0; i < point_count; ++i) {
                asked.push_back(positions.exact(i));
                if (!is_usable(asked.back())) refuse(asked.back(), format("point %zu", i).c_str());
            }
            queries.points(asked, mask, found);
        });
    });
}

vox_result vox_grid_query_box(const vox_grid* grid, const double min[3], const double max[3], uint64_t mask,
                              vox_tet_hit* hits, uint64_t capacity, uint64_t* out_count) {
    return border(grid, "grid", [&] {
        require(min, "min");
        require(max, "max");
        answer(hits, capacity, out_count, [&](std::pmr::vector<vox_tet_hit>& found) {
            for (int axis = 0; axis < 3; ++axis)
                if (!(min[axis] <= max[axis]))
                    throw Error(VOX_ERROR_INVALID_ARGUMENT,
                                format("the box is [%g, %g] on axis %d, expected min <= max", min[axis],
                                       max[axis], axis));
            grid->queries().box({min[0], min[1], min[2]}, {max[0], max[1], max[2]}, mask, found);
        });
    });
}

vox_result vox_grid_query_closest(const vox_grid* grid, const double point[3], double radius, uint64_t mask,
                                  vox_surface_hit* out_hit) {
    return border(grid, "grid", [&] {
        const Vec3d p = read_point(point, "point");
        require(out_hit, "out_hit");
        if (!(radius >= 0))
            throw Error(VOX_ERROR_INVALID_ARGUMENT, format("radius is %g, expected a number >= 0", radius));
        *out_hit = grid->queries().closest(p, radius, mask);
    });
}

vox_result vox_grid_query_ray(const vox_grid* grid, const double from[3], const double to[3], uint64_t mask,
                              vox_ray_hit* out_hit) {
    return border(grid, "grid", [&] {
        const Vec3d begin = read_point(from, "from"), end = read_point(to, "to");
        require(out_hit, "out_hit");
        *out_hit = grid->queries().ray(begin, end, mask);
    });
}
