# What follows from contacts: events; filters; queries.
foreach(name events filters)
  vox_test(${name} test_${name}.c LIBS vox::vox)
  set_tests_properties(${name} PROPERTIES LABELS valgrind)
  target_compile_definitions(test_${name} PRIVATE _POSIX_C_SOURCE=200809L)
  target_compile_options(test_${name} PRIVATE -Wno-conversion -Wno-float-conversion)
endforeach()
target_link_libraries(test_filters PRIVATE vox_oracle m)
