# Flags of every target of ours: warnings, floating point as written, sanitizers.
add_library(raytree_options INTERFACE)
target_include_directories(raytree_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(raytree_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wunused
  # Pixels must not depend on what a compiler likes to fuse.
  -ffp-contract=off
  # errno and floating-point traps of math functions are not used; values do not change.
  -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms at std::string's operator+ (GCC bug 105651).
  target_compile_options(raytree_options INTERFACE -Wno-restrict)
endif()
# Sanitized code makes g++ see uninitialized values inside std::regex and std::function that are none.
if(RAYTREE_WARNINGS_AS_ERRORS AND NOT (RAYTREE_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"))
  target_compile_options(raytree_options INTERFACE -Werror)
endif()
if(RAYTREE_NATIVE)
  target_compile_options(raytree_options INTERFACE -march=native)
endif()
if(RAYTREE_SANITIZE)
  target_compile_options(raytree_options INTERFACE -fsanitize=${RAYTREE_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  target_link_options(raytree_options INTERFACE -fsanitize=${RAYTREE_SANITIZE})
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# For targets that run little code of their own: what the optimizer costs the build, it would not give back.
if(RAYTREE_SANITIZE)
  set(RAYTREE_LITTLE_OPTIMIZATION -O0)
elseif(CMAKE_BUILD_TYPE)
  # At this level g++ 12 sees overruns inside std::string that are none.
  set(RAYTREE_LITTLE_OPTIMIZATION -O1 $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>)
endif()
