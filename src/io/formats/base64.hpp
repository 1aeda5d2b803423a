// Base64 (RFC 4648), in which XML and JSON hold binary data.
#pragma once

#include "io/formats/scan.hpp"

namespace vox::io {

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
        std::uint32_t digit = 0;
        if (c >= 'A' && c <= 'Z')
            digit = static_cast<std::uint32_t>(c - 'A');
        else if (c >= 'a' && c <= 'z')
            digit = static_cast<std::uint32_t>(c - 'a' + 26);
        else if (c >= '0' && c <= '9')
            digit = static_cast<std::uint32_t>(c - '0' + 52);
        else if (c == '+')
            digit = 62;
        else if (c == '/')
            digit = 63;
        else if (c == '=' && digits >= 2)
            ++padding;
        else if (Scanner::is_blank(c) || Scanner::is_line_end(c))
            continue;
        else
            fail(format("expected base64 text, found \"%s\"", printable({&c, 1}).c_str()));
        if (padding > 0 && c != '=') fail("expected the end of a base64 group, found more of it");
        bits = bits << 6 | digit;
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
