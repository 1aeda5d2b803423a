#include "json.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace tool {

namespace {

// How many bytes from `at` on are one character; 0: none. Unicode's table of well-formed sequences.
std::size_t character_at(const std::string& text, std::size_t at, std::size_t& valid) {
    const auto byte = [&](std::size_t i) {
        return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
    };
    const unsigned first = byte(0);
    valid = 1;
    if (first < 0x80) return 1;
    const std::size_t size = first >= 0xc2 && first < 0xe0   ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
    for (std::size_t i = 1; i < size; ++i, ++valid) {
        const unsigned least = i > 1 ? 0x80 : first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
        const unsigned most = i > 1 ? 0xbf : first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
        if (byte(i) < least || byte(i) > most) return 0;
    }
    return size;
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : valid_utf8(text)) {
        static constexpr char plain[] = "\"\\\b\f\n\r\t", letters[] = "\"\\bfnrt";
        const char* const found = c ? std::strchr(plain, c) : nullptr;
        if (found) {
            result += '\\';
            result += letters[found - plain];
        } else if (c >= 0 && c < ' ') {
            char code[8];
            std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
            result += code;
        } else {
            result += c;
        }
    }
    return result + '"';
}

} // namespace

std::string valid_utf8(const std::string& text) {
    std::string result;
    for (std::size_t at = 0, valid = 0; at < text.size(); at += valid)
        if (character_at(text, at, valid))
            result.append(text, at, valid);
        else
            result += "\xef\xbf\xbd";
    return result;
}

Json::Json(double value) : text_("null") {
    if (!std::isfinite(value)) return;
    char digits[32];
    text_.assign(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    if (text_.find_first_not_of("-0123456789") == std::string::npos) text_ += ".0"; // no integer for readers
}

Json::Json(const char* text) : text_(quoted(text)) {}

Json::Json(const std::string& text) : text_(quoted(text)) {}

Json::Json(std::initializer_list<Member> members) : text_("{}") {
    for (const Member& member : members) add(member.key, member.value);
}

Json Json::array(std::initializer_list<Json> elements) {
    Json array;
    array.text_ = "[]";
    for (const Json& element : elements) array.push_back(element);
    return array;
}

void Json::add(const std::string& key, const Json& value) { append(quoted(key) + ":" + value.text_); }

void Json::push_back(const Json& element) { append(element.text_); }

// Before the bracket at the end.
void Json::append(const std::string& text) {
    const char bracket = text_.back();
    text_.back() = ',';
    if (text_.size() == 2) text_.pop_back();
    text_ += text;
    text_ += bracket;
}

} // namespace tool
