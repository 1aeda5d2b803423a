// Three sizes an octave apart are run; then the one where a fit to all runs is least; then those a sixth of
// an octave to either side of the best run, as costs are not as smooth as fits. Fits without one of the runs
// say how sure that is (the jackknife: M. Quenouille, Biometrika 43, 1956): where they lose too much at the
// best run, the size is run where the worst of them is least.
#include "cell_size/foreign/fit.hpp"

#include "base/array.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vox {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Cell sizes are nodes, evenly spaced in the logarithm, but for the ends of the range.
class Tuner {
public:
    Tuner(const CostBasis& described, const vox_tune_desc& desc, const GridRun& run,
          std::pmr::memory_resource* memory)
        : described_(described), desc_(desc), run_(run), basis_(with_powers(described, desc.first)),
          first_(nodes_between(desc.min, desc.first)), high_(first_ + nodes_between(desc.first, desc.max)),
          values_(memory), timed_(memory), ran_(memory) {
        if (described.count > 0) check_countable(described, size(0), "the smallest cell size to be tried");
        for (int node = 0; node <= high_; ++node) values_.push_back(basis_.values(size(node)));
    }

    vox_cell_size_result operator()() {
        // The range may end closer than an octave away. Further sizes are for where it cannot run at these.
        const int step = std::clamp(high_ / 2, 1, nodes_per_octave);
        for (const int steps : {0, -1, 1, 2, -2, 3, -3}) {
            const int node = std::clamp(first_ + steps * step, low_, high_);
            if (may_go_on() && timed_.size() < 3 && !was_run(node, 0)) time(node);
        }
        if (timed_.empty())
            throw Error(VOX_ERROR_INVALID_STATE,
                        format("no run succeeded: %u could not run, the first at cell size %g%s", count_,
                               desc_.first, stopped_ ? ", then the callback stopped" : ""));
        for (fit(); may_go_on(); fit()) {
            const int node = next();
            if (was_run(node, 0)) break;
            time(node);
        }
        write_best(
            {size(best_), cost(best_, fitted_)},
            [&](double log_size) { return cost_of(basis_.values(std::exp2(log_size)), fitted_); },
            {size(view_low()), size(view_high())}, basis_, result_);
        result_.timing_count = count_;
        if (const int node = cheapest(fitted_); node < smallest_ || node > largest_)
            add_warning(
                result_, VOX_CELL_SIZE_OUT_OF_RANGE,
                format("the best cell size is beyond those run, %g to %g", size(smallest_), size(largest_)));
        write_errors(described_, values(best_), timed_, fitted_, result_);
        return result_;
    }

private:
    // Costs that are as power_basis expects are 0.07 % more at a node than half of the way to the next.
    static constexpr int nodes_per_octave = 12;

    // Within 24 octaves the squares of cubes of sizes are numbers.
    static int nodes_between(double a, double b) {
        return static_cast<int>(std::ceil(nodes_per_octave * std::min(std::log2(b / a), 24.0)));
    }
    double size(int node) const {
        return std::clamp(desc_.first * std::exp2(double(node - first_) / nodes_per_octave), desc_.min,
                          desc_.max);
    }
    const Coefficients& values(int node) const { return values_[static_cast<std::size_t>(node)]; }

    bool may_go_on() const { return !stopped_ && count_ < desc_.max_runs; }
    bool was_run(int node, int most_away) const {
        return std::any_of(nodes_.begin(), nodes_.begin() + count_,
                           [=](int other) { return std::abs(other - node) <= most_away; });
    }

    void time(int node) {
        const double cell_size = size(node), seconds = run_(cell_size);
        if (!(seconds >= 0)) {
            stopped_ = true;
            add_warning(result_, VOX_CELL_SIZE_STOPPED,
                        format("stopped at run %u, at cell size %g", count_ + 1, cell_size));
            return;
        }
        if (seconds < least_seconds)
            refuse(format("run %u, at cell size %g, returned %g seconds, expected at least %g: a run must "
                          "take longer than the clock's resolution",
                          count_ + 1, cell_size, seconds, least_seconds));
        const bool ran = seconds <= most_seconds;
        if (ran) {
            timed_.push_back({seconds, values(node)});
            ran_.push_back(node);
            if (seconds < fastest_) fastest_node_ = node;
            fastest_ = std::min(seconds, fastest_);
            smallest_ = std::min(smallest_, node);
            largest_ = std::max(largest_, node);
        } else if (timed_.size() == count_) {
            add_warning(result_, VOX_CELL_SIZE_STOPPED, format("it cannot run at cell size %g", cell_size));
        }
        nodes_[count_] = node;
        result_.timings[count_++] = {cell_size, ran ? seconds : infinity};
        // Where it cannot run, it cannot beyond that either. Half of the way there is left to be tried.
        for (std::uint32_t i = 0; i < count_ && !ran_.empty(); ++i) {
            if (nodes_[i] < smallest_) low_ = std::max(low_, smallest_ - (smallest_ - nodes_[i]) / 2);
            if (nodes_[i] > largest_) high_ = std::min(high_, largest_ + (nodes_[i] - largest_) / 2);
        }
    }

    // Up to an octave beyond what was run: half or two octaves change losses by less than 0.1 %.
    int view_low() const { return std::max(low_, smallest_ - nodes_per_octave); }
    int view_high() const { return std::min(high_, largest_ + nodes_per_octave); }

    // A fit to counts that are 0 at some sizes can be 0 there, which no run is. Shares up to 0.1 do as well.
    double cost(int node, const Coefficients& coefficients) const {
        return std::max(cost_of(values(node), coefficients), 1e-3 * fastest_);
    }
    int cheapest(const Coefficients& coefficients) const {
        int best = view_low();
        for (int node = best; node <= view_high(); ++node)
            if (cost(node, coefficients) < cost(best, coefficients)) best = node;
        return best;
    }

    void fit() {
        CostBasis basis = basis_;
        const Coefficients& middle = values(fastest_node_);
        if (described_.count ==
            0) // powers of sizes over the fastest one, where they are expected to cost least
            for (std::size_t i = 0; i < basis.count; ++i) basis.expected[i] /= middle[i];
        fitted_ = fit_robustly(basis, middle, timed_);
        // Timings have noise, and fits are smoother than costs: the best run has the least product of both.
        // Fits alone lose 0.8 % on average in place of 0.35; timings alone are as good where noise is 1 %,
        // and lose 0.1 % more where it is 4 %.
        double least = infinity;
        for (std::size_t i = 0; i < timed_.size(); ++i)
            if (const double both = timed_[i].seconds * cost(ran_[i], fitted_); both < least) {
                least = both;
                best_ = doubted_ = ran_[i];
            }
        // The jackknife's variance is (n - 1) / n times a sum of squares, and losses are as such squares.
        const double count = static_cast<double>(timed_.size());
        double sum = count > 1 || low_ == high_ ? 0 : infinity, greatest = 0;
        for (std::size_t i = 0; i < timed_.size() && count > 1; ++i) {
            const double weight = std::exchange(timed_[i].weight, 0.0);
            const Coefficients others = fit_once(basis, middle, timed_);
            timed_[i].weight = weight;
            const int there = cheapest(others);
            const double loss = cost(best_, others) / cost(there, others) - 1;
            if (loss > greatest) doubted_ = there;
            greatest = std::max(loss, greatest);
            sum += (count - 1) / count * loss;
        }
        result_.expected_loss = sum;
    }

    // One that was run where nothing is to be gained. Without those beside the mean loss is 0.6 % in place of
    // 0.35, and the worst 10 % in place of 2.3; at a quarter of an octave it is 0.43 %.
    int next() const {
        constexpr int sixth = nodes_per_octave / 6;
        if (const int node = cheapest(fitted_); !was_run(node, 1)) return node;
        for (const int beside : {best_ + sixth, best_ - sixth})
            if (const int node = std::clamp(beside, low_, high_); !was_run(node, 1)) return node;
        return result_.expected_loss > desc_.wanted_loss ? doubted_ : best_;
    }

    const CostBasis& described_;
    const vox_tune_desc& desc_;
    const GridRun& run_;
    const CostBasis basis_;      // the described terms, and powers
    const int first_;            // node of the first size
    int low_ = 0, high_;         // nodes that may be run
    Array<Coefficients> values_; // of the terms, at each node
    bool stopped_ = false;
    std::uint32_t count_ = 0; // of runs
    vox_cell_size_result result_{};
    std::array<int, VOX_TIMING_CAPACITY> nodes_{}; // of all runs
    Array<TimedTerms> timed_;                      // runs that succeeded, and their nodes
    Array<int> ran_;
    int smallest_ = std::numeric_limits<int>::max(), largest_ = 0; // of these
    double fastest_ = infinity;                                    // seconds of the fastest run
    Coefficients fitted_{};                                        // to all runs
    // Nodes: of the fastest run, of the best, and where the fit that loses most at the best costs least.
    int fastest_node_ = 0, best_ = 0, doubted_ = 0;
};

} // namespace

vox_cell_size_result tune(const CostBasis& described, const vox_tune_desc& desc, const GridRun& run,
                          std::pmr::memory_resource* memory) {
    return Tuner(described, desc, run, memory)();
}

} // namespace vox
