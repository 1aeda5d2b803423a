// Sampling that gives the same sample of the same list on every machine.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace vox {

// splitmix64 (G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA
// 2014).
inline std::uint64_t next_random(std::uint64_t& state) noexcept {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

// A random number from 0 to below - 1. Its bias is below 2^-53 * below, too small to matter in a sample.
inline std::uint64_t next_below(std::uint64_t& state, std::uint64_t below) noexcept {
    return static_cast<std::uint64_t>(static_cast<double>(next_random(state) >> 11) * 0x1p-53 *
                                      static_cast<double>(below));
}

// A random number from 0 to 1, 1 excluded.
inline double next_unit(std::uint64_t& state) noexcept {
    return static_cast<double>(next_random(state) >> 11) * 0x1p-53;
}

// The place within a part of a list for the next part: its multiples are spread evenly over 0 to 1 (H. Weyl,
// 1916).
inline double next_place(double place) noexcept {
    place += 0.6180339887498949; // golden ratio
    return place < 1 ? place : place - 1;
}

// Stratified sampling (W. G. Cochran, Sampling Techniques, 1977): cuts a list of `count` items into `wanted`
// equal parts and takes one item from each. The place within the part changes from part to part, so that a
// repeating pattern, as in a lattice, is sampled in all its phases. Calls visit(index) in ascending order;
// for every item if there are at most `wanted`.
template <class Visit>
void for_stratified(std::uint64_t count, std::uint64_t wanted, double place, Visit&& visit) {
    if (count <= wanted) {
        for (std::uint64_t i = 0; i < count; ++i) visit(i);
        return;
    }
    const double part = static_cast<double>(count) / static_cast<double>(wanted);
    for (std::uint64_t i = 0; i < wanted; ++i, place = next_place(place))
        visit(std::min(static_cast<std::uint64_t>((static_cast<double>(i) + place) * part), count - 1));
}

// The step at which to walk through `count` items so that at most `most` of them are visited.
inline std::size_t stride_for(std::size_t count, std::size_t most) noexcept {
    return std::max<std::size_t>((count + most - 1) / most, 1);
}

} // namespace vox
