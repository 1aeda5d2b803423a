# The public headers compile alone, as C99 and as C++17, without a hidden hole in any struct.
foreach(header vox vox_io vox_sim)
  foreach(language c cpp)
    set(file ${CMAKE_CURRENT_BINARY_DIR}/header_${header}.${language})
    file(CONFIGURE OUTPUT ${file} CONTENT "#include <vox/${header}.h>\n")
    add_library(header_${header}_${language} OBJECT ${file})
    target_include_directories(header_${header}_${language} PRIVATE ${PROJECT_SOURCE_DIR}/include)
    target_compile_options(header_${header}_${language} PRIVATE -Wall -Wextra -pedantic -Wpadded -Werror)
    set_target_properties(header_${header}_${language} PROPERTIES CXX_STANDARD 17)
  endforeach()
endforeach()

# The libraries export vox_* and nothing else.
if(BUILD_SHARED_LIBS AND UNIX AND NOT APPLE)
  foreach(library vox vox_io vox_sim)
    if(TARGET ${library})
      add_test(NAME exports_${library}
        COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/exports.sh ${CMAKE_NM} $<TARGET_FILE:${library}>
          ${PROJECT_SOURCE_DIR}/include/vox/${library}.h)
    endif()
  endforeach()
  # An installed vox serves a CMake project and a pkg-config one, both outside the tree.
  if(NOT VOX_SANITIZE)
    add_test(NAME install
      COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/install/run.sh ${PROJECT_BINARY_DIR}
        ${CMAKE_CURRENT_SOURCE_DIR}/install ${CMAKE_COMMAND} ${CMAKE_GENERATOR} ${CMAKE_C_COMPILER}
        $<IF:$<BOOL:${VOX_TBB}>,tbb,lean>)
  endif()
endif()
