// A hash of contacts that does not depend on their order: a sum, modulo 2^128, of a mix of each.
#include "dist/hash.hpp"

#include "dist/scene.hpp"

using namespace vox;
using namespace vox::dist;

namespace vox::dist {
namespace {

// The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t x) noexcept {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

} // namespace

void ContactSum::add(const vox_scene_contact& c) noexcept {
    std::uint64_t words[7] = {c.body_a, c.vertex, c.body_b, c.tet, 0, 0, c.interior};
    std::memcpy(&words[4], c.barycentric, sizeof c.barycentric);
    std::uint64_t low = 1, high = 2;
    for (const std::uint64_t word : words) {
        low = mixed(low ^ word);
        high = mixed(high + word * 0x9fb21c651e98df25u);
    }
    limbs[0] += low & 0xffffffff;
    limbs[1] += low >> 32;
    limbs[2] += high & 0xffffffff;
    limbs[3] += high >> 32;
    carry();
}

void ContactSum::carry() noexcept {
    for (int i = 0; i < 4; ++i) {
        if (i < 3) limbs[i + 1] += limbs[i] >> 32;
        limbs[i] &= 0xffffffff;
    }
}

void ContactSum::write(std::uint64_t out[2]) noexcept {
    carry();
    out[0] = limbs[1] << 32 | limbs[0];
    out[1] = limbs[3] << 32 | limbs[2];
}

void hash_of_grid(const vox_grid* grid, std::uint64_t out[2]) {
    vox_contact_view contacts;
    vox_interior_view interiors;
    check(vox_grid_get_contacts(grid, &contacts));
    check(vox_grid_contact_interiors(grid, &interiors));
    ContactSum sum;
    for (std::uint64_t i = 0; i < contacts.count; ++i) {
        const auto& hit = *reinterpret_cast<const vox_contact*>(
            reinterpret_cast<const std::byte*>(contacts.data) + i * contacts.byte_stride);
        vox_scene_contact contact{};
        check(vox_body_get_user_data(grid, hit.body_a, &contact.body_a));
        check(vox_body_get_user_data(grid, hit.body_b, &contact.body_b));
        contact.vertex = hit.vertex;
        contact.tet = hit.tet;
        std::memcpy(contact.barycentric, hit.barycentric, sizeof hit.barycentric);
        contact.interior = interiors.data[i * interiors.byte_stride];
        sum.add(contact);
    }
    sum.write(out);
}

} // namespace vox::dist

void vox_scene::hash(std::uint64_t out[2]) {
    ContactSum sum;
    for (const vox_scene_contact& contact : contacts_) sum.add(contact);
    transport_.agree(nullptr, 0, sum.limbs, 4); // 32 bits each: the sum of all ranks does not overflow
    sum.write(out);
}
