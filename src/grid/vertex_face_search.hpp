// Vertices of one body that are near faces of the surface of another one, or meet the boxes of these while
// both move: what margin contacts and passages begin with. For both engines alike.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/per_worker.hpp"
#include "base/scene.hpp"
#include "fast/step_scene.hpp"
#include "grid/box_lanes.hpp"
#include "grid/edge_contacts.hpp"
#include "grid/surface_features.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

class Workers;

// A surface as the search reads it.
struct SearchedSurface {
    explicit SearchedSurface(std::pmr::memory_resource* memory) noexcept : features(memory), facets(memory) {}

    SurfaceFeatures features;   // faces in the order of facet_corners of features.tets
    Array<std::uint8_t> facets; // of each face: which of the tetrahedron it is
};

// Vertices of body a and the surface of body b.
struct VertexFacePair {
    std::uint32_t a, b;
    std::span<const std::uint32_t> vertices; // of a, ascending
    const SearchedSurface* surface;          // of b
};

// A vertex, by its place in VertexFacePair::vertices, and those faces of a tile whose boxes it meets, as
// bits.
struct NearFaces {
    std::uint32_t place, faces;
};

// Says which vertices count, and takes what is found: between begin() and end() of a worker is what it finds
// in some tiles of a pair, tile by tile. Calls of different workers may be concurrent.
class NearFacesVisitor {
public:
    // Takes those vertices of body a, in ascending order, out of the list that are of no interest to faces of
    // body b.
    virtual void leave_out(std::uint32_t a, std::uint32_t b, Array<std::uint32_t>& vertices) const = 0;
    virtual void begin(const VertexFacePair& pair, std::uint32_t worker) = 0;
    virtual void visit(const SurfaceTile& tile, std::span<const NearFaces> near, std::uint32_t worker) = 0;
    virtual void end(std::uint32_t worker) = 0;

protected:
    ~NearFacesVisitor() = default;
};

class VertexFaceSearch {
public:
    explicit VertexFaceSearch(std::pmr::memory_resource* memory);

    // Finds vertices and faces of different bodies that may collide, and of which one moved since the last
    // step, as far as the engine knows; no such pair that is within `margin` is left out.
    void find_near(const StepScene& scene, double margin, NearFacesVisitor& visitor);
    // The same for vertices and faces that may meet on their straight way from the previous positions, those
    // without data standing still, to the present ones. Throws MeshError with NON_FINITE or LIMIT for a
    // previous position.
    void find_meeting(const StepScene& scene, std::span<const Positions> previous, NearFacesVisitor& visitor);

    // Of a mesh that is gone, or whose tetrahedra are others.
    void forget(vox_body mesh) noexcept;
    void forget_all() noexcept { surfaces_.clear(); }

private:
    struct Kept { // of a mesh, by its id
        vox_body mesh;
        SurfaceVersion version;
        SearchedSurface surface;
    };
    struct Searched { // a body
        // Packed, rounded to floats; `before` is null for one that stands still.
        const float *at = nullptr, *before = nullptr;
        // Blocks [first_of_block[i], first_of_block[i + 1]) of vertices, and their boxes.
        BlockBoxes blocks{};
        std::span<const std::uint32_t> first_of_block{};
        Box box = empty_box;                      // around all
        float grow = 0;                           // of two bodies, the sum is how far apart boxes can be
        const SearchedSurface* surface = nullptr; // null where no pair needs it
        std::uint32_t first_tile = 0;             // in tile_boxes_
        Box reached = empty_box;                  // around where the boxes of others reach that of the body

        std::uint32_t block_count() const noexcept {
            return static_cast<std::uint32_t>(first_of_block.size() - 1);
        }
        Box vertex_box(std::uint32_t vertex) const noexcept {
            const float* p = at + 3 * std::size_t{vertex};
            Box box{{p[0], p[1], p[2], 0}, {p[0], p[1], p[2], 0}};
            if (!before) return box;
            const float* q = before + 3 * std::size_t{vertex};
            add(box, Box{{q[0], q[1], q[2], 0}, {q[0], q[1], q[2], 0}});
            return box;
        }
    };
    struct TilePiece {
        std::uint32_t body, first, last;
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory)
            : tiles(memory), blocks(memory), vertices(memory), first_of_run(memory), runs(memory),
              groups(memory) {}
        auto buffers() { return std::tie(tiles, blocks, vertices, first_of_run, runs, groups); }

        Array<std::uint32_t> tiles, blocks;
        Array<std::uint32_t> vertices;     // of body a, in runs: those of a block
        Array<std::uint32_t> first_of_run; // in vertices, and the end
        Array<Box> runs, groups;           // boxes of runs, and of groups of them
    };

    void prepare_bodies(const StepScene& scene, std::span<const Positions> previous, double margin);
    void search(const StepScene& scene, NearFacesVisitor& visitor);
    const SearchedSurface& surface_of(const StepScene& scene, std::uint32_t body);
    void prepare_surfaces(const StepScene& scene);
    void make_tile_boxes(const StepScene& scene);
    bool list(const fast::Pair& pair, const NearFacesVisitor& visitor, Worker& worker) const;
    void make_runs(const Searched& body, Worker& worker) const;
    void load(const Searched& body, const SurfaceTile& tile, float reach, FaceBoxes& out) const;
    void search_tiles(const fast::Pair& pair, const Worker& lists, std::size_t begin, std::size_t end,
                      NearFacesVisitor& visitor, std::uint32_t worker) const;

    std::pmr::memory_resource* memory() const noexcept { return surfaces_.memory(); }

    Array<Kept> surfaces_; // by mesh

    // One search.
    Array<float> packed_;                  // previous positions
    Array<Box> block_boxes_, group_boxes_; // of bodies that move from there
    Array<Searched> searched_;             // of each body
    Array<Box> body_boxes_;
    fast::PairBuffers pair_buffers_;
    Array<fast::Pair> pairs_; // vertices of a, faces of b
    Array<TilePiece> pieces_;
    Array<Box> tile_boxes_;
    PerWorker<Worker> workers_;
};

} // namespace vox
