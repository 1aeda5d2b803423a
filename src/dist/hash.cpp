#include "dist/hash.hpp"

#include "dist/scene.hpp"

void vox_dist_scene::hash(std::uint64_t out[2]) {
    vox::dist::ContactSum sum;
    for (const vox_dist_contact& contact : contacts_) sum.add(contact);
    transport_.agree(nullptr, 0, sum.limbs, 4); // 32 bits each: the sum of all ranks does not overflow
    sum.write(out);
}
