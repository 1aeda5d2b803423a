// The collective step: the rounds, then the rule of contacts over all ranks.
#include "dist/hash.hpp"
#include "dist/rounds.hpp"

#include <algorithm>
#include <tuple>

using namespace vox;
using namespace vox::dist;

namespace vox::dist {
namespace {

auto key(const vox_dist_contact& c) noexcept { return std::tuple(c.body_a, c.vertex, c.body_b, c.tet); }
auto key_of_hit(const VertexHit& hit) noexcept { return key(hit.contact); }
bool same_pair(const vox_dist_contact& a, const vox_dist_contact& b) noexcept {
    return a.body_a == b.body_a && a.vertex == b.vertex && a.body_b == b.body_b;
}

// Calls keep(hit) for the hits that are contacts: those of a vertex in the interior of a tetrahedron of a
// body, or else the hit in the lowest one. Hits are sorted by key.
template <class Keep>
void apply_rule(std::span<const VertexHit> hits, Keep&& keep) {
    for (std::size_t begin = 0; begin < hits.size();) {
        std::size_t end = begin;
        bool interior = false;
        for (; end < hits.size() && same_pair(hits[begin].contact, hits[end].contact); ++end)
            interior |= hits[end].contact.interior != 0;
        for (std::size_t i = begin; i < end; ++i)
            if (interior ? hits[i].contact.interior != 0 : i == begin) keep(hits[i]);
        begin = end;
    }
}

// A byte for each hit of a neighbour: whether it is a contact. A neighbour without undecided hits needs no
// message.
class Verdicts {
public:
    explicit Verdicts(Memory* memory) : bytes_(memory), begins_(memory) {}

    void judge(const vox_dist_scene& scene, std::span<const VertexHit> hits) {
        for (std::uint32_t i = 0; i < scene.rank_count_; ++i) {
            begins_.push_back(bytes_.size());
            Reader reader(scene.in_[i]);
            bytes_.resize(bytes_.size() + (reader.more() ? reader.take<HitsHeader>().count : 0));
        }
        apply_rule(hits, [&](const VertexHit& hit) {
            if (hit.neighbour != no_neighbour) bytes_[begins_[hit.neighbour] + hit.hit] = 1;
        });
    }
    // A verdict on every hit of neighbour i, decided ones too, so that places are simple.
    vox_dist_message of(std::uint32_t i) const noexcept {
        const std::uint64_t end = i + 1 < begins_.size() ? begins_[i + 1] : bytes_.size();
        return {bytes_.data() + begins_[i], end - begins_[i]};
    }

private:
    Array<std::uint8_t> bytes_;
    Array<std::uint64_t> begins_;
};

// The number of hits in a message that need a verdict. Sender and receiver know it.
std::uint64_t undecided_hits(const vox_dist_message& message) noexcept {
    HitsHeader header{};
    if (message.size >= sizeof header) std::memcpy(&header, message.data, sizeof header);
    return header.undecided;
}

// Tells the ranks of the tetrahedra which undecided hits are contacts, after all ranks agreed that nothing
// failed. They have reserved memory for them in tet_contacts_, so only the transport can fail.
void exchange_verdicts(vox_dist_scene& scene, const Rounds& rounds, const Verdicts& verdicts) {
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
    auto hit = rounds.tet_hits.begin();
    while (hit != rounds.tet_hits.end()) {
        // The hits of one rank: with a verdict on each if any is undecided; otherwise all are contacts.
        const std::uint32_t rank = hit->contact.rank;
        const auto message_index = static_cast<std::size_t>(
            std::find(scene.ranks_.begin(), scene.ranks_.begin() + count, rank) - scene.ranks_.begin());
        const vox_dist_message message =
            message_index < count ? scene.in_[message_index] : vox_dist_message{nullptr, 0};
        const auto* verdict = static_cast<const std::uint8_t*>(message.data);
        for (std::uint64_t h = 0; hit != rounds.tet_hits.end() && hit->contact.rank == rank; ++hit, ++h)
            if (h >= message.size || verdict[h] != 0) scene.tet_contacts_.push_back(hit->contact);
    }
    std::ranges::sort(scene.tet_contacts_, {}, key);
}

} // namespace
} // namespace vox::dist

void vox_dist_scene::hash(std::uint64_t out[2]) {
    ContactSum sum;
    for (const vox_dist_contact& contact : contacts_) sum.add(contact);
    transport_.agree(nullptr, 0, sum.limbs, 4); // 32 bits each: the sum over all ranks does not overflow
    sum.write(out);
}

void vox_dist_scene::step() {
    contacts_.clear();
    tet_contacts_.clear();
    counters_ = {};
    transport_.messages = transport_.collectives = 0;
    Failure failure;
    Overview mine;
    failure.guard([&] {
        read_positions();
        for (const Part* part : parts_) {
            extend(mine.tets, part->tet_box);
            extend(mine.vertices, part->vertex_box);
        }
        if (parts_.size() == 1 && !parts_[0]->filter.self_collision) {
            mine.one_body = 1;
            mine.body = parts_[0]->body;
        }
    });
    exchange_overviews(mine, failure);

    Rounds rounds(*this, contact_grid_, false);
    Array<VertexSource> sources(&memory_);
    failure.guard([&] {
        for (const Part* part : parts_)
            if (part->vertex_clusters.size())
                sources.push_back({part, &part->vertex_clusters, part->positions, part->vertex_box});
    });
    rounds.run(sources, failure);

    Verdicts verdicts(&memory_);
    failure.guard([&] {
        std::ranges::sort(rounds.vertex_hits, {}, key_of_hit);
        verdicts.judge(*this, rounds.vertex_hits);
        apply_rule(rounds.vertex_hits, [&](const VertexHit& hit) {
            contacts_.push_back(hit.contact);
            if (hit.neighbour != no_neighbour) return;
            tet_contacts_.push_back(hit.contact);
            tet_contacts_.back().index = hit.hit;
        });
        tet_contacts_.reserve(tet_contacts_.size() + rounds.tet_hits.size());
    });
    try {
        failure.agree(transport_);
        exchange_verdicts(*this, rounds, verdicts);
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
