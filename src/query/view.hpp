// Query views: what was prepared for queries at one moment, owned by whoever asks it.
#pragma once

#include "base/array.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "query/queries.hpp"

#include <vox/vox.h>

#include <atomic>
#include <cstdint>
#include <memory_resource>
#include <span>

// The grid is an owner as long as it lives, so that it can use the memory again. When it is the only one, no
// thread has the view any more.
struct vox_query_view {
    explicit vox_query_view(const vox::MemoryShare& memory) : share(memory), queries(&*memory) {}
    vox_query_view(const vox_query_view&) = delete;
    vox_query_view& operator=(const vox_query_view&) = delete;

    vox::MemoryShare share; // first, as all else is released to it
    vox::Queries queries;
    std::uint64_t epoch = 0;
    std::atomic<std::uint64_t> owners = 1;
};

namespace vox {

void retain(vox_query_view& view) noexcept;
// Destroys the view when this was its last owner.
void release(vox_query_view& view) noexcept;

// The views of a grid that are in use, and those that wait for the next use.
class QueryViews {
public:
    explicit QueryViews(const MemoryShare& memory) : share_(memory), views_(&*memory) {}
    QueryViews(const QueryViews&) = delete;
    QueryViews& operator=(const QueryViews&) = delete;
    ~QueryViews();

    // One more owner of it is the caller's. Throws as Queries::prepare(), and has taken none then.
    vox_query_view* take(std::span<const QueryBody> bodies, Workers& workers, std::uint64_t epoch);
    // Gives up the memory of those that nobody uses.
    void clear() noexcept;

private:
    vox_query_view& unused();

    MemoryShare share_;
    Array<vox_query_view*> views_;
};

} // namespace vox
