# find_package(libdw): elfutils' library for debug information, and the one for ELF files below it, as target libdw::libdw. elfutils comes
# without a CMake package.
find_library(libdw_LIBRARY dw)
find_library(libdw_ELF_LIBRARY elf)
find_path(libdw_INCLUDE_DIR elfutils/libdw.h)
mark_as_advanced(libdw_LIBRARY libdw_ELF_LIBRARY libdw_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(libdw
  REQUIRED_VARS libdw_LIBRARY libdw_ELF_LIBRARY libdw_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "it is elfutils' library for debug information, on Debian the package libdw-dev")

if(libdw_FOUND AND NOT TARGET libdw::libdw)
  add_library(libdw::libdw UNKNOWN IMPORTED)
  set_target_properties(libdw::libdw PROPERTIES
    IMPORTED_LOCATION ${libdw_LIBRARY}
    INTERFACE_LINK_LIBRARIES ${libdw_ELF_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${libdw_INCLUDE_DIR})
endif()
