// The C border of vox_surface.h: surfaces, motion, pairs.

#include "surface/surface.hpp"
#include "base/border.hpp"
#include "base/caller_memory.hpp"
#include "base/memory.hpp"
#include "base/simd.hpp"
#include "base/structs.hpp"

#include <cmath>
#include <memory_resource>

using namespace vox;

namespace {

void check_surface_desc(const vox_surface_desc& desc) {
    check_allocator(desc.allocator, "allocator");
    check_workers(value_of(desc.tasks), desc.worker_count);
    if (!(desc.cell_size >= 0) || !std::isfinite(desc.cell_size))
        refuse(format("cell_size is %g, expected 0 or a length", desc.cell_size));
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
            throw Error(VOX_ERROR_BUDGET,
                        format("an empty surface needs %zu bytes, its byte budget is %llu", least,
                               static_cast<unsigned long long>(settings.byte_budget)));
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
        check_enum(a, VOX_FEATURE_FACE, "a");
        check_enum(b, VOX_FEATURE_FACE, "b");
        const FeaturePairs& pairs = surface->pairs(a, b, first, count);
        return vox_partner_lists{pairs.offsets.data(), pairs.partners.data(), pairs.first, pairs.count};
    });
}

vox_result vox_surface_set_cell_size(vox_surface* surface, double cell_size) {
    return border(surface, "surface", [&] { surface->set_cell_size(cell_size); });
}

vox_result vox_surface_suggest_cell_size(vox_surface* surface, vox_feature a, vox_feature b,
                                         vox_cell_size_result* out) {
    return border(surface, "surface", [&] {
        check_out_struct(out, "out");
        check_enum(a, VOX_FEATURE_FACE, "a");
        check_enum(b, VOX_FEATURE_FACE, "b");
        write_struct(out, surface->suggest_cell_size(a, b), "out");
    });
}

vox_result vox_surface_get_counters(const vox_surface* surface, vox_counter_view* out_view) {
    return border(surface, "surface", out_view, "out_view", [&] { return surface->counters(); });
}
