// The cell size of least cost, and the sizes around it that are nearly as good, for any cost function: those
// of the models of this library and those of its users (vox_cost_minimise).
#pragma once

#include <vox/vox_cell_size.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

namespace vox {

// What a zone_loss of 0 in vox.h stands for.
constexpr double default_zone_loss = 0.05;

// Cost at the cell size with this binary logarithm: costs are sums of powers of the size, so all searching is
// done in the logarithm. A value that is not a finite number counts as infinite.
using CostFunction = std::function<double(double log_size)>;

// The same for a cost that takes a size, which must outlive the result.
template <class Cost>
auto of_size(const Cost& cost) {
    return [&cost](double log_size) { return cost(std::exp2(log_size)); };
}

struct CellSizeRange {
    double min, max; // 0 < min <= max, finite
};

// A cost at one cell size in nanoseconds, term by term: how often a piece of work is done, and what that
// costs.
class CostTerms {
public:
    void add(const char* name, double count, double ns) noexcept {
        terms_[count_++] = {name, count, count * ns};
    }

    double cost() const noexcept {
        double sum = 0;
        for (const vox_cost_term& term : *this) sum += term.cost;
        return sum;
    }
    const vox_cost_term* begin() const noexcept { return terms_.data(); }
    const vox_cost_term* end() const noexcept { return terms_.data() + count_; }

private:
    std::array<vox_cost_term, VOX_TERM_CAPACITY> terms_{};
    std::uint32_t count_ = 0;
};

// How densely a range is scanned, and how closely the best place of the scan is then refined.
struct Fineness {
    double scans_per_octave = 5;
    int least_scans = 64;
    double tolerance = 1e-8;       // of an octave
    double zone_tolerance = 1e-12; // of the cost at the ends of a zone
};

// The least cost in the range, infinite where all are, by an even scan and a golden-section search around its
// best place. Of a function with several minima, those that lie between two places of the scan can be missed.
vox_cost_sample minimise(const CostFunction& cost, const CellSizeRange& range, const Fineness& fineness = {});

// The interval around the minimum where the cost is at most `limit`, cut to the range. Rises of the cost that
// lie between two places of the scan can be missed.
CellSizeRange zone_around(const vox_cost_sample& minimum, double limit, const CostFunction& cost,
                          const CellSizeRange& range, const Fineness& fineness = {});

// ---- results ----------------------------------------------------------------------------------------

// Adds a warning, and its text to the note, which ends where it is full.
void add_warning(vox_cell_size_result& result, vox_cell_size_warnings warning,
                 const std::string& text) noexcept;

// Lists the terms of a result, whose unit is `scale` of theirs.
void write_terms(const CostTerms& terms, double scale, vox_cell_size_result& result) noexcept;

// Costs at sizes that are evenly spaced in the logarithm, both ends included.
void draw_curve(const CostFunction& cost, const CellSizeRange& range,
                vox_cost_sample (&curve)[VOX_CURVE_CAPACITY], std::uint32_t& count);

// ---- cost functions of users ------------------------------------------------------------------------

// Takes the cost at a size. Throws INVALID_ARGUMENT for bounds that vox_cell_size.h does not allow, and for a
// cost that is nowhere finite or negative where it is least.
vox_cell_size_result minimise_within(const std::function<double(double cell_size)>& cost_at,
                                     const CellSizeRange& range, double zone_loss);

} // namespace vox
