// The fit to all timings so far says where the cost is least, and other fits say how sure that is: one
// without each timing (the jackknife: M. Quenouille, Biometrika 43, 1956), and two with each of n timings
// moved up and down by sqrt(n) times the noise, which together have the variance of the noise in all of them
// (S. Julier, J. Uhlmann, A new extension of the Kalman filter to nonlinear systems, AeroSense 1997). The
// size that loses least on average, with each fit taken for the truth, is the best so far. It is run next.
// Where it was already run, that size is whose timing would lower the average most: for each fit, a timing is
// taken from it, and what is chosen then is judged by it (P. Frazier, W. Powell, S. Dayanik, The
// knowledge-gradient policy for correlated normal beliefs, INFORMS J. on Computing 21, 2009).
#include "cell_size/foreign/tune.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "base/structs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace vox {

void complete(vox_tune_desc& desc) {
    set_default(desc.max_runs, 7u);
    set_default(desc.wanted_loss, 0.02);
}

void check_tune_desc(const vox_tune_desc& desc) {
    const auto at_least_0 = [](const char* name, double value) {
        if (!(value >= 0) || !std::isfinite(value))
            refuse(format("desc.%s is %g, expected a finite number of at least 0", name, value));
    };
    if (desc.max_runs < 3 || desc.max_runs > VOX_TIMING_CAPACITY)
        refuse(format("desc.max_runs is %u, expected 3 to %u", desc.max_runs, VOX_TIMING_CAPACITY));
    at_least_0("min", desc.min);
    at_least_0("max", desc.max);
    at_least_0("first", desc.first);
    if ((desc.min > 0) != (desc.max > 0) || desc.min > desc.max)
        refuse(
            format("desc.min and max are %g and %g, expected 0 < min <= max, or both 0", desc.min, desc.max));
    if (desc.first > 0 && desc.max > 0 && !(desc.first >= desc.min && desc.first <= desc.max))
        refuse(format("desc.first is %g, expected from min, %g, to max, %g", desc.first, desc.min, desc.max));
    at_least_0("wanted_loss", desc.wanted_loss);
}

TuneSettings::TuneSettings(const vox_tune_desc& desc, double loss_in_zone, double suggested,
                           double least_legal)
    : max_runs(desc.max_runs), zone_loss(loss_in_zone), wanted_loss(desc.wanted_loss), least(least_legal),
      first(desc.first > 0 ? desc.first : suggested), range{desc.min, desc.max} {
    constexpr double reach = 8;
    if (!(first > 0)) refuse("desc.first is 0, and no grid is described that a first cell size follows from");
    if (desc.first > 0 && first < least)
        refuse(format("desc.first is %g, the smallest that gives right answers is %g", first, least));
    if (range.max > 0 && range.max < least)
        refuse(format("desc.max is %g, the smallest that gives right answers is %g", range.max, least));
    if (!(range.max > 0)) range = {first / reach, first * reach};
    range.min = std::max(range.min, least);
    first = std::clamp(first, range.min, range.max);
    if (!(range.min > 0) || !std::isfinite(range.max))
        refuse(format("the first cell size is %g, too far from 1 for an eighth or eight times it", first));
}

namespace {

constexpr double without_end = std::numeric_limits<double>::infinity();
constexpr int nodes_per_octave = 12;
// From the first cell size on, either way.
constexpr int most_octaves_away = 24;

// One of the fits.
struct Opinion {
    Coefficients coefficients;
    double weight;
    double least; // cost of any size in view
};

// Cell sizes are nodes, evenly spaced in the logarithm. Node 0 is the first size that is run.
class Tuner {
public:
    Tuner(const CostBasis* described, const TuneSettings& settings, const GridRun& run,
          std::pmr::memory_resource* memory)
        : described_(described), settings_(settings), run_(run), first_known_(node_of(settings.range.min)),
          low_(first_known_), high_(node_of(settings.range.max)),
          known_(static_cast<std::size_t>(high_ - low_ + 1), memory), timed_(memory), nodes_(memory),
          failed_(memory), trial_(memory), opinions_(memory) {
        if (described_) check_countable(*described_, size(low_), "the smallest cell size to be tried");
    }

    vox_cell_size_result operator()() {
        run_first();
        if (timed_.empty())
            throw Error(VOX_ERROR_INVALID_STATE,
                        format("no run succeeded: %u could not run, the first at cell size %g%s", run_count_,
                               settings_.first, stopped_ ? ", then the callback stopped" : ""));
        for (judge(); !stopped_ && run_count_ < settings_.max_runs; judge()) {
            if (low_ == high_) break;
            if (run_count_ >= least_runs && open_side() == 0 && !doubtful_ && !unproven_ &&
                loss_ <= settings_.wanted_loss) {
                const std::optional<int> beside = unseen_beside();
                if (!beside) break;
                time(*beside);
            } else {
                time(next());
            }
        }
        return answer();
    }

private:
    static constexpr std::uint32_t least_runs = 4;

    double nodes_from_first(double cell_size) const {
        return nodes_per_octave * (std::log2(cell_size) - std::log2(settings_.first));
    }
    // The last node may be closer to the one before, at the end of the range.
    int node_of(double end) const {
        constexpr double most = nodes_per_octave * most_octaves_away;
        const double nodes = nodes_from_first(end);
        return static_cast<int>(std::clamp(nodes < 0 ? std::floor(nodes) : std::ceil(nodes), -most, most));
    }
    double size(int node) const {
        return std::clamp(settings_.first * std::exp2(double(node) / nodes_per_octave), settings_.range.min,
                          settings_.range.max);
    }

    // ---- runs -----------------------------------------------------------------------------------------

    // Three sizes an octave apart around the first, or others where it cannot run at these.
    void run_first() {
        const int step = std::clamp((high_ - low_) / 2, 1, nodes_per_octave);
        for (const int steps : {0, -1, 1, 2, -2, 3, -3}) {
            if (stopped_ || run_count_ == settings_.max_runs || timed_.size() == 3) break;
            const int node = std::clamp(steps * step, low_, high_);
            if (std::find(nodes_.begin(), nodes_.end(), node) == nodes_.end()) time(node);
        }
    }

    void time(int node) {
        const double cell_size = size(node), seconds = run_(cell_size);
        if (!(seconds >= 0)) {
            stopped_ = true;
            notes_.add(VOX_CELL_SIZE_STOPPED,
                       format("stopped at run %u, at cell size %g", run_count_ + 1, cell_size));
            return;
        }
        if (seconds < least_seconds)
            refuse(
                format("run %u, at cell size %g, returned %g seconds, expected at least %g: a run must take "
                       "longer than the clock's resolution",
                       run_count_ + 1, cell_size, seconds, least_seconds));
        const bool ran = seconds <= most_seconds;
        runs_[run_count_++] = {cell_size, ran ? seconds : without_end};
        if (ran) {
            timed_.push_back({seconds, {}});
            nodes_.push_back(node);
        } else {
            if (failed_.empty())
                notes_.add(VOX_CELL_SIZE_STOPPED, format("it cannot run at cell size %g", cell_size));
            failed_.push_back(node);
        }
        if (!timed_.empty()) narrow();
    }

    // Where it cannot run, it cannot beyond that either. Half of the way there is left to be tried.
    void narrow() {
        const int best = fastest();
        for (const int node : failed_) {
            int nearest = best; // to it, of those that ran
            for (const int ran : nodes_)
                if ((ran < node) == (best < node) && std::abs(ran - node) < std::abs(nearest - node))
                    nearest = ran;
            if (node < best) low_ = std::max(low_, nearest - (nearest - node) / 2);
            if (node > best) high_ = std::min(high_, nearest + (node - nearest) / 2);
        }
    }

    int fastest() const {
        std::size_t best = 0;
        for (std::size_t i = 1; i < timed_.size(); ++i)
            if (timed_[i].seconds < timed_[best].seconds) best = i;
        return nodes_[best];
    }
    double shortest_run() const {
        double least = without_end;
        for (const TimedTerms& timing : timed_) least = std::min(least, timing.seconds);
        return least;
    }
    int smallest() const { return *std::min_element(nodes_.begin(), nodes_.end()); }
    int largest() const { return *std::max_element(nodes_.begin(), nodes_.end()); }

    // ---- fits -----------------------------------------------------------------------------------------

    std::size_t described_terms() const { return described_ ? described_->count : 0; }

    // The powers stand behind the described terms, for what the description lacks.
    void set_powers(double cell_size, Coefficients& values) const {
        const Coefficients powers = powers_.values(cell_size);
        std::copy_n(powers.begin(), powers_.count, values.data() + described_terms());
    }
    Coefficients values_at(double cell_size) const {
        Coefficients values = described_ ? described_->values(cell_size) : Coefficients{};
        set_powers(cell_size, values);
        return values;
    }
    const Coefficients& values(int node) {
        std::optional<Coefficients>& known = known_[static_cast<std::size_t>(node - first_known_)];
        if (!known) known = values_at(size(node));
        return *known;
    }

    // The powers are centred at the best size so far, as they are expected to be least there.
    void recentre() {
        const int best = fastest();
        powers_ = power_basis(size(best));
        int node = first_known_;
        for (std::optional<Coefficients>& known : known_) {
            if (known) set_powers(size(node), *known);
            ++node;
        }
        CostBasis both = described_ ? *described_ : powers_;
        both.count = described_terms() + powers_.count;
        fit_.emplace(both, values(best));
        for (std::size_t i = 0; i < timed_.size(); ++i) timed_[i].values = values(nodes_[i]);
        view_low_ = std::max(low_, smallest() - nodes_per_octave);
        view_high_ = std::min(high_, largest() + nodes_per_octave);
    }

    // The node in view where these coefficients cost least.
    int cheapest(const Coefficients& coefficients) {
        int best = view_low_;
        double least = without_end;
        for (int node = view_low_; node <= view_high_; ++node)
            if (const double cost = cost_of(values(node), coefficients); cost < least) {
                least = cost;
                best = node;
            }
        return best;
    }

    static double loss(const Opinion& opinion, const Coefficients& values) {
        return std::max(cost_of(values, opinion.coefficients) / opinion.least - 1, 0.0);
    }

    void add_opinion(double weight) {
        const Coefficients coefficients = (*fit_)(trial_);
        // A fit to counts that are 0 at some sizes can be 0 there, which no run is.
        const double least = cost_of(values(cheapest(coefficients)), coefficients);
        opinions_.push_back({coefficients, weight, std::max(least, 1e-3 * shortest_run())});
    }

    // Fits to the timings so far, and the node that loses least on average.
    void judge() {
        recentre();
        const auto count = static_cast<double>(timed_.size());
        // Where one run is far faster than the others, the fit can be many times off there.
        const double noise = std::min(weigh(*fit_, timed_), 1.0), move = std::exp(noise * std::sqrt(count));
        const double left_out = timed_.size() > 1 ? 0.5 / count : 0, moved = (0.5 / count) - left_out / 2;
        opinions_.clear();
        for (std::size_t i = 0; i < timed_.size(); ++i) {
            trial_ = timed_;
            trial_[i].seconds = timed_[i].seconds * move;
            add_opinion(moved);
            trial_[i].seconds = timed_[i].seconds / move;
            add_opinion(moved);
            if (timed_.size() == 1) break;
            trial_.erase(trial_.begin() + static_cast<std::ptrdiff_t>(i));
            add_opinion(left_out);
        }
        // The average of the relative costs is a sum of the terms too. Its level is that of the least costs.
        double level = 0;
        for (const Opinion& opinion : opinions_) level += opinion.weight * opinion.least;
        mean_ = {};
        for (const Opinion& opinion : opinions_)
            for (std::size_t i = 0; i < mean_.size(); ++i)
                mean_[i] += opinion.weight * level / opinion.least * opinion.coefficients[i];
        chosen_ = cheapest(mean_);
        // A run can be slower than the fit by accident, but hardly faster, nor do two accidents happen at one
        // place. Otherwise the fit is wrong, as where there are two minima.
        const double much_faster = std::exp(-std::clamp(2 * noise, 0.1, 0.25));
        const double fastest_run = shortest_run();
        double nearby = without_end;
        int runs_nearby = 0;
        for (std::size_t i = 0; i < timed_.size(); ++i) {
            if (std::abs(nodes_[i] - chosen_) > 1) continue;
            nearby = std::min(nearby, timed_[i].seconds);
            ++runs_nearby;
        }
        const double fitted = cost_of(values(chosen_), mean_);
        doubtful_ = runs_nearby == 1 && fitted < much_faster * nearby;
        doubt_ = doubtful_ ? nearby / fastest_run - 1 : 0;
        unproven_ = none_near_chosen() && fitted < (1 - settings_.wanted_loss) * fastest_run;
        surprised_ = fastest_run < much_faster * (runs_nearby > 1 ? std::max(fitted, nearby) : fitted);
        if (surprised_) chosen_ = fastest();
        loss_ = greatest_loss(values(chosen_));
    }

    double greatest_loss(const Coefficients& values) const {
        double greatest = 0;
        for (const Opinion& opinion : opinions_) greatest = std::max(greatest, loss(opinion, values));
        return greatest;
    }

    bool none_near_chosen() const {
        return std::none_of(nodes_.begin(), nodes_.end(),
                            [&](int node) { return std::abs(node - chosen_) <= nodes_per_octave / 6; });
    }

    // On which side of the chosen node nothing was run, though it could be: -1, 1, or 0 for none.
    int open_side() const {
        if (chosen_ <= smallest() && smallest() > low_) return -1;
        return chosen_ >= largest() && largest() < high_ ? 1 : 0;
    }

    // A quarter of an octave to a side of the chosen node, where nothing was run as near: costs are not as
    // smooth as fits.
    std::optional<int> unseen_beside() const {
        constexpr int away = nodes_per_octave / 4;
        for (const int side : {away, -away}) {
            const int beside = std::clamp(chosen_ + side, low_, high_);
            const auto is_near = [&](int node) { return std::abs(node - beside) <= 1; };
            if (std::none_of(nodes_.begin(), nodes_.end(), is_near)) return beside;
        }
        return std::nullopt;
    }

    // Where to run next.
    int next() {
        constexpr int step = nodes_per_octave / 4;
        if (doubtful_ || none_near_chosen()) return chosen_;
        if (const int side = open_side())
            return std::clamp((side < 0 ? smallest() : largest()) + side * nodes_per_octave / 2, low_, high_);
        const double shortest = shortest_run();
        double least = without_end;
        int best = chosen_;
        trial_ = timed_;
        trial_.emplace_back();
        for (int node = view_low_; node <= view_high_; node += step) {
            double average = 0;
            TimedTerms& timing = trial_.back();
            timing.values = values(node);
            for (const Opinion& opinion : opinions_) {
                timing.seconds = cost_of(timing.values, opinion.coefficients);
                timing.weight = shortest / std::max(timing.seconds, shortest);
                average += opinion.weight * loss(opinion, values(cheapest((*fit_)(trial_))));
            }
            if (average < least) {
                least = average;
                best = node;
            }
        }
        return best;
    }

    // ---- the answer -----------------------------------------------------------------------------------

    vox_cell_size_result answer() {
        // Nothing is known beyond the sizes that were run.
        const int node = std::clamp(chosen_, smallest(), largest());
        const CostFunction cost = [&](double log_size) {
            return cost_of(values_at(std::exp2(log_size)), mean_);
        };
        const Fineness fineness{.least_scans = 3, .tolerance = 1e-4};
        const CellSizeRange around{size(std::max(node - 1, smallest())), size(std::min(node + 1, largest()))};
        const CellSizeRange view{size(view_low_), size(view_high_)};
        CostMinimum best = minimise(cost, around, fineness);
        if (surprised_)
            best = {size(node), cost(std::log2(size(node)))};
        else {
            prefer_run(best, cost);
            if (settings_.least > 0 && size(smallest()) <= settings_.least * 1.001)
                prefer_least(best, {size(smallest()), cost(std::log2(size(smallest())))});
            prefer_fastest(best, cost);
        }
        const CellSizeRange zone =
            zone_around(best, (1 + settings_.zone_loss) * best.cost, cost, view, fineness);

        vox_cell_size_result result{};
        result.cell_size = best.cell_size;
        result.zone_min = zone.min;
        result.zone_max = zone.max;
        result.cost = best.cost;
        result.min_cell_size = settings_.least;
        result.expected_loss = smallest() == largest() && low_ != high_
                                   ? without_end
                                   : std::max(greatest_loss(values_at(best.cell_size)), doubt_);
        result.fit_error = plain_error(timed_, (*fit_)(timed_));
        std::copy_n(runs_.begin(), run_count_, result.timings);
        result.timing_count = run_count_;
        draw_curve(cost, {best.cell_size / 8, best.cell_size * 8}, result.curve, result.curve_count);
        if (chosen_ != node)
            notes_.add(VOX_CELL_SIZE_OUT_OF_RANGE, format("the best cell size is beyond those run, %g to %g",
                                                          size(smallest()), size(largest())));
        if (settings_.least > 0 && best.cell_size <= settings_.least * 1.001)
            notes_.add(VOX_CELL_SIZE_AT_MINIMUM,
                       format("%g is the smallest cell size that gives right answers", settings_.least));
        compare_timings(result.fit_error);
        if (described_) result.weights = fit_described();
        result.warnings = notes_.warnings();
        notes_.write(result.note);
        return result;
    }

    // A size that was run, where the fits see no difference: real costs are not as smooth as theirs.
    void prefer_run(CostMinimum& best, const CostFunction& cost) const {
        double least = without_end;
        const double limit = best.cost * (1 + settings_.wanted_loss / 2);
        for (std::size_t i = 0; i < timed_.size(); ++i)
            if (const double fitted = cost(std::log2(size(nodes_[i])));
                fitted <= limit && timed_[i].seconds < least) {
                least = timed_[i].seconds;
                best = {size(nodes_[i]), fitted};
            }
    }

    // The fastest run, where those nearest to the answer were clearly slower: the fit is smoother than the
    // costs.
    void prefer_fastest(CostMinimum& best, const CostFunction& cost) const {
        constexpr double clearly_faster = 0.96;
        const auto answer = static_cast<int>(std::lround(nodes_from_first(best.cell_size)));
        int nearest = std::numeric_limits<int>::max();
        double there = without_end;
        for (std::size_t i = 0; i < timed_.size(); ++i) {
            const int away = std::abs(nodes_[i] - answer);
            if (away > nearest) continue;
            there = away < nearest ? timed_[i].seconds : std::min(there, timed_[i].seconds);
            nearest = away;
        }
        if (!(shortest_run() < clearly_faster * there)) return;
        const double cell_size = size(fastest());
        best = {cell_size, cost(std::log2(cell_size))};
    }

    void compare_timings(double noise) {
        constexpr double most_noise = 0.2;
        double widest = 1;
        int widest_at = 0;
        for (std::size_t i = 0; i < timed_.size(); ++i)
            for (std::size_t j = 0; j < timed_.size(); ++j)
                if (nodes_[i] == nodes_[j] && timed_[i].seconds / timed_[j].seconds > widest) {
                    widest = timed_[i].seconds / timed_[j].seconds;
                    widest_at = nodes_[i];
                }
        if (widest > disagreeing_timings)
            notes_.add(VOX_CELL_SIZE_TIMINGS_DISAGREE,
                       format("runs at cell size %g differ %.2f times", size(widest_at), widest));
        else if (noise > most_noise)
            notes_.add(VOX_CELL_SIZE_TIMINGS_DISAGREE,
                       format("runs are %.0f %% away from the best curve", 100 * noise));
    }

    // The weights of the described grid, without powers.
    vox_foreign_weights fit_described() {
        const double error_of_both = weighted_error(timed_, (*fit_)(timed_));
        const auto described_alone = [&](Coefficients values) {
            std::fill(values.begin() + static_cast<std::ptrdiff_t>(described_->count), values.end(), 0.0);
            return values;
        };
        trial_ = timed_;
        for (TimedTerms& timing : trial_) timing.values = described_alone(timing.values);
        const CostFit fit(*described_, described_alone(values(fastest())));
        (void)weigh(fit, trial_);
        const Coefficients coefficients = fit(trial_);
        const double error = weighted_error(trial_, coefficients);
        if (error > disagreeing_model && error > 2 * error_of_both)
            notes_.add(
                VOX_CELL_SIZE_MODEL_DISAGREES,
                format(
                    "the counts of this grid miss the times by %.0f %%, powers of the cell size by %.0f %%",
                    100 * error, 100 * error_of_both));
        return weights_of(coefficients);
    }

    const CostBasis* described_;
    const TuneSettings& settings_;
    const GridRun& run_;
    Notes notes_;
    bool stopped_ = false;

    const int first_known_;                    // node of known_[0]
    int low_, high_;                           // nodes that may be run
    int view_low_ = 0, view_high_ = 0;         // those up to an octave beyond what was run
    Array<std::optional<Coefficients>> known_; // values of the terms

    std::array<vox_timing, VOX_TIMING_CAPACITY> runs_{};
    std::uint32_t run_count_ = 0;
    Array<TimedTerms> timed_; // the runs that succeeded, and their nodes
    Array<int> nodes_;
    Array<int> failed_; // nodes of the others

    CostBasis powers_;
    std::optional<CostFit> fit_;
    Array<TimedTerms> trial_;
    Array<Opinion> opinions_;
    Coefficients mean_{}; // of the opinions, relative to the least cost of each
    int chosen_ = 0;
    bool doubtful_ = false;  // one run near chosen_, much slower than the fits say
    bool unproven_ = false;  // nothing was run near chosen_, which is to be faster than all that was
    double doubt_ = 0;       // what chosen_ loses if that is no accident
    bool surprised_ = false; // chosen_ was run much faster than the fits say
    double loss_ = 0;        // greatest at chosen_
};

} // namespace

vox_cell_size_result tune(const CostBasis* described, const TuneSettings& settings, const GridRun& run,
                          std::pmr::memory_resource* memory) {
    return Tuner(described, settings, run, memory)();
}

} // namespace vox
