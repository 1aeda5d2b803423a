// Reads JSON (RFC 8259) in one pass, value by value, without building a tree: a tree of small values takes
// many times the memory of the text.
#pragma once

#include "io/formats/scan.hpp"

#include <cstdint>
#include <string>

namespace vox::io {

class JsonReader {
public:
    // Reads the bytes of `file` from `first` on; errors name the byte, or the line.
    JsonReader(const File& file, std::size_t first, bool count_bytes) : file_(file), at_(first) {
        count_bytes_ = count_bytes;
        skip_blanks();
    }

    // Calls visit(name) for each member of an object; it must read the value.
    template <class Visit>
    void object(const Visit& visit) {
        if (!enter('{', '}', "an object")) return;
        do visit(name());
        while (another('}'));
    }
    // Calls visit() for each element of an array; it must read the element.
    template <class Visit>
    void array(const Visit& visit) {
        if (!enter('[', ']', "an array")) return;
        do visit();
        while (another(']'));
    }

    // The parts of the above, for a caller that reads something else in between. Passes `open`, and `close`
    // if it follows; returns whether there is an element.
    bool enter(char open, char close, const char* what);
    // Passes a comma, or `close`; returns whether there is another element.
    bool another(char close);

    std::string string(const char* what);
    double number(const char* what);
    std::uint64_t count(const char* what); // a number without fraction, from 0 to 2^53
    std::uint32_t index(const char* what); // the same, below 2^32 - 1
    bool boolean(const char* what);
    void skip(); // any value
    void end();  // nothing but blanks may follow

    std::size_t offset() const noexcept { return at_; }
    void seek(std::size_t offset) noexcept { at_ = offset; }
    [[noreturn]] void expected(const char* what) const;
    [[noreturn]] void fail(const std::string& text, vox_result result = VOX_ERROR_FORMAT) const;

private:
    void pass_colon();
    std::string name();
    char next() const noexcept { return at_ < file_.bytes.size() ? file_.bytes[at_] : '\0'; }
    void skip_blanks() noexcept;
    void skip_string();
    void skip_word();

    const File& file_;
    std::size_t at_; // behind blanks
    bool count_bytes_;
};

} // namespace vox::io
