# The fast engine as a whole, and stage by stage.
foreach(name fast fast_winding stages turning winding windows)
  vox_test(${name} internal/test_${name}.cpp LIBS vox_internal)
  target_include_directories(test_${name} PRIVATE ${CMAKE_CURRENT_LIST_DIR}/internal)
endforeach()

# Speed guard: instruction counts against a baseline (bench/guard/guard.py), of optimised code only.
find_program(VOX_VALGRIND valgrind)
if(VOX_VALGRIND AND CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT VOX_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
  find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)
  add_executable(guard ../bench/guard/guard.c)
  target_include_directories(guard PRIVATE ${CMAKE_CURRENT_LIST_DIR})
  target_link_libraries(guard PRIVATE vox::vox)
  vox_target(guard)
  add_test(NAME speed_guard
    COMMAND Python3::Interpreter -B ${PROJECT_SOURCE_DIR}/bench/guard/guard.py $<TARGET_FILE:guard>)
  set_tests_properties(speed_guard PROPERTIES LABELS guard SKIP_RETURN_CODE 77)
endif()
