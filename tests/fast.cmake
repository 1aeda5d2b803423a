vox_test(fast internal/test_fast.cpp LIBS vox_internal)
target_include_directories(test_fast PRIVATE ${CMAKE_CURRENT_LIST_DIR}/internal)
