// Values that are made on demand.
#pragma once

#include <atomic>
#include <memory>
#include <memory_resource>
#include <new>
#include <type_traits>
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

// A value that few objects need: a pointer until it is made, and as if empty before. A T is made from a
// memory_resource*, which then takes no memory and cannot fail.
template <class T>
class Rare {
    static_assert(std::is_nothrow_constructible_v<T, std::pmr::memory_resource*>);

public:
    Rare() noexcept = default;
    Rare(Rare&& other) noexcept : made_(std::exchange(other.made_, nullptr)) {}
    Rare& operator=(Rare&& other) noexcept {
        std::swap(made_, other.made_);
        return *this;
    }
    ~Rare() {
        if (!made_) return;
        std::pmr::memory_resource* memory = made_->memory;
        made_->~Made();
        memory->deallocate(made_, sizeof(Made), alignof(Made));
    }

    const T& operator*() const noexcept {
        static const T empty(std::pmr::null_memory_resource());
        return made_ ? made_->value : empty;
    }
    const T* operator->() const noexcept { return &**this; }

    // To change it; null before it is made.
    T* if_made() noexcept { return made_ ? &made_->value : nullptr; }
    // Makes it, unless that is done. Throws what the memory throws.
    T& make(std::pmr::memory_resource* memory) {
        if (!made_) made_ = ::new (memory->allocate(sizeof(Made), alignof(Made))) Made(memory);
        return made_->value;
    }

private:
    struct Made {
        explicit Made(std::pmr::memory_resource* from) noexcept : memory(from), value(from) {}

        std::pmr::memory_resource* memory;
        T value;
    };

    Made* made_ = nullptr;
};

} // namespace vox
