# OpenSubdiv's CPU library as OpenSubdiv::osdCPU. Debian ships a CMake config that names a static library which the package
# does not hold; so: the shared library and the headers, by name.
find_path(OpenSubdiv_INCLUDE_DIR opensubdiv/version.h)
find_library(OpenSubdiv_CPU_LIBRARY osdCPU)
mark_as_advanced(OpenSubdiv_INCLUDE_DIR OpenSubdiv_CPU_LIBRARY)

if(OpenSubdiv_INCLUDE_DIR)
  # OPENSUBDIV_VERSION_NUMBER is written 30500 for 3.5.0.
  file(STRINGS "${OpenSubdiv_INCLUDE_DIR}/opensubdiv/version.h" version_line REGEX "define OPENSUBDIV_VERSION_NUMBER +[0-9]+")
  string(REGEX REPLACE ".* ([0-9]+).*" "\\1" version_number "${version_line}")
  if(version_number)
    math(EXPR major "${version_number} / 10000")
    math(EXPR minor "${version_number} / 100 % 100")
    math(EXPR patch "${version_number} % 100")
    set(OpenSubdiv_VERSION "${major}.${minor}.${patch}")
  endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdiv REQUIRED_VARS OpenSubdiv_CPU_LIBRARY OpenSubdiv_INCLUDE_DIR
  VERSION_VAR OpenSubdiv_VERSION)

if(OpenSubdiv_FOUND AND NOT TARGET OpenSubdiv::osdCPU)
  add_library(OpenSubdiv::osdCPU UNKNOWN IMPORTED)
  set_target_properties(OpenSubdiv::osdCPU PROPERTIES IMPORTED_LOCATION "${OpenSubdiv_CPU_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OpenSubdiv_INCLUDE_DIR}")
endif()
