# The cell size: its statistics, cost function, zone and arguments; and the paper's tables.
vox_test(suggest test_suggest.c test_suggest_arguments.c LIBS vox::vox)
set_tests_properties(suggest PROPERTIES LABELS valgrind)
target_link_libraries(test_suggest PRIVATE $<$<BOOL:${UNIX}>:m>)
vox_test(suggest_models test_suggest_models.c LIBS vox::vox)
target_link_libraries(test_suggest_models PRIVATE $<$<BOOL:${UNIX}>:m>)
if(VOX_BUILD_IO)
  vox_test(paper_tables test_paper_tables.c LIBS vox::io)
endif()
# The cost models' counts against the engines' own.
vox_test(cost internal/test_cost.cpp LIBS vox_internal)
target_include_directories(test_cost PRIVATE ${CMAKE_CURRENT_LIST_DIR}/internal)
vox_test(cost_search internal/test_cost_search.cpp LIBS vox_internal)
target_include_directories(test_cost_search PRIVATE ${CMAKE_CURRENT_LIST_DIR}/internal)
# What a suggestion takes, by count.
vox_test(suggest_work internal/test_suggest_work.cpp LIBS vox_internal)
target_include_directories(test_suggest_work PRIVATE ${CMAKE_CURRENT_LIST_DIR}/internal)
set_tests_properties(suggest_work PROPERTIES LABELS threads) # also under the thread sanitizer
