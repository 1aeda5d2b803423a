#include "io/formats/scan.hpp"

namespace vox::io {

std::string printable(std::string_view text, std::size_t longest) {
    std::string out(text.substr(0, longest));
    for (char& c : out)
        if (c < ' ' || c > '~') c = '?';
    if (text.size() > longest) out.append("...");
    return out;
}

std::string Scanner::place(std::size_t offset) const {
    if (bytes_) return format("%s, byte %zu", name_.c_str(), offset);
    std::size_t line = 1;
    for (const char* c = begin_; c < begin_ + offset; ++c)
        line += *c == '\n' || (*c == '\r' && !(c + 1 < end_ && c[1] == '\n'));
    return format("%s, line %zu", name_.c_str(), line);
}

void Scanner::report_progress() {
    progress_.report(static_cast<double>(at_ - begin_) / static_cast<double>(end_ - begin_));
    reported_ = at_;
}

void Scanner::expected(const char* what) {
    skip_blanks();
    const bool line_end = at_line_end();
    const std::string found = printable(peek());
    if (done())
        fail(format("expected %s, found the end of the file", what));
    else if (line_end)
        fail(format("expected %s, found the end of the line", what));
    else
        fail(format("expected %s, found \"%s\"", what, found.c_str()));
}

void Scanner::fail(const std::string& text, vox_result result) const {
    throw Error(result, format("%s: %s", place().c_str(), text.c_str()));
}

void Scanner::out_of_range(const char* what) {
    fail(format("expected %s, found %s, which is out of range", what, printable(peek()).c_str()));
}

void Scanner::check_count(const char* what, std::uint64_t value, std::size_t bytes, std::uint64_t limit,
                          std::size_t at) const {
    if (value > remaining() / bytes)
        throw Error(VOX_ERROR_FORMAT, format("%s: %s: %llu are declared, but only %zu bytes follow",
                                             place(at).c_str(), what, llu(value), remaining()));
    if (value > limit)
        throw Error(VOX_ERROR_LIMIT, format("%s: %s: %llu are more than the limit of %llu", place(at).c_str(),
                                            what, llu(value), llu(limit)));
}

// A number out of range is tiny if its first significant digit, shifted by the exponent, is behind the
// decimal point.
bool Scanner::is_tiny(std::string_view number) noexcept {
    const std::size_t e = std::min(number.find_first_of("eE"), number.size());
    const std::string_view digits = number.substr(0, e);
    const std::size_t first = std::min(digits.find_first_of("123456789"), digits.size());
    const std::size_t point = std::min(digits.find('.'), digits.size());
    const char* const end = number.data() + number.size();
    const char* start = number.data() + std::min(e + 1, number.size());
    start += start != end && *start == '+';
    std::int64_t exponent = 0;
    const auto [stop, error] = std::from_chars(start, end, exponent);
    if (error == std::errc::result_out_of_range) return *start == '-';
    return static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first) + exponent < 0;
}

} // namespace vox::io
