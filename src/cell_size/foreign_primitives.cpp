#include "cell_size/foreign_primitives.hpp"

#include "base/sampling.hpp"
#include "base/structs.hpp"
#include "mesh/check.hpp"

#include <cinttypes>
#include <cmath>
#include <limits>

namespace vox {

namespace {

constexpr int corners_of_type[] = {1, 2, 3, 4, 2};

void check_length(double value, const char* where, const char* name) {
    if (!(value >= 0) || !std::isfinite(value))
        refuse(format("%s%s is %.9g, expected 0 or a length", where, name, value));
}

// A stride of 0 means tightly packed.
std::size_t checked_stride(std::uint64_t stride, std::uint64_t size, std::uint64_t count, const char* where,
                           const char* name) {
    if (stride == 0) stride = size;
    if (stride < size)
        refuse(
            format("%s%s is %" PRIu64 ", expected 0 or at least %" PRIu64 " bytes", where, name, stride, size));
    constexpr std::uint64_t most_bytes = std::numeric_limits<std::ptrdiff_t>::max();
    if (stride > most_bytes / count)
        refuse(format("%s%s is %" PRIu64 ", too large for %" PRIu64 " primitives", where, name, stride, count));
    return static_cast<std::size_t>(stride);
}

} // namespace

vox_primitives primitives_defaults() {
    vox_primitives primitives{};
    primitives.struct_size = sizeof primitives;
    return primitives;
}

Primitives::Primitives(const vox_primitives& desc, const char* where) : where_(where) {
    check_enum(desc.type, VOX_PRIMITIVE_BOX, format("%stype", where).c_str());
    check_format(desc.position_format, where);
    check_enum(desc.radius_format, VOX_FORMAT_DOUBLE3, format("%sradius_format", where).c_str());
    if (desc.count == 0) refuse(format("%scount is 0, expected at least one primitive", where));
    if (desc.count > std::numeric_limits<std::uint32_t>::max())
        throw Error(VOX_ERROR_LIMIT,
                    format("%scount is %" PRIu64 ", the limit is 2^32 - 1", where, desc.count));
    count_ = desc.count;
    corners_ = corners_of_type[enum_value(desc.type)];
    is_box_ = enum_value(desc.type) == VOX_PRIMITIVE_BOX;
    vertex_count_ = desc.vertex_count;
    if (!desc.positions) refuse(format("%spositions is null", where));
    positions_ = check_positions(desc.positions, desc.position_format, desc.position_byte_stride,
                                 desc.position_component_byte_stride, desc.vertex_count, where);
    indices_ = reinterpret_cast<const std::byte*>(desc.indices);
    const auto corners = static_cast<std::uint64_t>(corners_);
    index_stride_ = checked_stride(desc.index_byte_stride, corners * sizeof(std::uint32_t), count_, where,
                                   "index_byte_stride");
    if (!indices_ && vertex_count_ / corners < count_)
        throw Error(VOX_ERROR_INVALID_MESH,
                    format("%s%" PRIu64 " primitives of %" PRIu64 " vertices each, but vertex_count is %" PRIu64,
                           where, count_, corners, vertex_count_));
    radii_ = static_cast<const std::byte*>(desc.radii);
    double_radii_ = enum_value(desc.radius_format) == VOX_FORMAT_DOUBLE3;
    radius_stride_ = checked_stride(desc.radius_byte_stride, double_radii_ ? sizeof(double) : sizeof(float),
                                    count_, where, "radius_byte_stride");
    check_length(desc.radius, where, "radius");
    radius_ = desc.radius;
}

std::uint64_t Primitives::vertex(std::uint64_t primitive, int corner) const noexcept {
    if (!indices_)
        return primitive * static_cast<std::uint64_t>(corners_) + static_cast<std::uint64_t>(corner);
    std::uint32_t index;
    std::memcpy(&index,
                indices_ + primitive * index_stride_ + static_cast<std::size_t>(corner) * sizeof index,
                sizeof index);
    return index;
}

double Primitives::radius(std::uint64_t primitive) const {
    if (!radii_) return radius_;
    double own;
    const std::byte* from = radii_ + primitive * radius_stride_;
    if (double_radii_) {
        std::memcpy(&own, from, sizeof own);
    } else {
        float single;
        std::memcpy(&single, from, sizeof single);
        own = double{single};
    }
    if (!std::isfinite(own))
        throw Error(VOX_ERROR_NON_FINITE,
                    format("%sradius %" PRIu64 " is %g, not finite", where_, primitive, own));
    if (own < 0) refuse(format("%sradius %" PRIu64 " is %g, expected 0 or a length", where_, primitive, own));
    return own + radius_;
}

void Primitives::refuse_position(std::uint64_t primitive, std::uint64_t v) const {
    const Vec3d p = positions_.exact(static_cast<std::size_t>(v));
    const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    throw Error(finite ? VOX_ERROR_LIMIT : VOX_ERROR_NON_FINITE,
                format("%sprimitive %" PRIu64 " has vertex %" PRIu64 " at (%g, %g, %g), %s", where_, primitive,
                       v, p.x, p.y, p.z, finite ? "too large for a float" : "not finite"));
}

Vec3d Primitives::corner(std::uint64_t primitive, int corner) const {
    return positions_.exact(static_cast<std::size_t>(vertex(primitive, corner)));
}

PlainBox Primitives::box(std::uint64_t primitive) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    // Less than any double that rounds to an infinite float, NaN included.
    constexpr double most = 3.4028235677973362e38;
    PlainBox box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (int c = 0; c < corners_; ++c) {
        const std::uint64_t v = vertex(primitive, c);
        if (v >= vertex_count_)
            throw Error(VOX_ERROR_INVALID_MESH,
                        format("%sprimitive %" PRIu64 " names vertex %" PRIu64 " of %" PRIu64, where_, primitive,
                               v, vertex_count_));
        const Vec3d p = positions_.exact(static_cast<std::size_t>(v));
        if (!(std::abs(p.x) < most && std::abs(p.y) < most && std::abs(p.z) < most))
            refuse_position(primitive, v);
        box.include({{p.x, p.y, p.z}, {p.x, p.y, p.z}});
    }
    return box;
}

PrimitiveSums sum_boxes(const Primitives& primitives, double grown, bool centres, std::uint64_t most,
                        bool wants_all) {
    PrimitiveSums sums;
    sums.count = static_cast<double>(primitives.count());
    const std::uint64_t wanted = wants_all ? primitives.count() : std::min(primitives.count(), most);
    sums.all = wanted == primitives.count();
    bool first = true;
    double radii = 0;
    for_stratified(primitives.count(), wanted, 0.5, [&](std::uint64_t i) {
        PlainBox box = primitives.box(i);
        const double radius = primitives.radius(i) + grown;
        box.grow(radius);
        radii += radius;
        sums.cells.add(cells_met({box.side(0), box.side(1), box.side(2)}));
        sums.longest = std::max(sums.longest, box.longest_side());
        const PlainBox place = centres ? box.centre() : box;
        if (first) sums.bounds = place;
        first = false;
        sums.bounds.include(place);
    });
    const double each = 1 / static_cast<double>(wanted);
    sums.radius = radii * each;
    for (double& sum : sums.cells.sum) sum *= sums.count * each;
    return sums;
}

BoxSample sample_boxes(const Primitives& primitives, double grown, std::uint64_t wanted, std::uint64_t seed,
                       std::pmr::memory_resource* memory) {
    BoxSample sample(memory);
    const std::uint64_t count = primitives.count(), size = std::min(count, wanted);
    sample.boxes.reserve(static_cast<std::size_t>(size));
    sample.ids.reserve(static_cast<std::size_t>(size));
    const double part = static_cast<double>(count) / static_cast<double>(size);
    for (std::uint64_t i = 0; i < size; ++i) {
        std::uint64_t at = i;
        if (size < count) {
            const double place = static_cast<double>(next_random(seed) >> 11) * 0x1p-53;
            at = std::min(static_cast<std::uint64_t>((static_cast<double>(i) + place) * part), count - 1);
        }
        PlainBox box = primitives.box(at);
        box.grow(primitives.radius(at) + grown);
        sample.boxes.push_back(box);
        sample.ids.push_back(static_cast<std::uint32_t>(at));
    }
    return sample;
}

} // namespace vox
