// Constraints: what the contacts of a step, of every kind, amount to for a solver (vox_constraint).
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"
#include "depth/penetrations.hpp"
#include "grid/contact_pairs.hpp"
#include "grid/edge_contacts.hpp"
#include "grid/margin_contacts.hpp"
#include "grid/passages.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

class Workers;

// What the stages of a step found, of which constraints are made. Bodies and topologies have to be those of
// the step, as far as a chosen pair has them.
struct ConstraintSources {
    std::span<const Body> bodies;
    std::span<const Topology* const> topologies;
    std::span<const vox_pair> pairs;
    std::span<const std::uint8_t> chosen; // of each pair: whether its constraints are wanted
    // Vertices inside, in the order of make_contacts(). Without penetrations there is no depth.
    std::span<const Hit> hits;
    const Penetrations* penetrations;
    bool closest; // the method is VOX_DEPTH_METHOD_CLOSEST
    std::span<const EdgeContact> edges;
    std::span<const Depth> edge_depths; // of each, or none
    std::span<const MarginContact> margin_contacts;
    std::span<const Passage> passages;
    std::span<const Impact> impacts;
};

class Constraints {
public:
    explicit Constraints(std::pmr::memory_resource* memory);

    // Replaces the constraints. Throws what the memory throws, and Error(LIMIT) for more than
    // VOX_MAX_CONTACTS; the earlier ones stay then.
    void find(const ConstraintSources& sources, Workers& workers);
    // When a step begins: its constraints are compared with those that were found since the last one, or with
    // none if that succeeded and none were found.
    void begin_step(bool last_succeeded) noexcept;
    // Room for constraints of so many contacts, and the pairs of so many bodies (eight each).
    void reserve(std::size_t body_count, std::size_t contact_count);
    // When the results of a step are gone; with `all`, also what the next ones are compared with.
    void clear(bool all) noexcept;

    // Whether they were found since the step began.
    bool found() const noexcept { return found_; }
    // `data` of constraints of which none were found is null.
    vox_constraint_view view() const noexcept {
        return {constraints_.data(), constraints_.size(), pair_offsets_.data(), ranges_.pairs.size()};
    }

private:
    static constexpr std::size_t kinds = 4; // of vox_constraint_kind

    // What makes two constraints the same: the vertex, or the edge and the sorted face.
    struct Key {
        vox_body body_a;
        std::uint32_t vertices[5]; // an array of the library's would be compared by a call

        auto operator<=>(const Key&) const = default;
    };
    // The constraints of one step, in order: pair by pair, and of each pair kind by kind.
    struct Ranges {
        explicit Ranges(std::pmr::memory_resource* memory) : pairs(memory), first(memory) {}

        Array<IdPair> pairs;
        Array<std::uint32_t> first; // of each pair and kind, and the end
    };
    class Previous;

    static Key key_of(const vox_constraint& constraint) noexcept;
    template <class Visit>
    static void for_each(const ConstraintSources& sources, Visit&& visit);
    void make_room(std::size_t count, std::size_t pairs);
    void list(const ConstraintSources& sources);
    struct Run { // constraints of one pair and kind, all of them of a with b
        std::uint32_t pair;
        vox_constraint_kind kind;
        const Body &a, &b;
        std::size_t begin, end;
    };
    void write(const ConstraintSources& sources, std::size_t begin, std::size_t end) noexcept;
    void write_inside(const ConstraintSources& sources, const Run& run, Previous& previous) noexcept;
    void write_others(const ConstraintSources& sources, const Run& run, Previous& previous) noexcept;
    static void write_pair(const Run& run, vox_constraint& c) noexcept;

    Array<vox_constraint> constraints_;
    Array<std::uint64_t> pair_offsets_;
    Ranges ranges_;
    Array<std::uint32_t> sources_; // of each constraint, its index among those of its kind
    Array<std::uint32_t> place_;   // while sources are listed
    Array<Key> keys_;              // of each constraint
    bool found_ = false;
    // Of the step before.
    Ranges last_ranges_;
    Array<Key> last_keys_;
};

} // namespace vox
