#include "gpu/pipeline.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <bit>

namespace vox::gpu {

Pipeline::Pipeline(std::unique_ptr<Backend> backend, const SceneData& data, const StepRooms& rooms,
                   u64 byte_budget)
    : backend_(std::move(backend)), byte_budget_(byte_budget), bodies_(data.bodies) {
    try {
        SceneArrays& s = arrays_;
        s.vertex_count = data.vertex_count;
        s.tile_count = static_cast<u32>(data.tiles.size());
        s.body_count = static_cast<u32>(data.bodies.size());
        s.scene_count = static_cast<u32>(data.first_body.size() - 1);
        s.any_filter = data.any_filter;
        s.bodies = copy(data.bodies);
        s.cells = copy(data.cells);
        s.first_body = copy(data.first_body);
        s.vertex_body = copy(data.vertex_body);
        s.tiles = copy(data.tiles);
        s.tile_vertices = copy(data.tile_vertices);
        s.tile_tets = copy(data.tile_tets);
        s.corners = copy(data.corners);
        s.tets = copy(data.tets);
        // Half more cells than vertices: a slot that nobody needs is cleared and summed.
        const u64 vertices = s.vertex_count, bricks = std::bit_ceil((vertices + vertices / 2) / 64 + 1);
        make_work(rooms.bricks ? rooms.bricks : bricks);
        make_lists({rooms.points ? rooms.points : vertices, rooms.findings ? rooms.findings : vertices,
                    rooms.contacts ? rooms.contacts : vertices / 2 + 1, 0});
        backend_->prepare(s);
    } catch (...) {
        for (const Block& block : blocks_) backend_->release(block.memory);
        throw;
    }
}

Pipeline::~Pipeline() {
    for (const Block& block : blocks_) backend_->release(block.memory);
}

void* Pipeline::allocate(u64 bytes, bool work) {
    if (bytes > byte_budget_ || bytes_ > byte_budget_ - bytes)
        throw Error(
            VOX_ERROR_BUDGET,
            format("the arrays of the scenes need more than the budget of %llu bytes: %llu more than %llu",
                   static_cast<unsigned long long>(byte_budget_), static_cast<unsigned long long>(bytes),
                   static_cast<unsigned long long>(bytes_)));
    blocks_.reserve(blocks_.size() + 1);
    void* memory = backend_->allocate(std::max<u64>(bytes, 16), work);
    blocks_.push_back({memory, bytes});
    bytes_ += bytes;
    return memory;
}

void Pipeline::release(void* memory) noexcept {
    const auto at =
        std::find_if(blocks_.begin(), blocks_.end(), [=](const Block& b) { return b.memory == memory; });
    if (at == blocks_.end()) return;
    bytes_ -= at->bytes;
    backend_->release(memory);
    blocks_.erase(at);
}

template <class T>
const T* Pipeline::copy(const std::vector<T>& from) {
    T* to = static_cast<T*>(allocate(from.size() * sizeof(T), false));
    backend_->write(to, from.data(), from.size() * sizeof(T));
    return to;
}

// In place of what there is.
template <class T>
void Pipeline::make(T*& array, u64 count) {
    T* made = static_cast<T*>(allocate(count * sizeof(T), true));
    release(array);
    array = made;
}

void Pipeline::make_work(u64 bricks) {
    SceneArrays& s = arrays_;
    const u64 vertices = s.vertex_count;
    s.brick_mask = static_cast<u32>(bricks - 1);
    make(s.boxes, s.tile_count);
    for (u32** slots : {&s.cell_lowest, &s.cell_highest, &s.cell_count, &s.cell_begin})
        make(*slots, bricks * 64 + 1);
    for (u32** of_vertices : {&s.vertex_flag, &s.vertex_risk, &s.risk_vertex, &s.risk_body, &s.hits_of,
                              &s.hits_begin, &s.kept_of, &s.kept_begin})
        make(*of_vertices, vertices + 1);
    make(s.contact_begin, u64{s.scene_count} + 1);
    make(s.status, 1);
}

void Pipeline::make_lists(const StepRooms& rooms) {
    SceneArrays& s = arrays_;
    const auto grow = [](u32& room, u64 wanted) {
        if (wanted <= room) return false;
        room = static_cast<u32>(std::min<u64>(wanted, 0xffffffff));
        return true;
    };
    if (grow(s.point_room, rooms.points)) make(s.points, s.point_room);
    if (grow(s.finding_room, rooms.findings)) {
        make(s.findings, s.finding_room);
        make(s.finding_place, s.finding_room);
        make(s.hits, s.finding_room);
    }
    if (grow(s.contact_room, rooms.contacts)) {
        make(s.contacts, s.contact_room);
        make(s.weights, s.contact_room);
        make(s.interiors, s.contact_room);
    }
}

void Pipeline::bind(const void* positions, u64 byte_stride) {
    arrays_.gathers = byte_stride != 3 * sizeof(float);
    if (arrays_.gathers && !arrays_.gathered) make(arrays_.gathered, 3 * u64{arrays_.vertex_count});
    arrays_.source = static_cast<const char*>(positions);
    arrays_.byte_stride = byte_stride;
    arrays_.positions = arrays_.gathers ? arrays_.gathered : static_cast<const float*>(positions);
}

void Pipeline::step(void* stream) {
    if (!arrays_.positions && arrays_.vertex_count)
        throw Error(VOX_ERROR_INVALID_STATE, "the scenes have no positions on the device");
    backend_->step(arrays_, stream);
}

StepStatus Pipeline::finish() {
    backend_->wait();
    StepStatus status;
    backend_->read(&status, arrays_.status, sizeof status);
    // With an eighth more. What lacked room hid what comes after it.
    const auto more = [](u32 needed) { return u64{needed} + needed / 8; };
    if (status.faults & (too_many_points | too_many_findings | too_many_contacts)) {
        make_lists({status.faults & too_many_points ? more(status.needed_points) : 0,
                    status.faults & too_many_findings ? more(status.needed_findings) : 0,
                    status.faults & too_many_contacts ? more(status.needed_contacts) : 0, 0});
        backend_->prepare(arrays_);
    }
    return status;
}

} // namespace vox::gpu
