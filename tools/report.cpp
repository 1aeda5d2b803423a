#include "report.hpp"

#include "failure.hpp"
#include "stepping.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace tool {

namespace {

// The library gives cell size 0 for a rule that does not apply.
Json rule(double cell_size) { return cell_size > 0 ? number(cell_size) : Json(nullptr); }

Json rules(const vox_cell_size_rules& rules) {
    return {{"mean_edge", rule(rules.mean_edge)},     {"mean_edge_multiple", rule(rules.mean_edge_multiple)},
            {"object_512", rule(rules.object_512)},   {"resolution", rule(rules.resolution)},
            {"mean_volume", rule(rules.mean_volume)}, {"median_box_side", rule(rules.median_box_side)}};
}

Json stats(const vox_geometry_stats& stats) {
    return {{"vertices", stats.vertices},
            {"tets", stats.tets},
            {"edges", stats.edges},
            {"facets", stats.facets},
            {"boundary_facets", stats.boundary_facets},
            {"degenerate_tets", stats.degenerate_tets},
            {"mean_edge", number(stats.mean_edge)},
            {"mean_longest_edge", number(stats.mean_longest_edge)},
            {"mean_box_side", number(stats.mean_box_side)},
            {"median_box_side", number(stats.median_box_side)},
            {"mean_facet_area", number(stats.mean_facet_area)},
            {"mean_tet_facet_area", number(stats.mean_tet_facet_area)},
            {"mean_boundary_facet_area", number(stats.mean_boundary_facet_area)},
            {"mean_volume", number(stats.mean_volume)},
            {"bounds", bounds(stats.bounds_min, stats.bounds_max)}};
}

Json counters_json(const vox_counters& counters) {
    return {{"meshes", counters.meshes},
            {"vertices", counters.vertices},
            {"tets", counters.tets},
            {"cells", counters.cells},
            {"entries", counters.entries},
            {"fullest_cell", counters.fullest_cell},
            {"visited_cells", counters.visited_cells},
            {"visited_entries", counters.visited_entries},
            {"candidates", counters.candidates},
            {"exact_tests", counters.exact_tests},
            {"contacts", counters.contacts},
            {"skipped_degenerate", counters.skipped_degenerate},
            {"bytes", counters.bytes},
            {"peak_bytes", counters.peak_bytes},
            {"moved_meshes", counters.moved_meshes},
            {"carried_contacts", counters.carried_contacts},
            {"penetrations", counters.penetrations},
            {"leaving_edges", counters.leaving_edges},
            {"edge_tests", counters.edge_tests},
            {"closest_searches", counters.closest_searches},
            {"closest_tests", counters.closest_tests},
            {"disabled_meshes", counters.disabled_meshes},
            {"filtered", counters.filtered},
            {"cell_size_changes", counters.cell_size_changes},
            {"unknown_penetrations", counters.unknown_penetrations},
            {"carried_penetrations", counters.carried_penetrations},
            {"skipped_meshes", counters.skipped_meshes},
            {"meshes_without_tets", counters.meshes_without_tets},
            {"total_touches_began", counters.total_touches_began},
            {"total_touches_ended", counters.total_touches_ended},
            {"total_contacts_began", counters.total_contacts_began},
            {"total_contacts_ended", counters.total_contacts_ended},
            {"edge_contacts", counters.edge_contacts},
            {"carried_edge_contacts", counters.carried_edge_contacts},
            {"edge_candidates", counters.edge_candidates},
            {"margin_contacts", counters.margin_contacts},
            {"carried_margin_contacts", counters.carried_margin_contacts},
            {"passages", counters.passages}};
}

Json penetrations(const vox_grid* grid, const std::vector<vox_mesh>& ids) {
    const vox_penetration_view view = penetrations_of(grid);
    Json list = Json::array();
    for (std::uint64_t i = 0; i < view.count; ++i) {
        const vox_penetration p = penetration_at(view, i);
        list.push_back(
            {{"mesh_a", place_of(ids, p.mesh_a)},
             {"vertex", p.vertex},
             {"mesh_b", place_of(ids, p.mesh_b)},
             {"state", state_name(p.state)},
             {"contact", p.contact},
             {"depth", number(p.depth)},
             {"direction", {number(p.direction[0]), number(p.direction[1]), number(p.direction[2])}}});
    }
    return list;
}

Json edge_contacts(const vox_grid* grid, const std::vector<vox_mesh>& ids) {
    const vox_edge_contact_view view = edge_contacts_of(grid);
    const vox_depth_view depths = edge_depths_of(grid);
    Json list = Json::array();
    for (std::uint64_t i = 0; i < view.count; ++i) {
        const vox_edge_contact c = edge_contact_at(view, i);
        const vox_depth depth = depth_at(depths, i);
        list.push_back({{"mesh_a", place_of(ids, c.mesh_a)},
                        {"edge", {c.edge[0], c.edge[1]}},
                        {"mesh_b", place_of(ids, c.mesh_b)},
                        {"face", {c.face[0], c.face[1], c.face[2]}},
                        {"tet", c.tet},
                        {"kind", kind_name(c.kind)},
                        {"edge_weights", {number(c.edge_weights[0]), number(c.edge_weights[1])}},
                        {"face_weights", point(c.face_weights)},
                        {"position", point(c.position)},
                        {"normal", point(c.normal)},
                        {"depth", number(depth.depth)},
                        {"direction", point(depth.direction)}});
    }
    return list;
}

} // namespace

const char* kind_name(vox_crossing_kind kind) {
    return kind == VOX_CROSSING_THROUGH ? "through" : kind == VOX_CROSSING_TOUCHING ? "touching" : "coplanar";
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
    case VOX_COST_MODEL_FORCE_32_BITS:
        break;
    }
    return "unknown";
}

const char* state_name(vox_penetration_state state) {
    switch (state) {
    case VOX_PENETRATION_SURFACE:
        return "surface";
    case VOX_PENETRATION_PROPAGATED:
        return "propagated";
    case VOX_PENETRATION_ENCLOSED:
        return "enclosed";
    case VOX_PENETRATION_CROSSING:
        return "crossing";
    case VOX_PENETRATION_COINCIDENT:
        return "coincident";
    case VOX_PENETRATION_UNKNOWN:
    case VOX_PENETRATION_STATE_FORCE_32_BITS:
        break;
    }
    return "unknown";
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json number(std::optional<double> value) { return value ? number(*value) : Json(nullptr); }

Json point(const double (&coordinates)[3]) {
    return Json::array({number(coordinates[0]), number(coordinates[1]), number(coordinates[2])});
}

Json bounds(const double (&min)[3], const double (&max)[3]) {
    return {{"min", point(min)}, {"max", point(max)}};
}

bool collides(const vox_suggestion& suggestion) { return suggestion.predicted_cost > 0; }

void add_suggestion(Json& json, const vox_suggestion& suggestion) {
    json["cell_size"] = number(suggestion.cell_size);
    json["cells_per_axis"] = number(suggestion.cells_per_axis);
    const bool has_zone = collides(suggestion);
    json["zone"] = {{"min", has_zone ? number(suggestion.zone_min) : Json(nullptr)},
                    {"max", has_zone ? number(suggestion.zone_max) : Json(nullptr)}};
    json["collides"] = has_zone;
    json["predicted_cost"] = number(suggestion.predicted_cost);
    json["model"] = model_name(suggestion.model);
    json["rules"] = rules(suggestion.rules);
    json["stats"] = stats(suggestion.stats);
    Json curve = Json::array();
    for (std::uint32_t i = 0; i < suggestion.curve_count; ++i)
        curve.push_back({{"cell_size", number(suggestion.curve[i].cell_size)},
                         {"cost", number(suggestion.curve[i].cost)}});
    json["curve"] = std::move(curve);
    json["rule_costs"] = rules(suggestion.rule_costs);
    Json terms = Json::array();
    for (std::uint32_t i = 0; i < suggestion.term_count; ++i) {
        const vox_cost_share& term = suggestion.terms[i];
        terms.push_back({{"name", term.name},
                         {"count", number(term.count)},
                         {"cost", number(term.cost)},
                         {"share", number(term.share)}});
    }
    json["terms"] = std::move(terms);
    json["uniform_loss"] = number(suggestion.uniform_loss);
    Json levels = Json::array();
    for (std::uint32_t i = 0; i < suggestion.level_count; ++i) levels.push_back(number(suggestion.levels[i]));
    json["levels"] = std::move(levels);
}

void add_collision(Json& json, const vox_grid* grid, const std::vector<vox_mesh>& ids,
                   const vox_profile& profile) {
    const vox_contact_view view = contacts_of(grid);
    json["contact_count"] = view.count;
    Json contacts = Json::array();
    for (std::uint64_t i = 0; i < view.count; ++i) {
        const vox_contact contact = contact_at(view, i);
        const float* weight = contact.barycentric;
        contacts.push_back(
            {{"mesh_a", place_of(ids, contact.mesh_a)},
             {"vertex", contact.vertex},
             {"mesh_b", place_of(ids, contact.mesh_b)},
             {"tet", contact.tet},
             {"barycentric", {number(weight[0]), number(weight[1]), number(weight[2]), number(weight[3])}}});
    }
    json["contacts"] = std::move(contacts);
    json["penetrations"] = has_penetrations(grid) ? penetrations(grid, ids) : Json(nullptr);
    if (has_edge_contacts(grid)) json["edge_contacts"] = edge_contacts(grid, ids);
    add_result(json, grid, profile);
}

Json margin_contacts(const vox_grid* grid, const std::vector<vox_mesh>& ids) {
    Json list = Json::array();
    for (const vox_margin_contact& c : margin_contacts_of(grid))
        list.push_back({{"mesh_a", place_of(ids, c.mesh_a)},
                        {"vertex", c.vertex},
                        {"mesh_b", place_of(ids, c.mesh_b)},
                        {"tet", c.tet},
                        {"face", {c.face[0], c.face[1], c.face[2]}},
                        {"face_weights", point(c.face_weights)},
                        {"distance", number(c.distance)},
                        {"normal", point(c.normal)}});
    return list;
}

Json passages(const vox_grid* grid, const std::vector<vox_mesh>& ids) {
    Json list = Json::array();
    for (const vox_passage& p : passages_of(grid))
        list.push_back({{"mesh_a", place_of(ids, p.mesh_a)},
                        {"vertex", p.vertex},
                        {"mesh_b", place_of(ids, p.mesh_b)},
                        {"tet", p.tet},
                        {"face", {p.face[0], p.face[1], p.face[2]}},
                        {"time", number(p.time)}});
    return list;
}

void add_result(Json& json, const vox_grid* grid, const vox_profile& profile) {
    json["hash"] = hash_of(grid);
    json["cell_size"] = number(cell_size_of(grid));
    json["profile"] = {{"step_ns", profile.step_ns},
                       {"bin_ns", profile.bin_ns},
                       {"broad_ns", profile.broad_ns},
                       {"narrow_ns", profile.narrow_ns},
                       {"contacts_ns", profile.contacts_ns},
                       {"depth_ns", profile.depth_ns},
                       {"stream_ns", profile.stream_ns},
                       {"winding_ns", profile.winding_ns},
                       {"broad_phase_ns", profile.broad_phase_ns},
                       {"windows_ns", profile.windows_ns},
                       {"lookup_ns", profile.lookup_ns},
                       {"decide_ns", profile.decide_ns},
                       {"edges_ns", profile.edges_ns},
                       {"margin_ns", profile.margin_ns}};
    json["counters"] = counters_json(counters_of(grid));
}

Json body_list(const std::vector<Body>& bodies) {
    Json list = Json::array();
    for (const Body& body : bodies)
        list.push_back(
            {{"file", body.name}, {"vertices", body.view.vertex_count}, {"tets", body.view.tet_count}});
    return list;
}

std::size_t place_of(const std::vector<vox_mesh>& ids, vox_mesh mesh) {
    return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), mesh) - ids.begin());
}

std::string hash_of(const vox_grid* grid) {
    std::uint64_t hash = 0;
    check(vox_grid_hash(grid, &hash));
    return hexadecimal(hash);
}

std::string hexadecimal(std::uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

std::string xml_text(const std::string& text) {
    const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string result;
    for (const char c : Json::parse(quoted).get<std::string>()) switch (c) {
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
    // File names need not be UTF-8, but JSON must be.
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    std::fwrite(text.data(), 1, text.size(), stdout);
}

void finish_output() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw Failure(std::string("cannot write to standard output: ") + std::strerror(errno));
}

} // namespace tool
