// Reads text and binary mesh files from memory in one pass, without copies. Every failure names its place.
#pragma once

#include "base/llu.hpp"
#include "io/formats/decimal.hpp"
#include "io/progress.hpp"
#include "io/throw_error.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace vox::io {

// One file in memory. The bytes are borrowed.
struct File {
    std::string name; // for error texts
    std::string_view bytes;
    Progress progress{};      // of reading it
    bool split_cells = false; // hexahedra, wedges and pyramids into tets
};

// Text for an error message, shortened to `longest` characters, with unprintable ones shown as "?".
std::string printable(std::string_view text, std::size_t longest = 40);

// Reads the value stored at `data`, which need not be aligned; `swap` reverses its bytes.
template <class T>
T load(const char* data, bool swap) noexcept {
    char bytes[sizeof(T)];
    std::memcpy(bytes, data, sizeof bytes);
    if (swap)
        for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// A position in a file. Fields are read within one line unless skip_space() is called between them; line ends
// are "\n", "\r\n" or "\r". Line numbers are computed only when a failure needs one, so that reading does not
// pay for them. skip_space() and take() report the file's progress now and then, which throws if it is
// cancelled.
class Scanner {
public:
    // `comment` begins a comment, which extends to the end of its line; `separator` ends a word, as blanks
    // do; 0: the format has none.
    explicit Scanner(const File& file, char comment = 0, char separator = 0)
        : name_(file.name), progress_(file.progress), begin_(file.bytes.data()), at_(begin_),
          end_(begin_ + file.bytes.size()), comment_(comment), separator_(separator) {}

    // ---- place ----

    bool done() const noexcept { return at_ == end_; }
    std::size_t remaining() const noexcept { return static_cast<std::size_t>(end_ - at_); }
    std::size_t offset() const noexcept { return static_cast<std::size_t>(at_ - begin_); }
    void seek(std::size_t offset) noexcept { at_ = begin_ + offset; }
    std::string_view rest() const noexcept { return {at_, remaining()}; }

    // From now on failures name the byte (on) or the line (off).
    void count_bytes(bool on) noexcept { bytes_ = on; }

    std::string place(std::size_t offset) const;
    std::string place() const { return place(offset()); }

    // Throws "FILE, line N: expected WHAT, found ..." with the word at this place.
    [[noreturn]] void expected(const char* what);
    // Throws "FILE, line N: TEXT".
    [[noreturn]] VOX_PRINTF(2) void fail(const char* pattern, ...) const;
    [[noreturn]] VOX_PRINTF(3) void fail_at(std::size_t offset, const char* pattern, ...) const;
    [[noreturn]] VOX_PRINTF(2) void unsupported(const char* pattern, ...) const;

    // ---- text ----

    void skip_blanks() noexcept {
        while (at_ != end_ && is_blank(*at_)) ++at_;
    }
    // Skips blanks, comments and line ends.
    void skip_space() {
        note_progress();
        for (;; ++at_) {
            while (at_ != end_ && (is_blank(*at_) || is_line_end(*at_))) ++at_;
            if (at_ == end_ || !comment_ || *at_ != comment_) return;
            while (at_ != end_ && !is_line_end(*at_)) ++at_;
            if (at_ == end_) return;
        }
    }
    bool at_line_end() noexcept {
        skip_blanks();
        return at_ == end_ || is_line_end(*at_) || (comment_ && *at_ == comment_);
    }
    void skip_line() noexcept {
        while (at_ != end_ && !is_line_end(*at_)) ++at_;
        pass_line_end();
    }
    // Goes to the next line. Fails if anything but blanks remains in this one.
    void line_end() {
        if (!at_line_end()) expected("the end of the line");
        skip_line();
    }

    // The next word of the line, without passing it. Empty at the end of a line.
    std::string_view peek() noexcept {
        if (at_line_end()) return {};
        const char* stop = at_;
        while (stop != end_ && !is_blank(*stop) && !is_line_end(*stop) && !is_separator(*stop)) ++stop;
        return {at_, static_cast<std::size_t>(stop - at_)};
    }
    std::string_view word(const char* what) {
        const std::string_view found = peek();
        if (found.empty()) expected(what);
        at_ += found.size();
        return found;
    }
    bool accept_separator() noexcept {
        skip_blanks();
        const bool found = at_ != end_ && is_separator(*at_);
        at_ += found;
        return found;
    }
    // Passes `text` if it is the next word.
    bool accept(std::string_view text) noexcept {
        if (peek() != text) return false;
        at_ += text.size();
        return true;
    }

    template <class Integer>
    Integer integer(const char* what) {
        skip_blanks();
        const char* start = at_ + (at_ != end_ && *at_ == '+');
        Integer value{};
        const auto [stop, error] = std::from_chars(start, end_, value);
        if (error == std::errc::result_out_of_range) out_of_range(what);
        if (error != std::errc{} || !at_word_end(stop)) expected(what);
        at_ = stop;
        return value;
    }

    double real(const char* what) {
        skip_blanks();
        const char* start = at_ + (at_ != end_ && *at_ == '+');
        double value = 0;
        const auto [stop, error] = read_real(start, end_, value);
        if (error == std::errc::invalid_argument || !at_word_end(stop)) expected(what);
        // A number too small for a double is read as zero, as by C's strtod; a number too large fails.
        if (error == std::errc::result_out_of_range && value != 0) out_of_range(what);
        if (!std::isfinite(value)) expected("a finite number");
        at_ = stop;
        return value;
    }

    // Reads a count of at most `limit` items that each take at least `bytes` bytes of the rest of the file.
    std::uint64_t count(const char* what, std::size_t bytes, std::uint64_t limit) {
        skip_blanks();
        if (at_ != end_ && *at_ == '-') expected(what);
        const std::size_t start = offset();
        const auto value = integer<std::uint64_t>(what);
        check_count(what, value, bytes, limit, start);
        return value;
    }
    void check_count(const char* what, std::uint64_t value, std::size_t bytes, std::uint64_t limit,
                     std::size_t at) const;

    // ---- binary ----

    const char* take(std::size_t size, const char* what) {
        if (size > remaining())
            fail("expected %zu bytes (%s), found the end of the file after %zu", size, what, remaining());
        note_progress();
        const char* data = at_;
        at_ += size;
        return data;
    }
    template <class T>
    T binary(bool swap, const char* what) {
        return load<T>(take(sizeof(T), what), swap);
    }

    static bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
    static bool is_line_end(char c) noexcept { return c == '\n' || c == '\r'; }

private:
    void pass_line_end() noexcept {
        if (at_ != end_ && *at_ == '\r') {
            ++at_;
            if (at_ != end_ && *at_ == '\n') ++at_;
        } else if (at_ != end_) {
            ++at_;
        }
    }
    bool at_word_end(const char* c) const noexcept {
        return c == end_ || is_blank(*c) || is_line_end(*c) || (comment_ && *c == comment_) ||
               is_separator(*c);
    }
    bool is_separator(char c) const noexcept { return separator_ && c == separator_; }
    [[noreturn]] void out_of_range(const char* what);
    void note_progress() {
        if (at_ - reported_ >= report_every) report_progress();
    }
    void report_progress();

    static constexpr std::ptrdiff_t report_every = 1 << 18; // bytes: a millisecond or two

    const std::string& name_;
    const Progress& progress_;
    const char* begin_;
    const char* at_;
    const char* end_;
    const char* reported_ = begin_; // the farthest place that was reported
    char comment_, separator_;
    bool bytes_ = false;
};

inline bool is_finite(const double p[3]) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

inline constexpr bool host_is_big_endian = std::endian::native == std::endian::big;

} // namespace vox::io
