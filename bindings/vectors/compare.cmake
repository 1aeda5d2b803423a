# Fails unless PROGRAM writes the vectors that are in FOLDER.
execute_process(COMMAND ${PROGRAM} . COMMAND_ERROR_IS_FATAL ANY)
foreach(name vectors.json vectors.bin)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${name} ${FOLDER}/${name} RESULT_VARIABLE differs)
  if(differs)
    message(SEND_ERROR "${name} is not what the library gives now; if that is meant to be so: ./dev vectors")
  endif()
endforeach()
