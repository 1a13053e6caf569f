# mingw-w64 on Debian, and the prefix of third_party/windows/libraries.sh: for the preset "windows" and for
# those libraries themselves.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(windows_prefix ${CMAKE_CURRENT_LIST_DIR}/../../build/windows-prefix/installed)
file(REAL_PATH ${windows_prefix} windows_prefix)
set(CMAKE_FIND_ROOT_PATH ${windows_prefix} /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
foreach(kind LIBRARY INCLUDE PACKAGE)
    set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
set(CMAKE_PREFIX_PATH /)
# Debian's .pc files are Linux's.
set(ENV{PKG_CONFIG_LIBDIR} ${windows_prefix}/lib/pkgconfig)
set(ENV{PKG_CONFIG_PATH} "")
