// The device of a library without a GPU.
#include "base/error.hpp"
#include "gpu/host_backend.hpp"

namespace vox::gpu {

std::unique_ptr<Backend> make_backend(int device) {
    if (device == 0) return make_host_backend({});
    throw Error(VOX_ERROR_UNSUPPORTED, format("there is no device %d: vox_gpu_host has 0 alone", device));
}

} // namespace vox::gpu
