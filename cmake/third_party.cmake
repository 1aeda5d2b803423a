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

# vox_xml(TARGET): pugixml and zlib for it, compiled in where the drop has them.
function(vox_xml target)
  if(NOT EXISTS ${VOX_THIRD_PARTY}/pugixml)
    find_package(pugixml REQUIRED)
    find_package(ZLIB REQUIRED)
    if(VOX_FETCH_DEPENDENCIES) # then they are inside, and nobody needs to find them
      target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:pugixml::pugixml> $<BUILD_INTERFACE:ZLIB::ZLIB>)
    else()
      target_link_libraries(${target} PRIVATE pugixml::pugixml ZLIB::ZLIB)
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
