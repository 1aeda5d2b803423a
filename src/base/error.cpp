#include "base/error.hpp"

#include "base/structs.hpp"

#include <iterator>

namespace {

constexpr std::size_t text_capacity = 1024;
thread_local char last_error[text_capacity] = "";

} // namespace

vox_result vox_fail(vox_result result, const char* text) {
    if (!text) text = "";
    // memmove, because a failure that is passed on has this very buffer as its text.
    std::size_t length = strnlen(text, text_capacity - 1);
    if (text[length] != 0) length = vox::whole_characters(text, length);
    std::memmove(last_error, text, length);
    last_error[length] = '\0';
    return result;
}

const char* vox_last_error(void) { return last_error; }

const char* vox_result_string(vox_result result) {
    constexpr const char* names[] = {"VOX_OK",
                                     "VOX_ERROR_INVALID_ARGUMENT",
                                     "VOX_ERROR_INVALID_HANDLE",
                                     "VOX_ERROR_INVALID_MESH",
                                     "VOX_ERROR_INVALID_STATE",
                                     "VOX_ERROR_NON_FINITE",
                                     "VOX_ERROR_LIMIT",
                                     "VOX_ERROR_BUDGET",
                                     "VOX_ERROR_OUT_OF_MEMORY",
                                     "VOX_ERROR_UNSUPPORTED",
                                     "VOX_ERROR_FILE",
                                     "VOX_ERROR_FORMAT",
                                     "VOX_ERROR_INTERNAL"};
    static_assert(std::size(names) == 1 - VOX_ERROR_INTERNAL);
    const std::int32_t value = vox::enum_value(result);
    return value <= 0 && value >= VOX_ERROR_INTERNAL ? names[-value] : "unknown vox_result";
}
