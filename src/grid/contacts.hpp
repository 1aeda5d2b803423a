// From hits to contacts: the canonical order and the one-contact rule for shared faces (see vox_contact), and
// the hash.
#pragma once

#include "base/array.hpp"
#include "base/scene.hpp"

#include <vox/vox.h>

#include <cstdint>
#include <span>

namespace vox {

class Workers;

// Sorts `hits` (any order in, duplicates not allowed) and writes the contacts they amount to; `hits` is left
// with the ones that became contacts. `workers` share the work, as at most four tasks of the step; null: the
// calling thread does it. `interiors`, if not null, receives for each contact whether it is interior (0 or
// 1).
void make_contacts(std::span<const Body> bodies, Array<Hit>& hits, Array<vox_contact>& contacts,
                   Workers* workers = nullptr, Array<std::uint8_t>* interiors = nullptr);

// vox_grid_get_hash of a list of contacts: of its length and of all fields in order, as numbers, so that byte
// order and padding do not matter. Each contact is taken as the two 64-bit words
//     body_a + vertex * 2^32, body_b + tet * 2^32;
// a word w turns the state h, at first the number of contacts, into h' = m ^ (m >> 29) with
//     m = (h ^ w) * 0x9fb21c651e98df25 mod 2^64,
// a bijection of h for every w and of w for every h.
std::uint64_t hash_contacts(std::span<const vox_contact> contacts) noexcept;

} // namespace vox
