// A cost at one cell size, term by term: how often a piece of work is done, and what it costs each time.
#pragma once

#include <vox/vox.h>

#include <array>
#include <cstdint>

namespace vox {

struct CostTerm {
    const char* name; // at most 23 characters
    double count;
    double weight; // nanoseconds each
};

class CostTerms {
public:
    void add(const char* name, double count, double weight) noexcept {
        terms_[count_++] = {name, count, weight};
    }

    double cost() const noexcept {
        double sum = 0;
        for (const CostTerm& term : *this) sum += term.count * term.weight;
        return sum;
    }
    const CostTerm* begin() const noexcept { return terms_.data(); }
    const CostTerm* end() const noexcept { return terms_.data() + count_; }

private:
    std::array<CostTerm, VOX_COST_TERM_CAPACITY> terms_{};
    std::uint32_t count_ = 0;
};

} // namespace vox
