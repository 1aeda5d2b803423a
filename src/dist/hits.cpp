// Turns contacts of the grid into hits for the owners of the vertices.
#include "base/llu.hpp"
#include "dist/rounds.hpp"

#include "exact/accurate.hpp"

#include <algorithm>
#include <utility>

namespace vox::dist {

void Rounds::take_points_of_this_rank(std::span<const VertexSource> sources) {
    const Box3f& tets = scene_.overviews_[scene_.transport_.rank()].tets;
    const auto group = static_cast<std::uint32_t>(foreign_groups_.size());
    foreign_groups_.push_back({0, {}, no_neighbour});
    for (const VertexSource& source : sources)
        for (const std::uint32_t v : source.clusters->order) {
            const Vec3d p = source.positions.exact(v);
            if (!contains(tets, p)) continue;
            foreign_vertices_.push_back({v, group, v});
            foreign_positions_.push_back(p);
        }
}

void Rounds::step_grid() {
    grid_.set_points(foreign_positions_);
    check(vox_grid_step(grid_.grid.get()));
}

void Rounds::collect_here() {
    vox_contact_view contacts;
    check(vox_grid_get_contacts(grid_.grid.get(), &contacts));
    for (std::uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact& hit = contacts.data[i];
        const bool inside = contacts.interiors[i] != 0;
        const Part& part = grid_.part_of(hit.body_b);
        if (hit.body_a == grid_.points)
            collect_foreign(part, hit, inside);
        else
            collect(part, hit, inside);
    }
    std::ranges::stable_sort(tet_hits, {}, &TetHit::neighbour);
}

namespace {

// A contact without index and rank. The vertex is at p.
vox_dist_contact between(std::uint64_t body_a, std::uint64_t vertex, const Vec3d& p, const Part& part,
                         const vox_contact& hit, bool interior) {
    vox_dist_contact contact{};
    contact.body_a = body_a;
    contact.vertex = vertex;
    contact.body_b = part.body;
    contact.tet = part.id_of_tet(hit.tet);
    PointBlock block;
    AccurateWeights weights;
    set(block.point, 0, p);
    for (std::size_t c = 0; c < 4; ++c) set(block.corner[c], 0, part.corner(hit.tet, c));
    fill_last_register(block, 1);
    weigh_accurately(block, 1, true, weights);
    for (std::size_t c = 0; c < 4; ++c) contact.weights[c] = weights.weight[c][0];
    contact.interior = interior;
    return contact;
}

} // namespace

void Rounds::collect_foreign(const Part& part, const vox_contact& hit, bool interior) {
    const ForeignVertex& foreign = foreign_vertices_[hit.vertex];
    const ForeignGroup& group = foreign_groups_[foreign.group];
    if (!points_ && !collide(group.body, group.filter, part.body, part.filter)) return;
    vox_dist_contact contact =
        between(group.body, foreign.id, grid_.positions[hit.vertex], part, hit, interior);
    if (group.neighbour == no_neighbour) {
        contact.index = foreign.place;
        contact.rank = scene_.transport_.rank();
        vertex_hits.push_back({contact, no_neighbour, part.index_of_tet(hit.tet)});
        return;
    }
    contact.index = part.index_of_tet(hit.tet);
    contact.rank = scene_.ranks_[group.neighbour];
    tet_hits.push_back({contact, group.neighbour, foreign.place});
}

void Rounds::collect(const Part& part, const vox_contact& hit, bool interior) {
    const Part& part_a = grid_.part_of(hit.body_a);
    if (!collide(part_a.body, part_a.filter, part.body, part.filter)) return;
    vox_dist_contact contact = between(part_a.body, part_a.id_of(hit.vertex),
                                       part_a.positions.exact(hit.vertex), part, hit, interior);
    if (part_a.owns(hit.vertex)) {
        contact.index = hit.vertex;
        contact.rank = scene_.transport_.rank();
        vertex_hits.push_back({contact, no_neighbour, part.index_of_tet(hit.tet)});
        return;
    }
    const std::pair key(part_a.body, hit.vertex);
    const auto owner = std::ranges::lower_bound(copied_vertices_, key, {}, &CopiedVertex::key);
    if (owner == copied_vertices_.end() || owner->part != &part_a || owner->vertex != hit.vertex)
        throw Error(
            VOX_ERROR_INVALID_STATE,
            format("rank %u has a copy of vertex %llu of body %llu, which is in a tetrahedron there, but no "
                   "rank owns such a vertex at that position",
                   scene_.transport_.rank(), llu(contact.vertex), llu(part_a.body)));
    contact.index = part.index_of_tet(hit.tet);
    contact.rank = scene_.ranks_[owner->neighbour];
    tet_hits.push_back({contact, owner->neighbour, owner->place});
}

void Rounds::write_hits() {
    auto hit = tet_hits.begin();
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        writers_[i].clear();
        if (hit != tet_hits.end() && hit->neighbour == i) {
            HitsHeader header{};
            const std::size_t at = writers_[i].add(header);
            const std::uint32_t* const reported = reported_parts_.data();
            for (; hit != tet_hits.end() && hit->neighbour == i; ++hit) {
                const vox_dist_contact& c = hit->contact;
                SentHit message{c.tet, hit->place, 0, {}};
                std::copy_n(c.weights, 4, message.weights);
                const auto part = std::ranges::lower_bound(scene_.parts_, c.body_b, {}, &Part::body);
                const auto number = static_cast<std::uint32_t>(part - scene_.parts_.begin());
                message.part = number | (c.interior ? interior_bit : 0);
                writers_[i].add(message);
                ++header.count;
                header.undecided +=
                    !c.interior && std::binary_search(reported + reported_begins_[i],
                                                      reported + reported_begins_[i + 1], number);
            }
            writers_[i].set(at, header);
            scene_.counters_.hits_sent += header.count;
        }
        scene_.out_[i] = writers_[i].bytes();
    }
}

void Rounds::read_hits(std::span<const VertexSource> sources) {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        Reader reader(scene_.in_[i]);
        if (!reader.more()) continue;
        const auto header = reader.take<HitsHeader>();
        const std::span<const RemotePart> parts(remote_parts_.data() + remote_begins_[i],
                                                remote_parts_.data() + remote_begins_[i + 1]);
        for (std::uint32_t h = 0; h < header.count; ++h) {
            const auto hit = reader.take<SentHit>();
            const std::uint32_t number = hit.part & ~interior_bit;
            const auto part = std::ranges::lower_bound(parts, number, {}, &RemotePart::part);
            if (part == parts.end() || part->part != number ||
                hit.vertex >= sent_begins_[i + 1] - sent_begins_[i])
                throw Error(VOX_ERROR_INTERNAL, "another rank hit what it was not sent");
            const Sent& sent = sent_[sent_begins_[i] + hit.vertex];
            const VertexSource& source = sources[sent.source];
            vox_dist_contact contact{};
            contact.body_a = source.part ? source.part->body : 0;
            contact.vertex = source.part ? source.part->id_of(sent.vertex) : sent.vertex;
            contact.body_b = part->body;
            contact.tet = hit.tet;
            std::copy_n(hit.weights, 4, contact.weights);
            contact.index = sent.vertex;
            contact.rank = scene_.ranks_[i];
            contact.interior = (hit.part & interior_bit) != 0;
            vertex_hits.push_back({contact, i, h});
        }
    }
}

} // namespace vox::dist
