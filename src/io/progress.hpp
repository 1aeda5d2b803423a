// Reports the progress of long work to the caller's function.
#pragma once

#include "base/float_environment.hpp"
#include "io/throw_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vox::io {

class Progress {
public:
    Progress() = default;
    Progress(std::int32_t (*receive)(double fraction, void* user), void* user)
        : receive_(receive), user_(user) {}

    // The progress of the part of this work from fraction `from` to fraction `to`.
    Progress part(double from, double to) const {
        Progress part = *this;
        part.from_ = at(from);
        part.to_ = at(to);
        return part;
    }

    // Throws INVALID_STATE if the receiver cancels.
    void report(double fraction) const {
        if (receive_ && cancels(at(fraction)))
            throw_error(VOX_ERROR_INVALID_STATE, "cancelled by the progress function at %.0f %%",
                        100 * at(fraction));
    }

private:
    bool cancels(double fraction) const {
        const CallersFloats floats;
        return receive_(fraction, user_) != 0;
    }
    double at(double fraction) const { return std::lerp(from_, to_, std::clamp(fraction, 0.0, 1.0)); }

    std::int32_t (*receive_)(double, void*) = nullptr;
    void* user_ = nullptr;
    double from_ = 0, to_ = 1;
};

} // namespace vox::io
