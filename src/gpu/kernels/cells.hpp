// Cells belong to a scene and a level, and lie in bricks of 4 x 4 x 4 that are found by a hash without
// probing: two bricks in one slot cost time, never a contact, as every box test is done on coordinates
// (M. Teschner et al., Optimized spatial hashing for collision detection of deformable objects, VMV 2003).
// A tile that would meet many cells goes to a level of larger ones; the last level is one cell.
#pragma once

#include "gpu/scene.hpp"

namespace vox::gpu {

constexpr u32 most_cells_of_tile = 64;
constexpr u32 level_count = 6; // cells four times as large as those of the level below; the last: one

VOX_HD float inverse_at(float inverse, u32 level) { // exact but for underflow
    return inverse / static_cast<float>(1u << (2 * level));
}

// The number of a cell along an axis: rounded down, so it is monotone. NaN is in the first one.
VOX_HD int cell_along(float coordinate, float inverse) {
    constexpr float lowest = -1048576.0f, highest = 1048575.0f;
    const float t = coordinate * inverse, clamped = t > lowest ? (t < highest ? t : highest) : lowest;
    const int i = static_cast<int>(clamped);
    return i - (static_cast<float>(i) > clamped);
}

VOX_HD u32 slot_of(u32 brick_mask, u32 scene, u32 level, int x, int y, int z) {
    const auto brick = [](int i) { return static_cast<u64>(static_cast<u32>(i >> 2)); };
    u64 h = (u64{scene} * level_count + level) * 0x9e3779b97f4a7c15ull ^ brick(x) << 42 ^ brick(y) << 21 ^
            brick(z);
    h ^= h >> 31;
    h *= 0x9fb21c651e98df25ull;
    h ^= h >> 29;
    h *= 0x9fb21c651e98df25ull;
    h ^= h >> 32;
    const auto in_brick = static_cast<u32>((x & 3) | (y & 3) << 2 | (z & 3) << 4);
    return (static_cast<u32>(h) & brick_mask) << 6 | in_brick;
}

VOX_HD u32 slot_of_point(const SceneArrays& s, const CellsOfBody& cells, u32 level, const float* p) {
    if (level + 1 == level_count) return slot_of(s.brick_mask, cells.scene, level, 0, 0, 0);
    const float inverse = inverse_at(cells.inverse, level);
    return slot_of(s.brick_mask, cells.scene, level, cell_along(p[0], inverse), cell_along(p[1], inverse),
                   cell_along(p[2], inverse));
}

// The cells that a box meets, numbered.
class CellsOfBox {
public:
    VOX_HD CellsOfBox(const CellsOfBody& cells, const FloatBox& box) : scene_(cells.scene) {
        for (level = 0; level + 1 < level_count; ++level) {
            const float inverse = inverse_at(cells.inverse, level);
            u64 all = 1;
            for (int a = 0; a < 3; ++a) {
                first_[a] = cell_along(box.lo[a], inverse);
                size_[a] = cell_along(box.hi[a], inverse) - first_[a] + 1;
                all *= static_cast<u64>(size_[a] > 0 ? size_[a] : 1); // a NaN may be in the box
            }
            count = static_cast<u32>(all <= most_cells_of_tile ? all : 0);
            if (count != 0) return;
        }
        count = 1;
        for (int a = 0; a < 3; ++a) first_[a] = 0, size_[a] = 1;
    }
    VOX_HD u32 slot(u32 brick_mask, u32 i) const {
        const int x = static_cast<int>(i) % size_[0], rest = static_cast<int>(i) / size_[0];
        return slot_of(brick_mask, scene_, level, first_[0] + x, first_[1] + rest % size_[1],
                       first_[2] + rest / size_[1]);
    }
    // Whether two of them may share a slot. Else they would be a multiple of four apart on each axis.
    VOX_HD bool may_share() const { return size_[0] > 4 || size_[1] > 4 || size_[2] > 4; }

    u32 level, count;

private:
    u32 scene_;
    int first_[3], size_[3];
};

} // namespace vox::gpu
