// How far a long piece of work has come, for the caller's progress function.
#pragma once

#include "error.hpp"

#include <algorithm>
#include <cstdint>

namespace vox::io {

class Progress {
public:
    Progress() = default;
    Progress(std::int32_t (*receive)(double fraction, void* user), void* user)
        : receive_(receive), user_(user) {}

    // Throws INVALID_STATE when the receiver wants the work to end.
    void report(double fraction) const {
        if (receive_ && receive_(std::clamp(fraction, 0.0, 1.0), user_) != 0)
            throw Error(VOX_ERROR_INVALID_STATE,
                        format("cancelled by the progress function at %.0f %%", 100 * fraction));
    }

private:
    std::int32_t (*receive_)(double, void*) = nullptr;
    void* user_ = nullptr;
};

} // namespace vox::io
