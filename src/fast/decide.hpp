// The last stage: which findings of the lookup are hits. What floats could not decide is decided exactly.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"
#include "exact/predicates.hpp"
#include "fast/lookup.hpp"

#include <cstdint>
#include <memory_resource>
#include <mutex>
#include <span>

namespace vox {
struct SelfFilter;
}

namespace vox::fast {

// All workers add to this.
struct Decided {
    Array<Hit>& hits;
    Array<std::uint64_t>& degenerate; // body << 32 | tet, some more than once
    std::mutex mutex{};
};

// Counts of one worker in a step.
struct DecideCounts {
    std::uint64_t exact_tests = 0, filtered = 0, ns = 0;
};

// Takes what is found in the tets of one body.
class ExactDecisions final : public Findings {
public:
    ExactDecisions(std::span<const Body> bodies, std::uint32_t body, DecideCounts& counts, Decided& out)
        : bodies_(bodies), body_(body), tets_(bodies[body].tets), self_filter_(bodies[body].self_filter),
          counts_(counts), out_(out) {}

    void take(std::span<const Finding> findings) override;

private:
    Containment decide(const Finding& f);
    void append(std::span<const Hit> hits);

    std::span<const Body> bodies_;
    std::uint32_t body_;
    std::span<const Tet> tets_;
    const SelfFilter* self_filter_;
    DecideCounts& counts_;
    Decided& out_;
};

} // namespace vox::fast
