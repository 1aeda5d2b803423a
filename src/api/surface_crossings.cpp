// The C border of vox_surface.h: crossings.

#include "base/border.hpp"
#include "surface/surface.hpp"

#include <span>

using namespace vox;

vox_result vox_surface_find_crossings(vox_surface* surface, vox_crossing_view* out_view) {
    return border(surface, "surface", out_view, "out_view", [&] {
        const std::span<const vox_crossing> crossings = surface->crossings();
        return vox_crossing_view{crossings.data(), crossings.size()};
    });
}
