#include "fast/decide.hpp"

#include "base/clock.hpp"
#include "base/room.hpp"
#include "mesh/filter.hpp"

namespace vox::fast {

void ExactDecisions::take(std::span<const Finding> findings) {
    const std::uint64_t start = nanoseconds();
    Hit hits[64];
    std::size_t count = 0;
    for (const Finding& f : findings) {
        Containment where = Containment::interior;
        if (!f.certain) {
            where = decide(f);
            if (where == Containment::degenerate || where == Containment::outside) continue;
        }
        if (f.body == body_ && self_filter_ && self_filter_->skips(f.vertex, tets_[f.tet])) {
            ++counts_.filtered;
            continue;
        }
        // In place and as a whole: bit fields set one by one are slow to read back.
        hits[count++] = {f.body, f.vertex, body_, f.tet & 0x7fffffffu,
                         where == Containment::interior ? 1u : 0u};
        if (count == std::size(hits)) {
            append(std::span(hits, count));
            count = 0;
        }
    }
    append(std::span(hits, count));
    counts_.ns += nanoseconds() - start;
}

Containment ExactDecisions::decide(const Finding& f) {
    const Tet& tet = tets_[f.tet];
    const Positions& q = bodies_[body_].positions;
    const Containment where =
        locate(bodies_[f.body].positions.exact(f.vertex), q.exact(tet.v[0]), q.exact(tet.v[1]),
               q.exact(tet.v[2]), q.exact(tet.v[3]), counts_.exact_tests);
    if (where == Containment::degenerate) {
        const std::lock_guard lock(out_.mutex);
        out_.degenerate.push_back(std::uint64_t{body_} << 32 | f.tet);
    }
    return where;
}

// One list for all workers: how much room it needs does not depend on which of them found what.
void ExactDecisions::append(std::span<const Hit> hits) {
    if (hits.empty()) return;
    const std::lock_guard lock(out_.mutex);
    reserve_sparingly(out_.hits, out_.hits.size() + hits.size());
    out_.hits.insert(out_.hits.end(), hits.begin(), hits.end());
}

} // namespace vox::fast
