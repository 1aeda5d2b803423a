// vox check: whether the surface of a mesh passes through itself or lies on itself, and where.
#include "body.hpp"
#include "commands.hpp"
#include "facets.hpp"
#include "failure.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "overlaps.hpp"
#include "report.hpp"
#include "terminal.hpp"

#include <vox/vox_surface.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <numeric>

namespace tool {

namespace {

struct CheckOptions {
    std::vector<std::string> files;
    bool floats = false;
    std::uint32_t threads = 1;
    std::uint64_t limit = 10;
    Reading reading;
    std::string out;
    bool json = false;
};

const char* crossing_name(vox_crossing_kind kind) {
    return kind == VOX_CROSSING_THROUGH ? "through" : kind == VOX_CROSSING_TOUCHING ? "touching" : "coplanar";
}

// The surface of a mesh: its triangles, or the facets that only one tetrahedron has. Vertices at the same
// place are merged into the lowest one, as files often repeat a vertex for each triangle.
struct CheckedSurface {
    std::vector<double> positions;
    std::vector<Triangle> triangles;
};

// For each vertex the lowest one at the same place.
std::vector<std::uint32_t> merge_vertices(const std::vector<double>& positions) {
    const auto count = static_cast<std::uint32_t>(positions.size() / 3);
    const auto at = [&](std::uint32_t v) {
        const double* p = &positions[3 * std::size_t{v}];
        return std::array{p[0], p[1], p[2]};
    };
    std::vector<std::uint32_t> order(count), lowest(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t v, std::uint32_t w) { return at(v) < at(w); });
    for (std::size_t i = 0; i < count; ++i)
        lowest[order[i]] = i > 0 && at(order[i]) == at(order[i - 1]) ? lowest[order[i - 1]] : order[i];
    return lowest;
}

CheckedSurface surface_of(const Body& body) {
    CheckedSurface surface;
    surface.positions = body.exact;
    if (surface.positions.empty()) surface.positions.assign(body.positions.begin(), body.positions.end());
    const std::vector<std::uint32_t> lowest = merge_vertices(surface.positions);
    const vox_io_mesh_view& view = body.view;
    for (std::uint64_t i = 0; view.tet_count == 0 && i < view.triangle_count; ++i) {
        const std::uint32_t* v = view.triangles + 3 * i;
        surface.triangles.push_back({lowest[v[0]], lowest[v[1]], lowest[v[2]]});
    }
    std::vector<std::uint32_t> tets(view.tets, view.tets + 4 * view.tet_count);
    for (std::uint32_t& corner : tets) corner = lowest[corner];
    for (const Triangle& facet : boundary_of(tets)) surface.triangles.push_back(facet);
    return surface;
}

struct SurfaceDeleter {
    void operator()(vox_surface* surface) const noexcept { vox_surface_destroy(surface); }
};

struct Checked {
    std::string file;
    Json report;
    CheckedSurface surface;
    std::vector<std::uint32_t> edges; // two vertices each
    std::vector<vox_crossing> crossings;
    std::vector<Overlap> overlaps;

    bool is_free() const { return crossings.empty() && overlaps.empty(); }
    std::size_t count(OverlapKind kind) const {
        return static_cast<std::size_t>(
            std::count_if(overlaps.begin(), overlaps.end(),
                          [kind](const Overlap& overlap) { return overlap.kind == kind; }));
    }
    std::size_t count(vox_crossing_kind kind) const {
        return static_cast<std::size_t>(
            std::count_if(crossings.begin(), crossings.end(),
                          [kind](const vox_crossing& crossing) { return crossing.kind == kind; }));
    }
};

Checked check_file(const std::string& file, const CheckOptions& options) {
    Checked checked;
    checked.file = file;
    const Body body = load_body(file, {.keep_doubles = !options.floats}, options.reading);
    checked.report = report_json(body.report, body.warnings);
    checked.surface = surface_of(body);
    if (checked.surface.triangles.empty())
        throw Failure(file + " has no triangles and no tetrahedra to check");
    vox_surface_desc desc = vox_default_surface_desc();
    desc.worker_count = options.threads;
    desc.byte_budget = UINT64_MAX;
    desc.vertex_count = checked.surface.positions.size() / 3;
    desc.face_count = checked.surface.triangles.size();
    desc.faces = checked.surface.triangles.front().data();
    vox_surface* created = nullptr;
    check(vox_surface_create(&desc, &created));
    const std::unique_ptr<vox_surface, SurfaceDeleter> surface(created);
    vox_motion motion = vox_default_motion();
    motion.from = vox_double_positions(checked.surface.positions.data(), desc.vertex_count);
    check(vox_surface_move(surface.get(), &motion));
    vox_feature_view edges{};
    check(vox_surface_get_features(surface.get(), VOX_FEATURE_EDGE, &edges));
    checked.edges.assign(edges.vertices, edges.vertices + 2 * edges.count);
    vox_crossing_view view{};
    check(vox_surface_find_crossings(surface.get(), &view));
    checked.crossings.assign(view.data, view.data + view.count);
    checked.overlaps = find_overlaps(checked.surface.positions, checked.surface.triangles);
    return checked;
}

void print_overlaps(const Checked& checked, std::uint64_t limit) {
    const std::uint64_t shown = std::min<std::uint64_t>(limit, checked.overlaps.size());
    for (std::size_t i = 0; i < shown; ++i) {
        const Overlap& overlap = checked.overlaps[i];
        const Triangle &x = checked.surface.triangles[overlap.first],
                       &y = checked.surface.triangles[overlap.second];
        std::printf("  triangles %u %u %u and %u %u %u, %s\n", x[0], x[1], x[2], y[0], y[1], y[2],
                    overlap_names[static_cast<std::size_t>(overlap.kind)]);
    }
    print_rest(checked.overlaps.size() - shown);
}

void print_check(const Checked& checked, std::uint64_t limit) {
    std::printf("%s: %llu triangles, %llu edges: ", shown(checked.file).c_str(),
                llu(checked.surface.triangles.size()), llu(checked.edges.size() / 2));
    if (checked.is_free()) {
        std::printf("free of self-intersection\n");
        return;
    }
    if (!checked.crossings.empty())
        std::printf("%llu edges meet triangles (%llu through, %llu touching, %llu coplanar)%s",
                    llu(checked.crossings.size()), llu(checked.count(VOX_CROSSING_THROUGH)),
                    llu(checked.count(VOX_CROSSING_TOUCHING)), llu(checked.count(VOX_CROSSING_COPLANAR)),
                    checked.overlaps.empty() ? "" : ", ");
    if (!checked.overlaps.empty())
        std::printf("%llu %s on each other (%llu folded, %llu doubled, %llu opposite)",
                    llu(checked.overlaps.size()),
                    checked.overlaps.size() == 1 ? "pair of triangles lies" : "pairs of triangles lie",
                    llu(checked.count(OverlapKind::folded)), llu(checked.count(OverlapKind::doubled)),
                    llu(checked.count(OverlapKind::opposite)));
    std::printf("\n");
    print_overlaps(checked, limit);
    const std::size_t shown =
        static_cast<std::size_t>(std::min<std::uint64_t>(limit, checked.crossings.size()));
    for (std::size_t i = 0; i < shown; ++i) {
        const vox_crossing& c = checked.crossings[i];
        const Triangle& face = checked.surface.triangles[c.face];
        std::printf("  edge %u %u, triangle %u %u %u, at %.9g %.9g %.9g, %s\n", checked.edges[2 * c.edge],
                    checked.edges[2 * c.edge + 1], face[0], face[1], face[2], c.position[0], c.position[1],
                    c.position[2], crossing_name(c.kind));
    }
    print_rest(checked.crossings.size() - shown);
}

Json check_json(const Checked& checked) {
    Json list = Json::array();
    for (const vox_crossing& c : checked.crossings) {
        const Triangle& face = checked.surface.triangles[c.face];
        list.push_back({{"edge", Json::array({checked.edges[2 * c.edge], checked.edges[2 * c.edge + 1]})},
                        {"triangle", Json::array_of(face)},
                        {"kind", crossing_name(c.kind)},
                        {"position", Json::array_of(c.position)}});
    }
    Json overlaps = Json::array();
    for (const Overlap& overlap : checked.overlaps)
        overlaps.push_back(
            {{"triangles", Json::array({Json::array_of(checked.surface.triangles[overlap.first]),
                                        Json::array_of(checked.surface.triangles[overlap.second])})},
             {"kind", overlap_names[static_cast<std::size_t>(overlap.kind)]}});
    return {{"file", checked.file},
            {"triangles", checked.surface.triangles.size()},
            {"edges", checked.edges.size() / 2},
            {"through", checked.count(VOX_CROSSING_THROUGH)},
            {"touching", checked.count(VOX_CROSSING_TOUCHING)},
            {"coplanar", checked.count(VOX_CROSSING_COPLANAR)},
            {"crossings", list},
            {"folded", checked.count(OverlapKind::folded)},
            {"doubled", checked.count(OverlapKind::doubled)},
            {"opposite", checked.count(OverlapKind::opposite)},
            {"overlaps", overlaps},
            {"report", checked.report}};
}

// Writes the surface, with the number of crossings of each vertex (by its edges) and each triangle, in whose
// number are the triangles on it, too.
void write_surface(const Checked& checked, const std::string& path) {
    const std::vector<Triangle>& triangles = checked.surface.triangles;
    std::vector<double> of_vertex(checked.surface.positions.size() / 3, 0), of_triangle(triangles.size(), 0);
    std::map<std::array<std::uint32_t, 2>, double> of_edge;
    for (const vox_crossing& c : checked.crossings) {
        const std::uint32_t v = checked.edges[2 * c.edge], w = checked.edges[2 * c.edge + 1];
        of_vertex[v] += 1;
        of_vertex[w] += 1;
        of_triangle[c.face] += 1;
        of_edge[{std::min(v, w), std::max(v, w)}] += 1;
    }
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t v = triangles[t][i], w = triangles[t][(i + 1) % 3];
            const auto found = of_edge.find({std::min(v, w), std::max(v, w)});
            if (found != of_edge.end()) of_triangle[t] += found->second;
        }
    for (const Overlap& overlap : checked.overlaps)
        for (const std::size_t t : {overlap.first, overlap.second}) of_triangle[t] += 1;
    const vox_io_mesh_view arrays{checked.surface.positions.data(),
                                  of_vertex.size(),
                                  nullptr,
                                  0,
                                  triangles.front().data(),
                                  triangles.size(),
                                  nullptr,
                                  nullptr,
                                  nullptr};
    vox_io_mesh* made = nullptr;
    check(vox_io_mesh_create(&arrays, &made));
    const Mesh mesh(made);
    const vox_io_point_data points{"crossings", of_vertex.data(), 1, 0};
    const vox_io_point_data cells{"crossings", of_triangle.data(), 1, 0};
    vox_io_write_desc desc = vox_default_io_write_desc();
    desc.point_data = &points;
    desc.point_data_count = 1;
    desc.cell_data = &cells;
    desc.cell_data_count = 1;
    check(vox_io_write(mesh.get(), path.c_str(), &desc));
}

void run_check(const CheckOptions& options) {
    if (!options.out.empty()) {
        if (options.files.size() > 1) throw WrongUsage("-o takes one mesh");
        check_output(options.out, {".vtu", ".msh"});
    }
    bool free = true;
    Json meshes = Json::array();
    for (const std::string& file : options.files) {
        const Checked checked = check_file(file, options);
        free &= checked.is_free();
        if (!options.out.empty()) write_surface(checked, options.out);
        if (options.json)
            meshes.push_back(check_json(checked));
        else
            print_check(checked, options.limit);
    }
    if (options.json) print({{"free", free}, {"meshes", meshes}});
    if (!free) throw Verdict{3};
}

} // namespace

void add_check(CommandLine& line) {
    const auto options = std::make_shared<CheckOptions>();
    Command command =
        line.add("check", "Find out whether the surface of a mesh passes through itself, and where");
    command.option("MESH", options->files, "Mesh files, each checked by itself").required();
    command.flag("--float", options->floats, "Round positions to float first, as most commands do");
    command.option("--threads", options->threads, "Threads; 0: one per core").range(0, VOX_MAX_WORKERS);
    command.option("--limit", options->limit, "Most crossings of a mesh to print as text");
    command
        .option("-o,--output", options->out, "Write the surface and its crossings to this file, .vtu or .msh")
        .shown_as("FILE");
    add_what_is_read(command, options->reading);
    command.flag("--json", options->json, "Print one JSON object");
    command.examples("  vox check cloth.obj\n  vox check skin.stl -o crossings.vtu");
    command.runs([options] { run_check(*options); });
}

} // namespace tool
