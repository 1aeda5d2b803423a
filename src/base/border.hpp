// The C border. Every public function that can fail is `return border(...)`, which turns whatever is thrown
// inside into a result code and the text of vox_last_error(), and computes in the default floating-point
// environment.
#pragma once

#include "base/error.hpp"
#include "base/float_environment.hpp"

#include <exception>
#include <new>

namespace vox {

#if defined(_MSC_VER)
#define VOX_NOINLINE __declspec(noinline)
#else
#define VOX_NOINLINE __attribute__((noinline))
#endif

// Not inlined, so that none of its arithmetic leaves the environment of border().
template <class Function>
VOX_NOINLINE vox_result result_of(Function& function) noexcept {
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

template <class Function>
vox_result border(Function&& function) noexcept {
    const DefaultFloats floats;
    return result_of(function);
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
