#include "io/formats/json.hpp"

namespace vox::io {
namespace {

// The UTF-16 unit of the four hexadecimal digits that `text` begins with, or -1.
int utf16_unit(std::string_view text) {
    const std::string_view digits = text.substr(0, 4);
    std::uint16_t unit = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), unit, 16);
    return error == std::errc{} && stop == digits.data() + 4 ? unit : -1;
}

void append_utf8(std::string& out, std::uint32_t code) {
    const auto add = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80) return add(code);
    if (code < 0x800) {
        add(0xc0 | code >> 6);
    } else {
        if (code < 0x10000) {
            add(0xe0 | code >> 12);
        } else {
            add(0xf0 | code >> 18);
            add(0x80 | (code >> 12 & 0x3f));
        }
        add(0x80 | (code >> 6 & 0x3f));
    }
    add(0x80 | (code & 0x3f));
}

} // namespace

void JsonReader::fail(const std::string& text, vox_result result) const {
    Scanner in(file_);
    in.count_bytes(count_bytes_);
    in.seek(std::min(at_, file_.bytes.size()));
    in.fail(text, result);
}

void JsonReader::expected(const char* what) const {
    const std::string_view rest = file_.bytes.substr(std::min(at_, file_.bytes.size()));
    if (rest.empty()) fail(format("expected %s, found the end", what));
    const std::size_t word = std::min<std::size_t>(rest.find_first_of(" \t\r\n,:[]{}", 1), 24);
    fail(format("expected %s, found \"%s\"", what, printable(rest.substr(0, word)).c_str()));
}

void JsonReader::skip_blanks() noexcept {
    while (next() == ' ' || next() == '\t' || next() == '\n' || next() == '\r') ++at_;
}

bool JsonReader::enter(char open, char close, const char* what) {
    if (next() != open) expected(what);
    ++at_;
    skip_blanks();
    if (next() != close) return true;
    ++at_;
    skip_blanks();
    return false;
}

bool JsonReader::another(char close) {
    const bool more = next() == ',';
    if (!more && next() != close) expected(close == '}' ? "a comma or }" : "a comma or ]");
    ++at_;
    skip_blanks();
    return more;
}

void JsonReader::pass_colon() {
    if (next() != ':') expected("a colon");
    ++at_;
    skip_blanks();
}

std::string JsonReader::name() {
    std::string name = string("a name");
    pass_colon();
    return name;
}

void JsonReader::skip_string() {
    for (++at_;; ++at_) {
        const char c = next();
        if (at_ >= file_.bytes.size()) expected("the end of a text");
        if (static_cast<unsigned char>(c) < ' ') fail("expected a text, found a control character in it");
        if (c == '\\') ++at_;
        if (c == '"') break;
    }
    ++at_;
    skip_blanks();
}

std::string JsonReader::string(const char* what) {
    if (next() != '"') expected(what);
    const std::size_t start = at_ + 1;
    skip_string();
    std::size_t end = at_; // behind blanks
    while (file_.bytes[end - 1] != '"') --end;
    const std::string_view text = file_.bytes.substr(start, end - 1 - start);
    if (text.find('\\') == std::string_view::npos) return std::string(text);
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\') {
            out += text[i];
            continue;
        }
        static constexpr std::string_view letters = "\"\\/bfnrt", meant = "\"\\/\b\f\n\r\t";
        const std::size_t letter = letters.find(text[++i]);
        if (letter != std::string_view::npos) {
            out += meant[letter];
            continue;
        }
        int unit = text[i] == 'u' ? utf16_unit(text.substr(i + 1)) : -1;
        if (unit < 0) {
            at_ = start + i - 1;
            expected("an escape");
        }
        i += 4;
        auto code = static_cast<std::uint32_t>(unit);
        if (unit >= 0xd800 && unit < 0xdc00 && text.substr(i + 1).starts_with("\\u")) {
            const int low = utf16_unit(text.substr(i + 3));
            if (low >= 0xdc00 && low < 0xe000) {
                code = 0x10000 + ((code & 0x3ff) << 10) + (static_cast<std::uint32_t>(low) & 0x3ff);
                i += 6;
            }
        }
        append_utf8(out, code);
    }
    return out;
}

double JsonReader::number(const char* what) {
    const char* const start = file_.bytes.data() + at_;
    const char* const end = file_.bytes.data() + file_.bytes.size();
    const char first = next() == '-' && start + 1 < end ? start[1] : next();
    double value = 0;
    const auto [stop, error] = read_double(start, end, value);
    if (first < '0' || first > '9' || error == std::errc::invalid_argument) expected(what);
    const std::string_view text(start, static_cast<std::size_t>(stop - start));
    if (error == std::errc::result_out_of_range && !Scanner::is_tiny(text))
        fail(format("expected %s, found %s, which is out of range", what, printable(text).c_str()));
    at_ += text.size();
    skip_blanks();
    return value;
}

std::uint64_t JsonReader::count(const char* what) {
    const std::size_t at = at_;
    const double value = number(what);
    if (value >= 0 && value <= 0x1p53 && value == std::floor(value)) return static_cast<std::uint64_t>(value);
    at_ = at;
    expected(what);
}

std::uint32_t JsonReader::index(const char* what) {
    const std::size_t at = at_;
    const std::uint64_t value = count(what);
    if (value < 0xffffffffu) return static_cast<std::uint32_t>(value);
    at_ = at;
    expected(what);
}

void JsonReader::skip_word() {
    for (const std::string_view word : {"true", "false", "null"})
        if (file_.bytes.substr(at_).starts_with(word)) {
            at_ += word.size();
            skip_blanks();
            return;
        }
    number("a value");
}

bool JsonReader::boolean(const char* what) {
    const char first = next();
    if (first != 't' && first != 'f') expected(what);
    skip_word();
    return first == 't';
}

// Without recursion, as files can nest values deeper than the call stack allows.
void JsonReader::skip() {
    std::string open; // the brackets that are to be closed
    const auto skip_name = [&] {
        if (next() != '"') expected("a name");
        skip_string();
        pass_colon();
    };
    do {
        const char c = next();
        const char close = c == '{' ? '}' : c == '[' ? ']' : '\0';
        if (close && enter(c, close, "a value")) {
            open += close;
            if (close == '}') skip_name();
            continue;
        }
        if (c == '"')
            skip_string();
        else if (!close)
            skip_word();
        while (!open.empty() && !another(open.back())) open.pop_back();
        if (!open.empty() && open.back() == '}') skip_name();
    } while (!open.empty());
}

void JsonReader::end() {
    if (at_ < file_.bytes.size()) expected("the end");
}

} // namespace vox::io
