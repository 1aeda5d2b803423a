// Eigen for vox_io and vox_sim, which include it through this header alone.
#pragma once

// Where Eigen has SIMD it adds three numbers in another order than where it has none, as in WebAssembly.
// Without it all machines compute the same bits, whoever compiles the sources.
#define EIGEN_DONT_VECTORIZE
#include <Eigen/Geometry>
