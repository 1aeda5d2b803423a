// The samples of a sweep as a CSV file, to which every sample adds a line, so that an interrupted run can
// continue.
#pragma once

#include "experiment/samples.hpp"

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace tool {

class SweepLog {
public:
    // Keeps samples in memory only.
    SweepLog() = default;
    // `experiment` identifies what is measured; samples of another experiment are refused. With `resume`, an
    // existing file is continued, and an incomplete last line dropped; otherwise a new file is written.
    // Throws Failure.
    SweepLog(const std::string& path, const std::string& experiment, std::size_t frames, bool resume);

    // All samples, including those that were in the file.
    const std::vector<SweepSample>& samples() const { return samples_; }
    // Returns null if there is no sample of this cell size and round.
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
