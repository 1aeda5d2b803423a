// Constraints: what the contacts of a step, of every kind, amount to for a solver (vox_constraint).
#pragma once

#include "depth/penetrations.hpp"
#include "grid/edge_contacts.hpp"
#include "grid/impacts.hpp"
#include "grid/proximities.hpp"
#include "grid/shape_contacts.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <algorithm>
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
    // How depths were found. The constraints of the step before that were found in the same way are those of
    // now where both bodies are carried (Body::carried).
    vox_depth_method method;
    std::uint64_t closest_budget;
    std::span<const EdgeContact> edges;
    std::span<const Depth> edge_depths; // of each, or none
    std::span<const Proximity> proximities;
    std::span<const SurfaceMeeting> meetings;
    std::span<const Impact> impacts;
    std::span<const ShapeRun> shapes; // sorted by body_a, body_b
    std::size_t shape_count;          // contacts of these
    std::uint32_t most_per_pair;      // 0: all of them

    // The contact that a constraint of a vertex inside comes from.
    const Hit& hit_of(std::uint32_t source) const noexcept {
        return hits[penetrations ? static_cast<std::size_t>(penetrations->all()[source].contact) : source];
    }
    // Of the shape contact with this number.
    const ShapeRun* run_of(std::uint32_t source) const noexcept {
        return &*(std::ranges::upper_bound(shapes, source, {}, &ShapeRun::first) - 1);
    }
    bool has_shape(const IdPair& pair) const noexcept;
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

    // How many the limit of a pair left out.
    std::uint64_t left_out() const noexcept { return listed_count_ - now_.all.size(); }
    // Whether they were found since the step began.
    bool found() const noexcept { return found_; }
    // `data` of constraints of which none were found is null.
    vox_constraint_view view() const noexcept {
        return {now_.all.data(), now_.all.size(), pair_offsets_.data(), now_.pairs.size()};
    }

private:
    static constexpr std::size_t kinds = 4; // of vox_constraint_kind

    // What makes two constraints the same: the vertex, or the edge and the sorted face.
    struct Key {
        vox_body body_a;
        std::array<std::uint32_t, 5> vertices;

        auto operator<=>(const Key&) const = default;
    };
    // The constraints of one step, in order: pair by pair, and of each pair kind by kind.
    struct List {
        explicit List(std::pmr::memory_resource* memory) : all(memory), pairs(memory), first(memory) {}

        Array<vox_constraint> all;
        Array<IdPair> pairs;
        Array<std::uint32_t> first; // of each pair and kind, and the end
        vox_depth_method method{};
        std::uint64_t closest_budget = 0;
    };
    class Previous;

    static Key key_of(const vox_constraint& constraint) noexcept;
    void make_room(std::size_t listed, std::size_t kept, std::size_t pairs);
    using Ends = std::array<std::size_t, kinds>;
    Ends list(const ConstraintSources& sources);
    void order(const ConstraintSources& sources, const Ends& ends);
    std::size_t count_kept(const ConstraintSources& sources, std::size_t listed);
    void limit(const ConstraintSources& sources, Workers& workers);
    void keep(const ConstraintSources& sources, std::size_t pair) noexcept;
    struct Run { // constraints of one kind from those of `pair` on
        std::uint32_t pair;
        vox_constraint_kind kind;
        std::size_t begin, end;
    };
    void write(const ConstraintSources& sources, std::size_t begin, std::size_t end) noexcept;
    bool carry_inside(const ConstraintSources& sources, const Run& run, const Previous& previous) noexcept;
    void write_inside(const ConstraintSources& sources, const Run& run, Previous& previous) noexcept;
    void write_shapes(const ConstraintSources& sources, const Run& run, Previous& previous) noexcept;
    void write_others(const ConstraintSources& sources, const Run& run, Previous& previous) noexcept;

    List now_, last_; // of this step, and of the one before
    Array<std::uint64_t> pair_offsets_;
    Array<std::uint32_t> sources_; // of each constraint, its index among those of its kind
    struct Listed {                // before they are in order
        std::uint32_t pair, source;
    };
    Array<Listed> listed_;
    Array<std::uint32_t> place_; // where the next of each pair and kind goes
    struct Spot {                // of a constraint of a pair that has too many
        Vec3d at;
        double gap;
        double apart; // square of the distance from the nearest one that is kept
    };
    Array<Spot> spots_;
    Array<std::uint8_t> kept_;      // of each constraint
    Array<std::uint32_t> left_out_; // of each pair
    std::size_t listed_count_ = 0;
    bool found_ = false;
};

} // namespace vox
