#include "results_file.hpp"

#include "failure.hpp"
#include "output_file.hpp"
#include "report.hpp"

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
    std::vector<double> mesh, number, contacts;  // of vertices, or of cells
    std::vector<double> depth, direction, state; // of vertices
    std::vector<double> edge_contacts;           // of vertices
    std::vector<double> margin_distance, margin_normal, passage_time;
};

vox_io_point_data data(const char* name, const std::vector<double>& values, std::uint32_t components = 1) {
    return {name, values.data(), components, 0};
}

} // namespace

DrawnMesh drawn_mesh(const Body& body, vox_body id) {
    DrawnMesh mesh{id, body.exact, {}, {}, {}};
    if (mesh.positions.empty()) mesh.positions.assign(body.positions.begin(), body.positions.end());
    mesh.tets.assign(body.view.tets, body.view.tets + 4 * body.view.tet_count);
    if (mesh.tets.empty())
        mesh.triangles.assign(body.view.triangles, body.view.triangles + 3 * body.view.triangle_count);
    return mesh;
}

void write_results(const std::string& path, std::span<const DrawnMesh> meshes, const vox_grid* grid,
                   bool moving) {
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
    const vox_contact_view contacts = contacts_of(grid);
    for (std::uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact contact = contact_at(contacts, i);
        const std::size_t b = places.at(contact.body_b);
        std::size_t tet = contact.tet;
        if (const auto& numbers = meshes[b].numbers; !numbers.empty()) // ascending
            tet = static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), contact.tet) -
                                           numbers.begin());
        vertices.contacts[starts[places.at(contact.body_a)].vertex + contact.vertex] += 1;
        cells.contacts[starts[b].tet + tet] += 1;
    }
    std::vector<vox_io_point_data> of_points = {data("mesh", vertices.mesh), data("vertex", vertices.number),
                                                data("contacts", vertices.contacts)};
    if (has_penetrations(grid)) {
        vertices.depth.assign(vertices.mesh.size(), 0);
        vertices.direction.assign(3 * vertices.mesh.size(), 0);
        vertices.state.assign(vertices.mesh.size(), -1);
        const vox_penetration_view penetrations = penetrations_of(grid);
        for (std::uint64_t i = 0; i < penetrations.count; ++i) {
            const vox_penetration p = penetration_at(penetrations, i);
            const std::size_t vertex = starts[places.at(p.body_a)].vertex + p.vertex;
            if (vertices.state[vertex] >= 0 && vertices.depth[vertex] >= static_cast<double>(p.depth))
                continue;
            vertices.depth[vertex] = static_cast<double>(p.depth);
            std::copy(p.direction, p.direction + 3, vertices.direction.begin() + 3 * std::ptrdiff_t(vertex));
            vertices.state[vertex] = p.state;
        }
        of_points.push_back(data("depth", vertices.depth));
        of_points.push_back(data("direction", vertices.direction, 3));
        of_points.push_back(data("state", vertices.state));
    }
    if (has_edge_contacts(grid)) {
        vertices.edge_contacts.assign(vertices.mesh.size(), 0);
        const vox_edge_contact_view edges = edge_contacts_of(grid);
        for (std::uint64_t i = 0; i < edges.count; ++i) {
            const vox_edge_contact contact = edge_contact_at(edges, i);
            for (const std::uint32_t vertex : contact.edge)
                vertices.edge_contacts[starts[places.at(contact.body_a)].vertex + vertex] += 1;
        }
        of_points.push_back(data("edge_contacts", vertices.edge_contacts));
    }
    if (has_margin(grid)) {
        vertices.margin_distance.assign(vertices.mesh.size(), -1);
        vertices.margin_normal.assign(3 * vertices.mesh.size(), 0);
        for (const vox_margin_contact& c : margin_contacts_of(grid)) {
            const std::size_t vertex = starts[places.at(c.body_a)].vertex + c.vertex;
            double& distance = vertices.margin_distance[vertex];
            if (distance >= 0 && distance <= c.distance) continue;
            distance = c.distance;
            std::copy(c.normal, c.normal + 3, vertices.margin_normal.begin() + 3 * std::ptrdiff_t(vertex));
        }
        of_points.push_back(data("margin_distance", vertices.margin_distance));
        of_points.push_back(data("margin_normal", vertices.margin_normal, 3));
    }
    if (moving) {
        vertices.passage_time.assign(vertices.mesh.size(), -1);
        for (const vox_passage& p : passages_of(grid)) {
            double& time = vertices.passage_time[starts[places.at(p.body_a)].vertex + p.vertex];
            if (time < 0 || p.time < time) time = p.time;
        }
        of_points.push_back(data("passage_time", vertices.passage_time));
    }
    const std::vector<vox_io_point_data> of_cells = {data("mesh", cells.mesh), data("tet", cells.number),
                                                     data("contacts", cells.contacts)};

    const vox_io_mesh_view arrays{positions.data(), positions.size() / 3, tets.data(),
                                  tets.size() / 4,  triangles.data(),     triangles.size() / 3};
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

void write_contacts(const std::string& path, const std::vector<vox_body>& ids, const vox_grid* grid) {
    const bool deep = has_penetrations(grid);
    std::string text = "body_a,vertex,body_b,tet,weight_0,weight_1,weight_2,weight_3";
    text += deep ? ",depth,direction_x,direction_y,direction_z,state\n" : "\n";
    const vox_contact_view contacts = contacts_of(grid);
    const vox_penetration_view penetrations = deep ? penetrations_of(grid) : vox_penetration_view{};
    std::uint64_t at = 0; // the penetration of the contact at hand
    for (std::uint64_t i = 0; i < contacts.count; ++i) {
        const vox_contact contact = contact_at(contacts, i);
        const float* weight = contact.barycentric;
        char line[256];
        std::snprintf(line, sizeof line, "%zu,%u,%zu,%u,%.9g,%.9g,%.9g,%.9g", place_of(ids, contact.body_a),
                      contact.vertex, place_of(ids, contact.body_b), contact.tet,
                      static_cast<double>(weight[0]), static_cast<double>(weight[1]),
                      static_cast<double>(weight[2]), static_cast<double>(weight[3]));
        text += line;
        if (deep) {
            // The contacts of a vertex in one mesh stand together. They share a penetration, which names the
            // first of them.
            if (at + 1 < penetrations.count && penetration_at(penetrations, at + 1).contact == i) ++at;
            const vox_penetration p = penetration_at(penetrations, at);
            std::snprintf(line, sizeof line, ",%.9g,%.9g,%.9g,%.9g,%s", static_cast<double>(p.depth),
                          static_cast<double>(p.direction[0]), static_cast<double>(p.direction[1]),
                          static_cast<double>(p.direction[2]), state_name(p.state));
            text += line;
        }
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
