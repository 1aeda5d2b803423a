// Values that are made on demand.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace vox {

// Made by the first call of get(), and then kept. If several threads call at the same time, each makes a
// value, and the first one ready is kept.
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
        auto value = std::make_unique<T>(std::forward<Make>(make)());
        const T* first = nullptr;
        if (!made_.compare_exchange_strong(first, value.get(), std::memory_order_acq_rel,
                                           std::memory_order_acquire))
            return *first;
        return *value.release();
    }

    void reset() noexcept { delete made_.exchange(nullptr); }

private:
    mutable std::atomic<const T*> made_ = nullptr;
};

} // namespace vox
