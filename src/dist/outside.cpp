#include "dist/outside.hpp"

#include "exact/accurate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vox::dist {
namespace {

// A facet of one tetrahedron only on the rank that sends it.
struct SentFacet {
    std::uint64_t body, vertex[3], opposite;
};

// A point, and the squared distance beyond which no facet is of interest.
struct SentPoint {
    Vec3d p;
    double most;
};

// No point of a box is further away from any point of the other, squared.
double farthest_squared(const Box3f& a, const Box3f& b) noexcept {
    constexpr double slack = 1 + 0x1p-48;
    const auto side = [](double a_min, double a_max, double b_min, double b_max) {
        return std::max(std::abs(a_max - b_min), std::abs(b_max - a_min));
    };
    const double x = side(a.min.x, a.max.x, b.min.x, b.max.x), y = side(a.min.y, a.max.y, b.min.y, b.max.y),
                 z = side(a.min.z, a.max.z, b.min.z, b.max.z);
    return (x * x + y * y + z * z) * slack;
}

double closest_squared(const Box3f& a, const Box3f& b) noexcept {
    const Vec3d gap{std::max({double{a.min.x} - b.max.x, double{b.min.x} - a.max.x, 0.0}),
                    std::max({double{a.min.y} - b.max.y, double{b.min.y} - a.max.y, 0.0}),
                    std::max({double{a.min.z} - b.max.z, double{b.min.z} - a.max.z, 0.0})};
    return squared_distance_bound(gap, Box3f{});
}

} // namespace

Outside::Outside(vox_dist_scene& scene)
    : scene_(scene), memory_(&scene.memory_), writers_(memory_), facets_(memory_), boxes_(memory_),
      tree_(memory_), sent_(memory_), sent_begins_(memory_), asked_(memory_), nearest_(memory_),
      where_(memory_) {}

void Outside::run(const Positions& points, std::span<vox_dist_location> locations) {
    Failure failure;
    const auto round = [&](auto&& write, std::uint64_t& bytes) {
        failure.guard([&] {
            while (writers_.size() < scene_.rank_count_) writers_.emplace_back(memory_);
            for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) writers_[i].clear();
            write();
            for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) scene_.out_[i] = writers_[i].bytes();
        });
        scene_.exchange(&bytes, failure);
    };
    scene_.choose_ranks([](const Overview& a, const Overview& b) { return overlap(a.tets, b.tets); });
    round([&] { send_facets(); }, scene_.counters_.box_bytes);
    round([&] { find_sent_facets(); }, scene_.counters_.box_bytes);
    Overview mine;
    mine.call = Call::locate;
    failure.guard([&] {
        build_tree(mine);
        for (std::uint32_t i = 0; i < locations.size(); ++i)
            if (locations[i].state == VOX_LOCATION_NONE) {
                asked_.push_back(i);
                extend(mine.vertices, rounded_box(points.exact(i)));
            }
    });
    scene_.exchange_overviews(mine, failure);

    // Nothing is further away than the far side of any surface's box.
    const auto may_be_closest = [&](const Overview& asks, const Overview& answers) {
        if (is_empty(asks.vertices) || is_empty(answers.tets)) return false;
        const double least = closest_squared(asks.vertices, answers.tets);
        return std::ranges::all_of(scene_.overviews_, [&](const Overview& other) {
            return is_empty(other.tets) || least <= farthest_squared(asks.vertices, other.tets);
        });
    };
    scene_.choose_ranks(
        [&](const Overview& a, const Overview& b) { return may_be_closest(a, b) || may_be_closest(b, a); });
    round([&] { send_points(points); }, scene_.counters_.vertex_bytes);
    round([&] { answer_points(); }, scene_.counters_.hit_bytes);
    failure.guard([&] { take_answers(locations); });
    failure.agree(scene_.transport_);
}

// ---- which facets are on the surface --------------------------------------------------------------

// Sends the facets that a neighbour may have, too.
void Outside::send_facets() {
    for (Part* part : scene_.parts_) {
        part->find_facets(memory_);
        for (const std::uint32_t place : part->facets) facets_.push_back({part, place / 4, place % 4});
    }
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        sent_begins_.push_back(sent_.size());
        const Box3f& there = scene_.overviews_[scene_.ranks_[i]].tets;
        for (std::uint32_t f = 0; f < facets_.size(); ++f) {
            const auto& [part, tet, index] = facets_[f];
            bool inside = true;
            for (const std::uint8_t c : facet_corners[index]) inside &= contains(there, part->corner(tet, c));
            if (!inside) continue;
            const std::uint32_t* const v = part->tets.data() + 4 * std::size_t{tet};
            const auto& c = facet_corners[index];
            writers_[i].add(SentFacet{part->body,
                                      {part->id_of(v[c[0]]), part->id_of(v[c[1]]), part->id_of(v[c[2]])},
                                      part->id_of(v[index])});
            sent_.push_back(f);
        }
    }
    sent_begins_.push_back(sent_.size());
}

// Tells neighbours which of their facets other tetrahedra of this rank have.
void Outside::find_sent_facets() {
    struct Wanted {
        const Part* part;
        std::array<std::uint32_t, 3> vertices;
        std::uint32_t opposite; // VOX_NONE: not here
        std::uint32_t neighbour, place;
    };
    Array<Wanted> wanted(memory_);
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        std::uint32_t place = 0;
        for (Reader reader(scene_.in_[i]); reader.more(); ++place) {
            const auto sent = reader.take<SentFacet>();
            const Part* const part = scene_.find_body(sent.body);
            Wanted facet{part, {}, VOX_NONE, i, place};
            bool here = part != nullptr;
            for (std::size_t c = 0; here && c < 3; ++c) {
                const auto vertex = part->find(sent.vertex[c]);
                here = vertex.has_value();
                facet.vertices[c] = vertex.value_or(VOX_NONE);
            }
            if (!here) continue;
            std::ranges::sort(facet.vertices);
            facet.opposite = part->find(sent.opposite).value_or(VOX_NONE);
            wanted.push_back(facet);
        }
    }
    std::ranges::sort(wanted, {}, [](const Wanted& w) { return std::tie(w.part->body, w.vertices); });
    for (auto begin = wanted.begin(); begin != wanted.end();) {
        const Part* const part = begin->part;
        const auto end = std::find_if(begin, wanted.end(), [&](const Wanted& w) { return w.part != part; });
        Array<std::uint8_t> marked(part->vertex_count, std::uint8_t{0}, memory_);
        for (auto facet = begin; facet != end; ++facet)
            for (const std::uint32_t v : facet->vertices) marked[v] = 1;
        for (std::uint32_t t = 0; t < part->tet_count; ++t) {
            const std::uint32_t* const tet = part->tets.data() + 4 * std::size_t{t};
            if (marked[tet[0]] + marked[tet[1]] + marked[tet[2]] + marked[tet[3]] < 3 ||
                names_a_vertex_twice({tet[0], tet[1], tet[2], tet[3]}))
                continue;
            for (std::uint32_t f = 0; f < 4; ++f)
                for (const Wanted& same :
                     std::ranges::equal_range(begin, end, sorted_facet(tet, f), {}, &Wanted::vertices))
                    if (same.opposite != tet[f]) writers_[same.neighbour].add(same.place);
        }
        begin = end;
    }
}

// Drops the facets that neighbours have, too, and builds the tree over the others.
void Outside::build_tree(Overview& mine) {
    for (const auto& [part, tet, index] : facets_) {
        Box3f box = empty_box3f();
        for (std::size_t c = 0; c < 4; ++c) extend(box, rounded_box(part->corner(tet, c)));
        boxes_.push_back(box);
    }
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i)
        for (Reader reader(scene_.in_[i]); reader.more();) {
            const auto place = reader.take<std::uint32_t>();
            if (place >= sent_begins_[i + 1] - sent_begins_[i])
                throw Error(VOX_ERROR_INTERNAL, "another rank shares a facet that it was not sent");
            boxes_[sent_[sent_begins_[i] + place]] = empty_box3f();
        }
    for (const Box3f& box : boxes_) extend(mine.tets, box);
    tree_.reserve(boxes_.size());
    tree_.build(boxes_);
}

// ---- the closest one ------------------------------------------------------------------------------

// The facet that Queries::ClosestFacet would find among those here.
NearFacet Outside::search(const Vec3d& p, double most) const {
    NearFacet nearest{0, 0, most, {}, VOX_NONE, 0};
    SeenPoint seen{};
    std::uint32_t found = 0;
    const auto bound = [&p](const Box3f& box) noexcept { return squared_distance_bound(p, box); };
    tree_.visit_nearest_first(nearest.squared, bound, [&](std::uint32_t item) {
        const auto& [part, tet, index] = facets_[item];
        const auto& c = facet_corners[index];
        const SeenPoint here =
            closest_seen_from(p, part->corner(tet, c[0]), part->corner(tet, c[1]), part->corner(tet, c[2]));
        NearFacet candidate = nearest;
        candidate.squared = std::max(here.at.squared_distance, bound(boxes_[item]));
        candidate.body = part->body;
        candidate.tet = part->id_of_tet(tet);
        candidate.facet = index;
        if (candidate.squared > nearest.squared) return;
        if (nearest.facet != VOX_NONE && nearest.key() < candidate.key()) return;
        nearest = candidate;
        seen = here;
        found = item;
    });
    if (nearest.facet != VOX_NONE) write_weights(p, facets_[found], seen, nearest);
    return nearest;
}

// Computes what Queries::locate_outside does.
void Outside::write_weights(const Vec3d& p, const Facet& facet, const SeenPoint& seen, NearFacet& out) const {
    const auto& c = facet_corners[facet.index];
    const auto weights = normalised(seen.at.weight);
    for (std::size_t i = 0; i < 3; ++i) out.weights[c[i]] = weights[i];
    const std::uint32_t* const v = facet.part->tets.data() + 4 * std::size_t{facet.tet};
    std::array<std::uint8_t, 3> order{c[0], c[1], c[2]};
    std::ranges::sort(order, {}, [&](std::uint8_t corner) { return facet.part->id_of(v[corner]); });
    PointBlock block;
    AccurateWeights accurate;
    set(block.point, 0, p);
    for (std::size_t i = 0; i < 3; ++i) set(block.corner[i], 0, facet.part->corner(facet.tet, order[i]));
    fill_last_register(block, 1, 3);
    if (weigh_closest(block, 1, accurate)) return;
    for (std::size_t i = 0; i < 3; ++i) out.weights[order[i]] = accurate.weight[i][0];
}

// Searches here first, so that few ranks are asked.
void Outside::send_points(const Positions& points) {
    const auto surface_of = [&](std::uint32_t i) -> const Box3f& {
        return scene_.overviews_[scene_.ranks_[i]].tets;
    };
    for (const std::uint32_t point : asked_) {
        const Box3f at = rounded_box(points.exact(point));
        double most = std::numeric_limits<double>::max();
        for (std::uint32_t i = 0; i < scene_.rank_count_; ++i)
            if (!is_empty(surface_of(i))) most = std::min(most, farthest_squared(at, surface_of(i)));
        nearest_.push_back(search(points.exact(point), most));
        where_.push_back(scene_.transport_.rank());
    }
    sent_.clear();
    sent_begins_.clear();
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        sent_begins_.push_back(sent_.size());
        for (std::uint32_t a = 0; a < asked_.size(); ++a) {
            const SentPoint point{points.exact(asked_[a]), nearest_[a].squared};
            if (!(squared_distance_bound(point.p, surface_of(i)) <= point.most)) continue;
            writers_[i].add(point);
            sent_.push_back(a);
        }
    }
    sent_begins_.push_back(sent_.size());
    scene_.counters_.vertices_sent += sent_.size();
}

void Outside::answer_points() {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i) {
        std::uint32_t place = 0;
        for (Reader reader(scene_.in_[i]); reader.more(); ++place) {
            const auto [p, most] = reader.take<SentPoint>();
            NearFacet nearest = search(p, most);
            if (nearest.facet == VOX_NONE) continue;
            nearest.point = place;
            writers_[i].add(nearest);
            ++scene_.counters_.hits_sent;
        }
        scene_.counters_.vertices_received += place;
    }
}

void Outside::take_answers(std::span<vox_dist_location> locations) {
    for (std::uint32_t i = 0; i < scene_.rank_count_; ++i)
        for (Reader reader(scene_.in_[i]); reader.more();) {
            const auto answer = reader.take<NearFacet>();
            if (answer.point >= sent_begins_[i + 1] - sent_begins_[i])
                throw Error(VOX_ERROR_INTERNAL, "another rank answers for a point that it was not sent");
            const std::uint32_t a = sent_[sent_begins_[i] + answer.point];
            if (nearest_[a].facet != VOX_NONE && nearest_[a].key() < answer.key()) continue;
            nearest_[a] = answer;
            where_[a] = scene_.ranks_[i];
        }
    for (std::uint32_t a = 0; a < asked_.size(); ++a) {
        const NearFacet& nearest = nearest_[a];
        if (nearest.facet == VOX_NONE) continue;
        vox_dist_location& location = locations[asked_[a]];
        location = {nearest.body, nearest.tet, VOX_LOCATION_OUTSIDE, where_[a], {}, 0};
        location.distance = std::sqrt(nearest.squared);
        std::copy_n(nearest.weights, 4, location.weights);
    }
}

} // namespace vox::dist
