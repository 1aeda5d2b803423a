// The C border of scenes on a device.
#include "base/border.hpp"
#include "base/structs.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/upload.hpp"

#include <vox/vox_gpu.h>

#include <algorithm>
#include <cmath>

using namespace vox;
using namespace vox::gpu;

struct vox_gpu {
    Pipeline pipeline;
};

namespace {

constexpr u64 usual_budget = u64{4} << 30;

// The byte stride.
u64 checked_positions(const vox_positions* positions, u64 count) {
    require(positions, "positions");
    require(count == 0 ? positions : positions->data, "positions->data");
    if (positions->count != count)
        refuse(format("positions->count is %llu, expected %llu",
                      static_cast<unsigned long long>(positions->count),
                      static_cast<unsigned long long>(count)));
    check_enum(positions->format, VOX_FORMAT_DOUBLE, "positions->format");
    constexpr u64 packed = 3 * sizeof(float), component = sizeof(float);
    if (positions->format != VOX_FORMAT_FLOAT ||
        (positions->component_byte_stride != 0 && positions->component_byte_stride != component))
        throw Error(VOX_ERROR_UNSUPPORTED, "positions on a device are floats x y z, one after the other");
    const u64 stride = positions->byte_stride ? positions->byte_stride : packed;
    if (stride < packed || stride % sizeof(float) != 0)
        refuse(format("positions->byte_stride is %llu, expected a multiple of 4 from 12 on",
                      static_cast<unsigned long long>(stride)));
    return stride;
}

} // namespace

vox_result vox_gpu_create(const vox_gpu_desc* desc, const vox_grid* const* grids, uint64_t count,
                          vox_gpu** out_gpu) {
    return border([&] {
        require(out_gpu, "out_gpu");
        const vox_gpu_desc settings = desc ? read_struct(desc, "desc") : vox_default_gpu_desc();
        if (!(settings.cell_size >= 0) || std::isinf(settings.cell_size))
            refuse(format("desc->cell_size is %g, expected a finite number >= 0", settings.cell_size));
        if (settings.device > INT32_MAX)
            refuse(format("desc->device is %u, at most 2147483647", settings.device));
        check_limit(settings.contact_capacity, VOX_MAX_CONTACTS, "desc->contact_capacity");
        if (count) require(grids, "grids");
        for (u64 i = 0; i < count; ++i) require(grids[i], "grids[i]");
        StepRooms rooms;
        rooms.contacts = settings.contact_capacity;
        const SceneData data = read_grids({grids, static_cast<std::size_t>(count)}, settings.cell_size);
        *out_gpu = new vox_gpu{Pipeline(make_backend(static_cast<int>(settings.device)), data, rooms,
                                        settings.byte_budget ? settings.byte_budget : usual_budget)};
    });
}

void vox_gpu_destroy(vox_gpu* gpu) { delete gpu; }

vox_result vox_gpu_bind_positions(vox_gpu* gpu, const vox_positions* positions) {
    return border(gpu, "gpu", [&] {
        const u64 stride = checked_positions(positions, gpu->pipeline.arrays().vertex_count);
        gpu->pipeline.bind(positions->data, stride);
    });
}

vox_result vox_gpu_step(vox_gpu* gpu, void* stream) {
    return border(gpu, "gpu", [&] { gpu->pipeline.step(stream); });
}

vox_result vox_gpu_get_view(vox_gpu* gpu, vox_gpu_view* out_view) {
    return border(gpu, "gpu", out_view, "out_view", [&] {
        const SceneArrays& s = gpu->pipeline.arrays();
        return vox_gpu_view{s.contacts, s.interiors, s.weights[0], s.contact_begin, s.status, s.contact_room};
    });
}

vox_result vox_gpu_finish(vox_gpu* gpu, vox_gpu_status* out_status) {
    return border(gpu, "gpu", [&] {
        const StepStatus status = gpu->pipeline.finish();
        if (out_status) *out_status = status;
        if (status.faults & non_finite_position) {
            const std::vector<BodyOfScene>& bodies = gpu->pipeline.bodies();
            const auto next = std::find_if(bodies.begin(), bodies.end(), [&](const BodyOfScene& b) {
                return b.first_vertex + b.vertex_count > status.non_finite_vertex;
            });
            const u32 vertex = status.non_finite_vertex - next->first_vertex;
            throw Error(VOX_ERROR_NON_FINITE, format("vertex %u of body %u is not finite", vertex, next->id));
        }
        if (status.faults)
            throw Error(
                VOX_ERROR_LIMIT,
                format(
                    "the lists of a step were too short for %u points, %u findings and %u contacts: they are "
                    "longer now, step again",
                    status.needed_points, status.needed_findings, status.needed_contacts));
    });
}
