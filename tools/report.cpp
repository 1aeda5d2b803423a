#include "report.hpp"

#include "failure.hpp"
#include "grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace tool {

namespace {

// The library gives cell size 0 for a rule that does not apply.
Json rule(double cell_size) { return cell_size > 0 ? Json(cell_size) : Json(); }

Json rules(const vox_cell_size_rules& rules) {
    return {{"mean_edge", rule(rules.mean_edge)},     {"mean_edge_multiple", rule(rules.mean_edge_multiple)},
            {"object_512", rule(rules.object_512)},   {"resolution", rule(rules.resolution)},
            {"mean_volume", rule(rules.mean_volume)}, {"median_box_side", rule(rules.median_box_side)}};
}

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

Json bounds(const double (&min)[3], const double (&max)[3]) {
    return {{"min", Json::array_of(min)}, {"max", Json::array_of(max)}};
}

Json stats(const vox_geometry_stats& stats) {
    return {{"vertices", stats.vertices},
            {"tets", stats.tets},
            {"edges", stats.edges},
            {"facets", stats.facets},
            {"boundary_facets", stats.boundary_facets},
            {"degenerate_tets", stats.degenerate_tets},
            {"mean_edge", stats.mean_edge},
            {"mean_longest_edge", stats.mean_longest_edge},
            {"mean_box_side", stats.mean_box_side},
            {"median_box_side", stats.median_box_side},
            {"mean_facet_area", stats.mean_facet_area},
            {"mean_tet_facet_area", stats.mean_tet_facet_area},
            {"mean_boundary_facet_area", stats.mean_boundary_facet_area},
            {"mean_volume", stats.mean_volume},
            {"bounds", bounds(stats.bounds_min, stats.bounds_max)}};
}

Json curve(std::span<const vox_cost_sample> samples) {
    Json list = Json::array();
    for (const vox_cost_sample& sample : samples)
        list.push_back({{"cell_size", sample.cell_size}, {"cost", sample.cost}});
    return list;
}

bool collides(const vox_suggestion& suggestion) { return suggestion.predicted_cost > 0; }

void add_suggestion(Json& json, const vox_suggestion& suggestion) {
    json.add("cell_size", suggestion.cell_size);
    json.add("cells_per_axis", suggestion.cells_per_axis);
    const bool has_zone = collides(suggestion);
    json.add("zone", {{"min", has_zone ? Json(suggestion.zone_min) : Json()},
                      {"max", has_zone ? Json(suggestion.zone_max) : Json()}});
    json.add("collides", has_zone);
    json.add("predicted_cost", suggestion.predicted_cost);
    json.add("model", model_name(suggestion.model));
    json.add("rules", rules(suggestion.rules));
    json.add("stats", stats(suggestion.stats));
    json.add("curve", curve({suggestion.curve, suggestion.curve_count}));
    json.add("rule_costs", rules(suggestion.rule_costs));
    Json terms = Json::array();
    for (std::uint32_t i = 0; i < suggestion.term_count; ++i) {
        const vox_cost_share& term = suggestion.terms[i];
        terms.push_back(
            {{"name", term.name}, {"count", term.count}, {"cost", term.cost}, {"share", term.share}});
    }
    json.add("terms", terms);
    json.add("uniform_loss", suggestion.uniform_loss);
    Json levels = Json::array();
    for (std::uint32_t i = 0; i < suggestion.level_count; ++i) levels.push_back(suggestion.levels[i]);
    json.add("levels", levels);
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
        list.push_back(
            {{"file", body.name}, {"vertices", body.view.vertex_count}, {"tets", body.view.tet_count}});
    return list;
}

std::size_t place_of(const std::vector<vox_body>& ids, vox_body mesh) {
    return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), mesh) - ids.begin());
}

std::string hexadecimal(std::uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
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
