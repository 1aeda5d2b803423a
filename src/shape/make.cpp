// Shapes from what the caller gave.
#include "base/error.hpp"
#include "base/llu.hpp"
#include "base/positions.hpp"
#include "base/structs.hpp"
#include "base/vectors.hpp"
#include "shape/primitives.hpp"
#include "shape/triangles.hpp"

#include <cmath>
#include <limits>

namespace vox {

namespace {

constexpr double largest = std::numeric_limits<float>::max(); // a coordinate may be

void check_length(double length, const char* name) {
    if (!(length >= 0 && length <= largest))
        refuse(format("shape %s is %g, expected a number from 0 to %g", name, length, largest));
}

void check_coordinate(double x, const char* what, std::uint64_t index) {
    if (!std::isfinite(x))
        throw Error(VOX_ERROR_NON_FINITE,
                    format("shape %s %llu is %g, not a finite number", what, llu(index), x));
    if (std::abs(x) > largest)
        throw Error(VOX_ERROR_LIMIT,
                    format("shape %s %llu is %g, the limit is %g", what, llu(index), x, largest));
}

Array<Vec3d> read_points(const vox_shape_desc& desc, std::pmr::memory_resource* memory) {
    const Positions positions = check_positions(desc.positions, "shape positions");
    if (desc.positions.count > 0) require(positions.data, "shape positions.data");
    if (desc.positions.count > VOX_MAX_VERTICES)
        throw Error(VOX_ERROR_LIMIT, format("shape has %llu positions, the limit is %u",
                                            llu(desc.positions.count), VOX_MAX_VERTICES));
    Array<Vec3d> points(memory);
    points.reserve(static_cast<std::size_t>(desc.positions.count));
    for (std::size_t i = 0; i < desc.positions.count; ++i) {
        const Vec3d p = points.emplace_back(positions.exact(i));
        for (const double x : {p.x, p.y, p.z}) check_coordinate(x, "position", i);
    }
    return points;
}

Array<ShapeTriangle> read_triangles(const vox_shape_desc& desc, std::pmr::memory_resource* memory) {
    if (desc.triangle_count == 0) refuse("shape triangle_count is 0, expected triangles");
    if (desc.triangle_count > VOX_MAX_SURFACE_TETS)
        throw Error(VOX_ERROR_LIMIT, format("shape has %llu triangles, the limit is %u",
                                            llu(desc.triangle_count), VOX_MAX_SURFACE_TETS));
    require(desc.triangles, "shape triangles");
    Array<ShapeTriangle> triangles(memory);
    triangles.reserve(static_cast<std::size_t>(desc.triangle_count));
    for (std::size_t t = 0; t < desc.triangle_count; ++t) {
        const std::uint32_t* const v = desc.triangles + 3 * t;
        for (int i = 0; i < 3; ++i)
            if (v[i] >= desc.positions.count)
                throw Error(VOX_ERROR_INVALID_MESH, format("shape triangle %zu names vertex %u of %llu", t,
                                                           v[i], llu(desc.positions.count)));
        triangles.push_back({v[0], v[1], v[2]});
    }
    return triangles;
}

Array<Vec3d> read_heights(const vox_shape_desc& desc, std::pmr::memory_resource* memory) {
    if (desc.columns < 2 || desc.rows < 2)
        refuse(
            format("shape has %u columns and %u rows, expected 2 or more of both", desc.columns, desc.rows));
    const std::uint64_t count = std::uint64_t{desc.columns} * desc.rows;
    if (count > VOX_MAX_SURFACE_TETS / 2)
        throw Error(VOX_ERROR_LIMIT,
                    format("shape has %llu heights, the limit is %u", llu(count), VOX_MAX_SURFACE_TETS / 2));
    require(desc.heights, "shape heights");
    for (int i = 0; i < 2; ++i)
        if (!(desc.spacing[i] > 0 && desc.spacing[i] * (i == 0 ? desc.columns : desc.rows) <= largest))
            refuse(format("shape spacing[%d] is %g, expected a number above 0 with a field of at most %g", i,
                          desc.spacing[i], largest));
    Array<Vec3d> points(memory);
    points.reserve(static_cast<std::size_t>(count));
    for (std::uint32_t row = 0; row < desc.rows; ++row)
        for (std::uint32_t column = 0; column < desc.columns; ++column) {
            const std::size_t i = points.size();
            check_coordinate(desc.heights[i], "height", i);
            points.push_back({column * desc.spacing[0], row * desc.spacing[1], desc.heights[i]});
        }
    return points;
}

void check_half_size(const vox_shape_desc& desc) {
    const char* const names[3] = {"half_size[0]", "half_size[1]", "half_size[2]"};
    for (int i = 0; i < 3; ++i) check_length(desc.half_size[i], names[i]);
}

template <class Made, class... Arguments>
std::shared_ptr<const RigidShape> made(std::pmr::memory_resource* memory, Arguments&&... arguments) {
    return std::allocate_shared<Made>(std::pmr::polymorphic_allocator<Made>(memory),
                                      std::forward<Arguments>(arguments)...);
}

} // namespace

std::shared_ptr<const RigidShape> make_shape(const vox_shape_desc& desc, std::pmr::memory_resource* memory) {
    check_enum(desc.kind, VOX_SHAPE_FIELD, "shape kind");
    switch (desc.kind) {
    case VOX_SHAPE_NONE:
        break;
    case VOX_SHAPE_HALF_SPACE:
        return made<HalfSpace>(memory, desc);
    case VOX_SHAPE_SPHERE:
        check_length(desc.radius, "radius");
        return made<Capsule>(memory, desc);
    case VOX_SHAPE_CAPSULE:
        check_length(desc.radius, "radius");
        check_length(desc.half_length, "half_length");
        return made<Capsule>(memory, desc);
    case VOX_SHAPE_CYLINDER:
        check_length(desc.radius, "radius");
        check_length(desc.half_length, "half_length");
        return made<Cylinder>(memory, desc);
    case VOX_SHAPE_BOX:
        check_half_size(desc);
        return made<BoxShape>(memory, desc, memory);
    case VOX_SHAPE_HEIGHTFIELD:
        return made<Heightfield>(memory, desc, read_heights(desc, memory));
    case VOX_SHAPE_SOLID:
        return made<ClosedSurface>(memory, desc, read_points(desc, memory), read_triangles(desc, memory));
    case VOX_SHAPE_SHEET:
        check_length(desc.radius, "radius");
        return made<Sheet>(memory, desc, read_points(desc, memory), read_triangles(desc, memory));
    case VOX_SHAPE_FIELD:
        if (!desc.field) refuse("shape field is null, expected a function");
        check_half_size(desc);
        return made<Field>(memory, desc);
    }
    refuse("shape kind is VOX_SHAPE_NONE, expected a shape");
}

} // namespace vox
