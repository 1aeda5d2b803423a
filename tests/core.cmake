# The core through its public face: C programs that link the shared library as a user would.
foreach(name grid contacts memory rest)
  vox_test(${name} test_${name}.c LIBS vox::vox)
  set_tests_properties(${name} PROPERTIES LABELS valgrind)
  target_compile_definitions(test_${name} PRIVATE _POSIX_C_SOURCE=200809L)
  target_compile_options(test_${name} PRIVATE -Wno-conversion -Wno-float-conversion)
endforeach()

target_link_libraries(test_rest PRIVATE $<$<BOOL:${UNIX}>:m>)

# Threads; under the thread sanitizer by ./dev tsan.
find_package(Threads REQUIRED)
vox_test(threads test_threads.c LIBS vox::vox Threads::Threads)
set_tests_properties(threads PROPERTIES LABELS threads)
target_compile_definitions(test_threads PRIVATE _POSIX_C_SOURCE=200809L)
target_compile_options(test_threads PRIVATE -Wno-conversion -Wno-float-conversion)
