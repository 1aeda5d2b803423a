#include "mesh/check.hpp"

#include "base/error.hpp"
#include "base/structs.hpp"

#include <cinttypes>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace vox {

static_assert(sizeof(Tet) == 4 * sizeof(std::uint32_t) && alignof(Tet) == alignof(std::uint32_t),
              "tets are viewed in the caller's index array");

std::size_t check_stride(std::uint64_t byte_stride, vox_format position_format, std::uint64_t vertex_count,
                         const char* where) {
    const std::size_t size = position_format == VOX_FORMAT_DOUBLE3 ? sizeof(Vec3d) : sizeof(Vec3f);
    if (byte_stride == 0) return size;
    if (byte_stride < size)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("%sposition_byte_stride is %" PRIu64 ", expected 0 or at least %zu", where,
                           byte_stride, size));
    // No array is larger than this; a stride that would make it so is a mistake, not a huge mesh.
    constexpr std::uint64_t most_bytes = std::numeric_limits<std::ptrdiff_t>::max();
    if (vertex_count > 0 && byte_stride > most_bytes / vertex_count)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("%sposition_byte_stride is %" PRIu64 ", too large for %" PRIu64 " vertices", where,
                           byte_stride, vertex_count));
    return static_cast<std::size_t>(byte_stride);
}

void check_format(const vox_format& position_format, const char* where) {
    const std::int32_t value = enum_value(position_format);
    if (value != VOX_FORMAT_FLOAT3 && value != VOX_FORMAT_DOUBLE3)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("%sposition_format is %" PRId32 ", not a vox_format", where, value));
}

Body check_mesh(const vox_mesh_desc& desc, const char* where, NullPositions null_positions) {
    constexpr std::uint32_t known_flags =
        VOX_MESH_SELF_COLLISION | VOX_MESH_COPY_POSITIONS | VOX_MESH_BORROW_TETS;
    if (desc.flags & ~known_flags)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("%sflags is 0x%" PRIx32 ", of which 0x%" PRIx32 " is unknown", where, desc.flags,
                           desc.flags & ~known_flags));
    if (desc.reserved != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("%sreserved is %" PRIu32 ", expected 0", where, desc.reserved));
    if (desc.vertex_count > VOX_MAX_VERTICES)
        throw Error(VOX_ERROR_LIMIT, format("%svertex_count is %" PRIu64 ", the limit is %" PRIu32, where,
                                            desc.vertex_count, VOX_MAX_VERTICES));
    if (desc.tet_count > VOX_MAX_TETS)
        throw Error(VOX_ERROR_LIMIT, format("%stet_count is %" PRIu64 ", the limit is %" PRIu32, where,
                                            desc.tet_count, VOX_MAX_TETS));
    check_format(desc.position_format, where);
    const std::size_t stride =
        check_stride(desc.position_byte_stride, desc.position_format, desc.vertex_count, where);
    if (!desc.positions && desc.vertex_count > 0 && null_positions == NullPositions::rejected)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("%spositions is null, vertex_count is %" PRIu64, where, desc.vertex_count));
    if (!desc.tets && desc.tet_count > 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("%stets is null, tet_count is %" PRIu64, where, desc.tet_count));
    if (reinterpret_cast<std::uintptr_t>(desc.tets) % alignof(Tet) != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("%stets is not aligned to %zu bytes", where, alignof(Tet)));

    Body body;
    body.vertex_count = static_cast<std::uint32_t>(desc.vertex_count);
    body.positions = {static_cast<const std::byte*>(desc.positions), stride,
                      desc.position_format == VOX_FORMAT_DOUBLE3};
    body.tets = {reinterpret_cast<const Tet*>(desc.tets), static_cast<std::size_t>(desc.tet_count)};
    body.self_collision = (desc.flags & VOX_MESH_SELF_COLLISION) != 0;
    for (std::size_t tet = 0; tet < body.tets.size(); ++tet)
        for (const std::uint32_t vertex : body.tets[tet].v)
            if (vertex >= body.vertex_count)
                throw Error(VOX_ERROR_INVALID_MESH, format("%stet %zu names vertex %" PRIu32 " of %" PRIu32,
                                                           where, tet, vertex, body.vertex_count));
    return body;
}

void check_finite(const Body& body) {
    for (std::uint32_t v = 0; v < body.vertex_count; ++v) check_finite(body, v);
}

void check_finite(const Body& body, std::uint32_t vertex) {
    const auto all_finite = [](const auto& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };
    if (all_finite(body.positions[vertex])) return;
    const Vec3d p = body.positions.exact(vertex);
    const auto refuse = [&](vox_result result, const char* why) {
        throw Error(result, format("mesh %" PRIu32 ", vertex %" PRIu32 ": position (%g, %g, %g) is %s",
                                   body.mesh_id, vertex, p.x, p.y, p.z, why));
    };
    if (!all_finite(p)) refuse(VOX_ERROR_NON_FINITE, "not finite");
    refuse(VOX_ERROR_LIMIT, "too large: coordinates are below 2^128 - 2^103 = 3.4028236e+38");
}

} // namespace vox
