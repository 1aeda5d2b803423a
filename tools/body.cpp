#include "body.hpp"

#include "by_assimp.hpp"
#include "failure.hpp"
#include "terminal.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <utility>

namespace tool {

namespace {

// Doubles below this bound round to finite floats. It is midway between the largest float and the next power
// of two.
constexpr double float_range = 0x1.ffffffp127;

void place(Body& body, const Placement& placement) {
    body.positions.resize(3 * body.view.vertex_count);
    for (std::size_t i = 0; i < body.positions.size(); ++i) {
        const double moved = body.view.positions[i] * placement.scale + placement.offset[i % 3];
        if (!(std::abs(moved) < float_range)) {
            char words[160];
            std::snprintf(words, sizeof words, "vertex %zu has coordinate %.9g, which no float can hold",
                          i / 3, moved);
            check(vox_fail(VOX_ERROR_NON_FINITE, (body.name + ": " + words).c_str()));
        }
        body.positions[i] = static_cast<float>(moved);
        if (placement.keep_doubles) body.exact.push_back(moved);
    }
}

} // namespace

Loaded load_mesh(const std::string& path, const Reading& reading) {
    Progress progress;
    progress.begin_reading(path);
    vox_io_load_desc desc = vox_default_io_load_desc();
    desc.progress = [](double fraction, void* user) -> std::int32_t {
        static_cast<Progress*>(user)->show_read(fraction);
        return 0;
    };
    desc.progress_user = &progress;
    if (reading.keep_unused) desc.flags |= VOX_IO_LOAD_KEEP_UNUSED;
    if (reading.split_cells) desc.flags |= VOX_IO_LOAD_SPLIT_CELLS;
    Loaded loaded;
    loaded.report.struct_size = sizeof loaded.report;
    vox_io_mesh* read = nullptr;
    const vox_result result = vox_io_load(path.c_str(), &desc, &read);
    if (result == VOX_ERROR_UNSUPPORTED) {
        loaded.mesh = load_by_assimp(path, vox_last_error(), loaded.report);
    } else {
        check(result);
        loaded.mesh.reset(read);
        check(vox_io_mesh_get_report(read, &loaded.report));
    }
    std::istringstream lines(vox_io_mesh_get_warnings(loaded.mesh.get()));
    for (std::string line; std::getline(lines, line);) loaded.warnings.push_back(line);
    return loaded;
}

void say_warnings(const std::string& path, const std::vector<std::string>& warnings) {
    std::string words;
    for (const std::string& warning : warnings) words += (words.empty() ? "" : "; ") + warning;
    if (words.empty()) return;
    std::fflush(stdout);
    std::fprintf(stderr, "vox: warning: %s: %s\n", shown(path).c_str(), shown(words).c_str());
}

Body own_body(const std::string& name, vox_io_mesh* mesh) {
    Body body;
    body.name = name;
    body.mesh.reset(mesh);
    body.report.struct_size = sizeof body.report;
    check(vox_io_mesh_get_report(mesh, &body.report));
    check(vox_io_mesh_get_arrays(mesh, &body.view));
    place(body, {});
    return body;
}

Body load_body(const std::string& path, const Placement& placement, const Reading& reading) {
    Loaded loaded = load_mesh(path, reading);
    say_warnings(path, loaded.warnings);
    Body body;
    body.name = path;
    body.mesh = std::move(loaded.mesh);
    body.report = loaded.report;
    body.warnings = std::move(loaded.warnings);
    check(vox_io_mesh_get_arrays(body.mesh.get(), &body.view));
    if (reading.fill_surfaces && body.view.tet_count == 0) {
        vox_io_tetrahedralize_desc desc = vox_default_io_tetrahedralize_desc();
        desc.cell = reading.cell;
        vox_io_mesh* filled = nullptr;
        const vox_result result = vox_io_tetrahedralize(body.mesh.get(), &desc, &filled);
        if (result != VOX_OK) check(vox_fail(result, (path + ": " + vox_last_error()).c_str()));
        body.mesh.reset(filled);
        check(vox_io_mesh_get_arrays(filled, &body.view));
    }
    place(body, placement);
    return body;
}

vox_mesh_desc mesh_desc(const Body& body) {
    vox_mesh_desc desc = vox_default_mesh_desc();
    const std::uint64_t count = body.view.vertex_count;
    desc.positions = body.exact.empty() ? vox_float_positions(body.positions.data(), count)
                                        : vox_double_positions(body.exact.data(), count);
    desc.tets = body.view.tets;
    desc.tet_count = body.view.tet_count;
    return desc;
}

} // namespace tool
