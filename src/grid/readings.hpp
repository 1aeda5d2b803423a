// Contacts as a program reads them: where each vertex is, the surface next to it, its depth, user data. Made
// when they are asked for, after a step; see vox_reading.
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
    const Topology* topology = nullptr; // null: gone
};

class Readings {
public:
    explicit Readings(std::pmr::memory_resource* memory);
    Readings(const Readings&) = delete;
    Readings& operator=(const Readings&) = delete;

    // The meshes that touch, ascending, as ids: to be completed before prepare(), with finite positions.
    std::span<ReadingBody> list_meshes(const Events& events);
    // Of the contacts of a step and what else it found; meshes may have changed since. Throws what the memory
    // throws, and leaves all as it was then, or Error(INVALID_ARGUMENT) for a defective task system, and
    // there are none then.
    void prepare(std::span<const vox_contact> contacts, std::span<const vox_penetration> penetrations,
                 const Events& events, Workers& workers);
    void forget() noexcept { prepared_ = false; }

    // One for each contact. Throws Error(INVALID_STATE) when they are not prepared.
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
    // One vertex of a run, of whose contacts `same` are; no tree: mesh_b has no surface.
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
