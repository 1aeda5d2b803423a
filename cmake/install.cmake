# Installed so that both find_package(vox) and pkg-config work.
include(CMakePackageConfigHelpers)

function(vox_install library) # and its headers, a component that needs no build
  install(TARGETS ${library} EXPORT voxTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  list(TRANSFORM ARGN PREPEND include/vox/)
  install(FILES ${ARGN} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vox COMPONENT headers)
endfunction()
vox_install(vox vox.h vox.hpp vox_query.h vox_query.hpp vox_cell_size.h vox_cell_size.hpp vox_surface.h vox_surface.hpp)
# #include <vox/adapters/ipc_broad_phase.hpp>
function(vox_install_adapter header)
  install(FILES adapters/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vox/adapters COMPONENT headers)
endfunction()
vox_install_adapter(ipc_broad_phase.hpp)
if(VOX_BUILD_IO)
  vox_install(vox_io vox_io.h vox_io.hpp)
  vox_install_adapter(jolt_soft_contacts.hpp)
endif()
if(VOX_BUILD_SIM)
  vox_install(vox_sim vox_sim.h vox_sim.hpp)
endif()
if(VOX_BUILD_DIST OR VOX_MPI)
  vox_install(vox_dist vox_dist.h)
endif()
if(VOX_MPI)
  vox_install(vox_mpi vox_mpi.h)
endif()
install(EXPORT voxTargets NAMESPACE vox:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vox)
# With vox_DIR set to it, find_package takes a build folder too.
export(EXPORT voxTargets NAMESPACE vox::)

set(VOX_IO_FINDS_XML ${VOX_IO_XML})
if(VOX_FETCH_DEPENDENCIES OR TARGET vox_xml) # inside vox_io
  set(VOX_IO_FINDS_XML OFF)
endif()
configure_package_config_file(cmake/voxConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/voxConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vox)
# Until version 1.0 a minor version may break the ABI.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/voxConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/voxConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/voxConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vox)

# Relative to the file itself, so that the installed tree can be moved.
file(RELATIVE_PATH VOX_PC_PREFIX /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p)
set(VOX_PC_LIBS "-lstdc++ -lm") # what a static library leaves to the program
if(VOX_TBB)
  string(PREPEND VOX_PC_LIBS "-ltbb ")
elseif(NOT EMSCRIPTEN)
  string(APPEND VOX_PC_LIBS " -pthread")
endif()
if(NOT BUILD_SHARED_LIBS)
  set(VOX_PC_STATIC " -DVOX_STATIC")
endif()
function(vox_install_pkg_config library)
  configure_file(cmake/${library}.pc.in ${library}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${library}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
vox_install_pkg_config(vox)
if(VOX_BUILD_IO)
  if(NOT BUILD_SHARED_LIBS) # a shared library has them linked in, and pkg-config would want their files even so
    if(VOX_IO_ASSIMP)
      string(APPEND VOX_IO_PC_REQUIRES " assimp")
    endif()
    if(VOX_IO_FINDS_XML)
      string(APPEND VOX_IO_PC_REQUIRES " pugixml zlib")
    endif()
    if(VOX_IO_XML AND VOX_IO_LZMA)
      string(APPEND VOX_IO_PC_REQUIRES " liblzma")
    endif()
  endif()
  vox_install_pkg_config(vox_io)
endif()
if(VOX_BUILD_SIM)
  vox_install_pkg_config(vox_sim)
endif()
if(VOX_BUILD_DIST OR VOX_MPI)
  vox_install_pkg_config(vox_dist)
endif()
if(VOX_MPI)
  vox_install_pkg_config(vox_mpi)
endif()
