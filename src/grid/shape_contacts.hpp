// Contacts of vertices with rigid shapes: inside, within the margin, or passed through since their previous
// places. For both engines alike.
#pragma once

#include "base/counters.hpp"
#include "base/parallel.hpp"
#include "base/per_worker.hpp"
#include "fast/step_scene.hpp"
#include "grid/surface_features.hpp"
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
struct ShapeContact {
    vox_body body_a;
    std::uint32_t vertex;
    vox_body body_b; // the shape
    std::uint32_t element;
    vox_constraint_kind kind;
    vox_depth_state state;
    double gap, time;
    double normal[3];
};

class ShapeContacts {
public:
    static constexpr auto time = &Profile::shapes_ns;

    explicit ShapeContacts(std::pmr::memory_resource* memory)
        : previous_(memory), placed_(memory), moving_groups_(memory), tasks_(memory), workers_(memory),
          found_(memory), all_(memory), pairs_(memory) {}

    void set_margin(double margin) noexcept {
        margin_ = margin;
        changed_ = true;
    }
    // The transform that a shape had before; null: none. Throws what the memory throws.
    void bind_previous(vox_body shape, const double* matrix);
    // More than that meshes moved.
    void change() noexcept { changed_ = true; }

    void find(const StepScene& scene, KeptFeatures&);
    void count(Counters& counters) const noexcept {
        counters.shape_contacts = all_.size();
        counters.carried_shape_contacts = carried_;
    }
    bool is_unchanged() const noexcept { return is_unchanged_; }
    std::span<const vox_pair> pairs() const noexcept { return pairs_; }
    void add_to(ConstraintSources& sources, depth::SurfaceTrees&, Workers&) const noexcept;

    void clear() noexcept {
        all_.clear();
        pairs_.clear();
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
    // Groups [first, last) of a mesh; or what is carried over from all_. Its results are in the order of
    // vertices.
    struct Task {
        std::uint32_t body, placed;
        std::size_t first, last;
        bool carries;
        std::size_t first_moving; // of the mesh, in moving_groups_
        std::uint32_t worker;
        std::size_t begin, end; // in that worker's list
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory) : found(memory) {}
        auto buffers() { return std::tie(found); }

        Array<ShapeContact> found;
    };
    struct Search;

    void place_shapes(const StepScene& scene);
    void surround_previous(const StepScene& scene);
    void list_tasks(const StepScene& scene);
    void list_results();
    bool has_previous(const StepScene& scene, std::uint32_t body) const noexcept {
        return body < scene.previous.size() && scene.previous[body].data;
    }

    double margin_ = 0;
    bool changed_ = true;
    Array<Previous> previous_; // by shape

    // One step.
    Array<Placed> placed_;
    Array<Sphere> moving_groups_; // of meshes with previous positions, one after another
    Array<Task> tasks_;
    PerWorker<Worker> workers_;
    Array<ShapeContact> found_;

    // Results, sorted by (body_a, body_b, vertex).
    Array<ShapeContact> all_;
    Array<vox_pair> pairs_;
    std::size_t carried_ = 0;
    bool is_unchanged_ = false;
};

} // namespace vox
