// The C border. Every public function that can fail is `return border([&] { ... });`, which turns whatever is
// thrown inside into a result code and the text of vox_last_error().
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

} // namespace vox
