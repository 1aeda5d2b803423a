#include "base/error.hpp"

#include "base/structs.hpp"

#include <cstring>

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
    switch (vox::enum_value(result)) {
    case VOX_OK:
        return "VOX_OK";
    case VOX_ERROR_INVALID_ARGUMENT:
        return "VOX_ERROR_INVALID_ARGUMENT";
    case VOX_ERROR_INVALID_HANDLE:
        return "VOX_ERROR_INVALID_HANDLE";
    case VOX_ERROR_INVALID_MESH:
        return "VOX_ERROR_INVALID_MESH";
    case VOX_ERROR_INVALID_STATE:
        return "VOX_ERROR_INVALID_STATE";
    case VOX_ERROR_NON_FINITE:
        return "VOX_ERROR_NON_FINITE";
    case VOX_ERROR_LIMIT:
        return "VOX_ERROR_LIMIT";
    case VOX_ERROR_BUDGET:
        return "VOX_ERROR_BUDGET";
    case VOX_ERROR_OUT_OF_MEMORY:
        return "VOX_ERROR_OUT_OF_MEMORY";
    case VOX_ERROR_UNSUPPORTED:
        return "VOX_ERROR_UNSUPPORTED";
    case VOX_ERROR_FILE:
        return "VOX_ERROR_FILE";
    case VOX_ERROR_FORMAT:
        return "VOX_ERROR_FORMAT";
    case VOX_ERROR_INTERNAL:
        return "VOX_ERROR_INTERNAL";
        break;
    }
    return "unknown vox_result";
}
