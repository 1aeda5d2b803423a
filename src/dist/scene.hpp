// The parts of bodies on this rank, and their contacts.
#pragma once

#include "base/caller_memory.hpp"
#include "base/library.hpp"
#include "dist/part.hpp"
#include "dist/transport.hpp"

#include <vox/vox_cell_size.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>

namespace vox::dist {

// A part in a grid of the scene.
struct InsertedPart {
    vox_body mesh;
    Part* part;
};

// A grid with the parts of this rank, and with vertices or points of other ranks as a mesh without
// tetrahedra.
struct SearchGrid {
    explicit SearchGrid(Memory* memory) : inserted(memory), positions(memory) {}
    const Part& part_of(vox_body mesh) const noexcept;
    void insert(vox_body mesh, Part* part);
    // Gives the grid these points and keeps them.
    void set_points(Array<Vec3d>& new_positions);

    Array<InsertedPart> inserted; // ascending in mesh
    Array<Vec3d> positions;       // of `points`; the grid borrows them
    GridHandle grid;
    vox_body points = VOX_NULL_BODY;
};

vox_filter unfiltered() noexcept;

// What this rank sent and received in a collective function.
struct Traffic {
    std::uint64_t neighbours = 0, messages = 0, collectives = 0;
    std::uint64_t replicated_bytes = 0, box_bytes = 0, vertex_bytes = 0, hit_bytes = 0;
    std::uint64_t vertices_sent = 0, vertices_received = 0, vertices_here = 0, hits_sent = 0;
    std::uint64_t contacts = 0, incoming = 0;
};

struct TrafficName {
    const char* name;
    std::uint64_t Traffic::*field;
};
inline constexpr TrafficName traffic_names[] = {
    {"neighbours", &Traffic::neighbours},
    {"messages", &Traffic::messages},
    {"collectives", &Traffic::collectives},
    {"replicated_bytes", &Traffic::replicated_bytes},
    {"box_bytes", &Traffic::box_bytes},
    {"vertex_bytes", &Traffic::vertex_bytes},
    {"hit_bytes", &Traffic::hit_bytes},
    {"vertices_sent", &Traffic::vertices_sent},
    {"vertices_received", &Traffic::vertices_received},
    {"vertices_here", &Traffic::vertices_here},
    {"hits_sent", &Traffic::hits_sent},
    {"contacts", &Traffic::contacts},
    {"incoming", &Traffic::incoming},
};

} // namespace vox::dist

struct vox_dist_scene {
    vox_dist_scene(const vox_grid_desc& grid, const vox_dist_transport& transport);
    ~vox_dist_scene();
    vox_dist_scene(const vox_dist_scene&) = delete;
    vox_dist_scene& operator=(const vox_dist_scene&) = delete;

    void insert(const vox_dist_part_desc& desc);
    void remove(std::uint64_t body);
    void bind(std::uint64_t body, const vox_positions& positions);
    void step();
    void send(std::int32_t from, std::uint64_t item_bytes, const void* in,
              void* out); // from: a vox_dist_side
    void hash(std::uint64_t out[2]);
    void locate(const vox_positions* points, vox_dist_location* out_locations);
    void check_numbers();
    std::uint64_t costs(vox_dist_cost* costs, std::uint64_t capacity) const;
    vox_counter_view counters() const noexcept;

    // Looks up where the positions of all parts are now, checks them and computes boxes.
    void read_positions();
    // Exchanges overviews with all ranks, and throws the failure of the lowest rank that has one. The ranks
    // with vertices or points near tetrahedra of this one, or the reverse, are then in ranks_.
    void exchange_overviews(vox::dist::Overview mine, const vox::dist::Failure& failure);
    // Puts into ranks_ the other ranks for which meet(overview of this rank, overview of the other) holds.
    template <class Meet>
    void choose_ranks(Meet&& meet) {
        rank_count_ = 0;
        for (std::uint32_t rank = 0; rank < transport_.size(); ++rank)
            if (rank != transport_.rank() && meet(overviews_[transport_.rank()], overviews_[rank]))
                ranks_[rank_count_++] = rank;
        counters_.neighbours = std::max<std::uint64_t>(counters_.neighbours, rank_count_);
    }
    // Sends out_[i] to ranks_[i] and receives in_[i], for i below rank_count_. After a failure, here or
    // there, in_[i] are empty, and this rank goes on, as the others wait for it.
    void exchange(std::uint64_t* sent_bytes, vox::dist::Failure& failure);
    vox::dist::Part* find_body(std::uint64_t body) const noexcept;
    // Throws INVALID_HANDLE if there is none.
    vox::dist::Part& part_of(std::uint64_t body) const;

    // A copy of a desc and of all that it points to.
    class OwnDesc {
    public:
        explicit OwnDesc(const vox_grid_desc& desc);
        OwnDesc(const OwnDesc&) = delete;
        const vox_grid_desc& operator*() const noexcept { return desc_; }
        const vox_grid_desc* operator->() const noexcept { return &desc_; }

    private:
        vox_grid_desc desc_;
        vox_allocator allocator_;
        vox_log log_;
        vox_task_system tasks_;
        vox_reference_desc reference_;
        vox_cost_weights weights_;
    };

    OwnDesc grid_desc_;
    vox::CallerMemory memory_;
    vox::dist::Transport transport_;
    vox::Array<vox::dist::Part*> parts_; // in the order of bodies
    vox::dist::SearchGrid contact_grid_, point_grid_;
    vox::Array<vox_dist_contact> contacts_;     // whose vertices are owned here
    vox::Array<vox_dist_contact> tet_contacts_; // whose tetrahedra are here
    vox::dist::Traffic counters_;
    mutable vox_counter counter_list_[std::size(vox::dist::traffic_names)]; // for a vox_counter_view

    vox::Array<vox::dist::Overview> overviews_; // one a rank
    vox::Array<std::uint32_t> ranks_;           // that messages go to
    vox::Array<vox_dist_message> out_, in_;
    std::uint32_t rank_count_ = 0;
    vox::Array<std::uint8_t> has_contacts_; // one a rank: whether it has contacts with this one
};
