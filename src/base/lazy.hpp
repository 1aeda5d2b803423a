// A value that is made by the first const call that needs it, and then kept. If several threads call at the
// same time, each makes one, and the first that is ready is kept.
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

    // The reference is valid until the next call that is not const.
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
