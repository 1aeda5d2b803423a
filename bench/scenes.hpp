// The benchmark's scenes: deforming bodies made from a size and a seed, or read from a folder of meshes.
#pragma once

#include "bodies.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace bench {

struct Body {
    std::vector<float>
        positions; // of the current frame: 3 * vertex_count, and one more to load four at a time
    std::vector<std::vector<float>> frames;
    // Positions of the frames after those; null: the same again.
    std::function<std::vector<float>(std::size_t frame)> later;
    std::vector<std::uint32_t> tets; // 4 * tet_count
    bool self_collision = false;

    std::size_t vertex_count() const { return positions.size() / 3; }
    std::size_t tet_count() const { return tets.size() / 4; }
    vox_mesh_desc desc() const; // positions are borrowed
};

struct Scene {
    std::string name;
    std::vector<Body> bodies;
    double mean_edge = 0;

    std::size_t vertex_count() const;
    std::size_t tet_count() const;
    std::size_t frame_count() const { return bodies.front().frames.size(); }
    // Writes the positions of a frame, of any number, as a simulation would, into the memory that the
    // entrants read.
    void pose(std::size_t frame);
};

// The position of a vertex in a frame.
using Pose = std::function<Vec3(const Vec3& rest, std::size_t frame)>;

// Adds a body with its frames.
void add(Scene& scene, const Solid& solid, const Pose& pose, bool self_collision = false);

// The mean over the six edges of each tetrahedron.
double mean_edge(std::span<const Body> bodies);

struct SceneMaker {
    std::string name;
    std::string title;
    bool sized;                                           // false: it has a size of its own
    std::function<Scene(double tets, bool shuffle)> make; // about `tets` tetrahedra in all
};

// All scenes; those of `mesh_folder` (bunny, cow and armadillo as Gmsh files) are left out when it is empty.
// `shuffle` gives vertices and tetrahedra random numbers instead of the generator's.
std::vector<SceneMaker> scene_makers(const std::string& mesh_folder);

// The same, whose scenes know their name and their mean edge.
std::vector<SceneMaker> named(std::vector<SceneMaker> makers);

// A body from a file and its turned copy, so far apart that `share` of the tetrahedra hold a vertex of the
// other one.
Scene pair_from_file(const std::string& path, double share);

} // namespace bench
