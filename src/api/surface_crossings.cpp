// The C border of vox_surface.h: crossings.

#include "base/border.hpp"
#include "base/structs.hpp"
#include "surface/surface.hpp"

#include <span>

using namespace vox;

vox_result vox_surface_find_crossings(vox_surface* surface, vox_crossing_view* out_view) {
    return border(surface, "surface", [&] {
        check_out_struct(out_view, "out_view");
        const std::span<const vox_crossing> crossings = surface->crossings();
        vox_crossing_view view{};
        view.byte_stride = sizeof(vox_crossing);
        view.count = crossings.size();
        view.crossings = crossings.data();
        write_struct(out_view, view, "out_view");
    });
}
