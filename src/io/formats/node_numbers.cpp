#include "io/formats/node_numbers.hpp"

#include <algorithm>

namespace vox::io {

void NodeNumbers::finish(const Scanner& in) {
    if (numbers_.empty()) return;
    const auto fail_twice = [&](std::int64_t number) {
        in.fail(format("two %s have the number %lld", many_, lld(number)));
    };
    const auto [min, max] = std::minmax_element(numbers_.begin(), numbers_.end());
    first_ = *min;
    const std::uint64_t range = distance(*max);
    if (range / 4 < count_) {
        table_.assign(range + 1, none);
        for (std::uint64_t i = 0; i < count_; ++i) {
            std::uint32_t& slot = table_[distance(numbers_[i])];
            if (slot != none) fail_twice(numbers_[i]);
            slot = static_cast<std::uint32_t>(i);
        }
    } else {
        sorted_.reserve(count_);
        for (std::uint64_t i = 0; i < count_; ++i)
            sorted_.emplace_back(numbers_[i], static_cast<std::uint32_t>(i));
        std::sort(sorted_.begin(), sorted_.end());
        for (std::uint64_t i = 1; i < count_; ++i)
            if (sorted_[i].first == sorted_[i - 1].first) fail_twice(sorted_[i].first);
    }
    numbers_.resize(1); // not empty, as the numbers are not consecutive
    numbers_.shrink_to_fit();
}

std::uint32_t NodeNumbers::find_slow(std::int64_t number) const noexcept {
    if (!table_.empty()) return distance(number) < table_.size() ? table_[distance(number)] : none;
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::make_pair(number, 0u));
    return found != sorted_.end() && found->first == number ? found->second : none;
}

void NodeNumbers::fail(std::int64_t number, const Scanner& in) const {
    in.fail(format("expected the number of a %s, found %lld, which none of the %llu %s has", one_,
                   lld(number), llu(count_), many_));
}

} // namespace vox::io
