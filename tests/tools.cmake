# Tests of the command line: Python with the standard library only. What needs the meshes outside the tree is a
# test of its own, so that it can be skipped alone.
find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)

foreach(name command_line command_line_meshes sweep)
  add_test(NAME ${name} COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_LIST_DIR}/tools/${name}.py)
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77
    ENVIRONMENT "VOX_TOOL=$<TARGET_FILE:vox_tool>;VOX_MESHES=${VOX_MESHES}")
endforeach()
set_tests_properties(command_line_meshes sweep PROPERTIES LABELS heavy)
