#include "surface/surface.hpp"

#include "base/error.hpp"
#include "base/llu.hpp"
#include "mesh/check.hpp"
#include "surface/suggest.hpp"

#include <cmath>

using namespace vox;

vox_surface::vox_surface(const vox_surface_desc& desc, const MemoryShare& memory)
    : share_(memory), workers_(value_of(desc.tasks), desc.worker_count), topology_(desc, &*memory),
      cell_size_(desc.cell_size), positions_{Array<Vec3d>(&*memory), Array<Vec3d>(&*memory)},
      relative_(&*memory), search_(&*memory), answer_(&*memory), candidates_(&*memory), crossings_(&*memory),
      impacts_(&*memory), proximities_(&*memory), clearances_(&*memory) {}

void vox_surface::move(const vox_motion& motion) {
    const std::uint32_t count = topology_.vertex_count;
    if (count > 0) require(motion.from.data, "from.data");
    if (motion.to.data && motion.to.format != motion.from.format)
        refuse(format("to.format is %d, from.format %d, expected the same", enum_value(motion.to.format),
                      enum_value(motion.from.format)));
    if (motion.flags & ~std::uint32_t{VOX_MOTION_CULL})
        refuse(format("flags is %u, expected vox_motion_flags", motion.flags));
    if (!(motion.radius >= 0)) refuse(format("radius is %g, expected 0 or a length", motion.radius));
    // All that can fail comes first.
    const auto checked = [&](const vox_positions& given, const char* name) {
        const Positions positions = check_positions_of(count, given, name);
        const auto is_good = [](double x) { return std::isfinite(static_cast<float>(x)); };
        for (std::uint32_t v = 0; v < count; ++v) {
            const Vec3d p = positions.exact(v);
            if (is_good(p.x) && is_good(p.y) && is_good(p.z)) continue;
            const bool is_finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
            throw Error(is_finite ? VOX_ERROR_LIMIT : VOX_ERROR_NON_FINITE,
                        format("%s: vertex %u is at %g, %g, %g", name, v, p.x, p.y, p.z));
        }
        return positions;
    };
    const Positions from = checked(motion.from, "from");
    const Positions to = motion.to.data ? checked(motion.to, "to") : from;
    positions_[0].reserve(count);
    if (motion.to.data) positions_[1].reserve(count);
    const auto copy = [count](const Positions& positions, Array<Vec3d>& out) {
        out.resize(count);
        for (std::uint32_t v = 0; v < count; ++v) out[v] = positions.exact(v);
    };
    copy(from, positions_[0]);
    if (motion.to.data) copy(to, positions_[1]);
    motion_ = {positions_[0], motion.to.data ? positions_[1] : positions_[0], motion.radius, from.doubles,
               (motion.flags & VOX_MOTION_CULL) != 0};
    if (from.doubles && count > 0) {
        Vec3d lo = positions_[0][0], hi = lo;
        for (const Vec3d& p : positions_[0]) {
            lo = min(lo, p);
            hi = max(hi, p);
        }
        motion_.origin = far_middle(lo, hi, 16);
    }
    has_motion_ = true;
    search_.forget_boxes();
    piece_ = {};
    answer_lives_ = crossings_.lives = impacts_.lives = proximities_.lives = false;
}

const SurfaceMotion& vox_surface::motion() const {
    if (!has_motion_)
        throw Error(VOX_ERROR_INVALID_STATE, "the surface has no positions yet: call vox_surface_move");
    return motion_;
}

SurfaceMotion vox_surface::at_end(double radius) const {
    const SurfaceMotion& moving = motion();
    return {moving.to, moving.to, radius, moving.doubles, false, moving.origin};
}

void vox_surface::set_cell_size(double cell_size) {
    if (!(cell_size >= 0) || !std::isfinite(cell_size))
        refuse(format("cell_size is %g, expected 0 or a length", cell_size));
    cell_size_ = cell_size;
}

void vox_surface::find_fitting(const SurfaceMotion& motion, vox_feature a, vox_feature b, std::uint32_t first,
                               std::uint32_t count, FeaturePairs& out) {
    // Where the last answer was cut short, and this one goes on from there, about as many will fit.
    const bool goes_on =
        piece_.count > 0 && piece_.a == a && piece_.b == b && piece_.first + piece_.count == first;
    const std::uint32_t first_try = goes_on && piece_.count < count / 2 ? 2 * piece_.count : count;
    piece_ = {};
    for (std::uint32_t wanted = first_try;;) {
        try {
            search_.run(topology_, motion, a, b, first, wanted, cell_size_, workers_, out);
            if (wanted < count) piece_ = {a, b, first, wanted};
            return;
        } catch (const Error& error) {
            if (error.result() != VOX_ERROR_BUDGET) throw;
            search_.release_buffers(); // grown for more than there is room for
            out = FeaturePairs(&*share_);
            if (release_ended()) continue;
            if (wanted <= 1) throw;
            wanted = wanted / 2 + wanted % 2;
        }
    }
}

bool vox_surface::release_ended() noexcept {
    bool released = false;
    const auto release = [&](bool lives, auto& vector) {
        if (lives || vector.capacity() == 0) return;
        vector.clear();
        vector.shrink_to_fit();
        released = true;
    };
    release(answer_lives_, answer_.offsets);
    release(answer_lives_, answer_.partners);
    release(crossings_.lives, crossings_.all);
    release(impacts_.lives, impacts_.all);
    release(proximities_.lives, proximities_.all);
    return released;
}

// Makes an answer; where that is beyond the budget, again, in small pieces and without what is in the way.
template <class Make>
auto vox_surface::answer(bool& lives, Make&& make) {
    struct Pieces {
        std::uint32_t& most;
        ~Pieces() { most = many_at_once; }
    } const pieces{most_at_once_};
    lives = true; // its memory is in use
    try {
        try {
            return make();
        } catch (const Error& error) {
            if (error.result() != VOX_ERROR_BUDGET) throw;
            search_.release_buffers();
            candidates_ = FeaturePairs(&*share_);
            release_ended();
            pieces.most = few_at_once;
        }
        return make();
    } catch (...) {
        lives = false;
        throw;
    }
}

const FeaturePairs& vox_surface::pairs(vox_feature a, vox_feature b, std::uint64_t first,
                                       std::uint64_t count) {
    const SurfaceMotion& moving = motion();
    const std::uint64_t all = topology_.count(a);
    if (first > all) refuse(format("first is %llu of %llu", llu(first), llu(all)));
    answer(answer_lives_, [&] {
        find_fitting(moving, a, b, static_cast<std::uint32_t>(first),
                     static_cast<std::uint32_t>(std::min(count, all - first)), answer_);
    });
    return answer_;
}

vox_cell_size_result vox_surface::suggest_cell_size(vox_feature a, vox_feature b) {
    const SurfaceMotion& moving = motion();
    for (const vox_feature kind : {a, b})
        if (topology_.count(kind) == 0) refuse("there are no features of one of the kinds");
    const FeatureTiles &tiles_a = search_.tiles(topology_, moving, a),
                       &tiles_b = search_.tiles(topology_, moving, b);
    for (const FeatureTiles* tiles : {&tiles_a, &tiles_b})
        for (const Box& box : tiles->tile_boxes)
            if (!has_ends(box))
                refuse(format("radius is %g: boxes that reach beyond the floats overlap at every cell size",
                              moving.radius));
    bool nothing_lives;
    return answer(nothing_lives, [&] { return suggest_for_tiles(tiles_a, tiles_b, &*share_); });
}

// Calls add(Candidates, Answers) for all pairs of a motion.
template <class T, class Add>
std::span<const T> vox_surface::answer_all(Answers<T>& answers, const SurfaceMotion& motion, vox_feature a,
                                           vox_feature b, Add&& add) {
    answer(answers.lives, [&] {
        answers.all.clear();
        for_pieces(motion, a, b, [&](const Candidates& candidates) { add(candidates, answers); });
    });
    return answers.all;
}

std::span<const vox_crossing> vox_surface::crossings() {
    return answer_all(crossings_, at_end(0), VOX_FEATURE_EDGE, VOX_FEATURE_FACE,
                      [&](const Candidates& candidates, Answers<vox_crossing>& out) {
                          add_crossings(candidates, workers_, out);
                      });
}

namespace {

// What most vertices move by, along each axis: the median of some of them.
Vec3d common_way(const SurfaceMotion& motion) {
    constexpr std::size_t most = 255;
    const std::size_t count = motion.from.size(), samples = std::min(count, most);
    if (samples == 0 || motion.from.data() == motion.to.data()) return {};
    std::array<double, most> x, y, z;
    for (std::size_t i = 0; i < samples; ++i) {
        const std::size_t v = i * count / samples;
        const Vec3d way = motion.to[v] - motion.from[v];
        x[i] = way.x;
        y[i] = way.y;
        z[i] = way.z;
    }
    const auto median = [samples](std::array<double, most>& ways) {
        const auto half = ways.begin() + static_cast<std::ptrdiff_t>(samples / 2);
        std::nth_element(ways.begin(), half, ways.begin() + static_cast<std::ptrdiff_t>(samples));
        return *half;
    };
    return {median(x), median(y), median(z)};
}

} // namespace

// Without what most vertices move by, as differences of positions are all that counts. Each coordinate is off
// by 2^-53 of itself then.
SurfaceMotion vox_surface::reaching(double distance) {
    SurfaceMotion wide = motion();
    const Vec3d common = common_way(wide);
    double largest = 0;
    if (largest_coordinate(common) > 0) {
        relative_.resize(wide.to.size());
        for (std::size_t v = 0; v < relative_.size(); ++v) {
            relative_[v] = wide.to[v] - common;
            largest = std::max(largest, largest_coordinate(relative_[v]));
        }
        wide.to = relative_;
    }
    wide.radius = distance / 2 * (1 + 0x1p-50) + largest * 0x1p-52;
    wide.cull = true;
    return wide;
}

vox_safe_step vox_surface::safe_step(const ContactTimeRule& rule) {
    const SurfaceMotion reach = reaching(rule.distance);
    bool nothing_lives;
    return answer(nothing_lives, [&] {
        vox_safe_step found{};
        found.step = 1;
        for (const vox_feature a : {VOX_FEATURE_FACE, VOX_FEATURE_EDGE}) {
            const vox_feature b = a == VOX_FEATURE_FACE ? VOX_FEATURE_VERTEX : VOX_FEATURE_EDGE;
            for_pieces(reach, a, b, [&](const Candidates& candidates) {
                found.pairs += candidates.pairs.offsets[candidates.count()];
                lower_safe_step(candidates.in(motion_), rule, workers_, found);
            });
        }
        return found;
    });
}

std::span<const vox_impact> vox_surface::impacts(vox_feature a, vox_feature b, const ContactTimeRule& rule) {
    return answer_all(impacts_, reaching(rule.distance), a, b,
                      [&](const Candidates& candidates, Answers<vox_impact>& out) {
                          add_impacts(candidates.in(motion_), rule, workers_, out);
                      });
}

std::span<const vox_proximity> vox_surface::proximities(vox_feature a, vox_feature b, double distance) {
    return answer_all(proximities_, at_end(proximity_radius(motion().to, distance)), a, b,
                      [&](const Candidates& candidates, Answers<vox_proximity>& out) {
                          add_proximities(candidates, distance, workers_, out);
                      });
}

void vox_surface::clearances(double max_distance, double* out_distances) {
    const SurfaceMotion still = at_end(max_distance);
    bool nothing_lives;
    answer(nothing_lives, [&] {
        clearances_.resize(topology_.vertex_count);
        for (SharedLeast& of_vertex : clearances_)
            of_vertex.number.store(max_distance, std::memory_order_relaxed);
        for (const vox_feature a : {VOX_FEATURE_FACE, VOX_FEATURE_EDGE})
            for_pieces(still, a, a == VOX_FEATURE_FACE ? VOX_FEATURE_VERTEX : VOX_FEATURE_EDGE,
                       [&](const Candidates& candidates) {
                           lower_clearances(candidates, max_distance, workers_, clearances_);
                       });
    });
    for (std::uint32_t v = 0; v < topology_.vertex_count; ++v) // nothing can fail any more
        out_distances[v] = clearances_[v].number.load(std::memory_order_relaxed);
}

vox_counter_view vox_surface::counters() const {
    const PairCounters& last = search_.counters();
    counter_list_ = {{{"cells", last.cells},
                      {"tile_pairs", last.tile_pairs},
                      {"boxes_compared", last.boxes_compared},
                      {"overlaps", last.overlaps},
                      {"culled", last.culled},
                      {"bytes", share_->bytes()},
                      {"peak_bytes", share_->peak_bytes()}}};
    return {counter_list_.data(), counter_list_.size()};
}
