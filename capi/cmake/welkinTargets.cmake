# The targets of the installed package and of the build tree. Set before: welkin_INCLUDE_DIR, welkin_LIBRARY_DIR,
# welkin_RUNTIME_DIR (where Windows' DLL is), welkin_SHARED and welkin_STATIC (file names), welkin_SCOPE (GLOBAL or
# nothing).
add_library(welkin::welkin SHARED IMPORTED ${welkin_SCOPE})
set_target_properties(welkin::welkin PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${welkin_INCLUDE_DIR}")
if(WIN32)
  set_target_properties(welkin::welkin PROPERTIES
    IMPORTED_LOCATION "${welkin_RUNTIME_DIR}/${welkin_SHARED}"
    IMPORTED_IMPLIB "${welkin_LIBRARY_DIR}/welkin.dll.lib")
else()
  set_target_properties(welkin::welkin PROPERTIES
    IMPORTED_LOCATION "${welkin_LIBRARY_DIR}/${welkin_SHARED}"
    IMPORTED_SONAME "${welkin_SHARED}")
endif()

add_library(welkin::welkin_static STATIC IMPORTED ${welkin_SCOPE})
set_target_properties(welkin::welkin_static PROPERTIES
  IMPORTED_LOCATION "${welkin_LIBRARY_DIR}/${welkin_STATIC}"
  INTERFACE_INCLUDE_DIRECTORIES "${welkin_INCLUDE_DIR}")
# What Rust's standard library needs of the system.
if(WIN32)
  set_target_properties(welkin::welkin_static PROPERTIES
    INTERFACE_LINK_LIBRARIES "kernel32;ntdll;userenv;ws2_32;dbghelp")
elseif(APPLE)
  set_target_properties(welkin::welkin_static PROPERTIES INTERFACE_LINK_LIBRARIES "System;c;m")
else()
  # A plugin that is linked with it does not show its functions to others, which may have another version.
  set_target_properties(welkin::welkin_static PROPERTIES
    INTERFACE_LINK_LIBRARIES "gcc_s;pthread;dl;m"
    INTERFACE_LINK_OPTIONS "LINKER:--exclude-libs,${welkin_STATIC}")
endif()
