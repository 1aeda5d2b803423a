#include "io/formats/node_numbers.hpp"

#include <algorithm>

namespace vox::io {

void NodeNumbers::finish(const Scanner& in) {
    const std::vector<std::int64_t> numbers = std::move(numbers_);
    count_ = numbers.size();
    if (numbers.empty()) return;
    first_ = numbers[0];
    while (consecutive_ < count_ && distance(numbers[consecutive_]) == consecutive_) ++consecutive_;
    if (consecutive_ == count_) return;
    consecutive_ = 0;
    const auto fail_twice = [&](std::int64_t number) {
        in.fail("two %s have the number %lld", many_, lld(number));
    };
    const auto [min, max] = std::minmax_element(numbers.begin(), numbers.end());
    first_ = *min;
    const std::uint64_t range = distance(*max);
    if (range / 4 < count_) {
        table_.assign(range + 1, none);
        for (std::uint64_t i = 0; i < count_; ++i) {
            std::uint32_t& slot = table_[distance(numbers[i])];
            if (slot != none) fail_twice(numbers[i]);
            slot = static_cast<std::uint32_t>(i);
        }
        return;
    }
    for (std::uint64_t i = 0; i < count_; ++i)
        sorted_.emplace_back(numbers[i], static_cast<std::uint32_t>(i));
    std::sort(sorted_.begin(), sorted_.end());
    for (std::uint64_t i = 1; i < count_; ++i)
        if (sorted_[i].first == sorted_[i - 1].first) fail_twice(sorted_[i].first);
}

std::uint32_t NodeNumbers::find_sorted(std::int64_t number) const noexcept {
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::make_pair(number, 0u));
    return found != sorted_.end() && found->first == number ? found->second : none;
}

void NodeNumbers::fail(std::int64_t number, const Scanner& in) const {
    in.fail("expected the number of a %s, found %lld, which none of the %llu %s has", one_, lld(number),
            llu(count_), many_);
}

} // namespace vox::io
