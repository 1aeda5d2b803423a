// The C border of vox_surface.h's section on the time of contact.

#include "base/border.hpp"
#include "base/structs.hpp"
#include "surface/contact_time.hpp"
#include "surface/surface.hpp"

#include <cmath>

using namespace vox;

namespace {

ContactTimeRule read_contact_time_desc(const vox_contact_time_desc* given) {
    vox_contact_time_desc desc{};
    if (given) desc = read_struct(given, "desc");
    set_default(desc.most_iterations, 10000u);
    set_default(desc.slack, 0.1);
    if (!(desc.distance >= 0) || !std::isfinite(desc.distance))
        refuse(format("distance is %g, expected 0 or a length", desc.distance));
    if (!(desc.slack > 0 && desc.slack < 1))
        refuse(format("slack is %g, expected a number between 0 and 1", desc.slack));
    return {desc.distance, desc.slack, desc.most_iterations};
}

} // namespace

vox_result vox_surface_find_safe_step(vox_surface* surface, const vox_contact_time_desc* desc,
                                      vox_safe_step* out) {
    return border(surface, "surface", [&] {
        check_out_struct(out, "out");
        write_struct(out, surface->safe_step(read_contact_time_desc(desc)), "out");
    });
}

vox_result vox_surface_find_impacts(vox_surface* surface, vox_feature a, vox_feature b,
                                    const vox_contact_time_desc* desc, vox_timed_view* out_view) {
    return border(surface, "surface", [&] {
        check_out_struct(out_view, "out_view");
        check_enum(a, VOX_FEATURE_FACE, "a");
        check_enum(b, VOX_FEATURE_FACE, "b");
        if (!(a == VOX_FEATURE_FACE && b == VOX_FEATURE_VERTEX) &&
            !(a == VOX_FEATURE_EDGE && b == VOX_FEATURE_EDGE))
            refuse(format("a and b are %d and %d, expected VOX_FEATURE_FACE and VOX_FEATURE_VERTEX, or twice "
                          "VOX_FEATURE_EDGE",
                          int(a), int(b)));
        const auto found = surface->contact_times(a, b, read_contact_time_desc(desc));
        vox_timed_view view{};
        view.byte_stride = sizeof(vox_timed_pair);
        view.count = found.size();
        view.pairs = found.data();
        write_struct(out_view, view, "out_view");
    });
}
