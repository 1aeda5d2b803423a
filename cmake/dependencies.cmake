# VOX_FETCH_DEPENDENCIES: what the libraries, the tool and the tests include is downloaded, at the versions that CI tests, so
# that a compiler and CMake are enough. The second address of each, Debian's, has the same bytes.
include(FetchContent)
set(FETCHCONTENT_QUIET OFF)

function(vox_declare package hash)
  FetchContent_Declare(${package} URL ${ARGN} URL_HASH SHA256=${hash} DOWNLOAD_EXTRACT_TIMESTAMP OFF
    SOURCE_SUBDIR not_built OVERRIDE_FIND_PACKAGE) # nothing of its own build files: they bring tests and install rules
endfunction()

# vox_provide(package target include sources...): find_package(package) makes the target: headers below the folder `include`,
# and the objects of the sources, if there are any, which whatever links with the target holds from then on.
function(vox_provide package target include)
  string(TOLOWER ${package} lower)
  set(code "if(NOT TARGET ${target})
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE \${${lower}_SOURCE_DIR}/${include})\n")
  if(ARGN)
    list(TRANSFORM ARGN PREPEND "\${${lower}_SOURCE_DIR}/")
    list(JOIN ARGN " " sources)
    string(APPEND code "  add_library(vox_${lower} OBJECT ${sources})
  target_include_directories(vox_${lower} PRIVATE \${${lower}_SOURCE_DIR}/${include})
  target_sources(${target} INTERFACE $<TARGET_OBJECTS:vox_${lower}>)\n")
  endif()
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${lower}-extra.cmake "${code}endif()\n")
endfunction()

set(debian https://deb.debian.org/debian/pool/main)
vox_declare(highway 566fc77315878473d9a6bd815f7de78c73734acdcb745c3dde8579560ac5440e
  https://github.com/google/highway/archive/1.0.3.tar.gz ${debian}/h/highway/highway_1.0.3.orig.tar.gz)
FetchContent_MakeAvailable(highway)
set(VOX_HIGHWAY_INCLUDE_DIR ${highway_SOURCE_DIR})

vox_declare(Eigen3 b4c198460eba6f28d34894e3a5710998818515104d6e74e5cc331ce31e46e626
  https://gitlab.com/libeigen/eigen/-/archive/3.4.0/eigen-3.4.0.tar.bz2 ${debian}/e/eigen3/eigen3_3.4.0.orig.tar.bz2)
vox_provide(Eigen3 Eigen3::Eigen .)

vox_declare(CLI11 26291377e892ba0e5b4972cdfd4a2ab3bf53af8dac1f4ea8fe0d1376b625c8cb
  https://github.com/CLIUtils/CLI11/archive/v2.1.2.tar.gz)
vox_provide(CLI11 CLI11::CLI11 include)

vox_declare(nlohmann_json d69f9deb6a75e2580465c6c4c5111b89c4dc2fa94e3a85fcd2ffcd9a143d9273
  https://github.com/nlohmann/json/archive/v3.11.2.tar.gz ${debian}/n/nlohmann-json3/nlohmann-json3_3.11.2.orig.tar.gz)
vox_provide(nlohmann_json nlohmann_json::nlohmann_json include)

vox_declare(pugixml 5c5ad5d7caeb791420408042a7d88c2c6180781bf218feca259fd9d840a888e1
  https://github.com/zeux/pugixml/archive/v1.13.tar.gz ${debian}/p/pugixml/pugixml_1.13.orig.tar.gz)
vox_provide(pugixml pugixml::pugixml src src/pugixml.cpp)

if(NOT ZLIB_LIBRARY) # or somebody's own
  vox_declare(ZLIB 9a93b2b7dfdac77ceba5a558a580e74667dd6fede4585b91eefb60f03b72df23
    https://github.com/madler/zlib/releases/download/v1.3.1/zlib-1.3.1.tar.gz)
  vox_provide(ZLIB ZLIB::ZLIB . adler32.c crc32.c inffast.c inflate.c inftrees.c uncompr.c zutil.c) # for uncompress
endif()

if(VOX_BUILD_TESTS) # built by its own rules, which know the system
  FetchContent_Declare(check URL https://github.com/libcheck/check/archive/0.15.2.tar.gz
    ${debian}/c/check/check_0.15.2.orig.tar.gz
    URL_HASH SHA256=8451b68ac5d6f3157b24f22eceff575bcf566264f6d78f3852f89d4e08cf42e1 DOWNLOAD_EXTRACT_TIMESTAMP OFF)
  FetchContent_GetProperties(check)
  if(NOT check_POPULATED)
    FetchContent_Populate(check)
    add_subdirectory(${check_SOURCE_DIR} ${check_BINARY_DIR} EXCLUDE_FROM_ALL SYSTEM)
  endif()
endif()
