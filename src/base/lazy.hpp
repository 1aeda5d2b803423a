// What const calls make when the first of them wants it, and keep. They may come at the same time: each makes
// its own then, and the first one that is ready stays.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace vox {

template <class T>
class Lazy {
public:
    Lazy() noexcept = default;
    Lazy(Lazy&& other) noexcept : made_(other.made_.exchange(nullptr)) {}
    Lazy& operator=(Lazy&& other) noexcept {
        delete made_.exchange(other.made_.exchange(nullptr));
        return *this;
    }
    ~Lazy() { reset(); }

    // The reference stays good until the next call that is not const.
    template <class Make>
    const T& get(Make&& make) const {
        if (const T* made = made_.load(std::memory_order_acquire)) return *made;
        auto own = std::make_unique<T>(std::forward<Make>(make)());
        const T* there = nullptr;
        if (!made_.compare_exchange_strong(there, own.get(), std::memory_order_acq_rel,
                                           std::memory_order_acquire))
            return *there;
        return *own.release();
    }

    void reset() noexcept { delete made_.exchange(nullptr); }

private:
    mutable std::atomic<const T*> made_ = nullptr;
};

} // namespace vox
