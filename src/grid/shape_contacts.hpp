// Contacts with rigid shapes: vertices that are inside, within the margin, or passed through since their
// previous places, at most one with each shape; and edges. For both engines alike.
#pragma once

#include "base/counters.hpp"
#include "base/parallel.hpp"
#include "base/per_worker.hpp"
#include "fast/step_scene.hpp"
#include "grid/shape_edges.hpp"
#include "shape/shape.hpp"

#include <vox/vox.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

namespace depth {
class SurfaceTrees;
}
struct ConstraintSources;

// A vertex has at most one with each shape.
struct ShapeVertex {
    std::uint32_t vertex;
    std::uint32_t element;
    double gap, time;
    double normal[3];
    vox_constraint_kind kind;
    vox_depth_state state;
};

// Contacts of a mesh with a shape, in order: of vertices or of edges, the other span is empty.
struct ShapeRun {
    vox_body body_a, body_b;
    std::size_t first; // of these, among all contacts with shapes
    std::span<const ShapeVertex> vertices;
    std::span<const ShapeEdge> edges;
    std::array<std::size_t, 4> of_kind; // how many

    std::size_t count() const noexcept { return vertices.size() + edges.size(); }
};

class ShapeContacts {
public:
    static constexpr auto time = &Profile::shapes_ns;

    explicit ShapeContacts(std::pmr::memory_resource* memory)
        : previous_(memory), placed_(memory), moving_groups_(memory),
          tasks_(memory), workers_{PerWorker<Worker>(memory), PerWorker<Worker>(memory)}, runs_(memory),
          pairs_(memory) {}

    void set_margin(double margin) noexcept {
        margin_ = margin;
        changed_ = true;
    }
    void find_edges(bool find) noexcept {
        finds_edges_ = find;
        changed_ = true;
    }
    // The transform that a shape had before; null: none. Throws what the memory throws.
    void bind_previous(vox_body shape, const double* matrix);
    // More than that meshes moved.
    void change() noexcept { changed_ = true; }

    void find(const StepScene& scene, KeptFeatures& kept);
    void count(Counters& counters) const noexcept {
        counters.shape_contacts = count_;
        counters.carried_shape_contacts = carried_;
    }
    bool is_unchanged() const noexcept { return is_unchanged_; }
    std::span<const vox_pair> pairs() const noexcept { return pairs_; }
    void add_to(ConstraintSources& sources, depth::SurfaceTrees&, Workers&) const noexcept;

    void clear() noexcept {
        runs_.clear();
        pairs_.clear();
        count_ = 0;
        changed_ = true;
    }
    void forget(vox_body body) noexcept;
    void forget_all() noexcept {
        clear();
        previous_.clear();
    }

private:
    struct Previous {
        vox_body shape;
        std::array<double, 12> matrix;
    };
    // A shape of a step.
    struct Placed {
        std::uint32_t body;
        const RigidShape* shape;
        ShapePlace now, before;
        bool moves;
        RigidShape::Bounds bounds; // with the margin around it
    };
    // Where the vertices of 16 blocks were before.
    struct Sphere {
        Vec3d centre;
        double radius;
    };
    // Vertices of groups [first, last) of a mesh, in their order; tiles [first, last) of its surface, of
    // which the first task has the contacts of all at the end; or runs [first, last) that are carried over.
    enum class Does { vertices, edges, carry };
    struct Task {
        std::uint32_t body, placed;
        std::size_t first, last;
        Does does;
        std::size_t first_moving; // of the mesh, in moving_groups_
        std::uint32_t worker;
        std::size_t begin_vertex, end_vertex, begin_edge, end_edge; // in that worker's lists
        std::size_t begin_crossing, end_crossing;                   // of edges of the shape
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory)
            : vertices(memory), edges(memory), crossings(memory) {}
        auto buffers() {
            return std::tie(vertices, edges, crossings.of_one_search, crossings.of_shape, crossings.of_mesh);
        }

        Array<ShapeVertex> vertices;
        Array<ShapeEdge> edges;
        ShapeCrossings crossings;
    };
    struct Search;

    void place_shapes(const StepScene& scene);
    void surround_previous(const StepScene& scene);
    void list_tasks(const StepScene& scene, KeptFeatures& kept);
    void run(const StepScene& scene, KeptFeatures& kept, Task& task, Worker& out) const;
    void join_edges(const StepScene& scene, std::size_t first, std::uint32_t worker);
    ShapePair pair_of(const StepScene& scene, const Task& task) const noexcept;
    void list_results(const StepScene& scene);
    Box box_of(const StepScene& scene, std::uint32_t body, const Placed& placed) const noexcept;
    bool has_previous(const StepScene& scene, std::uint32_t body) const noexcept {
        return body < scene.previous.size() && scene.previous[body].data;
    }

    double margin_ = 0;
    bool finds_edges_ = false;
    bool changed_ = true;
    Array<Previous> previous_; // by shape

    // One step.
    Array<Placed> placed_;
    Array<Sphere> moving_groups_; // of meshes with previous positions, one after another
    Array<Task> tasks_;
    std::array<PerWorker<Worker>, 2> workers_; // what they found in this step and in the one before
    std::size_t now_ = 0;                      // of the two

    // Results.
    Array<ShapeRun> runs_; // sorted by (body_a, body_b), vertices before edges
    Array<vox_pair> pairs_;
    std::size_t count_ = 0;
    std::size_t carried_ = 0;
    bool is_unchanged_ = false;
};

} // namespace vox
