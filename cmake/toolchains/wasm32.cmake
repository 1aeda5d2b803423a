# WebAssembly with its SIMD of 128 bits, by Debian's packages emscripten and nodejs.
set(portable_simd "-msimd128 -fexceptions")
set(CMAKE_C_FLAGS_INIT ${portable_simd})
set(CMAKE_CXX_FLAGS_INIT ${portable_simd})
set(CMAKE_EXE_LINKER_FLAGS_INIT "-fexceptions -sALLOW_MEMORY_GROWTH=1 -sTOTAL_STACK=4MB")
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
