// Checks that owners, copies and numbers fit together: what has a number goes to the rank that a hash of the
// number chooses, which compares.
#include "base/llu.hpp"
#include "dist/scene.hpp"

#include <algorithm>
#include <tuple>

using namespace vox;
using namespace vox::dist;

namespace {

struct Numbered {
    std::uint64_t body, id;
    Vec3d position; // 0 for a tetrahedron
    std::uint32_t rank;
    std::uint32_t kind; // 0: a vertex's owner; 1: a copy; 2: a tetrahedron
};

void compare(const Numbered* begin, const Numbered* end) {
    const auto number = llu(begin->id);
    const auto body = llu(begin->body);
    const Numbered* const second = end - begin > 1 ? begin + 1 : nullptr;
    if (begin->kind == 2) {
        if (second)
            throw Error(VOX_ERROR_INVALID_STATE, format("tet %llu of body %llu is on ranks %u and %u", number,
                                                        body, begin->rank, second->rank));
        return;
    }
    if (begin->kind == 1)
        throw Error(VOX_ERROR_INVALID_STATE,
                    format("vertex %llu of body %llu has a copy on rank %u, but no rank owns it", number,
                           body, begin->rank));
    if (second && second->kind == 0)
        throw Error(VOX_ERROR_INVALID_STATE, format("vertex %llu of body %llu is owned by ranks %u and %u",
                                                    number, body, begin->rank, second->rank));
    const Vec3d& p = begin->position;
    for (const Numbered* copy = begin; ++copy != end;) {
        const Vec3d& q = copy->position;
        if (std::memcmp(&q, &p, sizeof q) != 0)
            throw Error(
                VOX_ERROR_INVALID_STATE,
                format("vertex %llu of body %llu is at %.17g %.17g %.17g on rank %u, which owns it, and at "
                       "%.17g %.17g %.17g on rank %u",
                       number, body, p.x, p.y, p.z, begin->rank, q.x, q.y, q.z, copy->rank));
    }
}

} // namespace

void vox_dist_scene::check_numbers() {
    Failure failure;
    Overview mine;
    mine.call = Call::check;
    failure.guard([&] { read_positions(); });
    exchange_overviews(mine, failure);
    const std::uint32_t size = transport_.size(), me = transport_.rank();
    Array<Writer> writers(&memory_);
    rank_count_ = 0;
    for (std::uint32_t rank = 0; rank < size; ++rank)
        if (rank != me) ranks_[rank_count_++] = rank;
    failure.guard([&] {
        for (std::uint32_t rank = 0; rank < size; ++rank) writers.emplace_back(&memory_);
        const auto send = [&](const Numbered& item) {
            const std::uint64_t mixed = (item.body * 0x9e3779b97f4a7c15u ^ item.id) * 0xbf58476d1ce4e5b9u;
            writers[(mixed >> 32) % size].add(item);
        };
        for (const Part* part : parts_) {
            for (std::uint32_t v = 0; v < part->vertex_count; ++v) {
                const std::uint32_t kind = part->owns(v) ? 0 : 1;
                send({part->body, part->id_of(v), part->positions.exact(v), me, kind});
            }
            for (std::uint32_t t = 0; t < part->tet_count; ++t)
                send({part->body, part->id_of_tet(t), {}, me, 2});
        }
        for (std::uint32_t i = 0; i < rank_count_; ++i) out_[i] = writers[ranks_[i]].bytes();
    });
    exchange(nullptr, failure);
    failure.guard([&] {
        Array<Numbered> items(&memory_);
        const auto take = [&](const vox_dist_message& bytes) {
            for (Reader reader(bytes); reader.more();) items.push_back(reader.take<Numbered>());
        };
        take(writers[me].bytes());
        for (std::uint32_t i = 0; i < rank_count_; ++i) take(in_[i]);
        const auto thing = [](const Numbered& n) { return std::tuple(n.kind == 2, n.body, n.id); };
        std::sort(items.begin(), items.end(), [&](const Numbered& a, const Numbered& b) {
            return std::tuple(thing(a), a.kind, a.rank) < std::tuple(thing(b), b.kind, b.rank);
        });
        for (auto begin = items.begin(); begin != items.end();) {
            const auto end = std::find_if(begin, items.end(),
                                          [&](const Numbered& n) { return thing(n) != thing(*begin); });
            compare(items.data() + (begin - items.begin()), items.data() + (end - items.begin()));
            begin = end;
        }
    });
    failure.agree(transport_);
}

std::uint64_t vox_dist_scene::costs(vox_dist_cost* costs, std::uint64_t capacity) const {
    double tets = 0;
    for (const Part* part : parts_) tets += part->tet_count;
    double seconds = 0; // a step of this rank
    if (tets > 0) {
        vox_cell_size_desc desc = vox_default_cell_size_desc();
        desc.model = VOX_COST_MODEL_FAST;
        vox_cell_size_result suggestion{};
        suggestion.struct_size = sizeof suggestion;
        check(vox_grid_suggest_cell_size(contact_grid_.grid.get(), &desc, &suggestion));
        seconds = suggestion.cost;
    }
    for (std::size_t i = 0; i < parts_.size() && i < capacity; ++i)
        costs[i] = {parts_[i]->body, tets > 0 ? seconds * parts_[i]->tet_count / tets : 0.0};
    return parts_.size();
}
