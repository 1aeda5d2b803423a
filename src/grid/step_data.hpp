// The arrays of one step, kept from step to step.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"
#include "fast/engine.hpp"
#include "fast/step_scene.hpp"
#include "mesh/topology.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <memory_resource>

namespace vox {

struct StepData {
    explicit StepData(std::pmr::memory_resource* memory)
        : bodies(memory), prepared(memory), topologies(memory), versions(memory), hits(memory),
          contacts(memory), interiors(memory) {}

    Array<Body> bodies;
    Array<fast::PreparedBody> prepared; // of each body that has tiles
    Array<const Topology*> topologies;  // of each body
    Array<SurfaceVersion> versions;     // of each body, while a stage looks at surfaces
    Array<Hit> hits;                    // of contacts, once these are made
    Array<vox_contact> contacts;
    Array<std::uint8_t> interiors; // whether each contact is interior
};

} // namespace vox
