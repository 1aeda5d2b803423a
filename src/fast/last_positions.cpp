#include "fast/last_positions.hpp"

#include <algorithm>
#include <cstring>

namespace vox::fast {

bool copy_strided(LastPositions& rest, std::size_t part, const Positions& positions, std::uint32_t first,
                  std::uint32_t last) noexcept {
    float* out = rest.positions.data() + std::size_t{first} * 3;
    bool same = rest.parts[part].copied;
    for (std::uint32_t v = first; v < last; ++v, out += 3) {
        const Vec3f p = positions[v];
        same = same && std::memcmp(out, &p, sizeof p) == 0;
        std::memcpy(out, &p, sizeof p);
    }
    rest.parts[part].copied = true;
    return same;
}

namespace {

// Compares with the copy, and makes a new copy where one is needed.
template <class IsSame, class Copy>
bool compare(LastPositions::Part& part, const Box& box, IsSame&& is_same, Copy&& copy) {
    const bool same = part.copied && is_same();
    const bool same_box =
        std::equal(box.lo, box.lo + 3, part.box.lo) && std::equal(box.hi, box.hi + 3, part.box.hi);
    if (!same) {
        part.copied = same_box || is_empty(part.box);
        if (part.copied) copy();
    }
    part.box = box;
    return same;
}

} // namespace

bool compare_packed(LastPositions& rest, std::size_t part, const float* positions, std::uint32_t first,
                    std::uint32_t last, const Box& box) noexcept {
    const float* from = positions + std::size_t{first} * 3;
    float* copy = rest.positions.data() + std::size_t{first} * 3;
    const std::size_t bytes = std::size_t{last - first} * sizeof(Vec3f);
    return compare(
        rest.parts[part], box, [&] { return std::memcmp(copy, from, bytes) == 0; },
        [&] { std::memcpy(copy, from, bytes); });
}

bool compare_exact(LastPositions& rest, std::size_t part, const Positions& positions, std::uint32_t first,
                   std::uint32_t last, const Box& box) noexcept {
    const auto is_same = [&] {
        for (std::uint32_t v = first; v < last; ++v) {
            const Vec3d p = positions.exact(v);
            if (std::memcmp(&rest.exact[v], &p, sizeof p) != 0) return false;
        }
        return true;
    };
    return compare(rest.parts[part], box, is_same, [&] {
        for (std::uint32_t v = first; v < last; ++v) rest.exact[v] = positions.exact(v);
    });
}

void LastPositions::expect(bool rounded) {
    const std::size_t count = rounded ? positions.size() / 3 : 0;
    if (exact.size() == count) return;
    exact.resize(count);
    for (Part& part : parts) part = {};
}

} // namespace vox::fast
