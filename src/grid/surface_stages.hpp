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

#include <vox/vox.h>

#include <optional>
#include <tuple>

namespace vox {

class SurfaceStages {
public:
    explicit SurfaceStages(std::pmr::memory_resource* memory) noexcept : memory_(memory) {}

    // Whether a step looks at surfaces.
    bool any() const noexcept { return kept_.has_value(); }
    double margin() const noexcept {
        const auto& proximities = std::get<std::optional<Proximities>>(stages_);
        return proximities ? proximities->margin() : 0;
    }

    // What they look for; drop_unused() gives up what is without use then.
    void find_edges(bool find) { (void)use<EdgeContacts>(find); }
    void set_margin(double margin) {
        if (Proximities* const proximities = use<Proximities>(margin > 0)) proximities->set_margin(margin);
    }
    void bind_previous(vox_body mesh, const Positions& positions) {
        if (positions.data || std::get<std::optional<Impacts>>(stages_))
            use<Impacts>(true)->bind(mesh, positions);
    }
    // Returns whether that leaves no stage, where there was one.
    bool drop_unused() noexcept {
        auto& impacts = std::get<std::optional<Impacts>>(stages_);
        if (impacts && !impacts->any_bound()) impacts.reset();
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
        for_each([&](auto& stage) { stage.forget(mesh); });
    }
    // Tetrahedra of the mesh are others, or it is gone.
    void topology_changed(vox_body mesh) noexcept {
        if (kept_) kept_->features.forget(mesh);
        forget(mesh);
    }
    void forget_all() noexcept {
        if (kept_) kept_->features.forget_all();
        for_each([](auto& stage) { stage.forget_all(); });
    }

private:
    struct Kept {
        explicit Kept(std::pmr::memory_resource* memory) : streamed(memory), features(memory) {}

        StreamedScene streamed; // the reference engine's steps
        KeptFeatures features;  // of surfaces that a stage came upon
    };

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
    // Those that are there, in their order in a step: bodies that touch before those that are near.
    std::tuple<std::optional<EdgeContacts>, std::optional<Impacts>, std::optional<Proximities>> stages_;
};

} // namespace vox
