# Settings shared by every target of this project.
function(vox_target name)
  if(MSVC)
    target_compile_options(${name} PRIVATE /W4 $<$<BOOL:${VOX_WERROR}>:/WX> /fp:precise)
  else()
    # No contraction into fused multiply-adds: results must not depend on compiler or instruction set.
    target_compile_options(${name} PRIVATE -Wall -Wextra -Wpedantic -Wconversion
      $<$<BOOL:${VOX_WERROR}>:-Werror> -ffp-contract=off)
  endif()
  if(VOX_SANITIZE)
    target_compile_options(${name} PRIVATE -fsanitize=${VOX_SANITIZE} -fno-sanitize-recover=all
      -fno-omit-frame-pointer)
    target_link_options(${name} PRIVATE -fsanitize=${VOX_SANITIZE})
    # C programs too get the C++ part of the sanitizers' runtimes, which the libraries need.
    set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  endif()
endfunction()

# A library with C linkage only: everything but vox_* is hidden, by compiler flags and by an export map.
function(vox_library name export_map)
  vox_target(${name})
  set_target_properties(${name} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${VOX_ABI_VERSION})
  if(BUILD_SHARED_LIBS)
    target_compile_definitions(${name} PRIVATE VOX_BUILD)
    if(UNIX AND NOT APPLE AND NOT EMSCRIPTEN)
      target_link_options(${name} PRIVATE LINKER:--version-script=${export_map} LINKER:--no-undefined)
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
