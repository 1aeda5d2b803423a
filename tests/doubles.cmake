# Positions of other kinds than floats: doubles, the library's own, moved by a transform.
foreach(name doubles positions transform)
  vox_test(${name} test_${name}.c LIBS vox::vox)
  set_tests_properties(${name} PROPERTIES LABELS valgrind)
  target_compile_definitions(test_${name} PRIVATE _POSIX_C_SOURCE=200809L)
  target_compile_options(test_${name} PRIVATE -Wno-conversion -Wno-float-conversion)
  target_link_libraries(test_${name} PRIVATE vox_oracle $<$<BOOL:${UNIX}>:m>)
endforeach()
