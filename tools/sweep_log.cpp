#include "sweep_log.hpp"

#include "failure.hpp"
#include "paths.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace tool {

namespace {

const char* const header =
    "experiment,name,round,cell_size,contacts,visited_cells,visited_entries,candidates,frames_ns";
constexpr std::size_t columns = 9;

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    return parts;
}

template <class Number>
bool parse(const std::string& text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

bool parse_sample(const std::vector<std::string>& fields, SweepSample& sample) {
    sample.name = fields[1];
    if (!parse(fields[2], sample.round) || !parse(fields[3], sample.cell_size) ||
        !parse(fields[4], sample.contacts) || !parse(fields[5], sample.visited_cells) ||
        !parse(fields[6], sample.visited_entries) || !parse(fields[7], sample.candidates))
        return false;
    for (const std::string& time : split(fields[8], ' ')) {
        sample.frame_ns.emplace_back();
        if (!parse(time, sample.frame_ns.back())) return false;
    }
    return sample.cell_size > 0 && std::isfinite(sample.cell_size);
}

} // namespace

SweepLog::SweepLog(const std::string& path, const std::string& experiment, std::size_t frames, bool resume)
    : path_(path), experiment_(experiment) {
    std::string text;
    if (resume && std::filesystem::exists(path_of(path))) {
        if (!std::filesystem::is_regular_file(path_of(path)))
            throw Failure(path + ": cannot be written: it is not a file");
        std::ifstream in(path_of(path), std::ios::binary);
        text.assign(std::istreambuf_iterator<char>(in), {});
        const std::size_t whole =
            text.find_last_of('\n') == std::string::npos ? 0 : text.find_last_of('\n') + 1;
        if (whole < text.size()) {
            if (whole == 0) throw Failure(path + ": line 1 is not the header of a sweep");
            text.resize(whole);
            in.close();
            std::filesystem::resize_file(path_of(path), whole);
        }
        if (!text.empty()) read(text, frames);
    }
    file_.reset(open_file(path, text.empty() ? "wb" : "ab"));
    if (!file_) throw Failure(path + ": cannot be written: " + std::strerror(errno));
    if (text.empty()) write(header);
}

void SweepLog::read(const std::string& text, std::size_t frames) {
    const std::vector<std::string> lines = split(text, '\n');
    if (lines.front() != header) throw Failure(path_ + ": line 1 is not the header of a sweep");
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const std::string where = path_ + ": line " + std::to_string(i + 1);
        const std::vector<std::string> fields = split(lines[i], ',');
        SweepSample sample;
        if (fields.size() != columns || !parse_sample(fields, sample))
            throw Failure(where + " is not a sample of a sweep");
        if (fields[0] != experiment_)
            throw Failure(where + " belongs to another experiment, " + fields[0] + "; this one is " +
                          experiment_);
        if (sample.frame_ns.size() != frames)
            throw Failure(where + " has " + std::to_string(sample.frame_ns.size()) +
                          " frames, this experiment has " + std::to_string(frames));
        samples_.push_back(std::move(sample));
    }
}

const SweepSample* SweepLog::find(double cell_size, std::uint64_t round) const {
    const auto found = std::find_if(samples_.begin(), samples_.end(), [&](const SweepSample& sample) {
        return sample.cell_size == cell_size && sample.round == round;
    });
    return found == samples_.end() ? nullptr : &*found;
}

void SweepLog::add(const SweepSample& sample) {
    samples_.push_back(sample);
    if (!file_) return;
    char numbers[192];
    std::snprintf(numbers, sizeof numbers, ",%llu,%.17g,%llu,%llu,%llu,%llu,", llu(sample.round),
                  sample.cell_size, llu(sample.contacts), llu(sample.visited_cells),
                  llu(sample.visited_entries), llu(sample.candidates));
    std::string line = experiment_ + ',' + sample.name + numbers;
    for (std::size_t i = 0; i < sample.frame_ns.size(); ++i)
        line.append(i == 0 ? "" : " ").append(std::to_string(sample.frame_ns[i]));
    write(line);
}

// Flushes every line, so that no sample is lost.
void SweepLog::write(const std::string& line) {
    if (std::fputs((line + '\n').c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0)
        throw Failure(path_ + ": cannot be written: " + std::strerror(errno));
}

} // namespace tool
