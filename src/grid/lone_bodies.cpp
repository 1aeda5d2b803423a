#include "grid/lone_bodies.hpp"

#include "fast/lone_boxes.hpp"

#include <algorithm>

namespace vox {

namespace {

// So few small bodies are not worth looking for, and neither are they where there are more than so many
// vertices of large bodies for each: the boxes of those are made twice.
constexpr std::size_t few_bodies = 64, most_large_vertices = 16;
constexpr std::size_t task_slots = 512; // are worth a task: some ten microseconds

// The box around positions; empty where one is not finite: the step fails then, or leaves the body out.
Box box_around(const Positions& positions, std::uint32_t count) noexcept {
    Box box = empty_box;
    bool finite = true;
    for (std::uint32_t v = 0; v < count; ++v) {
        const Vec3f p = positions[v];
        const float x[3] = {p.x, p.y, p.z};
        for (int a = 0; a < 3; ++a) {
            finite &= x[a] - x[a] == 0;
            box.lo[a] = x[a] < box.lo[a] ? x[a] : box.lo[a];
            box.hi[a] = x[a] > box.hi[a] ? x[a] : box.hi[a];
        }
    }
    return finite ? box : empty_box;
}

} // namespace

void LoneBodies::look_at(MeshSlot& slot, std::size_t index, bool all_rounded) {
    Box& box = boxes_[index] = empty_box;
    slots_[index] = {};
    if (!slot.live || !slot.mesh.is_enabled() || !slot.mesh.has_positions()) return;
    Slot& seen = slots_[index];
    const bool is_small =
        slot.mesh.is_shared() && !slot.left_out && slot.state.is_of(slot.mesh.tiles_version());
    seen.is_large = !is_small;
    if (!is_small) return;
    const Positions positions = slot.mesh.positions();
    const std::uint32_t count = slot.mesh.vertex_count();
    box = box_around(positions, count);
    seen.is_small = !is_empty(box);
    if (!seen.is_small) return; // the engine finds out what is wrong
    slot.body = MeshSlot::none; // unless it turns out to be one
    seen.vertices = count & 15;
    seen.tets = slot.mesh.tet_count() & 31;
    seen.rounded = positions.rounded();
    seen.moved = fast::take_in(slot.state.last_positions, positions, all_rounded || seen.rounded, count, box);
}

void LoneBodies::find(MeshTable& meshes, bool all_rounded, fast::PairBuffers& buffers, Workers& workers) {
    forget();
    const std::size_t count = meshes.slot_count();
    if (count < few_bodies) return;
    boxes_.resize(count);
    slots_.resize(count);
    workers.for_ranges(count, task_slots, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t s = begin; s < end; ++s) look_at(meshes.slot(s), s, all_rounded);
    });
    std::size_t small = 0, large_vertices = 0;
    for (std::size_t s = 0; s < count; ++s) {
        small += slots_[s].is_small;
        if (slots_[s].is_large) large_vertices += meshes.slot(s).mesh.vertex_count();
    }
    if (small < few_bodies || large_vertices > most_large_vertices * small) return;
    for (std::size_t s = 0; large_vertices > 0 && s < count; ++s)
        if (slots_[s].is_large)
            boxes_[s] = box_around(meshes.slot(s).mesh.positions(), meshes.slot(s).mesh.vertex_count());
    if (!fast::find_met_boxes(boxes_, buffers, met_)) return;
    for (std::size_t s = 0; s < count; ++s) {
        Slot& seen = slots_[s];
        seen.is_lone = seen.is_small && met_[s] == 0;
        if (!seen.is_lone) continue;
        ++totals_.bodies;
        totals_.vertices += seen.vertices;
        totals_.tets += seen.tets;
        totals_.moved += seen.moved;
        if (seen.rounded) vox::add(totals_.rounded, boxes_[s]);
    }
}

} // namespace vox
