// Canonical order by least-significant-digit radix sort (Knuth, The Art of Computer Programming 3,
// Sect. 5.2.5): hits may be millions, their keys are four integers, and most digits are the same in all of
// them and cost nothing.
#include "contacts.hpp"

#include "predicates.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

namespace vox {
namespace {

constexpr std::size_t field_count = 4;
constexpr std::size_t digits_per_field = 4; // of 8 bits
constexpr std::size_t digit_values = 256;

// The sort key, from its least to its most significant field.
std::array<std::uint32_t, field_count> key(const Hit& hit) {
    return {hit.tet, hit.body_b, hit.vertex, hit.body_a};
}

bool before(const Hit& x, const Hit& y) {
    return std::tuple(x.body_a, x.vertex, x.body_b, std::uint32_t(x.tet)) <
           std::tuple(y.body_a, y.vertex, y.body_b, std::uint32_t(y.tet));
}

bool tets_ascend(const std::pmr::vector<Hit>& hits) {
    return std::is_sorted(hits.begin(), hits.end(), [](const Hit& x, const Hit& y) {
        return std::tuple(x.body_b, std::uint32_t(x.tet)) < std::tuple(y.body_b, std::uint32_t(y.tet));
    });
}

void radix_sort(std::pmr::vector<Hit>& hits, std::pmr::vector<Hit>& scratch) {
    // The sort is stable: hits that come in the order of (body_b, tet) need only the two other fields.
    const std::size_t first_field = tets_ascend(hits) ? 2 : 0;

    std::uint32_t counts[field_count][digits_per_field][digit_values] = {};
    for (const Hit& hit : hits) {
        const auto fields = key(hit);
        for (std::size_t f = first_field; f < field_count; ++f)
            for (std::size_t d = 0; d < digits_per_field; ++d) ++counts[f][d][fields[f] >> (8 * d) & 255];
    }

    scratch.resize(hits.size());
    for (std::size_t f = first_field; f < field_count; ++f) {
        for (std::size_t d = 0; d < digits_per_field; ++d) {
            std::uint32_t(&position)[digit_values] = counts[f][d];
            if (position[key(hits.front())[f] >> (8 * d) & 255] == hits.size()) continue; // all the same
            std::uint32_t sum = 0;
            for (std::uint32_t& p : position) sum += std::exchange(p, sum);
            for (const Hit& hit : hits) scratch[position[key(hit)[f] >> (8 * d) & 255]++] = hit;
            hits.swap(scratch);
        }
    }
}

// Leaves, per (body_a, vertex, body_b), the hits in the interior of a tetrahedron, or else the first of those
// on a boundary. `hits` is sorted.
void drop_shared_boundaries(std::pmr::vector<Hit>& hits) {
    std::size_t kept = 0;
    for (std::size_t begin = 0, end; begin < hits.size(); begin = end) {
        bool any_interior = false;
        for (end = begin; end < hits.size() && hits[end].body_a == hits[begin].body_a &&
                          hits[end].vertex == hits[begin].vertex && hits[end].body_b == hits[begin].body_b;
             ++end)
            any_interior |= hits[end].interior != 0;
        if (!any_interior) {
            hits[kept++] = hits[begin];
            continue;
        }
        for (std::size_t h = begin; h < end; ++h)
            if (hits[h].interior) hits[kept++] = hits[h];
    }
    hits.resize(kept);
}

} // namespace

void make_contacts(std::span<const Body> bodies, std::pmr::vector<Hit>& hits, std::pmr::vector<Hit>& scratch,
                   std::pmr::vector<vox_contact>& contacts) {
    constexpr std::size_t few = 256; // where clearing the counts costs more than sorting; any number will do
    // A 32-bit count per digit is enough for 2^32 - 1 hits.
    if (hits.size() < few || hits.size() > UINT32_MAX)
        std::sort(hits.begin(), hits.end(), before);
    else
        radix_sort(hits, scratch);
    drop_shared_boundaries(hits);

    contacts.resize(hits.size());
    for (std::size_t h = 0; h < hits.size(); ++h) {
        const Hit& hit = hits[h];
        const Body& body_b = bodies[hit.body_b];
        const std::uint32_t tet = hit.tet;
        const std::uint32_t* corner = body_b.tets[tet].v;
        const std::array<float, 4> weights = barycentric(
            bodies[hit.body_a].positions[hit.vertex], body_b.positions[corner[0]],
            body_b.positions[corner[1]], body_b.positions[corner[2]], body_b.positions[corner[3]]);
        contacts[h] = {bodies[hit.body_a].mesh_id,
                       hit.vertex,
                       body_b.mesh_id,
                       tet,
                       {weights[0], weights[1], weights[2], weights[3]}};
    }
}

std::uint64_t hash_contacts(std::span<const vox_contact> contacts) noexcept {
    std::uint64_t state = contacts.size();
    const auto add = [&state](std::uint32_t low, std::uint32_t high) {
        const std::uint64_t word = low | std::uint64_t(high) << 32;
        state = (state ^ word) * 0x9fb21c651e98df25u;
        state ^= state >> 29;
    };
    for (const vox_contact& contact : contacts) {
        add(contact.mesh_a, contact.vertex);
        add(contact.mesh_b, contact.tet);
        add(std::bit_cast<std::uint32_t>(contact.barycentric[0]),
            std::bit_cast<std::uint32_t>(contact.barycentric[1]));
        add(std::bit_cast<std::uint32_t>(contact.barycentric[2]),
            std::bit_cast<std::uint32_t>(contact.barycentric[3]));
    }
    return state;
}

} // namespace vox
