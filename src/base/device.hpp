// Marks functions that the kernels of src/gpu share with the host: CUDA's compiler makes them for both.
#pragma once

#if defined(__CUDACC__)
#define VOX_HD __host__ __device__ __forceinline__
#else
#define VOX_HD inline
#endif

// Before a loop that seldom runs: on the device in few registers.
#if defined(__CUDA_ARCH__)
#define VOX_ROLLED _Pragma("unroll 1")
#else
#define VOX_ROLLED
#endif
