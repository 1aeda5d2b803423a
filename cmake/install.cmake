# Installed so that both find_package(vox) and pkg-config work.
include(CMakePackageConfigHelpers)

install(TARGETS vox EXPORT voxTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(FILES include/vox/vox.h include/vox/vox.hpp include/vox/vox_pairs.h include/vox/vox_pairs.hpp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vox)
# #include <vox/adapters/ipc_broad_phase.hpp>
install(FILES adapters/ipc_broad_phase.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vox/adapters)
if(VOX_BUILD_IO)
  install(TARGETS vox_io EXPORT voxTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES include/vox/vox_io.h include/vox/vox_io.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vox)
endif()
if(VOX_BUILD_SIM)
  install(TARGETS vox_sim EXPORT voxTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES include/vox/vox_sim.h include/vox/vox_sim.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vox)
endif()
if(TARGET vox_dist)
  install(TARGETS vox_dist EXPORT voxTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES include/vox/vox_dist.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vox)
endif()
if(VOX_MPI)
  install(TARGETS vox_mpi EXPORT voxTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES include/vox/vox_mpi.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vox)
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
configure_file(cmake/vox.pc.in vox.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vox.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(VOX_BUILD_IO)
  if(NOT BUILD_SHARED_LIBS) # a shared library has them linked in, and pkg-config would want their files even so
    if(VOX_IO_ASSIMP)
      string(APPEND VOX_IO_PC_REQUIRES " assimp")
    endif()
    if(VOX_IO_FINDS_XML)
      string(APPEND VOX_IO_PC_REQUIRES " pugixml zlib")
    endif()
  endif()
  configure_file(cmake/vox_io.pc.in vox_io.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vox_io.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()
if(VOX_BUILD_SIM)
  configure_file(cmake/vox_sim.pc.in vox_sim.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vox_sim.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()
if(TARGET vox_dist)
  configure_file(cmake/vox_dist.pc.in vox_dist.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vox_dist.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()
if(VOX_MPI)
  configure_file(cmake/vox_mpi.pc.in vox_mpi.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/vox_mpi.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()
