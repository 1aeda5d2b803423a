// Maps the node numbers of a file to vertex indices.
#pragma once

#include "io/formats/scan.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace vox::io {

class NodeNumbers {
public:
    // Error texts call the vertices `one` or `many`, as the format does.
    explicit NodeNumbers(const char* one = "node", const char* many = "nodes") : one_(one), many_(many) {}

    // Adds the number of the next vertex, in file order.
    void add(std::int64_t number) { numbers_.push_back(number); }

    // Must be called after the last add and before the first vertex_of. `in` fails if two vertices have the
    // same number.
    void finish(const Scanner& in);

    // Returns the index of the vertex with that number. `in` fails if there is none.
    std::uint32_t vertex_of(std::int64_t number, const Scanner& in) const {
        const std::uint64_t place = distance(number);
        if (place < consecutive_) return static_cast<std::uint32_t>(place);
        const std::uint32_t vertex = place < table_.size() ? table_[place] : find_sorted(number);
        if (vertex == none) fail(number, in);
        return vertex;
    }

private:
    static constexpr std::uint32_t none = 0xffffffffu;

    // number - first_, or a huge value if number < first_.
    std::uint64_t distance(std::int64_t number) const noexcept {
        return static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(first_);
    }
    std::uint32_t find_sorted(std::int64_t number) const noexcept;
    [[noreturn]] void fail(std::int64_t number, const Scanner& in) const;

    const char* one_;
    const char* many_;
    std::vector<std::int64_t> numbers_;         // until finish
    std::int64_t first_ = 0;                    // the smallest
    std::uint64_t count_ = 0, consecutive_ = 0; // of vertices, all of them if they are numbered in order
    std::vector<std::uint32_t> table_; // or else the index of number first_ + i, if the numbers are dense
    std::vector<std::pair<std::int64_t, std::uint32_t>> sorted_; // (number, index), if they are sparse
};

} // namespace vox::io
