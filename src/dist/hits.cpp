// From the contacts of the grid to those of the vertices' owners.
#include "dist/rounds.hpp"

#include "exact/predicates.hpp"

#include <algorithm>
#include <tuple>

namespace vox::dist {

void Rounds::take_points_of_this_rank(std::span<const Source> sources) {
    const Box& tets = scene_.overviews_[scene_.transport_.rank()].tets;
    const auto group = static_cast<std::uint32_t>(groups_.size());
    groups_.push_back({0, {}, no_neighbour});
    for (const Source& source : sources)
        for (const std::uint32_t v : source.clusters->order) {
            double position[3];
            get(source.positions, v, position);
            if (!tets.holds(position)) continue;
            strangers_.push_back({v, group, v});
            xyz_.insert(xyz_.end(), position, position + 3);
        }
}

void Rounds::step_grid() {
    side_.set_points(xyz_);
    check(vox_grid_step(side_.grid.get()));
}

void Rounds::collect_here() {
    vox_contact_view contacts;
    check(vox_grid_get_contacts(side_.grid.get(), &contacts));
    for (std::uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact& hit = contacts.data[i];
        const bool inside = contacts.interiors[i] != 0;
        const Part& part = side_.part_of(hit.body_b);
        if (hit.body_a == side_.points)
            collect_stranger(part, hit, inside);
        else
            collect(part, hit, inside);
    }
    std::stable_sort(outgoing.begin(), outgoing.end(),
                     [](const Outgoing& a, const Outgoing& b) { return a.neighbour < b.neighbour; });
}

namespace {

// Without index and rank, which differ from side to side. The vertex is at p.
vox_dist_contact between(std::uint64_t body_a, std::uint64_t vertex, const Vec3d& p, const Part& part,
                         const vox_contact& hit, bool interior) {
    vox_dist_contact contact{};
    contact.body_a = body_a;
    contact.vertex = vertex;
    contact.body_b = part.body;
    contact.tet = part.id_of_tet(hit.tet);
    const auto corner = [&](std::size_t c) {
        return part.positions.exact(part.tets[4 * std::size_t{hit.tet} + c]);
    };
    std::ranges::copy(barycentric(p, corner(0), corner(1), corner(2), corner(3)), contact.weights);
    contact.interior = interior;
    return contact;
}

} // namespace

void Rounds::collect_stranger(const Part& part, const vox_contact& hit, bool interior) {
    const Stranger& stranger = strangers_[hit.vertex];
    const Group& group = groups_[stranger.group];
    if (!points_ && !collide(group.body, group.filter, part.body, part.filter)) return;
    const double* x = side_.xyz.data() + 3 * std::size_t{hit.vertex};
    vox_dist_contact contact = between(group.body, stranger.id, {x[0], x[1], x[2]}, part, hit, interior);
    if (group.neighbour == no_neighbour) {
        contact.index = stranger.place;
        contact.rank = scene_.transport_.rank();
        found.push_back({contact, no_neighbour, part.index_of_tet(hit.tet)});
        return;
    }
    contact.index = part.index_of_tet(hit.tet);
    contact.rank = scene_.ranks_[group.neighbour];
    outgoing.push_back({contact, group.neighbour, stranger.place, 0});
}

void Rounds::collect(const Part& part, const vox_contact& hit, bool interior) {
    const Part& part_a = side_.part_of(hit.body_a);
    if (!collide(part_a.body, part_a.filter, part.body, part.filter)) return;
    vox_dist_contact contact = between(part_a.body, part_a.id_of(hit.vertex),
                                       part_a.positions.exact(hit.vertex), part, hit, interior);
    if (part_a.owns(hit.vertex)) {
        contact.index = hit.vertex;
        contact.rank = scene_.transport_.rank();
        found.push_back({contact, no_neighbour, part.index_of_tet(hit.tet)});
        return;
    }
    const auto owner =
        std::lower_bound(known_.begin(), known_.end(), std::tuple(part_a.body, hit.vertex),
                         [](const Known& k, const std::tuple<std::uint64_t, std::uint32_t>& key) {
                             return std::tuple(k.part->body, k.vertex) < key;
                         });
    if (owner == known_.end() || owner->part != &part_a || owner->vertex != hit.vertex)
        throw Error(
            VOX_ERROR_INVALID_STATE,
            format("rank %u has a copy of vertex %llu of body %llu, which is in a tetrahedron there, but no "
                   "rank owns such a vertex at that position",
                   scene_.transport_.rank(), static_cast<unsigned long long>(contact.vertex),
                   static_cast<unsigned long long>(part_a.body)));
    contact.index = part.index_of_tet(hit.tet);
    contact.rank = scene_.ranks_[owner->neighbour];
    outgoing.push_back({contact, owner->neighbour, owner->place, 0});
}

void Rounds::write_hits() {
    auto hit = outgoing.begin();
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        writers_[i].clear();
        if (hit != outgoing.end() && hit->neighbour == i) {
            Hits header{};
            const std::size_t at = writers_[i].add(header);
            const auto split = told_split_.begin() + static_cast<std::ptrdiff_t>(told_split_begin_[i]);
            const auto split_end =
                told_split_.begin() + static_cast<std::ptrdiff_t>(told_split_begin_[i + 1]);
            for (; hit != outgoing.end() && hit->neighbour == i; ++hit) {
                const vox_dist_contact& c = hit->contact;
                Hit message{c.tet, hit->place, 0, {}};
                std::copy_n(c.weights, 4, message.weights);
                const auto part =
                    std::lower_bound(scene_.parts_.begin(), scene_.parts_.end(), c.body_b,
                                     [](const Part* p, std::uint64_t b) { return p->body < b; });
                const auto number = static_cast<std::uint32_t>(part - scene_.parts_.begin());
                message.part = number | (c.interior ? interior_bit : 0);
                writers_[i].add(message);
                ++header.count;
                header.undecided += !c.interior && std::binary_search(split, split_end, number);
            }
            writers_[i].set(at, header);
            scene_.counters_.hits_sent += header.count;
        }
        scene_.out_[i] = writers_[i].bytes();
    }
}

void Rounds::read_hits(std::span<const Source> sources) {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        Reader reader(scene_.in_[i]);
        if (!reader.more()) continue;
        const auto header = reader.take<Hits>();
        const std::span<const Remote> parts(remote_.data() + remote_begin_[i],
                                            remote_.data() + remote_begin_[i + 1]);
        for (std::uint32_t h = 0; h < header.count; ++h) {
            const auto hit = reader.take<Hit>();
            const std::uint32_t number = hit.part & ~interior_bit;
            const auto part = std::lower_bound(parts.begin(), parts.end(), number,
                                               [](const Remote& p, std::uint32_t n) { return p.part < n; });
            if (part == parts.end() || part->part != number ||
                hit.vertex >= sent_begin_[i + 1] - sent_begin_[i])
                throw Error(VOX_ERROR_INTERNAL, "another rank hit what it was not sent");
            const Sent& sent = sent_[sent_begin_[i] + hit.vertex];
            const Source& source = sources[sent.source];
            vox_dist_contact contact{};
            contact.body_a = source.part ? source.part->body : 0;
            contact.vertex = source.part ? source.part->id_of(sent.vertex) : sent.vertex;
            contact.body_b = part->body;
            contact.tet = hit.tet;
            std::copy_n(hit.weights, 4, contact.weights);
            contact.index = sent.vertex;
            contact.rank = scene_.ranks_[i];
            contact.interior = (hit.part & interior_bit) != 0;
            found.push_back({contact, i, h});
        }
    }
}

} // namespace vox::dist
