# hairis::hairis, the shared library, and hairis::static: what variants/capi/install.sh installs, or cargo-c, which puts this file into `share`
# and libraries into the folder of the architecture, as distributions do.
get_filename_component(_hairis_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
set(_hairis_lib "${_hairis_prefix}/lib")
if(CMAKE_CURRENT_LIST_DIR MATCHES "/share/cmake/")
  foreach(_hairis_dir "lib64" "lib/${CMAKE_LIBRARY_ARCHITECTURE}")
    if(EXISTS "${_hairis_prefix}/${_hairis_dir}/libhairis.so.1")
      set(_hairis_lib "${_hairis_prefix}/${_hairis_dir}")
    endif()
  endforeach()
endif()
if(NOT TARGET hairis::hairis)
  add_library(hairis::hairis SHARED IMPORTED)
  set_target_properties(hairis::hairis PROPERTIES
    IMPORTED_LOCATION "${_hairis_lib}/libhairis.so.1"
    IMPORTED_SONAME "libhairis.so.1"
    INTERFACE_INCLUDE_DIRECTORIES "${_hairis_prefix}/include")
endif()
# Built without std: it stands beside other static libraries of Rust.
if(NOT TARGET hairis::static)
  add_library(hairis::static STATIC IMPORTED)
  set_target_properties(hairis::static PROPERTIES
    IMPORTED_LOCATION "${_hairis_lib}/libhairis.a"
    INTERFACE_INCLUDE_DIRECTORIES "${_hairis_prefix}/include"
    INTERFACE_LINK_OPTIONS "$<$<PLATFORM_ID:Linux>:-Wl,--gc-sections>")
endif()
set(hairis_FOUND TRUE)
