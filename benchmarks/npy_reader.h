// Rays from NumPy's .npy files (format of numpy.lib.format, versions 1 to 3): float32, little-endian, C order, N x 6
// (origin, unit or not direction) or N x 8 (and the distances at which a ray begins and ends).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec.h"

namespace raytree::benchmarks {

struct FileRay {
  Vec3f origin, direction;   ///< world space; the direction is made unit
  float begin = 0, end = 0;  ///< along it, in the scene's units
};

/// Columns 0-2 are the origin, 3-5 the direction, 6 and 7 where the ray begins and ends in lengths of the direction as
/// given; with six columns it begins at its origin and ends nowhere. Everything must be finite but an end, which may be
/// +infinity; a direction may not be zero, 0 <= begin <= end. Throws Error (bad_input) naming the file and, where one
/// is to blame, the row.
std::vector<FileRay> read_rays(const std::string& path);

/// The same from a file's bytes; `name` stands for the file in messages.
std::vector<FileRay> parse_rays(std::string_view bytes, const std::string& name);

}  // namespace raytree::benchmarks
