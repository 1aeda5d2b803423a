// TetGen .node and .ele (H. Si, TetGen user's manual, "File formats").
#include "io/formats/node_numbers.hpp"
#include "io/formats/readers.hpp"

namespace vox::io {
namespace {

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

void read_tets(const File& file, const NodeNumbers& numbers, MeshData& data) {
    Scanner in(file, '#');
    in.skip_space();
    const auto count = in.count("number of tetrahedra", 1, max_count);
    const auto corners = in.integer<std::int64_t>("number of nodes per tetrahedron");
    if (corners != 4 && corners != 10)
        in.fail("expected 4 or 10 nodes per tetrahedron, found %lld", lld(corners));
    in.skip_line();
    in.check_count("number of tetrahedra", count, 9, max_count, in.offset());
    data.tets.reserve(4 * count);
    for (std::uint64_t i = 0; i < count; ++i) {
        in.skip_space();
        in.integer<std::int64_t>("a tetrahedron's number");
        for (std::int64_t c = 0; c < corners; ++c) {
            const auto number = in.integer<std::int64_t>("a node number");
            if (c >= 4) continue; // nodes on edges
            data.tets.push_back(numbers.vertex_of(number, in));
        }
        in.skip_line(); // attributes
    }
    in.skip_space();
    if (!in.done()) in.expected(format("the end of the file after %llu tetrahedra", llu(count)).c_str());
    if (corners == 10) data.second_order_tets = count;
}

} // namespace

MeshData read_tetgen(const File& node, const File& ele) {
    MeshData data;
    NodeNumbers numbers;
    read_nodes(node, data, numbers);
    read_tets(ele, numbers, data);
    return finished(std::move(data), {}, ele.name);
}

} // namespace vox::io
