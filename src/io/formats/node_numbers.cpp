#include "io/formats/node_numbers.hpp"

#include <algorithm>

namespace vox::io {

bool NodeNumbers::finish(std::int64_t& out_twice) {
    if (numbers_.empty()) return true;
    const auto [min, max] = std::minmax_element(numbers_.begin(), numbers_.end());
    first_ = *min;
    const std::uint64_t range = distance(*max);
    if (range / 4 < count_) {
        table_.assign(range + 1, none);
        for (std::uint64_t i = 0; i < count_; ++i) {
            std::uint32_t& slot = table_[distance(numbers_[i])];
            if (slot != none) {
                out_twice = numbers_[i];
                return false;
            }
            slot = static_cast<std::uint32_t>(i);
        }
    } else {
        sorted_.reserve(count_);
        for (std::uint64_t i = 0; i < count_; ++i)
            sorted_.emplace_back(numbers_[i], static_cast<std::uint32_t>(i));
        std::sort(sorted_.begin(), sorted_.end());
        for (std::uint64_t i = 1; i < count_; ++i)
            if (sorted_[i].first == sorted_[i - 1].first) {
                out_twice = sorted_[i].first;
                return false;
            }
    }
    numbers_.resize(1); // not empty, as the numbers are not consecutive
    numbers_.shrink_to_fit();
    return true;
}

std::uint32_t NodeNumbers::find_slow(std::int64_t number) const noexcept {
    if (!table_.empty()) return distance(number) < table_.size() ? table_[distance(number)] : none;
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::make_pair(number, 0u));
    return found != sorted_.end() && found->first == number ? found->second : none;
}

} // namespace vox::io
