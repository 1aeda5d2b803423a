// The collective step: the rounds, then the rule of contacts over all ranks.
#include "dist/rounds.hpp"

#include <algorithm>
#include <tuple>

using namespace vox;
using namespace vox::dist;

namespace vox::dist {
namespace {

auto key(const vox_dist_contact& c) noexcept { return std::tuple(c.body_a, c.vertex, c.body_b, c.tet); }
bool before(const vox_dist_contact& a, const vox_dist_contact& b) noexcept { return key(a) < key(b); }
bool same_pair(const vox_dist_contact& a, const vox_dist_contact& b) noexcept {
    return a.body_a == b.body_a && a.vertex == b.vertex && a.body_b == b.body_b;
}

// Of the hits of a vertex in a body all in the interior of a tetrahedron, or else the one in the lowest.
template <class Keep>
void apply_rule(std::span<const Found> found, Keep&& keep) {
    for (std::size_t begin = 0; begin < found.size();) {
        std::size_t end = begin;
        bool interior = false;
        for (; end < found.size() && same_pair(found[begin].contact, found[end].contact); ++end)
            interior |= found[end].contact.interior != 0;
        for (std::size_t i = begin; i < end; ++i)
            if (interior ? found[i].contact.interior != 0 : i == begin) keep(found[i]);
        begin = end;
    }
}

// One byte for each hit of a neighbour: whether it is a contact. Neighbours that know all of theirs need no
// message.
class Verdicts {
public:
    explicit Verdicts(Memory* memory) : bytes_(memory), begins_(memory) {}

    void judge(const vox_dist_scene& scene, std::span<const Found> found) {
        for (std::uint32_t i = 0; i < scene.rank_count_; ++i) {
            begins_.push_back(bytes_.size());
            Reader reader(scene.in_[i]);
            bytes_.resize(bytes_.size() + (reader.more() ? reader.take<Hits>().count : 0));
        }
        apply_rule(found, [&](const Found& f) {
            if (f.neighbour != no_neighbour) bytes_[begins_[f.neighbour] + f.hit] = 1;
        });
    }
    // Of all hits of neighbour i, those that it knows of too, so that places are simple.
    vox_dist_message of(std::uint32_t i) const noexcept {
        const std::uint64_t end = i + 1 < begins_.size() ? begins_[i + 1] : bytes_.size();
        return {bytes_.data() + begins_[i], end - begins_[i]};
    }

private:
    Array<std::uint8_t> bytes_;
    Array<std::uint64_t> begins_;
};

// How many of the hits in a message need a verdict; both sides of the message know.
std::uint64_t undecided_hits(const vox_dist_message& message) noexcept {
    Hits header{};
    if (message.size >= sizeof header) std::memcpy(&header, message.data, sizeof header);
    return header.undecided;
}

// After all ranks agreed that nothing failed: the other side of undecided hits learns which of them are
// contacts, and has them in tet_contacts_, for which it has the memory. Here only the transport can fail.
void tell_verdicts(vox_dist_scene& scene, const Rounds& rounds, const Verdicts& verdicts) {
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < scene.rank_count_; ++i) {
        const std::uint64_t received = undecided_hits(scene.in_[i]);
        if (undecided_hits(scene.out_[i]) == 0 && received == 0) continue;
        scene.ranks_[count] = scene.ranks_[i];
        scene.out_[count++] = received == 0 ? vox_dist_message{nullptr, 0} : verdicts.of(i);
    }
    scene.rank_count_ = count;
    for (std::uint32_t i = 0; i < count; ++i) scene.counters_.hit_bytes += scene.out_[i].size;
    scene.transport_.exchange(scene.ranks_.data(), count, scene.out_.data(), scene.in_.data());
    auto hit = rounds.outgoing.begin();
    while (hit != rounds.outgoing.end()) {
        // Of one rank, with a verdict of each if one of them is undecided; otherwise all are contacts.
        const std::uint32_t rank = hit->contact.rank;
        const auto told = static_cast<std::size_t>(
            std::find(scene.ranks_.begin(), scene.ranks_.begin() + count, rank) - scene.ranks_.begin());
        const vox_dist_message message = told < count ? scene.in_[told] : vox_dist_message{nullptr, 0};
        const auto* verdict = static_cast<const std::uint8_t*>(message.data);
        for (std::uint64_t h = 0; hit != rounds.outgoing.end() && hit->contact.rank == rank; ++hit, ++h)
            if (h >= message.size || verdict[h] != 0) scene.tet_contacts_.push_back(hit->contact);
    }
    std::sort(scene.tet_contacts_.begin(), scene.tet_contacts_.end(), before);
}

} // namespace
} // namespace vox::dist

void vox_dist_scene::step() {
    contacts_.clear();
    tet_contacts_.clear();
    counters_ = {};
    transport_.messages = transport_.collectives = 0;
    Failure failure;
    Overview mine;
    failure.guard([&] {
        look();
        for (const Part* part : parts_) {
            mine.tets.add(part->tet_box);
            mine.vertices.add(part->vertex_box);
        }
        if (parts_.size() == 1 && !parts_[0]->filter.self_collision) {
            mine.one_body = 1;
            mine.body = parts_[0]->body;
        }
    });
    meet(mine, failure);

    Rounds rounds(*this, contacts_side_, false);
    Array<Source> sources(&memory_);
    failure.guard([&] {
        for (const Part* part : parts_)
            if (part->vertex_clusters.size())
                sources.push_back({part, &part->vertex_clusters, part->positions, part->vertex_box});
    });
    rounds.run(sources, failure);

    Verdicts verdicts(&memory_);
    failure.guard([&] {
        std::sort(rounds.found.begin(), rounds.found.end(),
                  [](const Found& a, const Found& b) { return before(a.contact, b.contact); });
        verdicts.judge(*this, rounds.found);
        apply_rule(rounds.found, [&](const Found& f) {
            contacts_.push_back(f.contact);
            if (f.neighbour != no_neighbour) return;
            tet_contacts_.push_back(f.contact);
            tet_contacts_.back().index = f.hit;
        });
    });

    failure.guard([&] { tet_contacts_.reserve(tet_contacts_.size() + rounds.outgoing.size()); });
    try {
        failure.agree(transport_);
        tell_verdicts(*this, rounds, verdicts);
    } catch (...) {
        contacts_.clear();
        tet_contacts_.clear();
        throw;
    }
    counters_.messages = transport_.messages;
    counters_.collectives = transport_.collectives;
    counters_.contacts = contacts_.size();
    counters_.incoming = tet_contacts_.size();
}
