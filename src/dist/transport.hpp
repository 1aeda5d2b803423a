// The caller's transport: its failures as exceptions, and counts of its messages.
#pragma once

#include "base/error.hpp"
#include "base/float_environment.hpp"

#include <vox/vox_dist.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

namespace vox::dist {

class Transport {
public:
    explicit Transport(const vox_dist_transport& callbacks) : callbacks_(callbacks) {}
    std::uint32_t rank() const noexcept { return callbacks_.rank; }
    std::uint32_t size() const noexcept { return callbacks_.size; }

    void allgather(const void* in, std::uint64_t bytes, void* out) {
        ++collectives;
        if (!callbacks_.allgather) return static_cast<void>(std::memcpy(out, in, bytes));
        const CallersFloats floats;
        check_transport(callbacks_.allgather(in, bytes, out, callbacks_.user), "allgather");
    }
    void exchange(const std::uint32_t* ranks, std::uint32_t count, const vox_dist_message* out,
                  vox_dist_message* in) {
        messages += count;
        if (!callbacks_.exchange) return;
        const CallersFloats floats;
        check_transport(callbacks_.exchange(ranks, count, out, in, callbacks_.user), "exchange");
    }
    void agree(std::uint64_t* minima, std::uint32_t minimum_count, std::uint64_t* sums,
               std::uint32_t sum_count) {
        ++collectives;
        if (!callbacks_.agree) return;
        const CallersFloats floats;
        check_transport(callbacks_.agree(minima, minimum_count, sums, sum_count, callbacks_.user), "agree");
    }

    std::uint64_t messages = 0, collectives = 0;

private:
    static void check_transport(vox_result result, const char* function) {
        if (result == VOX_OK) return;
        throw Error(result, format("the transport's %s failed with %s", function, vox_result_string(result)));
    }

    vox_dist_transport callbacks_;
};

// A failure of this rank in a collective function. The rank goes on with messages that say so, so that no
// rank waits. A rank that receives such a message stops, too, without a failure of its own.
class Failure {
public:
    template <class Function>
    void guard(Function&& function) {
        if (*this) return;
        try {
            function();
        } catch (const Error& error) {
            set(error.result(), error.what());
        } catch (const std::bad_alloc&) {
            set(VOX_ERROR_OUT_OF_MEMORY, "out of memory");
        } catch (const std::exception& error) {
            set(VOX_ERROR_INTERNAL, error.what());
        }
    }
    // Adopts another failure, unless there is one already.
    void take(const Failure& other) noexcept {
        if (result_ == VOX_OK) set(other.result_, other.text_);
    }
    // Another rank failed.
    void follow() noexcept { follows_ = true; }
    vox_result result() const noexcept { return result_; }
    explicit operator bool() const noexcept { return result_ != VOX_OK || follows_; }

    // The failure of a rank as a number; the least is that of the lowest rank that failed.
    static std::uint64_t as_minimum(std::int32_t result, std::uint32_t rank) noexcept {
        if (result == VOX_OK) return UINT64_MAX;
        return std::uint64_t{rank} << 32 | static_cast<std::uint32_t>(-result);
    }
    // Throws the failure that all ranks agreed upon, if there is one.
    void throw_agreed(std::uint64_t minimum, std::uint32_t rank) const {
        if (minimum == UINT64_MAX) return;
        const auto failed = static_cast<std::uint32_t>(minimum >> 32);
        const auto result = static_cast<vox_result>(-static_cast<std::int32_t>(minimum & 0xffffffff));
        if (failed == rank) throw Error(result, text_);
        throw Error(result, format("rank %u failed with %s; its vox_last_error says more", failed,
                                   vox_result_string(result)));
    }
    // Takes part in the agreement that ends a collective function, and throws what it says. `sum` becomes the
    // sum over all ranks.
    void agree(Transport& transport, std::uint64_t* sum = nullptr) const {
        std::uint64_t minimum = as_minimum(result_, transport.rank());
        transport.agree(&minimum, 1, sum, sum ? 1 : 0);
        throw_agreed(minimum, transport.rank());
    }

private:
    void set(vox_result result, const char* text) noexcept {
        result_ = result;
        std::snprintf(text_, sizeof text_, "%s", text);
    }

    vox_result result_ = VOX_OK;
    bool follows_ = false;
    char text_[1024] = "";
};

} // namespace vox::dist
