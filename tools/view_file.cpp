#include "view_file.hpp"

#include "curve_svg.hpp"
#include "facets.hpp"
#include "json.hpp"
#include "output_file.hpp"
#include "report.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <tuple>

namespace tool {

// web/viewer/viewer.html with its scripts, by tools/CMakeLists.txt.
extern const char* const viewer_page;

namespace {

using Point = std::array<double, 3>;

// The lowest byte of each word comes first.
std::string base64(std::span<const std::uint32_t> words) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    const std::size_t count = 4 * words.size();
    const auto byte = [&](std::size_t i) { return i < count ? words[i / 4] >> (8 * (i % 4)) & 255u : 0u; };
    text.reserve(count / 3 * 4 + 4);
    for (std::size_t i = 0; i < count; i += 3) {
        const std::uint32_t bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > count ? '=' : digits[bits >> (18 - 6 * k) & 63u];
    }
    return text;
}

std::uint32_t bits_of(double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); }

Point at(const DrawnMesh& mesh, std::uint32_t vertex) {
    const double* p = &mesh.positions[3 * std::size_t{vertex}];
    return {p[0], p[1], p[2]};
}

std::vector<Triangle> surface_of(const DrawnMesh& mesh) {
    std::vector<Triangle> surface = boundary_of(mesh.tets);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
        surface.push_back({mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]});
    return surface;
}

// The middle of all that is drawn: floats are finest around it.
Point middle_of(std::span<const DrawnMesh> meshes) {
    Point low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (const DrawnMesh& mesh : meshes)
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            low[i % 3] = std::min(low[i % 3], mesh.positions[i]);
            high[i % 3] = std::max(high[i % 3], mesh.positions[i]);
        }
    Point middle;
    for (std::size_t c = 0; c < 3; ++c) middle[c] = low[c] <= high[c] ? low[c] / 2 + high[c] / 2 : 0;
    return middle;
}

void add_point(std::vector<std::uint32_t>& words, const Point& point, const Point& middle) {
    for (std::size_t c = 0; c < 3; ++c) words.push_back(bits_of(point[c] - middle[c]));
}

// Only the vertices of the surface.
Json body_of(const DrawnMesh& mesh, const Point& middle) {
    std::vector<std::uint32_t> positions, corners;
    std::map<std::uint32_t, std::uint32_t> places;
    for (const Triangle& triangle : surface_of(mesh))
        for (const std::uint32_t vertex : triangle) {
            const auto [place, is_new] = places.emplace(vertex, static_cast<std::uint32_t>(places.size()));
            if (is_new) add_point(positions, at(mesh, vertex), middle);
            corners.push_back(place->second);
        }
    return {
        {"name", short_names({mesh.name})}, {"positions", base64(positions)}, {"triangles", base64(corners)}};
}

// Six floats for each contact: where the vertex is, and its way out, as long as it is deep.
std::string ways_of(std::span<const DrawnMesh> meshes, const vox_grid* grid, const Point& middle) {
    std::map<std::tuple<vox_body, std::uint32_t, vox_body>, const vox_constraint*> constraints;
    for (const vox_constraint& c : constraints_of(grid))
        if (c.kind == VOX_CONSTRAINT_INSIDE)
            constraints.emplace(std::tuple(c.body_a, c.vertices[0], c.body_b), &c);
    std::vector<std::uint32_t> words;
    for (const vox_contact& contact : contacts_of(grid)) {
        const auto mesh = std::ranges::find(meshes, contact.body_a, &DrawnMesh::id);
        const auto found = constraints.find({contact.body_a, contact.vertex, contact.body_b});
        Point way{};
        if (found != constraints.end())
            for (std::size_t c = 0; c < 3; ++c) way[c] = -found->second->gap * found->second->normal[c];
        add_point(words, at(*mesh, contact.vertex), middle);
        add_point(words, way, {});
    }
    return base64(words);
}

void replace(std::string& page, const std::string& mark, const std::string& text) {
    page.replace(page.find(mark), mark.size(), text);
}

} // namespace

void write_view(const std::string& path, std::span<const DrawnMesh> meshes, const vox_grid* grid) {
    const Point middle = middle_of(meshes);
    Json bodies = Json::array();
    std::vector<std::string> names;
    for (const DrawnMesh& mesh : meshes) {
        bodies.push_back(body_of(mesh, middle));
        names.push_back(mesh.name);
    }
    const Json data = {{"bodies", bodies},
                       {"contact_count", contacts_of(grid).size()},
                       {"contacts", ways_of(meshes, grid, middle)},
                       {"middle", Json::array({middle[0], middle[1], middle[2]})}};
    std::string escaped; // in a page, "</script>" would end the data
    for (const char c : data.text()) escaped += c == '<' ? std::string("\\u003c") : std::string(1, c);
    std::string page = viewer_page;
    replace(page, "{{data}}", escaped);
    replace(page, "{{title}}", xml_text(short_names(names)));
    write_file(path, page);
}

} // namespace tool
