# Deformable bodies.
foreach(name sim sim_bad_input)
  vox_test(${name} ${CMAKE_CURRENT_LIST_DIR}/test_${name}.c LIBS vox::sim vox::io vox::vox m)
  target_compile_options(test_${name} PRIVATE -Wno-conversion -Wno-float-conversion)
endforeach()
set_tests_properties(sim_bad_input PROPERTIES LABELS heavy)
# Ten bodies for a thousand frames: a minute, and many under a sanitizer, which sees the same code in the small stack.
if(NOT VOX_SANITIZE)
  add_test(NAME sim_stack COMMAND test_sim heavy)
  set_tests_properties(sim_stack PROPERTIES LABELS heavy)
endif()
