// The fast engine: the same hits as the reference engine, found tile by tile. A step is six stages
// (stages.hpp), plain functions over the arrays that live here; docs/engine.md explains them.
#pragma once

#include "base/array.hpp"
#include "base/counters.hpp"
#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "fast/broad_phase.hpp"
#include "fast/decide.hpp"
#include "fast/lookup.hpp"
#include "fast/mesh_state.hpp"
#include "fast/step.hpp"
#include "fast/step_scene.hpp"
#include "fast/stream.hpp"
#include "fast/windows.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

struct FastSettings {
    double cell_size = 0;       // 0: chosen for each body from the tiles that look into its windows
    bool winding = true;        // cull self-collision by winding numbers where it pays
    Workers* workers = nullptr; // that share the work; null: none, all is done on the calling thread
    // Leave out what cannot have changed: pairs of bodies neither of which moved since the last step, whose
    // hits the caller has. For the same engine and states of meshes as in the last step, meshes that are new
    // or gone excepted, and not after a step that failed.
    bool carry = false;
    bool keep_certified = false; // for StepScene::certified()
};

// The engine's buffers live here from step to step, so that the steady state allocates nothing.
class FastEngine {
public:
    explicit FastEngine(std::pmr::memory_resource* memory);
    FastEngine(const FastEngine&) = delete;
    FastEngine& operator=(const FastEngine&) = delete;

    // As ReferenceEngine::detect: appends a Hit for every vertex in a closed tetrahedron that does not own
    // it, in any order. `prepared` is what there is of each body. Throws Error(NON_FINITE) naming mesh and
    // vertex; sets the counters from `cells` to `skipped_degenerate` (degenerate tetrahedra with a vertex in
    // their box) and the times of its stages, with the sums that they make up: `winding` and `decide` run
    // within the tasks of `windows` and `lookup`, and count for the worker that took longest over them.
    // Nothing but times and the order of hits depends on the workers. With more than one, the memory given to
    // the constructor and that of `hits` are used by many threads at once.
    void detect(std::span<const Body> bodies, std::span<const fast::PreparedBody> prepared,
                const FastSettings& settings, Array<Hit>& hits, Counters& counters, Profile& profile);

    // The cost model reads what the last step found, until the next one; pointers and spans of the Step are
    // no longer valid.
    const fast::Step& last_step() const noexcept { return step_; }
    const fast::StepBoxes& boxes() const noexcept { return boxes_; }
    const fast::BroadPhase& broad_phase() const noexcept { return broad_phase_; }
    const fast::Windows& windows() const noexcept { return windows_; }

    // True if a body moved before the last step, as far as FastSettings::carry lets the engine know. Bodies
    // added since count as moved.
    bool moved(std::size_t body) const noexcept { return body >= step_.of.size() || step_.of[body].moved; }

    // True if winding numbers excluded most of the self-collision of a body in the last step: what is left of
    // it costs next to nothing. The body has so many vertices.
    bool cleared(std::size_t body, std::uint32_t vertices) const noexcept;

    // Sets what the last step found, good until the next one.
    void fill(StepScene& scene) const noexcept;

    // The cell size of the last window of the last step that had one; 0 before.
    double cell_size() const noexcept { return cell_size_; }

private:
    struct Worker : fast::LookupBuffers {
        using LookupBuffers::LookupBuffers;
        fast::DecideCounts decided;
    };

    void begin(std::span<const Body> bodies, std::span<const fast::PreparedBody> prepared,
               const FastSettings& settings);
    void look_up(Array<Hit>& hits);
    void count(Counters& counters);

    fast::Step step_;
    fast::StepBoxes boxes_;
    fast::StreamBuffers stream_;
    fast::BroadPhase broad_phase_;
    fast::Windows windows_;
    PerWorker<Worker> workers_;
    Array<std::uint64_t> degenerate_; // body << 32 | tet
    double cell_size_ = 0;
};

} // namespace vox
