// Locators: what was prepared for queries at one moment, owned by whoever asks it.
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

// The grid is an owner as long as it lives, so that it can use the memory again. When it is the only one, no
// thread has the locator any more.
struct vox_locator {
    explicit vox_locator(const vox::MemoryShare& memory) : share(memory), queries(&*memory) {}
    vox_locator(const vox_locator&) = delete;
    vox_locator& operator=(const vox_locator&) = delete;

    vox::MemoryShare share; // first, as all else is released to it
    vox::Queries queries;
    std::uint64_t epoch = 0;
    std::atomic<std::uint64_t> owners = 1;
};

namespace vox {

void retain(vox_locator& locator) noexcept;
// Destroys the locator when this was its last owner.
void release(vox_locator& locator) noexcept;

// The locators of a grid that are in use, and those that wait for the next use.
class Locators {
public:
    explicit Locators(const MemoryShare& memory) : share_(memory), locators_(&*memory) {}
    Locators(const Locators&) = delete;
    Locators& operator=(const Locators&) = delete;
    ~Locators();

    // One more owner of it is the caller's. Throws as Queries::prepare(), and has taken none then.
    vox_locator* take(std::span<const QueryBody> bodies, Workers& workers, std::uint64_t epoch);
    // Gives up the memory of those that nobody uses.
    void clear() noexcept;

private:
    vox_locator& unused();

    MemoryShare share_;
    Array<vox_locator*> locators_;
};

} // namespace vox
