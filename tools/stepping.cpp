#include "stepping.hpp"

#include "failure.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tool {

namespace {

// A body's positions and how they sway about them: each coordinate follows a wave of the body's length along
// the next axis. The strain is below 1 %.
class Wobble {
public:
    explicit Wobble(const Body& body) : floats_(body.positions), doubles_(body.exact) {
        const auto measure = [this](const auto& positions) {
            for (std::size_t i = 0; i < positions.size(); ++i) {
                const double x = positions[i];
                least_[i % 3] = i < 3 ? x : std::min(least_[i % 3], x);
                most_[i % 3] = i < 3 ? x : std::max(most_[i % 3], x);
            }
        };
        doubles_.empty() ? measure(floats_) : measure(doubles_);
        for (std::size_t axis = 0; axis < 3; ++axis) size_ = std::max(size_, most_[axis] - least_[axis]);
    }

    void move(Body& body, double time) const {
        doubles_.empty() ? move(floats_, body.positions, time) : move(doubles_, body.exact, time);
    }
    // Keeps the arrays where they are, because the grid borrows them.
    void restore(Body& body) const {
        std::copy(floats_.begin(), floats_.end(), body.positions.begin());
        std::copy(doubles_.begin(), doubles_.end(), body.exact.begin());
    }

private:
    template <class Real>
    void move(const std::vector<Real>& rest, std::vector<Real>& moved, double time) const {
        if (!(size_ > 0)) return;
        const double waves = 2 * std::numbers::pi / size_;
        for (std::size_t i = 0; i < rest.size(); ++i) {
            const std::size_t along = i % 3 == 2 ? i - 2 : i + 1;
            const double phase = waves * (static_cast<double>(rest[along]) - least_[along % 3]) + time;
            const double x = static_cast<double>(rest[i]) + 0.001 * size_ * std::sin(phase);
            // Coordinates near the largest float stay.
            if (std::abs(x) < static_cast<double>(std::numeric_limits<float>::max()))
                moved[i] = static_cast<Real>(x);
        }
    }

    std::vector<float> floats_;
    std::vector<double> doubles_;
    std::array<double, 3> least_{}, most_{};
    double size_ = 0;
};

} // namespace

Grid make_grid(const vox_grid_desc& desc, std::span<const Body> bodies, bool self_collision,
               std::vector<vox_mesh>& ids) {
    vox_grid* created = nullptr;
    check(vox_grid_create(&desc, &created));
    Grid grid(created);
    ids.clear();
    for (const Body& body : bodies) {
        vox_mesh_desc mesh = mesh_desc(body);
        if (self_collision) mesh.flags |= VOX_MESH_SELF_COLLISION;
        vox_mesh id = VOX_NULL_MESH;
        check(vox_mesh_insert(grid.get(), &mesh, &id));
        ids.push_back(id);
    }
    return grid;
}

vox_profile profile_of(const vox_grid* grid) {
    vox_profile profile{};
    profile.struct_size = sizeof profile;
    check(vox_grid_profile(grid, &profile));
    return profile;
}

vox_counters counters_of(const vox_grid* grid) {
    vox_counters counters{};
    counters.struct_size = sizeof counters;
    check(vox_grid_counters(grid, &counters));
    return counters;
}

double cell_size_of(const vox_grid* grid) {
    double cell_size = 0;
    check(vox_grid_cell_size(grid, &cell_size));
    return cell_size;
}

vox_contact_view contacts_of(const vox_grid* grid) {
    vox_contact_view view{};
    check(vox_grid_contacts(grid, &view));
    return view;
}

vox_penetration_view penetrations_of(const vox_grid* grid) {
    vox_penetration_view view{};
    check(vox_grid_penetrations(grid, &view));
    return view;
}

vox_edge_contact_view edge_contacts_of(const vox_grid* grid) {
    vox_edge_contact_view view{};
    check(vox_grid_edge_contacts(grid, &view));
    return view;
}

vox_depth_view edge_depths_of(const vox_grid* grid) {
    vox_depth_view view{};
    check(vox_grid_edge_depths(grid, &view));
    return view;
}

vox_profile median(std::span<const vox_profile> profiles) {
    std::vector<std::uint64_t> times(profiles.size());
    const auto median_of = [&](std::uint64_t vox_profile::*time) {
        for (std::size_t i = 0; i < profiles.size(); ++i) times[i] = profiles[i].*time;
        std::sort(times.begin(), times.end());
        const std::size_t middle = times.size() / 2;
        return times.size() % 2 ? times[middle] : (times[middle - 1] + times[middle]) / 2;
    };
    vox_profile result = profiles.front();
    for (const auto time :
         {&vox_profile::step_ns, &vox_profile::bin_ns, &vox_profile::broad_ns, &vox_profile::narrow_ns,
          &vox_profile::contacts_ns, &vox_profile::depth_ns, &vox_profile::stream_ns,
          &vox_profile::winding_ns, &vox_profile::broad_phase_ns, &vox_profile::windows_ns,
          &vox_profile::lookup_ns, &vox_profile::decide_ns, &vox_profile::edges_ns, &vox_profile::margin_ns})
        result.*time = median_of(time);
    return result;
}

void step_anew(vox_grid* grid, std::span<const vox_mesh> ids) {
    for (const vox_mesh id : ids) check(vox_mesh_mark_moved(grid, id));
    check(vox_grid_step(grid));
}

vox_profile measure_steps(vox_grid* grid, std::span<Body> bodies, std::span<const vox_mesh> ids,
                          std::uint32_t repeat) {
    Progress progress;
    progress.show("first step");
    check(vox_grid_step(grid));
    std::vector<Wobble> wobbles(bodies.begin(), bodies.end());
    std::vector<vox_profile> profiles;
    for (std::uint32_t i = 0; i < repeat; ++i) {
        progress.show("step " + std::to_string(i + 1) + " of " + std::to_string(repeat));
        for (std::size_t b = 0; b < bodies.size(); ++b) wobbles[b].move(bodies[b], i + 1);
        step_anew(grid, ids);
        profiles.push_back(profile_of(grid));
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) wobbles[b].restore(bodies[b]);
    step_anew(grid, ids);
    return median(profiles);
}

namespace {

// The elements of a view, which may be larger than this program knows them.
template <class View>
auto elements_of(const View& view) {
    std::vector<std::remove_cvref_t<decltype(*view.data)>> all(view.count);
    for (std::uint64_t i = 0; i < view.count; ++i)
        std::memcpy(&all[i], reinterpret_cast<const char*>(view.data) + i * view.byte_stride, sizeof all[i]);
    return all;
}

bool has_flag(const vox_grid* grid, std::uint32_t flag) {
    std::uint32_t flags = 0;
    check(vox_grid_get_flags(grid, &flags));
    return (flags & flag) != 0;
}

} // namespace

bool has_margin(const vox_grid* grid) {
    double margin = 0;
    check(vox_grid_margin(grid, &margin));
    return margin > 0;
}

std::vector<vox_margin_contact> margin_contacts_of(const vox_grid* grid) {
    vox_margin_contact_view view;
    check(vox_grid_margin_contacts(grid, &view));
    return elements_of(view);
}

std::vector<vox_passage> passages_of(const vox_grid* grid) {
    vox_passage_view view;
    check(vox_grid_passages(grid, &view));
    return elements_of(view);
}

bool has_penetrations(const vox_grid* grid) { return has_flag(grid, VOX_GRID_PENETRATIONS); }

bool has_edge_contacts(const vox_grid* grid) { return has_flag(grid, VOX_GRID_EDGE_CONTACTS); }

} // namespace tool
