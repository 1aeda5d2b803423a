// A surface: vertices, edges and faces, with or without tetrahedra behind them, and the motion that it is
// asked about (vox_surface.h).
#pragma once

#include "base/array.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "surface/answers.hpp"
#include "surface/contact_time.hpp"
#include "surface/motion.hpp"
#include "surface/pairs.hpp"
#include "surface/topology.hpp"

#include <vox/vox_surface.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>

struct vox_surface {
public:
    // Throws as SurfaceTopology; INVALID_ARGUMENT for the other fields.
    vox_surface(const vox_surface_desc& desc, const vox::MemoryShare& memory);

    const vox::SurfaceTopology& topology() const noexcept { return topology_; }
    const vox::MemoryShare& memory() const noexcept { return share_; }
    vox::Workers& workers() noexcept { return workers_; }

    // Throws as vox_surface_move, and has changed nothing then.
    void move(const vox_motion& motion);
    // Throws INVALID_STATE before the first move().
    const vox::SurfaceMotion& motion() const;
    // The end of the motion, as one that stands still: for what is asked about positions.
    vox::SurfaceMotion at_end(double radius) const;

    void set_cell_size(double cell_size);

    // Calls visit(Candidates) for the partners of all features of kind a, as vox_surface_find_pairs finds
    // them, for any motion of this surface, piece by piece. The buffers behind it are the surface's: one call
    // at a time.
    template <class Visit>
    void for_pieces(const vox::SurfaceMotion& motion, vox_feature a, vox_feature b, Visit&& visit) {
        const std::uint32_t all = topology_.count(a);
        for (std::uint32_t first = 0; first < all; first += static_cast<std::uint32_t>(candidates_.count)) {
            find_fitting(motion, a, b, first, std::min(most_at_once_, all - first), candidates_);
            visit(vox::Candidates{topology_, motion, a, b, candidates_});
        }
    }
    // The partners of features first, first + 1, ... for the motion that is set: of `count`, or as many as
    // fit into the byte budget, at least one. They live until the next call or move().
    const vox::FeaturePairs& pairs(vox_feature a, vox_feature b, std::uint64_t first, std::uint64_t count);

    // Throws as vox_surface_suggest_cell_size.
    vox_cell_size_result suggest_cell_size(vox_feature a, vox_feature b);
    // The least time of contact of faces and vertices, and of edges. Throws as vox_surface_find_safe_step.
    vox_safe_step safe_step(const vox::ContactTimeRule& rule);
    // Pairs within a distance; they live until the next call or move(). Throws as
    // vox_surface_find_proximities.
    std::span<const vox_proximity> proximities(vox_feature a, vox_feature b, double distance);
    // Throws as vox_surface_find_clearances.
    void clearances(double max_distance, double* out_distances);
    // Impacts of two kinds; they live until the next call or move().
    std::span<const vox_impact> impacts(vox_feature a, vox_feature b, const vox::ContactTimeRule& rule);
    // Crossings at the end of the motion. They live until the next call or move().
    std::span<const vox_crossing> crossings();

    vox_counter_view counters() const;

private:
    // The motion of pairs that may come this close.
    vox::SurfaceMotion reaching(double distance);
    // The partners of features [first, first + count) of kind a, or of the first of them: as many as fit into
    // the byte budget, at least one.
    void find_fitting(const vox::SurfaceMotion& motion, vox_feature a, vox_feature b, std::uint32_t first,
                      std::uint32_t count, vox::FeaturePairs& out);
    template <class Make>
    auto answer(bool& lives, Make&& make);
    template <class T, class Add>
    std::span<const T> answer_all(vox::Answers<T>& answers, const vox::SurfaceMotion& motion, vox_feature a,
                                  vox_feature b, Add&& add);
    // Gives back the memory of answers that have ended, kept for the next ones. Returns whether there was
    // any.
    bool release_ended() noexcept;

    vox::MemoryShare share_; // first, as all else is released to it
    vox::Workers workers_;
    vox::SurfaceTopology topology_;
    double cell_size_; // 0: chosen
    bool has_motion_ = false;
    std::array<vox::Array<vox::Vec3d>, 2> positions_; // at time 0 and 1; the latter empty: stands still
    vox::SurfaceMotion motion_;
    vox::Array<vox::Vec3d> relative_; // positions at time 1, as pairs are searched for contacts
    vox::PairSearch search_;
    struct Piece {
        vox_feature a, b;
        std::uint32_t first, count; // count 0: none
    };
    Piece piece_{}; // the last answer, where not all of what was asked fitted
    vox::FeaturePairs answer_;
    bool answer_lives_ = false;    // the caller may have a view of it
    vox::FeaturePairs candidates_; // of what is asked beside the pairs, a range at a time
    static constexpr std::uint32_t many_at_once = 1u << 20, few_at_once = 1u << 10;
    std::uint32_t most_at_once_ = many_at_once;
    vox::Answers<vox_crossing> crossings_;
    vox::Answers<vox_impact> impacts_;
    vox::Answers<vox_proximity> proximities_;
    vox::Array<vox::SharedLeast> clearances_;         // of each vertex
    mutable std::array<vox_counter, 7> counter_list_; // as they are when asked for
};
