# Reading contacts: positions, the surface next to them, depth.
foreach(name readings reading_life)
  vox_test(${name} test_${name}.c LIBS vox::vox $<$<BOOL:${UNIX}>:m>)
  set_tests_properties(${name} PROPERTIES LABELS valgrind)
  target_compile_definitions(test_${name} PRIVATE _POSIX_C_SOURCE=200809L)
  target_compile_options(test_${name} PRIVATE -Wno-conversion -Wno-float-conversion)
endforeach()
set_tests_properties(readings PROPERTIES LABELS "valgrind;threads") # also under the thread sanitizer

# Limits, those that can be reached and those that cannot.
vox_test(limits test_limits.c LIBS vox::vox)
target_compile_options(test_limits PRIVATE -Wno-conversion -Wno-float-conversion)
vox_test(internal_limits internal/test_limits.cpp LIBS vox_internal)
