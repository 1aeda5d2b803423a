#include "portability/simd_level.h"

#include "base/simd.hpp"

const char* force_simd_level(int level) {
    return vox::simd::level_name(vox::simd::force_level(static_cast<vox::simd::Level>(level)));
}
