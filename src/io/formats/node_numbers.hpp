// Maps the node numbers of a file to vertex indices. Consecutive numbers, the usual case, need no memory.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace vox::io {

class NodeNumbers {
public:
    static constexpr std::uint32_t none = 0xffffffffu;

    // Adds the number of the next vertex, in file order.
    void add(std::int64_t number) {
        if (!numbers_.empty()) {
            numbers_.push_back(number);
        } else if (count_ == 0) {
            first_ = number;
        } else if (distance(number) != count_) {
            for (std::uint64_t i = 0; i < count_; ++i)
                numbers_.push_back(first_ + static_cast<std::int64_t>(i));
            numbers_.push_back(number);
        }
        ++count_;
    }

    // Must be called after the last add and before the first find. Returns false if two vertices have the
    // same number, `out_twice`.
    bool finish(std::int64_t& out_twice);

    // Returns the index of the vertex with that number, or `none`.
    std::uint32_t find(std::int64_t number) const noexcept {
        if (!numbers_.empty()) return find_slow(number);
        return distance(number) < count_ ? static_cast<std::uint32_t>(distance(number)) : none;
    }

    std::uint64_t count() const noexcept { return count_; }

private:
    // number - first_, or a huge value if number < first_.
    std::uint64_t distance(std::int64_t number) const noexcept {
        return static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(first_);
    }
    std::uint32_t find_slow(std::int64_t number) const noexcept;

    std::int64_t first_ = 0; // of the numbers added; after finish, the smallest
    std::uint64_t count_ = 0;
    std::vector<std::int64_t> numbers_; // empty while all numbers are consecutive
    std::vector<std::uint32_t> table_;  // index of number first_ + i, if the numbers are dense
    std::vector<std::pair<std::int64_t, std::uint32_t>> sorted_; // (number, index), if they are sparse
};

} // namespace vox::io
