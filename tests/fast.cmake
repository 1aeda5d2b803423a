vox_test(fast internal/test_fast.cpp LIBS vox_internal)
target_include_directories(test_fast PRIVATE ${CMAKE_CURRENT_LIST_DIR}/internal)

# bench_engines: built on request, not by default.
add_executable(bench_engines EXCLUDE_FROM_ALL ../bench/engines.cpp)
target_include_directories(bench_engines PRIVATE ${CMAKE_CURRENT_LIST_DIR}/internal)
target_link_libraries(bench_engines PRIVATE vox_internal)
vox_target(bench_engines)
