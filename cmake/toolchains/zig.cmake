# Any platform from any other, by the compiler that the Python package ziglang brings: clang, and for each target a linker, a C
# library and libc++. cmake -DCMAKE_TOOLCHAIN_FILE=cmake/toolchains/zig.cmake -DVOX_ZIG_TARGET=... with -DVOX_ZIG=PATH where zig
# is not found. Targets are zig's: x86_64-linux-gnu.2.17 (the oldest glibc that will do), aarch64-linux-musl, aarch64-macos.11.0,
# x86_64-windows-gnu ...
set(VOX_ZIG_TARGET "" CACHE STRING "What zig compiles for")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VOX_ZIG VOX_ZIG_TARGET)
if(NOT VOX_ZIG_TARGET MATCHES "^([a-z0-9_]+)-(linux|macos|windows)")
  message(FATAL_ERROR "VOX_ZIG_TARGET is '${VOX_ZIG_TARGET}'; it has to be like x86_64-linux-musl")
endif()
set(CMAKE_SYSTEM_PROCESSOR ${CMAKE_MATCH_1})
set(vox_system_linux Linux)
set(vox_system_macos Darwin)
set(vox_system_windows Windows)
set(CMAKE_SYSTEM_NAME ${vox_system_${CMAKE_MATCH_2}})
find_program(VOX_ZIG zig REQUIRED)

set(CMAKE_C_COMPILER ${VOX_ZIG} cc -target ${VOX_ZIG_TARGET})
set(CMAKE_CXX_COMPILER ${VOX_ZIG} c++ -target ${VOX_ZIG_TARGET})
foreach(language C CXX)
  set(CMAKE_${language}_ARCHIVE_CREATE "\"${VOX_ZIG}\" ar qc <TARGET> <LINK_FLAGS> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_APPEND "\"${VOX_ZIG}\" ar q <TARGET> <LINK_FLAGS> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_FINISH "\"${VOX_ZIG}\" ranlib <TARGET>")
endforeach()
set(CMAKE_EXE_LINKER_FLAGS_INIT -s) # zig writes what debuggers want, asked or not: 20 MB
set(CMAKE_SHARED_LINKER_FLAGS_INIT -s)

# Nothing of the machine at hand, and no tool of the other one's, which installing would change paths of search with.
set(CMAKE_FIND_ROOT_PATH /nothing)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
if(CMAKE_SYSTEM_NAME STREQUAL Darwin)
  # Libraries find each other as they will when installed.
  set(CMAKE_BUILD_WITH_INSTALL_NAME_DIR ON)
  set(CMAKE_USER_MAKE_RULES_OVERRIDE ${CMAKE_CURRENT_LIST_DIR}/zig_macos.cmake)
  set(CMAKE_INSTALL_NAME_TOOL ${VOX_ZIG}) # CMake asks for one, and does not call it then
endif()
