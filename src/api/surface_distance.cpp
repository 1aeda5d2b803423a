// The C border of vox_surface.h: what is close, and how far it may move.

#include "base/border.hpp"
#include "base/llu.hpp"
#include "base/structs.hpp"
#include "surface/surface.hpp"

#include <algorithm>
#include <cmath>

using namespace vox;

namespace {

const char* name_of(vox_feature feature) noexcept {
    constexpr const char* names[] = {"VERTEX", "EDGE", "FACE"};
    return names[feature];
}

} // namespace

vox_result vox_surface_find_proximities(vox_surface* surface, vox_feature a, vox_feature b, double distance,
                                        vox_close_view* out_view) {
    return border(surface, "surface", [&] {
        check_out_struct(out_view, "out_view");
        check_enum(a, VOX_FEATURE_FACE, "a");
        check_enum(b, VOX_FEATURE_FACE, "b");
        if (corners_of(a) + corners_of(b) > 4)
            refuse(format("a is %s and b is %s, expected FACE and VERTEX, EDGE and EDGE, EDGE and VERTEX, or "
                          "VERTEX and "
                          "VERTEX",
                          name_of(a), name_of(b)));
        if (!(distance >= 0) || !std::isfinite(distance))
            refuse(format("distance is %g, expected 0 or a length", distance));
        const std::span<const vox_close_pair> pairs = surface->close_pairs(a, b, distance);
        vox_close_view view{};
        view.byte_stride = sizeof(vox_close_pair);
        view.count = pairs.size();
        view.pairs = pairs.data();
        write_struct(out_view, view, "out_view");
    });
}

vox_result vox_surface_find_clearances(vox_surface* surface, double most, double* per_vertex,
                                       uint64_t vertex_count) {
    return border(surface, "surface", [&] {
        require(per_vertex, "per_vertex");
        if (vertex_count != surface->topology().vertex_count)
            refuse(format("vertex_count is %llu, but the surface has %u vertices", llu(vertex_count),
                          surface->topology().vertex_count));
        if (!(most > 0) || !std::isfinite(most))
            refuse(format("most is %g, expected a length above 0", most));
        surface->clearance(most, per_vertex);
    });
}
