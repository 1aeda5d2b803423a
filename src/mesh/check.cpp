#include "mesh/check.hpp"

#include "base/structs.hpp"
#include "mesh/filter.hpp"

#include <algorithm>
#include <bit>
#include <cinttypes>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace vox {

static_assert(sizeof(Tet) == 4 * sizeof(std::uint32_t) && alignof(Tet) == alignof(std::uint32_t),
              "tets are viewed in the caller's index array");

Body check_mesh(const vox_mesh_desc& desc, const char* where, NullPositions null_positions) {
    constexpr std::uint32_t known_flags = VOX_MESH_COPY_POSITIONS | VOX_MESH_BORROW_TETS;
    if (desc.flags & ~known_flags)
        refuse(format("%sflags is 0x%" PRIx32 ", of which 0x%" PRIx32 " is unknown", where, desc.flags,
                      desc.flags & ~known_flags));
    if (desc.positions.count > VOX_MAX_VERTICES)
        throw Error(VOX_ERROR_LIMIT, format("%spositions.count is %" PRIu64 ", the limit is %" PRIu32, where,
                                            desc.positions.count, VOX_MAX_VERTICES));
    if (desc.tet_count > VOX_MAX_TETS)
        throw Error(VOX_ERROR_LIMIT, format("%stet_count is %" PRIu64 ", the limit is %" PRIu32, where,
                                            desc.tet_count, VOX_MAX_TETS));
    const Positions positions = check_positions(desc.positions, format("%spositions", where).c_str());
    if (!desc.positions.data && desc.positions.count > 0 && null_positions == NullPositions::rejected)
        refuse(format("%spositions.data is null, positions.count is %" PRIu64, where, desc.positions.count));
    if (!desc.tets && desc.tet_count > 0)
        refuse(format("%stets is null, tet_count is %" PRIu64, where, desc.tet_count));
    if (reinterpret_cast<std::uintptr_t>(desc.tets) % alignof(Tet) != 0)
        refuse(format("%stets is not aligned to %zu bytes", where, alignof(Tet)));

    Body body;
    body.vertex_count = static_cast<std::uint32_t>(desc.positions.count);
    body.user_data = desc.user_data;
    body.positions = positions;
    body.tets = {reinterpret_cast<const Tet*>(desc.tets), static_cast<std::size_t>(desc.tet_count)};
    body.self_collision = collides_with_itself(desc.filter);
    for (std::size_t tet = 0; tet < body.tets.size(); ++tet)
        for (const std::uint32_t vertex : body.tets[tet].v)
            if (vertex >= body.vertex_count)
                throw Error(VOX_ERROR_INVALID_MESH, format("%stet %zu names vertex %" PRIu32 " of %" PRIu32,
                                                           where, tet, vertex, body.vertex_count));
    return body;
}

std::string name_of(const Body& body) {
    if (body.slot == Body::no_slot) return format("the mesh (user data %" PRIu64 ")", body.user_data);
    if (body.slot == Body::in_array)
        return format("mesh %" PRIu32 " (user data %" PRIu64 ")", body.mesh_id, body.user_data);
    return format("body %" PRIu32 " (slot %" PRIu32 ", user data %" PRIu64 ")", body.mesh_id, body.slot,
                  body.user_data);
}

namespace {

bool all_finite(const auto& p) noexcept {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

} // namespace

bool is_finite(const Body& body, std::uint32_t vertex) noexcept { return all_finite(body.positions[vertex]); }

std::uint32_t first_bad_vertex(const Body& body) noexcept {
    for (std::uint32_t v = 0; v < body.vertex_count; ++v)
        if (!is_finite(body, v)) return v;
    return VOX_NONE;
}

vox_result bad_position(const Body& body, std::uint32_t vertex) noexcept {
    return all_finite(body.positions.exact(vertex)) ? VOX_ERROR_LIMIT : VOX_ERROR_NON_FINITE;
}

void check_finite(const Body& body) {
    if (const std::uint32_t vertex = first_bad_vertex(body); vertex != VOX_NONE)
        throw position_error(body, vertex);
}

MeshError position_error(const Body& body, std::uint32_t vertex) {
    const Vec3d p = body.positions.exact(vertex);
    const vox_result result = bad_position(body, vertex);
    return MeshError(result, body,
                     format(", vertex %" PRIu32 ": position (%g, %g, %g) is %s", vertex, p.x, p.y, p.z,
                            result == VOX_ERROR_LIMIT
                                ? "too large: coordinates are below 2^128 - 2^103 = 3.4028236e+38"
                                : "not finite"),
                     vertex);
}

namespace {

// Packed numbers that are read as floats, as words of doubles.
struct WordCounts {
    std::uint32_t tiny = 0, huge = 0; // low words below 2^-40, beyond 2^40
    bool ordinary = true;             // all high words are 0, or from 2^-30 to 2^31
};

// Counts the numbers [first, last), where `first` is even.
void count_words(const std::byte* data, std::size_t first, std::size_t last, WordCounts& counts) noexcept {
    constexpr std::size_t high_word = std::endian::native == std::endian::little ? 1 : 0;
    for (std::size_t i = first; i < last; ++i) {
        std::uint32_t bits;
        std::memcpy(&bits, data + i * sizeof bits, sizeof bits);
        const std::uint32_t magnitude = bits & 0x7fffffffu;
        const int exponent = static_cast<int>(magnitude >> 23) - 127;
        if (i % 2 == high_word) {
            counts.ordinary &= magnitude == 0 || (exponent >= -30 && exponent <= 30);
        } else {
            counts.tiny += magnitude != 0 && exponent < -40;
            counts.huge += exponent > 40;
        }
    }
}

} // namespace

// Doubles of ordinary size, 2^-240 to 2^240, are pairs of a low word and a high one. As a float, the high
// word is 0 or from 2^-30 to 2^31, for the float's exponent has the upper bits of the double's. The low word
// is the end of the mantissa: where it is not 0, most of its patterns are floats beyond 2^40 or below 2^-40.
// Three numbers make a position, so x, y and z would change with the parity of the vertex; no mesh of floats
// does that. Doubles with short mantissas, e.g. whole numbers, have low words of 0 and are not told apart
// here.
bool check_not_doubles(const Body& body) {
    constexpr std::uint32_t least_vertices = 16, most_vertices = 4096;
    const Positions& given = body.positions;
    if (given.doubles || given.byte_stride != sizeof(Vec3f) || given.component_gap != 0) return true;
    if (body.vertex_count < least_vertices) return false;
    // A look at some of them clears almost every mesh of floats.
    WordCounts some, all;
    constexpr std::size_t run = 3 * std::size_t{least_vertices};
    const std::size_t end = 3 * std::size_t{body.vertex_count};
    for (const std::size_t at : {std::size_t{0}, (end - run) / 2, end - run})
        count_words(given.data, at & ~std::size_t{1}, (at & ~std::size_t{1}) + run, some);
    if (!some.ordinary || some.tiny + some.huge == 0) return true;

    const std::size_t numbers = 3 * std::size_t{std::min(body.vertex_count, most_vertices)} & ~std::size_t{1};
    count_words(given.data, 0, numbers, all);
    const std::size_t enough = numbers / 64 + 1; // one low word in 32
    if (!all.ordinary || all.tiny < enough || all.huge < enough) return true;
    throw MeshError(
        VOX_ERROR_INVALID_ARGUMENT, body,
        format(": its positions are doubles, but their format is VOX_FORMAT_FLOAT (of %zu numbers, "
               "every other is of ordinary size; of those between, %" PRIu32 " are beyond 2^40 and %" PRIu32
               " below 2^-40)",
               numbers, all.huge, all.tiny));
}

} // namespace vox
