// TetGen .node and .ele (H. Si, TetGen user's manual, "File formats").
#include "io/formats/node_numbers.hpp"
#include "io/formats/readers.hpp"
#include "io/formats/regions.hpp"

namespace vox::io {
namespace {

// The last attribute of a tet, where TetGen puts its region (option -A), if it is a whole number.
std::int32_t last_as_region(Scanner& in) {
    std::string_view last;
    while (!in.at_line_end()) last = in.word("an attribute");
    double number = 0;
    read_double(last.data(), last.data() + last.size(), number);
    return number == std::floor(number) && std::fabs(number) < 0x1p31 ? static_cast<std::int32_t>(number) : 0;
}

void read_nodes(const File& file, MeshData& data, NodeNumbers& numbers) {
    Scanner in(file, '#');
    in.skip_space();

    const auto count = in.count("number of nodes", 1, max_count);
    const auto dimension = in.integer<std::int64_t>("number of dimensions");
    if (dimension != 3) in.fail("expected 3 dimensions, found %lld", lld(dimension));
    in.skip_line();
    in.check_count("number of nodes", count, 7, max_count, in.offset()); // a node is at least "0 0 0 0"
    data.positions.reserve(3 * count);
    for (std::uint64_t i = 0; i < count; ++i) {
        in.skip_space();
        numbers.add(in.integer<std::int64_t>("a node number"));
        for (int k = 0; k < 3; ++k) data.positions.push_back(in.real("a coordinate"));
        in.skip_line(); // attributes and boundary marker
    }
    in.skip_space();
    if (!in.done()) in.expected(format("the end of the file after %llu nodes", llu(count)).c_str());
    numbers.finish(in);
}

void read_tets(const File& file, const NodeNumbers& numbers, Cells& cells, MeshData& data) {
    Scanner in(file, '#');
    in.skip_space();
    const auto count = in.count("number of tetrahedra", 1, max_count);
    const auto corners = in.integer<std::int64_t>("number of nodes per tetrahedron");
    if (corners != 4 && corners != 10)
        in.fail("expected 4 or 10 nodes per tetrahedron, found %lld", lld(corners));
    const bool has_attributes = !in.at_line_end() && in.peek() != "0";
    in.skip_line();
    in.check_count("number of tetrahedra", count, 9, max_count, in.offset());
    data.tets.reserve(4 * count);
    for (std::uint64_t i = 0; i < count; ++i) {
        in.skip_space();
        in.integer<std::int64_t>("a tetrahedron's number");
        std::uint32_t tet[4];
        for (std::int64_t c = 0; c < corners; ++c) {
            const auto number = in.integer<std::int64_t>("a node number");
            if (c < 4) tet[c] = numbers.vertex_of(number, in); // the others are on edges
        }
        cells.add(CellKind::tet, "", static_cast<std::uint64_t>(corners), tet,
                  has_attributes ? last_as_region(in) : 0, data);
        in.skip_line();
    }
    in.skip_space();
    if (!in.done()) in.expected(format("the end of the file after %llu tetrahedra", llu(count)).c_str());
}

} // namespace

MeshData read_tetgen(const File& node, const File& ele) {
    MeshData data;
    NodeNumbers numbers;
    read_nodes(node, data, numbers);
    Cells cells(ele);
    read_tets(ele, numbers, cells, data);
    return cells.finished(std::move(data));
}

} // namespace vox::io
