# What lasts: snapshots, a long random life, and the interface itself.
vox_test(snapshot test_snapshot.c LIBS vox::vox m)
vox_test(snapshot_hostile test_snapshot_hostile.c LIBS vox::vox m)
vox_test(soak test_soak.c LIBS vox::vox m)
foreach(name snapshot snapshot_hostile soak)
  set_tests_properties(${name} PROPERTIES LABELS valgrind)
  target_compile_definitions(test_${name} PRIVATE _POSIX_C_SOURCE=200809L)
  target_compile_options(test_${name} PRIVATE -Wno-conversion -Wno-float-conversion)
endforeach()

find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)
add_test(NAME abi_header COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_LIST_DIR}/abi/test_header.py)
# The checked-in numbers are those of 64-bit machines. What built libraries say themselves: ./dev abi.
if(CMAKE_SIZEOF_VOID_P EQUAL 8 AND NOT CMAKE_CROSSCOMPILING AND NOT MSVC)
  add_test(NAME abi_layout
    COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_LIST_DIR}/abi/layout.py ${CMAKE_C_COMPILER})
endif()

if(BUILD_SHARED_LIBS AND CMAKE_READELF AND UNIX AND NOT APPLE)
  foreach(library vox vox_io vox_sim)
    if(TARGET ${library})
      add_test(NAME soname_${library}
        COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/abi/soname.sh ${CMAKE_READELF} $<TARGET_FILE:${library}>
          ${PROJECT_SOURCE_DIR}/include/vox/vox.h)
    endif()
  endforeach()
endif()

if(VOX_BUILD_TOOLS)
  add_test(NAME replay COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_LIST_DIR}/tools/replay.py)
  set_tests_properties(replay PROPERTIES ENVIRONMENT "VOX_TOOL=$<TARGET_FILE:vox_tool>")
endif()

# The same hashes in every configuration, and as checked in. Other compilers and optimisations: ./dev hashes.
add_executable(hashes portability/hashes.c portability/simd_level.cpp)
target_link_libraries(hashes PRIVATE vox_internal)
target_include_directories(hashes PRIVATE ${CMAKE_CURRENT_LIST_DIR})
target_include_directories(hashes SYSTEM PRIVATE ${VOX_HIGHWAY_INCLUDE_DIR})
vox_target(hashes)
set(few)
if(VOX_SANITIZE)
  set(few --few)
endif()
add_test(NAME hashes
  COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_LIST_DIR}/portability/matrix.py $<TARGET_FILE:hashes> ${few})
