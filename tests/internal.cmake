# The stages by themselves, from C++, against brute force in exact arithmetic.
add_library(vox_oracle STATIC EXCLUDE_FROM_ALL oracle.c)
target_include_directories(vox_oracle PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(vox_oracle PUBLIC ${GMP_LIBRARY} $<$<BOOL:${UNIX}>:m>)
vox_target(vox_oracle)

foreach(name predicates reference reference_grid canonical_contacts)
  vox_test(${name} internal/test_${name}.cpp LIBS vox_internal vox_oracle)
endforeach()

vox_test(grid_memory internal/test_grid_memory.cpp LIBS vox_internal)
