#include "surface/suggest.hpp"

#include "base/array.hpp"
#include "base/error.hpp"
#include "cell_size/foreign/grid.hpp"
#include "cell_size/suggest.hpp"
#include "mesh/facets.hpp"
#include "mesh/topology.hpp"
#include "surface/topology.hpp"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <optional>
#include <span>

namespace vox {

namespace {

// Nanoseconds, estimates: the time of a search is nearly all in comparing features, so the cells' own share
// is hard to measure, and what its minimum is off by costs little (bench/surface/pairs.py --sweep).
constexpr vox_foreign_weights tile_weights{0, 12, 6, 2, 2, 2, 0};

vox_primitives boxes_as_primitives(const Array<Box>& boxes) {
    static_assert(sizeof(Box) == 2 * sizeof(Box::lo) && sizeof(Box::lo) == 4 * sizeof(float));
    vox_primitives primitives = vox_default_primitives();
    primitives.type = VOX_PRIMITIVE_BOX;
    primitives.positions.data = boxes.data();
    primitives.positions.count = 2 * boxes.size();
    primitives.positions.byte_stride = sizeof(Box::lo);
    primitives.count = boxes.size();
    return primitives;
}

// The grid of the tiles of one kind, asked by those of another.
struct DescribedTiles {
    DescribedTiles(const FeatureTiles& a, const FeatureTiles& b, std::pmr::memory_resource* memory)
        : held(boxes_as_primitives(b.tile_boxes)), asking(boxes_as_primitives(a.tile_boxes)),
          grid(description(&a == &b)), work(grid, quick_look(grid), memory) {}
    DescribedTiles(const DescribedTiles&) = delete;
    DescribedTiles& operator=(const DescribedTiles&) = delete;

    vox_primitives held, asking;
    ForeignGrid grid;
    ForeignWork work;

private:
    ForeignGrid description(bool same) const {
        vox_foreign_grid desc = vox_default_foreign_grid();
        desc.stored = &held;
        desc.querying = same ? nullptr : &asking;
        desc.weights = tile_weights;
        return ForeignGrid(&desc);
    }
};

// The surfaces of bodies as one: the facets that no two tetrahedra share, with the vertices that they name.
struct CommonSurface {
    CommonSurface(std::span<const Body> bodies, std::pmr::memory_resource* memory)
        : positions(memory), faces(memory) {
        for (const Body& body : bodies) add(body);
    }

    Array<Vec3d> positions;
    Array<std::uint32_t> faces; // three vertices each

private:
    void add(const Body& body) {
        check_tet_count(body.tets.size());
        std::pmr::memory_resource* const memory = faces.memory();
        MatchedFacets facets(memory);
        match_facets(body.tets, body.vertex_count, facets);
        constexpr std::uint32_t unnamed = ~0u;
        Array<std::uint32_t> number_of(body.vertex_count, unnamed, memory);
        for (const Triangle& triangle : facets.triangles)
            for (const std::uint32_t v : triangle.v) {
                if (number_of[v] == unnamed) {
                    number_of[v] = static_cast<std::uint32_t>(positions.size());
                    positions.push_back(body.positions.exact(v));
                }
                faces.push_back(number_of[v]);
            }
    }
};

// The cost of the searches of a surface that stands still: edges with edges, faces with vertices.
class SurfaceModel {
public:
    SurfaceModel(std::span<const Body> bodies, std::pmr::memory_resource* memory)
        : tiles_{FeatureTiles(memory), FeatureTiles(memory), FeatureTiles(memory)} {
        const CommonSurface surface(bodies, memory);
        if (surface.faces.empty()) refuse("no surface: the tetrahedra have no facets, or share all of them");
        vox_surface_desc desc{};
        desc.vertex_count = surface.positions.size();
        desc.faces = surface.faces.data();
        desc.face_count = surface.faces.size() / 3;
        const SurfaceTopology topology(desc, memory);
        const SurfaceMotion still{surface.positions, surface.positions, 0, true, false};
        Array<Box> boxes(memory);
        make_vertex_boxes(still, boxes);
        for (const vox_feature kind : {VOX_FEATURE_VERTEX, VOX_FEATURE_EDGE, VOX_FEATURE_FACE}) {
            FeatureTiles& tiles = tiles_[static_cast<std::size_t>(kind)];
            make_feature_tiles(topology, kind, still.from, tiles);
            make_boxes(boxes, tiles);
        }
        edges_.emplace(of(VOX_FEATURE_EDGE), of(VOX_FEATURE_EDGE), memory);
        faces_.emplace(of(VOX_FEATURE_FACE), of(VOX_FEATURE_VERTEX), memory);
    }

    // The sizes among which the one of least cost is: it lies between those that are best for either search.
    CellSizeRange range() {
        const vox_cell_size_result of_edges = suggest_for(edges_->grid, edges_->work),
                                   of_faces = suggest_for(faces_->grid, faces_->work);
        return {std::min(of_edges.zone_min, of_faces.zone_min),
                std::max(of_edges.zone_max, of_faces.zone_max)};
    }

    CostTerms terms(double cell_size) {
        const vox_foreign_counts e = edges_->work.at(cell_size), f = faces_->work.at(cell_size);
        const vox_foreign_weights& w = tile_weights;
        CostTerms terms;
        terms.add("put a tile into a cell", e.stored + f.stored, w.store);
        terms.add("visit a cell", e.visits + f.visits, w.visit);
        terms.add("find a list there", e.visits - e.empty + f.visits - f.empty, w.found);
        terms.add("read a tile's number", e.reads + f.reads, w.read);
        terms.add("make a cell", e.occupied + f.occupied, w.occupied);
        return terms;
    }

private:
    const FeatureTiles& of(vox_feature kind) const { return tiles_[static_cast<std::size_t>(kind)]; }

    std::array<FeatureTiles, feature_kinds> tiles_;
    std::optional<DescribedTiles> edges_, faces_;
};

void check_size(const vox_geometry& stats) {
    if (stats.tets == 0)
        refuse(format("no tetrahedra: %" PRIu64 " vertices alone give no surface", stats.vertices));
    if (!(stats.mean_box_side > 0))
        refuse(format("%" PRIu64 " tets of no size: mean box side 0", stats.tets));
}

} // namespace

vox_cell_size_result suggest_for_tiles(const FeatureTiles& a, const FeatureTiles& b,
                                       std::pmr::memory_resource* memory) {
    DescribedTiles tiles(a, b, memory);
    return suggest_for(tiles.grid, tiles.work);
}

vox_cell_size_result suggest_for_surfaces(const vox_cell_size_desc& desc, CellSizeScene& scene) {
    scene.prepare(desc.model); // finds positions that are not finite
    check_size(scene.geometry.stats);
    SurfaceModel model(scene.bodies, scene.memory);
    const CellSizeRange range = model.range();
    return suggest_by(desc, scene.geometry, [&](double cell_size) { return model.terms(cell_size); }, range,
                      {range.min / 8, range.max * 8});
}

} // namespace vox
