# Penetrations: through the public face, state by state, against the figures that are promised, and part by part.
set(depth_tests depth depth_states)
vox_test(depth test_depth.c LIBS vox::vox)
vox_test(depth_states test_depth_states.c LIBS vox::vox)
set_tests_properties(depth_states PROPERTIES LABELS valgrind) # the others are long, and run under the sanitizers
if(VOX_BUILD_IO)
  list(APPEND depth_tests depth_figures)
  vox_test(depth_figures test_depth_figures.c LIBS vox::io vox::vox)
endif()
foreach(name ${depth_tests})
  target_link_libraries(test_${name} PRIVATE $<$<BOOL:${UNIX}>:m>)
  target_compile_options(test_${name} PRIVATE -Wno-conversion -Wno-float-conversion)
endforeach()
vox_test(depth_parts internal/test_depth_parts.cpp LIBS vox_internal)
