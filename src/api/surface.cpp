// The C border of vox_surface.h.

#include "surface/surface.hpp"
#include "base/border.hpp"
#include "base/caller_memory.hpp"
#include "base/llu.hpp"
#include "base/memory.hpp"
#include "base/simd.hpp"
#include "base/structs.hpp"
#include "surface/contact_time.hpp"

#include <cmath>
#include <memory_resource>
#include <span>

using namespace vox;

namespace {

void check_length(double value, const char* name) {
    if (!(value >= 0) || !std::isfinite(value))
        refuse(format("%s is %g, expected 0 or a length", name, value));
}

void check_surface_desc(const vox_surface_desc& desc) {
    check_allocator(desc.allocator, "allocator");
    check_workers(value_of(desc.tasks), desc.worker_count);
    check_length(desc.cell_size, "cell_size");
}

// By reference: a value that is none of vox_feature must not be loaded before it is checked.
void check_features(const vox_feature& a, const vox_feature& b) {
    check_enum(a, VOX_FEATURE_FACE, "a");
    check_enum(b, VOX_FEATURE_FACE, "b");
}

const char* name_of(vox_feature feature) noexcept {
    constexpr const char* names[] = {"VERTEX", "EDGE", "FACE"};
    return names[feature];
}

ContactTimeRule read_impact_desc(const vox_impact_desc* given) {
    vox_impact_desc desc{};
    if (given) desc = read_struct(given, "desc");
    set_default(desc.max_iterations, 10000u);
    set_default(desc.slack, 0.1);
    check_length(desc.distance, "distance");
    if (!(desc.slack > 0 && desc.slack < 1))
        refuse(format("slack is %g, expected a number between 0 and 1", desc.slack));
    return {desc.distance, desc.slack, desc.max_iterations};
}

} // namespace

vox_result vox_surface_create(const vox_surface_desc* desc, vox_surface** out_surface) {
    return border([&] {
        require(desc, "desc");
        require(out_surface, "out_surface");
        simd::require_instructions();
        vox_surface_desc settings = read_struct(desc, "desc");
        settings.byte_budget = byte_limit(settings.byte_budget);
        check_surface_desc(settings);
        constexpr std::size_t least = sizeof(GridMemory) + sizeof(vox_surface);
        if (settings.byte_budget < least)
            throw Error(VOX_ERROR_BUDGET, format("an empty surface needs %zu bytes, its byte budget is %llu",
                                                 least, llu(settings.byte_budget)));
        const MemoryShare memory(settings.allocator, settings.byte_budget);
        std::pmr::polymorphic_allocator<> allocator(&*memory);
        *out_surface = allocator.new_object<vox_surface>(settings, memory);
    });
}

void vox_surface_destroy(vox_surface* surface) {
    if (!surface) return;
    const MemoryShare memory = surface->memory();
    std::pmr::polymorphic_allocator<> allocator(&*memory);
    allocator.delete_object(surface);
}

vox_result vox_surface_get_features(const vox_surface* surface, vox_feature feature,
                                    vox_feature_view* out_view) {
    return border(surface, "surface", out_view, "out_view", [&] {
        check_enum(feature, VOX_FEATURE_FACE, "feature");
        if (feature == VOX_FEATURE_VERTEX) refuse("feature is VOX_FEATURE_VERTEX, expected edges or faces");
        const SurfaceTopology& topology = surface->topology();
        const std::uint64_t count = topology.count(feature);
        return vox_feature_view{count > 0 ? topology.corners(feature, 0) : nullptr, count};
    });
}

vox_result vox_surface_move(vox_surface* surface, const vox_motion* motion) {
    return border(surface, "surface", [&] { surface->move(read_struct(motion, "motion")); });
}

vox_result vox_surface_find_pairs(vox_surface* surface, vox_feature a, vox_feature b, uint64_t first,
                                  uint64_t count, vox_partner_lists* out_lists) {
    return border(surface, "surface", out_lists, "out_lists", [&] {
        check_features(a, b);
        const FeaturePairs& pairs = surface->pairs(a, b, first, count);
        return vox_partner_lists{pairs.offsets.data(), pairs.partners.data(), pairs.first, pairs.count};
    });
}

vox_result vox_surface_find_crossings(vox_surface* surface, vox_crossing_view* out_view) {
    return border(surface, "surface", out_view, "out_view", [&] {
        const std::span<const vox_crossing> crossings = surface->crossings();
        return vox_crossing_view{crossings.data(), crossings.size()};
    });
}

vox_result vox_surface_find_proximities(vox_surface* surface, vox_feature a, vox_feature b, double distance,
                                        vox_proximity_view* out_view) {
    return border(surface, "surface", out_view, "out_view", [&] {
        check_features(a, b);
        if (corners_of(a) + corners_of(b) > 4)
            refuse(format("a is %s and b is %s, expected FACE and VERTEX, EDGE and EDGE, EDGE and VERTEX, or "
                          "VERTEX and VERTEX",
                          name_of(a), name_of(b)));
        check_length(distance, "distance");
        const std::span<const vox_proximity> found = surface->proximities(a, b, distance);
        return vox_proximity_view{found.data(), found.size()};
    });
}

vox_result vox_surface_find_clearances(vox_surface* surface, double max_distance, double* out_distances) {
    return border(surface, "surface", [&] {
        if (surface->topology().count(VOX_FEATURE_VERTEX) > 0) require(out_distances, "out_distances");
        if (!(max_distance > 0) || !std::isfinite(max_distance))
            refuse(format("max_distance is %g, expected a length above 0", max_distance));
        surface->clearances(max_distance, out_distances);
    });
}

vox_result vox_surface_find_safe_step(vox_surface* surface, const vox_impact_desc* desc, vox_safe_step* out) {
    return border(surface, "surface", out, "out", [&] { return surface->safe_step(read_impact_desc(desc)); });
}

vox_result vox_surface_find_impacts(vox_surface* surface, vox_feature a, vox_feature b,
                                    const vox_impact_desc* desc, vox_impact_view* out_view) {
    return border(surface, "surface", out_view, "out_view", [&] {
        check_features(a, b);
        if (!(a == VOX_FEATURE_FACE && b == VOX_FEATURE_VERTEX) &&
            !(a == VOX_FEATURE_EDGE && b == VOX_FEATURE_EDGE))
            refuse(format("a and b are %d and %d, expected VOX_FEATURE_FACE and VOX_FEATURE_VERTEX, or twice "
                          "VOX_FEATURE_EDGE",
                          int(a), int(b)));
        const std::span<const vox_impact> found = surface->impacts(a, b, read_impact_desc(desc));
        return vox_impact_view{found.data(), found.size()};
    });
}

vox_result vox_surface_set_cell_size(vox_surface* surface, double cell_size) {
    return border(surface, "surface", [&] { surface->set_cell_size(cell_size); });
}

vox_result vox_surface_suggest_cell_size(vox_surface* surface, vox_feature a, vox_feature b,
                                         vox_cell_size_result* out) {
    return border(surface, "surface", [&] {
        check_out_struct(out, "out");
        check_features(a, b);
        write_struct(out, surface->suggest_cell_size(a, b), "out");
    });
}

vox_result vox_surface_get_counters(const vox_surface* surface, vox_counter_view* out_view) {
    return border(surface, "surface", out_view, "out_view", [&] { return surface->counters(); });
}
