// The stages of a step that look at surfaces, as a list: a new kind of contact is a class like these, and a
// line in it. Each has
//   time                      the field of Profile that its time is added to
//   find(scene, kept)         replaces the contacts; those between bodies at rest may be carried over
//   count(counters)           of the last step
//   is_unchanged()            whether that found what the step before had, all of it carried over
//   pairs()                   of bodies that have such contacts, in order; how they touch
//   add_to(sources, trees, workers)
//                             what constraints are made of, with depths where these are asked for
//   clear()                   forgets the contacts, as when find() has thrown
//   forget(body)              forgets what was given for a body that is gone or whose vertices are others
//   forget_all()              all of this
#pragma once

#include "base/clock.hpp"
#include "grid/edge_contacts.hpp"
#include "grid/impacts.hpp"
#include "grid/proximities.hpp"
#include "grid/shape_contacts.hpp"

#include <vox/vox.h>

#include <optional>
#include <tuple>

namespace vox {

class SurfaceStages {
public:
    explicit SurfaceStages(std::pmr::memory_resource* memory) noexcept
        : memory_(memory), bound_(memory), previous_(memory) {}

    // Whether a step looks at surfaces.
    bool any() const noexcept { return kept_.has_value(); }
    // Those of meshes.
    bool reads_surfaces() const noexcept {
        return std::get<std::optional<EdgeContacts>>(stages_) || std::get<std::optional<Impacts>>(stages_) ||
               std::get<std::optional<Proximities>>(stages_);
    }
    double margin() const noexcept { return margin_; }

    // What they look for; drop_unused() gives up what is without use then.
    void find_edges(bool find) {
        (void)use<EdgeContacts>(find);
        if (shapes()) shapes()->find_edges(find);
    }
    void set_margin(double margin) {
        if (Proximities* const proximities = use<Proximities>(margin > 0)) proximities->set_margin(margin);
        margin_ = margin;
        if (shapes()) shapes()->set_margin(margin);
    }
    void find_shapes(bool find) {
        if (find == shapes().has_value()) return;
        (void)use<ShapeContacts>(find);
        if (!find) return;
        shapes()->set_margin(margin_);
        shapes()->find_edges(std::get<std::optional<EdgeContacts>>(stages_).has_value());
    }
    std::optional<ShapeContacts>& shapes() noexcept {
        return std::get<std::optional<ShapeContacts>>(stages_);
    }
    // The positions that a mesh had before; without data: it has none any more.
    void bind_previous(vox_body mesh, const Positions& positions) {
        const auto at = std::ranges::lower_bound(bound_, mesh, {}, &Bound::mesh);
        const bool is_bound = at != bound_.end() && at->mesh == mesh;
        if (!positions.data) return forget(mesh);
        if (shapes()) shapes()->change();
        (void)use<Impacts>(true);
        if (is_bound)
            at->positions = positions;
        else
            bound_.insert(at, {mesh, positions});
    }
    // Returns whether that leaves no stage, where there was one.
    bool drop_unused() noexcept {
        if (bound_.empty()) std::get<std::optional<Impacts>>(stages_).reset();
        const bool is_used =
            std::apply([](const auto&... stage) { return (stage.has_value() || ...); }, stages_);
        if (is_used || !any()) return false;
        kept_.reset();
        return true;
    }

    // Finds the contacts of a step; fill(scene, streamed) completes the scene. Returns whether they are those
    // of the step before.
    template <class Fill>
    bool find(StepScene& scene, const Fill& fill, Counters& counters, Profile& profile) {
        bool is_filled = false, is_unchanged = true;
        list_previous(scene);
        for_each([&](auto& stage) {
            const Timed timed(profile.*stage.time);
            if (!is_filled) fill(scene, kept_->streamed);
            is_filled = true;
            stage.find(scene, kept_->features);
            stage.count(counters);
            is_unchanged = is_unchanged && stage.is_unchanged();
        });
        return is_unchanged;
    }
    // Makes the features of the surface of a mesh; call it while reads_surfaces().
    void prepare(const Body& body, const Topology& topology, const SurfaceVersion& version,
                 const Tiles& tiles) {
        const Topology* const of = &topology;
        fast::StepBody prepared{};
        prepared.tiles = &tiles;
        StepScene scene{{&body, 1}, {&of, 1}, {&version, 1}, nullptr};
        scene.of = {&prepared, 1};
        (void)kept_->features.of(scene, 0);
    }
    // Calls visit(pairs) for each kind of contact.
    template <class Visit>
    void for_pairs(const Visit& visit) {
        for_each([&](auto& stage) { visit(stage.pairs()); });
    }
    void add_to(ConstraintSources& sources, depth::SurfaceTrees& trees, Workers& workers) {
        for_each([&](auto& stage) { stage.add_to(sources, trees, workers); });
    }

    void clear() noexcept {
        for_each([](auto& stage) { stage.clear(); });
    }
    void forget(vox_body mesh) noexcept {
        erase_if(bound_, [mesh](const Bound& bound) { return bound.mesh == mesh; });
        for_each([&](auto& stage) { stage.forget(mesh); });
    }
    // Tetrahedra of the mesh are others, or it is gone.
    void topology_changed(vox_body mesh) noexcept {
        if (kept_) kept_->features.forget(mesh);
        forget(mesh);
    }
    void forget_all() noexcept {
        if (kept_) kept_->features.forget_all();
        bound_.clear();
        for_each([](auto& stage) { stage.forget_all(); });
    }

private:
    struct Kept {
        explicit Kept(std::pmr::memory_resource* memory) : streamed(memory), features(memory) {}

        StreamedScene streamed; // the reference engine's steps
        KeptFeatures features;  // of surfaces that a stage came upon
    };

    struct Bound {
        vox_body mesh;
        Positions positions;
    };

    void list_previous(StepScene& scene) {
        previous_.clear();
        if (bound_.empty()) return;
        previous_.assign(scene.bodies.size(), {});
        auto at = bound_.begin();
        for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
            while (at != bound_.end() && at->mesh < scene.bodies[b].mesh_id) ++at;
            if (at != bound_.end() && at->mesh == scene.bodies[b].mesh_id) previous_[b] = at->positions;
        }
        scene.previous = previous_;
    }
    template <class Visit>
    void for_each(const Visit& visit) {
        std::apply([&](auto&... stage) { ((stage ? visit(*stage) : void()), ...); }, stages_);
    }
    // Null for a stage that is not wanted.
    template <class Stage>
    Stage* use(bool wanted) {
        auto& stage = std::get<std::optional<Stage>>(stages_);
        if (!wanted) {
            stage.reset();
            return nullptr;
        }
        if (!stage) stage.emplace(memory_);
        if (!kept_) kept_.emplace(memory_);
        return &*stage;
    }

    std::pmr::memory_resource* memory_;
    std::optional<Kept> kept_; // while there is a stage
    double margin_ = 0;
    Array<Bound> bound_;        // previous positions, by mesh
    Array<Positions> previous_; // of each body of a step
    // Those that are there, in their order in a step: bodies that touch before those that are near.
    std::tuple<std::optional<EdgeContacts>, std::optional<Impacts>, std::optional<ShapeContacts>,
               std::optional<Proximities>>
        stages_;
};

} // namespace vox
