# Every library that Raytree uses, found once. Debian's CMake configs of OpenColorIO and OpenImageIO do not work
# (off the search path; drags in OpenCV's include paths), so those two come through pkg-config; OpenSubdiv's names a static
# library that is not there, so it has a find module of ours.
find_package(Threads REQUIRED)
find_package(Imath CONFIG REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(TBB CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 CONFIG REQUIRED)
endif()
find_package(OpenSubdiv 3.5 REQUIRED)  # by cmake/FindOpenSubdiv.cmake
find_package(PkgConfig REQUIRED)
pkg_check_modules(OpenColorIO REQUIRED IMPORTED_TARGET OpenColorIO>=2.1)
pkg_check_modules(OpenImageIO REQUIRED IMPORTED_TARGET OpenImageIO>=2.4)
