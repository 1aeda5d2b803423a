// The C border of vox.h's cell-size section.

#include "border.hpp"
#include "geometry.hpp"
#include "mesh_check.hpp"
#include "structs.hpp"
#include "suggest.hpp"

#include <cinttypes>
#include <cmath>
#include <limits>
#include <vector>

using namespace vox;

namespace {

vox_suggest_desc suggest_defaults() {
    vox_suggest_desc desc{};
    desc.struct_size = sizeof desc;
    desc.p_nc = 0.99;
    desc.cost_ratio = 5;
    desc.zone_loss = 0.05;
    desc.mean_edge_factor = 2;
    return desc;
}

// The caller's array: its elements are as far apart as the caller's own vox_mesh_desc is large.
std::vector<Body> read_bodies(const vox_mesh_desc* meshes, std::uint64_t count) {
    std::vector<Body> bodies;
    if (count == 0) return bodies;
    require(meshes, "meshes");
    if (count > VOX_MAX_MESHES)
        throw Error(VOX_ERROR_LIMIT,
                    format("mesh_count is %" PRIu64 ", the limit is %u", count, VOX_MAX_MESHES));
    check_out_struct(meshes, "meshes[0]");
    const std::uint32_t stride = meshes->struct_size;
    if (stride % alignof(vox_mesh_desc) != 0)
        throw Error(VOX_ERROR_INVALID_ARGUMENT,
                    format("meshes[0].struct_size is %u, expected a multiple of %zu", stride,
                           alignof(vox_mesh_desc)));
    vox_mesh_desc defaults{};
    defaults.struct_size = sizeof defaults;
    bodies.reserve(static_cast<std::size_t>(count));
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto* element = reinterpret_cast<const vox_mesh_desc*>(
            reinterpret_cast<const std::byte*>(meshes) + std::size_t{i} * stride);
        if (element->struct_size != stride)
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("meshes[%u].struct_size is %u, that of meshes[0] is %u", i,
                               element->struct_size, stride));
        const vox_mesh_desc desc = read_struct(element, defaults, "mesh");
        Body body = check_mesh(desc, format("mesh %u: ", i).c_str(), NullPositions::rejected);
        body.mesh_id = i;
        bodies.push_back(body);
    }
    return bodies;
}

void check_cells(double cells, const char* name) {
    if (!(cells > 0) || !std::isfinite(cells))
        throw Error(VOX_ERROR_INVALID_ARGUMENT, format("%s is %.9g, expected a number above 0", name, cells));
}

// Eq. 9 as printed has the factors a = floor(n_opt / n) and b = floor(n / n_opt) to choose the side that n
// lies on; the other one is zero, and where the one is above 1 it cancels out.
double zone_distance(double n, double n_min, double n_opt, double n_max) {
    if (n == n_opt) return 0;
    const double width = n < n_opt ? n_opt - n_min : n_max - n_opt;
    return width > 0 ? std::abs(n_opt - n) / width : std::numeric_limits<double>::infinity();
}

} // namespace

vox_result vox_suggest_desc_init(vox_suggest_desc* desc, uint32_t struct_size) {
    return border([&] { init_struct(desc, struct_size, suggest_defaults(), "vox_suggest_desc"); });
}

vox_result vox_suggest_cell_size(const vox_suggest_desc* desc, const vox_mesh_desc* meshes,
                                 uint64_t mesh_count, vox_suggestion* out) {
    return border([&] {
        check_out_struct(out, "out");
        const vox_suggest_desc settings =
            desc ? read_struct(desc, suggest_defaults(), "vox_suggest_desc") : suggest_defaults();
        check_suggest_desc(settings);
        write_struct(out, suggest(settings, measure(read_bodies(meshes, mesh_count))), "out");
    });
}

vox_result vox_zone_distance(double n, double n_min, double n_opt, double n_max, double* out_epsilon) {
    return border([&] {
        require(out_epsilon, "out_epsilon");
        check_cells(n, "n");
        check_cells(n_min, "n_min");
        check_cells(n_opt, "n_opt");
        check_cells(n_max, "n_max");
        if (!(n_min <= n_opt && n_opt <= n_max))
            throw Error(VOX_ERROR_INVALID_ARGUMENT,
                        format("n_min %.9g, n_opt %.9g, n_max %.9g: expected in ascending order", n_min,
                               n_opt, n_max));
        *out_epsilon = zone_distance(n, n_min, n_opt, n_max);
    });
}
