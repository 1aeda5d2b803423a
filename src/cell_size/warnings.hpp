// Warnings of a cell size, with their texts.
#pragma once

#include <vox/vox_cell_size.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

namespace vox {

// Adds a warning, and its text to the note, which ends where it is full.
inline void add_warning(vox_cell_size_result& result, vox_cell_size_warnings warning,
                        const std::string& text) noexcept {
    result.warnings |= static_cast<std::uint32_t>(warning);
    const std::size_t used = std::strlen(result.note);
    (void)std::snprintf(result.note + used, sizeof result.note - used, "%s%s", used > 0 ? "; " : "",
                        text.c_str());
}

} // namespace vox
