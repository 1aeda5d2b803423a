// Canonical order by radix sort (Knuth, The Art of Computer Programming 3, Sect. 5.2.5) of body_a and vertex
// alone: few hits share a vertex, and those are put in order by themselves. Of many hits the most significant
// digit comes first, and the others piece by piece.
#include "grid/contacts.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <tuple>
#include <utility>

namespace vox {
namespace {

bool before(const Hit& x, const Hit& y) {
    return std::tuple(x.body_a, x.vertex, x.body_b, std::uint32_t(x.tet)) <
           std::tuple(y.body_a, y.vertex, y.body_b, std::uint32_t(y.tet));
}

// A hit is kept in either list, bit by bit, while they are sorted.
static_assert(sizeof(Hit) == sizeof(vox_contact) && offsetof(Hit, body_a) == offsetof(vox_contact, body_a) &&
              offsetof(Hit, vertex) == offsetof(vox_contact, vertex));
std::uint32_t body_of(const Hit& hit) { return hit.body_a; }
std::uint32_t body_of(const vox_contact& contact) { return contact.body_a; }

template <class Stored>
bool same_vertex(const Stored& x, const Stored& y) {
    return x.vertex == y.vertex && body_of(x) == body_of(y);
}

// body_a and vertex as one number of as few bits as these bodies need.
struct SortKey {
    explicit SortKey(std::span<const Body> bodies) {
        std::uint32_t most_vertices = 1;
        for (const Body& body : bodies) most_vertices = std::max(most_vertices, body.vertex_count);
        vertex_bits = static_cast<int>(std::bit_width(most_vertices - 1));
        bits = vertex_bits + static_cast<int>(std::bit_width(bodies.size()));
    }

    template <class Stored>
    std::uint64_t of(const Stored& stored) const {
        return std::uint64_t{body_of(stored)} << vertex_bits | stored.vertex;
    }
    template <class Stored>
    std::size_t digit(const Stored& stored, int shift, std::size_t values) const {
        return static_cast<std::size_t>(of(stored) >> shift) & (values - 1);
    }

    int vertex_bits, bits;
};

constexpr int most_digit_bits = 11; // the counts and the places written to stay in the first cache
using Places = std::array<std::uint32_t, std::size_t{1} << most_digit_bits>; // of each value; first counts

void sum(Places& places, std::size_t values) {
    std::uint32_t before = 0;
    for (std::size_t v = 0; v < values; ++v) before += std::exchange(places[v], before);
}

template <class Stored, class Other>
void move_by_digit(const SortKey& key, int shift, std::size_t values, std::span<const Stored> from,
                   std::span<Other> to, Places& places) {
    for (const Stored& stored : from)
        to[places[key.digit(stored, shift, values)]++] = std::bit_cast<Other>(stored);
}

// By the lowest `bits` of the key, cut into two equal digits or more. `other` is as long as `hits`, and holds
// them after every other digit.
template <class Stored, class Other>
void sort_by_low_bits(const SortKey& key, int bits, std::span<Stored> hits, std::span<Other> other) {
    // Not many more counts than hits.
    const int wanted_bits = std::clamp(static_cast<int>(std::bit_width(hits.size())), 1, most_digit_bits);
    const int pairs = std::max((bits + 2 * wanted_bits - 1) / (2 * wanted_bits), 1); // of digits
    const int digit_bits = (bits + 2 * pairs - 1) / (2 * pairs);
    const std::size_t values = std::size_t{1} << digit_bits;
    Places low, high;
    for (int shift = 0; shift < 2 * pairs * digit_bits; shift += 2 * digit_bits) {
        for (Places* places : {&low, &high}) std::fill_n(places->begin(), values, 0u);
        for (const Stored& hit : hits) {
            ++low[key.digit(hit, shift, values)];
            ++high[key.digit(hit, shift + digit_bits, values)];
        }
        for (Places* places : {&low, &high}) sum(*places, values);
        move_by_digit(key, shift, values, std::span<const Stored>(hits), other, low);
        move_by_digit(key, shift + digit_bits, values, std::span<const Other>(other), hits, high);
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

// The same for hits in order. `kept` may be where they are.
template <class Stored>
Hit* keep_all(std::span<const Stored> sorted, Hit* hits, Hit* kept) {
    for (std::size_t begin = 0, end; begin < sorted.size(); begin = end) {
        end = begin + 1;
        while (end < sorted.size() && same_vertex(sorted[begin], sorted[end])) ++end;
        if (end - begin == 1) {
            *kept++ = std::bit_cast<Hit>(sorted[begin]);
            continue;
        }
        for (std::size_t i = begin; i < end; ++i) hits[i] = std::bit_cast<Hit>(sorted[i]);
        kept = keep(hits + begin, hits + end, kept);
    }
    return kept;
}
Hit* keep_all(std::span<Hit> sorted) {
    return keep_all(std::span<const Hit>(sorted), sorted.data(), sorted.data());
}

// Calls function(i) for each i below `count`, in tasks unless there are no workers.
template <class Function>
void for_each(Workers* workers, std::size_t count, Function&& function) {
    const auto run = [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t i = begin; i < end; ++i) function(i);
    };
    for_ranges(workers, count, 1, run);
}

// Sorts the hits of a piece, which have all but the lowest bits of their keys in common, and moves those that
// become contacts to the front of `out`, which has as many places. Returns how many do.
std::uint32_t keep_piece(const SortKey& key, int low_bits, std::span<vox_contact> piece, std::span<Hit> out) {
    sort_by_low_bits(key, low_bits, piece, out);
    const Hit* end = keep_all(std::span<const vox_contact>(piece), out.data(), out.data());
    return static_cast<std::uint32_t>(end - out.data());
}

// As sort_and_keep(). The hits are first moved into pieces by the upper bits of their keys: each of a few
// chunks of the list counts its hits of every piece, which gives the places that it moves them to. A piece is
// then sorted in the first cache. Workers share chunks, then pieces.
Hit* sort_and_keep_in_pieces(const SortKey& key, std::span<Hit> hits, std::span<vox_contact> contacts,
                             Workers* workers) {
    constexpr std::size_t piece_size = 1024; // on average
    constexpr int chunk_bits = 4;
    const int piece_bits = std::min({static_cast<int>(std::bit_width(hits.size() / piece_size)),
                                     most_digit_bits - (workers ? chunk_bits - 2 : 0), key.bits});
    const int low_bits = key.bits - piece_bits;
    const std::size_t pieces = std::size_t{1} << piece_bits;
    const std::size_t chunks = workers ? std::size_t{1} << chunk_bits : 1;
    std::array<std::uint32_t, std::size_t{1} << (most_digit_bits + 2)> places; // of each chunk; first counts
    const auto in_chunk = [&](std::size_t c) {
        const std::size_t first = hits.size() * c / chunks;
        return std::span<const Hit>(hits).subspan(first, hits.size() * (c + 1) / chunks - first);
    };
    for_each(workers, chunks, [&](std::size_t c) {
        std::uint32_t* count = places.data() + c * pieces;
        std::fill_n(count, pieces, 0u);
        for (const Hit& hit : in_chunk(c)) ++count[key.digit(hit, low_bits, pieces)];
    });
    std::array<std::uint32_t, (std::size_t{1} << most_digit_bits) + 1>
        first_of; // hit of each piece, and the end
    std::uint32_t sum_before = 0;
    for (std::size_t p = 0; p < pieces; ++p) {
        first_of[p] = sum_before;
        for (std::size_t c = 0; c < chunks; ++c)
            sum_before += std::exchange(places[c * pieces + p], sum_before);
    }
    first_of[pieces] = sum_before;
    for_each(workers, chunks, [&](std::size_t c) {
        std::uint32_t* place = places.data() + c * pieces;
        for (const Hit& hit : in_chunk(c))
            contacts[place[key.digit(hit, low_bits, pieces)]++] = std::bit_cast<vox_contact>(hit);
    });
    Places kept; // of each piece
    for_each(workers, pieces, [&](std::size_t p) {
        const std::size_t first = first_of[p], count = first_of[p + 1] - first;
        kept[p] = keep_piece(key, low_bits, contacts.subspan(first, count), hits.subspan(first, count));
    });
    Hit* end = hits.data();
    for (std::size_t p = 0; p < pieces; end += kept[p++])
        if (const Hit* begin = hits.data() + first_of[p]; begin != end) std::copy_n(begin, kept[p], end);
    return end;
}

// Sorts the hits and keeps those that become contacts at the front. Returns their end. `contacts` is as long,
// and is overwritten.
Hit* sort_and_keep(std::span<const Body> bodies, std::span<Hit> hits, std::span<vox_contact> contacts,
                   Workers* workers) {
    constexpr std::size_t few = std::size_t{1} << 17; // 8 MiB in both lists, which the caches hold
    constexpr std::size_t few_for_tasks = std::size_t{1} << 13;
    const SortKey key(bodies);
    if (hits.size() > (workers ? few_for_tasks : few))
        return sort_and_keep_in_pieces(key, hits, contacts, workers);
    sort_by_low_bits(key, key.bits, hits, contacts);
    return keep_all(hits);
}

// With room for a few more, so that a few more contacts in a later step allocate nothing.
template <class Item>
void resize(Array<Item>& items, std::size_t count) {
    if (items.capacity() < count) {
        items.clear();
        items.reserve(count + count / 8);
    }
    items.resize(count);
}

} // namespace

void make_contacts(std::span<const Body> bodies, Array<Hit>& hits, Array<vox_contact>& contacts,
                   Workers* workers, Array<std::uint8_t>* interiors) {
    if (workers && workers->count() == 1) workers = nullptr;
    resize(contacts, hits.size());
    Hit* kept;
    if (hits.size() <= UINT32_MAX) { // what 32-bit counts are enough for
        kept = sort_and_keep(bodies, hits, contacts, workers);
    } else {
        std::sort(hits.begin(), hits.end(), before);
        kept = keep_all(std::span<Hit>(hits));
    }
    hits.resize(static_cast<std::size_t>(kept - hits.data()));
    contacts.resize(hits.size());
    if (interiors) resize(*interiors, hits.size());

    const auto write = [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const Hit hit = hits[i];
            contacts[i] = {bodies[hit.body_a].mesh_id, hit.vertex, bodies[hit.body_b].mesh_id,
                           std::uint32_t(hit.tet)};
            if (interiors) (*interiors)[i] = hit.interior;
        }
    };
    constexpr std::size_t least = 8192; // worth a task
    for_ranges(workers, hits.size(), least, write);
}

std::uint64_t hash_contacts(std::span<const vox_contact> contacts) noexcept {
    std::uint64_t state = contacts.size();
    const auto add = [&state](std::uint32_t low, std::uint32_t high) {
        const std::uint64_t word = low | std::uint64_t(high) << 32;
        state = (state ^ word) * 0x9fb21c651e98df25u;
        state ^= state >> 29;
    };
    for (const vox_contact& contact : contacts) {
        add(contact.body_a, contact.vertex);
        add(contact.body_b, contact.tet);
    }
    return state;
}

} // namespace vox
