// How far a long piece of work has come, for the caller's progress function.
#pragma once

#include "base/error.hpp"

#include <algorithm>
#include <cstdint>

namespace vox::io {

class Progress {
public:
    Progress() = default;
    Progress(std::int32_t (*receive)(double fraction, void* user), void* user)
        : receive_(receive), user_(user) {}

    // The part of this work from `from` to `to`, as a work of its own.
    Progress part(double from, double to) const {
        Progress part = *this;
        part.from_ = at(from);
        part.to_ = at(to);
        return part;
    }

    // Throws INVALID_STATE when the receiver wants the work to end.
    void report(double fraction) const {
        if (receive_ && receive_(at(fraction), user_) != 0)
            throw Error(VOX_ERROR_INVALID_STATE,
                        format("cancelled by the progress function at %.0f %%", 100 * at(fraction)));
    }

private:
    double at(double fraction) const { return from_ + (to_ - from_) * std::clamp(fraction, 0.0, 1.0); }

    std::int32_t (*receive_)(double, void*) = nullptr;
    void* user_ = nullptr;
    double from_ = 0, to_ = 1;
};

} // namespace vox::io
