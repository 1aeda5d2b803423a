// Locators: the state of a grid at one moment, prepared for queries and owned by its users.
#pragma once

#include "base/array.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "query/queries.hpp"

#include <vox/vox_query.h>

#include <atomic>
#include <cstdint>
#include <memory_resource>
#include <span>

// The grid is an owner as long as it lives, so that it can use the memory again once it is the only owner.
struct vox_locator {
    explicit vox_locator(const vox::MemoryShare& memory) : share(memory), queries(&*memory) {}
    vox_locator(const vox_locator&) = delete;
    vox_locator& operator=(const vox_locator&) = delete;

    vox::MemoryShare share; // first: the other members are released to it
    vox::Queries queries;
    std::uint64_t epoch = 0;
    std::atomic<std::uint64_t> owners = 1;
};

namespace vox {

void retain(vox_locator& locator) noexcept;
// Destroys the locator if this was its last owner.
void release(vox_locator& locator) noexcept;

// The locators of a grid: those in use, and those to be used again.
class Locators {
public:
    explicit Locators(const MemoryShare& memory) : share_(memory), locators_(&*memory) {}
    Locators(const Locators&) = delete;
    Locators& operator=(const Locators&) = delete;
    ~Locators();

    // The caller becomes an owner of the result. Throws like Queries::prepare().
    vox_locator* take(std::span<const QueryBody> bodies, Workers& workers, std::uint64_t epoch);
    // Releases the memory of unused ones.
    void clear() noexcept;

private:
    vox_locator& unused();

    MemoryShare share_;
    Array<vox_locator*> locators_;
};

} // namespace vox
