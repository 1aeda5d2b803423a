#include "results_file.hpp"

#include "failure.hpp"
#include "output_file.hpp"
#include "report.hpp"
#include "view_file.hpp"

#include <algorithm>
#include <cstdio>
#include <unordered_map>

namespace tool {

namespace {

// Where the vertices and tets of a mesh begin in the file.
struct Start {
    std::size_t vertex, tet;
};

struct Results {
    std::vector<double> mesh, number, contacts;   // one a vertex, or one a cell
    std::vector<double> kind, state, gap, normal; // one a vertex
};

vox_io_point_data data(const char* name, const std::vector<double>& values, std::uint32_t components = 1) {
    return {name, values.data(), components, 0};
}

} // namespace

DrawnMesh drawn_mesh(const Body& body, vox_body id) {
    DrawnMesh mesh{id, body.exact, {}, {}, {}, body.name};
    if (mesh.positions.empty()) mesh.positions.assign(body.positions.begin(), body.positions.end());
    mesh.tets.assign(body.view.tets, body.view.tets + 4 * body.view.tet_count);
    if (mesh.tets.empty())
        mesh.triangles.assign(body.view.triangles, body.view.triangles + 3 * body.view.triangle_count);
    return mesh;
}

void write_results(const std::string& path, std::span<const DrawnMesh> meshes, const vox_grid* grid) {
    if (has_ending(path, ".html")) return write_view(path, meshes, grid);
    std::vector<double> positions;
    std::vector<std::uint32_t> triangles, tets;
    std::vector<Start> starts;
    std::unordered_map<vox_body, std::size_t> places;
    Results vertices, cells;
    for (const DrawnMesh& mesh : meshes) { // in a file, triangles come before the tets
        const auto first = static_cast<std::uint32_t>(positions.size() / 3);
        for (const std::uint32_t corner : mesh.triangles) triangles.push_back(first + corner);
        cells.mesh.insert(cells.mesh.end(), mesh.triangles.size() / 3, static_cast<double>(places.size()));
        cells.number.insert(cells.number.end(), mesh.triangles.size() / 3, -1);
        positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
        places.emplace(mesh.id, places.size());
    }
    std::size_t first = 0;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const DrawnMesh& mesh = meshes[i];
        starts.push_back({first, cells.mesh.size()});
        for (const std::uint32_t corner : mesh.tets)
            tets.push_back(static_cast<std::uint32_t>(first) + corner);
        for (std::size_t v = 0; v < mesh.positions.size() / 3; ++v) {
            vertices.mesh.push_back(static_cast<double>(i));
            vertices.number.push_back(static_cast<double>(v));
        }
        for (std::size_t t = 0; t < mesh.tets.size() / 4; ++t) {
            cells.mesh.push_back(static_cast<double>(i));
            cells.number.push_back(static_cast<double>(mesh.numbers.empty() ? t : mesh.numbers[t]));
        }
        first += mesh.positions.size() / 3;
    }

    vertices.contacts.assign(vertices.mesh.size(), 0);
    cells.contacts.assign(cells.mesh.size(), 0);
    for (const vox_contact& contact : contacts_of(grid)) {
        const std::size_t b = places.at(contact.body_b);
        std::size_t tet = contact.tet;
        if (const auto& numbers = meshes[b].numbers; !numbers.empty()) // ascending
            tet = static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), contact.tet) -
                                           numbers.begin());
        vertices.contacts[starts[places.at(contact.body_a)].vertex + contact.vertex] += 1;
        cells.contacts[starts[b].tet + tet] += 1;
    }
    vertices.kind.assign(vertices.mesh.size(), -1);
    vertices.state.assign(vertices.mesh.size(), -1);
    vertices.gap.assign(vertices.mesh.size(), 0);
    vertices.normal.assign(3 * vertices.mesh.size(), 0);
    for (const vox_constraint& c : constraints_of(grid))
        for (const std::uint32_t v : std::span(c.vertices).first(c.count_a)) {
            const std::size_t vertex = starts[places.at(c.body_a)].vertex + v;
            if (vertices.state[vertex] >= 0 && vertices.gap[vertex] <= c.gap) continue;
            vertices.kind[vertex] = c.kind;
            vertices.state[vertex] = c.state;
            vertices.gap[vertex] = c.gap;
            std::copy(c.normal, c.normal + 3, vertices.normal.begin() + 3 * std::ptrdiff_t(vertex));
        }
    const std::vector<vox_io_point_data> of_points = {
        data("mesh", vertices.mesh),         data("vertex", vertices.number),
        data("contacts", vertices.contacts), data("kind", vertices.kind),
        data("state", vertices.state),       data("gap", vertices.gap),
        data("normal", vertices.normal, 3)};
    const std::vector<vox_io_point_data> of_cells = {data("mesh", cells.mesh), data("tet", cells.number),
                                                     data("contacts", cells.contacts)};

    const vox_io_mesh_view arrays{positions.data(), positions.size() / 3, tets.data(), tets.size() / 4,
                                  triangles.data(), triangles.size() / 3, nullptr,     nullptr,
                                  nullptr};
    vox_io_mesh* made = nullptr;
    check(vox_io_mesh_create(&arrays, &made));
    const Mesh mesh(made);
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.point_data = of_points.data();
    desc.point_data_count = of_points.size();
    desc.cell_data = of_cells.data();
    desc.cell_data_count = of_cells.size();
    check(vox_io_write(mesh.get(), path.c_str(), &desc));
}

void write_constraints(const std::string& path, const std::vector<vox_body>& ids, const vox_grid* grid) {
    std::string text = "kind,state,body_a,body_b";
    for (const char* column : {"vertex", "weight"})
        for (std::uint32_t i = 0; i < VOX_STENCIL_CAPACITY; ++i)
            text += "," + std::string(column) + "_" + std::to_string(i);
    text += ",gap,normal_x,normal_y,normal_z,position_x,position_y,position_z,time\n";
    const auto add = [&](double value) {
        char number[32];
        std::snprintf(number, sizeof number, ",%.17g", value);
        text += number;
    };
    for (const vox_constraint& c : constraints_of(grid)) {
        text += std::string(kind_name(c.kind)) + "," + state_name(c.state) + "," +
                std::to_string(place_of(ids, c.body_a)) + "," + std::to_string(place_of(ids, c.body_b));
        for (std::uint32_t i = 0; i < VOX_STENCIL_CAPACITY; ++i)
            text += i < c.count ? "," + std::to_string(c.vertices[i]) : ",";
        for (std::uint32_t i = 0; i < VOX_STENCIL_CAPACITY; ++i)
            if (i < c.count)
                add(c.weights[i]);
            else
                text += ",";
        add(c.gap);
        for (const double x : c.normal) add(x);
        for (const double x : c.position) add(x);
        add(c.time);
        text += '\n';
    }
    write_file(path, text);
}

std::string pvd_series(std::span<const std::string> files, std::span<const std::uint64_t> times) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
    for (std::size_t i = 0; i < files.size(); ++i) {
        text +=
            "<DataSet timestep=\"" + std::to_string(times[i]) + "\" file=\"" + xml_text(files[i]) + "\"/>\n";
    }
    return text + "</Collection>\n</VTKFile>\n";
}

} // namespace tool
