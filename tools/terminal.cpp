#include "terminal.hpp"

#include "paths.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#ifdef _WIN32
#if !defined(NOMINMAX) // MinGW's C++ library defines it
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <fcntl.h>
#include <io.h>
#else
#include <unistd.h>
#endif

namespace tool {

namespace {

bool is_terminal(std::FILE* file) {
#ifdef _WIN32
    return _isatty(_fileno(file)) != 0;
#else
    return isatty(fileno(file)) != 0;
#endif
}

bool lines = false; // progress as lines, also where standard error is no terminal

std::string repeated(std::string_view text, int count) {
    std::string result;
    for (int i = 0; i < count; ++i) result += text;
    return result;
}

// Blocks that fill 0 to 8 eighths of a character from below.
constexpr const char* columns_utf8[9] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
// Blocks that fill 0 to 7 eighths from the left.
constexpr const char* rows_utf8[8] = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};

} // namespace

#ifdef _WIN32

Console::Console() : code_page_(GetConsoleOutputCP()) {
    SetConsoleOutputCP(CP_UTF8);
    (void)_setmode(_fileno(stdout), _O_BINARY);
    const HANDLE terminal = GetStdHandle(STD_ERROR_HANDLE);
    DWORD mode = 0;
    if (GetConsoleMode(terminal, &mode))
        SetConsoleMode(terminal, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING); // Progress erases its line
}

Console::~Console() {
    std::fflush(stdout);
    SetConsoleOutputCP(code_page_);
}

#endif

Progress::Progress() : begin_(std::chrono::steady_clock::now()) {}

Progress::~Progress() { hide(); }

void Progress::show_always() { lines = !is_terminal(stderr); }

void Progress::show(const std::string& where) {
    const auto now = std::chrono::steady_clock::now();
    const bool due = lines ? !shown_ || now - last_ >= std::chrono::seconds(1)
                           : is_terminal(stderr) && now - begin_ >= std::chrono::milliseconds(500) &&
                                 now - last_ >= std::chrono::milliseconds(100);
    if (due) print(where);
}

void Progress::begin_reading(const std::string& path) {
    reading_ = "reading " + path;
    std::error_code error;
    const double bytes = static_cast<double>(std::filesystem::file_size(path_of(path), error));
    if (error) return; // the size of a pipe is unknown; if the file cannot be read, the reader says why
    char words[48];
    if (bytes < 1e6)
        std::snprintf(words, sizeof words, ", %.0f kB", std::ceil(bytes * 1e-3));
    else
        std::snprintf(words, sizeof words, ", %.0f MB", bytes * 1e-6);
    reading_ += words;
    // Readers take some tens of megabytes a second.
    if (lines || (is_terminal(stderr) && bytes > 1e7)) print(reading_);
}

void Progress::show_read(double fraction) {
    show(reading_ + ": " + std::to_string(static_cast<int>(100 * fraction)) + " %");
}

void Progress::hide() {
    if (lines || !shown_) return;
    std::fputs("\r\033[K", stderr);
    shown_ = false;
}

void Progress::print(const std::string& where) {
    std::fprintf(stderr, lines ? "vox: %s\n" : "\r\033[Kvox: %s", shown(where).c_str());
    std::fflush(stderr);
    shown_ = true;
    last_ = std::chrono::steady_clock::now();
}

std::string shown(const std::string& text) {
    std::string result;
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    const auto escape = [&](unsigned code) {
        char escaped[8];
        std::snprintf(escaped, sizeof escaped, "\\x%02x", code);
        result += escaped;
    };
    for (std::size_t i = 0; i < text.size();) {
        const unsigned c = byte(i);
        std::size_t length = c < 0x80 ? 1 : c < 0xc2 ? 0 : c < 0xe0 ? 2 : c < 0xf0 ? 3 : c < 0xf5 ? 4 : 0;
        for (std::size_t k = 1; k < length; ++k)
            if ((byte(i + k) & 0xc0) != 0x80) length = 0; // cut off: no character
        if (length == 0)
            result += "\xef\xbf\xbd";
        else if (c < 0x20 || c == 0x7f)
            escape(c);
        else if (c == 0xc2 && byte(i + 1) < 0xa0) // U+0080 to U+009F
            escape(byte(i + 1));
        else
            result.append(text, i, length);
        i += length > 0 ? length : 1;
    }
    return result;
}

std::string emphasised(const std::string& text) {
    const char* const off = std::getenv("NO_COLOR");
    if ((off && *off) || !is_terminal(stdout)) return text;
    return "\033[1;32m" + text + "\033[0m";
}

void warn_if_busy(std::chrono::duration<double> passed, double processor) {
    constexpr double share = 0.9;
    if (processor >= share * passed.count()) return;
    std::fprintf(
        stderr,
        "vox: warning: the machine is busy: of %.1f s of measuring, this process had a processor for "
        "%.1f s; times may be too long\n",
        passed.count(), processor);
}

bool locale_is_utf8() {
#ifdef _WIN32
    return true; // see Console
#else
    // The first of these that is set and not empty decides, as POSIX specifies.
    for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
        const char* value = std::getenv(variable);
        if (!value || !*value) continue;
        std::string name = value;
        std::transform(name.begin(), name.end(), name.begin(),
                       [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
        return name.find("utf-8") != std::string::npos || name.find("utf8") != std::string::npos;
    }
    return false;
#endif
}

std::string bar(double fraction, int width) {
    fraction = std::clamp(fraction, 0.0, 1.0);
    if (!locale_is_utf8()) {
        const int length = static_cast<int>(std::lround(fraction * width));
        return repeated("#", fraction > 0 ? std::max(length, 1) : 0);
    }
    int eighths = static_cast<int>(std::lround(fraction * width * 8));
    if (fraction > 0) eighths = std::max(eighths, 1);
    return repeated("█", eighths / 8) + rows_utf8[eighths % 8];
}

std::string cost_curve(const vox_cell_size_result& found) {
    const int columns = static_cast<int>(found.curve_count);
    if (columns < 2) return {};
    const bool utf8 = locale_is_utf8();
    // The chart goes from 0 to three times the minimum, because the interesting part is near the minimum.
    constexpr int height = 8;
    constexpr double top = 3;
    const char* indent = "       ";

    std::string text;
    for (int row = height; row >= 1; --row) {
        char label[16] = "";
        const double level = top * row / height;
        if (row == height) std::snprintf(label, sizeof label, ">%.0fx", level);
        if (std::abs(level - 1.5) < 1e-9) std::snprintf(label, sizeof label, "%.1fx", level);
        char head[32];
        std::snprintf(head, sizeof head, "%6s ", label);
        text += head;
        std::string line;
        for (int column = 0; column < columns; ++column) {
            const double cost = found.curve[column].cost / found.cost;
            const int eighths = static_cast<int>(std::lround(cost / top * height * 8)) - (row - 1) * 8;
            if (utf8)
                line += columns_utf8[std::clamp(eighths, 0, 8)];
            else
                line += eighths >= 4 ? '#' : ' ';
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    }

    // The samples are evenly spaced in the logarithm of the cell size, which gives the column of a cell size.
    const double first = std::log(found.curve[0].cell_size);
    const double last = std::log(found.curve[columns - 1].cell_size);
    const auto column_of = [&](double cell_size) {
        const double place = (std::log(cell_size) - first) / (last - first) * (columns - 1);
        return std::clamp(static_cast<int>(std::lround(place)), 0, columns - 1);
    };
    const int zone_begin = column_of(found.zone_min), zone_end = column_of(found.zone_max);
    const int best = std::clamp(column_of(found.cell_size), zone_begin, zone_end);
    text += indent + repeated(" ", zone_begin) + repeated(utf8 ? "─" : "-", best - zone_begin) +
            (utf8 ? "▲" : "^") + repeated(utf8 ? "─" : "-", zone_end - best) + "\n";

    char left[32], right[32], middle[48];
    std::snprintf(left, sizeof left, "%.3g", found.curve[0].cell_size);
    std::snprintf(right, sizeof right, "%.3g", found.curve[columns - 1].cell_size);
    std::snprintf(middle, sizeof middle, "%.4g", found.cell_size);
    std::string scale(static_cast<std::size_t>(columns), ' ');
    const auto write = [&](int column, const char* words) {
        const std::string_view word = words;
        const int begin = std::clamp(column, 0, std::max(0, columns - static_cast<int>(word.size())));
        for (std::size_t i = 0; i < word.size(); ++i) {
            const std::size_t at = static_cast<std::size_t>(begin) + i;
            if (at < scale.size()) scale[at] = word[i];
        }
    };
    write(0, left);
    write(columns, right);
    write(best - static_cast<int>(std::string_view(middle).size()) / 2, middle);
    return text + indent + scale + "\n";
}

} // namespace tool
