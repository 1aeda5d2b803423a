# Surface to tetrahedra and the ready-made bodies.
foreach(name solid_bodies solid_models solid_surfaces)
  vox_test(${name} test_${name}.c LIBS vox::io)
  target_compile_options(test_${name} PRIVATE -Wno-conversion -Wno-float-conversion)
  if(UNIX)
    target_link_libraries(test_${name} PRIVATE m)
  endif()
endforeach()

# Stuffing alone, from lattices of random sides and cuts rather than from bodies.
set(io ${PROJECT_SOURCE_DIR}/src/io)
vox_test(stuffing internal/test_stuffing.cpp ${io}/solid_coarsen.cpp ${io}/solid_lattice.cpp ${io}/solid_stencil.cpp
  ${io}/solid_stuff.cpp LIBS vox::vox)
set_tests_properties(solid_bodies solid_models solid_surfaces stuffing PROPERTIES LABELS heavy)
target_include_directories(test_stuffing PRIVATE ${io} ${PROJECT_SOURCE_DIR}/src)
