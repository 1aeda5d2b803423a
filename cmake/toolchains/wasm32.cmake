# WebAssembly by Debian's packages emscripten and nodejs, with or without its SIMD of 128 bits.
option(VOX_WASM_SIMD "Use WebAssembly's SIMD of 128 bits" ON)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VOX_WASM_SIMD)
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
set(wasm_flags -fwasm-exceptions) # those of -fexceptions go through JavaScript
if(VOX_WASM_SIMD)
  string(APPEND wasm_flags " -msimd128")
  # clang 14 makes wrong numbers of the plain doubles of src/depth/walk.cpp where it puts them into registers by itself. Its -O3
  # would undo this in the flags.
  add_compile_options(-fno-slp-vectorize)
endif()
set(CMAKE_C_FLAGS_INIT ${wasm_flags})
# Debian 12's Emscripten comes with libc++ 13, which lacks a little of C++20.
set(CMAKE_CXX_FLAGS_INIT "${wasm_flags} -I${CMAKE_CURRENT_LIST_DIR}/libcxx13")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-sALLOW_MEMORY_GROWTH=1 -sTOTAL_STACK=4MB")
