# 64-bit Windows by clang, with the headers, libraries and linker of Debian's MinGW-w64, gcc's C++ library among them: packages
# clang, g++-mingw-w64-x86-64-posix, and wine64 to run what comes out.
include(${CMAKE_CURRENT_LIST_DIR}/windows-gcc.cmake)
set(CMAKE_C_COMPILER clang)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_C_COMPILER_TARGET x86_64-w64-mingw32)
set(CMAKE_CXX_COMPILER_TARGET x86_64-w64-mingw32)
# clang does not look for gcc where Debian has it. Thread-local variables are gcc's, as in its library, which needs the one of
# threads. Not by lld: that of LLVM 14 drops what unwinds the stack in templates of gcc's C++ library, so that a bad_alloc or
# length_error from within std::string or std::pmr ends the program. GNU's linker says that such templates differ in size.
file(GLOB gcc_library /usr/lib/gcc/x86_64-w64-mingw32/*-posix)
set(CMAKE_C_FLAGS_INIT "-nostdlibinc -isystem /usr/x86_64-w64-mingw32/include -femulated-tls -Wno-unused-command-line-argument")
set(CMAKE_CXX_FLAGS_INIT "-nostdinc++ -nostdlibinc -isystem ${gcc_library}/include/c++ \
-isystem ${gcc_library}/include/c++/x86_64-w64-mingw32 -isystem /usr/x86_64-w64-mingw32/include -femulated-tls -Wno-unused-command-line-argument")
foreach(kind EXE SHARED MODULE)
  set(CMAKE_${kind}_LINKER_FLAGS_INIT "-B${gcc_library} -L${gcc_library} -L/usr/x86_64-w64-mingw32/lib -rtlib=libgcc")
endforeach()
set(CMAKE_C_STANDARD_LIBRARIES "-lgcc_eh -lpthread -lkernel32" CACHE STRING "")
set(CMAKE_CXX_STANDARD_LIBRARIES "-lstdc++ -lgcc_eh -lpthread -lkernel32 -lshell32" CACHE STRING "")
