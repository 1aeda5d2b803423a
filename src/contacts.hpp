// From hits to contacts: the canonical order and the one-contact rule for shared faces (design: contact semantics of
// vox_contact), barycentric coordinates, and the hash.
#pragma once

#include "scene.hpp"

#include <vox/vox.h>

#include <memory_resource>
#include <span>
#include <vector>

namespace vox {

// Sorts `hits` (any order in, duplicates not allowed) and writes the contacts they amount to. `scratch` is a
// buffer kept from step to step.
void make_contacts(std::span<const Body> bodies, std::pmr::vector<Hit>& hits, std::pmr::vector<Hit>& scratch,
                   std::pmr::vector<vox_contact>& contacts);

// vox_grid_hash of a list of contacts.
std::uint64_t hash_contacts(std::span<const vox_contact> contacts) noexcept;

} // namespace vox
