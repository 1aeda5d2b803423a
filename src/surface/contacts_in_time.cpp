#include "surface/contacts_in_time.hpp"
#include "base/array.hpp"

#include <atomic>
#include <mutex>
#include <tuple>

namespace vox {

namespace {

constexpr std::size_t least_features = 64; // that a worker takes at once

std::span<const std::uint32_t> corners_in(const SurfaceTopology& topology, vox_feature kind,
                                          const std::uint32_t& index) {
    return {kind == VOX_FEATURE_VERTEX ? &index : topology.corners(kind, index), corners_of(kind)};
}

} // namespace

void first_contact(const SurfaceTopology& topology, const SurfaceMotion& motion, vox_feature a, vox_feature b,
                   const FeaturePairs& pairs, const ContactTimeRule& rule, Workers& workers,
                   vox_safe_step& found) {
    std::atomic<double> latest = found.step; // no later contact matters
    std::mutex mutex;
    workers.for_ranges(pairs.count, least_features, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto own = static_cast<std::uint32_t>(pairs.first + i);
            for (std::uint64_t k = pairs.offsets[i]; k < pairs.offsets[i + 1]; ++k) {
                const std::uint32_t partner = pairs.partners[k];
                const ContactTime contact =
                    contact_time(motion, corners_in(topology, a, own), corners_in(topology, b, partner), rule,
                                 latest.load(std::memory_order_relaxed));
                if (!contact.touches) continue;
                const std::lock_guard lock(mutex);
                if (contact.time > found.step) continue;
                if (contact.time == found.step &&
                    (found.kind_a != a || std::tie(found.a, found.b) <= std::tie(own, partner)))
                    continue; // of an earlier kind, or before it; times are below 1
                found.step = contact.time;
                found.kind_a = a;
                found.kind_b = b;
                found.a = own;
                found.b = partner;
                found.unfinished = !contact.finished;
                latest.store(contact.time, std::memory_order_relaxed);
            }
        }
    });
}

void all_contacts(const SurfaceTopology& topology, const SurfaceMotion& motion, vox_feature a, vox_feature b,
                  const FeaturePairs& pairs, const ContactTimeRule& rule, Workers& workers,
                  Gathered<vox_impact>& gathered, Array<vox_impact>& out) {
    const auto find = [&](std::uint32_t i, Array<vox_impact>& found) {
        const std::uint32_t own = static_cast<std::uint32_t>(pairs.first) + i;
        for (std::uint64_t k = pairs.offsets[i]; k < pairs.offsets[i + 1]; ++k) {
            const std::uint32_t partner = pairs.partners[k];
            const ContactTime contact =
                contact_time(motion, corners_in(topology, a, own), corners_in(topology, b, partner), rule, 1);
            if (contact.touches) found.push_back({own, partner, contact.time});
        }
    };
    gathered.run(static_cast<std::size_t>(pairs.count), workers, find, out);
}

} // namespace vox
