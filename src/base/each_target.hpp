// Has the including file compiled once for each target of Highway. Such a source begins with
//
//   #undef VOX_SOURCE
//   #define VOX_SOURCE "folder/file.cpp"
//   #include "base/each_target.hpp"
//
// Highway's headers take as long to compile as most of these files. So a build compiles several of them in
// one source, which has itself compiled for each target (cmake/vox_target.cmake).
#include "base/simd.hpp"

#if !defined(HIGHWAY_HWY_FOREACH_TARGET_H_) // not together with others
#define HWY_TARGET_INCLUDE VOX_SOURCE
#include <hwy/foreach_target.h>
#endif
#include <hwy/highway.h>
