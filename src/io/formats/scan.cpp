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
        fail("expected %s, found the end of the file", what);
    else if (line_end)
        fail("expected %s, found the end of the line", what);
    else
        fail("expected %s, found \"%s\"", what, found.c_str());
}

void Scanner::fail(const char* pattern, ...) const {
    va_list arguments;
    va_start(arguments, pattern);
    const std::string text = text_of(pattern, arguments);
    va_end(arguments);
    fail_at(offset(), "%s", text.c_str());
}

void Scanner::fail_at(std::size_t offset, const char* pattern, ...) const {
    va_list arguments;
    va_start(arguments, pattern);
    const std::string text = text_of(pattern, arguments);
    va_end(arguments);
    throw_error(VOX_ERROR_FORMAT, "%s: %s", place(offset).c_str(), text.c_str());
}

void Scanner::unsupported(const char* pattern, ...) const {
    va_list arguments;
    va_start(arguments, pattern);
    const std::string text = text_of(pattern, arguments);
    va_end(arguments);
    throw_error(VOX_ERROR_UNSUPPORTED, "%s: %s", place().c_str(), text.c_str());
}

void Scanner::out_of_range(const char* what) {
    fail("expected %s, found %s, which is out of range", what, printable(peek()).c_str());
}

void Scanner::check_count(const char* what, std::uint64_t value, std::size_t bytes, std::uint64_t limit,
                          std::size_t at) const {
    if (value > remaining() / bytes)
        throw_error(VOX_ERROR_FORMAT, "%s: %s: %llu are declared, but only %zu bytes follow",
                    place(at).c_str(), what, llu(value), remaining());
    if (value > limit)
        throw_error(VOX_ERROR_LIMIT, "%s: %s: %llu are more than the limit of %llu", place(at).c_str(), what,
                    llu(value), llu(limit));
}

} // namespace vox::io
