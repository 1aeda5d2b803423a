// The constraints of the last step, in it or when asked for: which pairs are wanted, the depths of their
// contacts, and the records.
#pragma once

#include "depth/closest.hpp"
#include "depth/stage.hpp"
#include "fast/engine.hpp"
#include "grid/constraints.hpp"
#include "grid/mesh_table.hpp"
#include "grid/surface_stages.hpp"

#include <vox/vox.h>

namespace vox {

// The arrays of one step, kept from step to step.
struct StepData {
    explicit StepData(std::pmr::memory_resource* memory)
        : bodies(memory), prepared(memory), topologies(memory), versions(memory), hits(memory),
          contacts(memory), interiors(memory) {}

    Array<Body> bodies;
    Array<fast::PreparedBody> prepared; // of each body that has tiles
    Array<const Topology*> topologies;  // of each body
    Array<SurfaceVersion> versions;     // of each body, while a stage looks at surfaces
    Array<Hit> hits;                    // of contacts, once these are made
    Array<vox_contact> contacts;
    Array<std::uint8_t> interiors; // whether each contact is interior
};

class ConstraintStage {
public:
    // A pair has at most so many constraints; 0: all.
    ConstraintStage(std::pmr::memory_resource* memory, std::uint32_t most_per_pair)
        : most_per_pair_(most_per_pair), trees_(memory), penetrations_(memory), constraints_(memory),
          chosen_pairs_(memory), chosen_bodies_(memory), chosen_hits_(memory) {}

    // What a step has when its pairs are known.
    struct Scene {
        StepData& step;
        MeshTable& meshes;
        std::span<const vox_pair> pairs;
        SurfaceStages& surfaces;
        Workers& workers;
        bool in_step; // else meshes are as they are now
    };

    void begin_step(bool last_succeeded) noexcept;
    // When contacts are made: whether those of bodies at rest were carried over, and whether all were.
    void carry(bool carried, bool all_carried, Counters& counters) noexcept;
    // Throws INVALID_STATE where a body of a chosen pair is not as it was in the step.
    void find(const vox_constraint_desc& desc, const Scene& scene, Counters& counters, Profile& profile);
    const Constraints& constraints() const noexcept { return constraints_; }
    std::uint32_t most_per_pair() const noexcept { return most_per_pair_; }

    void reserve(std::uint32_t body_count, std::uint64_t contact_count);
    // Makes the tree over the surface of a mesh.
    void prepare(const Body& body, const Topology& topology, bool folds);
    // As those of Constraints; without `all`, trees stay as well.
    void clear(bool all) noexcept;
    void forget(vox_body mesh) noexcept { trees_.forget(mesh); }
    void forget_trees() noexcept { trees_.forget_all(); }
    void topology_changed(vox_body mesh) noexcept { trees_.topology_changed(mesh); }

private:
    // Which penetrations there are: none, or those of all contacts of a step.
    struct FoundDepths {
        bool all = false;
        vox_depth_method method = VOX_DEPTH_METHOD_CONSISTENT;
        std::uint64_t closest_budget = 0;

        bool operator==(const FoundDepths&) const = default;
    };

    static void renew(const Scene& scene);
    bool choose_pairs(const vox_constraint_desc& desc, const Scene& scene);
    DepthStage& depth();
    void find_depths(const FoundDepths& wanted, const Scene& scene, Counters& counters);

    std::uint32_t most_per_pair_;
    depth::SurfaceTrees trees_;       // that depths search
    std::optional<DepthStage> depth_; // once depths were looked for
    Penetrations penetrations_;
    FoundDepths depths_;            // what is in penetrations_
    bool depths_may_carry_ = false; // those of the last step, to this one
    Constraints constraints_;
    Array<std::uint8_t> chosen_pairs_, chosen_bodies_; // in one call
    Array<Hit> chosen_hits_;                           // of some pairs, once they alone were asked for
};

} // namespace vox
