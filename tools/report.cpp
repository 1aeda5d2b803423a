#include "report.hpp"

#include "failure.hpp"
#include "grid.hpp"
#include "terminal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <span>

namespace tool {

namespace {

// The library returns 0 if there is no number.
Json number(double value) { return value > 0 ? Json(value) : Json(); }

Json constraints(const vox_grid* grid, const std::vector<vox_body>& ids) {
    Json list = Json::array();
    for (const vox_constraint& c : constraints_of(grid))
        list.push_back({{"kind", kind_name(c.kind)},
                        {"state", state_name(c.state)},
                        {"body_a", place_of(ids, c.body_a)},
                        {"body_b", place_of(ids, c.body_b)},
                        {"count_a", c.count_a},
                        {"vertices", Json::array_of(std::span(c.vertices).first(c.count))},
                        {"weights", Json::array_of(std::span(c.weights).first(c.count))},
                        {"element_b", c.element_b},
                        {"gap", c.gap},
                        {"normal", Json::array_of(c.normal)},
                        {"position", Json::array_of(c.position)},
                        {"time", c.time}});
    return list;
}

} // namespace

const char* kind_name(vox_constraint_kind kind) {
    switch (kind) {
    case VOX_CONSTRAINT_INSIDE:
        return "inside";
    case VOX_CONSTRAINT_EDGE:
        return "edge";
    case VOX_CONSTRAINT_PROXIMITY:
        return "proximity";
    case VOX_CONSTRAINT_IMPACT:
        break;
    }
    return "impact";
}

const char* model_name(vox_cost_model model) {
    switch (model) {
    case VOX_COST_MODEL_PAPER:
        return "paper";
    case VOX_COST_MODEL_REFERENCE:
        return "reference";
    case VOX_COST_MODEL_FAST:
        return "fast";
    case VOX_COST_MODEL_SURFACE:
        return "surface";
    }
    return "unknown";
}

const char* state_name(vox_depth_state state) {
    switch (state) {
    case VOX_DEPTH_SURFACE:
        return "surface";
    case VOX_DEPTH_PROPAGATED:
        return "propagated";
    case VOX_DEPTH_CLOSEST:
        return "closest";
    case VOX_DEPTH_AMBIGUOUS:
        return "ambiguous";
    case VOX_DEPTH_TOUCHING:
        return "touching";
    case VOX_DEPTH_PLANE:
        return "plane";
    case VOX_DEPTH_UNKNOWN:
        break;
    }
    return "unknown";
}

void print_rest(std::uint64_t count) {
    if (count > 0)
        std::printf("  and %llu more (--limit N prints N of them, --json all of them)\n", llu(count));
}

Json bounds(const double (&min)[3], const double (&max)[3]) {
    return {{"min", Json::array_of(min)}, {"max", Json::array_of(max)}};
}

Json geometry(const vox_geometry& geometry) {
    return {{"vertices", geometry.vertices},
            {"tets", geometry.tets},
            {"edges", geometry.edges},
            {"facets", geometry.facets},
            {"boundary_facets", geometry.boundary_facets},
            {"degenerate_tets", geometry.degenerate_tets},
            {"mean_edge", geometry.mean_edge},
            {"mean_longest_edge", geometry.mean_longest_edge},
            {"mean_box_side", geometry.mean_box_side},
            {"median_box_side", geometry.median_box_side},
            {"mean_facet_area", geometry.mean_facet_area},
            {"mean_tet_facet_area", geometry.mean_tet_facet_area},
            {"mean_boundary_facet_area", geometry.mean_boundary_facet_area},
            {"mean_volume", geometry.mean_volume},
            {"bounds", bounds(geometry.bounds_min, geometry.bounds_max)}};
}

Json curve(const vox_cell_size_result& result) {
    Json list = Json::array();
    for (const vox_cost_sample& sample : std::span(result.curve).first(result.curve_count))
        list.push_back({{"cell_size", sample.cell_size}, {"cost", sample.cost}});
    return list;
}

void add_report(Json& json, const vox_io_report& report, const std::vector<std::string>& warnings) {
    json.add("format", vox_io_format_string(report.format));
    const std::pair<const char*, std::uint64_t> counts[] = {
        {"vertices", report.vertices},
        {"tets", report.tets},
        {"triangles", report.triangles},
        {"surface_triangles", report.boundary_facets},
        {"inverted", report.inverted_tets},
        {"degenerate", report.degenerate_tets},
        {"duplicate_vertices", report.duplicate_vertices},
        {"nearly_flat", report.nearly_flat_tets},
        {"duplicate_tets", report.duplicate_tets},
        {"degenerate_triangles", report.degenerate_triangles},
        {"unused_vertices", report.unused_vertices},
        {"left_out_vertices", report.left_out_vertices},
        {"left_out_triangles", report.left_out_triangles},
        {"left_out_tets", report.left_out_tets},
        {"split_cells", report.split_cells},
        {"non_manifold_facets", report.non_manifold_facets},
        {"open_edges", report.open_edges},
        {"misoriented_edges", report.misoriented_edges},
        {"components", report.components},
        {"skipped_elements", report.skipped_elements},
        {"second_order_tets", report.second_order_tets}};
    for (const auto& [name, count] : counts) json.add(name, count);
    json.add("volume", report.volume);
    json.add("unit_in_metres", number(report.unit_in_metres));
    json.add("bounds", bounds(report.bounds_min, report.bounds_max));
    json.add("warnings", Json::array_of(warnings));
}

Json report_json(const vox_io_report& report, const std::vector<std::string>& warnings) {
    Json json = Json::object();
    add_report(json, report, warnings);
    return json;
}

bool collides(const vox_cell_size_result& result) { return result.cost > 0; }

void add_suggestion(Json& json, const vox_cell_size_result& result) {
    const bool has_zone = collides(result);
    json.add("cell_size", result.cell_size);
    json.add("zone_min", has_zone ? Json(result.zone_min) : Json());
    json.add("zone_max", has_zone ? Json(result.zone_max) : Json());
    json.add("cost", result.cost);
    json.add("min_cell_size", result.min_cell_size);
    json.add("cells_per_axis", number(result.cells_per_axis));
    json.add("fit_error", result.fit_error);
    json.add("expected_loss", result.expected_loss);
    json.add("curve", curve(result));
    Json terms = Json::array(), rules = terms, timings = terms;
    for (const vox_cost_term& term : std::span(result.terms).first(result.term_count))
        terms.push_back({{"name", term.name}, {"count", term.count}, {"cost", term.cost}});
    for (const vox_cell_size_rule& rule : std::span(result.rules).first(result.rule_count))
        rules.push_back(
            {{"name", rule.name}, {"cell_size", number(rule.cell_size)}, {"cost", number(rule.cost)}});
    for (const vox_timing& timing : std::span(result.timings).first(result.timing_count))
        timings.push_back({{"cell_size", timing.cell_size}, {"seconds", timing.seconds}});
    json.add("terms", terms);
    json.add("rules", rules);
    json.add("timings", timings);
    const vox_foreign_weights& w = result.weights;
    json.add("weights", {{"run", w.run},
                         {"store", w.store},
                         {"visit", w.visit},
                         {"found", w.found},
                         {"read", w.read},
                         {"occupied", w.occupied},
                         {"cell", w.cell}});
    json.add("warnings", result.warnings);
    json.add("note", result.note);
}

void add_suggestion(Json& json, const vox_cell_size_result& result, vox_cost_model model,
                    const vox_geometry& measured) {
    add_suggestion(json, result);
    json.add("collides", collides(result));
    json.add("model", model_name(model));
    json.add("geometry", geometry(measured));
}

void print_reasons(const vox_cell_size_result& result, double mean_edge) {
    std::printf("Predicted cost over cell size, in units of the minimum (logarithmic in cell size):\n%s",
                cost_curve(result).c_str());
    const auto print_rule = [&](const char* name, double cell_size, double cost) {
        if (!(cell_size > 0)) return;
        std::printf("  %-48s %-12.4g", name, cell_size);
        if (mean_edge > 0) std::printf(" %6.2f", cell_size / mean_edge);
        if (cost > 0) std::printf(" %+7.0f %%", 100 * (cost / result.cost - 1));
        std::printf("\n");
    };
    if (result.rule_count > 0) {
        std::printf("\n  %-48s %-12s%s %9s\n", "rule", "cell size", mean_edge > 0 ? "  edges" : "", "cost");
        print_rule("this suggestion", result.cell_size, result.cost);
    }
    for (const vox_cell_size_rule& rule : std::span(result.rules).first(result.rule_count))
        print_rule(rule.name, rule.cell_size, rule.cost);
    std::vector<vox_cost_term> terms(result.terms, result.terms + result.term_count);
    std::erase_if(terms, [](const vox_cost_term& term) { return !(term.cost > 0); });
    std::ranges::sort(terms, std::greater(), &vox_cost_term::cost);
    if (!terms.empty()) std::printf("\nWhat the cost is made of:\n");
    for (const vox_cost_term& term : terms)
        std::printf("  %-22s %12.4g times %5.1f %%  %s\n", term.name, term.count,
                    100 * term.cost / result.cost, bar(term.cost / result.cost, 30).c_str());
    if (*result.note) std::printf("\n%s\n", result.note);
}

void add_collision(Json& json, const vox_grid* grid, const std::vector<vox_body>& ids,
                   const Counters& times) {
    Json contacts = Json::array();
    for (const vox_contact& contact : contacts_of(grid))
        contacts.push_back({{"body_a", place_of(ids, contact.body_a)},
                            {"vertex", contact.vertex},
                            {"body_b", place_of(ids, contact.body_b)},
                            {"tet", contact.tet}});
    json.add("contact_count", contacts_of(grid).size());
    json.add("contacts", contacts);
    json.add("constraints", constraints(grid, ids));
    add_result(json, grid, times);
}

void add_result(Json& json, const vox_grid* grid, const Counters& times) {
    Json profile = Json::object(), counters = Json::object();
    for (const vox_counter& c : times)
        if (is_time(c)) profile.add(c.name, c.value);
    for (const vox_counter& c : counters_of(grid))
        if (!is_time(c)) counters.add(c.name, c.value);
    const vox_grid_info info = info_of(grid);
    counters.add("bytes", info.bytes);
    counters.add("peak_bytes", info.peak_bytes);
    counters.add("moved_bodies", info.moved_bodies);
    counters.add("skipped_bodies", info.skipped_bodies);
    counters.add("total_began", info.total_began);
    counters.add("total_ended", info.total_ended);
    json.add("hash", hexadecimal(hash_of(grid)));
    json.add("profile", profile);
    json.add("counters", counters);
}

Json body_list(const std::vector<Body>& bodies) {
    Json list = Json::array();
    for (const Body& body : bodies)
        list.push_back({{"file", body.name},
                        {"vertices", body.view.vertex_count},
                        {"tets", body.view.tet_count},
                        {"report", report_json(body.report, body.warnings)}});
    return list;
}

std::size_t place_of(const std::vector<vox_body>& ids, vox_body mesh) {
    return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), mesh) - ids.begin());
}

std::string hexadecimal(std::uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", llu(value));
    return text;
}

std::string xml_text(const std::string& text) {
    std::string result;
    for (const char c : valid_utf8(text)) switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += c >= 0 && c < ' ' ? '?' : c;
        }
    return result;
}

void print(const Json& json) {
    const std::string text = json.text() + "\n";
    std::fwrite(text.data(), 1, text.size(), stdout);
}

void finish_output() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw Failure(std::string("cannot write to standard output: ") + std::strerror(errno));
}

} // namespace tool
