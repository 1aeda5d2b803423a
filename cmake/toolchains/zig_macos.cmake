# CMake asks the machine at hand which macOS it is, and takes what is none for one that has no search paths in its libraries.
set(CMAKE_SHARED_LIBRARY_RUNTIME_C_FLAG "-Wl,-rpath,")
