// Readings of contacts: where each vertex is, the surface next to it, its depth, user data. Made after a
// step, on request; see vox_reading.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"
#include "depth/penetrations.hpp"
#include "depth/surface_trees.hpp"
#include "grid/events.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

class Workers;

// A mesh that touches others, as it is now.
struct ReadingBody {
    Body body{};
    const Topology* topology = nullptr; // null: its surface is not read, or it has none
    std::uint64_t user_data = 0;
    bool is_present = false;            // else it was removed since the step
    bool is_entered = false;            // by vertices whose contacts are read
    bool is_as_stepped = false;         // its topology is that of the step
    bool is_in_itself = false;          // has vertices in its own tetrahedra, set by prepare()
    depth::SurfaceTree* tree = nullptr; // where it is searched; set by prepare()
};

class Readings {
public:
    explicit Readings(std::pmr::memory_resource* memory);
    Readings(const Readings&) = delete;
    Readings& operator=(const Readings&) = delete;

    // Chooses contacts: all, those of one mesh, or those between two. Lists the meshes in them by ids; the
    // caller completes body, topology and is_present before prepare(). Throws what the memory throws.
    std::span<ReadingBody> choose(const Events& events, std::span<const vox_body> meshes);
    // Makes the parts `what` of the readings of these contacts from the results of a step; meshes may have
    // changed since. Throws what the memory throws, or Error(NON_FINITE or LIMIT) for the position of a
    // vertex, and changes nothing then, or Error(INVALID_ARGUMENT) for a defective task system, and there are
    // no readings then. Positions of meshes with a topology have to be finite.
    // `closest_budget` as in vox_readings_desc. Returns how many vertices have no surface because of it.
    std::uint64_t prepare(std::uint32_t what, std::uint64_t closest_budget,
                          std::span<const vox_contact> contacts, const Penetrations& penetrations,
                          depth::SurfaceTrees& trees, Workers& workers);
    void invalidate() noexcept { prepared_ = false; }

    // Throws Error(INVALID_STATE) unless they are prepared.
    void require_prepared() const;
    std::span<const vox_reading> all() const noexcept { return readings_; } // in the order of contacts
    std::span<const vox_depth> depths() const noexcept { return depths_; }  // of each, or of none
    const vox_reading* find(std::uint64_t contact) const noexcept;          // null when it was not chosen

private:
    // What all parts of prepare() read.
    struct Step {
        std::uint32_t what;
        std::uint64_t closest_budget;
        std::span<const vox_contact> contacts;
        const Penetrations& penetrations;
    };
    // A vertex that asks for a surface: whose, its place on a curve, the first of its readings, and the
    // closest triangle, if that is known.
    struct Ask {
        std::uint32_t body_b, code, first, closest;
    };
    class PenetrationOf;
    struct Range {
        std::size_t first, last;
    };

    std::uint32_t body_of(vox_body mesh) const noexcept; // index in bodies_
    // The contact of a reading.
    std::uint32_t contact_of(std::size_t reading) const noexcept {
        return all_ ? static_cast<std::uint32_t>(reading) : chosen_[reading];
    }
    // The end, at most `last`, of the readings of the same vertex in the same mesh.
    std::size_t end_of_vertex(std::size_t first, std::size_t last, const Step& step) const noexcept;
    static bool has_position(const ReadingBody& a, std::uint32_t vertex) noexcept;
    void check_positions(const Step& step, std::size_t count) const;
    void read_range(const Range& range, const Step& step) noexcept;
    std::uint64_t list_asks(const Step& step, std::size_t count);
    void fit_trees(depth::SurfaceTrees& trees);
    void sort_asks(const Step& step) noexcept;
    void read_surfaces(const Range& asks, const Step& step) noexcept;

    Array<vox_body> ids_; // of the meshes in the contacts that are read, ascending
    Array<ReadingBody> bodies_;
    bool all_ = true;             // all contacts are read, else those
    Array<std::uint32_t> chosen_; // ascending
    Array<Ask> asks_;             // by body_b, neighbours next to each other
    Array<vox_reading> readings_;
    Array<vox_depth> depths_;
    bool prepared_ = false;
};

} // namespace vox
