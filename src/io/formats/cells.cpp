#include "io/formats/cells.hpp"

#include "base/llu.hpp"
#include "io/mesh.hpp"

#include <algorithm>

namespace vox::io {
namespace {

constexpr std::uint8_t none = most_corners; // in place of a triangle's fourth corner
using Faces = std::uint8_t[6][4];           // counter-clockwise as seen from outside
constexpr Faces of_hexahedron = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                 {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
constexpr Faces of_wedge = {{0, 2, 1, none}, {3, 4, 5, none}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
constexpr Faces of_pyramid = {
    {0, 3, 2, 1}, {0, 1, 4, none}, {1, 2, 4, none}, {2, 3, 4, none}, {3, 0, 4, none}};

// Leaves out tets of more than four nodes whose corners lie in one plane: these say nothing of the tet's
// shape.
void leave_out_flat(MeshData& data) {
    const std::vector<std::uint32_t> high = std::move(data.high_tets);
    auto next = high.begin();
    number_cells(data, data.tets.size() / 4);
    std::size_t to = 0;
    for (std::size_t t = 0; t < data.tets.size() / 4; ++t) {
        const bool is_high = next != high.end() && *next == t;
        if (is_high) {
            ++next;
            if (volume_sign(data, &data.tets[4 * t]) == 0) continue;
        }
        data.second_order_tets += is_high;
        std::copy_n(&data.tets[4 * t], 4, &data.tets[4 * to]);
        if (!data.tet_regions.empty()) data.tet_regions[to] = data.tet_regions[t];
        data.tet_cells[to] = data.tet_cells[t];
        ++to;
    }
    data.left_out_tets = data.tets.size() / 4 - to;
    data.tets.resize(4 * to);
    if (!data.tet_regions.empty()) data.tet_regions.resize(to);
    data.tet_cells.resize(to);
}

// `= {}` would keep its room.
template <class Number>
void drop(std::vector<Number>& array) {
    array = std::vector<Number>();
}

const char* s(std::uint64_t number) { return number == 1 ? "" : "s"; }

} // namespace

void number_cells(MeshData& data, std::size_t tets) {
    for (std::size_t t = data.tet_cells.size(); t < tets; ++t)
        data.tet_cells.push_back(static_cast<std::uint32_t>(t));
}

std::size_t split_cell(CellKind kind, const std::uint32_t* corners, std::uint32_t (&tets)[6][4]) {
    const Faces& faces = kind == CellKind::hexahedron ? of_hexahedron
                         : kind == CellKind::wedge    ? of_wedge
                                                      : of_pyramid;
    const std::size_t face_count = kind == CellKind::hexahedron ? 6 : 5;
    const auto lowest =
        static_cast<std::uint8_t>(std::min_element(corners, corners + corner_count(kind)) - corners);
    std::size_t count = 0;
    for (std::size_t f = 0; f < face_count; ++f) {
        const auto& face = faces[f];
        if (std::find(face, face + 4, lowest) != face + 4) continue;
        const std::size_t size = face[3] == none ? 3 : 4;
        const auto* const first = std::min_element(
            face, face + size, [&](std::uint8_t a, std::uint8_t b) { return corners[a] < corners[b]; });
        const std::size_t begin = size == 4 ? static_cast<std::size_t>(first - face) % 2 : 0;
        for (std::size_t second = 1; second + 1 < size; ++second) {
            std::uint32_t(&tet)[4] = tets[count];
            tet[0] = corners[lowest];
            tet[1] = corners[face[begin]];
            tet[2] = corners[face[begin + second]];
            tet[3] = corners[face[(begin + second + 1) % size]];
            bool repeats = false;
            for (int i = 0; i < 4; ++i) repeats = repeats || std::count(tet, tet + 4, tet[i]) > 1;
            count += !repeats;
        }
    }
    return count;
}

void Cells::add_tet(const std::uint32_t* corners, std::int32_t region, MeshData& data) const {
    const std::size_t tet = data.tets.size() / 4;
    if (tet == VOX_MAX_TETS)
        throw_error(VOX_ERROR_LIMIT, "%s: more tetrahedra than the limit of %u", file_.name.c_str(),
                    VOX_MAX_TETS);
    for (int i = 0; i < 4; ++i) data.tets.push_back(corners[i]); // faster than insert
    // Most files of tets alone need no numbers.
    if (region != 0 || !data.tet_regions.empty()) {
        data.tet_regions.resize(tet);
        data.tet_regions.push_back(region);
    }
    if (data.cells != tet || !data.tet_cells.empty()) {
        number_cells(data, tet);
        data.tet_cells.push_back(static_cast<std::uint32_t>(data.cells));
    }
}

void Cells::add(CellKind kind, const char* name, std::uint64_t nodes, const std::uint32_t* corners,
                std::int32_t region, MeshData& data) {
    if (kind == CellKind::triangle) {
        data.triangles.insert(data.triangles.end(), corners, corners + 3);
    } else if (kind == CellKind::tet) {
        if (nodes > 4) data.high_tets.push_back(static_cast<std::uint32_t>(data.tets.size() / 4));
        add_tet(corners, region, data);
    } else {
        std::uint32_t tets[6][4];
        const std::size_t number = split_cell(kind, corners, tets);
        for (std::size_t t = 0; t < number; ++t) add_tet(tets[t], region, data);
        Count& count = of_name(split_, name);
        ++count.cells;
        count.tets += number;
        count.high += nodes > corner_count(kind);
    }
    ++data.cells;
}

void Cells::skip(CellKind kind, const char* name, std::uint64_t number, MeshData& data) {
    data.cells += number;
    skipped_cells_ += number;
    could_split_ = could_split_ || (number > 0 && corner_count(kind) > 0);
    if (kind != CellKind::other) of_name(skipped_, name).cells += number;
}

Cells::Count& Cells::of_name(std::vector<Count>& counts, const char* name) {
    const auto found =
        std::find_if(counts.begin(), counts.end(), [&](const Count& count) { return count.name == name; });
    return found != counts.end() ? *found : counts.emplace_back(Count{name});
}

MeshData Cells::finished(MeshData data) const {
    data.skipped_elements += skipped_cells_;
    for (const Count& count : skipped_)
        data.notes.push_back(format("%llu volume element%s of another kind %s left out: %s", llu(count.cells),
                                    s(count.cells), count.cells == 1 ? "was" : "were", count.name.c_str()));
    for (const Count& count : split_) {
        data.split_cells += count.cells;
        data.notes.push_back(format("%llu cell%s split into %llu tet%s: %s", llu(count.cells),
                                    count.cells == 1 ? " was" : "s were", llu(count.tets), s(count.tets),
                                    count.name.c_str()));
        if (count.high > 0)
            data.notes.push_back(format("%llu cell%s more nodes than corners, which alone were used: %s",
                                        llu(count.high), count.high == 1 ? " has" : "s have",
                                        count.name.c_str()));
    }
    if (!data.high_tets.empty()) leave_out_flat(data);
    if (std::count(data.tet_regions.begin(), data.tet_regions.end(), 0) == std::ssize(data.tet_regions))
        drop(data.tet_regions);
    std::size_t same = 0;
    while (same < data.tet_cells.size() && data.tet_cells[same] == same) ++same;
    if (same == data.tet_cells.size()) drop(data.tet_cells);
    if (!data.tets.empty()) return data;
    std::string text = format("%s: expected tetrahedra, found none", file_.name.c_str());
    if (!data.triangles.empty()) text += format(" (but %zu triangles)", data.triangles.size() / 3);
    for (const std::string& note : data.notes) text.append("; ").append(note);
    if (data.left_out_tets > 0)
        text +=
            format("; %llu tet%s of more than four nodes %s in one plane", llu(data.left_out_tets),
                   s(data.left_out_tets), data.left_out_tets == 1 ? "has its corners" : "have their corners");
    if (could_split_) text += " (they are split into tetrahedra on request: split_cells)";
    throw Error(VOX_ERROR_FORMAT, text);
}

} // namespace vox::io
