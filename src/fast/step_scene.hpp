// A step when its hits are found: what the searches over surfaces read of it. The fast engine fills it with
// what it made for itself; for the reference engine StreamedScene makes the same.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/scene.hpp"
#include "fast/body_pairs.hpp"
#include "fast/mesh_state.hpp"
#include "fast/step.hpp"
#include "fast/stream.hpp"
#include "fast/winding/certificate.hpp"

#include <vox/vox.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

namespace vox {

struct Topology;
class Workers;

// Numbers that grow with every change of a mesh: its features are made again then.
struct SurfaceVersion {
    std::uint32_t topology, tiles;

    bool operator==(const SurfaceVersion&) const = default;
};

struct StepScene {
    std::span<const Body> bodies;
    std::span<const Topology* const> topologies; // of each body
    std::span<const SurfaceVersion> versions;    // of each body
    Workers* workers;
    std::span<const vox_contact> contacts{}; // in canonical order, once they are made
    std::span<const Positions> previous{};   // of each body, null where it has none; empty if none has any

    // Set by the engine, or by StreamedScene.
    std::span<const fast::StepBody> of{}; // each body: its packed positions, and whether it moved
    const fast::StepBoxes* boxes = nullptr;
    // Both ways: bodies whose boxes overlap, that may collide, and of which one moved.
    std::span<const fast::Pair> pairs{};
    std::span<const fast::CertifiedCells> certified_cells{}; // of each body; without any, none are known
    Vec3d origin{};                                          // subtracted from positions that were rounded

    // Where winding numbers showed that a body does not overlap itself; null where they showed nothing.
    const fast::CertifiedCells* certified(std::uint32_t body) const noexcept {
        return body < certified_cells.size() && !certified_cells[body].certified.empty()
                   ? &certified_cells[body]
                   : nullptr;
    }

    // Appends those of the step before between bodies that have not moved since, by append(element).
    template <class Found, class Append>
    void carry(std::span<const Found> found, Append&& append) const {
        const auto rests = [&](std::uint32_t mesh) {
            const std::uint32_t body = body_index(bodies, mesh);
            return body < bodies.size() && bodies[body].mesh_id == mesh && !of[body].moved;
        };
        const Found* last = nullptr;
        bool last_rests = false;
        for (const Found& one : found) {
            if (!last || one.body_a != last->body_a || one.body_b != last->body_b)
                last_rests = rests(one.body_a) && rests(one.body_b);
            last = &one;
            if (last_rests) append(one);
        }
    }
};

// Positions, boxes and pairs of a step of the reference engine, of which every body counts as moved.
class StreamedScene {
public:
    explicit StreamedScene(std::pmr::memory_resource* memory)
        : step_(memory), boxes_(memory), stream_(memory), pair_buffers_(memory), pairs_(memory) {}

    // `prepared` has the tiles of each body. What is filled in is good until the next call.
    void fill(std::span<const fast::PreparedBody> prepared, StepScene& scene);

private:
    fast::Step step_;
    fast::StepBoxes boxes_;
    fast::StreamBuffers stream_;
    fast::PairBuffers pair_buffers_;
    Array<fast::Pair> pairs_;
};

} // namespace vox
