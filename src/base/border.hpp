// The C border. Every public function that can fail is `return border(...)`, which turns whatever is thrown
// inside into a result code and the text of vox_last_error().
#pragma once

#include "base/error.hpp"

#include <exception>
#include <new>

namespace vox {

template <class Function>
vox_result border(Function&& function) noexcept {
    try {
        function();
        return VOX_OK;
    } catch (const Error& error) {
        return vox_fail(error.result(), error.what());
    } catch (const std::bad_alloc&) {
        return vox_fail(VOX_ERROR_OUT_OF_MEMORY, "out of memory");
    } catch (const std::exception& error) {
        return vox_fail(VOX_ERROR_INTERNAL, error.what());
    } catch (...) {
        return vox_fail(VOX_ERROR_INTERNAL, "unknown exception");
    }
}

// For a function of an object, which must not be null; `name` is that of the parameter.
template <class Function>
vox_result border(const void* object, const char* name, Function&& function) noexcept {
    return border([&] {
        require(object, name);
        function();
    });
}

// For a function of an object that sets *out, not null either, to what value() returns.
template <class T, class Value>
vox_result border(const void* object, const char* name, T* out, const char* out_name,
                  Value&& value) noexcept {
    return border(object, name, [&] {
        require(out, out_name);
        *out = value();
    });
}

} // namespace vox
