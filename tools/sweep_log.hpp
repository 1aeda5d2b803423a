// The samples of a sweep as a CSV file that grows by a line a sample, so that a run that was cut off can go
// on.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace tool {

struct SweepSample {
    std::string name; // the rule that the cell size is from; "" for one of the range
    double cell_size = 0;
    std::uint64_t round = 0;
    std::vector<std::uint64_t> frame_ns;
    std::uint64_t contacts = 0, visited_cells = 0, visited_entries = 0, candidates = 0; // of all frames
};

class SweepLog {
public:
    // Samples stay in memory alone.
    SweepLog() = default;
    // `experiment` names what is measured; samples of another one are refused. resume: goes on with the file
    // where there is one (a line that was cut off is dropped); else it is made anew. Throws Failure.
    SweepLog(const std::string& path, const std::string& experiment, std::size_t frames, bool resume);

    // The samples so far, those that were in the file included.
    const std::vector<SweepSample>& samples() const { return samples_; }
    // Null when there is none of this cell size and round.
    const SweepSample* find(double cell_size, std::uint64_t round) const;
    void add(const SweepSample& sample);

private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };

    void read(const std::string& text, std::size_t frames);
    void write(const std::string& line);

    std::string path_, experiment_;
    std::unique_ptr<std::FILE, Close> file_;
    std::vector<SweepSample> samples_;
};

} // namespace tool
