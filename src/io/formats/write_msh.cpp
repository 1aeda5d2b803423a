// Writes Gmsh .msh 2.2 and 4.1 (Gmsh reference manual, "File formats"). All triangles belong to entity 1 of
// dimension 2, all tets to entity 1 of dimension 3.
#include "base/error.hpp"
#include "base/llu.hpp"
#include "io/formats/writers.hpp"

#include <algorithm>
#include <limits>

namespace vox::io {
namespace {

struct Kind {
    const std::vector<std::uint32_t>& corners;
    std::uint32_t nodes, type, dimension;
    std::uint64_t count() const { return corners.size() / nodes; }
};

void write_header(const char* version, bool binary, Output& out) {
    out << "$MeshFormat\n" << version << (binary ? " 1 8\n" : " 0 8\n");
    if (binary) out.binary<std::int32_t>(1) << '\n';
    out << "$EndMeshFormat\n";
}

void write_position(const double* p, bool binary, Output& out) {
    if (binary)
        out.binary(p[0]).binary(p[1]).binary(p[2]);
    else
        out << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
}

// $NodeData is the same in both versions. Integers are int32.
void write_point_data(const MeshData& mesh, PointData point_data, bool binary, Output& out) {
    const std::uint64_t vertices = mesh.positions.size() / 3;
    for (const vox_io_point_data& array : point_data) {
        out << "$NodeData\n1\n\"" << array.name << "\"\n1\n0\n3\n0\n"
            << array.components << '\n'
            << vertices << '\n';
        for (std::uint64_t v = 0; v < vertices; ++v) {
            if (binary)
                out.binary(static_cast<std::int32_t>(v + 1));
            else
                out << v + 1;
            for (std::uint64_t c = 0; c < array.components; ++c) {
                const double value = array.values[v * array.components + c];
                if (binary)
                    out.binary(value);
                else
                    out << ' ' << value;
            }
            if (!binary) out << '\n';
        }
        out << (binary ? "\n$EndNodeData\n" : "$EndNodeData\n");
    }
}

// Writes $Entities of version 4.1: at most one surface and one volume, both with the box of all vertices, and
// without physical groups and boundaries.
void write_entities(const MeshData& mesh, bool surface, bool volume, bool binary, Output& out) {
    double box[6] = {};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const std::size_t k = i % 3;
        box[k] = i < 3 ? mesh.positions[i] : std::min(box[k], mesh.positions[i]);
        box[3 + k] = i < 3 ? mesh.positions[i] : std::max(box[3 + k], mesh.positions[i]);
    }
    out << "$Entities\n";
    if (binary)
        out.binary<std::uint64_t>(0)
            .binary<std::uint64_t>(0)
            .binary<std::uint64_t>(surface)
            .binary<std::uint64_t>(volume);
    else
        out << "0 0 " << (surface ? "1 " : "0 ") << (volume ? "1\n" : "0\n");
    for (const bool present : {surface, volume}) {
        if (!present) continue;
        if (binary)
            out.binary<std::int32_t>(1);
        else
            out << '1';
        for (const double x : box) {
            if (binary)
                out.binary(x);
            else
                out << ' ' << x;
        }
        if (binary)
            out.binary<std::uint64_t>(0).binary<std::uint64_t>(0);
        else
            out << " 0 0\n";
    }
    out << (binary ? "\n$EndEntities\n" : "$EndEntities\n");
}

} // namespace

void write_msh22(const MeshData& mesh, PointData point_data, bool binary, Output& out) {
    const std::uint64_t vertices = mesh.positions.size() / 3;
    const Kind kinds[] = {{mesh.triangles, 3, 2, 2}, {mesh.tets, 4, 4, 3}};
    const std::uint64_t elements = kinds[0].count() + kinds[1].count();
    if (elements > std::numeric_limits<std::int32_t>::max())
        throw Error(VOX_ERROR_LIMIT,
                    format("%llu elements are more than .msh 2.2 can number", llu(elements)));
    write_header("2.2", binary, out);
    out << "$Nodes\n" << vertices << '\n';
    for (std::uint64_t v = 0; v < vertices; ++v) {
        if (binary)
            out.binary(static_cast<std::int32_t>(v + 1));
        else
            out << v + 1 << ' ';
        write_position(&mesh.positions[3 * v], binary, out);
    }
    out << (binary ? "\n$EndNodes\n" : "$EndNodes\n") << "$Elements\n" << elements << '\n';
    std::uint32_t number = 1;
    for (const Kind& kind : kinds) {
        if (kind.count() == 0) continue;
        if (binary)
            out.binary(kind.type).binary(static_cast<std::uint32_t>(kind.count())).binary<std::uint32_t>(2);
        for (std::size_t i = 0; i < kind.corners.size(); i += kind.nodes) {
            if (binary)
                out.binary(number++).binary<std::uint32_t>(1).binary<std::uint32_t>(1);
            else
                out << number++ << ' ' << kind.type << " 2 1 1";
            for (std::uint32_t c = 0; c < kind.nodes; ++c) {
                if (binary)
                    out.binary(kind.corners[i + c] + 1);
                else
                    out << ' ' << kind.corners[i + c] + 1;
            }
            if (!binary) out << '\n';
        }
    }
    out << (binary ? "\n$EndElements\n" : "$EndElements\n");
    write_point_data(mesh, point_data, binary, out);
}

void write_msh41(const MeshData& mesh, PointData point_data, bool binary, Output& out) {
    const std::uint64_t vertices = mesh.positions.size() / 3;
    const Kind kinds[] = {{mesh.triangles, 3, 2, 2}, {mesh.tets, 4, 4, 3}};
    const std::uint64_t elements = kinds[0].count() + kinds[1].count();
    const std::uint64_t blocks = (kinds[0].count() > 0) + (kinds[1].count() > 0);
    const std::int32_t node_dimension = kinds[1].count() > 0 ? 3 : 2;
    write_header("4.1", binary, out);

    write_entities(mesh, node_dimension == 2 || kinds[0].count() > 0, node_dimension == 3, binary, out);

    // There is one block of nodes. It begins with its entity, `parametric` and the number of nodes.
    out << "$Nodes\n";
    if (binary) {
        out.binary<std::uint64_t>(1).binary(vertices).binary<std::uint64_t>(1).binary(vertices);
        out.binary(node_dimension).binary<std::int32_t>(1).binary<std::int32_t>(0).binary(vertices);
    } else {
        out << "1 " << vertices << " 1 " << vertices << '\n';
        out << static_cast<std::uint32_t>(node_dimension) << " 1 0 " << vertices << '\n';
    }
    for (std::uint64_t v = 0; v < vertices; ++v) {
        if (binary)
            out.binary(v + 1);
        else
            out << v + 1 << '\n';
    }
    for (std::uint64_t v = 0; v < vertices; ++v) write_position(&mesh.positions[3 * v], binary, out);
    out << (binary ? "\n$EndNodes\n" : "$EndNodes\n");

    out << "$Elements\n";
    if (binary)
        out.binary(blocks).binary(elements).binary<std::uint64_t>(1).binary(elements);
    else
        out << blocks << ' ' << elements << " 1 " << elements << '\n';
    std::uint64_t number = 1;
    for (const Kind& kind : kinds) {
        if (kind.count() == 0) continue;
        if (binary)
            out.binary(kind.dimension).binary<std::uint32_t>(1).binary(kind.type).binary(kind.count());
        else
            out << kind.dimension << " 1 " << kind.type << ' ' << kind.count() << '\n';
        for (std::size_t i = 0; i < kind.corners.size(); i += kind.nodes) {
            if (binary)
                out.binary(number++);
            else
                out << number++;
            for (std::uint32_t c = 0; c < kind.nodes; ++c) {
                const std::uint64_t node = std::uint64_t{kind.corners[i + c]} + 1;
                if (binary)
                    out.binary(node);
                else
                    out << ' ' << node;
            }
            if (!binary) out << '\n';
        }
    }
    out << (binary ? "\n$EndElements\n" : "$EndElements\n");
    write_point_data(mesh, point_data, binary, out);
}

} // namespace vox::io
