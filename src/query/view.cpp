#include "query/view.hpp"

#include "base/room.hpp"

#include <algorithm>

namespace vox {

namespace {

// What the last other owner did with the view has happened before.
bool is_unused(const vox_query_view* view) noexcept {
    return view->owners.load(std::memory_order_acquire) == 1;
}

} // namespace

void retain(vox_query_view& view) noexcept { view.owners.fetch_add(1, std::memory_order_relaxed); }

void release(vox_query_view& view) noexcept {
    if (view.owners.fetch_sub(1, std::memory_order_acq_rel) > 1) return;
    const MemoryShare share = view.share;
    std::pmr::polymorphic_allocator<> allocator(&*share);
    allocator.delete_object(&view);
}

QueryViews::~QueryViews() {
    for (vox_query_view* view : views_) release(*view);
}

vox_query_view* QueryViews::take(std::span<const QueryBody> bodies, Workers& workers, std::uint64_t epoch) {
    vox_query_view& view = unused();
    view.queries.prepare(bodies, workers);
    view.epoch = epoch;
    retain(view);
    return &view;
}

void QueryViews::clear() noexcept {
    erase_if(views_, [](vox_query_view* view) {
        if (!is_unused(view)) return false;
        release(*view);
        return true;
    });
}

vox_query_view& QueryViews::unused() {
    const auto found = std::find_if(views_.begin(), views_.end(), is_unused);
    if (found != views_.end()) return **found;
    reserve_growing(views_, views_.size() + 1);
    std::pmr::polymorphic_allocator<> allocator(&*share_);
    views_.push_back(allocator.new_object<vox_query_view>(share_));
    return *views_.back();
}

} // namespace vox
