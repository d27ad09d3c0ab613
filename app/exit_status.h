// What the program tells its caller by its exit status; docs/command-line.md lists the same numbers.
#pragma once

namespace raytree::app {

inline constexpr int kSuccess = 0;
inline constexpr int kFailure = 1;       ///< disk full, no memory, a check that found something wrong
inline constexpr int kBadInput = 2;      ///< usage, scene, mesh, config
inline constexpr int kFallsShort = 3;    ///< what was measured or compared is not as it should be
inline constexpr int kSignalBase = 128;  ///< plus the signal's number: 130 for SIGINT, 143 for SIGTERM

}  // namespace raytree::app
