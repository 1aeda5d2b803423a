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
// In light and in dark.
constexpr const char* style =
    "<style>.paper{fill:#fff}text{fill:#222}.dim{fill:#666}.line{stroke:#ddd}.curve{fill:none;stroke:#1f6fb2;"
    "stroke-width:2.5}.zone{fill:#dcebdc}.best{fill:#2c7a2c}.rule{fill:#b0762b;stroke:#b0762b;stroke-"
    "dasharray:3 3}"
    ".label{fill:#7d5015;paint-order:stroke;stroke:#fff;stroke-width:4}"
    "@media "
    "(prefers-color-scheme:dark){.paper{fill:#14171c}text{fill:#ddd}.dim{fill:#999}.line{stroke:#333842}"
    ".curve{stroke:#64a8e0}.zone{fill:#1f3326}.best{fill:#6cc47a}.rule{fill:#d9a05a;stroke:#d9a05a}"
    ".label{fill:#e8bd85;stroke:#14171c}}</style>\n";

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
    double y(double cost) const { return height - below - cost / least_ / top * (height - above - below); }
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

// The distance of at most eight numbers 1, 2, 3, ..., 2, 4, 6, ... or 5, 10, 15, ... along an axis up to
// `last`.
double tick_step(double last) {
    const double least = last / 8, power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * power >= least) return digit * power;
    return 10 * power;
}

// The costs that the axis shows, with a line each.
void add_costs(std::string& text, const Axes& axes, const CurveWords& words) {
    add(text, "<text transform=\"translate(20 %g) rotate(-90)\" text-anchor=\"middle\">",
        (above + height - below) / 2);
    text += xml_text(words.axis) + "</text>\n";
    const double unit = words.unit > 0 ? words.unit : axes.least();
    const double last = top * axes.least() / unit, step = words.unit > 0 ? tick_step(last) : 1;
    for (int i = 0; i * step <= last; ++i) {
        const double y = axes.y(i * step * unit);
        add(text, "<line x1=\"%g\" y1=\"%.2f\" x2=\"%g\" y2=\"%.2f\" class=\"line\"/>\n", left, y,
            width - right, y);
        add(text, "<text x=\"%g\" y=\"%.2f\" text-anchor=\"end\">%.6g%s</text>\n", left - 8, y + 4, i * step,
            words.unit > 0 ? "" : "&#215;");
    }
}

// What each rule costs: a label to a row, inward, the outermost first, so that hardly a line crosses a label.
void add_rules(std::string& text, const Axes& axes, std::span<const vox_cell_size_rule> rules) {
    constexpr double middle = (left + width - right) / 2, row = 18;
    std::vector<const vox_cell_size_rule*> shown;
    for (const vox_cell_size_rule& rule : rules)
        if (axes.shows(rule.cell_size) && axes.y(rule.cost) > above) shown.push_back(&rule);
    const auto aside = [&](const vox_cell_size_rule* rule) {
        return std::abs(axes.x(rule->cell_size) - middle);
    };
    std::sort(shown.begin(), shown.end(), [&](auto* a, auto* b) { return aside(a) > aside(b); });
    double label = above + row;
    std::string labels; // over all lines
    for (const vox_cell_size_rule* rule : shown) {
        const double x = axes.x(rule->cell_size), y = axes.y(rule->cost);
        const bool on_right = x > middle;
        add(text,
            "<path class=\"rule\" d=\"M%.2f %.2fV%.2f\"/>\n<circle class=\"rule\" cx=\"%.2f\" cy=\"%.2f\" "
            "r=\"4\"/>\n",
            x, label, y, x, y);
        add(labels, "<text class=\"label\" x=\"%.2f\" y=\"%.2f\" text-anchor=\"%s\">%s, %+.0f %%</text>\n",
            on_right ? x - 6 : x + 6, label + 4, on_right ? "end" : "start", rule->name,
            100 * (rule->cost / axes.least() - 1));
        label += row;
    }
    text += labels;
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

std::string curve_svg(const vox_cell_size_result& c, const CurveWords& words) {
    const Axes axes(c);
    const double floor_y = height - below;
    std::string text;
    add(text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" font-family=\"sans-serif\" "
        "font-size=\"13\">\n<title>%s</title>\n",
        width, height, xml_text(words.title).c_str());
    text += style;
    add(text, "<rect class=\"paper\" width=\"%g\" height=\"%g\"/>\n", width, height);
    add(text, "<clipPath id=\"frame\"><rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\"/></clipPath>\n",
        left, above, width - left - right, floor_y - above);
    add(text, "<text x=\"%g\" y=\"24\" font-size=\"17\">%s</text>\n", left, xml_text(words.title).c_str());
    add(text, "<text x=\"%g\" y=\"46\" class=\"dim\">", left);
    text += xml_text(words.below) + "</text>\n";
    add(text, "<rect x=\"%.2f\" y=\"%g\" width=\"%.2f\" height=\"%.2f\" class=\"zone\"/>\n",
        axes.x(c.zone_min), above, axes.x(c.zone_max) - axes.x(c.zone_min), floor_y - above);
    add_costs(text, axes, words);
    for (const double size : round_sizes(c)) {
        add(text, "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" class=\"line\"/>\n", axes.x(size),
            floor_y, axes.x(size), floor_y + 5);
        add(text, "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"middle\">%g</text>\n", axes.x(size),
            floor_y + 20, size);
    }
    add(text, "<text x=\"%g\" y=\"%g\" text-anchor=\"middle\">cell size</text>\n", (left + width - right) / 2,
        height - 12);
    text += "<polyline class=\"curve\" clip-path=\"url(#frame)\" points=\"";
    for (const vox_cost_sample& sample : std::span(c.curve).first(c.curve_count))
        add(text, "%.2f,%.2f ", axes.x(sample.cell_size), axes.y(sample.cost));
    text += "\"/>\n";

    add(text, "<text x=\"%.2f\" y=\"%g\" text-anchor=\"middle\" class=\"best\">nearly as good</text>\n",
        (axes.x(c.zone_min) + axes.x(c.zone_max)) / 2, floor_y - 10);
    for (const vox_timing& timing : std::span(c.timings).first(c.timing_count))
        if (axes.shows(timing.cell_size) && axes.y(timing.seconds) > above)
            add(text, "<circle class=\"dim\" cx=\"%.2f\" cy=\"%.2f\" r=\"3\"/>\n", axes.x(timing.cell_size),
                axes.y(timing.seconds));
    add_rules(text, axes, std::span(c.rules).first(c.rule_count));
    add(text, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"6\" class=\"best\"/>\n", axes.x(c.cell_size),
        axes.y(c.cost));
    add(text, "<text x=\"%.2f\" y=\"%.2f\" text-anchor=\"middle\" class=\"best\">%.4g</text>\n",
        axes.x(c.cell_size), axes.y(c.cost) + 22, c.cell_size);
    text += "</svg>\n";
    return text;
}

} // namespace tool
