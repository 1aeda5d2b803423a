# gcc for Windows aligns the stack to 16 bytes and reads what it spills there as if it were to 32 or 64 (gcc bug 54412):
# AVX may crash. binutils 2.38 and newer can write the moves so that alignment does not matter, at the same speed. Without
# that, base/simd.hpp leaves AVX out.
if(MINGW AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-Wa,-muse-unaligned-vector-move VOX_HAS_UNALIGNED_MOVES)
endif()

# Settings shared by every target of this project.
function(vox_target name)
  if(MSVC)
    target_compile_options(${name} PRIVATE /W4 $<$<BOOL:${VOX_WERROR}>:/WX> /fp:precise)
  else()
    # No contraction into fused multiply-adds: results must not depend on compiler or instruction set, nor on -ffast-math
    # of a parent project or in CXXFLAGS.
    target_compile_options(${name} PRIVATE -Wall -Wextra -Wpedantic -Wconversion
      $<$<BOOL:${EMSCRIPTEN}>:-Wno-shorten-64-to-32> # size_t has 32 bits there
      $<$<BOOL:${VOX_WERROR}>:-Werror> -fno-fast-math -ffp-contract=off)
  endif()
  if(VOX_HAS_UNALIGNED_MOVES)
    target_compile_options(${name} PRIVATE -Wa,-muse-unaligned-vector-move)
    target_compile_definitions(${name} PRIVATE VOX_UNALIGNED_MOVES)
  endif()
  if(MINGW)
    # A program or DLL holds the runtimes of gcc, so that it needs none of its DLLs.
    target_link_options(${name} PRIVATE -static)
  endif()
  if(VOX_SANITIZE)
    target_compile_options(${name} PRIVATE -fsanitize=${VOX_SANITIZE} -fno-sanitize-recover=all
      -fno-omit-frame-pointer)
    # With this check clang takes 100 s instead of 20 for the largest source; the address sanitizer sees where such pointers lead.
    target_compile_options(${name} PRIVATE "$<$<CXX_COMPILER_ID:Clang>:-fno-sanitize=pointer-overflow>")
    # Reports need no more debug information than lines, and clang takes up to a tenth longer to write the rest.
    target_compile_options(${name} PRIVATE "$<$<CXX_COMPILER_ID:Clang>:-gline-tables-only>")
    target_link_options(${name} PRIVATE -fsanitize=${VOX_SANITIZE})
    # C programs too get the C++ part of the sanitizers' runtimes, which the libraries need.
    set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  endif()
endfunction()

# What makes an overflow, should there be one, harder to exploit. The libraries read files and snapshots of strangers.
option(VOX_HARDEN "Compile and link libraries and tool with stack protector, fortified C functions, control-flow
protection and read-only relocations; off: where a packager's own flags say it" ON)
if(VOX_SANITIZE OR WIN32 OR EMSCRIPTEN)
  # The sanitizers see more. MinGW's protector is a library of its own, gcc does not compile large frames with probes of
  # the stack there, and its linker's defaults are random addresses and no execution of data. A WebAssembly module cannot leave its memory.
  set(VOX_HARDEN OFF)
endif()
if(VOX_HARDEN)
  include(CheckCXXCompilerFlag)
  set(CMAKE_REQUIRED_FLAGS -Werror) # clang only warns of a flag of another processor
  foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection=full -mbranch-protection=standard)
    string(MAKE_C_IDENTIFIER "VOX_HAS${flag}" has)
    check_cxx_compiler_flag(${flag} ${has})
    if(${has})
      list(APPEND VOX_HARDENING ${flag})
    endif()
  endforeach()
  unset(CMAKE_REQUIRED_FLAGS)
endif()
function(vox_harden name)
  if(NOT VOX_HARDEN)
    return()
  endif()
  target_compile_options(${name} PRIVATE ${VOX_HARDENING}
    $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>) # which needs an optimising compiler
  if(UNIX AND NOT APPLE AND NOT EMSCRIPTEN)
    target_link_options(${name} PRIVATE LINKER:-z,relro,-z,now,-z,noexecstack)
  endif()
endfunction()

# A library with C linkage only: everything but vox_* is hidden, by compiler flags and by an export map.
function(vox_library name export_map)
  vox_target(${name})
  vox_harden(${name})
  set_target_properties(${name} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${VOX_ABI_VERSION})
  if(WIN32 AND BUILD_SHARED_LIBS)
    set_target_properties(${name} PROPERTIES PREFIX "") # vox.dll by any compiler: C# and Python load it by that name
  endif()
  if(BUILD_SHARED_LIBS)
    target_compile_definitions(${name} PRIVATE VOX_BUILD)
    if(UNIX AND NOT APPLE AND NOT EMSCRIPTEN)
      # Never unloaded: threads, oneTBB's among them, may still be in it when a host that loaded it by name (Mono, a
      # plug-in's) gives it back.
      target_link_options(${name} PRIVATE LINKER:--no-undefined LINKER:-z,nodelete)
      # LINKER: would part a path at its commas.
      target_link_options(${name} PRIVATE "SHELL:-Xlinker --version-script=\"${export_map}\"")
      if(VOX_SANITIZE)
        # The sanitizer runtimes are resolved when a program starts, not when the library is linked.
        target_link_options(${name} PRIVATE LINKER:-z,undefs)
      endif()
      set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS ${export_map})
    endif()
  else()
    target_compile_definitions(${name} PUBLIC VOX_STATIC)
  endif()
endfunction()

# vox_with_hidden_symbols(LIBRARY): its objects once more, as the archive LIBRARY_internal, for tests and benchmarks that call the stages.
function(vox_with_hidden_symbols library)
  set(name ${library}_internal)
  add_library(${name} STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:${library}>)
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${name} PUBLIC $<GENEX_EVAL:$<TARGET_PROPERTY:${library},LINK_LIBRARIES>>)
  vox_target(${name})
endfunction()

# A full build in half the time. Off in the presets debug and clang, so that what a file forgets to include is seen.
option(VOX_UNITY
  "Compile the sources of a folder together: half the work of a full build, more work where one file has changed" ON)

# vox_precompile(name headers...): headers that most sources include, compiled once.
function(vox_precompile name)
  if(VOX_UNITY)
    target_precompile_headers(${name} PRIVATE ${ARGN})
    if(CMAKE_CXX_COMPILER_LAUNCHER AND CMAKE_CXX_COMPILER_ID STREQUAL Clang) # else no cache keeps what includes them
      target_compile_options(${name} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")
    endif()
  endif()
endfunction()

# vox_unity(name): compiles the sources of each folder together. Those that are compiled once for each instruction set
# (base/each_target.hpp) become two sources, which two processors compile at the same time.
function(vox_unity name)
  if(NOT VOX_UNITY)
    set_target_properties(${name} PROPERTIES UNITY_BUILD OFF) # whatever CMAKE_UNITY_BUILD of a parent is
    return()
  endif()
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${name} SOURCES)
  foreach(source IN LISTS sources)
    file(STRINGS ${source} each_target REGEX "base/each_target.hpp" LIMIT_COUNT 1)
    if(each_target)
      list(APPEND for_each_target ${source})
      continue()
    endif()
    get_filename_component(folder ${source} DIRECTORY)
    if(IS_ABSOLUTE "${folder}") # where the clone lies would decide the order of groups, and that of a module's functions
      file(RELATIVE_PATH folder ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/.. ${folder})
    endif()
    string(MAKE_C_IDENTIFIER "${name}_${folder}" group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
  list(LENGTH for_each_target count)
  math(EXPR half "(${count} + 1) / 2")
  foreach(first 0 ${half})
    if(NOT first LESS count)
      break()
    endif()
    list(SUBLIST for_each_target ${first} ${half} some)
    set_source_files_properties(${some} PROPERTIES HEADER_FILE_ONLY ON)
    list(JOIN some "\"\n#include \"" includes)
    set(together ${CMAKE_CURRENT_BINARY_DIR}/${name}_each_target_${first}.cpp)
    file(CONFIGURE OUTPUT ${together} @ONLY CONTENT "#include \"base/simd.hpp\"
#define HWY_TARGET_INCLUDE \"${together}\"
#include <hwy/foreach_target.h>
#include \"${includes}\"
")
    set_source_files_properties(${together} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    list(INSERT sources 0 ${together}) # they take longest, so they come first
  endforeach()
  set_property(TARGET ${name} PROPERTY SOURCES ${sources})
endfunction()
