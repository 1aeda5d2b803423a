// What proximities and impacts have in common: of each vertex near a surface, the face with the least of some
// number, a distance or a time.
#pragma once

#include "base/counters.hpp"
#include "grid/pairs.hpp"
#include "grid/vertex_face_search.hpp"

#include <vox/vox.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <tuple>

namespace vox {

namespace depth {
class SurfaceTrees;
}
struct ConstraintSources;

// A vertex and a face of the surface of another body.
struct VertexFace {
    vox_body body_a;
    std::uint32_t vertex;
    vox_body body_b;
    std::uint32_t tet, facet; // of body_b
    std::uint32_t face[3];    // its vertices
};

// What contacts of a vertex are sorted by, whatever their kind.
template <class Element>
auto place_of(const Element& element) noexcept {
    return std::tuple(element.body_a, element.vertex, element.body_b);
}

// `Element` is a VertexFace and more, `Tile` what is read of a tile for all vertices near it.
template <class Element, class Tile>
class LeastFaces : protected VertexFaceSearch {
public:
    static constexpr auto time = &Profile::margin_ns;

    bool is_unchanged() const noexcept { return false; }
    std::span<const vox_pair> pairs() const noexcept { return pairs_; }
    void clear() noexcept {
        all_.clear();
        pairs_.clear();
    }

protected:
    std::span<const Element> all() const noexcept { return all_; } // in canonical order

    // The least face so far of a vertex; of several with the same number that of the lowest (tet, facet).
    struct Least {
        std::uint32_t place; // of the vertex in the pair
        std::uint32_t face;  // of the surface
        std::array<std::uint32_t, 3> corners;
        double number;
    };
    struct Found {
        Element element;
        double number;
    };
    struct Worker {
        explicit Worker(std::pmr::memory_resource* memory)
            : found(memory), least(memory), of_vertex(memory) {}
        auto buffers() { return std::tie(found, least, of_vertex); }

        Array<Found> found;
        // The pair that the worker is at.
        VertexFacePair pair{};
        Array<Least> least;
        struct OfVertex {
            double most;         // that the number of another face may be
            std::uint32_t least; // its index; none_yet
        };
        Array<OfVertex> of_vertex;
        std::uint64_t candidates = 0; // of the step
        // The tile that it is at.
        const SurfaceTile* tile = nullptr;
        Tile read;
    };
    static constexpr std::uint32_t none_yet = ~0u;

    explicit LeastFaces(std::pmr::memory_resource* memory)
        : VertexFaceSearch(memory), workers_(memory), found_(memory), order_(memory), all_(memory),
          pairs_(memory) {}
    ~LeastFaces() = default;

    // Reads worker.tile.
    virtual void load(Worker& worker) const = 0;
    // May remove faces that are certainly too far from their vertex.
    virtual void sieve(Worker&, std::span<NearFaces>) const {}
    // Calls offer() for those of the faces that a vertex is near to which may be its least.
    virtual void look(Worker& worker, const NearFaces& near) const = 0;
    virtual Element element_of(const Worker& worker, const Least& least) const = 0;

    // Begins a step. Numbers above `most` count for nothing.
    void begin_step(const StepScene& scene, double most) {
        scene_ = scene;
        most_ = most;
        workers_.grow(scene.workers->count());
        for (Worker& worker : workers_) {
            worker.found.clear();
            worker.candidates = 0;
        }
        found_.clear();
    }
    // Carries over those of the step before between bodies at rest: the only ones of their vertex and mesh.
    std::size_t carry() {
        scene_.carry(all(), [&](const Element& element) {
            reserve_sparingly(found_, found_.size() + 1);
            found_.push_back({element, 0});
        });
        return found_.size();
    }
    // Replaces all() by what was found.
    void end_step(const char* what) {
        std::size_t count = found_.size();
        candidates_ = 0;
        for (const Worker& worker : workers_) {
            count += worker.found.size();
            candidates_ += worker.candidates;
        }
        reserve_sparingly(found_, count);
        for (const Worker& worker : workers_)
            found_.insert(found_.end(), worker.found.begin(), worker.found.end());
        for (Worker& worker : workers_) { // in a later step, one may find all
            reserve_sparingly(worker.found, count);
            reserve_sparingly(worker.least, count);
        }
        workers_.level();
        put_in_order();
        check_contact_count(all_.size(), what);
    }

    void count_candidates(Counters& counters) const noexcept { counters.face_candidates += candidates_; }

    const StepScene& scene() const noexcept { return scene_; } // of the last step
    Vec3d position(std::uint32_t body, std::uint32_t vertex) const noexcept {
        return scene_.bodies[body].positions.exact(vertex);
    }

    // Makes the face of this number in the tile the least of a vertex, unless it has a lower one.
    void offer(Worker& worker, std::uint32_t vertex_place, std::uint32_t face_in_tile, double number) const {
        const SurfaceFeatures& surface = *worker.pair.surface;
        const std::uint32_t face = worker.tile->first_face + face_in_tile;
        const auto key_of = [&](std::uint32_t f) { return std::tuple(surface.tets[f], surface.facets[f]); };
        auto& [most, index] = worker.of_vertex[vertex_place];
        if (number > most ||
            (number == most && index != none_yet && !(key_of(face) < key_of(worker.least[index].face))))
            return;
        if (index == none_yet) {
            index = static_cast<std::uint32_t>(worker.least.size());
            reserve_growing(worker.least, worker.least.size() + 1);
            worker.least.emplace_back();
        }
        most = number;
        Least& least = worker.least[index];
        least.place = vertex_place;
        least.face = face;
        for (std::size_t i = 0; i < 3; ++i)
            least.corners[i] = surface.vertices[worker.tile->first_vertex + surface.faces[face][i]];
        least.number = number;
    }

    // The vertex and the face, for element_of().
    VertexFace vertex_face(const Worker& worker, const Least& least) const {
        const auto& [u, v, w] = least.corners;
        return {scene_.bodies[worker.pair.a].mesh_id,    worker.pair.vertices[least.place],
                scene_.bodies[worker.pair.b].mesh_id,    worker.pair.surface->tets[least.face],
                worker.pair.surface->facets[least.face], {u, v, w}};
    }

private:
    void begin(const VertexFacePair& pair, std::uint32_t w) final {
        Worker& worker = workers_[w];
        worker.pair = pair;
        worker.tile = nullptr;
        worker.least.clear();
        reserve_growing(worker.of_vertex, pair.vertices.size());
        worker.of_vertex.assign(pair.vertices.size(), {most_, none_yet});
    }
    void visit(const SurfaceTile& tile, std::span<NearFaces> near, std::uint32_t w) final {
        Worker& worker = workers_[w];
        if (worker.tile != &tile) {
            worker.tile = &tile;
            load(worker);
        }
        sieve(worker, near);
        for (const NearFaces& one : near) look(worker, one);
    }
    void end(std::uint32_t w) final {
        Worker& worker = workers_[w];
        reserve_growing(worker.found, worker.found.size() + worker.least.size());
        for (const Least& least : worker.least)
            worker.found.push_back({element_of(worker, least), least.number});
    }
    double latest(std::uint32_t place, std::uint32_t w) noexcept final {
        return workers_[w].of_vertex[place].most;
    }
    // The least of each vertex and mesh, as pieces of a pair each found one.
    void put_in_order() {
        order_.clear();
        reserve_sparingly(order_, found_.size());
        for (std::uint32_t i = 0; i < found_.size(); ++i) order_.push_back(i);
        std::sort(order_.begin(), order_.end(), [&](std::uint32_t i, std::uint32_t j) {
            const Element &x = found_[i].element, &y = found_[j].element;
            return std::tie(x.body_a, x.vertex, x.body_b, found_[i].number, x.tet, x.facet) <
                   std::tie(y.body_a, y.vertex, y.body_b, found_[j].number, y.tet, y.facet);
        });
        all_.clear();
        reserve_sparingly(all_, found_.size());
        for (const std::uint32_t i : order_)
            if (all_.empty() || place_of(all_.back()) != place_of(found_[i].element))
                all_.push_back(found_[i].element);
    }

    StepScene scene_{};
    double most_ = 0;
    PerWorker<Worker> workers_;
    std::uint64_t candidates_ = 0;
    Array<Found> found_;
    Array<std::uint32_t> order_;
    Array<Element> all_;

protected:
    Array<vox_pair> pairs_; // of bodies with contacts, in order
};

} // namespace vox
