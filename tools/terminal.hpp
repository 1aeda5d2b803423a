// Output for people: progress on standard error, and bars and curves made of characters.
#pragma once

#include <vox/vox_cell_size.h>

#include <chrono>
#include <string>

namespace tool {

#ifdef _WIN32
// While it exists, output is UTF-8 and, as on other systems, unchanged to the byte, without carriage
// returns.
class Console {
public:
    Console();
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

private:
    unsigned code_page_;
};
#endif

// A line on standard error that overwrites itself, e.g. "vox: step 3 of 100". It is shown only on a terminal,
// and only after half a second, so that short work shows nothing. The destructor erases it. After
// show_always() it is shown elsewhere, too, as lines of their own: the first at once, the next ones after a
// second each.
class Progress {
public:
    Progress();
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    static void show_always();

    void show(const std::string& where);
    // Names the file and its size, at once if it is so large that reading it will take long.
    void begin_reading(const std::string& path);
    // Shows which fraction of the work is done, too.
    void show_read(double fraction);
    // Erases the line, before something else is printed where it may stand.
    void hide();

private:
    void print(const std::string& where);

    bool shown_ = false;
    std::string reading_;
    std::chrono::steady_clock::time_point begin_, last_;
};

// Text for a terminal, of which file names and files' contents are a part: with control characters as \x1b,
// so that they do nothing there, and U+FFFD in the place of bytes that are not UTF-8.
std::string shown(const std::string& text);

// The text in bold on a terminal; as it is elsewhere, or where NO_COLOR is set (no-color.org).
std::string emphasised(const std::string& text);

// Warns if others had the processors for a good part of the time: caches are then shared, too, and what
// several threads need cannot be told from waiting.
void warn_if_busy(std::chrono::duration<double> passed, double processor);

// Whether the locale of the environment can print the block and line characters of Unicode.
bool locale_is_utf8();

// A horizontal bar of at most `width` characters for a fraction in [0, 1].
std::string bar(double fraction, int width);

// The predicted cost over the cell size, one column a sample, with the zone and the suggestion marked below.
std::string cost_curve(const vox_cell_size_result& found);

} // namespace tool
