#include "query/locator.hpp"

#include "base/room.hpp"

#include <algorithm>

namespace vox {

namespace {

// Synchronises with the last release by another owner.
bool is_unused(const vox_locator* locator) noexcept {
    return locator->owners.load(std::memory_order_acquire) == 1;
}

} // namespace

void retain(vox_locator& locator) noexcept { locator.owners.fetch_add(1, std::memory_order_relaxed); }

void release(vox_locator& locator) noexcept {
    if (locator.owners.fetch_sub(1, std::memory_order_acq_rel) > 1) return;
    const MemoryShare share = locator.share;
    std::pmr::polymorphic_allocator<> allocator(&*share);
    allocator.delete_object(&locator);
}

Locators::~Locators() {
    for (vox_locator* locator : locators_) release(*locator);
}

vox_locator* Locators::take(std::span<const QueryBody> bodies, Workers& workers, std::uint64_t epoch) {
    vox_locator& locator = unused();
    locator.queries.prepare(bodies, workers);
    locator.epoch = epoch;
    retain(locator);
    return &locator;
}

void Locators::clear() noexcept {
    erase_if(locators_, [](vox_locator* locator) {
        if (!is_unused(locator)) return false;
        release(*locator);
        return true;
    });
}

vox_locator& Locators::unused() {
    const auto found = std::find_if(locators_.begin(), locators_.end(), is_unused);
    if (found != locators_.end()) return **found;
    reserve_growing(locators_, locators_.size() + 1);
    std::pmr::polymorphic_allocator<> allocator(&*share_);
    locators_.push_back(allocator.new_object<vox_locator>(share_));
    return *locators_.back();
}

} // namespace vox
