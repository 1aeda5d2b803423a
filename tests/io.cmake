# vox_io: readers, diagnosis, writers.
foreach(name io_manifest io_meshes io_hostile io_write io_diagnosis)
  vox_test(${name} test_${name}.c LIBS vox::io vox::vox m)
  target_compile_definitions(test_${name} PRIVATE _POSIX_C_SOURCE=200809L
    VOX_TEST_DATA="${CMAKE_CURRENT_LIST_DIR}/data")
endforeach()
target_link_libraries(test_io_diagnosis PRIVATE ${GMP_LIBRARY})

if(VOX_BUILD_FUZZERS)
  add_subdirectory(${CMAKE_CURRENT_LIST_DIR}/fuzz ${CMAKE_CURRENT_BINARY_DIR}/fuzz)
endif()
