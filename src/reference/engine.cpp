// The paper's algorithm as in Sect. 3 and Fig. 1. Pass one recomputes the boxes and classifies all particles.
// Pass two runs the broad and the narrow phase for each tetrahedron. With levels of cell sizes, which the
// paper does not have, classification and pass two run once for each level.
#include "reference/engine.hpp"

#include "base/bits.hpp"
#include "base/boxes.hpp"
#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/room.hpp"
#include "exact/predicates.hpp"
#include "mesh/check.hpp"
#include "mesh/filter.hpp"

#include <algorithm>
#include <cmath>
#include <new>

namespace vox {

struct ReferenceEngine::Step {
    std::span<const Body> bodies;
    const ReferenceSettings& settings;
    Array<Hit>& hits;
    Counters& counters;
    Profile& profile;
    bool some_filtered = false; // whether some pairs of bodies must not collide
};

namespace {

bool in_range(const CellCoord& at, const CellCoord& min, const CellCoord& max) {
    return at.i >= min.i && at.i <= max.i && at.j >= min.j && at.j <= max.j && at.k >= min.k && at.k <= max.k;
}

double cells_between(const CellCoord& min, const CellCoord& max) {
    return (double(max.i) - min.i + 1) * (double(max.j) - min.j + 1) * (double(max.k) - min.k + 1);
}

} // namespace

ReferenceEngine::ReferenceEngine(std::pmr::memory_resource* memory)
    : particles_(memory), exact_(memory), first_(memory), body_of_(memory), boxes_(memory), cells_(memory),
      sorted_(memory) {}

void ReferenceEngine::detect(std::span<const Body> bodies, const ReferenceSettings& settings,
                             Array<Hit>& hits, Counters& counters, Profile& profile) {
    counters.cells = counters.entries = counters.fullest_cell = 0;
    counters.visited_cells = counters.visited_entries = counters.candidates = 0;
    counters.exact_tests = counters.filtered = counters.skipped_degenerate = 0;
    profile.bin_ns = profile.broad_ns = profile.narrow_ns = 0;
    candidate_count_ = 0;

    Step step{bodies, settings, hits, counters, profile};
    for (const Body& body : bodies)
        step.some_filtered |= body.filter != PairFilter{} || !body.exceptions.empty();
    const std::uint64_t start = nanoseconds();
    load_particles(bodies, step.some_filtered);
    compute_boxes(step);
    profile.bin_ns = nanoseconds() - start;

    double above = -1;
    for (const CellLevel& level : settings.levels) {
        detect_level(step, level.cell_size, {above, level.longest_side});
        above = level.longest_side;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (settings.levels.empty()) detect_level(step, settings.cell_size, {above, infinity});
}

void ReferenceEngine::detect_level(Step& step, double cell_size, const Sizes& sizes) {
    const ReferenceSettings& settings = step.settings;
    // Hashed storage has no bounds. 2^30 cells each way are enough for floats at any sensible cell size, and
    // clamping beyond that keeps the order.
    constexpr std::int32_t far = 1 << 30;
    const Lattice unbounded({0, 0, 0}, cell_size, {-far, -far, -far}, {far, far, far});
    if (settings.dense) {
        DenseAddress address{};
        const Lattice lattice = prepare_dense(settings, cell_size, address);
        run(step, sizes, lattice, address);
    } else if (settings.paper_hash) {
        run_hashed(step, sizes, unbounded, PaperAddress{prepare_hashed(settings)});
    } else {
        run_hashed(step, sizes, unbounded, MixedAddress{prepare_hashed(settings)});
    }
}

template <class Address>
void ReferenceEngine::run_hashed(Step& step, const Sizes& sizes, const Lattice& lattice,
                                 const Address& address) {
    if (!run(step, sizes, lattice, address)) run(step, sizes, lattice, prepare_sorted(lattice));
}

// Returns false, and has found nothing, if the address puts too many cells into one bucket.
template <class Address>
bool ReferenceEngine::run(Step& step, const Sizes& sizes, const Lattice& lattice, const Address& address) {
    const std::uint64_t start = nanoseconds(), decided = step.profile.narrow_ns;
    const bool is_classified = classify(step, lattice, address);
    const std::uint64_t classified = nanoseconds();
    step.profile.bin_ns += classified - start;
    if (!is_classified) return false;

    const Box3f* boxes = boxes_.data();
    for (std::uint32_t body = 0; body < step.bodies.size(); ++body) {
        broad_phase(step, body, boxes, sizes, lattice, address);
        narrow_phase(step, body);
        boxes += step.bodies[body].tets.size();
    }
    step.profile.broad_ns += nanoseconds() - classified - (step.profile.narrow_ns - decided);
    return true;
}

// ---- pass one -------------------------------------------------------------------------------------

void ReferenceEngine::load_particles(std::span<const Body> bodies, bool some_filtered) {
    std::size_t count = 0;
    first_.clear();
    for (const Body& body : bodies) {
        first_.push_back(std::uint32_t(count));
        count += body.vertex_count;
    }
    first_.push_back(std::uint32_t(count));
    body_of_.resize(some_filtered ? count : 0);
    for (std::uint32_t b = 0; b < bodies.size() && some_filtered; ++b)
        std::fill(body_of_.begin() + first_[b], body_of_.begin() + first_[b + 1], b);

    const bool rounded =
        std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.positions.rounded(); });
    particles_.resize(count);
    exact_.resize(rounded ? count : 0);
    Particle* particle = particles_.data();
    Vec3d* exact = exact_.data();
    for (const Body& body : bodies) {
        check_finite(body);
        for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
            *particle++ = {body.positions[v], CellLists::none};
            if (rounded) *exact++ = body.positions.exact(v);
        }
    }
}

// The exact position, for the predicates.
inline Vec3d ReferenceEngine::position(std::size_t particle) const {
    return exact_.empty() ? Vec3d(particles_[particle].position) : exact_[particle];
}

// Boxes from the deformed positions. A tetrahedron that is off or of zero volume holds nothing and gets an
// empty box.
void ReferenceEngine::compute_boxes(Step& step) {
    std::size_t count = 0;
    for (const Body& body : step.bodies) count += body.tets.size();
    boxes_.resize(count);

    Box3f* box = boxes_.data();
    for (std::size_t b = 0; b < step.bodies.size(); ++b) {
        const std::size_t own = first_[b];
        const Body& body = step.bodies[b];
        for (const Tet& tet : body.tets) {
            *box = empty_box3f();
            if (body.off_count != 0 && has_bit(body.off, static_cast<std::size_t>(&tet - body.tets.data()))) {
                ++box;
                continue;
            }
            if (orientation(position(own + tet.v[0]), position(own + tet.v[1]), position(own + tet.v[2]),
                            position(own + tet.v[3]), step.counters.exact_tests) == 0)
                ++step.counters.skipped_degenerate;
            else
                for (const std::uint32_t v : tet.v) extend(*box, particles_[own + v].position);
            ++box;
        }
    }
}

// Makes the cells of dense storage, and a lattice that counts from the corner of their box.
Lattice ReferenceEngine::prepare_dense(const ReferenceSettings& settings, double cell_size,
                                       DenseAddress& address) {
    Vec3d min = settings.world_min, max = settings.world_max;
    const bool automatic = min.x == 0 && min.y == 0 && min.z == 0 && max.x == 0 && max.y == 0 && max.z == 0;
    if (automatic && !particles_.empty()) {
        Box3f box = empty_box3f();
        for (const Particle& particle : particles_) extend(box, particle.position);
        min = {box.min.x, box.min.y, box.min.z};
        max = {box.max.x, box.max.y, box.max.z};
    }
    const auto cells_along = [&](double from, double to) {
        return std::max(1.0, std::ceil((to - from) / cell_size));
    };
    const double nx = cells_along(min.x, max.x), ny = cells_along(min.y, max.y),
                 nz = cells_along(min.z, max.z);
    const double count = nx * ny * nz;
    const auto wanted = [&] {
        return format("dense storage needs %.0f x %.0f x %.0f cells of size %g, %.0f bytes", nx, ny, nz,
                      cell_size, count * double(sizeof(std::uint32_t)));
    };
    if (!(count < 0x1p31))
        throw Error(VOX_ERROR_LIMIT, format("%s; the limit is 2^31 cells", wanted().c_str()));
    try {
        cells_.reset(std::size_t(count), particles_.size());
    } catch (const Error& error) {
        throw Error(error.result(), format("%s: %s", wanted().c_str(), error.what()));
    } catch (const std::bad_alloc&) {
        throw Error(VOX_ERROR_OUT_OF_MEMORY, format("%s: out of memory", wanted().c_str()));
    }
    address = {std::uint32_t(nx), std::uint32_t(ny)};
    return Lattice(min, cell_size, {0, 0, 0},
                   {std::int32_t(nx) - 1, std::int32_t(ny) - 1, std::int32_t(nz) - 1});
}

// Makes the hash table. Its size is a prime, at least twice the number of particles unless the caller sets
// it.
Modulus ReferenceEngine::prepare_hashed(const ReferenceSettings& settings) {
    const std::uint64_t wanted =
        settings.hash_table_size != 0 ? settings.hash_table_size : std::uint64_t(particles_.size()) * 2;
    const std::uint32_t size = next_prime(wanted);
    cells_.reset(size, particles_.size());
    return Modulus(size);
}

// Lists the occupied cells in ascending order, and makes a bucket for each.
SortedAddress ReferenceEngine::prepare_sorted(const Lattice& lattice) {
    sorted_.clear();
    sorted_.reserve(particles_.size());
    for (const Particle& particle : particles_) sorted_.push_back(lattice.cell_of(particle.position));
    std::sort(sorted_.begin(), sorted_.end(), SortedAddress::before);
    sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
    cells_.reset(sorted_.size(), particles_.size());
    return {sorted_};
}

// Puts the particles into cells. Returns false if the address puts too many cells into one bucket; the cells
// are then of no use.
template <class Address>
bool ReferenceEngine::classify(Step& step, const Lattice& lattice, const Address& address) {
    std::uint32_t fullest = 0;
    for (std::size_t p = 0; p < particles_.size(); ++p) {
        Particle& particle = particles_[p];
        const CellCoord at = lattice.cell_of(particle.position);
        const std::uint32_t bucket = address.bucket(address.row(at.j, at.k), at.i);
        const std::uint32_t count = cells_.insert(bucket, at, particle, std::uint32_t(p));
        if (count == 0) return false;
        fullest = std::max(fullest, count);
    }
    step.counters.cells += cells_.occupied().size();
    step.counters.entries += particles_.size();
    step.counters.fullest_cell = std::max<std::uint64_t>(step.counters.fullest_cell, fullest);
    return true;
}

// ---- pass two -------------------------------------------------------------------------------------

template <class Address>
void ReferenceEngine::broad_phase(Step& step, std::uint32_t body, const Box3f* boxes, const Sizes& sizes,
                                  const Lattice& lattice, const Address& address) {
    const std::span<const Tet> tets = step.bodies[body].tets;
    const Particle* particles = particles_.data();
    const std::uint32_t first_own = first_[body];
    // The body's own particles are left out, or if it collides with itself, only the tetrahedron's corners.
    const std::uint32_t own_count = step.bodies[body].self_collision ? 0 : step.bodies[body].vertex_count;
    // Particles of a body follow each other in a cell: the filters are asked when the body changes.
    std::uint32_t asked = body;
    bool asked_collides = true;
    const auto is_filtered = [&](std::uint32_t particle) {
        const std::uint32_t a = body_of_[particle];
        if (a != asked) {
            asked = a;
            asked_collides = a == body || collide(step.bodies[a], step.bodies[body]);
        }
        return !asked_collides;
    };
    std::uint64_t visited_cells = 0, visited_entries = 0;

    for (std::size_t t = 0; t < tets.size(); ++t) {
        const Box3f& box = boxes[t];
        if (is_empty(box)) continue;
        const double side = longest_side(box);
        if (!(side > sizes.above && side <= sizes.most)) continue;

        const auto visit = [&](const Cell& cell) {
            visited_entries += cell.count;
            for (std::uint32_t p = cell.first; p != CellLists::none; p = particles[p].next) {
                if (p - first_own < own_count || !contains(box, particles[p].position)) continue;
                if (step.some_filtered && is_filtered(p)) continue;
                // The number of the vertex in this body; a particle of another body has a number beyond its
                // last.
                const std::uint32_t v = p - first_own;
                const std::uint32_t* corner = tets[t].v;
                if (v == corner[0] || v == corner[1] || v == corner[2] || v == corner[3]) continue;
                candidates_[candidate_count_++] = {std::uint32_t(t), p};
                if (candidate_count_ == candidates_.size()) narrow_phase(step, body);
            }
        };

        const CellCoord min = lattice.cell_of(box.min), max = lattice.cell_of(box.max);
        if (cells_between(min, max) > double(cells_.occupied().size())) {
            // There are more objective voxels than occupied ones (a sliver, a far vertex, tiny cells). Going
            // through the occupied ones instead meets the same particles, and bounds what a tetrahedron
            // costs.
            for (const Cell& cell : cells_.occupied()) {
                if (!in_range(cell.at, min, max)) continue;
                ++visited_cells;
                visit(cell);
            }
            continue;
        }
        for (std::int32_t k = min.k; k <= max.k; ++k) {
            for (std::int32_t j = min.j; j <= max.j; ++j) {
                const auto row = address.row(j, k);
                for (std::int32_t i = min.i; i <= max.i; ++i) {
                    ++visited_cells;
                    if (const Cell* cell = cells_.find(address.bucket(row, i), {i, j, k})) visit(*cell);
                }
            }
        }
    }
    step.counters.visited_cells += visited_cells;
    step.counters.visited_entries += visited_entries;
}

// Decides the collected candidates of tetrahedra of `body`.
void ReferenceEngine::narrow_phase(Step& step, std::uint32_t body) {
    const std::uint64_t start = nanoseconds();
    const std::span<const Tet> tets = step.bodies[body].tets;
    const std::size_t own = first_[body];
    const SelfFilter* self_filter = step.bodies[body].self_filter;
    for (std::size_t c = 0; c < candidate_count_; ++c) {
        const Candidate& candidate = candidates_[c];
        const Tet& tet = tets[candidate.tet];
        const Containment found =
            locate_in_solid(position(candidate.particle), position(own + tet.v[0]), position(own + tet.v[1]),
                            position(own + tet.v[2]), position(own + tet.v[3]), step.counters.exact_tests);
        if (found == Containment::outside) continue;
        // The body of the particle is the last one that does not start after it.
        const auto after = std::upper_bound(first_.begin(), first_.end(), candidate.particle);
        const auto body_a = std::uint32_t(after - first_.begin() - 1);
        if (body_a == body && self_filter && self_filter->skips(candidate.particle - first_[body_a], tet)) {
            ++step.counters.filtered;
            continue;
        }
        reserve_sparingly(step.hits, step.hits.size() + 1);
        step.hits.push_back({body_a, candidate.particle - first_[body_a], body, candidate.tet & 0x7fffffffu,
                             found == Containment::interior});
    }
    step.counters.candidates += candidate_count_;
    candidate_count_ = 0;
    step.profile.narrow_ns += nanoseconds() - start;
}

} // namespace vox
