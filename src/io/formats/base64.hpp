// Base64 (RFC 4648), in which XML and JSON hold binary data.
#pragma once

#include "io/formats/scan.hpp"

#include <array>

namespace vox::io {

// What each character stands for; 64: no digit.
inline constexpr auto base64_digits = [] {
    std::array<std::uint8_t, 256> digits{};
    digits.fill(64);
    std::uint8_t digit = 0;
    for (const char c : std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"))
        digits[static_cast<unsigned char>(c)] = digit++;
    return digits;
}();

// Decodes base64 text into at most `most` bytes. Padding may end a group anywhere, as VTK encodes the header
// and the data separately. White space is skipped. `fail` must throw.
template <class Fail>
std::string from_base64(std::string_view text, std::size_t most, const Fail& fail) {
    std::string out;
    out.reserve(std::min(most, text.size() / 4 * 3 + 3));
    std::uint32_t bits = 0;
    int digits = 0, padding = 0;
    for (const char c : text) {
        if (out.size() >= most) break;
        const std::uint32_t digit = base64_digits[static_cast<unsigned char>(c)];
        if (digit == 64 && (Scanner::is_blank(c) || Scanner::is_line_end(c))) continue;
        if (c == '=' && digits >= 2)
            ++padding;
        else if (digit == 64)
            fail(format("expected base64 text, found \"%s\"", printable({&c, 1}).c_str()));
        if (padding > 0 && c != '=') fail("expected the end of a base64 group, found more of it");
        bits = bits << 6 | digit % 64;
        if (++digits == 4) {
            for (int byte = 2; byte >= padding; --byte) out += static_cast<char>(bits >> (8 * byte) & 0xff);
            bits = 0;
            digits = padding = 0;
        }
    }
    if (out.size() < most && digits != 0) fail("expected base64 text in groups of four, found its end");
    return out;
}

} // namespace vox::io
