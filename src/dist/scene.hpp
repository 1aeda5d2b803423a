// The parts of this rank, and what they found.
#pragma once

#include "base/caller_memory.hpp"
#include "dist/part.hpp"
#include "dist/transport.hpp"

#include <vox/vox_cell_size.h>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>

namespace vox::dist {

struct GridDeleter {
    void operator()(vox_grid* grid) const noexcept { vox_grid_destroy(grid); }
};
using GridHandle = std::unique_ptr<vox_grid, GridDeleter>;

// A part in a grid of the scene.
struct Placed {
    vox_body mesh;
    Part* part;
};

// A grid with the parts, and with the vertices or points of other ranks as a mesh without tetrahedra.
struct Side {
    explicit Side(Memory* memory) : placed(memory), xyz(memory) {}
    const Part& part_of(vox_body mesh) const noexcept;
    // Gives the grid these points, and keeps them.
    void set_points(Array<double>& positions);

    Array<Placed> placed; // ascending
    Array<double> xyz;    // of the points, which the grid borrows
    GridHandle grid;
    vox_body points = VOX_NULL_BODY;
};

vox_filter everything() noexcept;

// What a step sends from this rank.
struct Counts {
    std::uint64_t neighbours = 0, messages = 0, collectives = 0;
    std::uint64_t replicated_bytes = 0, box_bytes = 0, vertex_bytes = 0, hit_bytes = 0;
    std::uint64_t vertices_sent = 0, vertices_received = 0, vertices_here = 0, hits_sent = 0;
    std::uint64_t contacts = 0, incoming = 0;
};

struct NamedCount {
    const char* name;
    std::uint64_t Counts::*field;
};
inline constexpr NamedCount named_counts[] = {
    {"neighbours", &Counts::neighbours},
    {"messages", &Counts::messages},
    {"collectives", &Counts::collectives},
    {"replicated_bytes", &Counts::replicated_bytes},
    {"box_bytes", &Counts::box_bytes},
    {"vertex_bytes", &Counts::vertex_bytes},
    {"hit_bytes", &Counts::hit_bytes},
    {"vertices_sent", &Counts::vertices_sent},
    {"vertices_received", &Counts::vertices_received},
    {"vertices_here", &Counts::vertices_here},
    {"hits_sent", &Counts::hits_sent},
    {"contacts", &Counts::contacts},
    {"incoming", &Counts::incoming},
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

    // Reads where the positions of all parts are now, checks them and computes their boxes.
    void look();
    // Tells all ranks this one's overview, and throws what the lowest failing rank says.
    void meet(vox::dist::Overview mine, const vox::dist::Failure& failure);
    // Sends out_[i] to ranks_[i], below rank_count_, and gets in_[i]. After a failure, here or there, it gets
    // nothing, and goes on with what all ranks call next.
    void exchange(std::uint64_t* sent_bytes, vox::dist::Failure& failure);
    vox::dist::Part* find_body(std::uint64_t body) const noexcept;
    // Throws INVALID_HANDLE where it has none.
    vox::dist::Part& part_of(std::uint64_t body) const;

    // A copy of a desc, with all that it names.
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
    vox::dist::Side contacts_side_, points_side_;
    vox::Array<vox_dist_contact> contacts_;     // of the vertices owned here
    vox::Array<vox_dist_contact> tet_contacts_; // with the tetrahedra here
    vox::dist::Counts counters_;
    mutable vox_counter counter_list_[std::size(vox::dist::named_counts)]; // as they are when asked for

    vox::Array<vox::dist::Overview> overviews_; // of all ranks
    vox::Array<std::uint32_t> ranks_;           // who is talked to
    vox::Array<vox_dist_message> out_, in_;
    std::uint32_t rank_count_ = 0;
    vox::Array<std::uint8_t> in_contact_; // each rank: whether it is, with this one
};
