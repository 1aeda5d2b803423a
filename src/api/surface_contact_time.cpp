// The C border of vox_surface.h: times of impact.

#include "base/border.hpp"
#include "base/structs.hpp"
#include "surface/contact_time.hpp"
#include "surface/surface.hpp"

#include <cmath>

using namespace vox;

namespace {

ContactTimeRule read_impact_desc(const vox_impact_desc* given) {
    vox_impact_desc desc{};
    if (given) desc = read_struct(given, "desc");
    set_default(desc.max_iterations, 10000u);
    set_default(desc.slack, 0.1);
    if (!(desc.distance >= 0) || !std::isfinite(desc.distance))
        refuse(format("distance is %g, expected 0 or a length", desc.distance));
    if (!(desc.slack > 0 && desc.slack < 1))
        refuse(format("slack is %g, expected a number between 0 and 1", desc.slack));
    return {desc.distance, desc.slack, desc.max_iterations};
}

} // namespace

vox_result vox_surface_find_safe_step(vox_surface* surface, const vox_impact_desc* desc, vox_safe_step* out) {
    return border(surface, "surface", out, "out", [&] { return surface->safe_step(read_impact_desc(desc)); });
}

vox_result vox_surface_find_impacts(vox_surface* surface, vox_feature a, vox_feature b,
                                    const vox_impact_desc* desc, vox_impact_view* out_view) {
    return border(surface, "surface", out_view, "out_view", [&] {
        check_enum(a, VOX_FEATURE_FACE, "a");
        check_enum(b, VOX_FEATURE_FACE, "b");
        if (!(a == VOX_FEATURE_FACE && b == VOX_FEATURE_VERTEX) &&
            !(a == VOX_FEATURE_EDGE && b == VOX_FEATURE_EDGE))
            refuse(format("a and b are %d and %d, expected VOX_FEATURE_FACE and VOX_FEATURE_VERTEX, or twice "
                          "VOX_FEATURE_EDGE",
                          int(a), int(b)));
        const std::span<const vox_impact> found = surface->impacts(a, b, read_impact_desc(desc));
        return vox_impact_view{found.data(), found.size()};
    });
}
