// Writes Gmsh .msh 2.2 and 4.1 (Gmsh reference manual, "File formats"). All triangles belong to entity 1 of
// dimension 2. Tets without regions belong to entity 1 of dimension 3; with regions there is an entity for
// each, whose physical group is the region.
#include "base/llu.hpp"
#include "io/formats/writers.hpp"
#include "io/throw_error.hpp"

#include <algorithm>
#include <limits>

namespace vox::io {
namespace {

struct Kind {
    std::span<const std::uint32_t> corners;
    std::uint32_t nodes, type, dimension;
    std::uint64_t count() const { return corners.size() / nodes; }
};

// Writes the sections of a file. Numbers are bytes, or text in rows with a blank between two numbers.
class MshWriter {
public:
    MshWriter(const vox_io_mesh_view& mesh, bool binary, Output& out)
        : mesh_(mesh), binary_(binary), out_(out) {}

    void write(vox_io_write_format version, const WrittenData& values) {
        const bool version_41 = version == VOX_IO_WRITE_MSH_41;
        out_ << "$MeshFormat\n" << (version_41 ? "4.1" : "2.2") << (binary_ ? " 1 8\n" : " 0 8\n");
        if (binary_) out_.binary<std::uint32_t>(1) << '\n';
        out_ << "$EndMeshFormat\n";
        if (version_41)
            write_blocks();
        else
            write_lists();
        for (const vox_io_point_data& data : values.points) write_values("NodeData", data, vertices_);
        for (const vox_io_point_data& data : values.cells) write_values("ElementData", data, elements_);
    }

private:
    template <class Number>
    void put(Number number) {
        if (binary_) {
            out_.binary(number);
            return;
        }
        if (!row_is_empty_) out_ << ' ';
        out_ << number;
        row_is_empty_ = false;
    }
    void end_row() {
        if (!binary_) out_ << '\n';
        row_is_empty_ = true;
    }
    template <class... Number>
    void row(Number... numbers) {
        (put(numbers), ...);
        end_row();
    }

    void end_section(std::string_view mark) { out_ << (binary_ ? "\n" : "") << mark; }

    // ---- version 2.2; integers have 32 bits ----

    void write_lists() {
        if (elements_ > std::numeric_limits<std::int32_t>::max())
            throw_error(VOX_ERROR_LIMIT, "%llu elements are more than .msh 2.2 can number", llu(elements_));
        out_ << "$Nodes\n" << vertices_ << '\n';
        const double* p = mesh_.positions;
        for (std::uint32_t v = 0; v < vertices_; ++v, p += 3) row(v + 1, p[0], p[1], p[2]);
        end_section("$EndNodes\n");

        out_ << "$Elements\n" << elements_ << '\n';
        const std::uint32_t tags = 2;
        std::uint32_t number = 1;
        for (const Kind& kind : kinds_) {
            if (kind.count() == 0) continue;
            if (binary_) row(kind.type, static_cast<std::uint32_t>(kind.count()), tags);
            for (std::size_t i = 0; i < kind.corners.size(); i += kind.nodes) {
                put(number++);
                if (!binary_) {
                    put(kind.type);
                    put(tags);
                }
                const Volume volume = &kind == kinds_ ? Volume{1, 1} : volume_of(i / kind.nodes);
                put(volume.group);
                put(volume.entity);
                for (std::uint32_t c = 0; c < kind.nodes; ++c) put(kind.corners[i + c] + 1);
                end_row();
            }
        }
        end_section("$EndElements\n");
    }

    // ---- version 4.1; counts and the numbers of nodes and elements have 64 bits ----

    void write_blocks() {
        constexpr std::uint32_t parametric = 0, first_entity = 1;
        constexpr std::uint64_t one = 1;
        const bool volume = kinds_[1].count() > 0, surface = kinds_[0].count() > 0 || !volume;
        write_entities(surface, volume);

        out_ << "$Nodes\n"; // in one block
        row(one, vertices_, one, vertices_);
        row(std::uint32_t{volume ? 3u : 2u}, first_entity, parametric, vertices_);
        for (std::uint64_t v = 0; v < vertices_; ++v) row(v + 1);
        const double* p = mesh_.positions;
        for (std::uint64_t v = 0; v < vertices_; ++v, p += 3) row(p[0], p[1], p[2]);
        end_section("$EndNodes\n");

        out_ << "$Elements\n";
        std::uint64_t blocks = kinds_[0].count() > 0;
        for (std::uint64_t t = 0; t < kinds_[1].count(); t = end_of_run(kinds_[1], t)) ++blocks;
        row(blocks, elements_, one, elements_);
        std::uint64_t number = 1;
        for (const Kind& kind : kinds_) {
            std::uint64_t end = 0;
            for (std::uint64_t e = 0; e < kind.count(); ++e) {
                if (e == end) { // a block begins
                    end = end_of_run(kind, e);
                    row(kind.dimension, &kind == kinds_ ? 1 : volume_of(e).entity, kind.type, end - e);
                }
                const std::size_t i = static_cast<std::size_t>(e) * kind.nodes;
                put(number++);
                for (std::uint32_t c = 0; c < kind.nodes; ++c) put(std::uint64_t{kind.corners[i + c]} + 1);
                end_row();
            }
        }
        end_section("$EndElements\n");
    }

    // At most one surface, and volumes, all with the box of all vertices and without boundaries.
    void write_entities(bool surface, bool volume) {
        constexpr std::uint64_t none = 0;
        double box[6] = {};
        for (std::size_t i = 0; i < 3 * vertices_; ++i) {
            const std::size_t k = i % 3;
            box[k] = i < 3 ? mesh_.positions[i] : std::min(box[k], mesh_.positions[i]);
            box[3 + k] = i < 3 ? mesh_.positions[i] : std::max(box[3 + k], mesh_.positions[i]);
        }
        out_ << "$Entities\n";
        const std::uint64_t volumes = !volume ? 0 : regions_.empty() ? 1 : regions_.size();
        row(none, none, std::uint64_t{surface}, volumes);
        for (std::uint64_t v = surface ? 0 : 1; v <= volumes; ++v) {
            put(static_cast<std::uint32_t>(v > 0 ? v : 1));
            for (const double side : box) put(side);
            const std::int32_t group = v > 0 && !regions_.empty() ? regions_[v - 1] : 0;
            put(std::uint64_t{group != 0});
            if (group != 0) put(group);
            row(none);
        }
        end_section("$EndEntities\n");
    }

    // ---- regions ----

    struct Volume {
        std::int32_t group;
        std::uint32_t entity;
    };
    Volume volume_of(std::uint64_t tet) const {
        if (!mesh_.tet_regions) return {1, 1};
        const std::int32_t region = mesh_.tet_regions[tet];
        const auto place = std::lower_bound(regions_.begin(), regions_.end(), region) - regions_.begin();
        return {region, static_cast<std::uint32_t>(place + 1)};
    }
    // Where the elements of a kind that follow each other in one entity end.
    std::uint64_t end_of_run(const Kind& kind, std::uint64_t first) const {
        if (&kind == kinds_ || !mesh_.tet_regions) return kind.count();
        const std::int32_t* const regions = mesh_.tet_regions;
        const auto other = [&](std::int32_t region) { return region != regions[first]; };
        return static_cast<std::uint64_t>(std::find_if(regions + first, regions + kind.count(), other) -
                                          regions);
    }
    static std::vector<std::int32_t> sorted_regions(const vox_io_mesh_view& mesh) {
        std::vector<std::int32_t> regions;
        if (mesh.tet_regions) regions.assign(mesh.tet_regions, mesh.tet_regions + mesh.tet_count);
        std::sort(regions.begin(), regions.end());
        regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
        return regions;
    }

    // ---- both versions ----

    // `section` is NodeData or ElementData.
    void write_values(const std::string& section, const vox_io_point_data& array, std::uint64_t count) {
        out_ << "$" << section << "\n1\n\"" << array.name << "\"\n1\n0\n3\n0\n"
             << array.components << '\n'
             << count << '\n';
        const double* value = array.values;
        for (std::uint32_t i = 0; i < count; ++i) {
            put(i + 1);
            for (std::uint32_t c = 0; c < array.components; ++c) put(*value++);
            end_row();
        }
        end_section("$End" + section + "\n");
    }

    const vox_io_mesh_view& mesh_;
    const bool binary_;
    Output& out_;
    bool row_is_empty_ = true;
    const std::uint64_t vertices_ = mesh_.vertex_count;
    const Kind kinds_[2] = {{{mesh_.triangles, static_cast<std::size_t>(3 * mesh_.triangle_count)}, 3, 2, 2},
                            {{mesh_.tets, static_cast<std::size_t>(4 * mesh_.tet_count)}, 4, 4, 3}};
    const std::vector<std::int32_t> regions_ = sorted_regions(mesh_); // each once
    const std::uint64_t elements_ = kinds_[0].count() + kinds_[1].count();
};

} // namespace

void write_msh(const vox_io_mesh_view& mesh, vox_io_write_format version, const WrittenData& values,
               bool binary, Output& out) {
    MshWriter(mesh, binary, out).write(version, values);
}

} // namespace vox::io
