// The constraints that stay of a pair that may have only some (vox_grid_desc.max_constraints_per_pair): the
// deepest one, then always the one farthest from all that stay, in order where distances are equal. Those of
// vertices that are only near come last, as they hold nothing apart yet. The order of Gonzalez, "Clustering
// to minimize the maximum intercluster distance" (1985): no choice covers the rest with half the radius.
#include "grid/constraints.hpp"

#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/vectors.hpp"
#include "grid/pairs.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace vox {

namespace {

// Where a constraint is, and its gap: as they will be written.
struct Place {
    Vec3d at;
    double gap;
};

Place place_of_shape(const ConstraintSources& from, std::uint32_t source) noexcept {
    const ShapeRun& run = *from.run_of(source);
    const Positions& positions = from.bodies[body_index(from.bodies, run.body_a)].positions;
    if (run.edges.empty()) {
        const ShapeVertex& contact = run.vertices[source - run.first];
        return {positions.exact(contact.vertex), contact.gap};
    }
    const ShapeEdge& contact = run.edges[source - run.first];
    Vec3d at{0, 0, 0};
    for (std::uint32_t v = 0; v < contact.count; ++v)
        at = at + contact.weights[v] * positions.exact(contact.vertices[v]);
    return {at, contact.gap};
}

Place place_of_mesh(const ConstraintSources& from, vox_constraint_kind kind, std::uint32_t source) noexcept {
    const auto of_vertex = [&](const auto& contact, double gap) -> Place {
        const Body& a = from.bodies[body_index(from.bodies, contact.body_a)];
        return {a.positions.exact(contact.vertex), gap};
    };
    const auto gap_of = [](const Depth& depth) { return depth.depth > 0 ? -depth.depth : 0.0; };
    switch (kind) {
    case VOX_CONSTRAINT_INSIDE: {
        const Hit& hit = from.hit_of(source);
        return {from.bodies[hit.body_a].positions.exact(hit.vertex),
                from.penetrations ? gap_of(from.penetrations->depths()[source]) : 0};
    }
    case VOX_CONSTRAINT_EDGE: {
        const EdgeContact& contact = from.edges[source];
        const bool deep = !from.edge_depths.empty() && contact.kind == CrossingKind::through;
        return {vector_of(contact.position), deep ? gap_of(from.edge_depths[source]) : 0};
    }
    case VOX_CONSTRAINT_PROXIMITY:
        return of_vertex(from.proximities[source], from.proximities[source].distance);
    case VOX_CONSTRAINT_IMPACT:
        break;
    }
    return of_vertex(from.impacts[source], from.impacts[source].gap);
}

} // namespace

// How many of those listed stay, of all pairs. Makes room for limit().
std::size_t Constraints::count_kept(const ConstraintSources& from, std::size_t listed) {
    std::size_t kept = listed;
    left_out_.assign(from.pairs.size(), 0);
    for (std::size_t p = 0; from.most_per_pair > 0 && p < from.pairs.size(); ++p) {
        const std::uint32_t* const of = &place_[kinds * p];
        const std::uint32_t all = std::accumulate(of, of + kinds, 0u);
        left_out_[p] = all - std::min(all, from.most_per_pair);
        kept -= left_out_[p];
    }
    if (kept == listed) return kept;
    reserve_sparingly(spots_, listed);
    reserve_sparingly(kept_, listed);
    return kept;
}

// Marks the constraints of a pair that stay.
void Constraints::keep(const ConstraintSources& from, std::size_t pair) noexcept {
    const std::uint32_t* const first = &now_.first[kinds * pair];
    const std::uint32_t begin = first[0], end = first[kinds];
    const std::uint32_t near = first[VOX_CONSTRAINT_PROXIMITY],
                        near_end = first[VOX_CONSTRAINT_PROXIMITY + 1];
    const bool of_shape = from.has_shape(now_.pairs[pair]);
    for (std::uint32_t kind = 0; kind < kinds; ++kind)
        for (std::uint32_t i = first[kind]; i < first[kind + 1]; ++i) {
            const Place place =
                of_shape ? place_of_shape(from, sources_[i])
                         : place_of_mesh(from, static_cast<vox_constraint_kind>(kind), sources_[i]);
            spots_[i] = {place.at, place.gap, std::numeric_limits<double>::infinity()};
            kept_[i] = 0;
        }
    std::uint32_t others = (end - begin) - (near_end - near); // that are left
    std::uint32_t chosen = end;
    for (std::uint32_t n = 0; n < from.most_per_pair; ++n) {
        std::uint32_t best = end;
        for (std::uint32_t i = begin; i < end; ++i) {
            if (kept_[i]) continue;
            Spot& spot = spots_[i];
            if (n > 0) {
                const Vec3d way = spot.at - spots_[chosen].at;
                spot.apart = std::min(spot.apart, dot(way, way));
            }
            if ((i >= near && i < near_end) != (others == 0)) continue;
            if (best == end || (n == 0 ? spot.gap < spots_[best].gap : spot.apart > spots_[best].apart))
                best = i;
        }
        kept_[best] = 1;
        others -= others > 0;
        chosen = best;
    }
}

void Constraints::limit(const ConstraintSources& from, Workers& workers) {
    spots_.resize(listed_count_);
    kept_.resize(listed_count_);
    const std::size_t pairs = now_.pairs.size();
    workers.for_ranges(pairs, 16, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t p = begin; p < end; ++p)
            if (left_out_[p] > 0) keep(from, p);
    });
    std::uint32_t to = 0, i = 0;
    for (std::size_t bucket = 0; bucket < kinds * pairs; ++bucket) {
        const std::uint32_t end = now_.first[bucket + 1];
        const bool all = left_out_[bucket / kinds] == 0;
        now_.first[bucket] = to;
        for (; i < end; ++i)
            if (all || kept_[i]) sources_[to++] = sources_[i];
    }
    now_.first[kinds * pairs] = to;
    for (std::size_t p = 0; p <= pairs; ++p) pair_offsets_[p] = now_.first[kinds * p];
}

} // namespace vox
