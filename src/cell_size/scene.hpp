// The scene that a cell size is chosen for, as every model sees it.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"
#include "cell_size/pairs.hpp"
#include "cell_size/tile_sketch.hpp"
#include "fast/engine.hpp"
#include "mesh/mesh.hpp"
#include "mesh/tiles.hpp"

#include <vox/vox_cell_size.h>

#include <cstdint>
#include <memory_resource>

namespace vox {

// The counts and means of a scene that cost models and cell-size rules are written in.
struct Geometry {
    vox_geometry stats;
    // Mean over the bodies whose bounding box has a volume, of the side of the cube of equal volume. 0 where
    // none has.
    double mean_object_side;
};

// As closely as a model looks at all. The tests hold its counts to within 10 % of the engines' own.
inline constexpr SampleBudget thorough{.summed = 1 << 18,
                                       .held = 1 << 18,
                                       .asking = 1 << 18,
                                       .chosen = 4096,
                                       .coarse = 1,
                                       .cells = 4096,
                                       .rough = 0,
                                       .singly = 0};

// For vox_suggest_cell_size, of a scene of so many tetrahedra.
SampleBudget usual(vox_cost_model model, std::uint64_t tets) noexcept;

// For a grid, where choosing has to cost less than a step of `tets` tetrahedra.
SampleBudget quick(vox_cost_model model, std::uint64_t tets) noexcept;

struct CellSizeScene {
    explicit CellSizeScene(std::pmr::memory_resource* memory);
    CellSizeScene(const CellSizeScene&) = delete;
    CellSizeScene& operator=(const CellSizeScene&) = delete;

    std::pmr::memory_resource* memory; // for this scene and for what models keep

    // ---- set by the caller ----
    Array<Body> bodies;
    SampleBudget budget = thorough; // prepare() makes it a small one where the scene is a grid's
    // What a grid has prepared of each body, and found in its last step. All empty where there is no grid.
    Array<const Mesh*> meshes;
    Array<const Tiles*> tiles;             // null where they were not made: they are then sketched
    Array<std::uint8_t> at_rest;           // the body did not move before the last step
    Array<std::uint8_t> cleared;           // winding numbers excluded most of its self-collision
    const FastEngine* last_step = nullptr; // null unless it was a step of these bodies, wherever they are now

    // ---- set by prepare() ----
    Geometry geometry{};

    // Gets the scene ready for a model: a grid's scene is only sampled, so that choosing takes less time than
    // a step. Throws Error(NON_FINITE) naming mesh_id and vertex.
    void prepare(vox_cost_model model);

    // For the fast engine's model, which bodies are near each other: from the last step where the boxes of
    // all bodies are what they were then (prepare() sets `last_step` to null otherwise), else found by the
    // same functions that the engine calls.
    const fast::Step& step() const noexcept { return last_step ? last_step->last_step() : step_; }
    const fast::StepBoxes& boxes() const noexcept { return last_step ? last_step->boxes() : boxes_; }
    const fast::BroadPhase& broad_phase() const noexcept {
        return last_step ? last_step->broad_phase() : broad_phase_;
    }
    // The box of all vertices of a body where prepare() has found it; else null.
    const Box* box(std::size_t body) const noexcept;
    // Where vertices of a body may be in tetrahedra of the same body.
    Box own_region(std::size_t body) const noexcept;

private:
    bool moved_since_last_step() const;
    void find_near_bodies();
    void sketch_missing_tiles();
    void make_tile_boxes(std::size_t body);

    Array<TileSketch> sketches_; // of all bodies, where some have no tiles
    fast::Step step_;
    fast::StepBoxes boxes_;
    fast::StreamBuffers stream_;
    fast::BroadPhase broad_phase_;
};

// Scenes of at most so many tetrahedra are measured as a whole: for the paper's model, whose z is defined by
// the means over all edges and facets, and for the others, which only compare with rules of thumb.
inline constexpr std::uint64_t whole_for_paper = 200'000, whole_for_rules = 1500;

// Measures the positions as they are now: of all tetrahedra where there are at most `most_whole` and the
// scene is not a grid's, else of samples (mesh/sample.hpp). Then the counts of edges and facets and the means
// are estimates.
//
// The bounds are those of the vertices that tetrahedra use, and of all vertices for a body without
// tetrahedra; every vertex must be finite all the same. A tetrahedron that names a vertex twice has no edges
// and facets of its own but counts in the means over tetrahedra; one that is off does not count. Means of
// nothing are 0. Throws Error(NON_FINITE) naming mesh_id and vertex.
Geometry measure(const CellSizeScene& scene, std::uint64_t most_whole);

} // namespace vox
