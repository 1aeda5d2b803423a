// The interface of everything that is timed: a vox engine, a peer or a floor.
#pragma once

#include "scenes.hpp"

#include <vox/vox.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace bench {

class Entrant {
public:
    virtual ~Entrant() = default;

    // Gets the topology, and positions to build from. The scene outlives the entrant; its positions change
    // between steps.
    virtual void setup(const Scene& scene) = 0;

    // Finds its best settings for the scene.
    virtual void tune(const Scene&) {}

    // Finds every vertex in a closed tetrahedron for the positions as they are now. This is what is timed.
    virtual void step() = 0;

    // What the last step found, by the library's canonical rule, with bodies' indices for mesh ids. Not
    // timed.
    virtual std::vector<vox_contact> contacts() = 0;

    // Bytes held beside the scene's own arrays; 0: not known.
    virtual std::size_t bytes() const { return 0; }

    // The cell size in use; 0 where there is none.
    virtual double cell_size() const { return 0; }
};

enum class Kind { vox, peer, floor };

struct EntrantMaker {
    std::string name;
    Kind kind;
    std::function<std::unique_ptr<Entrant>()> make;
};

extern const std::string subject_name;   // a grid with constraints, whose figures are judged
extern const std::string avx2_name;      // the same with no more than AVX2
extern const std::string contacts_name;  // the default grid: contacts alone, as the peers find them
extern const std::string reference_name; // the paper's algorithm, contacts alone, that ratios are taken to

std::vector<EntrantMaker> vox_entrants();
vox_grid_desc grid_desc(const std::string& vox_entrant); // of the grid that this entrant steps
std::vector<EntrantMaker> peers();
std::vector<EntrantMaker> floors();

} // namespace bench
