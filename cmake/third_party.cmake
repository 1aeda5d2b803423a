# Of others' libraries a source drop has what it needs in third_party/ (packages/source_drop.py); elsewhere the system has them.
set(VOX_THIRD_PARTY ${PROJECT_SOURCE_DIR}/third_party)

# vox_headers(TARGET FOLDER PACKAGE...): a library of headers alone, in that folder of third_party/ or by find_package.
function(vox_headers target folder)
  if(TARGET ${target})
    return()
  endif()
  if(EXISTS ${VOX_THIRD_PARTY}/${folder})
    add_library(${target} INTERFACE IMPORTED GLOBAL)
    target_include_directories(${target} SYSTEM INTERFACE ${VOX_THIRD_PARTY})
  else()
    find_package(${ARGN} REQUIRED)
  endif()
endfunction()

# vox_inside(TARGET LIBRARIES...): libraries that end up within the target, headers or objects. Not linked with it: what a static
# library links with is named in what is exported from a build folder, for others to find.
function(vox_inside target)
  foreach(library IN LISTS ARGN)
    target_include_directories(${target} SYSTEM PRIVATE $<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>)
    target_compile_definitions(${target} PRIVATE $<TARGET_PROPERTY:${library},INTERFACE_COMPILE_DEFINITIONS>)
    target_sources(${target} PRIVATE $<TARGET_PROPERTY:${library},INTERFACE_SOURCES>)
  endforeach()
endfunction()

# vox_xml(TARGET): pugixml and zlib for it, compiled in where the drop has them.
function(vox_xml target)
  if(NOT EXISTS ${VOX_THIRD_PARTY}/pugixml)
    find_package(pugixml REQUIRED)
    find_package(ZLIB REQUIRED)
    if(NOT VOX_FETCH_DEPENDENCIES)
      target_link_libraries(${target} PRIVATE pugixml::pugixml ZLIB::ZLIB)
    elseif(ZLIB_LIBRARY) # somebody's own
      vox_inside(${target} pugixml::pugixml)
      target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:ZLIB::ZLIB>)
    else()
      vox_inside(${target} pugixml::pugixml ZLIB::ZLIB)
    endif()
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${VOX_THIRD_PARTY}/zlib/*.c)
  add_library(vox_xml OBJECT ${VOX_THIRD_PARTY}/pugixml/pugixml.cpp ${sources})
  target_compile_definitions(vox_xml PRIVATE PUGIXML_NO_XPATH
    $<$<BOOL:${APPLE}>:fdopen=fdopen>) # zlib 1.2.13 takes macOS for a system that has none
  target_compile_options(vox_xml PRIVATE $<IF:$<BOOL:${MSVC}>,/w,-w>)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:vox_xml>)
  target_include_directories(${target} SYSTEM PRIVATE ${VOX_THIRD_PARTY}/pugixml ${VOX_THIRD_PARTY}/zlib)
endfunction()
