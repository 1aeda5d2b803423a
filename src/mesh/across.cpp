#include "mesh/across.hpp"

#include <utility>

namespace vox {

std::size_t Across::bytes() const noexcept {
    return codes_.capacity() * sizeof codes_[0] + blocks_.capacity() * sizeof(Block) +
           far_.capacity() * sizeof far_[0] + unsorted_.capacity() * sizeof(Far) +
           wide_.capacity() * sizeof wide_[0];
}

void Across::begin(std::size_t tets) {
    *this = Across(memory());
    size_ = tets;
    codes_.assign(4 * tets, static_cast<std::uint16_t>(nothing_code));
    blocks_.assign((tets + block_size - 1) / block_size, Block{});
}

void Across::build_far(std::uint32_t tet, std::uint32_t facet, std::uint32_t value) {
    const std::size_t place = 4 * std::size_t{tet} + facet;
    if (value & surface_bit) {
        Block& block = blocks_[tet / block_size];
        const std::uint32_t triangle = value & ~surface_bit;
        if (block.first_triangle == nothing) block.first_triangle = triangle;
        if (triangle - block.first_triangle < first_far_code - near_codes) {
            codes_[place] = static_cast<std::uint16_t>(near_codes + (triangle - block.first_triangle));
            return;
        }
    }
    unsorted_.push_back({place, value});
    if (unsorted_.size() > 2 * size_) widen(); // which takes less memory then
}

// By a counting sort.
void Across::finish() {
    if (unsorted_.empty()) return;
    for (const Far& far : unsorted_) ++blocks_[far.place / (4 * block_size)].first_far;
    std::uint32_t sum = 0;
    for (Block& block : blocks_) block.first_far = sum += block.first_far; // its end, so far
    far_.resize(unsorted_.size());
    for (auto far = unsorted_.rbegin(); far != unsorted_.rend(); ++far)
        far_[--blocks_[far->place / (4 * block_size)].first_far] = far->value;
    std::pmr::vector<std::uint16_t> count(blocks_.size(), 0, memory()); // of each block
    for (const Far& far : unsorted_)
        codes_[far.place] =
            static_cast<std::uint16_t>(first_far_code + count[far.place / (4 * block_size)]++);
    unsorted_ = std::pmr::vector<Far>(memory());
}

void Across::widen() {
    if (is_wide_) return;
    std::pmr::vector<std::array<std::uint32_t, 4>> wide(memory());
    wide.reserve(size_);
    for (std::size_t t = 0; t < size_; ++t) wide.push_back((*this)[t]);
    for (const Far& far : unsorted_) wide[far.place / 4][far.place % 4] = far.value;
    const std::size_t size = size_;
    *this = Across(memory());
    size_ = size;
    is_wide_ = true;
    wide_ = std::move(wide);
}

void Across::resize(std::size_t tets) {
    widen();
    wide_.resize(tets, {nothing, nothing, nothing, nothing});
    size_ = tets;
}

} // namespace vox
