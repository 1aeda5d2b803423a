// Which vertices of a body may be in contact, binned for the lookup in cells of a size that fits the tiles
// that will look for them.
#pragma once

#include "base/array.hpp"
#include "base/boxes.hpp"
#include "base/per_worker.hpp"
#include "fast/broad_phase.hpp"
#include "fast/step.hpp"
#include "fast/winding/certificate.hpp"
#include "fast/window.hpp"

#include <cstdint>
#include <memory_resource>
#include <tuple>

namespace vox::fast {

// The windows of a body.
struct BodyWindow {
    const Bins* bins;    // null: no vertex of it may be in contact
    std::uint32_t root;  // of the tree of windows, in bins->windows
    std::uint32_t count; // vertices in them
    Box own;             // where some of them may be in tets of the same body; empty: nowhere
    double cell_size;
};

// Buffers for the windows of a body.
struct WindowBuffers {
    explicit WindowBuffers(std::pmr::memory_resource* memory)
        : certificate(memory), active(memory), points(memory) {}

    Certificate certificate;
    Array<std::uint8_t> active; // blocks with vertices that may be in tets of the same body
    Points points;              // before they are binned

    auto buffers() {
        return std::tuple_cat(certificate.buffers(),
                              std::tie(active, points.x, points.y, points.z, points.id));
    }
};

struct Windows {
    explicit Windows(std::pmr::memory_resource* memory)
        : of(memory), certified(memory), bins(memory), workers(memory), groups(memory), large(memory),
          large_of(memory) {}

    Array<BodyWindow> of; // each body
    // For each body; without cells where winding numbers decided nothing. Empty unless asked for.
    Array<CertifiedCells> certified;
    Array<Bins> bins;

    struct Worker : WindowBuffers { // the buffers are for bodies that have none of their own
        using WindowBuffers::WindowBuffers;
        std::uint64_t exact_tests = 0, winding_ns = 0; // of the step
    };
    PerWorker<Worker> workers;

    // Bodies [first, last), which share one of `bins`: always the same ones, so that these find their size.
    struct Group {
        std::uint32_t first, last;
    };
    Array<Group> groups;
    Array<WindowBuffers> large; // of bodies that are more than a worker's share
    static constexpr std::uint32_t none = ~0u;
    Array<std::uint32_t> large_of; // each body in `large`, or none
};

// Makes the windows of all bodies with vertices that reach another body or that may be in tets of their own.
// Cells are of `cell_size`; 0: of a size chosen for each body. With `keep_certified`, fills out.certified.
void make_windows(const Step& step, const BroadPhase& broad, double cell_size, bool keep_certified,
                  StepBoxes& boxes, Windows& out);

// Appends the vertices in `around` of those blocks of a body that meet one of its regions, or that are
// `active` (null: none), or of all its blocks.
void collect_near(const Step& step, const StepBoxes& boxes, const BroadPhase& broad, std::uint32_t body,
                  const Box& around, bool all_blocks, const std::uint8_t* active, Points& points);

} // namespace vox::fast
