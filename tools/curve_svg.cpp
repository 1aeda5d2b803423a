#include "curve_svg.hpp"

#include "paths.hpp"
#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <span>
#include <vector>

namespace tool {

namespace {

// The size and margins of the picture, in its own units.
constexpr double width = 800, height = 480, left = 76, right = 24, above = 64, below = 56;
// Costs are drawn from 0 to this many times the minimum.
constexpr double top = 4;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void
add(std::string& text, const char* pattern, ...) {
    char line[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(line, sizeof line, pattern, arguments);
    va_end(arguments);
    text += line;
}

class Axes {
public:
    explicit Axes(const vox_cell_size_result& c)
        : first_(std::log(c.curve[0].cell_size)), last_(std::log(c.curve[c.curve_count - 1].cell_size)),
          least_(c.cost) {}

    double x(double cell_size) const {
        const double part = (std::log(cell_size) - first_) / (last_ - first_);
        return left + std::clamp(part, 0.0, 1.0) * (width - left - right);
    }
    double y(double cost) const {
        const double part = std::min(cost / least_, top) / top;
        return height - below - part * (height - above - below);
    }
    bool shows(double cell_size) const {
        return cell_size > 0 && std::log(cell_size) >= first_ && std::log(cell_size) <= last_;
    }
    double least() const { return least_; }

private:
    double first_, last_, least_;
};

// The numbers 1, 2, 5, 10, ... within the range of the axis.
std::vector<double> round_sizes(const vox_cell_size_result& c) {
    std::vector<double> sizes;
    const double from = c.curve[0].cell_size, to = c.curve[c.curve_count - 1].cell_size;
    for (int exponent = static_cast<int>(std::floor(std::log10(from))); std::pow(10.0, exponent) <= to;
         ++exponent)
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double size = digit * std::pow(10.0, exponent);
            if (size >= from && size <= to) sizes.push_back(size);
        }
    return sizes;
}

} // namespace

std::string short_names(const std::vector<std::string>& files) {
    constexpr std::size_t most = 3;
    std::string names;
    for (std::size_t i = 0; i < std::min(files.size(), most); ++i)
        names += (i == 0 ? "" : ", ") + utf8_of(path_of(files[i]).filename());
    if (files.size() > most) names += " and " + std::to_string(files.size() - most) + " more";
    return names;
}

std::string curve_svg(const vox_cell_size_result& c, const std::string& words) {
    const Axes axes(c);
    const double floor_y = height - below;
    std::string text;
    add(text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" font-family=\"sans-serif\" "
        "font-size=\"13\">\n<title>Predicted cost over cell size</title>\n<rect width=\"%g\" height=\"%g\" "
        "fill=\"white\"/>\n",
        width, height, width, height);
    add(text, "<text x=\"%g\" y=\"24\" font-size=\"17\">Predicted cost over cell size</text>\n", left);
    add(text, "<text x=\"%g\" y=\"46\" fill=\"#555\">", left);
    text += xml_text(words) + "</text>\n";
    add(text,
        "<text transform=\"translate(20 %g) rotate(-90)\" text-anchor=\"middle\">cost, in units of the "
        "least</text>\n",
        (above + floor_y) / 2);
    add(text, "<rect x=\"%.2f\" y=\"%g\" width=\"%.2f\" height=\"%.2f\" fill=\"#dcebdc\"/>\n",
        axes.x(c.zone_min), above, axes.x(c.zone_max) - axes.x(c.zone_min), floor_y - above);
    for (int times = 0; times <= static_cast<int>(top); ++times) {
        const double y = axes.y(times * axes.least());
        add(text, "<line x1=\"%g\" y1=\"%.2f\" x2=\"%g\" y2=\"%.2f\" stroke=\"#ddd\"/>\n", left, y,
            width - right, y);
        add(text, "<text x=\"%g\" y=\"%.2f\" text-anchor=\"end\">%d&#215;</text>\n", left - 8, y + 4, times);
    }
    for (const double size : round_sizes(c)) {
        add(text, "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" stroke=\"#888\"/>\n", axes.x(size),
            floor_y, axes.x(size), floor_y + 5);
        add(text, "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"middle\">%g</text>\n", axes.x(size),
            floor_y + 20, size);
    }
    add(text, "<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">cell size</text>\n", (left + width - right) / 2,
        height - 12);
    text += "<polyline fill=\"none\" stroke=\"#1f5fa8\" stroke-width=\"2.5\" points=\"";
    for (const vox_cost_sample& sample : std::span(c.curve).first(c.curve_count))
        add(text, "%.2f,%.2f ", axes.x(sample.cell_size), axes.y(sample.cost));
    text += "\"/>\n";

    double label = above + 16; // labels are placed one below the other, so that they never overlap
    for (const vox_cell_size_rule& rule : std::span(c.rules).first(c.rule_count)) {
        if (!axes.shows(rule.cell_size)) continue;
        const double x = axes.x(rule.cell_size), y = axes.y(rule.cost);
        add(text,
            "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" stroke=\"#b0762b\" stroke-dasharray=\"3 "
            "3\"/>\n",
            x, label, x, y);
        add(text, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"4\" fill=\"#b0762b\"/>\n", x, y);
        const bool on_left = x > (left + width - right) / 2;
        add(text, "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"%s\" fill=\"#7d5015\">%s, %+.0f %%</text>\n",
            on_left ? x - 6 : x + 6, label + 4, on_left ? "end" : "start", rule.name,
            100 * (rule.cost / axes.least() - 1));
        label += 18;
    }
    add(text, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"6\" fill=\"#2c7a2c\"/>\n", axes.x(c.cell_size),
        axes.y(c.cost));
    add(text, "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"middle\" fill=\"#1f5c1f\">%.4g</text>\n",
        axes.x(c.cell_size), axes.y(c.cost) + 22, c.cell_size);
    text += "</svg>\n";
    return text;
}

} // namespace tool
