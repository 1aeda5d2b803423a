// The C border of vox_surface.h: what is close, and how far it may move.

#include "base/border.hpp"
#include "base/structs.hpp"
#include "surface/surface.hpp"

#include <cmath>

using namespace vox;

namespace {

const char* name_of(vox_feature feature) noexcept {
    constexpr const char* names[] = {"VERTEX", "EDGE", "FACE"};
    return names[feature];
}

} // namespace

vox_result vox_surface_find_proximities(vox_surface* surface, vox_feature a, vox_feature b, double distance,
                                        vox_proximity_view* out_view) {
    return border(surface, "surface", out_view, "out_view", [&] {
        check_enum(a, VOX_FEATURE_FACE, "a");
        check_enum(b, VOX_FEATURE_FACE, "b");
        if (corners_of(a) + corners_of(b) > 4)
            refuse(format("a is %s and b is %s, expected FACE and VERTEX, EDGE and EDGE, EDGE and VERTEX, or "
                          "VERTEX and "
                          "VERTEX",
                          name_of(a), name_of(b)));
        if (!(distance >= 0) || !std::isfinite(distance))
            refuse(format("distance is %g, expected 0 or a length", distance));
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
