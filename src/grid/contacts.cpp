// Canonical order by least-significant-digit radix sort (Knuth, The Art of Computer Programming 3,
// Sect. 5.2.5) of body_a and vertex alone: few hits share a vertex, and those are put in order by themselves.
#include "grid/contacts.hpp"

#include "base/parallel.hpp"
#include "exact/barycentric.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

namespace vox {
namespace {

bool before(const Hit& x, const Hit& y) {
    return std::tuple(x.body_a, x.vertex, x.body_b, std::uint32_t(x.tet)) <
           std::tuple(y.body_a, y.vertex, y.body_b, std::uint32_t(y.tet));
}

bool same_vertex(const Hit& x, const Hit& y) { return x.vertex == y.vertex && x.body_a == y.body_a; }

// By body_a and vertex: one number of as few bits as these bodies need, cut into two equal digits or more.
// `contacts` is as long as `hits`, and holds them, bit by bit, after every other digit.
void radix_sort(std::span<const Body> bodies, std::span<Hit> hits, std::span<vox_contact> contacts) {
    static_assert(sizeof(Hit) == sizeof(vox_contact));
    constexpr int most_digit_bits = 11; // the counts and the places written to stay in the first cache
    constexpr std::size_t most_values = std::size_t{1} << most_digit_bits;
    std::uint32_t most_vertices = 1;
    for (const Body& body : bodies) most_vertices = std::max(most_vertices, body.vertex_count);
    const int vertex_bits = static_cast<int>(std::bit_width(most_vertices - 1));
    const int bits = vertex_bits + static_cast<int>(std::bit_width(bodies.size()));
    // Not many more counts than hits.
    const int wanted_bits = std::clamp(static_cast<int>(std::bit_width(hits.size())), 1, most_digit_bits);
    const int pairs = std::max((bits + 2 * wanted_bits - 1) / (2 * wanted_bits), 1); // of digits
    const int digit_bits = (bits + 2 * pairs - 1) / (2 * pairs);
    const std::size_t digit_values = std::size_t{1} << digit_bits;

    std::array<std::uint32_t, most_values> place[2]; // of the lower and the upper digit; first counts
    for (int pair = 0; pair < pairs; ++pair) {
        const auto digit = [=](const Hit& hit, int upper) {
            const std::uint64_t key = std::uint64_t{hit.body_a} << vertex_bits | hit.vertex;
            return static_cast<std::size_t>(key >> (2 * pair + upper) * digit_bits) & (digit_values - 1);
        };
        for (auto& counts : place) std::fill_n(counts.begin(), digit_values, 0u);
        for (const Hit& hit : hits) {
            ++place[0][digit(hit, 0)];
            ++place[1][digit(hit, 1)];
        }
        for (auto& counts : place) {
            std::uint32_t sum = 0;
            for (std::size_t v = 0; v < digit_values; ++v) sum += std::exchange(counts[v], sum);
        }
        for (const Hit& hit : hits) contacts[place[0][digit(hit, 0)]++] = std::bit_cast<vox_contact>(hit);
        for (const vox_contact& contact : contacts) {
            const Hit hit = std::bit_cast<Hit>(contact);
            hits[place[1][digit(hit, 1)]++] = hit;
        }
    }
}

// Moves those of [begin, end), all with the same body_a and vertex, that become contacts to `kept`, in
// canonical order: for each body_b the hits in the interior of a tetrahedron, or else the first of those on a
// boundary.
Hit* keep(Hit* begin, Hit* end, Hit* kept) {
    std::sort(begin, end, before);
    for (Hit* next; begin != end; begin = next) {
        bool any_interior = false;
        for (next = begin; next != end && next->body_b == begin->body_b; ++next)
            any_interior |= next->interior != 0;
        if (!any_interior)
            *kept++ = *begin;
        else
            kept = std::copy_if(begin, next, kept, [](const Hit& hit) { return hit.interior != 0; });
    }
    return kept;
}

// The contacts of the block of hits from `first` on.
void write_block(std::span<const Body> bodies, bool rounded, std::span<const Hit> hits, std::size_t first,
                 vox_contact* out) {
    const std::size_t count = std::min(barycentric_block, hits.size() - first);
    const std::span<const Hit> block = hits.subspan(first, count);
    bool complete = true;
    for (std::size_t i = 0; i < count; ++i) {
        const Hit& hit = block[i];
        const float* w = hit.weights.of;
        out[first + i] = {bodies[hit.body_a].mesh_id,
                          hit.vertex,
                          bodies[hit.body_b].mesh_id,
                          std::uint32_t(hit.tet),
                          {w[0], w[1], w[2], w[3]}};
        complete &= hit.weights.known();
    }
    if (complete) return;
    BarycentricWeights weights;
    barycentric(bodies, rounded, hits, first, weights);
    for (std::size_t i = 0; i < count; ++i)
        if (!block[i].weights.known())
            std::copy(weights[i].begin(), weights[i].end(), out[first + i].barycentric);
}

// With room for a few more, so that a few more contacts in a later step allocate nothing.
void resize(std::pmr::vector<vox_contact>& contacts, std::size_t count) {
    if (contacts.capacity() < count) {
        contacts.clear();
        contacts.reserve(count + count / 8);
    }
    contacts.resize(count);
}

} // namespace

void make_contacts(std::span<const Body> bodies, std::pmr::vector<Hit>& hits,
                   std::pmr::vector<vox_contact>& contacts, Workers* workers) {
    resize(contacts, hits.size());
    if (hits.size() <= UINT32_MAX) // what 32-bit counts are enough for
        radix_sort(bodies, hits, contacts);
    else
        std::sort(hits.begin(), hits.end(), before);

    Hit* kept = hits.data();
    Hit* const last = hits.data() + hits.size();
    for (Hit *begin = hits.data(), *end; begin != last; begin = end) {
        end = begin + 1;
        while (end != last && same_vertex(*begin, *end)) ++end;
        if (end - begin == 1)
            *kept++ = *begin;
        else
            kept = keep(begin, end, kept);
    }
    hits.resize(static_cast<std::size_t>(kept - hits.data()));
    contacts.resize(hits.size());

    const bool rounded =
        std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.positions.rounded(); });
    const std::size_t blocks = (hits.size() + barycentric_block - 1) / barycentric_block;
    const auto write = [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t b = begin; b < end; ++b)
            write_block(bodies, rounded, hits, b * barycentric_block, contacts.data());
    };
    constexpr std::size_t least_blocks = 16; // worth a task
    if (workers && workers->count() > 1 && blocks > least_blocks)
        workers->for_ranges(blocks, least_blocks, write);
    else
        write(0, blocks, 0);
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
