#include "dist/scene.hpp"

#include "base/llu.hpp"
#include "base/room.hpp"
#include "base/structs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

using namespace vox;
using namespace vox::dist;

namespace vox::dist {

vox_filter unfiltered() noexcept {
    vox_filter filter{};
    filter.category = UINT64_MAX;
    return filter;
}

const Part& SearchGrid::part_of(vox_body mesh) const noexcept {
    return *std::ranges::lower_bound(inserted, mesh, {}, &InsertedPart::mesh)->part;
}

void SearchGrid::insert(vox_body mesh, Part* part) {
    inserted.insert(std::ranges::upper_bound(inserted, mesh, {}, &InsertedPart::mesh),
                    InsertedPart{mesh, part});
}

void SearchGrid::set_points(Array<Vec3d>& new_positions) {
    const std::uint64_t count = new_positions.size();
    if (points == VOX_NULL_BODY && count == 0) return;
    vox_mesh_desc desc =
        vox_mesh_desc_doubles(reinterpret_cast<const double*>(new_positions.data()), count, nullptr, 0);
    desc.filter = unfiltered();
    if (points == VOX_NULL_BODY)
        check(vox_mesh_insert(grid.get(), &desc, &points));
    else
        check(vox_mesh_set_topology(grid.get(), points, &desc));
    positions.swap(new_positions);
    check(vox_body_set_enabled(grid.get(), points, count != 0));
}

namespace {

Filter read_filter(const vox_filter& filter) {
    if (filter.self_rings != 0 || filter.self_rest_distance != 0)
        throw Error(VOX_ERROR_UNSUPPORTED,
                    "self_rings and self_rest_distance are not supported for parts of bodies");
    return {{.category = filter.category != 0 ? filter.category : 1,
             .mask = filter.mask != 0 ? filter.mask : UINT64_MAX,
             .group = filter.group,
             .world = filter.world},
            filter.flags & VOX_FILTER_SELF_COLLISION ? 1u : 0u};
}

} // namespace
} // namespace vox::dist

vox_dist_scene::OwnDesc::OwnDesc(const vox_grid_desc& desc)
    : desc_(desc), allocator_(value_of(desc.allocator)), log_(value_of(desc.log)),
      tasks_(value_of(desc.tasks)) {
    desc_.allocator = &allocator_;
    desc_.log = &log_;
    desc_.tasks = &tasks_;
    if (!desc.reference) return;
    reference_ = read_struct(desc.reference, "grid->reference");
    desc_.reference = &reference_;
    if (!reference_.weights) return;
    weights_ = read_struct(reference_.weights, "grid->reference->weights");
    reference_.weights = &weights_;
}

vox_dist_scene::vox_dist_scene(const vox_grid_desc& grid, const vox_dist_transport& transport)
    : grid_desc_(grid), memory_(grid.allocator), transport_(transport), parts_(&memory_),
      contact_grid_(&memory_), point_grid_(&memory_), contacts_(&memory_), tet_contacts_(&memory_),
      overviews_(&memory_), ranks_(&memory_), out_(&memory_), in_(&memory_), has_contacts_(&memory_) {
    overviews_.resize(transport.size);
    ranks_.resize(transport.size);
    out_.resize(transport.size);
    in_.resize(transport.size);
    has_contacts_.resize(transport.size);
    contact_grid_.grid = create_grid(*grid_desc_);
}

vox_dist_scene::~vox_dist_scene() {
    std::pmr::polymorphic_allocator<> allocator(&memory_);
    for (Part* part : parts_) allocator.delete_object(part);
}

Part* vox_dist_scene::find_body(std::uint64_t body) const noexcept {
    const auto place = std::ranges::lower_bound(parts_, body, {}, &Part::body);
    return place != parts_.end() && (*place)->body == body ? *place : nullptr;
}

void vox_dist_scene::insert(const vox_dist_part_desc& desc) {
    vox_mesh_desc mesh = read_struct(desc.mesh, "desc.mesh");
    if (find_body(desc.body)) refuse(format("body %llu has a part on this rank already", llu(desc.body)));
    const Filter filter = read_filter(mesh.filter);

    std::pmr::polymorphic_allocator<> allocator(&memory_);
    const auto remove = [&](Part* part) { allocator.delete_object(part); };
    std::unique_ptr<Part, decltype(remove)> part(allocator.new_object<Part>(&memory_), remove);
    part->take(desc, mesh);
    part->body = desc.body;
    part->filter = filter;
    reserve_growing(parts_, parts_.size() + 1);
    reserve_growing(contact_grid_.inserted, contact_grid_.inserted.size() + 1);

    // The grid may find more than the filters allow; Rounds drops the rest. Received vertices have no world.
    mesh.filter.world = 0;
    mesh.tets = part->tets.data();
    mesh.flags |= VOX_MESH_BORROW_TETS;
    mesh.user_data = desc.body;
    check(vox_mesh_insert(contact_grid_.grid.get(), &mesh, &part->mesh));

    contact_grid_.insert(part->mesh, part.get());
    parts_.insert(std::ranges::upper_bound(parts_, desc.body, {}, &Part::body), part.release());
}

Part& vox_dist_scene::part_of(std::uint64_t body) const {
    Part* const part = find_body(body);
    if (!part)
        throw Error(VOX_ERROR_INVALID_HANDLE,
                    format("there is no part of body %llu on this rank", llu(body)));
    return *part;
}

void vox_dist_scene::remove(std::uint64_t body) {
    Part* const part = &part_of(body);
    check(vox_body_remove(contact_grid_.grid.get(), part->mesh));
    for (SearchGrid* grid : {&contact_grid_, &point_grid_}) {
        const auto gone = std::ranges::find(grid->inserted, part, &InsertedPart::part);
        if (gone == grid->inserted.end()) continue;
        if (grid == &point_grid_) (void)vox_body_remove(grid->grid.get(), gone->mesh);
        grid->inserted.erase(gone);
    }
    parts_.erase(std::ranges::find(parts_, part));
    std::pmr::polymorphic_allocator<>(&memory_).delete_object(part);
}

void vox_dist_scene::bind(std::uint64_t body, const vox_positions& positions) {
    check(vox_mesh_bind_positions(contact_grid_.grid.get(), part_of(body).mesh, &positions));
}

vox_counter_view vox_dist_scene::counters() const noexcept {
    std::ranges::transform(traffic_names, counter_list_, [this](const TrafficName& c) {
        return vox_counter{c.name, counters_.*c.field};
    });
    return {counter_list_, std::size(counter_list_)};
}

void vox_dist_scene::read_positions() {
    for (Part* part : parts_) {
        vox_body_info info{};
        info.struct_size = sizeof info;
        check(vox_body_get_info(contact_grid_.grid.get(), part->mesh, &info));
        if (!info.positions.data && part->vertex_count != 0)
            throw Error(VOX_ERROR_INVALID_STATE,
                        format("the part of body %llu has no positions", llu(part->body)));
        part->positions = check_positions(info.positions, "positions");
        part->read_positions(&memory_);
    }
}

void vox_dist_scene::exchange_overviews(Overview mine, const Failure& failure) {
    mine.result = failure.result();
    transport_.allgather(&mine, sizeof mine, overviews_.data());
    counters_.replicated_bytes += sizeof mine;
    for (std::uint32_t rank = 0; rank < transport_.size(); ++rank)
        failure.throw_agreed(Failure::as_minimum(overviews_[rank].result, rank), transport_.rank());
    for (std::uint32_t rank = 1; rank < transport_.size(); ++rank)
        if (overviews_[rank].call != overviews_[0].call)
            throw Error(VOX_ERROR_INVALID_STATE, format("ranks 0 and %u call different functions", rank));
    choose_ranks([](const Overview& a, const Overview& b) {
        return a.collides_with(b) && (overlap(a.tets, b.vertices) || overlap(b.tets, a.vertices));
    });
}

void vox_dist_scene::exchange(std::uint64_t* sent_bytes, Failure& failure) {
    static constexpr std::byte failed{1}; // no other message has 1 byte
    if (failure)
        for (std::uint32_t i = 0; i < rank_count_; ++i) out_[i] = {&failed, 1};
    if (sent_bytes)
        for (std::uint32_t i = 0; i < rank_count_; ++i) *sent_bytes += out_[i].size;
    Failure mine;
    mine.guard([&] { transport_.exchange(ranks_.data(), rank_count_, out_.data(), in_.data()); });
    failure.take(mine);
    if (!mine)
        for (std::uint32_t i = 0; i < rank_count_; ++i)
            if (in_[i].size == 1) failure.follow();
    if (failure)
        for (std::uint32_t i = 0; i < rank_count_; ++i) in_[i] = {nullptr, 0};
}
