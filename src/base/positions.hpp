// The caller's arrays of positions.
#pragma once

#include "base/error.hpp"
#include "base/scene.hpp"
#include "base/structs.hpp"

#include <vox/vox.h>

#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace vox {

// Checks format and strides of the caller's positions, and views them. They may be null. Errors call them
// `name`, for example "mesh 1: positions". Throws INVALID_ARGUMENT.
inline Positions check_positions(const vox_positions& given, const char* name) {
    const std::int32_t format_value = enum_value(given.format);
    if (format_value != VOX_FORMAT_FLOAT && format_value != VOX_FORMAT_DOUBLE)
        refuse(format("%s.format is %" PRId32 ", not a vox_format", name, format_value));
    if (given.reserved != 0) refuse(format("%s.reserved is %" PRIu32 ", expected 0", name, given.reserved));
    const bool doubles = format_value == VOX_FORMAT_DOUBLE;
    const std::uint64_t count = given.count, number = doubles ? sizeof(double) : sizeof(float);
    const std::uint64_t component = given.component_byte_stride == 0 ? number : given.component_byte_stride;
    const bool together = component == number;
    const std::uint64_t stride = given.byte_stride != 0 ? given.byte_stride : together ? 3 * number : number;
    // No array is larger; a stride that says so is a mistake, not a huge mesh.
    constexpr std::uint64_t most_bytes = std::numeric_limits<std::ptrdiff_t>::max();
    if (count > 0 && stride > most_bytes / count)
        refuse(format("%s.byte_stride is %" PRIu64 ", too large for %" PRIu64 " positions", name, stride,
                      count));
    if (component > most_bytes / 4 || (count > 0 && stride > (most_bytes - 2 * component) / count))
        refuse(format("%s.component_byte_stride is %" PRIu64 ", too large for %" PRIu64 " positions %" PRIu64
                      " bytes apart",
                      name, component, count, stride));
    const std::uint64_t least = together ? 3 * number : number;
    if (stride < least && (together || count > 1))
        refuse(format("%s.byte_stride is %" PRIu64 ", expected 0 or at least %" PRIu64, name, stride, least));
    const bool rows = stride >= 2 * component + number;
    const bool columns = count <= 1 || component >= (count - 1) * stride + number;
    if (component < number || (!rows && !columns))
        refuse(format("%s.component_byte_stride is %" PRIu64 ", byte_stride %" PRIu64 ": %" PRIu64
                      " positions would overlap; columns need at least %" PRIu64,
                      name, component, stride, count, count * stride));
    return {.data = static_cast<const std::byte*>(given.data),
            .byte_stride = static_cast<std::size_t>(stride),
            .doubles = doubles,
            .component_gap = static_cast<std::size_t>(component - number)};
}

// Checks in addition that there is one position for each vertex of a mesh.
inline Positions check_positions_of(std::uint64_t vertex_count, const vox_positions& given,
                                    const char* name) {
    if (given.count != vertex_count)
        refuse(format("%s.count is %" PRIu64 ", expected %" PRIu64 ", one for each vertex", name, given.count,
                      vertex_count));
    return check_positions(given, name);
}

// The opposite of check_positions(); no stride is 0.
inline vox_positions as_given(const Positions& positions, std::uint64_t count) noexcept {
    const std::size_t number = positions.doubles ? sizeof(double) : sizeof(float);
    return {.data = positions.data,
            .count = count,
            .format = positions.doubles ? VOX_FORMAT_DOUBLE : VOX_FORMAT_FLOAT,
            .reserved = 0,
            .byte_stride = positions.byte_stride,
            .component_byte_stride = number + positions.component_gap};
}

} // namespace vox
