// The tetrahedra that segments pass through.
#pragma once

#include "base/array.hpp"
#include "base/entry_bound.hpp"
#include "exact/accurate.hpp"
#include "exact/predicates.hpp"
#include "query/facets.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>

namespace vox {

// The part of a segment in a closed tetrahedron.
struct TrackChord {
    bool any = false;    // it has a length
    bool within = false; // it lies in a facet or an edge
    bool tied = false;   // it begins or ends in an edge
    std::uint32_t facet_in = VOX_NONE, facet_out = VOX_NONE;
};

// The corners other than i and j, in the order that makes i, j and them an even permutation.
inline constexpr std::uint8_t other_corners[4][4][2] = {{{}, {2, 3}, {3, 1}, {1, 2}},
                                                        {{3, 2}, {}, {0, 3}, {2, 0}},
                                                        {{1, 3}, {3, 0}, {}, {0, 1}},
                                                        {{2, 1}, {0, 2}, {1, 0}, {}}};

TrackChord find_chord(const Vec3d& from, const Vec3d& to, const Vec3d* const (&corner)[4]);

// The pieces of one segment at a time.
class Queries::Tracker {
public:
    // `walks`: if not, `around_from` is null.
    Tracker(const Queries& queries, QueryMeshes which, bool walks, std::pmr::memory_resource* memory)
        : queries_(queries), which_(which), links_(memory), pieces_(memory), settled_(memory),
          borders_(memory), active_(memory) {
        for (const Mesh& mesh : queries.meshes_)
            links_.push_back(walks && wants(mesh, which) ? &mesh.tets->links() : nullptr);
    }

    // `around_from` are the tetrahedra that contain `from`, all of them but for boundaries; null if the tree
    // is to be searched.
    void find(std::uint32_t segment, const Vec3d& from, const Vec3d& to,
              const std::span<const PointHit>* around_from, HitList<vox_track_piece>& out);

private:
    struct Piece {
        std::uint32_t mesh, tet; // the mesh in meshes_
        TrackChord chord;
        bool follows = false; // the piece before, at whose end it begins
        double t_in = 0, t_out = 1;

        auto order() const noexcept { return std::tie(mesh, t_in, t_out, tet); }
    };

    bool walk_all(std::span<const PointHit> around_from, const EntryBound& bound);
    bool enter(std::uint32_t leaf, const LeafTets& tets, std::size_t tet, std::uint32_t facet);
    bool walk(std::uint32_t leaf, std::uint32_t place, std::uint32_t facet_in, int volume);
    bool ends_beyond(const Vec3d* const (&corner)[4], std::uint32_t facet) const noexcept;
    void find_in(std::uint32_t leaf, const EntryBound& bound);
    void add_end(const Vec3d* const (&corner)[4], std::uint32_t facet, bool out);
    void place_ends();
    void settle(std::span<const Piece> pieces);

    const Queries& queries_;
    const QueryMeshes which_;
    Vec3d from_{}, to_{};
    Array<const QueryTets::Links*> links_; // of each mesh, while it walks
    Array<Piece> pieces_, settled_;
    Array<double> borders_;      // of settle()
    Array<const Piece*> active_; // likewise
    int axis_ = 0;               // along which the segment is longest
    bool ascends_ = true;
    // Ends of pieces that wait until they fill whole registers.
    std::size_t end_count_ = 0;
    struct End {
        std::size_t piece;
        bool out;
    };
    End ends_[point_block];
    PointBlock block_;
    Crossings crossings_;
};

} // namespace vox
