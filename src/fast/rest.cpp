#include "rest.hpp"

#include <algorithm>
#include <cstring>

namespace vox::fast {

bool copy_strided(Rest& rest, std::size_t part, const Positions& positions, std::uint32_t first,
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

bool compare_packed(Rest& rest, std::size_t part, const float* positions, std::uint32_t first,
                    std::uint32_t last, const Box& box) noexcept {
    Rest::Part& p = rest.parts[part];
    const float* from = positions + std::size_t{first} * 3;
    float* copy = rest.positions.data() + std::size_t{first} * 3;
    const std::size_t bytes = std::size_t{last - first} * sizeof(Vec3f);
    const bool same = p.copied && std::memcmp(copy, from, bytes) == 0;
    const bool same_box =
        std::equal(box.lo, box.lo + 3, p.box.lo) && std::equal(box.hi, box.hi + 3, p.box.hi);
    if (!same) {
        p.copied = same_box || is_empty(p.box);
        if (p.copied) std::memcpy(copy, from, bytes);
    }
    p.box = box;
    return same;
}

} // namespace vox::fast
