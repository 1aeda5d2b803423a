// Readings of contacts: where each vertex is, the surface next to it, its depth, user data. Made after a
// step, on request; see vox_reading.
#pragma once

#include "base/scene.hpp"
#include "depth/closest.hpp"
#include "grid/events.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

class Workers;

// A mesh as it is now.
struct ReadingBody {
    Body body{};
    const Topology* topology = nullptr; // null: the mesh was removed
};

class Readings {
public:
    explicit Readings(std::pmr::memory_resource* memory);
    Readings(const Readings&) = delete;
    Readings& operator=(const Readings&) = delete;

    // Lists the meshes that touch, ascending, with their ids alone. The caller fills in the rest before
    // prepare(); positions have to be finite.
    std::span<ReadingBody> list_meshes(const Events& events);
    // Makes the readings from the results of a step; meshes may have changed since. Throws what the memory
    // throws, and changes nothing then, or Error(INVALID_ARGUMENT) for a defective task system, and there are
    // no readings then.
    void prepare(std::span<const vox_contact> contacts, std::span<const vox_penetration> penetrations,
                 const Events& events, Workers& workers);
    void invalidate() noexcept { prepared_ = false; }

    // One for each contact. Throws Error(INVALID_STATE) unless they are prepared.
    std::span<const vox_reading> all() const;

private:
    // Contacts of vertices of mesh_a in tetrahedra of mesh_b, in canonical order: indices of contacts.
    struct Run {
        vox_mesh mesh_b;
        const ReadingBody *a, *b;
        std::span<const std::uint32_t> contacts;
        std::uint64_t user_data_a, user_data_b;
    };
    // The runs with one mesh_b, in runs_.
    struct Group {
        std::size_t first, last;
    };

    const ReadingBody& body_of(vox_mesh mesh) const noexcept;
    void list_runs(const Events& events);
    void list_depths(std::span<const vox_penetration> penetrations) noexcept;
    void read(const Group& group, std::span<const vox_contact> contacts, depth::SurfaceTree& tree);
    // Reads one vertex of a run; `same` are its contacts there. `tree` is null where mesh_b has no surface.
    void read_vertex(const Run& run, std::span<const std::uint32_t> same,
                     std::span<const vox_contact> contacts, depth::SurfaceTree* tree, vox_reading& out);

    std::pmr::vector<ReadingBody> bodies_; // by id
    std::pmr::vector<Run> runs_;
    std::pmr::vector<Group> groups_;
    std::pmr::vector<depth::SurfaceTree> trees_; // of each worker
    std::pmr::vector<vox_reading> readings_;
    bool prepared_ = false;
};

} // namespace vox
