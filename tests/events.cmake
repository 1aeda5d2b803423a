# What comes with contacts: events, filters, queries.
find_package(Threads REQUIRED)
foreach(name events filters self_filters queries query_surfaces)
  vox_test(${name} test_${name}.c LIBS vox::vox)
  set_tests_properties(${name} PROPERTIES LABELS valgrind)
  target_compile_definitions(test_${name} PRIVATE _POSIX_C_SOURCE=200809L)
  target_compile_options(test_${name} PRIVATE -Wno-conversion -Wno-float-conversion)
endforeach()
target_link_libraries(test_self_filters PRIVATE vox_oracle)
target_link_libraries(test_query_surfaces PRIVATE vox_oracle)
target_link_libraries(test_queries PRIVATE vox_oracle Threads::Threads)
set_tests_properties(queries PROPERTIES LABELS "valgrind;threads") # also under the thread sanitizer
set_tests_properties(query_surfaces PROPERTIES LABELS "") # minutes under valgrind
