// The paper's algorithm as printed (Sect. 3). Every particle is classified into a uniform grid, then every
// tetrahedron tests the particles in the cells that its box covers. The engine is the baseline and the oracle
// of the fast one, and what the paper's cost function describes.
#pragma once

#include "base/array.hpp"
#include "base/counters.hpp"
#include "base/scene.hpp"
#include "reference/cell_lists.hpp"
#include "reference/levels.hpp"

#include <vox/vox_cell_size.h>

#include <array>
#include <memory_resource>
#include <span>

namespace vox {

struct ReferenceSettings {
    double cell_size = 0;    // > 0, finite
    bool dense = false;      // VOX_REFERENCE_DENSE
    bool paper_hash = false; // VOX_REFERENCE_PAPER_HASH
    std::uint64_t hash_table_size = 0;
    Vec3d world_min{}, world_max{}; // dense storage: both zero means the box of all positions
    // If not empty, these replace the cell size. They ascend, and each has a grid of its own.
    std::span<const CellLevel> levels{};
};

// Keeps the engine's buffers from step to step, so that the steady state allocates nothing. The one exception
// is dense storage in the box of all positions, when that box grows.
class ReferenceEngine {
public:
    explicit ReferenceEngine(std::pmr::memory_resource* memory);

    // Appends a Hit for every vertex in a closed tetrahedron that does not own it, level after level in the
    // order of (body_b, tet). make_contacts() chooses the canonical ones later. Throws Error(NON_FINITE)
    // naming mesh and vertex, or Error(LIMIT or BUDGET) when the cells do not fit; the engine can be used
    // again after that. Sets the counters from `cells` to `skipped_degenerate` and the stage times from
    // `bin_ns` to `narrow_ns`.
    void detect(std::span<const Body> bodies, const ReferenceSettings& settings, Array<Hit>& hits,
                Counters& counters, Profile& profile);

    // The cells of the last level.
    const CellLists& cells() const noexcept { return cells_; }

private:
    struct Candidate {
        std::uint32_t tet;
        std::uint32_t particle;
    };

    struct Step; // the arguments of detect(), for its parts

    // Chooses the tetrahedra whose boxes have a longest side in (above, most].
    struct Sizes {
        double above, most;
    };

    void load_particles(std::span<const Body> bodies, bool some_filtered);
    Vec3d position(std::size_t particle) const;
    void compute_boxes(Step& step);
    void detect_level(Step& step, double cell_size, const Sizes& sizes);
    Lattice prepare_dense(const ReferenceSettings& settings, double cell_size, DenseAddress& address);
    Modulus prepare_hashed(const ReferenceSettings& settings);
    template <class Address>
    void run_hashed(Step& step, const Sizes& sizes, const Lattice& lattice, const Address& address);
    template <class Address>
    bool run(Step& step, const Sizes& sizes, const Lattice& lattice, const Address& address);
    template <class Address>
    bool classify(Step& step, const Lattice& lattice, const Address& address);
    SortedAddress prepare_sorted(const Lattice& lattice);
    template <class Address>
    void broad_phase(Step& step, std::uint32_t body, const Box3f* boxes, const Sizes& sizes,
                     const Lattice& lattice, const Address& address);
    void narrow_phase(Step& step, std::uint32_t body);

    Array<Particle> particles_;    // of all bodies, one after the other
    Array<Vec3d> exact_;           // their positions; empty where floats are enough
    Array<std::uint32_t> first_;   // each body's first particle, and the end
    Array<std::uint32_t> body_of_; // each particle; empty where all bodies may collide
    Array<Box3f> boxes_;           // of the tetrahedra of all bodies; empty boxes for degenerate ones
    CellLists cells_;
    Array<CellCoord> sorted_;                // the occupied cells, where a hash was of no use
    std::array<Candidate, 4096> candidates_; // between the phases; the narrow phase runs when it is full
    std::size_t candidate_count_ = 0;
};

} // namespace vox
