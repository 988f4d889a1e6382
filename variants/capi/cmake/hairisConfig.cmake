# hairis::hairis, the shared library, and hairis::static: what variants/capi/install.sh installs.
get_filename_component(_hairis_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET hairis::hairis)
  add_library(hairis::hairis SHARED IMPORTED)
  set_target_properties(hairis::hairis PROPERTIES
    IMPORTED_LOCATION "${_hairis_prefix}/lib/libhairis.so.1"
    IMPORTED_SONAME "libhairis.so.1"
    INTERFACE_INCLUDE_DIRECTORIES "${_hairis_prefix}/include")
endif()
# Built without std: it stands beside other static libraries of Rust.
if(NOT TARGET hairis::static)
  add_library(hairis::static STATIC IMPORTED)
  set_target_properties(hairis::static PROPERTIES
    IMPORTED_LOCATION "${_hairis_prefix}/lib/libhairis.a"
    INTERFACE_INCLUDE_DIRECTORIES "${_hairis_prefix}/include"
    INTERFACE_LINK_OPTIONS "$<$<PLATFORM_ID:Linux>:-Wl,--gc-sections>")
endif()
set(hairis_FOUND TRUE)
